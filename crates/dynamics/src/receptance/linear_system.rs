//! The linear part with open ports.

use super::{LockedSystem, ReceptanceError};
use crate::orbit::harmonic_balance::elimination;
use slackside_linalg::{Complex, ComplexMatrix, Lu, Matrix, eigenvalues};
use slackside_mechanics::{Law, Piece, System};

/// `D(ω) q = F − B f` with `D(ω) = −ω² M + iω (C + Ω C₁) + K + Ω² K₂`: a system without the elements at its ports, whose
/// columns form `B`. Linear elements elsewhere are part of `C` and `K`.
#[derive(Debug, Clone)]
pub struct LinearSystem {
    pub(super) mass: Matrix,
    pub(super) damping: Matrix,
    pub(super) damping_linear: Option<Matrix>,
    pub(super) stiffness: Matrix,
    pub(super) stiffness_quadratic: Option<Matrix>,
    pub(crate) constant: Vec<f64>,
    /// Order of the load's harmonic, and its amplitudes `F_k`.
    pub(super) harmonics: Vec<(usize, Vec<Complex>)>,
    /// Columns of `B`.
    pub(super) ports: Vec<Vec<f64>>,
    /// Names of the elements at the ports.
    pub(super) names: Vec<String>,
}

/// Stiffness and damping of a law that is a linear spring and damper, and its constant force; `None` for any other law.
pub(crate) fn linear_law(law: &dyn Law) -> Option<(f64, f64, f64)> {
    let table = law.regimes()?;
    match table.regimes.as_slice() {
        [regime] if regime.guards.is_empty() && !table.internal => match regime.piece {
            Piece::Affine {
                constant,
                displacement,
                velocity,
                ..
            } => Some((displacement, velocity, constant)),
            _ => None,
        },
        _ => None,
    }
}

/// Indices of the elements that are no linear spring and damper.
pub(crate) fn nonlinear_elements(system: &System) -> Vec<usize> {
    (0..system.elements.len())
        .filter(|&e| linear_law(system.elements[e].law.as_ref()).is_none())
        .collect()
}

impl LinearSystem {
    /// The system with the ports of `elements` (indices) open; every other element must be linear.
    ///
    /// # Errors
    /// [`ReceptanceError::NonlinearElement`] or [`ReceptanceError::NoElement`].
    pub fn new(system: &System, elements: &[usize]) -> Result<Self, ReceptanceError> {
        let n = system.order();
        let count = system.elements.len();
        if let Some(&index) = elements.iter().find(|&&e| e >= count) {
            return Err(ReceptanceError::NoElement { index, count });
        }
        let mut result = Self {
            mass: system.mass.clone(),
            damping: system.damping.clone(),
            damping_linear: system.damping_linear_in_frequency.clone(),
            stiffness: system.stiffness.clone(),
            stiffness_quadratic: system.stiffness_quadratic_in_frequency.clone(),
            constant: system.forcing.constant.clone(),
            harmonics: Vec::new(),
            ports: Vec::new(),
            names: Vec::new(),
        };
        for harmonic in &system.forcing.harmonics {
            let parts = harmonic.cosine.iter().zip(&harmonic.sine);
            let amplitudes = parts.map(|(&c, &s)| Complex::new(c, -s)).collect();
            result.harmonics.push((harmonic.order, amplitudes));
        }
        for (index, element) in system.elements.iter().enumerate() {
            if elements.contains(&index) {
                continue;
            }
            let Some((spring, damper, constant)) = linear_law(element.law.as_ref()) else {
                return Err(ReceptanceError::NonlinearElement {
                    element: element.name.clone(),
                    kind: element.law.kind(),
                });
            };
            for &(i, a) in element.port.terms() {
                result.constant[i] -= a * constant;
                for &(j, b) in element.port.terms() {
                    result.stiffness[(i, j)] += a * b * spring;
                    result.damping[(i, j)] += a * b * damper;
                }
            }
        }
        for &index in elements {
            let element = &system.elements[index];
            result.ports.push(element.port.dense(n));
            result.names.push(element.name.clone());
        }
        Ok(result)
    }

    /// The system with the ports of all its nonlinear elements open.
    ///
    /// # Errors
    /// None that a sound system could cause.
    pub fn without_nonlinear_elements(system: &System) -> Result<Self, ReceptanceError> {
        Self::new(system, &nonlinear_elements(system))
    }

    /// Number of coordinates.
    pub fn order(&self) -> usize {
        self.mass.rows()
    }

    /// Number of ports.
    pub fn ports(&self) -> usize {
        self.ports.len()
    }

    /// The column of a port.
    pub fn port(&self, index: usize) -> &[f64] {
        &self.ports[index]
    }

    /// Orders of the load's harmonics.
    pub fn orders(&self) -> Vec<usize> {
        self.harmonics.iter().map(|(order, _)| *order).collect()
    }

    /// The complex amplitudes `F_k` of the load, if it has this order.
    pub fn load(&self, order: usize) -> Option<&[Complex]> {
        let found = self.harmonics.iter().find(|(k, _)| *k == order);
        found.map(|(_, amplitudes)| amplitudes.as_slice())
    }

    /// The same system with its ports held at rest.
    ///
    /// # Errors
    /// [`ReceptanceError::DependentPort`].
    pub fn locked(&self) -> Result<LockedSystem, ReceptanceError> {
        LockedSystem::new(self)
    }

    /// `K + Ω² K₂`.
    pub(crate) fn stiffness_at(&self, frequency: f64) -> Matrix {
        let mut result = self.stiffness.clone();
        if let Some(quadratic) = &self.stiffness_quadratic {
            result.add_scaled(frequency * frequency, quadratic);
        }
        result
    }

    /// `C + Ω C₁`.
    pub(crate) fn damping_at(&self, frequency: f64) -> Matrix {
        let mut result = self.damping.clone();
        if let Some(linear) = &self.damping_linear {
            result.add_scaled(frequency, linear);
        }
        result
    }

    /// Writes `D(ω)` into `result`, row by row.
    pub(super) fn dynamic_stiffness(&self, omega: f64, frequency: f64, result: &mut [Complex]) {
        let (mass, damping) = (self.mass.as_slice(), self.damping.as_slice());
        let stiffness = self.stiffness.as_slice();
        for (i, out) in result.iter_mut().enumerate() {
            *out = Complex::new(stiffness[i] - omega * omega * mass[i], omega * damping[i]);
        }
        if let Some(matrix) = &self.damping_linear {
            for (out, &c) in result.iter_mut().zip(matrix.as_slice()) {
                out.im += omega * frequency * c;
            }
        }
        if let Some(matrix) = &self.stiffness_quadratic {
            for (out, &k) in result.iter_mut().zip(matrix.as_slice()) {
                out.re += frequency * frequency * k;
            }
        }
    }

    /// `D(ω)⁻¹ [F, B]`: the response of all coordinates to the load's amplitude of this order, if there is one, and to a unit
    /// force `+1` in each port, as columns of a row-major `n × (1 + ports)` array.
    pub(crate) fn responses(
        &self,
        order: usize,
        omega: f64,
        frequency: f64,
    ) -> Result<ComplexMatrix, ReceptanceError> {
        let (n, columns) = (self.order(), 1 + self.ports.len());
        let mut matrix = vec![Complex::ZERO; n * n];
        self.dynamic_stiffness(omega, frequency, &mut matrix);
        let mut right = vec![Complex::ZERO; n * columns];
        for i in 0..n {
            if let Some(load) = self.load(order) {
                right[i * columns] = load[i];
            }
            for (j, port) in self.ports.iter().enumerate() {
                right[i * columns + 1 + j] = Complex::new(port[i], 0.0);
            }
        }
        if !elimination::solve(&mut matrix, &mut right, n, columns) {
            return Err(ReceptanceError::Resonance { omega });
        }
        let mut result = ComplexMatrix::zeros(n, columns);
        for i in 0..n {
            for j in 0..columns {
                result[(i, j)] = right[i * columns + j];
            }
        }
        Ok(result)
    }

    /// The receptance `R(ω) = Bᵀ D(ω)⁻¹ B` of the ports at circular frequency `ω`, while the load has frequency `Ω`:
    /// displacement per force.
    ///
    /// # Errors
    /// [`ReceptanceError::Resonance`].
    pub fn receptance(&self, omega: f64, frequency: f64) -> Result<ComplexMatrix, ReceptanceError> {
        let responses = self.responses(usize::MAX, omega, frequency)?;
        let m = self.ports.len();
        let mut result = ComplexMatrix::zeros(m, m);
        for i in 0..m {
            for j in 0..m {
                result[(i, j)] = project(&self.ports[i], &responses, 1 + j);
            }
        }
        Ok(result)
    }

    /// The displacements `u_lin,k = Bᵀ D(kΩ)⁻¹ F_k` of the open ports.
    ///
    /// # Errors
    /// [`ReceptanceError::Resonance`].
    pub fn open_displacements(&self, order: usize, frequency: f64) -> Result<Vec<Complex>, ReceptanceError> {
        let responses = self.responses(order, order as f64 * frequency, frequency)?;
        Ok((self.ports.iter())
            .map(|port| project(port, &responses, 0))
            .collect())
    }

    /// The poles `λ` of the open system, solutions of `det(λ² M + λ (C + Ω C₁) + K + Ω² K₂) = 0`, by rising imaginary part. A
    /// coordinate without stiffness contributes the one pole of its rate.
    ///
    /// # Errors
    /// [`ReceptanceError::Linalg`].
    pub fn poles(&self, frequency: f64) -> Result<Vec<Complex>, ReceptanceError> {
        let (matrix, _) = self.state_matrix(frequency)?;
        let mut poles = eigenvalues(&matrix)?;
        poles.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
        Ok(poles)
    }

    /// Coordinates with stiffness; the others are cyclic, with rows and columns of `K` that are zero.
    pub fn held_coordinates(&self, frequency: f64) -> Vec<usize> {
        let stiffness = self.stiffness_at(frequency);
        let n = self.order();
        let held = |i: usize| (0..n).any(|j| stiffness[(i, j)] != 0.0 || stiffness[(j, i)] != 0.0);
        (0..n).filter(|&i| held(i)).collect()
    }

    /// The matrix `A` of `[q_held; q']' = A [q_held; q']`, and `M⁻¹ B` as columns.
    pub(crate) fn state_matrix(&self, frequency: f64) -> Result<(Matrix, Vec<Vec<f64>>), ReceptanceError> {
        let n = self.order();
        let held = self.held_coordinates(frequency);
        let (h, size) = (held.len(), held.len() + n);
        let lu = Lu::new(&self.mass)?;
        let stiffness = lu.solve_matrix(&self.stiffness_at(frequency));
        let damping = lu.solve_matrix(&self.damping_at(frequency));
        let mut matrix = Matrix::zeros(size, size);
        for (a, &i) in held.iter().enumerate() {
            matrix[(a, h + i)] = 1.0;
            for row in 0..n {
                matrix[(h + row, a)] = -stiffness[(row, i)];
            }
        }
        for i in 0..n {
            for j in 0..n {
                matrix[(h + i, h + j)] = -damping[(i, j)];
            }
        }
        let inputs = self.ports.iter().map(|port| lu.solve(port)).collect();
        Ok((matrix, inputs))
    }
}

/// `bᵀ x` for a column of complex responses.
pub(crate) fn project(port: &[f64], responses: &ComplexMatrix, column: usize) -> Complex {
    (port.iter().enumerate())
        .map(|(i, b)| b * responses[(i, column)])
        .sum()
}
