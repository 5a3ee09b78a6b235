//! The linear map from the forces at the ports to the motion, harmonic by harmonic, with the mean apart.

use crate::receptance::{LinearSystem, ReceptanceError, project};
use slackside_linalg::{Complex, ComplexMatrix, Lu, Matrix};

/// `q_k = q_lin,k − D_k⁻¹ B f_k` for `k ≥ 1`. For the mean, coordinates without stiffness move at constant rates `ω`:
/// `C_zz ω = F_z − B_z f_0`, `K_hh q_h = F_h − B_h f_0 − C_hz ω`.
#[derive(Debug)]
pub struct PortMap<'a> {
    pub linear: &'a LinearSystem,
    pub frequency: f64,
    /// `[D_k⁻¹F_k, D_k⁻¹B]` for `k = 1 … H`.
    pub responses: Vec<ComplexMatrix>,
    /// Coordinates without stiffness.
    pub cyclic: Vec<usize>,
    /// `C + Ω C₁`.
    damping: Matrix,
}

impl<'a> PortMap<'a> {
    /// The map for harmonics up to `highest`.
    ///
    /// # Errors
    /// [`ReceptanceError::Resonance`].
    pub fn new(linear: &'a LinearSystem, frequency: f64, highest: usize) -> Result<Self, ReceptanceError> {
        let responses = (1..=highest)
            .map(|k| linear.responses(k, k as f64 * frequency, frequency))
            .collect::<Result<_, _>>()?;
        let held = linear.held_coordinates(frequency);
        Ok(Self {
            linear,
            frequency,
            responses,
            cyclic: (0..linear.order()).filter(|i| !held.contains(i)).collect(),
            damping: linear.damping_at(frequency),
        })
    }

    /// Mobility `Y_k` of the ports, real for the highest harmonic, of which samples see the cosine only.
    pub fn mobility(&self, k: usize) -> ComplexMatrix {
        let m = self.linear.ports();
        let mut result = ComplexMatrix::zeros(m, m);
        let rate = Complex::new(0.0, k as f64 * self.frequency);
        for i in 0..m {
            for j in 0..m {
                let y = rate * project(self.linear.port(i), &self.responses[k - 1], 1 + j);
                let alone = k == self.responses.len();
                result[(i, j)] = if alone { Complex::new(y.re, 0.0) } else { y };
            }
        }
        result
    }

    /// Velocity `v_lin,k` of an open port.
    pub fn open_velocity(&self, k: usize, port: usize) -> Complex {
        let rate = Complex::new(0.0, k as f64 * self.frequency);
        rate * project(self.linear.port(port), &self.responses[k - 1], 0)
    }

    /// The mean forces `w` with `w − r B_zᵀ ω = x` and `C_zz ω + B_z w = F_z`, as a matrix and a vector: `w = P x + p`.
    ///
    /// # Errors
    /// [`ReceptanceError::FreeMean`] if a coordinate has neither stiffness, damping nor a port.
    pub fn mean_step(&self, factors: &[f64]) -> Result<(Matrix, Vec<f64>), ReceptanceError> {
        let (m, z) = (factors.len(), self.cyclic.len());
        let mut matrix = Matrix::zeros(m + z, m + z);
        let mut load = vec![0.0; m + z];
        for i in 0..m {
            matrix[(i, i)] = 1.0;
            for (a, &c) in self.cyclic.iter().enumerate() {
                matrix[(i, m + a)] = -factors[i] * self.linear.port(i)[c];
                matrix[(m + a, i)] = self.linear.port(i)[c];
            }
        }
        for (a, &c) in self.cyclic.iter().enumerate() {
            load[m + a] = self.linear.constant[c];
            for (b, &d) in self.cyclic.iter().enumerate() {
                matrix[(m + a, m + b)] = self.damping[(c, d)];
            }
        }
        let lu = Lu::new(&matrix).map_err(|_| ReceptanceError::FreeMean)?;
        let constant = lu.solve(&load);
        let mut step = Matrix::zeros(m, m);
        for j in 0..m {
            let mut unit = vec![0.0; m + z];
            unit[j] = 1.0;
            for (i, value) in lu.solve(&unit).iter().take(m).enumerate() {
                step[(i, j)] = *value;
            }
        }
        Ok((step, constant[..m].to_vec()))
    }

    /// Mean rates of the cyclic coordinates and mean positions of the others under mean port forces; the mean of a port's
    /// velocity decides the rates where damping does not.
    ///
    /// # Errors
    /// [`ReceptanceError::FreeMean`].
    pub fn means(&self, forces: &[f64], velocities: &[f64]) -> Result<(Vec<f64>, Vec<f64>), ReceptanceError> {
        let n = self.linear.order();
        let (m, z) = (forces.len(), self.cyclic.len());
        let mut rates = vec![0.0; n];
        if z > 0 {
            // Least squares of B_zᵀ ω = v, C_zz ω = F_z − B_z f, each scaled to coefficients of size one: both hold at the
            // solution, and one of them determines the rates.
            let scale = (self.cyclic.iter())
                .flat_map(|&c| self.cyclic.iter().map(move |&d| self.damping[(c, d)].abs()))
                .fold(0.0_f64, f64::max);
            let mut rows: Vec<(Vec<f64>, f64)> = Vec::new();
            for i in 0..m {
                let row = self.cyclic.iter().map(|&c| self.linear.port(i)[c]).collect();
                rows.push((row, velocities[i]));
            }
            for &c in self.cyclic.iter().filter(|_| scale > 0.0) {
                let row = self
                    .cyclic
                    .iter()
                    .map(|&d| self.damping[(c, d)] / scale)
                    .collect();
                let force: f64 = (0..m).map(|i| self.linear.port(i)[c] * forces[i]).sum();
                rows.push((row, (self.linear.constant[c] - force) / scale));
            }
            let mut normal = Matrix::zeros(z, z);
            let mut right = vec![0.0; z];
            for (row, value) in &rows {
                for a in 0..z {
                    right[a] += row[a] * value;
                    for b in 0..z {
                        normal[(a, b)] += row[a] * row[b];
                    }
                }
            }
            let found = Lu::new(&normal)
                .map_err(|_| ReceptanceError::FreeMean)?
                .solve(&right);
            for (&c, rate) in self.cyclic.iter().zip(found) {
                rates[c] = rate;
            }
        }
        let held: Vec<usize> = (0..n).filter(|i| !self.cyclic.contains(i)).collect();
        let load: Vec<f64> = held
            .iter()
            .map(|&i| {
                let ports: f64 = (0..m).map(|j| self.linear.port(j)[i] * forces[j]).sum();
                let drag: f64 = self.cyclic.iter().map(|&c| self.damping[(i, c)] * rates[c]).sum();
                self.linear.constant[i] - ports - drag
            })
            .collect();
        let mut positions = vec![0.0; n];
        if !held.is_empty() {
            let stiffness = self.linear.stiffness_at(self.frequency).selected(&held);
            let lu = Lu::new(&stiffness).map_err(|_| ReceptanceError::FreeMean)?;
            for (&i, x) in held.iter().zip(lu.solve(&load)) {
                positions[i] = x;
            }
        }
        Ok((positions, rates))
    }
}
