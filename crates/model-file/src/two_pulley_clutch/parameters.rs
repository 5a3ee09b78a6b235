//! The parameters of the two-pulley system, dimensionless (theory 02 §1.3) or in physical units (theory 02 §1.2).

use schemars::JsonSchema;
use serde::Serialize;

use crate::scalar::{Bound, Numbers, Scalars, join, scalars, split_first};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// Exactly one of the two forms of the same system.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Parameters {
    /// Dimensionless parameters; time is measured in units of `1/omega_0` (theory 02 §1.3).
    Dimensionless(Dimensionless),
    /// Parameters in physical units.
    Physical(Physical),
}

/// Dimensionless parameters (theory 02 §1.3).
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dimensionless {
    /// Ratio of the inertias of accessory and pulley, `alpha = J_a/J_p`.
    #[schemars(with = "RatioSchema")]
    pub inertia_ratio: f64,
    /// Ratio of the radii of crank and pulley, `beta = r_cs/r_p`.
    #[schemars(with = "RatioSchema")]
    pub radius_ratio: f64,
    /// Stiffness of the belt `K_b`, in units of `J_p omega_0^2`.
    #[schemars(with = "RatioSchema")]
    pub belt_stiffness: f64,
    /// Stiffness of the engaged clutch spring `K_d`, in units of `J_p omega_0^2`.
    #[schemars(with = "RatioSchema")]
    pub clutch_stiffness: f64,
    /// Constant load of the accessory `M`, in units of `J_p omega_0^2`.
    #[schemars(with = "RatioSchema")]
    pub preload: f64,
    /// Amplitude of the crank's rotation `A_m` in radians.
    #[schemars(with = "QuantitySchema")]
    pub crank_amplitude: f64,
    /// Damping ratio of the engaged modes: one number for both, or one for each.
    pub damping_ratio: DampingRatio,
}

scalars!(Dimensionless {
    inertia_ratio: quantities::NUMBER, Bound::Positive;
    radius_ratio: quantities::NUMBER, Bound::Positive;
    belt_stiffness: quantities::NUMBER, Bound::Positive;
    clutch_stiffness: quantities::NUMBER, Bound::Positive;
    preload: quantities::NUMBER, Bound::Positive, "no preload: the clutch has no engaged equilibrium";
    crank_amplitude: quantities::ANGLE, Bound::NotNegative;
});

/// Parameters in physical units (theory 02 §1.2).
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Physical {
    /// Inertia of the pulley `J_p`, kg m².
    #[schemars(with = "QuantitySchema")]
    pub pulley_inertia: f64,
    /// Inertia of the accessory `J_a`, kg m².
    #[schemars(with = "QuantitySchema")]
    pub accessory_inertia: f64,
    /// Pitch radius of the pulley `r_p`, m.
    #[schemars(with = "QuantitySchema")]
    pub pulley_radius: f64,
    /// Pitch radius of the crank pulley `r_cs`, m.
    #[schemars(with = "QuantitySchema")]
    pub crank_radius: f64,
    /// Resultant tangential stiffness of the spans, N/m.
    #[schemars(with = "QuantitySchema")]
    pub belt_stiffness: f64,
    /// Stiffness of the engaged clutch spring, N m/rad.
    #[schemars(with = "QuantitySchema")]
    pub clutch_stiffness: f64,
    /// Constant torque of the accessory, N m.
    #[schemars(with = "QuantitySchema")]
    pub preload: f64,
    /// Amplitude of the crank's rotation `A_m`, rad.
    #[schemars(with = "QuantitySchema")]
    pub crank_amplitude: f64,
    /// Damping ratio of the engaged modes: one number for both, or one for each.
    pub damping_ratio: DampingRatio,
}

scalars!(Physical {
    pulley_inertia: quantities::INERTIA, Bound::Positive;
    accessory_inertia: quantities::INERTIA, Bound::Positive;
    pulley_radius: quantities::LENGTH, Bound::Positive;
    crank_radius: quantities::LENGTH, Bound::Positive;
    belt_stiffness: quantities::STIFFNESS, Bound::Positive;
    clutch_stiffness: quantities::TORSIONAL_STIFFNESS, Bound::Positive;
    preload: quantities::TORQUE, Bound::Positive, "no preload: the clutch has no engaged equilibrium";
    crank_amplitude: quantities::ANGLE, Bound::NotNegative;
});

impl Numbers for Dimensionless {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("damping_ratio", rest) => self.damping_ratio.number_mut(rest),
            _ => self.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        self.collect_scalar_keys(prefix, keys);
        self.damping_ratio
            .collect_keys(&join(prefix, "damping_ratio"), keys);
    }
}

impl Numbers for Physical {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("damping_ratio", rest) => self.damping_ratio.number_mut(rest),
            _ => self.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        self.collect_scalar_keys(prefix, keys);
        self.damping_ratio
            .collect_keys(&join(prefix, "damping_ratio"), keys);
    }
}

/// Damping ratios of the two modes of the engaged system (theory 02 §1.7).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum DampingRatio {
    /// The same for both modes.
    Common(#[schemars(with = "RatioSchema")] f64),
    /// Of the first and of the second mode.
    Each(#[schemars(with = "[RatioSchema; 2]")] [f64; 2]),
}

impl Default for DampingRatio {
    fn default() -> Self {
        Self::Common(0.0)
    }
}

impl DampingRatio {
    /// Damping ratios of the first and second mode.
    pub fn of_modes(self) -> [f64; 2] {
        match self {
            Self::Common(ratio) => [ratio, ratio],
            Self::Each(ratios) => ratios,
        }
    }

    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match (self, path) {
            (Self::Common(ratio), "") => Some(ratio),
            (Self::Each(ratios), "0") => Some(&mut ratios[0]),
            (Self::Each(ratios), "1") => Some(&mut ratios[1]),
            _ => None,
        }
    }

    fn collect_keys(self, path: &str, keys: &mut Vec<String>) {
        match self {
            Self::Common(_) => keys.push(path.to_owned()),
            Self::Each(_) => keys.extend([join(path, "0"), join(path, "1")]),
        }
    }
}
