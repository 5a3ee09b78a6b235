//! `tensioner.friction`: friction of a tensioner that depends on the direction of its motion.

use schemars::JsonSchema;
use serde::Serialize;

use crate::scalar::{Absent, Bound, Numbers, Scalars, collect_items, item_mut, join, scalars, split_first};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// Friction of a tensioner. It acts in motions, not in the steady state and the linear model.
///
/// All laws have the same keys, so that a change of `law` compares them; a key that the law does not use is remarked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DryFriction {
    /// What it does.
    #[serde(default)]
    pub law: FrictionLaw,
    /// Friction torque of a rotary tensioner, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub torque: Option<f64>,
    /// Friction force of a linear tensioner, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub force: Option<f64>,
    /// Friction while the belt pushes the tensioner back against its spring, N m or N.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub loading: Option<f64>,
    /// Friction while the spring moves the tensioner and tightens the belt, N m or N.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub unloading: Option<f64>,
    /// Ratio of the friction at rest to that in motion, at least 1.
    #[serde(default = "super::one")]
    #[schemars(with = "RatioSchema")]
    pub static_ratio: f64,
    /// Stiffness with which a spring-slider, Dahl or LuGre friction gives before it slides, N m/rad or N/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub stiffness: Option<f64>,
    /// Damping of the bristles of LuGre friction, N m s/rad or N s/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub damping: Option<f64>,
    /// Viscous friction of LuGre friction, N m s/rad or N s/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub viscous: Option<f64>,
    /// Velocity over which LuGre friction falls from that at rest, rad/s or m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub stribeck_velocity: Option<f64>,
    /// The loop of a test bench.
    #[serde(rename = "loop", skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredLoop>,
}

scalars!(DryFriction {
    torque: quantities::TORQUE, Bound::NotNegative => Absent::Nothing;
    force: quantities::FORCE, Bound::NotNegative => Absent::Nothing;
    loading: quantities::GENERALISED_FORCE, Bound::NotNegative => Absent::Nothing;
    unloading: quantities::GENERALISED_FORCE, Bound::NotNegative => Absent::Nothing;
    static_ratio: quantities::NUMBER, Bound::Positive => Absent::Value(1.0);
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive => Absent::Nothing;
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Nothing;
    viscous: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Nothing;
    stribeck_velocity: quantities::RATE, Bound::Positive => Absent::Nothing;
});

/// What the friction of a tensioner does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionLaw {
    /// Dry friction: constant in each direction, anything in between at rest.
    #[default]
    Coulomb,
    /// Dry friction behind a spring.
    SpringSlider,
    /// Friction that builds up gradually over the way.
    Dahl,
    /// Friction of elastic bristles, with a maximum at slow motion.
    Lugre,
    /// The loop of a test bench.
    MeasuredLoop,
}

impl FrictionLaw {
    /// The words of the file.
    pub(super) const WORDS: [(&'static str, Self); 5] = [
        ("coulomb", Self::Coulomb),
        ("spring-slider", Self::SpringSlider),
        ("dahl", Self::Dahl),
        ("lugre", Self::Lugre),
        ("measured-loop", Self::MeasuredLoop),
    ];

    /// The word of the file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Coulomb => "coulomb",
            Self::SpringSlider => "spring-slider",
            Self::Dahl => "dahl",
            Self::Lugre => "lugre",
            Self::MeasuredLoop => "measured-loop",
        }
    }
}

/// Torque of a tensioner, spring and friction together, over its whole stroke, positive where it tightens the belt.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredLoop {
    /// Positions of the tensioner, ascending, rad or m.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub position: Vec<f64>,
    /// Torque while the belt pushes the tensioner back, at these positions, N m or N.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub loading: Vec<f64>,
    /// Torque while the spring tightens the belt, N m or N.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub unloading: Vec<f64>,
}

impl MeasuredLoop {
    fn lists(&self) -> [(&'static str, &Vec<f64>); 3] {
        [
            ("position", &self.position),
            ("loading", &self.loading),
            ("unloading", &self.unloading),
        ]
    }
}

impl Numbers for DryFriction {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("loop", rest) => {
                let measured = self.measured.as_mut()?;
                let (list, rest) = split_first(rest);
                let list = match list {
                    "position" => &mut measured.position,
                    "loading" => &mut measured.loading,
                    "unloading" => &mut measured.unloading,
                    _ => return None,
                };
                item_mut(list, rest)
            }
            _ => self.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        self.collect_scalar_keys(prefix, keys);
        for (key, list) in self.measured.iter().flat_map(MeasuredLoop::lists) {
            collect_items(list, &join(&join(prefix, "loop"), key), keys);
        }
    }
}
