//! `kind = "two-pulley-clutch"`: a crank drives an accessory over a belt and a wrap-spring one-way clutch
//! (theory 02 §1).

mod check;
mod parameters;
mod read;
mod system;

use schemars::JsonSchema;
use serde::Serialize;

pub use parameters::{DampingRatio, Dimensionless, Parameters, Physical};

use crate::scalar::{Numbers, Scalars, join, split_first};
use crate::smoothing::Smoothing;

/// The two-pulley system with a wrap-spring one-way clutch (theory 02 §1).
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TwoPulleyClutch {
    /// Short name, for titles and result files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Free text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// The parameters, dimensionless or physical.
    #[serde(flatten)]
    pub parameters: Parameters,
    /// Smooth clutch law; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

impl TwoPulleyClutch {
    /// Deflection of the clutch under the accessory load, `delta_s = M/K_d` in radians (theory 02 §1.5).
    pub fn static_deflection(&self) -> f64 {
        match &self.parameters {
            Parameters::Dimensionless(parameters) => parameters.preload / parameters.clutch_stiffness,
            Parameters::Physical(parameters) => parameters.preload / parameters.clutch_stiffness,
        }
    }
}

impl Numbers for TwoPulleyClutch {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match (split_first(path), &mut self.parameters) {
            (("dimensionless", rest), Parameters::Dimensionless(parameters)) => parameters.number_mut(rest),
            (("physical", rest), Parameters::Physical(parameters)) => parameters.number_mut(rest),
            (("smoothing", rest), _) => self.smoothing.as_mut()?.scalar_mut(rest),
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match &self.parameters {
            Parameters::Dimensionless(parameters) => {
                parameters.collect_keys(&join(prefix, "dimensionless"), keys);
            }
            Parameters::Physical(parameters) => {
                parameters.collect_keys(&join(prefix, "physical"), keys);
            }
        }
        if let Some(smoothing) = &self.smoothing {
            smoothing.collect_scalar_keys(&join(prefix, "smoothing"), keys);
        }
    }
}
