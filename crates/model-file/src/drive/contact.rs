//! What happens when a tensioner meets a stop or another pulley.

use schemars::JsonSchema;
use serde::Serialize;

use crate::scalar::{Absent, Bound, scalars};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// A contact: an impact with a `restitution`, or a spring with `stiffness` and perhaps `damping` that push but do not pull.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StopContact {
    /// Coefficient of restitution of a rigid contact, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<RatioSchema>")]
    pub restitution: Option<f64>,
    /// Stiffness of a compliant contact, N m/rad, or N/m of a linear tensioner.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub stiffness: Option<f64>,
    /// Damping of a compliant contact, N m s/rad, or N s/m of a linear tensioner.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub damping: Option<f64>,
}

scalars!(StopContact {
    restitution: quantities::NUMBER, Bound::Share => Absent::Nothing;
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive => Absent::Nothing;
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Nothing;
});

/// A pulley that a pulley on the tensioner may touch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PulleyContact {
    /// Name of the pulley that may be touched.
    pub pulley: String,
    /// Name of the pulley on the tensioner that may touch it; needed if the tensioner carries several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carried: Option<String>,
    /// Thickness of the belt between the two pitch circles where they touch, m.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub belt_thickness: f64,
    /// Coefficient of restitution of a rigid contact, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<RatioSchema>")]
    pub restitution: Option<f64>,
    /// Stiffness of a compliant contact, N/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub stiffness: Option<f64>,
    /// Damping of a compliant contact, N s/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub damping: Option<f64>,
}

scalars!(PulleyContact {
    belt_thickness: quantities::LENGTH, Bound::Any => Absent::Value(0.0);
    restitution: quantities::NUMBER, Bound::Share => Absent::Nothing;
    stiffness: quantities::STIFFNESS, Bound::Positive => Absent::Nothing;
    damping: quantities::DAMPING, Bound::NotNegative => Absent::Nothing;
});

impl PulleyContact {
    /// The contact without what touches.
    pub(super) fn contact(&self) -> StopContact {
        StopContact {
            restitution: self.restitution,
            stiffness: self.stiffness,
            damping: self.damping,
        }
    }
}
