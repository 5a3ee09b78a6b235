//! Floquet multipliers of a motion found by harmonic balance, by three methods (theory 02 §7).

mod hill;
mod magnus;
mod switching;

use super::{HarmonicBalanceError, HarmonicOrbit};
use crate::orbit::floquet;
use slackside_linalg::{Complex, Lu, Matrix};
use slackside_mechanics::System;

/// How multipliers are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StabilityMethod {
    /// Product of matrix exponentials over the regimes between switching angles: exact for these angles. The default for
    /// piecewise-linear laws.
    Switching,
    /// Product of exponentials by the Magnus series of order four over the periodic tangent, with steps that adapt. The
    /// default for all other laws: its error falls with the step and not with the number of harmonics of the disturbance.
    Magnus,
    /// Hill's eigenvalue problem in the harmonics of the disturbance, as many as the motion has. At force kinks its error
    /// falls like `H⁻³` only.
    Hill,
}

/// Multipliers with their origin.
#[derive(Debug, Clone)]
pub struct Stability {
    /// How they were found.
    pub method: StabilityMethod,
    /// The multipliers over one period of the motion, largest modulus first.
    pub multipliers: Vec<Complex>,
    /// The monodromy matrix in `(q, q')`; Hill's method has none.
    pub monodromy: Option<Matrix>,
    /// Estimated error of the entries of the monodromy matrix by integration; the other methods give none.
    pub error_estimate: Option<f64>,
}

impl Stability {
    /// Whether all multipliers lie inside the unit circle.
    pub fn is_stable(&self) -> bool {
        self.multipliers.iter().all(|value| value.norm() < 1.0)
    }
}

impl HarmonicOrbit {
    /// Multipliers by the more accurate method for the laws at hand, which the result names.
    ///
    /// # Errors
    /// [`HarmonicBalanceError::Linalg`] if the motion is not finite or an iteration fails.
    pub fn stability(&self) -> Result<Stability, HarmonicBalanceError> {
        let all_switch = self.regimes_at_start.iter().all(Option::is_some);
        self.stability_by(if all_switch {
            StabilityMethod::Switching
        } else {
            StabilityMethod::Magnus
        })
    }

    /// Multipliers by a given method. Those of a free drift, which are one, are left out.
    ///
    /// # Errors
    /// [`HarmonicBalanceError::NotPiecewiseLinear`] if switching angles are asked of another law,
    /// [`HarmonicBalanceError::NoTangent`] for dry friction that is not smoothed and for laws with a memory, or
    /// [`HarmonicBalanceError::Linalg`].
    pub fn stability_by(&self, method: StabilityMethod) -> Result<Stability, HarmonicBalanceError> {
        let without_tangent = self.system.elements.iter().find(|element| {
            let is_set_valued = element.law.regimes().is_some_and(|table| !table.rests.is_empty());
            is_set_valued || element.law.memory().is_some()
        });
        if let Some(element) = without_tangent {
            return Err(HarmonicBalanceError::NoTangent {
                element: element.name.clone(),
            });
        }
        let mut found = self.multipliers_by(method)?;
        for _ in 0..self.linearization.drift.as_ref().map_or(0, |(_, count)| *count) {
            let values = found.multipliers.iter().enumerate();
            let distance = |value: &Complex| (value - 1.0).norm();
            let nearest = values.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
            if let Some((index, _)) = nearest {
                found.multipliers.remove(index);
            }
        }
        Ok(found)
    }

    fn multipliers_by(&self, method: StabilityMethod) -> Result<Stability, HarmonicBalanceError> {
        let (monodromy, error_estimate) = match method {
            StabilityMethod::Switching => (switching::monodromy(self)?, None),
            StabilityMethod::Magnus => {
                let (monodromy, error) = magnus::monodromy(self)?;
                (monodromy, Some(error))
            }
            StabilityMethod::Hill => {
                return Ok(Stability {
                    method,
                    multipliers: hill::multipliers(self)?,
                    monodromy: None,
                    error_estimate: None,
                });
            }
        };
        Ok(Stability {
            method,
            multipliers: floquet::multipliers(&monodromy)?,
            monodromy: Some(monodromy),
            error_estimate,
        })
    }
}

/// State matrices `[[0, I], [−M⁻¹K, −M⁻¹C]]` of a system whose elements have given tangents.
#[derive(Debug)]
struct StateMatrices<'a> {
    system: &'a System,
    base: Matrix,
    /// `M⁻¹ b` of each element.
    columns: Vec<Vec<f64>>,
}

impl<'a> StateMatrices<'a> {
    fn new(system: &'a System, frequency: f64) -> Result<Self, HarmonicBalanceError> {
        let n = system.order();
        let mass = Lu::new(&system.mass)?;
        let stiffness = mass.solve_matrix(&system.stiffness_at(frequency));
        let damping = mass.solve_matrix(&system.damping_at(frequency));
        let mut base = Matrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            base[(i, n + i)] = 1.0;
            for j in 0..n {
                base[(n + i, j)] = -stiffness[(i, j)];
                base[(n + i, n + j)] = -damping[(i, j)];
            }
        }
        let ports = system
            .elements
            .iter()
            .map(|element| mass.solve(&element.port.dense(n)));
        Ok(Self {
            columns: ports.collect(),
            system,
            base,
        })
    }

    /// The matrix for tangents `(∂f/∂u, ∂f/∂v)` of the elements.
    fn with_tangents(&self, tangents: impl Iterator<Item = (f64, f64)>) -> Matrix {
        let n = self.system.order();
        let mut result = self.base.clone();
        for (e, (by_displacement, by_velocity)) in tangents.enumerate() {
            for i in 0..n {
                let column = self.columns[e][i];
                for &(j, factor) in self.system.elements[e].port.terms() {
                    result[(n + i, j)] -= column * factor * by_displacement;
                    result[(n + i, n + j)] -= column * factor * by_velocity;
                }
            }
        }
        result
    }
}
