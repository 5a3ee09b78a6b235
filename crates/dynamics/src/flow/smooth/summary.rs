//! Measures of a smooth motion from the interpolants of its steps (theory 02 §9.2).
//!
//! Integrals are taken by Gauss–Legendre quadrature on every step: unlike the trapezoidal rule over a period they need
//! neither a periodic motion nor equal steps, and steps are dense where the motion bends.

use super::equations::Equations;
use crate::flow::{Record, Request};
use crate::orbit::MeasureSummary;
use slackside_linalg::Complex;
use slackside_mechanics::Output;
use slackside_numerics::ode::DenseStep;
use slackside_numerics::quadrature::{NODES, gauss_legendre};
use std::f64::consts::TAU;

/// Value of a measure at a state and phase.
fn value(output: &Output, equations: &Equations, phase: f64, x: &[f64]) -> f64 {
    let n = equations.coordinates();
    let displacement: f64 = output.displacement.iter().map(|&(i, a)| a * x[i]).sum();
    let velocity: f64 = output.velocity.iter().map(|&(i, a)| a * x[n + i]).sum();
    let force: f64 = output
        .force
        .iter()
        .map(|&(element, a)| a * equations.response(element, x).force)
        .sum();
    let prescribed: f64 = output
        .harmonics
        .iter()
        .map(|&(order, cosine, sine)| {
            let (sin, cos) = (order as f64 * phase).sin_cos();
            cosine * cos + sine * sin
        })
        .sum();
    output.constant + displacement + velocity + force + prescribed
}

/// Sums of one measure over the steps seen.
#[derive(Debug, Clone)]
struct Sums {
    /// First value seen: subtracted before squaring, against cancellation.
    reference: Option<f64>,
    integral: f64,
    square: f64,
    range: (f64, f64),
    harmonics: Vec<Complex>,
}

/// Accumulates summaries and samples over whole periods of a motion.
pub(super) struct Summary<'a> {
    equations: &'a Equations,
    outputs: &'a [Output],
    request: &'a Request,
    frequency: f64,
    periods: usize,
    /// Phase at the start of the current period of the load.
    pub offset: f64,
    sums: Vec<Sums>,
    samples: Vec<Vec<f64>>,
    x: Vec<f64>,
}

impl<'a> Summary<'a> {
    pub fn new(
        equations: &'a Equations,
        outputs: &'a [Output],
        request: &'a Request,
        frequency: f64,
        periods: usize,
    ) -> Self {
        let count = if request.harmonics > 0 {
            request.harmonics + 1
        } else {
            0
        };
        let sums = Sums {
            reference: None,
            integral: 0.0,
            square: 0.0,
            range: (f64::INFINITY, f64::NEG_INFINITY),
            harmonics: vec![Complex::ZERO; count],
        };
        Self {
            equations,
            outputs,
            request,
            frequency,
            periods,
            offset: 0.0,
            sums: vec![sums; outputs.len()],
            samples: vec![Vec::with_capacity(request.samples * periods); outputs.len()],
            x: vec![0.0; equations.state()],
        }
    }

    /// Value of a measure at the share `s` of a step.
    fn at(&mut self, step: &DenseStep<'_>, s: f64, output: usize) -> f64 {
        step.at(s, &mut self.x);
        let phase = self.frequency * (step.start + s * step.length);
        value(&self.outputs[output], self.equations, phase, &self.x)
    }

    /// Takes a step, its time counted from the start of the current period of the load.
    pub fn step(&mut self, step: &DenseStep<'_>) {
        self.integrate(step);
        self.sample(step);
        if self.request.extremes {
            for output in 0..self.outputs.len() {
                self.extend_range(step, output);
            }
        }
    }

    fn integrate(&mut self, step: &DenseStep<'_>) {
        let rule = gauss_legendre();
        // Harmonics turn faster than the motion itself: shorter panels keep the quadrature at rounding.
        let turn = self.request.harmonics as f64 * self.frequency / self.periods as f64 * step.length;
        let panels = (turn / 3.0).ceil().max(1.0);
        for panel in 0..panels as usize {
            for node in 0..NODES {
                let s = (panel as f64 + rule.nodes[node]) / panels;
                let weight = rule.weights[node] * step.length / panels;
                let phase = self.frequency * (step.start + s * step.length);
                let turn = Complex::from_polar(1.0, -(self.offset + phase) / self.periods as f64);
                step.at(s, &mut self.x);
                for (sums, output) in self.sums.iter_mut().zip(self.outputs) {
                    let absolute = value(output, self.equations, phase, &self.x);
                    let y = absolute - *sums.reference.get_or_insert(absolute);
                    sums.integral += weight * y;
                    sums.square += weight * y * y;
                    let mut power = Complex::from(weight * y);
                    for sum in &mut sums.harmonics {
                        *sum += power;
                        power *= turn;
                    }
                }
            }
        }
    }

    /// Takes the samples that fall into the step, its start included and its end not.
    fn sample(&mut self, step: &DenseStep<'_>) {
        if self.request.samples == 0 || self.outputs.is_empty() {
            return;
        }
        let interval = TAU / self.frequency / self.request.samples as f64;
        let done = (self.offset / TAU).round() as usize * self.request.samples;
        loop {
            let taken = self.samples[0].len() - done;
            let ahead = taken as f64 * interval - step.start;
            if taken >= self.request.samples || ahead >= step.length {
                return;
            }
            let s = (ahead / step.length).max(0.0);
            for output in 0..self.outputs.len() {
                let y = self.at(step, s, output);
                self.samples[output].push(y);
            }
        }
    }

    /// Extends the range of a measure by its values on the step.
    fn extend_range(&mut self, step: &DenseStep<'_>, output: usize) {
        let mut values = [0.0; GRID + 1];
        for (i, value) in values.iter_mut().enumerate() {
            *value = self.at(step, i as f64 / GRID as f64, output);
        }
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // Between points of the grid a smooth measure cannot rise by more than it varies over the whole step.
        let margin = high - low;
        for sign in [1.0, -1.0] {
            let best = values.map(|v| sign * v);
            let range = self.sums[output].range;
            let known = if sign > 0.0 { range.1 } else { -range.0 };
            let top = best.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let top = if top + margin > known {
                self.climb(step, output, sign, &best).max(top)
            } else {
                top
            };
            let range = &mut self.sums[output].range;
            if sign > 0.0 {
                range.1 = range.1.max(top);
            } else {
                range.0 = range.0.min(-top);
            }
        }
    }

    /// The largest value of `sign · y` near the largest on the grid, by golden sections.
    fn climb(&mut self, step: &DenseStep<'_>, output: usize, sign: f64, grid: &[f64; GRID + 1]) -> f64 {
        let peak = (0..=GRID).fold(0, |best, i| if grid[i] > grid[best] { i } else { best });
        let mut left = peak.saturating_sub(1) as f64 / GRID as f64;
        let mut right = (peak + 1).min(GRID) as f64 / GRID as f64;
        let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
        let mut inner = [right - ratio * (right - left), left + ratio * (right - left)];
        let mut values = inner.map(|s| sign * self.at(step, s, output));
        // The value is flat at the peak: an abscissa good to 1e-8 leaves the value good to rounding.
        while right - left > 1e-8 {
            if values[0] > values[1] {
                right = inner[1];
                inner = [right - ratio * (right - left), inner[0]];
                values = [sign * self.at(step, inner[0], output), values[0]];
            } else {
                left = inner[0];
                inner = [inner[1], left + ratio * (right - left)];
                values = [values[1], sign * self.at(step, inner[1], output)];
            }
        }
        values[0].max(values[1])
    }

    /// The record over all periods.
    pub fn finish(self) -> Record {
        let total = self.periods as f64 * TAU / self.frequency;
        let measures = self.sums.into_iter().map(|sums| {
            let shift = sums.integral / total;
            let mean = sums.reference.unwrap_or(0.0) + shift;
            let harmonics = sums.harmonics.iter().enumerate();
            MeasureSummary {
                mean,
                rms: (sums.square / total - shift * shift).max(0.0).sqrt(),
                max: sums.range.1,
                min: sums.range.0,
                harmonics: harmonics
                    .map(|(k, sum)| {
                        if k == 0 {
                            Complex::from(mean)
                        } else {
                            2.0 * sum / total
                        }
                    })
                    .collect(),
            }
        });
        Record {
            measures: measures.collect(),
            events: Vec::new(),
            fractions: Vec::new(),
            samples: self.samples,
            ..Record::default()
        }
    }
}

/// Intervals per step among which an extreme is looked for.
const GRID: usize = 8;
