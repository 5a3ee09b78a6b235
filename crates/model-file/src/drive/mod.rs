//! `kind = "drive"`: a serpentine belt drive with any number of pulleys and tensioners (theory 04).
//!
//! The types here hold what the file says, in SI units and in the form in which it was said, so that every number keeps
//! its key. [`Drive::belt_drive`] turns them into the drive that the mechanics compute with.

mod belt;
mod caution;
mod check;
mod contact;
mod convert;
mod coupling;
mod damping;
mod excitation;
mod friction;
mod load;
mod pulley;
mod read;
mod service;
mod system;
mod tensioner;

use schemars::JsonSchema;
use serde::Serialize;

pub use belt::{
    ArcStretch, Belt, BeltModel, Friction, GroovedFriction, Installation, Length, ModesPerSpan,
    OperatingPosition, PerRib, RestTension, Section, SectionProperties, SpanEnds,
};
pub use contact::{PulleyContact, StopContact};
pub use coupling::{Coupling, CouplingKind};
pub use damping::{BeltDamping, ModalDamping, Rayleigh};
pub use excitation::{Amount, Excitation, Order};
pub use friction::{DryFriction, FrictionLaw, MeasuredLoop};
pub use load::{Load, LoadTable, Power, SpeedOf};
pub use pulley::{Carried, Contact, Fixed, Mount, Pulley, Size};
pub use service::{Condition, Operating, Rotation};
pub use tensioner::{BearingDrag, Direction, Guide, Linear, Rotary, Spring, Tensioner};

use crate::names::named_index;
use crate::scalar::{Numbers, Scalars, join, split_first};

/// A serpentine belt drive (theory 04).
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// Short name, for titles and result files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Free text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// The belt and what is known of its length.
    pub belt: Belt,
    /// The pulleys, in the order in which the belt meets them.
    #[serde(rename = "pulley")]
    pub pulleys: Vec<Pulley>,
    /// The tensioners; none for fixed centres.
    #[serde(rename = "tensioner", default)]
    pub tensioners: Vec<Tensioner>,
    /// The operating point.
    pub operating: Operating,
    /// What shakes the driver.
    #[serde(default)]
    pub excitation: Excitation,
    /// Conditions of service in which the drive is examined beside the one as installed.
    #[serde(rename = "condition", default)]
    pub conditions: Vec<Condition>,
}

impl Drive {
    /// Speed of the driver at the operating point, rad/s.
    pub fn operating_speed(&self) -> f64 {
        self.operating.speed
    }

    /// Names of the pulleys, then of the tensioners.
    pub fn coordinates(&self) -> Vec<&str> {
        let pulleys = self.pulleys.iter().map(|pulley| &*pulley.name);
        let tensioners = self.tensioners.iter().map(|tensioner| &*tensioner.name);
        pulleys.chain(tensioners).collect()
    }
}

impl Numbers for Drive {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        let (key, rest) = split_first(path);
        match key {
            "belt" => self.belt.number_mut(rest),
            "pulley" => {
                let (item, rest) = split_first(rest);
                let index = named_index(self.pulleys.iter().map(|pulley| &*pulley.name), item)?;
                self.pulleys[index].number_mut(rest)
            }
            "tensioner" => {
                let (item, rest) = split_first(rest);
                let index = named_index(self.tensioners.iter().map(|tensioner| &*tensioner.name), item)?;
                self.tensioners[index].number_mut(rest)
            }
            "operating" => self.operating.scalar_mut(rest),
            "excitation" => self.excitation.number_mut(rest),
            "condition" => {
                let (item, rest) = split_first(rest);
                let index = named_index(self.conditions.iter().map(|condition| &*condition.name), item)?;
                self.conditions[index].scalar_mut(rest)
            }
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        self.belt.collect_keys(&join(prefix, "belt"), keys);
        for pulley in &self.pulleys {
            pulley.collect_keys(&join(prefix, &format!("pulley.{}", pulley.name)), keys);
        }
        for tensioner in &self.tensioners {
            tensioner.collect_keys(&join(prefix, &format!("tensioner.{}", tensioner.name)), keys);
        }
        self.operating
            .collect_scalar_keys(&join(prefix, "operating"), keys);
        self.excitation.collect_keys(&join(prefix, "excitation"), keys);
        for condition in &self.conditions {
            condition.collect_scalar_keys(&join(prefix, &format!("condition.{}", condition.name)), keys);
        }
    }
}

/// Value of a key that is not written and then holds.
const fn yes() -> bool {
    true
}

/// Value of a factor that is not written.
const fn one() -> f64 {
    1.0
}
