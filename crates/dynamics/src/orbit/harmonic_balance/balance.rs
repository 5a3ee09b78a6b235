//! The equations of harmonic balance for one system: residual, Jacobian and derivative with respect to frequency.

use super::condensed::Condensed;
use super::crossings::{Crossing, CrossingSearch};
use super::force::{ExactSwitching, ForceEvaluation, Marched, PortForce, Sampled, add_product};
use super::graph::{Argument, Graph};
use super::layout::{pack, tail, unpack, velocity, write};
use super::linear_part::LinearPart;
use super::linearization::Linearization;
use super::tangent::fill_tangent;
use super::{ForceMethod, HarmonicBalanceError, Settings};
use num_complex::Complex;
use slackside_linalg::{Matrix, norm};
use slackside_mechanics::System;
use slackside_numerics::fourier::FourierPlanner;
use std::sync::Arc;

/// The equations for one system and one number of harmonics. It owns all space; evaluation allocates nothing.
#[derive(Debug)]
pub struct Balance {
    /// The system.
    pub system: Arc<System>,
    /// How its elements are split, and where it drifts.
    pub linearization: Arc<Linearization>,
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
pub fn graphs(system: &System, linearization: &Linearization) -> Vec<Option<Graph>> {
    system
        .elements
        .iter()
        .zip(&linearization.elements)
        .map(|(element, &linear)| Graph::from_table(&element.law.regimes()?, linear))
        .collect()
}

/// Checks that every law can be balanced.
///
/// # Errors
/// [`HarmonicBalanceError::NotCovered`] for a one-sided set-valued law and for an internal state that switches.
pub fn check_laws(system: &System) -> Result<(), HarmonicBalanceError> {
    for element in &system.elements {
        let Some(table) = element.law.regimes() else {
            continue;
        };
        let reason = if table.internal {
            "its internal state switches; use the exact motion"
        } else if !table.rests.is_empty() && Graph::from_table(&table, (0.0, 0.0)).is_none() {
            "its force has no finite values on one side; use a one-way damper with a large damping, or the exact motion"
        } else {
            continue;
        };
        return Err(HarmonicBalanceError::NotCovered {
            element: element.name.clone(),
            kind: element.law.kind(),
            reason,
        });
    }
    Ok(())
}

impl Balance {
    /// The equations of `system` with `harmonics` orders; `samples` is the number for sampled laws, the least one unless the
    /// settings keep it.
    pub fn new(
        system: Arc<System>,
        settings: &Settings,
        harmonics: usize,
        samples: usize,
        planner: &mut FourierPlanner,
    ) -> Self {
        let linearization = Arc::new(Linearization::of(&system));
        let all = graphs(&system, &linearization);
        let samples = match settings.refine_samples {
            true => samples.max(16 * harmonics).next_power_of_two(),
            false => samples,
        };
        let nonlinear: Vec<usize> = (0..system.elements.len())
            .filter(|&e| !all[e].as_ref().is_some_and(Graph::is_zero))
            .collect();
        let graphs: Vec<_> = nonlinear.iter().map(|&e| all[e].clone()).collect();
        let evaluations = nonlinear
            .iter()
            .zip(&graphs)
            .map(|(&e, graph)| -> Box<dyn ForceEvaluation> {
                let law = system.elements[e].law.clone();
                let (linear, drifts) = (linearization.elements[e], linearization.drifting[e]);
                match (graph, settings.force_method) {
                    (Some(graph), ForceMethod::Automatic) => {
                        Box::new(ExactSwitching::new(graph.clone(), drifts, harmonics, planner))
                    }
                    _ if law.memory().is_some() => {
                        Box::new(Marched::new(law, linear, harmonics, samples, planner))
                    }
                    _ => Box::new(Sampled::new(law, linear, drifts, harmonics, samples, planner)),
                }
            })
            .collect();
        let (m, order) = (nonlinear.len(), 2 * harmonics + 1);
        Self {
            linear: LinearPart::new(&system, &linearization, &nonlinear),
            linearization,
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

    /// Whether a law has a narrow transition at rest, so that a wider one is easier to solve.
    pub fn has_transitions(&self) -> bool {
        let laws = self.nonlinear.iter().map(|&e| &self.system.elements[e].law);
        laws.into_iter().any(|law| law.widened(f64::MAX).is_some())
    }

    /// Widens every transition at rest to half the velocity of the linear response `z` divided by `divisor`, and restores those
    /// that are wider than that anyway. Returns whether any is widened.
    pub fn widen(&mut self, z: &[f64], frequency: f64, divisor: f64) -> bool {
        let omega = frequency / self.subharmonic as f64;
        let order = 2 * self.harmonics + 1;
        let mut any = false;
        for (i, &e) in self.nonlinear.iter().enumerate() {
            let amplitudes = z[i * order + 1..(i + 1) * order].chunks(2).enumerate();
            let velocity = amplitudes
                .map(|(k, h)| (k + 1) as f64 * omega * norm(h))
                .fold(0.0, f64::max);
            let law = &self.system.elements[e].law;
            let wider = law.widened(0.5 * velocity / divisor);
            any |= wider.is_some();
            self.evaluations[i].set_law(wider.unwrap_or_else(|| law.clone()));
        }
        any
    }

    /// Internal states at the start of the period of the elements with a smooth memory, in element order.
    pub fn internal_states(&mut self, frequency: f64) -> Vec<f64> {
        let omega = frequency / self.subharmonic as f64;
        let evaluations = self.evaluations.iter_mut().zip(&self.displacements);
        evaluations
            .filter_map(|(evaluation, port)| evaluation.internal_state(port, omega))
            .collect()
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
    /// more than `1e-10` of the amplitudes; `None` if the samples suffice or are to be kept, nothing is sampled, or their limit
    /// is reached.
    pub fn aliased(
        &mut self,
        z: &[f64],
        frequency: f64,
        settings: &Settings,
        planner: &mut FourierPlanner,
    ) -> Option<usize> {
        let used = self.samples();
        if !settings.refine_samples || used == 0 || used >= MOST_SAMPLES {
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
        let ports = self.nonlinear.iter();
        for ((force, tangent), &e) in self.forces.iter().zip(&mut self.tangents).zip(ports) {
            fill_tangent(
                force,
                self.harmonics,
                omega,
                self.linearization.drifting[e],
                tangent,
            );
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
            let share = 1.0 / self.subharmonic as f64;
            if let Some(direct) = &self.forces[j].direct {
                for (out, value) in self.force_rate[j].iter_mut().zip(&direct.by_frequency) {
                    *out = share * value;
                }
            } else if !self.forces[j].by_velocity.is_empty() {
                // A mean velocity does not follow the frequency.
                velocity(&self.displacements[j], share, false, &mut self.rate);
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
        let ports = self.displacements.iter().zip(&self.nonlinear);
        for (graph, (port, &e)) in self.graphs.iter().zip(ports) {
            let Some(graph) = graph else { continue };
            let argument = match graph.argument {
                Argument::Displacement => port,
                Argument::Velocity => {
                    velocity(port, omega, self.linearization.drifting[e], &mut self.rate);
                    &self.rate
                }
            };
            self.search.find(argument, &graph.levels, &mut crossings);
            count += crossings.len();
        }
        count
    }
}
