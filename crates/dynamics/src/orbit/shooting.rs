//! Periodic motions by shooting (theory 02 §8).

use super::floquet::{multipliers, neimark_sacker_test, period_doubling_test};
use crate::flow::{Flow, FlowError, Record, Request, open_with_rate};
use slackside_continuation::{Evaluation, Family, FamilyError};
use slackside_linalg::{Complex, Lu, Matrix};
use slackside_mechanics::{Output, System, SystemFamily, modes};
use std::sync::Arc;

/// A periodic motion, known to rounding.
#[derive(Debug, Clone)]
pub struct Orbit {
    /// Parameter of the family at which it was found.
    pub parameter: f64,
    /// Frequency of the load.
    pub frequency: f64,
    /// Periods of the load after which it repeats.
    pub periods: usize,
    /// State `(q, q')` at phase zero.
    pub start: Vec<f64>,
    /// Monodromy matrix over the motion's period.
    pub monodromy: Matrix,
    /// Floquet multipliers, largest modulus first.
    pub multipliers: Vec<Complex>,
    /// Largest difference between the states at start and end, relative to the scale of the state.
    pub residual: f64,
    /// Newton iterations spent.
    pub iterations: usize,
}

impl Orbit {
    /// Whether all multipliers lie inside the unit circle.
    pub fn is_stable(&self) -> bool {
        self.multipliers.iter().all(|multiplier| multiplier.norm() < 1.0)
    }
}

/// Why shooting found no periodic motion.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShootingError {
    /// The flow failed.
    #[error(transparent)]
    Flow(#[from] FlowError),
    /// Newton's method did not converge.
    #[error(
        "shooting did not converge: after {iterations} iterations the state misses itself by {residual:.1e} of its scale"
    )]
    NoConvergence {
        /// Iterations spent.
        iterations: usize,
        /// Last residual, relative to the scale of the state.
        residual: f64,
    },
}

/// The residual `P(x) − x` of the map over `n` periods of the load, as a family.
pub struct Shooting {
    family: Arc<dyn SystemFamily>,
    periods: usize,
    flow: (f64, Box<dyn Flow>),
    variations: Vec<f64>,
    scales: Vec<f64>,
    /// Coordinates on which nothing depends: turned back to zero at the end of the period, so that the motion may leave
    /// them turned (theory 05 §3.1).
    cyclic: Vec<usize>,
    parameter_scale: f64,
    /// Events met by the last map.
    events: usize,
    /// Maps computed so far.
    evaluations: usize,
}

impl Shooting {
    /// Motions that repeat after `periods` periods of the load. Scales are taken from the system at `parameter`.
    ///
    /// # Errors
    /// [`FlowError`] if there is no piecewise-linear system there.
    pub fn new(family: Arc<dyn SystemFamily>, parameter: f64, periods: usize) -> Result<Self, FlowError> {
        let point = family.at(parameter)?;
        let flow = open_with_rate(family.as_ref(), parameter)?;
        let scales = state_scales(&point.system, point.frequency)?;
        let nx = flow.dimension();
        let mut unknowns = scales.displacement.clone();
        unknowns.extend(scales.displacement.iter().map(|d| d * scales.frequency));
        // An internal state is a wind-up, of the size of a displacement.
        unknowns.resize(nx, scales.displacement.first().copied().unwrap_or(1.0));
        let parameter_scale = if family.is_frequency() {
            scales.frequency
        } else {
            parameter.abs().max(1e-3)
        };
        Ok(Self {
            family,
            periods,
            flow: (parameter, flow),
            variations: vec![0.0; nx * (nx + 1)],
            scales: unknowns,
            cyclic: point.system.cyclic_coordinates(),
            parameter_scale,
            events: 0,
            evaluations: 0,
        })
    }

    /// Sets the typical size of the parameter (by default the lowest natural frequency, or the value at the start).
    pub fn set_parameter_scale(&mut self, scale: f64) {
        self.parameter_scale = scale;
    }

    /// Periods of the load after which the motions repeat.
    pub fn periods(&self) -> usize {
        self.periods
    }

    /// Number of maps with derivatives computed so far: the unit of cost of shooting and continuation.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// The flow at a parameter value.
    ///
    /// # Errors
    /// [`FlowError`] where the family has no system.
    pub fn flow(&mut self, parameter: f64) -> Result<&mut dyn Flow, FlowError> {
        let (at, flow) = &mut self.flow;
        if *at != parameter {
            let sound = parameter > 0.0 && parameter.is_finite();
            if !(self.family.is_frequency() && sound && flow.set_frequency(parameter)) {
                *flow = open_with_rate(self.family.as_ref(), parameter)?;
            }
            *at = parameter;
        }
        Ok(flow.as_mut())
    }

    /// The map over the motion's period with its derivatives: end state, monodromy matrix, derivative with respect to the
    /// parameter at fixed phases.
    ///
    /// # Errors
    /// [`FlowError`].
    pub fn map(&mut self, start: &[f64], parameter: f64) -> Result<(Vec<f64>, Matrix, Vec<f64>), FlowError> {
        self.evaluations += 1;
        let nx = self.scales.len();
        let periods = self.periods;
        let mut variations = std::mem::take(&mut self.variations);
        variations.fill(0.0);
        for i in 0..nx {
            variations[i * nx + i] = 1.0;
        }
        let mut end = start.to_vec();
        let outcome = self
            .flow(parameter)
            .and_then(|flow| flow.advance(&mut end, periods, &mut variations));
        let mut monodromy = Matrix::zeros(nx, nx);
        for j in 0..nx {
            for i in 0..nx {
                monodromy[(i, j)] = variations[j * nx + i];
            }
        }
        let mut by_parameter = variations[nx * nx..].to_vec();
        self.variations = variations;
        self.events = outcome?;
        for &i in &self.cyclic {
            end[i] = 0.0;
            by_parameter[i] = 0.0;
            monodromy.row_mut(i).fill(0.0);
        }
        Ok((end, monodromy, by_parameter))
    }

    /// Newton's method for a periodic motion at a fixed parameter, from a state near it. Steps longer than twenty times
    /// the scale of the state are shortened.
    ///
    /// # Errors
    /// [`ShootingError`].
    pub fn solve(&mut self, guess: &[f64], parameter: f64) -> Result<Orbit, ShootingError> {
        let nx = self.scales.len();
        if guess.len() != nx {
            return Err(FlowError::StateLength {
                expected: nx,
                found: guess.len(),
            }
            .into());
        }
        let mut x = guess.to_vec();
        let mut last = f64::INFINITY;
        let limit = 40;
        for iterations in 0..=limit {
            let (end, monodromy, _) = self.map(&x, parameter)?;
            let residual = (0..nx).fold(0.0_f64, |a, i| a.max(((end[i] - x[i]) / self.scales[i]).abs()));
            // Quadratic convergence: once below 1e-9 one more step reaches rounding.
            let settled = residual <= 1e-14 || (residual <= 1e-11 && residual >= 0.1 * last);
            if settled {
                let frequency = self.flow(parameter)?.frequency();
                let multipliers = multipliers(&monodromy).map_err(FlowError::from)?;
                return Ok(Orbit {
                    parameter,
                    frequency,
                    periods: self.periods,
                    start: x,
                    monodromy,
                    multipliers,
                    residual,
                    iterations,
                });
            }
            if iterations == limit || !residual.is_finite() {
                return Err(ShootingError::NoConvergence { iterations, residual });
            }
            last = residual;
            let mut matrix = monodromy;
            for i in 0..nx {
                matrix[(i, i)] -= 1.0;
            }
            let right: Vec<f64> = (0..nx).map(|i| x[i] - end[i]).collect();
            let Ok(lu) = Lu::new(&matrix) else {
                return Err(ShootingError::NoConvergence { iterations, residual });
            };
            let step = lu.solve(&right);
            let size = (0..nx).fold(0.0_f64, |a, i| a.max((step[i] / self.scales[i]).abs()));
            let share = (20.0 / size).min(1.0);
            for i in 0..nx {
                x[i] += share * step[i];
            }
        }
        Err(ShootingError::NoConvergence {
            iterations: limit,
            residual: last,
        })
    }

    /// Summary of the motion that starts at `start` over its period.
    ///
    /// # Errors
    /// [`FlowError`].
    pub fn summarize(
        &mut self,
        start: &[f64],
        parameter: f64,
        outputs: &[Output],
        request: &Request,
    ) -> Result<Record, FlowError> {
        let periods = self.periods;
        self.flow(parameter)?
            .record(&mut start.to_vec(), periods, outputs, request)
    }
}

impl Family for Shooting {
    fn dimension(&self) -> usize {
        self.scales.len()
    }

    fn unknown_scales(&self) -> Vec<f64> {
        self.scales.clone()
    }

    fn parameter_scale(&self) -> f64 {
        self.parameter_scale
    }

    fn evaluate(&mut self, z: &[f64], p: f64, evaluation: &mut Evaluation) -> Result<(), FamilyError> {
        let (end, monodromy, by_parameter) =
            self.map(z, p).map_err(|error| FamilyError(error.to_string()))?;
        evaluation.jacobian = monodromy;
        for i in 0..z.len() {
            evaluation.residual[i] = end[i] - z[i];
            evaluation.jacobian[(i, i)] -= 1.0;
        }
        evaluation.by_parameter = by_parameter;
        Ok(())
    }

    fn test_functions(&mut self, _: &[f64], _: f64, evaluation: &Evaluation) -> Vec<f64> {
        let monodromy = monodromy_of(evaluation);
        vec![period_doubling_test(&monodromy), neimark_sacker_test(&monodromy)]
    }

    fn pattern(&mut self, _: &[f64], _: f64, _: &Evaluation) -> i64 {
        self.events as i64
    }

    /// Real and imaginary parts of the multipliers, largest modulus first.
    fn observe(&mut self, _: &[f64], _: f64, evaluation: &Evaluation) -> Vec<f64> {
        match multipliers(&monodromy_of(evaluation)) {
            Ok(values) => values.iter().flat_map(|m| [m.re, m.im]).collect(),
            Err(_) => Vec::new(),
        }
    }
}

/// The monodromy matrix contained in the Jacobian `Mon − I` of a shooting residual.
pub fn monodromy_of(evaluation: &Evaluation) -> Matrix {
    let mut monodromy = evaluation.jacobian.clone();
    for i in 0..monodromy.rows() {
        monodromy[(i, i)] += 1.0;
    }
    monodromy
}

/// Typical sizes of displacement and frequency of a system.
struct StateScales {
    displacement: Vec<f64>,
    frequency: f64,
}

/// Displacements of the order of the static ones under all loads, and the lowest natural frequency of the linearised
/// system.
fn state_scales(system: &System, frequency: f64) -> Result<StateScales, FlowError> {
    let modes = modes(system, frequency, true)?;
    let n = system.order();
    let mut load: Vec<f64> = system.forcing.constant.iter().map(|f| f.abs()).collect();
    for harmonic in &system.forcing.harmonics {
        for i in 0..n {
            load[i] += harmonic.cosine[i].abs() + harmonic.sine[i].abs();
        }
    }
    let lowest = modes
        .iter()
        .map(|m| m.frequency)
        .find(|&w| w > 0.0)
        .unwrap_or(1.0);
    let mut largest = 0.0_f64;
    for mode in modes.iter().filter(|mode| mode.frequency > 0.0) {
        let work: f64 = mode.shape.iter().zip(&load).map(|(p, f)| (p * f).abs()).sum();
        let amplitude = work / (mode.frequency * mode.frequency);
        for entry in &mode.shape {
            largest = largest.max((entry * amplitude).abs());
        }
    }
    let displacement = if largest > 0.0 { largest } else { 1.0 };
    Ok(StateScales {
        displacement: vec![displacement; n],
        frequency: lowest,
    })
}
