//! Exact harmonics of a piecewise-linear law along a trigonometric polynomial (theory 02 §5.3).
//!
//! With all crossings of the breakpoints known, slope and constant of the law are step functions of the angle, whose
//! Fourier coefficients are sums over the steps. There is no sampling and no aliasing. Where the law is continuous the
//! motion of the crossings drops out of the derivative (C12); where it jumps, as dry friction does at rest, the derivative
//! has an impulse of size `jump/|dx/dθ|` there (theory 05 §5.4).

use super::{ForceEvaluation, PortForce, add_product};
use crate::orbit::harmonic_balance::crossings::{Crossing, CrossingSearch};
use crate::orbit::harmonic_balance::graph::{Argument, Graph};
use crate::orbit::harmonic_balance::layout::velocity;
use num_complex::Complex;
use slackside_numerics::fourier::{FourierPlanner, value, value_and_rate};
use std::f64::consts::TAU;

/// Least rate of a crossing of a jump relative to its mean rate around the turn; slower ones count as that fast.
const SLOWEST: f64 = 1e-9;

/// Exact evaluation of a piecewise-linear remainder of displacement or velocity.
#[derive(Debug, Clone)]
pub struct ExactSwitching {
    graph: Graph,
    drifts: bool,
    search: CrossingSearch,
    argument: Vec<Complex<f64>>,
    crossings: Vec<Crossing>,
    slopes: Vec<Complex<f64>>,
    constants: Vec<Complex<f64>>,
}

impl ExactSwitching {
    /// Evaluation of `graph` for motions with `harmonics` orders.
    pub fn new(graph: Graph, drifts: bool, harmonics: usize, planner: &mut FourierPlanner) -> Self {
        Self {
            graph,
            drifts,
            search: CrossingSearch::new(harmonics, planner),
            argument: vec![Complex::ZERO; harmonics + 1],
            crossings: Vec::new(),
            slopes: vec![Complex::ZERO; 2 * harmonics + 1],
            constants: vec![Complex::ZERO; harmonics + 1],
        }
    }

    /// Finds the crossings along the motion, and from them the Fourier coefficients of slope and constant as step functions
    /// of the angle, enough for `highest` orders of the force.
    fn steps(&mut self, displacement: &[Complex<f64>], omega: f64, highest: usize) {
        match self.graph.argument {
            Argument::Displacement => self.argument.copy_from_slice(displacement),
            Argument::Velocity => velocity(displacement, omega, self.drifts, &mut self.argument),
        }
        self.search
            .find(&self.argument, &self.graph.levels, &mut self.crossings);
        let graph = &self.graph;
        self.slopes.clear();
        self.slopes.resize(displacement.len() + highest, Complex::ZERO);
        self.constants.clear();
        self.constants.resize(highest + 1, Complex::ZERO);
        let mut piece = graph.piece_at(value(&self.argument, 0.0));
        let mut start = 0.0;
        let (mut mean_slope, mut mean_constant) = (0.0, 0.0);
        for crossing in &self.crossings {
            let (from, to) = match crossing.rising {
                true => (crossing.level, crossing.level + 1),
                false => (crossing.level + 1, crossing.level),
            };
            let share = (crossing.angle - start) / TAU;
            mean_slope += share * graph.slopes[piece];
            mean_constant += share * graph.constants[piece];
            let slope_step = (graph.slopes[to] - graph.slopes[from]) / TAU;
            let constant_step = (graph.constants[to] - graph.constants[from]) / TAU;
            let turn = Complex::cis(-crossing.angle);
            let mut phase = Complex::new(1.0, 0.0);
            for m in 1..self.slopes.len() {
                phase *= turn;
                // e^{−imθ} / (i m)
                let weight = Complex::new(phase.im, -phase.re) / m as f64;
                self.slopes[m] += slope_step * weight;
                if m < self.constants.len() {
                    self.constants[m] += constant_step * weight;
                }
            }
            piece = to;
            start = crossing.angle;
        }
        let share = (TAU - start) / TAU;
        self.slopes[0] = Complex::new(mean_slope + share * graph.slopes[piece], 0.0);
        self.constants[0] = Complex::new(mean_constant + share * graph.constants[piece], 0.0);
    }
}

impl ExactSwitching {
    /// Adds the Fourier coefficients of the impulses `jump · δ(x − level)` to those of the slope.
    fn add_impulses(&self, slopes: &mut [Complex<f64>]) {
        let size = |k: usize, h: &Complex<f64>| (k * k) as f64 * h.norm_sqr();
        let rates: f64 = self.argument.iter().enumerate().map(|(k, h)| size(k, h)).sum();
        let slowest = SLOWEST * rates.sqrt();
        for crossing in &self.crossings {
            let jump = self.graph.jumps[crossing.level];
            if jump == 0.0 || slowest == 0.0 {
                continue;
            }
            let (_, rate) = value_and_rate(&self.argument, crossing.angle);
            let weight = jump / (TAU * rate.abs().max(slowest));
            let turn = Complex::cis(-crossing.angle);
            let mut phase = Complex::ONE;
            for coefficient in slopes.iter_mut() {
                *coefficient += weight * phase;
                phase *= turn;
            }
        }
    }

    /// Writes the remainder force from the coefficients that [`Self::steps`] left.
    fn write_remainder(&self, remainder: &mut Vec<Complex<f64>>) {
        remainder.clear();
        let factor = |k: usize| if k == 0 { 1.0 } else { 2.0 };
        remainder.extend(self.constants.iter().enumerate().map(|(k, c)| factor(k) * c));
        add_product(&self.slopes, &self.argument, remainder);
    }
}

impl ForceEvaluation for ExactSwitching {
    fn evaluate(&mut self, displacement: &[Complex<f64>], omega: f64, force: &mut PortForce) {
        self.steps(displacement, omega, displacement.len() - 1);
        self.write_remainder(&mut force.remainder);
        let (used, unused) = match self.graph.argument {
            Argument::Displacement => (&mut force.by_displacement, &mut force.by_velocity),
            Argument::Velocity => (&mut force.by_velocity, &mut force.by_displacement),
        };
        used.clear();
        used.extend_from_slice(&self.slopes);
        unused.clear();
        force.direct = None;
        self.add_impulses(used);
    }

    fn remainder(&mut self, displacement: &[Complex<f64>], omega: f64, highest: usize) -> Vec<Complex<f64>> {
        let mut result = Vec::new();
        self.steps(displacement, omega, highest);
        self.write_remainder(&mut result);
        result
    }

    fn samples(&self) -> usize {
        0
    }
}
