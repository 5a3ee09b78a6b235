//! The spectral radius of a regime, which sets the length of its steps.

use super::FlowError;
use slackside_linalg::{LinalgError, Matrix, eigenvalues};

/// Largest size of a matrix whose spectral radius is computed from its eigenvalues.
const EIGENVALUES_UP_TO: usize = 8;

/// The spectral radius, or for larger matrices the bound `‖A^128‖^(1/128)` on it by seven squarings, which is a few percent
/// too large and several times cheaper.
pub(super) fn spectral_radius(matrix: &Matrix) -> Result<f64, FlowError> {
    if matrix.rows() <= EIGENVALUES_UP_TO {
        let values = eigenvalues(matrix)?;
        return Ok(values.iter().map(|v| v.norm()).fold(0.0, f64::max));
    }
    if !matrix.is_finite() {
        return Err(LinalgError::NotFinite.into());
    }
    let mut power = matrix.clone();
    let mut square = matrix.clone();
    // The power is carried as `e^logarithm · power`, against overflow.
    let (mut logarithm, mut exponent) = (0.0, 1.0);
    for _ in 0..7 {
        let norm = power.norm_infinity();
        if norm == 0.0 {
            return Ok(0.0);
        }
        power.as_mut_slice().iter_mut().for_each(|value| *value /= norm);
        power.product_into(&power, &mut square);
        std::mem::swap(&mut power, &mut square);
        logarithm = 2.0 * (logarithm + norm.ln());
        exponent *= 2.0;
    }
    let norm = power.norm_infinity();
    Ok(if norm == 0.0 {
        0.0
    } else {
        ((logarithm + norm.ln()) / exponent).exp()
    })
}
