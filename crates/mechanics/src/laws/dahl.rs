//! Dahl's friction: an elastic onset of sliding (theory 05 §6.3).

use crate::law::sign;
use crate::law::{Gradient, Law, Memory, MemoryResponse, RegimeTable, Response};

/// `f = σ z`, `z' = v − (σ/T)|v| z`, that is `f' = σ v (1 − f sgn v / T)`: stiffness `σ` at reversals, torque `T` in steady
/// sliding. The internal state `z` is the elastic deflection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dahl {
    stiffness: f64,
    torque: f64,
}

/// The element with `stiffness > 0` and `torque > 0`.
pub fn dahl(stiffness: f64, torque: f64) -> Dahl {
    Dahl { stiffness, torque }
}

impl Memory for Dahl {
    fn evaluate(&self, _: f64, velocity: f64, internal: f64) -> MemoryResponse {
        let decay = self.stiffness / self.torque;
        MemoryResponse {
            force: self.stiffness * internal,
            force_by: Gradient {
                internal: self.stiffness,
                ..Gradient::default()
            },
            rate: velocity - decay * velocity.abs() * internal,
            rate_by: Gradient {
                displacement: 0.0,
                velocity: 1.0 - decay * sign(velocity) * internal,
                internal: -decay * velocity.abs(),
            },
        }
    }

    fn scale(&self) -> f64 {
        self.torque / self.stiffness
    }
}

impl Law for Dahl {
    fn kind(&self) -> &'static str {
        "dahl"
    }

    fn response(&self, _: f64, _: f64) -> Response {
        Response::default()
    }

    fn regimes(&self) -> Option<RegimeTable> {
        None
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }

    fn is_monotone(&self) -> bool {
        false
    }

    fn linearized(&self) -> (f64, f64) {
        (self.stiffness, 0.0)
    }

    fn depends_on_displacement(&self) -> bool {
        false
    }
}
