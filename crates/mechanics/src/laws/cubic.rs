//! A hardening or softening spring: the standard smooth nonlinearity.

use crate::law::{Law, RegimeTable, Response};

/// `f = linear · u + cubic · u³`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// Force per displacement at `u = 0`.
    pub linear: f64,
    /// Force per displacement cubed.
    pub cubic: f64,
}

impl Law for Cubic {
    fn kind(&self) -> &'static str {
        "cubic"
    }

    fn response(&self, displacement: f64, _velocity: f64) -> Response {
        let square = displacement * displacement;
        Response {
            force: displacement * (self.linear + self.cubic * square),
            by_displacement: self.linear + 3.0 * self.cubic * square,
            by_velocity: 0.0,
        }
    }

    fn regimes(&self) -> Option<RegimeTable> {
        None
    }

    fn is_monotone(&self) -> bool {
        false
    }

    fn linearized(&self) -> (f64, f64) {
        (self.linear, 0.0)
    }
}
