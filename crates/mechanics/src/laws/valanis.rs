//! Valanis' model of a joint with micro-slip (theory 05 §6.3).

use crate::law::sign;
use crate::law::{Gradient, Law, Memory, MemoryResponse, RegimeTable, Response};

/// Parameters outside their ranges.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} is {value}, but must be {range}")]
pub struct ValanisError {
    /// Name of the parameter.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// What is allowed.
    pub range: &'static str,
}

/// `f' = E₀ v (1 + λ s x)/(1 + κ λ s x)` with `x = E_t u − f`, `s = sgn v`: stiffness `E₀` at reversals, slope `E_t` in gross
/// slip, where `f = E_t u ± T`; `λ = (E₀ − E_t)/((E₀ − κ E_t) T)`. The sharper the onset of slip the nearer is `κ` to one. The
/// internal state is the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Valanis {
    stiffness: f64,
    slip_stiffness: f64,
    torque: f64,
    sharpness: f64,
}

impl Valanis {
    /// The element with `stiffness` `E₀ > 0`, `slip_stiffness` `0 ≤ E_t < E₀`, `torque` `T > 0` and `sharpness` `0 ≤ κ < 1`.
    ///
    /// # Errors
    /// [`ValanisError`] naming the first parameter outside its range.
    pub fn new(
        stiffness: f64,
        slip_stiffness: f64,
        torque: f64,
        sharpness: f64,
    ) -> Result<Self, ValanisError> {
        let fault = |name, value, range| Err(ValanisError { name, value, range });
        if !(stiffness.is_finite() && stiffness > 0.0) {
            return fault("the stiffness", stiffness, "positive");
        }
        if !(0.0..stiffness).contains(&slip_stiffness) {
            return fault(
                "the stiffness in slip",
                slip_stiffness,
                "not negative and below the stiffness",
            );
        }
        if !(torque.is_finite() && torque > 0.0) {
            return fault("the torque", torque, "positive");
        }
        if !(0.0..1.0).contains(&sharpness) {
            return fault("the sharpness", sharpness, "not negative and below one");
        }
        Ok(Self {
            stiffness,
            slip_stiffness,
            torque,
            sharpness,
        })
    }
}

impl Memory for Valanis {
    fn evaluate(&self, displacement: f64, velocity: f64, internal: f64) -> MemoryResponse {
        let s = sign(velocity);
        let (stiffness, slope) = (self.stiffness, self.slip_stiffness);
        let lambda = (stiffness - slope) / ((stiffness - self.sharpness * slope) * self.torque);
        let y = lambda * s * (slope * displacement - internal);
        let denominator = 1.0 + self.sharpness * y;
        let tangent = stiffness * (1.0 + y) / denominator;
        let by_y = stiffness * (1.0 - self.sharpness) / (denominator * denominator);
        let by_internal = -lambda * velocity.abs() * by_y;
        MemoryResponse {
            force: internal,
            force_by: Gradient {
                internal: 1.0,
                ..Gradient::default()
            },
            rate: velocity * tangent,
            rate_by: Gradient {
                displacement: -slope * by_internal,
                velocity: tangent,
                internal: by_internal,
            },
        }
    }

    fn scale(&self) -> f64 {
        self.torque
    }
}

impl Law for Valanis {
    fn kind(&self) -> &'static str {
        "valanis"
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
}
