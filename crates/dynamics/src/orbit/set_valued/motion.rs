//! What set-valued harmonic balance finds.

use super::iteration::Iteration;
use super::port_map::PortMap;
use crate::receptance::ReceptanceError;
use slackside_linalg::Complex;
use slackside_numerics::fourier::rms_about_mean;

/// A periodic motion as samples at the ports and harmonics of all coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct SetValuedMotion {
    /// Frequency `Ω` of load and motion.
    pub frequency: f64,
    /// Indices of the nonlinear elements, in the order of the port samples.
    pub elements: Vec<usize>,
    /// Force of each of these elements at `N` equidistant times from phase zero, on the graph of its law.
    pub forces: Vec<Vec<f64>>,
    /// Velocity of its port at these times.
    pub velocities: Vec<Vec<f64>>,
    /// Per coordinate, the harmonics `q_0 … q_{N/2}` of its position (zero mean for a cyclic coordinate).
    pub harmonics: Vec<Vec<Complex>>,
    /// Mean rate of each coordinate; zero unless it is cyclic.
    pub mean_rates: Vec<f64>,
    /// Largest difference between the two estimates of the force, relative to the largest force.
    pub residual: f64,
    /// Iterations spent.
    pub iterations: usize,
    /// Whether the residual is below the tolerance.
    pub converged: bool,
}

impl SetValuedMotion {
    /// Recovers the motion of all coordinates, `q_k = D_k⁻¹ (F_k − B f_k)`.
    pub(super) fn new(
        map: &PortMap<'_>,
        iteration: &Iteration,
        elements: Vec<usize>,
        tolerance: f64,
    ) -> Result<Self, ReceptanceError> {
        let n = map.linear.order();
        let forces: Vec<Vec<Complex>> = (iteration.forces.iter())
            .map(|samples| iteration.harmonics_of(samples))
            .collect();
        let mean = |samples: &Vec<f64>| samples.iter().sum::<f64>() / samples.len() as f64;
        let mean_forces: Vec<f64> = iteration.forces.iter().map(mean).collect();
        let mean_velocities: Vec<f64> = iteration.velocities.iter().map(mean).collect();
        let (positions, mean_rates) = map.means(&mean_forces, &mean_velocities)?;
        let harmonics = (0..n)
            .map(|i| {
                let mut result = vec![Complex::new(positions[i], 0.0)];
                result.extend(map.responses.iter().enumerate().map(|(k, response)| {
                    let reaction: Complex = (forces.iter().enumerate())
                        .map(|(j, f)| response[(i, 1 + j)] * f[k + 1])
                        .sum();
                    response[(i, 0)] - reaction
                }));
                result
            })
            .collect();
        Ok(Self {
            frequency: map.frequency,
            elements,
            forces: iteration.forces.clone(),
            velocities: iteration.velocities.clone(),
            harmonics,
            mean_rates,
            residual: iteration.residual,
            iterations: iteration.iterations,
            converged: iteration.residual <= tolerance,
        })
    }

    /// Root mean square of a coordinate about its mean (of the periodic part, if it drifts).
    pub fn rms(&self, coordinate: usize) -> f64 {
        rms_about_mean(&self.harmonics[coordinate])
    }

    /// Root mean square of a coordinate's rate about its mean.
    pub fn rms_of_rate(&self, coordinate: usize) -> f64 {
        let orders = self.harmonics[coordinate].iter().enumerate().skip(1);
        let sum: f64 = orders
            .map(|(k, h)| (k as f64 * self.frequency).powi(2) * h.norm_sqr())
            .sum();
        (0.5 * sum).sqrt()
    }

    /// Coordinates, then their rates, at phase zero of the load: a start for shooting. Cyclic coordinates start from the
    /// periodic part alone.
    pub fn state_at_phase_zero(&self) -> Vec<f64> {
        let positions = self.harmonics.iter().map(|h| h.iter().map(|h| h.re).sum::<f64>());
        let rates = self.harmonics.iter().zip(&self.mean_rates).map(|(h, mean)| {
            let orders = h.iter().enumerate();
            let sum: f64 = orders.map(|(k, h)| -(k as f64) * self.frequency * h.im).sum();
            mean + sum
        });
        positions.chain(rates).collect()
    }

    /// The share of the period during which the port with this place in `elements` rests.
    pub fn share_at_rest(&self, port: usize) -> f64 {
        let samples = &self.velocities[port];
        samples.iter().filter(|&&v| v == 0.0).count() as f64 / samples.len() as f64
    }
}
