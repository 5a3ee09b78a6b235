//! `pulley.coupling`: what connects a pulley with the accessory behind it.

use schemars::JsonSchema;
use serde::Serialize;

use crate::scalar::{Absent, Bound, Numbers, Scalars, scalars};
use crate::schema::QuantitySchema;
use crate::units::quantities;

/// What connects a pulley with the accessory behind it. The linear model has the one-way kinds in their locked state.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Coupling {
    /// A rigid shaft.
    Rigid(Rigid),
    /// A clutch on the relative velocity: rigid while it transmits torque, free while the accessory runs ahead.
    OneWay(OneWay),
    /// A clutch on the relative displacement: a spring while it is wound up, free otherwise.
    WrapSpring(Flexible),
    /// A spring and a damper.
    Isolator(Flexible),
    /// A spring and a one-way clutch in series.
    Decoupler(Decoupler),
}

/// Keys of a rigid shaft.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// Inertia of the accessory, kg m².
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub accessory_inertia: f64,
}

scalars!(Rigid {
    accessory_inertia: quantities::INERTIA, Bound::NotNegative => Absent::Value(0.0);
});

/// Keys of a one-way clutch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OneWay {
    /// Inertia of the accessory, kg m².
    #[schemars(with = "QuantitySchema")]
    pub accessory_inertia: f64,
}

scalars!(OneWay {
    accessory_inertia: quantities::INERTIA, Bound::Positive;
});

/// Keys of a wrap spring or an isolator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flexible {
    /// Inertia of the accessory, kg m².
    #[schemars(with = "QuantitySchema")]
    pub accessory_inertia: f64,
    /// Torsional stiffness, N m/rad.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Torsional damping, N m s/rad.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
}

scalars!(Flexible {
    accessory_inertia: quantities::INERTIA, Bound::Positive;
    stiffness: quantities::TORSIONAL_STIFFNESS, Bound::Positive;
    damping: quantities::TORSIONAL_DAMPING, Bound::NotNegative => Absent::Value(0.0);
});

/// Keys of a decoupler.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Decoupler {
    /// Inertia of the accessory, kg m².
    #[schemars(with = "QuantitySchema")]
    pub accessory_inertia: f64,
    /// Torsional stiffness, N m/rad.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Torsional damping, N m s/rad.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
    /// Torque of the spring below which the clutch opens, N m; it does not act in the linear model.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub preload: f64,
}

scalars!(Decoupler {
    accessory_inertia: quantities::INERTIA, Bound::Positive;
    stiffness: quantities::TORSIONAL_STIFFNESS, Bound::Positive;
    damping: quantities::TORSIONAL_DAMPING, Bound::NotNegative => Absent::Value(0.0);
    preload: quantities::TORQUE, Bound::NotNegative => Absent::Value(0.0);
});

impl Coupling {
    /// The word of `kind`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Rigid(_) => "rigid",
            Self::OneWay(_) => "one-way",
            Self::WrapSpring(_) => "wrap-spring",
            Self::Isolator(_) => "isolator",
            Self::Decoupler(_) => "decoupler",
        }
    }
}

impl Numbers for Coupling {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match self {
            Self::Rigid(coupling) => coupling.scalar_mut(path),
            Self::OneWay(coupling) => coupling.scalar_mut(path),
            Self::WrapSpring(coupling) | Self::Isolator(coupling) => coupling.scalar_mut(path),
            Self::Decoupler(coupling) => coupling.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match self {
            Self::Rigid(coupling) => coupling.collect_scalar_keys(prefix, keys),
            Self::OneWay(coupling) => coupling.collect_scalar_keys(prefix, keys),
            Self::WrapSpring(coupling) | Self::Isolator(coupling) => {
                coupling.collect_scalar_keys(prefix, keys)
            }
            Self::Decoupler(coupling) => coupling.collect_scalar_keys(prefix, keys),
        }
    }
}
