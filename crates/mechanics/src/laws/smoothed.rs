//! Smoothed forms of a piecewise-linear law (theory 02 §4).

use super::PiecewiseLinear;
use crate::law::{Law, RegimeTable, Response};
use std::f64::consts::PI;

/// The function that replaces the hinge `max(x, 0)`; `ε` is a width in the unit of `x`, and `w = x/ε`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Smoothing {
    /// `x (1 + tanh w)/2` (2.6).
    Tanh,
    /// `x (1/2 + atan(w)/π)`: only first-order accurate in `ε`, it leaves a constant force on both sides.
    Arctan,
    /// `(x + ε ln(2 cosh w))/2`.
    Cosh,
    /// `ε (w + 1)²/4` for `|w| < 1`: once continuously differentiable.
    Quadratic,
    /// `ε (−w⁴ + 6w² + 8w + 3)/16` for `|w| < 1`: twice continuously differentiable.
    Quartic,
}

impl Smoothing {
    /// All kinds.
    pub const ALL: [Self; 5] = [
        Self::Tanh,
        Self::Arctan,
        Self::Cosh,
        Self::Quadratic,
        Self::Quartic,
    ];

    /// Value and slope of the smoothed hinge at `x` for width `ε > 0`.
    pub fn hinge(self, x: f64, width: f64) -> (f64, f64) {
        let w = x / width;
        match self {
            Self::Tanh => {
                let t = w.tanh();
                (0.5 * x * (1.0 + t), 0.5 * (1.0 + t) + 0.5 * w * (1.0 - t * t))
            }
            Self::Arctan => {
                let share = 0.5 + w.atan() / PI;
                (x * share, share + w / (PI * (1.0 + w * w)))
            }
            Self::Cosh => {
                let log_two_cosh = w.abs() + (-2.0 * w.abs()).exp().ln_1p();
                (0.5 * (x + width * log_two_cosh), 0.5 * (1.0 + w.tanh()))
            }
            Self::Quadratic | Self::Quartic if w <= -1.0 => (0.0, 0.0),
            Self::Quadratic | Self::Quartic if w >= 1.0 => (x, 1.0),
            Self::Quadratic => (0.25 * width * (w + 1.0).powi(2), 0.5 * (w + 1.0)),
            Self::Quartic => {
                let square = w * w;
                (
                    width * (-square * square + 6.0 * square + 8.0 * w + 3.0) / 16.0,
                    0.25 * (-w * square + 3.0 * w + 2.0),
                )
            }
        }
    }

    /// Value and slope of the smooth step that replaces the sign of `x`, from −1 to 1: `tanh w`, `(2/π) atan w`, and for the
    /// other kinds the step whose integral is their hinge, `2 hinge' − 1`.
    pub fn step(self, x: f64, width: f64) -> (f64, f64) {
        let w = x / width;
        match self {
            Self::Tanh | Self::Cosh => {
                let t = w.tanh();
                (t, (1.0 - t * t) / width)
            }
            Self::Arctan => (2.0 / PI * w.atan(), 2.0 / (PI * width * (1.0 + w * w))),
            Self::Quadratic | Self::Quartic if w.abs() >= 1.0 => (w.signum(), 0.0),
            Self::Quadratic => (w, 1.0 / width),
            Self::Quartic => (0.5 * w * (3.0 - w * w), 1.5 * (1.0 - w * w) / width),
        }
    }

    /// The constant `κ` of the leading error `κ ε²` of every response quantity; `None` for arctan, whose error is of first
    /// order.
    pub fn error_constant(self) -> Option<f64> {
        match self {
            Self::Tanh => Some(-PI * PI / 24.0),
            Self::Arctan => None,
            Self::Cosh => Some(PI * PI / 24.0),
            Self::Quadratic => Some(1.0 / 6.0),
            Self::Quartic => Some(1.0 / 10.0),
        }
    }

    /// The name in model files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tanh => "tanh",
            Self::Arctan => "arctan",
            Self::Cosh => "cosh",
            Self::Quadratic => "quadratic",
            Self::Quartic => "quartic",
        }
    }
}

/// A piecewise-linear law with every hinge replaced by a smooth one of width `ε`.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    exact: PiecewiseLinear,
    smoothing: Smoothing,
    width: f64,
}

impl Smoothed {
    /// The law `exact` smoothed over `width > 0`, in the unit of its argument.
    pub fn new(exact: PiecewiseLinear, smoothing: Smoothing, width: f64) -> Self {
        Self {
            exact,
            smoothing,
            width,
        }
    }

    /// The law that is smoothed.
    pub fn exact(&self) -> &PiecewiseLinear {
        &self.exact
    }

    /// Kind and width of the smoothing.
    pub fn smoothing(&self) -> (Smoothing, f64) {
        (self.smoothing, self.width)
    }
}

impl Law for Smoothed {
    fn kind(&self) -> &'static str {
        self.exact.name()
    }

    fn response(&self, displacement: f64, velocity: f64) -> Response {
        let x = match self.exact.variable() {
            super::Variable::Displacement => displacement,
            super::Variable::Velocity => velocity,
        };
        let slopes = self.exact.slopes();
        let mut force = slopes[0] * x;
        let mut slope = slopes[0];
        for (i, &breakpoint) in self.exact.breakpoints().iter().enumerate() {
            let change = slopes[i + 1] - slopes[i];
            let (value, rate) = self.smoothing.hinge(x - breakpoint, self.width);
            force += change * (value - (-breakpoint).max(0.0));
            slope += change * rate;
        }
        self.exact.response_of(force, slope)
    }

    fn regimes(&self) -> Option<RegimeTable> {
        None
    }

    fn is_monotone(&self) -> bool {
        false
    }

    fn linearized(&self) -> (f64, f64) {
        self.exact.linearized()
    }

    fn depends_on_displacement(&self) -> bool {
        self.exact.depends_on_displacement()
    }
}
