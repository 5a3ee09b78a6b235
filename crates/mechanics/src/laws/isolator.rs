//! A linear spring-damper between pulley and shaft.

use crate::law::{Law, Piece, Regime, RegimeTable, Response};

/// `f = stiffness · u + damping · v`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isolator {
    /// Force per displacement.
    pub stiffness: f64,
    /// Force per velocity.
    pub damping: f64,
}

impl Law for Isolator {
    fn kind(&self) -> &'static str {
        "isolator"
    }

    fn response(&self, displacement: f64, velocity: f64) -> Response {
        Response {
            force: self.stiffness * displacement + self.damping * velocity,
            by_displacement: self.stiffness,
            by_velocity: self.damping,
        }
    }

    fn regimes(&self) -> Option<RegimeTable> {
        let piece = Piece::Affine {
            constant: 0.0,
            displacement: self.stiffness,
            velocity: self.damping,
            internal: 0.0,
        };
        let regime = Regime::new("linear", true, piece, Vec::new());
        Some(RegimeTable::of_function(vec![regime]))
    }

    fn is_monotone(&self) -> bool {
        self.stiffness == 0.0 && self.damping >= 0.0
    }

    fn linearized(&self) -> (f64, f64) {
        (self.stiffness, self.damping)
    }
}
