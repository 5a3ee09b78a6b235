//! The LuGre model: bristles that deflect and slip, with Stribeck's fall of friction with velocity (theory 05 §6.3).

use crate::law::sign;
use crate::law::{Gradient, Law, Memory, MemoryResponse, RegimeTable, Response};

/// Friction in steady sliding, `g(v) = T + (r − 1) T e^{−(v/v_s)²}`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stribeck {
    /// Torque `T > 0` of fast sliding.
    pub torque: f64,
    /// Ratio `r ≥ 1` of the torque of very slow sliding to `T`.
    pub static_ratio: f64,
    /// Velocity `v_s > 0` over which it falls.
    pub velocity: f64,
}

impl Stribeck {
    /// Value and slope.
    fn at(&self, velocity: f64) -> (f64, f64) {
        let w = velocity / self.velocity;
        let fall = (self.static_ratio - 1.0) * self.torque * (-w * w).exp();
        (self.torque + fall, -2.0 * w / self.velocity * fall)
    }
}

/// `f = σ₀ z + σ₁ z' + σ₂ v`, `z' = v − σ₀ |v| z / g(v)`. The internal state `z` is the mean deflection of the bristles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LuGre {
    /// Stiffness `σ₀ > 0` of the bristles.
    pub stiffness: f64,
    /// Damping `σ₁ ≥ 0` of the bristles.
    pub damping: f64,
    /// Viscous coefficient `σ₂ ≥ 0`.
    pub viscous: f64,
    /// Friction in steady sliding.
    pub stribeck: Stribeck,
}

impl Memory for LuGre {
    fn evaluate(&self, _: f64, velocity: f64, internal: f64) -> MemoryResponse {
        let (sliding, sliding_slope) = self.stribeck.at(velocity);
        let decay = self.stiffness * velocity.abs() / sliding;
        let decay_slope =
            self.stiffness * (sign(velocity) - velocity.abs() * sliding_slope / sliding) / sliding;
        let rate = velocity - decay * internal;
        let rate_by = Gradient {
            displacement: 0.0,
            velocity: 1.0 - decay_slope * internal,
            internal: -decay,
        };
        MemoryResponse {
            force: self.stiffness * internal + self.damping * rate + self.viscous * velocity,
            force_by: Gradient {
                displacement: 0.0,
                velocity: self.damping * rate_by.velocity + self.viscous,
                internal: self.stiffness + self.damping * rate_by.internal,
            },
            rate,
            rate_by,
        }
    }

    fn scale(&self) -> f64 {
        self.stribeck.static_ratio * self.stribeck.torque / self.stiffness
    }
}

impl Law for LuGre {
    fn kind(&self) -> &'static str {
        "lugre"
    }

    fn response(&self, displacement: f64, velocity: f64) -> Response {
        let response = self.evaluate(displacement, velocity, 0.0);
        Response {
            force: response.force,
            by_displacement: 0.0,
            by_velocity: response.force_by.velocity,
        }
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
        (self.stiffness, self.damping + self.viscous)
    }

    fn depends_on_displacement(&self) -> bool {
        false
    }
}
