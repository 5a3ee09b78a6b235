//! A continuous piecewise-linear graph of displacement or velocity: the table behind clutch, backlash, stop and damper.

use crate::law::{Guard, Law, Piece, Regime, RegimeTable, Response, Transition};

/// The argument of a piecewise-linear graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// `f = f(u)`: a spring.
    Displacement,
    /// `f = f(v)`: a damper.
    Velocity,
}

/// A continuous piecewise-linear law through the origin: slope `slopes[i]` between `breakpoints[i−1]` and `breakpoints[i]`.
///
/// With `x` the argument and `h(x) = max(x, 0)`:
/// `f(x) = slopes[0] x + Σ_i (slopes[i+1] − slopes[i]) (h(x − x_i) − h(−x_i))`.
#[derive(Debug, Clone, PartialEq)]
pub struct PiecewiseLinear {
    kind: &'static str,
    variable: Variable,
    breakpoints: Vec<f64>,
    slopes: Vec<f64>,
    names: Vec<&'static str>,
    linear_piece: usize,
}

/// Why a piecewise-linear graph is not sound.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PiecewiseLinearError {
    /// The numbers of slopes and breakpoints do not fit.
    #[error("{breakpoints} breakpoints need {} slopes, but {slopes} are given", breakpoints + 1)]
    Count {
        /// Breakpoints given.
        breakpoints: usize,
        /// Slopes given.
        slopes: usize,
    },
    /// Breakpoints must rise.
    #[error("breakpoints must be finite and strictly rising, but {0} is not above its predecessor")]
    Order(f64),
    /// A slope is not finite.
    #[error("slopes must be finite, but one is {0}")]
    Slope(f64),
}

/// Names of regimes of a graph that its law does not name itself.
const NUMBERED: [&str; 8] = [
    "piece 1", "piece 2", "piece 3", "piece 4", "piece 5", "piece 6", "piece 7", "piece 8",
];

impl PiecewiseLinear {
    /// A general graph. Its linearisation is the piece that holds the origin.
    ///
    /// # Errors
    /// [`PiecewiseLinearError`] if the numbers do not describe a graph.
    pub fn new(
        variable: Variable,
        breakpoints: Vec<f64>,
        slopes: Vec<f64>,
    ) -> Result<Self, PiecewiseLinearError> {
        if slopes.len() != breakpoints.len() + 1 {
            return Err(PiecewiseLinearError::Count {
                breakpoints: breakpoints.len(),
                slopes: slopes.len(),
            });
        }
        if let Some(bad) = breakpoints.iter().find(|x| !x.is_finite()) {
            return Err(PiecewiseLinearError::Order(*bad));
        }
        if let Some(pair) = breakpoints.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(PiecewiseLinearError::Order(pair[1]));
        }
        if let Some(bad) = slopes.iter().find(|k| !k.is_finite()) {
            return Err(PiecewiseLinearError::Slope(*bad));
        }
        let names = (0..slopes.len())
            .map(|i| NUMBERED.get(i).copied().unwrap_or("piece 9+"))
            .collect();
        let linear_piece = breakpoints.iter().filter(|&&x| x < 0.0).count();
        Ok(Self {
            kind: "piecewise-linear",
            variable,
            breakpoints,
            slopes,
            names,
            linear_piece,
        })
    }

    /// A graph whose law has a name of its own; the laws of this module guarantee sound numbers.
    pub(super) fn named(
        kind: &'static str,
        variable: Variable,
        breakpoints: Vec<f64>,
        slopes: Vec<f64>,
        names: Vec<&'static str>,
        linear_piece: usize,
    ) -> Self {
        debug_assert_eq!(slopes.len(), breakpoints.len() + 1);
        debug_assert_eq!(slopes.len(), names.len());
        Self {
            kind,
            variable,
            breakpoints,
            slopes,
            names,
            linear_piece,
        }
    }

    /// The kind as model files call it.
    pub(super) fn name(&self) -> &'static str {
        self.kind
    }

    /// The argument of the graph.
    pub fn variable(&self) -> Variable {
        self.variable
    }

    /// The breakpoints, rising.
    pub fn breakpoints(&self) -> &[f64] {
        &self.breakpoints
    }

    /// The slopes, one more than breakpoints.
    pub fn slopes(&self) -> &[f64] {
        &self.slopes
    }

    fn piece_of(&self, x: f64) -> usize {
        self.breakpoints.iter().filter(|&&b| x > b).count()
    }

    /// Force at the origin side constant of a piece: `f = constant + slope x` on piece `i`.
    fn constant_of(&self, piece: usize) -> f64 {
        let mut constant = 0.0;
        for (i, &x) in self.breakpoints.iter().enumerate() {
            let change = self.slopes[i + 1] - self.slopes[i];
            let passed = if i < piece { -x } else { 0.0 };
            constant += change * (passed - (-x).max(0.0));
        }
        constant
    }

    /// Places a scalar tangent on the argument the graph depends on.
    pub(super) fn response_of(&self, force: f64, slope: f64) -> Response {
        match self.variable {
            Variable::Displacement => Response {
                force,
                by_displacement: slope,
                by_velocity: 0.0,
            },
            Variable::Velocity => Response {
                force,
                by_displacement: 0.0,
                by_velocity: slope,
            },
        }
    }
}

impl Law for PiecewiseLinear {
    fn kind(&self) -> &'static str {
        self.kind
    }

    fn response(&self, displacement: f64, velocity: f64) -> Response {
        let x = match self.variable {
            Variable::Displacement => displacement,
            Variable::Velocity => velocity,
        };
        let piece = self.piece_of(x);
        let slope = self.slopes[piece];
        self.response_of(self.constant_of(piece) + slope * x, slope)
    }

    fn regimes(&self) -> Option<RegimeTable> {
        let on_argument = |factor: f64, constant: f64, to: usize| match self.variable {
            Variable::Displacement => Guard::on_displacement(factor, constant, Transition::To(to)),
            Variable::Velocity => Guard::on_velocity(factor, constant, Transition::To(to)),
        };
        let regimes = (0..self.slopes.len())
            .map(|i| {
                let constant = self.constant_of(i);
                let slope = self.slopes[i];
                let piece = match self.variable {
                    Variable::Displacement => Piece::Affine {
                        constant,
                        displacement: slope,
                        velocity: 0.0,
                        internal: 0.0,
                    },
                    Variable::Velocity => Piece::Affine {
                        constant,
                        displacement: 0.0,
                        velocity: slope,
                        internal: 0.0,
                    },
                };
                let mut guards = Vec::new();
                if i > 0 {
                    guards.push(on_argument(1.0, -self.breakpoints[i - 1], i - 1));
                }
                if i < self.breakpoints.len() {
                    guards.push(on_argument(-1.0, self.breakpoints[i], i + 1));
                }
                Regime::new(self.names[i], slope != 0.0, piece, guards)
            })
            .collect();
        Some(RegimeTable::of_function(regimes))
    }

    fn is_monotone(&self) -> bool {
        self.variable == Variable::Velocity && self.slopes.iter().all(|&slope| slope >= 0.0)
    }

    fn resolvent(&self, w: f64, r: f64) -> Option<(f64, f64)> {
        if !self.is_monotone() {
            return None;
        }
        // `v + r f(v)` rises with v: the piece that holds its value at w is the one sought.
        let piece = (self.breakpoints.iter())
            .filter(|&&x| x + r * self.response(0.0, x).force < w)
            .count();
        let (constant, slope) = (self.constant_of(piece), self.slopes[piece]);
        let v = (w - r * constant) / (1.0 + r * slope);
        Some((v, constant + slope * v))
    }

    fn linearized(&self) -> (f64, f64) {
        let slope = self.slopes[self.linear_piece];
        match self.variable {
            Variable::Displacement => (slope, 0.0),
            Variable::Velocity => (0.0, slope),
        }
    }
}
