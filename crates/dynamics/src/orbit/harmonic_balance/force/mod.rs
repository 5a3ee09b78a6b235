//! Harmonics of an element's remainder force, with derivatives, by three methods behind one trait.

mod exact_switching;
mod marched;
mod sampled;

pub use exact_switching::ExactSwitching;
pub use marched::Marched;
pub use sampled::Sampled;

use num_complex::Complex;
use slackside_linalg::Matrix;
use slackside_mechanics::Law;
use std::sync::Arc;

/// Harmonics of the remainder force `N = f − k u − c v` of one element and of its tangents.
#[derive(Debug, Clone, Default)]
pub struct PortForce {
    /// Amplitudes `N_0 … N_H`.
    pub remainder: Vec<Complex<f64>>,
    /// Two-sided Fourier coefficients `G_m`, `m = 0 … 2H`, of `∂N/∂u`; `G_{−m}` is the conjugate. Empty if it vanishes.
    pub by_displacement: Vec<Complex<f64>>,
    /// The same of `∂N/∂v`.
    pub by_velocity: Vec<Complex<f64>>,
    /// Derivatives of a force that depends on the whole past of the motion, in place of the two tangents.
    pub direct: Option<DirectTangent>,
}

/// Derivatives of the amplitudes of a remainder force.
#[derive(Debug, Clone)]
pub struct DirectTangent {
    /// With respect to the unknowns of the port, both in the real order of [`super::layout`].
    pub matrix: Matrix,
    /// With respect to the frequency `ω` of the motion.
    pub by_frequency: Vec<Complex<f64>>,
}

/// A way to evaluate the harmonics of a remainder force.
pub trait ForceEvaluation: std::fmt::Debug + Send {
    /// Evaluates at the port displacement with amplitudes `displacement` (`h_0 … h_H`), whose fundamental frequency is
    /// `omega`; `h_0` is the mean velocity of a port that drifts. Allocates nothing once `force` has its size.
    fn evaluate(&mut self, displacement: &[Complex<f64>], omega: f64, force: &mut PortForce);

    /// Amplitudes `N_0 … N_K` of the remainder force along the same motion, also beyond the orders of the displacement.
    fn remainder(&mut self, displacement: &[Complex<f64>], omega: f64, highest: usize) -> Vec<Complex<f64>>;

    /// Replaces a sampled law, for a wider or the true transition at rest; exact evaluations ignore it.
    fn set_law(&mut self, _law: Arc<dyn Law>) {}

    /// The internal state at the start of the period, for a law with a smooth memory.
    fn internal_state(&mut self, _displacement: &[Complex<f64>], _omega: f64) -> Option<f64> {
        None
    }

    /// Number of time samples; zero where there is no sampling.
    fn samples(&self) -> usize;
}

/// Amplitudes of the product `g(θ) x(θ)`, `k = 0 … K`, added to `result`: `g` by its two-sided coefficients `G_m`,
/// `m = 0 … K + H`, `x` by its amplitudes `0 … H`. `O(K H)`.
pub fn add_product(coefficients: &[Complex<f64>], x: &[Complex<f64>], result: &mut [Complex<f64>]) {
    let highest = x.len() - 1;
    let mean: f64 = (1..=highest).map(|l| (coefficients[l].conj() * x[l]).re).sum();
    result[0] += coefficients[0].re * x[0].re + mean;
    for (k, out) in result.iter_mut().enumerate().skip(1) {
        let mut sum = 2.0 * coefficients[k] * x[0].re;
        for l in 1..=highest {
            let difference = if k >= l {
                coefficients[k - l]
            } else {
                coefficients[l - k].conj()
            };
            sum += difference * x[l] + coefficients[k + l] * x[l].conj();
        }
        *out += sum;
    }
}
