//! What is followed: a residual with derivatives.

use slackside_linalg::Matrix;

/// Residual and derivatives of a family at one point.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// `F(z, p)`, length `n`.
    pub residual: Vec<f64>,
    /// `∂F/∂z`, `n × n`.
    pub jacobian: Matrix,
    /// `∂F/∂p`, length `n`.
    pub by_parameter: Vec<f64>,
}

impl Evaluation {
    /// Space for a family of dimension `n`.
    pub fn new(n: usize) -> Self {
        Self {
            residual: vec![0.0; n],
            jacobian: Matrix::zeros(n, n),
            by_parameter: vec![0.0; n],
        }
    }
}

/// Why a family could not be evaluated; the corrector then shortens its step.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct FamilyError(pub String);

/// A residual `F(z, p) = 0` with `z ∈ Rⁿ` and one parameter.
pub trait Family {
    /// The number `n` of unknowns.
    fn dimension(&self) -> usize;

    /// Typical size of each unknown, all positive: arclength is measured in `z_i / scale_i`.
    fn unknown_scales(&self) -> Vec<f64>;

    /// Typical size of the parameter: arclength is measured in `p / scale`.
    fn parameter_scale(&self) -> f64;

    /// Writes residual and derivatives at `(z, p)` into `evaluation`, which has the family's dimension.
    ///
    /// # Errors
    /// [`FamilyError`] where the residual is not defined (an integration fails, a parameter leaves its domain).
    fn evaluate(&mut self, z: &[f64], p: f64, evaluation: &mut Evaluation) -> Result<(), FamilyError>;

    /// Values of the family's test functions at a solution, always as many and in the same order. A special point is
    /// located wherever one of them changes sign; NaN means "not defined here". `evaluation` is that of the solution.
    fn test_functions(&mut self, z: &[f64], p: f64, evaluation: &Evaluation) -> Vec<f64> {
        let _ = (z, p, evaluation);
        Vec::new()
    }

    /// A number that is the same for solutions of the same discrete pattern (the sequence of events, say). Where it changes
    /// along the branch the place is located.
    fn pattern(&mut self, z: &[f64], p: f64, evaluation: &Evaluation) -> i64 {
        let _ = (z, p, evaluation);
        0
    }

    /// Numbers to be kept with each point (multipliers, say); the tracer only stores them.
    fn observe(&mut self, z: &[f64], p: f64, evaluation: &Evaluation) -> Vec<f64> {
        let _ = (z, p, evaluation);
        Vec::new()
    }

    /// Offered after each accepted point: a family whose discretisation adapts may change its dimension and resize
    /// (pad or cut) the solution and the tangent; it then returns true and the point is corrected again.
    fn adapt(&mut self, z: &mut Vec<f64>, tangent: &mut Vec<f64>) -> bool {
        let _ = (z, tangent);
        false
    }
}
