//! `[operating]` and `[[condition]]`: in what service the drive is examined.

use schemars::JsonSchema;
use serde::Serialize;

use super::one;
use crate::scalar::{Absent, Bound, scalars};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// The operating point.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Operating {
    /// Speed of the driver, rad/s.
    #[schemars(with = "QuantitySchema")]
    pub speed: f64,
    /// Sense in which the driver turns; without it the sense in which the belt can follow the pulleys.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
}

scalars!(Operating {
    speed: quantities::ROTATIONAL_SPEED, Bound::NotNegative;
});

/// Sense of rotation, seen with +x to the right and +y up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rotation {
    /// Against the clock.
    CounterClockwise,
    /// With the clock.
    Clockwise,
}

/// What differs from the drive as installed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// Name, for results and for key paths.
    pub name: String,
    /// Temperature above that of the installation, K.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub temperature_change: f64,
    /// Change of the belt's natural length, m: a tolerance of manufacture.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub length_change: f64,
    /// Lasting elongation of the belt as a strain: wear.
    #[serde(default)]
    #[schemars(with = "RatioSchema")]
    pub elongation: f64,
    /// Thermal expansion of the structure that holds the pulleys, 1/K.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub structure_expansion: f64,
    /// Factor on the torque of every tensioner's spring.
    #[serde(default = "one")]
    #[schemars(with = "RatioSchema")]
    pub spring_factor: f64,
}

scalars!(Condition {
    temperature_change: quantities::TEMPERATURE_CHANGE, Bound::Any => Absent::Value(0.0);
    length_change: quantities::LENGTH, Bound::Any => Absent::Value(0.0);
    elongation: quantities::NUMBER, Bound::Any => Absent::Value(0.0);
    structure_expansion: quantities::THERMAL_EXPANSION, Bound::Any => Absent::Value(0.0);
    spring_factor: quantities::NUMBER, Bound::Positive => Absent::Value(1.0);
});
