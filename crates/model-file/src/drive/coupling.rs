//! `pulley.coupling`: what connects a pulley with the accessory behind it.

use schemars::JsonSchema;
use serde::Serialize;

use crate::scalar::{Absent, Bound, scalars};
use crate::schema::QuantitySchema;
use crate::units::quantities;

/// What connects a pulley with the accessory behind it. The linear model has the one-way kinds in their locked state; in
/// motions they open and lock.
///
/// All kinds have the same keys, so that a change of `kind` compares them; a key that the kind does not use is remarked.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// What it does.
    pub kind: CouplingKind,
    /// Inertia of the accessory, kg m².
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub accessory_inertia: f64,
    /// Viscous friction of the accessory's own bearing, N m s/rad.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub accessory_damping: f64,
    /// Torsional stiffness, N m/rad; needed by wrap springs, isolators and decouplers.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub stiffness: Option<f64>,
    /// Torsional damping of the same, N m s/rad; zero if it is not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub damping: Option<f64>,
    /// Torque with which a decoupler's spring rests against its stop, N m; up to it the decoupler is rigid. It does not act in
    /// the linear model.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub preload: Option<f64>,
}

scalars!(Coupling {
    accessory_inertia: quantities::INERTIA, Bound::NotNegative => Absent::Value(0.0);
    accessory_damping: quantities::TORSIONAL_DAMPING, Bound::NotNegative => Absent::Value(0.0);
    stiffness: quantities::TORSIONAL_STIFFNESS, Bound::Positive => Absent::Nothing;
    damping: quantities::TORSIONAL_DAMPING, Bound::NotNegative => Absent::Nothing;
    preload: quantities::TORQUE, Bound::NotNegative => Absent::Nothing;
});

/// What a coupling does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CouplingKind {
    /// A rigid shaft.
    Rigid,
    /// A clutch on the relative velocity: rigid while it transmits torque, free while the accessory runs ahead.
    OneWay,
    /// A clutch on the relative displacement: a spring while it is wound up, free otherwise.
    WrapSpring,
    /// A spring and a damper.
    Isolator,
    /// A spring and a one-way clutch in series.
    Decoupler,
}

impl CouplingKind {
    /// The words of the file.
    pub(super) const WORDS: [(&'static str, Self); 5] = [
        ("rigid", Self::Rigid),
        ("one-way", Self::OneWay),
        ("wrap-spring", Self::WrapSpring),
        ("isolator", Self::Isolator),
        ("decoupler", Self::Decoupler),
    ];

    /// The word of the file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::OneWay => "one-way",
            Self::WrapSpring => "wrap-spring",
            Self::Isolator => "isolator",
            Self::Decoupler => "decoupler",
        }
    }

    /// Whether it has a spring while it transmits torque.
    pub fn is_flexible(self) -> bool {
        match self {
            Self::Rigid | Self::OneWay => false,
            Self::WrapSpring | Self::Isolator | Self::Decoupler => true,
        }
    }
}
