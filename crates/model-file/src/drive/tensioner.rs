//! `[[tensioner]]`: an arm on a pivot or a slide, with spring, damping, friction and stops.

use schemars::JsonSchema;
use serde::Serialize;

use super::contact::{PulleyContact, StopContact};
use super::friction::DryFriction;
use crate::scalar::{Absent, Bound, Numbers, Scalars, collect_items, item_mut, join, scalars, split_first};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// A tensioner. Its coordinate is the angle of the arm from +x, counter-clockwise, or the way along the slide.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tensioner {
    /// Name, for results and for key paths.
    pub name: String,
    /// How it moves.
    #[serde(flatten)]
    pub guide: Guide,
    /// The spring; only a locked tensioner needs none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spring: Option<Spring>,
    /// Viscous damping, N m s/rad, or N s/m of a linear tensioner.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
    /// Friction; it acts in motions, not in the linear model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<DryFriction>,
    /// Damping while the belt pushes the tensioner back, N m s/rad, or N s/m of a linear tensioner; it acts in motions.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub one_way_damping: f64,
    /// Smallest and largest position, rad or m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[QuantitySchema; 2]>")]
    pub stops: Option<[f64; 2]>,
    /// What happens in motions at the stops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop_contact: Option<StopContact>,
    /// Pulleys that a carried pulley may touch in motions.
    #[serde(rename = "pulley_contact", default, skip_serializing_if = "Vec::is_empty")]
    pub pulley_contacts: Vec<PulleyContact>,
    /// Where the drag of the carried pulleys reacts.
    #[serde(default)]
    pub bearing_drag: BearingDrag,
    /// Whether it is held at its reference.
    #[serde(default)]
    pub locked: bool,
}

scalars!(Tensioner {
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Value(0.0);
    one_way_damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Value(0.0);
});

/// How a tensioner moves.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Guide {
    /// An arm about a pivot.
    Rotary(Rotary),
    /// Along a line.
    Linear(Linear),
}

/// An arm about a pivot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Rotary {
    /// The pivot `[x, y]`, m.
    #[schemars(with = "[QuantitySchema; 2]")]
    pub pivot: [f64; 2],
    /// Distance from the pivot to the centre of the pulley, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub arm_length: Option<f64>,
    /// Reference position: angle of the arm from +x, counter-clockwise, rad.
    #[schemars(with = "QuantitySchema")]
    pub arm_angle: f64,
    /// Inertia about the pivot, kg m².
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub inertia: f64,
}

scalars!(Rotary {
    arm_length: quantities::LENGTH, Bound::Positive => Absent::Nothing;
    arm_angle: quantities::ANGLE, Bound::Any;
    inertia: quantities::INERTIA, Bound::NotNegative => Absent::Value(0.0);
});

/// A slide.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Linear {
    /// Where the centre of the pulley is at position zero, `[x, y]`, m.
    #[schemars(with = "[QuantitySchema; 2]")]
    pub point: [f64; 2],
    /// Direction in which the position grows.
    pub direction: Direction,
    /// Reference position, m.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub position: f64,
    /// Moving mass, kg.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub mass: f64,
}

scalars!(Linear {
    position: quantities::LENGTH, Bound::Any => Absent::Value(0.0);
    mass: quantities::MASS, Bound::NotNegative => Absent::Value(0.0);
});

/// A direction in the plane.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Direction {
    /// Angle from +x, counter-clockwise, rad.
    Angle(#[schemars(with = "QuantitySchema")] f64),
    /// A vector of any length.
    Vector(#[schemars(with = "[RatioSchema; 2]")] [f64; 2]),
}

/// The spring of a tensioner.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// Rate, N m/rad, or N/m of a linear tensioner.
    #[schemars(with = "QuantitySchema")]
    pub rate: f64,
    /// Torque (N m) or force (N) at the reference position, positive where it tightens the belt; it follows from an
    /// installation with a tension.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub preload: Option<f64>,
}

scalars!(Spring {
    rate: quantities::GENERALISED_STIFFNESS, Bound::NotNegative;
    preload: quantities::GENERALISED_FORCE, Bound::Any => Absent::Nothing;
});

/// Where the drag of the carried pulleys reacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BearingDrag {
    /// On the arm, as with an idler's bearing.
    #[default]
    Arm,
    /// On the ground.
    Ground,
}

impl Guide {
    /// The key of the reference position, and the position: rad or m.
    pub fn reference(&self) -> (&'static str, f64) {
        match self {
            Self::Rotary(rotary) => ("arm_angle", rotary.arm_angle),
            Self::Linear(linear) => ("position", linear.position),
        }
    }
}

impl Numbers for Tensioner {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("spring", rest) => self.spring.as_mut()?.scalar_mut(rest),
            ("friction", rest) => self.friction.as_mut()?.number_mut(rest),
            ("stop_contact", rest) => self.stop_contact.as_mut()?.scalar_mut(rest),
            ("pulley_contact", rest) => {
                let (index, rest) = split_first(rest);
                let contact = self.pulley_contacts.get_mut(index.parse::<usize>().ok()?)?;
                contact.scalar_mut(rest)
            }
            ("stops", rest) => item_mut(self.stops.as_mut()?, rest),
            ("damping", "") => Some(&mut self.damping),
            ("one_way_damping", "") => Some(&mut self.one_way_damping),
            _ => self.guide.number_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        self.guide.collect_keys(prefix, keys);
        if let Some(spring) = &self.spring {
            spring.collect_scalar_keys(&join(prefix, "spring"), keys);
        }
        self.collect_scalar_keys(prefix, keys);
        if let Some(friction) = &self.friction {
            friction.collect_keys(&join(prefix, "friction"), keys);
        }
        if let Some(stops) = &self.stops {
            collect_items(stops, &join(prefix, "stops"), keys);
        }
        if let Some(contact) = &self.stop_contact {
            contact.collect_scalar_keys(&join(prefix, "stop_contact"), keys);
        }
        for (index, contact) in self.pulley_contacts.iter().enumerate() {
            contact.collect_scalar_keys(&join(prefix, &format!("pulley_contact.{index}")), keys);
        }
    }
}

impl Numbers for Guide {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match (self, split_first(path)) {
            (Self::Rotary(rotary), ("pivot", rest)) => item_mut(&mut rotary.pivot, rest),
            (Self::Rotary(rotary), _) => rotary.scalar_mut(path),
            (Self::Linear(linear), ("point", rest)) => item_mut(&mut linear.point, rest),
            (Self::Linear(linear), ("direction", rest)) => match &mut linear.direction {
                Direction::Angle(angle) => rest.is_empty().then_some(angle),
                Direction::Vector(vector) => item_mut(vector, rest),
            },
            (Self::Linear(linear), _) => linear.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match self {
            Self::Rotary(rotary) => {
                collect_items(&rotary.pivot, &join(prefix, "pivot"), keys);
                rotary.collect_scalar_keys(prefix, keys);
            }
            Self::Linear(linear) => {
                collect_items(&linear.point, &join(prefix, "point"), keys);
                let direction = join(prefix, "direction");
                match &linear.direction {
                    Direction::Angle(_) => keys.push(direction),
                    Direction::Vector(vector) => collect_items(vector, &direction, keys),
                }
                linear.collect_scalar_keys(prefix, keys);
            }
        }
    }
}
