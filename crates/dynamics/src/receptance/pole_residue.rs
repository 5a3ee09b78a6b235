//! The mobility of the ports as a sum over poles.

use super::{LinearSystem, ReceptanceError};
use slackside_linalg::{Complex, ComplexMatrix, eigen};

/// Largest relative difference allowed between the sum over poles and a direct solution.
const AGREEMENT: f64 = 1e-8;

/// `Y(s) = Σ_p ρ_p / (s − λ_p)`: velocity of the open ports per force in them, for the matrices at one frequency of the load
/// (theory 05 §5.3, §5.5). Coordinates without stiffness are left out of the state, so that the pole of a free, undamped
/// rate is zero, once.
#[derive(Debug, Clone)]
pub struct Mobility {
    /// Poles `λ_p`, radians per unit of time.
    pub poles: Vec<Complex>,
    /// Residues `ρ_p`, of order `ports`.
    pub residues: Vec<ComplexMatrix>,
    /// Relative difference to direct solutions at a few frequencies.
    pub error: f64,
    /// `Y(0)`, and whether it is zero by construction: every port then has static stiffness.
    pub(super) has_static_stiffness: bool,
}

impl Mobility {
    /// The sum over poles of a system at frequency `Ω` of its load.
    ///
    /// # Errors
    /// [`ReceptanceError::Defective`] if the eigenvectors do not give the mobility to `1e-8`, [`ReceptanceError::Linalg`].
    pub fn new(system: &LinearSystem, frequency: f64) -> Result<Self, ReceptanceError> {
        let (matrix, inputs) = system.state_matrix(frequency)?;
        let (size, n, m) = (matrix.rows(), system.order(), system.ports());
        let first_rate = size - n;
        let decomposition = eigen(&matrix)?;
        let lu = decomposition.vectors.lu()?;
        let participation: Vec<Vec<Complex>> = inputs
            .iter()
            .map(|input| {
                let mut state = vec![Complex::ZERO; size];
                for (i, v) in input.iter().enumerate() {
                    state[first_rate + i] = Complex::new(*v, 0.0);
                }
                lu.solve(&state)
            })
            .collect();
        let residues = (0..size)
            .map(|p| {
                let mut residue = ComplexMatrix::zeros(m, m);
                for i in 0..m {
                    let seen: Complex = (system.ports[i].iter().enumerate())
                        .map(|(row, b)| b * decomposition.vectors[(first_rate + row, p)])
                        .sum();
                    for j in 0..m {
                        residue[(i, j)] = seen * participation[j][p];
                    }
                }
                residue
            })
            .collect();
        let held = system.held_coordinates(frequency);
        let on_held = |port: &Vec<f64>| {
            port.iter()
                .enumerate()
                .all(|(i, &b)| b == 0.0 || held.contains(&i))
        };
        let mut result = Self {
            poles: decomposition.values,
            residues,
            error: 0.0,
            has_static_stiffness: system.ports.iter().all(on_held),
        };
        result.error = result.difference(system, frequency)?;
        if result.error > AGREEMENT {
            return Err(ReceptanceError::Defective { error: result.error });
        }
        Ok(result)
    }

    /// `Y(iω)`.
    pub fn at(&self, omega: f64) -> ComplexMatrix {
        let m = self.residues.first().map_or(0, ComplexMatrix::rows);
        let mut result = ComplexMatrix::zeros(m, m);
        for (pole, residue) in self.poles.iter().zip(&self.residues) {
            let factor = (Complex::new(0.0, omega) - pole).inv();
            for i in 0..m {
                for j in 0..m {
                    result[(i, j)] += residue[(i, j)] * factor;
                }
            }
        }
        result
    }

    /// Largest relative difference to direct solutions between and beside the poles.
    fn difference(&self, system: &LinearSystem, frequency: f64) -> Result<f64, ReceptanceError> {
        let highest = self.poles.iter().fold(0.0_f64, |a, p| a.max(p.norm()));
        let mut worst = 0.0_f64;
        for share in [0.01, 0.07, 0.23, 0.61, 1.3] {
            let omega = share * highest;
            if omega == 0.0 {
                continue;
            }
            let direct = system.receptance(omega, frequency)?;
            let sum = self.at(omega);
            let m = sum.rows();
            let (mut apart, mut size) = (0.0_f64, 0.0_f64);
            for i in 0..m {
                for j in 0..m {
                    let mobility = direct[(i, j)] * Complex::new(0.0, omega);
                    apart = apart.max((mobility - sum[(i, j)]).norm());
                    size = size.max(mobility.norm());
                }
            }
            if size > 0.0 {
                worst = worst.max(apart / size);
            }
        }
        Ok(worst)
    }
}
