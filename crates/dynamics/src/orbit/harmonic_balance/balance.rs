//! The equations of harmonic balance for one system: residual, Jacobian and derivative with respect to frequency.

use super::condensed::Condensed;
use super::crossings::{Crossing, CrossingSearch};
use super::force::{ExactSwitching, ForceEvaluation, PortForce, Sampled, add_product};
use super::graph::{Argument, Graph};
use super::layout::{pack, tail, unpack, write};
use super::linear_part::LinearPart;
use super::tangent::fill_tangent;
use super::{ForceMethod, HarmonicBalanceError, Settings};
use num_complex::Complex;
use slackside_linalg::{Matrix, norm};
use slackside_mechanics::System;
use slackside_numerics::fourier::{FourierPlanner, differentiate};
use std::sync::Arc;

/// The equations for one system and one number of harmonics. It owns all space; evaluation allocates nothing.
#[derive(Debug)]
pub struct Balance {
    /// The system.
    pub system: Arc<System>,
    /// Its linear part.
    pub linear: LinearPart,
    /// Elements with a remainder force, whose harmonics are the unknowns.
    pub nonlinear: Vec<usize>,
    /// Number of harmonics `H`.
    pub harmonics: usize,
    /// Subharmonic order `n`.
    pub subharmonic: usize,
    /// Amplitudes of the nonlinear elements' displacements at the last evaluation.
    pub displacements: Vec<Vec<Complex<f64>>>,
    /// Their remainder forces at the last evaluation.
    pub forces: Vec<PortForce>,
    evaluations: Vec<Box<dyn ForceEvaluation>>,
    graphs: Vec<Option<Graph>>,
    search: CrossingSearch,
    condensed: Condensed,
    condensed_at: Option<(f64, bool)>,
    tangents: Vec<Matrix>,
    rate: Vec<Complex<f64>>,
    force_rate: Vec<Vec<Complex<f64>>>,
}

/// The share of the amplitudes by which doubling the samples may change the residual.
const ALIASING: f64 = 1e-10;
/// Largest number of samples that refinement goes to.
const MOST_SAMPLES: usize = 1 << 16;

/// What to write beside the residual.
#[derive(Debug, Default)]
pub struct Derivatives<'a> {
    /// `∂r/∂z`.
    pub jacobian: Option<&'a mut Matrix>,
    /// `∂r/∂Ω` for a system that does not otherwise change.
    pub by_frequency: Option<&'a mut [f64]>,
}

/// The law of each element as a graph beside its linearisation, where it is one.
pub fn graphs(system: &System) -> Vec<Option<Graph>> {
    system
        .elements
        .iter()
        .map(|element| {
            let table = element.law.regimes()?;
            Graph::from_table(&table, element.law.linearized())
        })
        .collect()
}

impl Balance {
    /// The equations of `system` with `harmonics` orders; `samples` is the least number for sampled laws.
    pub fn new(
        system: Arc<System>,
        settings: &Settings,
        harmonics: usize,
        samples: usize,
        planner: &mut FourierPlanner,
    ) -> Self {
        let all = graphs(&system);
        let nonlinear: Vec<usize> = (0..system.elements.len())
            .filter(|&e| !all[e].as_ref().is_some_and(Graph::is_zero))
            .collect();
        let graphs: Vec<_> = nonlinear.iter().map(|&e| all[e].clone()).collect();
        let evaluations = nonlinear
            .iter()
            .zip(&graphs)
            .map(|(&e, graph)| -> Box<dyn ForceEvaluation> {
                match (graph, settings.force_method) {
                    (Some(graph), ForceMethod::Automatic) => {
                        Box::new(ExactSwitching::new(graph.clone(), harmonics, planner))
                    }
                    _ => {
                        let law = system.elements[e].law.clone();
                        Box::new(Sampled::new(law, harmonics, samples.max(16 * harmonics), planner))
                    }
                }
            })
            .collect();
        let (m, order) = (nonlinear.len(), 2 * harmonics + 1);
        Self {
            linear: LinearPart::new(&system, &nonlinear),
            search: CrossingSearch::new(harmonics, planner),
            system,
            harmonics,
            subharmonic: settings.subharmonic,
            displacements: vec![vec![Complex::ZERO; harmonics + 1]; m],
            forces: vec![PortForce::default(); m],
            evaluations,
            graphs,
            condensed: Condensed::default(),
            condensed_at: None,
            tangents: vec![Matrix::zeros(order, order); m],
            rate: vec![Complex::ZERO; harmonics + 1],
            force_rate: vec![vec![Complex::ZERO; harmonics + 1]; m],
            nonlinear,
        }
    }

    /// Number of real unknowns, `m (2H + 1)`.
    pub fn dimension(&self) -> usize {
        self.nonlinear.len() * (2 * self.harmonics + 1)
    }

    /// Largest number of time samples in use; zero if all laws are evaluated exactly.
    pub fn samples(&self) -> usize {
        self.evaluations.iter().map(|e| e.samples()).max().unwrap_or(0)
    }

    /// The linear response, packed as unknowns.
    ///
    /// # Errors
    /// [`HarmonicBalanceError::Resonance`].
    pub fn linear_response(&mut self, frequency: f64) -> Result<Vec<f64>, HarmonicBalanceError> {
        self.condense(frequency, false)?;
        let mut z = vec![0.0; self.dimension()];
        let order = 2 * self.harmonics + 1;
        for i in 0..self.nonlinear.len() {
            let port: Vec<_> = (0..=self.harmonics)
                .map(|k| self.condensed.response(k, i))
                .collect();
            pack(&port, &mut z[i * order..(i + 1) * order]);
        }
        Ok(z)
    }

    fn condense(&mut self, frequency: f64, with_rates: bool) -> Result<(), HarmonicBalanceError> {
        if let Some((at, rates)) = self.condensed_at
            && at == frequency
            && (rates || !with_rates)
        {
            return Ok(());
        }
        self.condensed_at = None;
        self.condensed.update(
            &self.linear,
            self.harmonics,
            frequency,
            self.subharmonic,
            with_rates,
        )?;
        self.condensed_at = Some((frequency, with_rates));
        Ok(())
    }

    /// Takes the amplitudes of the ports from `z`.
    pub fn unpack(&mut self, z: &[f64]) {
        let order = 2 * self.harmonics + 1;
        for (i, port) in self.displacements.iter_mut().enumerate() {
            unpack(&z[i * order..(i + 1) * order], port);
        }
    }

    /// Unpacks `z` and evaluates the remainder forces.
    pub fn evaluate_forces(&mut self, z: &[f64], frequency: f64) {
        self.unpack(z);
        let omega = frequency / self.subharmonic as f64;
        for ((port, evaluation), force) in self
            .displacements
            .iter()
            .zip(&mut self.evaluations)
            .zip(&mut self.forces)
        {
            evaluation.evaluate(port, omega, force);
        }
    }

    /// Amplitudes of the remainder forces at the last evaluation, also beyond `H`.
    pub fn remainders(&mut self, frequency: f64, highest: usize) -> Vec<Vec<Complex<f64>>> {
        let omega = frequency / self.subharmonic as f64;
        let evaluations = self.evaluations.iter_mut().zip(&self.displacements);
        evaluations
            .map(|(evaluation, port)| evaluation.remainder(port, omega, highest))
            .collect()
    }

    /// Compares the residual at `z` with that from twice the samples. Returns their number if the residual then changes by
    /// more than `1e-10` of the amplitudes; `None` if the samples suffice, nothing is sampled, or their limit is reached.
    pub fn aliased(
        &mut self,
        z: &[f64],
        frequency: f64,
        settings: &Settings,
        planner: &mut FourierPlanner,
    ) -> Option<usize> {
        let used = self.samples();
        if used == 0 || used >= MOST_SAMPLES {
            return None;
        }
        let mut finer = Self::new(self.system.clone(), settings, self.harmonics, 2 * used, planner);
        let (mut coarse, mut fine) = (vec![0.0; z.len()], vec![0.0; z.len()]);
        // A resonance, the only fault, is met by both and reported by whoever evaluates next.
        self.evaluate(z, frequency, &mut coarse, Derivatives::default())
            .ok()?;
        finer
            .evaluate(z, frequency, &mut fine, Derivatives::default())
            .ok()?;
        let change = coarse
            .iter()
            .zip(&fine)
            .map(|(a, b)| (a - b).powi(2))
            .sum::<f64>()
            .sqrt();
        (change > ALIASING * norm(z)).then_some(2 * used)
    }

    /// Writes the residual at `z` and frequency `Ω`, and what `derivatives` asks for.
    ///
    /// # Errors
    /// [`HarmonicBalanceError::Resonance`].
    pub fn evaluate(
        &mut self,
        z: &[f64],
        frequency: f64,
        residual: &mut [f64],
        derivatives: Derivatives<'_>,
    ) -> Result<(), HarmonicBalanceError> {
        self.condense(frequency, derivatives.by_frequency.is_some())?;
        self.evaluate_forces(z, frequency);
        let m = self.nonlinear.len();
        let order = 2 * self.harmonics + 1;
        for i in 0..m {
            for k in 0..=self.harmonics {
                let mut r = self.displacements[i][k] - self.condensed.response(k, i);
                for j in 0..m {
                    r += self.condensed.receptance(k, i, j) * self.forces[j].remainder[k];
                }
                write(residual, i * order, k, r);
            }
        }
        if let Some(jacobian) = derivatives.jacobian {
            self.jacobian(frequency, jacobian);
        }
        if let Some(by_frequency) = derivatives.by_frequency {
            self.by_frequency(by_frequency);
        }
        Ok(())
    }

    /// `J = I + R ∂N/∂u`, where `∂N/∂u` is Toeplitz plus Hankel in the Fourier coefficients of the tangents.
    fn jacobian(&mut self, frequency: f64, jacobian: &mut Matrix) {
        let omega = frequency / self.subharmonic as f64;
        let m = self.nonlinear.len();
        let order = 2 * self.harmonics + 1;
        for (force, tangent) in self.forces.iter().zip(&mut self.tangents) {
            fill_tangent(force, self.harmonics, omega, tangent);
        }
        for i in 0..m {
            for j in 0..m {
                let tangent = &self.tangents[j];
                let columns = j * order..(j + 1) * order;
                let mean = self.condensed.receptance(0, i, j).re;
                let out = &mut jacobian.row_mut(i * order)[columns.clone()];
                for (o, t) in out.iter_mut().zip(tangent.row(0)) {
                    *o = mean * t;
                }
                for k in 1..=self.harmonics {
                    let r = self.condensed.receptance(k, i, j);
                    let (real, imaginary) = (tangent.row(2 * k - 1), tangent.row(2 * k));
                    for (row, a, b) in [(2 * k - 1, r.re, -r.im), (2 * k, r.im, r.re)] {
                        let out = &mut jacobian.row_mut(i * order + row)[columns.clone()];
                        for ((o, x), y) in out.iter_mut().zip(real).zip(imaginary) {
                            *o = a * x + b * y;
                        }
                    }
                }
            }
        }
        for i in 0..m * order {
            jacobian[(i, i)] += 1.0;
        }
    }

    /// `∂r/∂Ω = −u_lin' + R' N + R ∂N/∂Ω`; the force depends on `Ω` at fixed amplitudes through the velocity.
    fn by_frequency(&mut self, result: &mut [f64]) {
        let m = self.nonlinear.len();
        let order = 2 * self.harmonics + 1;
        for j in 0..m {
            self.force_rate[j].fill(Complex::ZERO);
            if !self.forces[j].by_velocity.is_empty() {
                differentiate(
                    &self.displacements[j],
                    1.0 / self.subharmonic as f64,
                    &mut self.rate,
                );
                add_product(&self.forces[j].by_velocity, &self.rate, &mut self.force_rate[j]);
            }
        }
        for i in 0..m {
            for k in 0..=self.harmonics {
                let mut sum = -self.condensed.response_rate(k, i);
                for j in 0..m {
                    sum += self.condensed.receptance_rate(k, i, j) * self.forces[j].remainder[k]
                        + self.condensed.receptance(k, i, j) * self.force_rate[j][k];
                }
                write(result, i * order, k, sum);
            }
        }
    }

    /// The tail `τ` of the amplitudes at the last evaluation (theory 02 §5.5), the largest over the ports.
    pub fn tail(&self) -> f64 {
        self.displacements
            .iter()
            .map(|port| tail(port))
            .fold(0.0, f64::max)
    }

    /// Number of switchings of all elements at the last evaluation.
    pub fn switchings(&mut self, frequency: f64) -> usize {
        let omega = frequency / self.subharmonic as f64;
        let mut crossings: Vec<Crossing> = Vec::new();
        let mut count = 0;
        for (graph, port) in self.graphs.iter().zip(&self.displacements) {
            let Some(graph) = graph else { continue };
            let argument = match graph.argument {
                Argument::Displacement => port,
                Argument::Velocity => {
                    differentiate(port, omega, &mut self.rate);
                    &self.rate
                }
            };
            self.search.find(argument, &graph.levels, &mut crossings);
            count += crossings.len();
        }
        count
    }
}
