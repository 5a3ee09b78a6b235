//! Harmonics of any law from equispaced samples of one period: alternating frequency and time (theory 02 §5.2).

use super::{ForceEvaluation, PortForce};
use crate::orbit::harmonic_balance::layout::velocity;
use num_complex::Complex;
use slackside_mechanics::Law;
use slackside_numerics::fourier::{FourierPlanner, FourierTransform};
use std::sync::Arc;

/// Sampled evaluation of a law beside its linear spring and damper.
#[derive(Debug, Clone)]
pub struct Sampled {
    law: Arc<dyn Law>,
    linear: (f64, f64),
    drifts: bool,
    transform: FourierTransform,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    remainder: Vec<f64>,
    by_displacement: Vec<f64>,
    by_velocity: Vec<f64>,
    rate: Vec<Complex<f64>>,
}

impl Sampled {
    /// Evaluation beside the spring and damper `linear` for motions with `harmonics` orders on `samples` points, never fewer
    /// than `4H + 2`, which the exact tangent needs. More are needed to resolve a narrow transition: eight per its width.
    pub fn new(
        law: Arc<dyn Law>,
        linear: (f64, f64),
        drifts: bool,
        harmonics: usize,
        samples: usize,
        planner: &mut FourierPlanner,
    ) -> Self {
        let length = samples.max(4 * harmonics + 2);
        Self {
            linear,
            drifts,
            law,
            transform: planner.transform(length),
            displacement: vec![0.0; length],
            velocity: vec![0.0; length],
            remainder: vec![0.0; length],
            by_displacement: vec![0.0; length],
            by_velocity: vec![0.0; length],
            rate: vec![Complex::ZERO; harmonics + 1],
        }
    }
}

impl Sampled {
    /// Samples the remainder and its tangents along the motion; tells whether each tangent differs from zero anywhere.
    fn sample(&mut self, displacement: &[Complex<f64>], omega: f64) -> (bool, bool) {
        velocity(displacement, omega, self.drifts, &mut self.rate);
        self.transform.synthesize(displacement, &mut self.displacement);
        self.transform.synthesize(&self.rate, &mut self.velocity);
        let (spring, damper) = self.linear;
        let (mut depends_on_u, mut depends_on_v) = (false, false);
        for i in 0..self.displacement.len() {
            let (u, v) = (self.displacement[i], self.velocity[i]);
            let response = self.law.response(u, v);
            self.remainder[i] = response.force - spring * u - damper * v;
            self.by_displacement[i] = response.by_displacement - spring;
            self.by_velocity[i] = response.by_velocity - damper;
            depends_on_u |= self.by_displacement[i] != 0.0;
            depends_on_v |= self.by_velocity[i] != 0.0;
        }
        (depends_on_u, depends_on_v)
    }
}

impl ForceEvaluation for Sampled {
    fn evaluate(&mut self, displacement: &[Complex<f64>], omega: f64, force: &mut PortForce) {
        force.direct = None;
        let (depends_on_u, depends_on_v) = self.sample(displacement, omega);
        let harmonics = displacement.len() - 1;
        force.remainder.resize(harmonics + 1, Complex::ZERO);
        self.transform.analyze(&self.remainder, &mut force.remainder);
        for (used, samples, out) in [
            (depends_on_u, &self.by_displacement, &mut force.by_displacement),
            (depends_on_v, &self.by_velocity, &mut force.by_velocity),
        ] {
            out.clear();
            if used {
                out.resize(2 * harmonics + 1, Complex::ZERO);
                self.transform.analyze(samples, out);
                out.iter_mut().skip(1).for_each(|h| *h *= 0.5);
            }
        }
    }

    fn remainder(&mut self, displacement: &[Complex<f64>], omega: f64, highest: usize) -> Vec<Complex<f64>> {
        self.sample(displacement, omega);
        let mut result = vec![Complex::ZERO; highest + 1];
        // Orders beyond a quarter of the samples are aliased as strongly as they are present.
        let told = highest.min(self.remainder.len() / 4);
        self.transform.analyze(&self.remainder, &mut result[..=told]);
        result
    }

    fn set_law(&mut self, law: Arc<dyn Law>) {
        self.law = law;
    }

    fn samples(&self) -> usize {
        self.displacement.len()
    }
}
