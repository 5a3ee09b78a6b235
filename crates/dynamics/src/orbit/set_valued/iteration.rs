//! Douglas–Rachford splitting between the laws, sample by sample, and the linear system, harmonic by harmonic.

use super::port_map::PortMap;
use crate::receptance::ReceptanceError;
use slackside_linalg::{Complex, ComplexMatrix, Matrix};
use slackside_mechanics::Law;
use slackside_numerics::fourier::FourierTransform;
use std::sync::Arc;

/// The iteration and all its space; a step allocates nothing.
#[derive(Debug)]
pub struct Iteration {
    laws: Vec<Arc<dyn Law>>,
    /// `r` of each port.
    factors: Vec<f64>,
    transform: FourierTransform,
    /// `(1 + r Y_k)⁻¹` and `(1 + r Y_k)⁻¹ r v_lin,k` for `k ≥ 1`.
    steps: Vec<(ComplexMatrix, Vec<Complex>)>,
    mean: (Matrix, Vec<f64>),
    /// `z` of each port.
    points: Vec<Vec<f64>>,
    /// Samples of the port forces and velocities, on the graphs of the laws.
    pub forces: Vec<Vec<f64>>,
    pub velocities: Vec<Vec<f64>>,
    reflected: Vec<Vec<f64>>,
    harmonics: Vec<Vec<Complex>>,
    /// Largest `|w − f|` over the largest `|f|`.
    pub residual: f64,
    pub iterations: usize,
}

impl Iteration {
    /// Starts from zero, with `r = factor / median |Y_1 … Y_7|`.
    pub fn new(
        map: &PortMap<'_>,
        laws: &[Arc<dyn Law>],
        factor: f64,
        transform: FourierTransform,
    ) -> Result<Self, ReceptanceError> {
        let (m, samples) = (laws.len(), transform.length());
        let highest = map.responses.len();
        let mobilities: Vec<ComplexMatrix> = (1..=highest).map(|k| map.mobility(k)).collect();
        let factors: Vec<f64> = (0..m)
            .map(|port| {
                let mut sizes: Vec<f64> = (mobilities.iter().take(7))
                    .map(|y| y[(port, port)].norm())
                    .collect();
                sizes.sort_by(f64::total_cmp);
                let median = sizes[sizes.len() / 2];
                if median > 0.0 { factor / median } else { factor }
            })
            .collect();
        let mut steps = Vec::with_capacity(highest);
        for (k, mobility) in mobilities.iter().enumerate() {
            let mut matrix = mobility.clone();
            for i in 0..m {
                for j in 0..m {
                    matrix[(i, j)] *= factors[i];
                }
                matrix[(i, i)] += 1.0;
            }
            let lu = matrix.lu()?;
            let mut inverse = ComplexMatrix::zeros(m, m);
            for j in 0..m {
                let mut unit = vec![Complex::ZERO; m];
                unit[j] = Complex::ONE;
                for (i, value) in lu.solve(&unit).into_iter().enumerate() {
                    inverse[(i, j)] = value;
                }
            }
            let driven: Vec<Complex> = (0..m).map(|i| factors[i] * map.open_velocity(k + 1, i)).collect();
            steps.push((inverse, lu.solve(&driven)));
        }
        Ok(Self {
            mean: map.mean_step(&factors)?,
            laws: laws.to_vec(),
            factors,
            transform,
            steps,
            points: vec![vec![0.0; samples]; m],
            forces: vec![vec![0.0; samples]; m],
            velocities: vec![vec![0.0; samples]; m],
            reflected: vec![vec![0.0; samples]; m],
            harmonics: vec![vec![Complex::ZERO; highest + 1]; m],
            residual: f64::INFINITY,
            iterations: 0,
        })
    }

    /// Iterates until the residual is below the tolerance or `iterations` have been spent in all.
    pub fn run(&mut self, iterations: usize, tolerance: f64) {
        while self.residual > tolerance && self.iterations < iterations {
            self.step();
        }
    }

    fn step(&mut self) {
        self.iterations += 1;
        let m = self.laws.len();
        for port in 0..m {
            let r = self.factors[port];
            for (i, &z) in self.points[port].iter().enumerate() {
                // f + r v = z as v + f/r = z/r.
                let (v, f) = self.laws[port].resolvent(z / r, 1.0 / r).unwrap_or((0.0, z));
                self.velocities[port][i] = v;
                self.forces[port][i] = f;
                self.reflected[port][i] = 2.0 * f - z;
            }
            self.transform
                .analyze(&self.reflected[port], &mut self.harmonics[port]);
        }
        for k in 0..=self.steps.len() {
            let at: Vec<Complex> = if m == 1 {
                self.harmonics[0][k] = self.applied(k, 0, &[self.harmonics[0][k]]);
                continue;
            } else {
                self.harmonics.iter().map(|h| h[k]).collect()
            };
            for i in 0..m {
                self.harmonics[i][k] = self.applied(k, i, &at);
            }
        }
        let (mut apart, mut size) = (0.0_f64, 0.0_f64);
        for port in 0..m {
            let w = &mut self.reflected[port];
            self.transform.synthesize(&self.harmonics[port], w);
            for ((z, w), f) in self.points[port].iter_mut().zip(w).zip(&self.forces[port]) {
                *z += *w - f;
                apart = apart.max((*w - f).abs());
                size = size.max(f.abs());
            }
        }
        self.residual = if size > 0.0 { apart / size } else { f64::INFINITY };
    }

    /// Row `i` of the linear step at harmonic `k`.
    fn applied(&self, k: usize, i: usize, at: &[Complex]) -> Complex {
        if k == 0 {
            let (matrix, constant) = &self.mean;
            let sum: f64 = at.iter().enumerate().map(|(j, x)| matrix[(i, j)] * x.re).sum();
            return Complex::new(sum + constant[i], 0.0);
        }
        let (inverse, driven) = &self.steps[k - 1];
        let sum: Complex = at.iter().enumerate().map(|(j, x)| inverse[(i, j)] * x).sum();
        sum + driven[i]
    }

    /// Harmonics of samples, to the highest order that they tell.
    pub fn harmonics_of(&self, samples: &[f64]) -> Vec<Complex> {
        let mut result = vec![Complex::ZERO; self.steps.len() + 1];
        self.transform.clone().analyze(samples, &mut result);
        result
    }
}
