//! Harmonics of a law with a smooth memory, by integrating its internal state around the period (theory 05 §6.3).
//!
//! The state moves by the classical rule of order four from sample to sample; steps also end where the velocity changes its
//! sign, since rates of Duhem's type have a kink there. The periodic state is the fixed point of the map of one turn, found
//! by Newton's method in one unknown (in one step for Dahl's and the LuGre model, whose equations are linear in the state).
//! Derivatives are those of the discrete rule itself.

use super::{DirectTangent, ForceEvaluation, PortForce};
use num_complex::Complex;
use slackside_linalg::Matrix;
use slackside_mechanics::{Law, MemoryResponse};
use slackside_numerics::fourier::{FourierPlanner, FourierTransform, differentiate, value};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Velocities below this share of the largest one count as zero at the end of a step: its side is that of the step.
const AT_REST: f64 = 1e-9;
/// Newton steps at most for the periodic state.
const TURNS: usize = 30;

/// Evaluation of a law with memory beside its linear spring and damper.
#[derive(Debug, Clone)]
pub struct Marched {
    law: Arc<dyn Law>,
    linear: (f64, f64),
    samples: usize,
    /// Twice the samples: steps need their middles.
    fine: FourierTransform,
    coarse: FourierTransform,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    rate: Vec<Complex<f64>>,
    steps: Vec<Step>,
    /// Internal state at the start of each step.
    states: Vec<f64>,
    /// State at the start, kept as the first guess of the next evaluation.
    start: f64,
}

/// A moment of the motion.
#[derive(Debug, Clone, Copy, Default)]
struct Moment {
    angle: f64,
    displacement: f64,
    velocity: f64,
}

/// One step of the rule between two angles.
#[derive(Debug, Clone, Copy, Default)]
struct Step {
    /// Sample at which it starts, if it does not start at a change of sign.
    sample: Option<usize>,
    /// Start, middle, end.
    moments: [Moment; 3],
}

/// A step with its derivatives: factors of the variations of the state and of `u` and `v` at start, middle and end.
#[derive(Debug, Clone, Copy, Default)]
struct Advance {
    state: f64,
    by_state: f64,
    by_displacement: [f64; 3],
    by_velocity: [f64; 3],
    by_length: f64,
}

impl Marched {
    /// Evaluation for motions with `harmonics` orders on `samples` points, never fewer than `4H + 2`.
    pub fn new(
        law: Arc<dyn Law>,
        linear: (f64, f64),
        harmonics: usize,
        samples: usize,
        planner: &mut FourierPlanner,
    ) -> Self {
        let samples = samples.max(4 * harmonics + 2);
        Self {
            law,
            linear,
            samples,
            fine: planner.transform(2 * samples),
            coarse: planner.transform(samples),
            displacement: vec![0.0; 2 * samples],
            velocity: vec![0.0; 2 * samples],
            rate: vec![Complex::ZERO; harmonics + 1],
            steps: Vec::with_capacity(samples + 8),
            states: Vec::with_capacity(samples + 8),
            start: 0.0,
        }
    }

    fn at(&self, displacement: f64, velocity: f64, internal: f64) -> MemoryResponse {
        // Only laws with memory are given to this evaluation.
        self.law.memory().map_or_else(MemoryResponse::default, |memory| {
            memory.evaluate(displacement, velocity, internal)
        })
    }

    /// Divides the turn into steps.
    fn divide(&mut self, displacement: &[Complex<f64>], omega: f64) {
        differentiate(displacement, omega, &mut self.rate);
        self.fine.synthesize(displacement, &mut self.displacement);
        self.fine.synthesize(&self.rate, &mut self.velocity);
        let largest = self.velocity.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let count = 2 * self.samples;
        let grid = |j: usize| TAU * j as f64 / count as f64;
        let (u, v, rate) = (&self.displacement, &self.velocity, &self.rate);
        let sampled = |j: usize| Moment {
            angle: grid(j),
            displacement: u[j % count],
            velocity: v[j % count],
        };
        let anywhere = |angle: f64| Moment {
            angle,
            displacement: value(displacement, angle),
            velocity: value(rate, angle),
        };
        let is_change =
            |a: f64, b: f64| a * b < 0.0 && a.abs() > AT_REST * largest && b.abs() > AT_REST * largest;
        self.steps.clear();
        for sample in 0..self.samples {
            let moments = [
                sampled(2 * sample),
                sampled(2 * sample + 1),
                sampled(2 * sample + 2),
            ];
            let halves = [(moments[0], moments[1]), (moments[1], moments[2])];
            let changes = halves.iter().filter(|(a, b)| is_change(a.velocity, b.velocity));
            let changes: Vec<f64> = changes.map(|(a, b)| zero(rate, *a, *b)).collect();
            let first = self.steps.len();
            if changes.is_empty() {
                self.steps.push(Step {
                    sample: Some(sample),
                    moments,
                });
            } else {
                let mut from = moments[0];
                for to in changes.into_iter().map(anywhere).chain([moments[2]]) {
                    let middle = anywhere(0.5 * (from.angle + to.angle));
                    self.steps.push(Step {
                        sample: None,
                        moments: [from, middle, to],
                    });
                    from = to;
                }
                self.steps[first].sample = Some(sample);
            }
            for step in &mut self.steps[first..] {
                // The smallest positive number tells the side and is nothing else.
                let side = step.moments[1].velocity.signum() * f64::MIN_POSITIVE;
                for end in [0, 2] {
                    let moment = &mut step.moments[end];
                    if moment.velocity.abs() <= AT_REST * largest {
                        moment.velocity = side;
                    }
                }
            }
        }
    }

    /// One step of the classical rule from `state`.
    fn advance(&self, step: &Step, state: f64, omega: f64) -> Advance {
        let [a, m, b] = step.moments;
        let h = (b.angle - a.angle) / omega;
        let k1 = self.at(a.displacement, a.velocity, state);
        let k2 = self.at(m.displacement, m.velocity, state + 0.5 * h * k1.rate);
        let k3 = self.at(m.displacement, m.velocity, state + 0.5 * h * k2.rate);
        let k4 = self.at(b.displacement, b.velocity, state + h * k3.rate);
        // Weights with which a change of each stage's rate reaches the end.
        let s4 = h / 6.0;
        let s3 = h / 3.0 + h * k4.rate_by.internal * s4;
        let s2 = h / 3.0 + 0.5 * h * k3.rate_by.internal * s3;
        let s1 = h / 6.0 + 0.5 * h * k2.rate_by.internal * s2;
        let (g1, g2, g3, g4) = (k1.rate_by, k2.rate_by, k3.rate_by, k4.rate_by);
        let mean = (k1.rate + 2.0 * (k2.rate + k3.rate) + k4.rate) / 6.0;
        Advance {
            state: state + h * mean,
            by_state: 1.0 + s1 * g1.internal + s2 * g2.internal + s3 * g3.internal + s4 * g4.internal,
            by_displacement: [
                s1 * g1.displacement,
                s2 * g2.displacement + s3 * g3.displacement,
                s4 * g4.displacement,
            ],
            by_velocity: [
                s1 * g1.velocity,
                s2 * g2.velocity + s3 * g3.velocity,
                s4 * g4.velocity,
            ],
            by_length: mean
                + 0.5 * (s2 * g2.internal * k1.rate + s3 * g3.internal * k2.rate)
                + s4 * g4.internal * k3.rate,
        }
    }

    /// Finds the periodic internal state; leaves it in `states`.
    fn settle(&mut self, omega: f64) {
        let mut start = if self.start.is_finite() { self.start } else { 0.0 };
        for _ in 0..TURNS {
            let (mut state, mut slope) = (start, 1.0);
            self.states.clear();
            for index in 0..self.steps.len() {
                self.states.push(state);
                let advance = self.advance(&self.steps[index], state, omega);
                state = advance.state;
                slope *= advance.by_state;
            }
            let change = state - start;
            let scale = self.law.memory().map_or(1.0, |memory| memory.scale());
            // A port at rest keeps any state.
            let step = if 1.0 - slope > 1e-12 {
                change / (1.0 - slope)
            } else {
                change
            };
            if step.abs() <= 1e-15 * scale.max(start.abs()) || !step.is_finite() {
                break;
            }
            start += step;
        }
        self.start = start;
    }

    fn force(&self, step: &Step, state: f64) -> (f64, MemoryResponse) {
        let moment = step.moments[0];
        let response = self.at(moment.displacement, moment.velocity, state);
        let (spring, damper) = self.linear;
        let linear = spring * moment.displacement + damper * moment.velocity;
        (response.force - linear, response)
    }

    /// Samples of the remainder force along the motion.
    fn remainders(&mut self, displacement: &[Complex<f64>], omega: f64) -> Vec<f64> {
        self.divide(displacement, omega);
        self.settle(omega);
        let steps = self.steps.iter().zip(&self.states);
        let starts = steps.filter(|(step, _)| step.sample.is_some());
        starts.map(|(step, &state)| self.force(step, state).0).collect()
    }

    /// Derivatives of the samples of the remainder with respect to the unknowns of the port, and last to `ω`: one row a
    /// sample.
    fn derivatives(&self, harmonics: usize, omega: f64) -> Matrix {
        let columns = 2 * harmonics + 2;
        let mut result = Matrix::zeros(self.samples, columns);
        // Variations of u and v at one moment, by column.
        let fill = |moment: &Moment, du: &mut [f64], dv: &mut [f64]| {
            (du[0], dv[0]) = (1.0, 0.0);
            let turn = Complex::cis(moment.angle);
            let mut phase = Complex::<f64>::ONE;
            for k in 1..=harmonics {
                phase *= turn;
                let rate = k as f64 * omega;
                (du[2 * k - 1], du[2 * k]) = (phase.re, -phase.im);
                (dv[2 * k - 1], dv[2 * k]) = (-rate * phase.im, -rate * phase.re);
            }
            (du[columns - 1], dv[columns - 1]) = (0.0, moment.velocity / omega);
        };
        let mut basis = vec![vec![0.0; 2 * columns]; 3];
        let mut variation = vec![0.0; columns];
        let (mut product, mut products) = (1.0, vec![0.0; self.samples]);
        let mut factors = vec![0.0; self.samples];
        let (spring, damper) = self.linear;
        for (index, step) in self.steps.iter().enumerate() {
            for (values, moment) in basis.iter_mut().zip(&step.moments) {
                let (du, dv) = values.split_at_mut(columns);
                fill(moment, du, dv);
            }
            let state = self.states[index];
            if let Some(sample) = step.sample {
                let (_, response) = self.force(step, state);
                let by = response.force_by;
                let (du, dv) = basis[0].split_at(columns);
                let row = result.row_mut(sample);
                for j in 0..columns {
                    row[j] = (by.displacement - spring) * du[j]
                        + (by.velocity - damper) * dv[j]
                        + by.internal * variation[j];
                }
                products[sample] = product;
                factors[sample] = by.internal;
            }
            let advance = self.advance(step, state, omega);
            let length = (step.moments[2].angle - step.moments[0].angle) / omega;
            for (j, value) in variation.iter_mut().enumerate() {
                let mut next = advance.by_state * *value;
                for (stage, values) in basis.iter().enumerate() {
                    next += advance.by_displacement[stage] * values[j]
                        + advance.by_velocity[stage] * values[columns + j];
                }
                *value = next;
            }
            variation[columns - 1] -= advance.by_length * length / omega;
            product *= advance.by_state;
        }
        // The state at the start moves so that the turn closes.
        if 1.0 - product > 1e-12 {
            for sample in 0..self.samples {
                let factor = factors[sample] * products[sample] / (1.0 - product);
                for (entry, v) in result.row_mut(sample).iter_mut().zip(&variation) {
                    *entry += factor * v;
                }
            }
        }
        result
    }
}

impl ForceEvaluation for Marched {
    fn evaluate(&mut self, displacement: &[Complex<f64>], omega: f64, force: &mut PortForce) {
        let harmonics = displacement.len() - 1;
        let samples = self.remainders(displacement, omega);
        force.remainder.resize(harmonics + 1, Complex::ZERO);
        self.coarse.analyze(&samples, &mut force.remainder);
        force.by_displacement.clear();
        force.by_velocity.clear();
        let derivatives = self.derivatives(harmonics, omega);
        let order = 2 * harmonics + 1;
        let mut direct = DirectTangent {
            matrix: Matrix::zeros(order, order),
            by_frequency: vec![Complex::ZERO; harmonics + 1],
        };
        let mut amplitudes = vec![Complex::ZERO; harmonics + 1];
        for column in 0..order {
            self.coarse.analyze(&derivatives.column(column), &mut amplitudes);
            direct.matrix[(0, column)] = amplitudes[0].re;
            for k in 1..=harmonics {
                direct.matrix[(2 * k - 1, column)] = amplitudes[k].re;
                direct.matrix[(2 * k, column)] = amplitudes[k].im;
            }
        }
        self.coarse
            .analyze(&derivatives.column(order), &mut direct.by_frequency);
        force.direct = Some(direct);
    }

    fn remainder(&mut self, displacement: &[Complex<f64>], omega: f64, highest: usize) -> Vec<Complex<f64>> {
        let samples = self.remainders(displacement, omega);
        let mut result = vec![Complex::ZERO; highest + 1];
        // Orders beyond a quarter of the samples are aliased as strongly as they are present.
        let told = highest.min(self.samples / 4);
        self.coarse.analyze(&samples, &mut result[..=told]);
        result
    }

    fn samples(&self) -> usize {
        self.samples
    }

    fn internal_state(&mut self, displacement: &[Complex<f64>], omega: f64) -> Option<f64> {
        self.divide(displacement, omega);
        self.settle(omega);
        Some(self.start)
    }
}

/// The angle between two moments of opposite velocity where it vanishes, by bisection with secant steps.
fn zero(rate: &[Complex<f64>], a: Moment, b: Moment) -> f64 {
    let (mut low, mut high) = ((a.angle, a.velocity), (b.angle, b.velocity));
    for iteration in 0..60 {
        let width = high.0 - low.0;
        if width <= 4.0 * f64::EPSILON * high.0 {
            break;
        }
        let secant = low.0 - low.1 * width / (high.1 - low.1);
        let is_inside = secant > low.0 && secant < high.0;
        let middle = if is_inside && iteration % 3 != 2 {
            secant
        } else {
            0.5 * (low.0 + high.0)
        };
        let velocity = value(rate, middle);
        if velocity == 0.0 {
            return middle;
        }
        if (velocity < 0.0) == (low.1 < 0.0) {
            low = (middle, velocity);
        } else {
            high = (middle, velocity);
        }
    }
    0.5 * (low.0 + high.0)
}
