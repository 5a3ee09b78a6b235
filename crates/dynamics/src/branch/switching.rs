//! Starting the branch of twice the period at a period doubling (theory 02 §6).

use super::follow::BranchFamily;
use crate::orbit::shooting::Shooting;
use slackside_continuation::Family;
use slackside_linalg::{LinalgError, Matrix, eigen};

/// A start on the branch of twice the period.
#[derive(Debug, Clone, PartialEq)]
pub struct DoublingStart {
    /// State near the doubled motion.
    pub state: Vec<f64>,
    /// Scaled tangent of the branch, of length `2n + 1`; its parameter part is zero.
    pub tangent: Vec<f64>,
}

/// The start at scaled distance `distance` along the eigenvector of the multiplier −1.
///
/// # Errors
/// [`LinalgError`] if the eigenvector cannot be computed.
pub fn doubling_start(
    state: &[f64],
    monodromy: &Matrix,
    scales: &[f64],
    distance: f64,
) -> Result<DoublingStart, LinalgError> {
    let n = state.len();
    let decomposition = eigen(monodromy)?;
    let closest = (0..n)
        .min_by(|&i, &j| {
            (decomposition.values[i] + 1.0)
                .norm()
                .total_cmp(&(decomposition.values[j] + 1.0).norm())
        })
        .unwrap_or(0);
    // The eigenvector of a simple real eigenvalue is real up to a common factor.
    let vector: Vec<_> = (0..n)
        .map(|i| decomposition.vectors[(i, closest)] / scales[i])
        .collect();
    let largest = vector
        .iter()
        .copied()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))
        .unwrap_or_default();
    let mut tangent: Vec<f64> = vector
        .iter()
        .map(|v| {
            if largest.norm() > 0.0 {
                (v / largest).re
            } else {
                0.0
            }
        })
        .collect();
    let length = slackside_linalg::norm(&tangent);
    tangent.iter_mut().for_each(|value| *value /= length);
    let state = (0..n)
        .map(|i| state[i] + distance * tangent[i] * scales[i])
        .collect();
    tangent.push(0.0);
    Ok(DoublingStart { state, tangent })
}

impl BranchFamily for Shooting {
    fn periods(&self) -> usize {
        self.periods()
    }

    fn as_family(&mut self) -> &mut dyn Family {
        self
    }
}
