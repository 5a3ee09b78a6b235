//! The measures of a system along a motion by harmonic balance.

use super::HarmonicOrbit;
use super::crossings::CrossingSearch;
use crate::orbit::MeasureSummary;
use num_complex::Complex;
use slackside_mechanics::Output;
use slackside_numerics::fourier::{FourierPlanner, rms_about_mean, value};
use slackside_numerics::quadrature::gauss_legendre;
use std::f64::consts::TAU;

impl HarmonicOrbit {
    /// All measures of the system, in its order. Measures without force of a nonlinear element, or with that of one with a
    /// smooth memory, are trigonometric polynomials and exact: rms by Parseval's identity, extrema by the zeros of the rate. Others take the law itself
    /// along the motion, not its truncated harmonics: rms by Gauss' rule between the events, extrema by refinement of
    /// dense samples.
    pub fn measures(&self) -> Vec<MeasureSummary> {
        let mut planner = FourierPlanner::default();
        let outputs = self.system.outputs.iter();
        outputs
            .map(|output| self.measure_with(output, &mut planner))
            .collect()
    }

    /// One measure, which need not be one of the system's own.
    pub fn measure(&self, output: &Output) -> MeasureSummary {
        self.measure_with(output, &mut FourierPlanner::default())
    }

    fn measure_with(&self, output: &Output, planner: &mut FourierPlanner) -> MeasureSummary {
        let harmonics = self.output_harmonics(output, true);
        let has_law = output.force.iter().any(|&(element, _)| {
            let law = &self.system.elements[element].law;
            let is_linear = law.regimes().is_some_and(|table| table.regimes.len() == 1);
            !is_linear && law.memory().is_none()
        });
        if has_law {
            return self.sampled(output, harmonics);
        }
        let mut search = CrossingSearch::new(harmonics.len() - 1, planner);
        let (max, min) = search.extrema(&harmonics);
        MeasureSummary {
            mean: harmonics[0].re,
            rms: rms_about_mean(&harmonics),
            max,
            min,
            harmonics,
        }
    }

    /// Amplitudes of a measure, with or without its element forces.
    fn output_harmonics(&self, output: &Output, with_forces: bool) -> Vec<Complex<f64>> {
        let prescribed = output
            .harmonics
            .iter()
            .map(|&(order, ..)| order * self.subharmonic);
        let orders = self.coordinates.first().map_or(0, |q| q.len() - 1);
        let highest = prescribed.max().unwrap_or(0).max(orders);
        let mut result = vec![Complex::ZERO; highest + 1];
        result[0].re = output.constant;
        for k in 0..=orders {
            for &(i, factor) in &output.displacement {
                result[k] += self.coordinates[i][k] * factor;
            }
            for &(i, factor) in &output.velocity {
                result[k] += self.coordinates[i][k] * Complex::new(0.0, factor * k as f64 * self.omega());
                if k == 0 {
                    result[0].re += factor * self.coordinate_drifts[i];
                }
            }
            if with_forces {
                for &(element, factor) in &output.force {
                    result[k] += self.forces[element][k] * factor;
                }
            }
        }
        for &(order, cosine, sine) in &output.harmonics {
            result[order * self.subharmonic] += Complex::new(cosine, -sine);
        }
        result
    }

    /// A measure that contains laws: `y(θ)` from the smooth part and the laws at the ports.
    fn sampled(&self, output: &Output, harmonics: Vec<Complex<f64>>) -> MeasureSummary {
        let smooth = self.output_harmonics(output, false);
        let rates: Vec<Vec<Complex<f64>>> = output
            .force
            .iter()
            .map(|&(element, _)| self.port_rate(element))
            .collect();
        let y = |angle: f64| {
            let laws = output.force.iter().zip(&rates).map(|(&(element, factor), rate)| {
                if self.system.elements[element].law.memory().is_some() {
                    return factor * value(&self.forces[element], angle);
                }
                let u = value(&self.displacements[element], angle);
                let v = value(rate, angle);
                factor * self.system.elements[element].law.response(u, v).force
            });
            value(&smooth, angle) + laws.sum::<f64>()
        };
        // On panels no longer than two of the H-th waves, nor than eight samples of the laws, nine nodes resolve more than
        // twice that order; amplitudes beyond are far below rounding's share in the mean square.
        let widest = TAU / (self.harmonics / 2).max(self.samples / 8).max(32) as f64;
        let mean = harmonics[0].re;
        let rule = gauss_legendre();
        let mut square = 0.0;
        let mut points = Vec::new();
        for (start, end) in self.panels(widest) {
            let length = end - start;
            points.push((start, y(start)));
            for (node, weight) in rule.nodes.iter().zip(rule.weights) {
                let angle = start + length * node;
                let value = y(angle);
                square += weight * length * (value - mean).powi(2);
                points.push((angle, value));
            }
        }
        MeasureSummary {
            mean,
            rms: (square / TAU).sqrt(),
            max: largest(&points, 1.0, &y),
            min: -largest(&points, -1.0, &y),
            harmonics,
        }
    }
}

/// The largest value of `sign · y`, by golden-section search about the best of the `points` (angle and value of `y`, by
/// rising angle).
fn largest(points: &[(f64, f64)], sign: f64, y: &dyn Fn(f64) -> f64) -> f64 {
    let (count, at) = (points.len(), |angle: f64| sign * y(angle));
    let best = (0..count).fold(0, |best, i| match sign * points[i].1 > sign * points[best].1 {
        true => i,
        false => best,
    });
    let mut a = if best == 0 {
        points[count - 1].0 - TAU
    } else {
        points[best - 1].0
    };
    let mut b = if best + 1 == count {
        points[0].0 + TAU
    } else {
        points[best + 1].0
    };
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut c, mut d) = (b - ratio * (b - a), a + ratio * (b - a));
    let (mut at_c, mut at_d) = (at(c), at(d));
    let mut result = (sign * points[best].1).max(at_c).max(at_d);
    // Rounding in y hides differences of angle below 1e-8.
    while b - a > 1e-9 {
        if at_c > at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - ratio * (b - a);
            at_c = at(c);
            result = result.max(at_c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + ratio * (b - a);
            at_d = at(d);
            result = result.max(at_d);
        }
    }
    result
}
