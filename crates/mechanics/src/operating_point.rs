//! Systems that depend on one parameter: what branches are followed in.

use crate::System;
use std::sync::Arc;

/// A system together with the fundamental frequency `Ω` of its load.
#[derive(Debug, Clone)]
pub struct OperatingPoint {
    /// The system.
    pub system: Arc<System>,
    /// Fundamental frequency of the load, radians per unit of time, positive.
    pub frequency: f64,
}

/// Why there is no system at a parameter value, in words for the user.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct OutsideDomain(pub String);

/// Systems that depend smoothly on one parameter: the frequency of the load, or any key of a model.
pub trait SystemFamily: Send + Sync {
    /// The system and its frequency at a parameter value.
    ///
    /// # Errors
    /// [`OutsideDomain`] where the parameter describes no system.
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain>;

    /// Whether the parameter is the frequency `Ω` itself and the system does not otherwise change, so that derivatives
    /// are known in closed form.
    fn is_frequency(&self) -> bool;
}

/// One system under a load of varying frequency; the parameter is `Ω`.
#[derive(Debug, Clone)]
pub struct FrequencyFamily {
    system: Arc<System>,
}

impl FrequencyFamily {
    /// The family of one system over frequency.
    pub fn new(system: Arc<System>) -> Self {
        Self { system }
    }
}

impl SystemFamily for FrequencyFamily {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        if !(parameter.is_finite() && parameter > 0.0) {
            return Err(OutsideDomain(format!(
                "the frequency must be positive, but is {parameter}"
            )));
        }
        Ok(OperatingPoint {
            system: self.system.clone(),
            frequency: parameter,
        })
    }

    fn is_frequency(&self) -> bool {
        true
    }
}
