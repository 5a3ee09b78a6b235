//! What motions are found and followed with: shooting or harmonic balance behind one face.

use super::curve::Curve;
use crate::document::{assemble, motion};
use crate::{Motion, Quantity, StudyError};
use slackside_dynamics::branch::{BranchFamily, BranchPoint};
use slackside_dynamics::flow::{Request, open};
use slackside_dynamics::orbit::harmonic_balance::{
    HarmonicBalance, HarmonicOrbit, Settings, Solution, SolveStop, Start, solve,
};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_linalg::Complex;
use slackside_mechanics::{OperatingPoint, Output, SystemFamily};
use std::sync::Arc;

/// How motions are found and followed numerically.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tracing {
    /// Shooting.
    Shooting,
    /// Harmonic balance; `None` adapts the number of harmonics.
    HarmonicBalance {
        /// Number of harmonics.
        harmonics: Option<usize>,
    },
}

/// A periodic motion to begin with.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownMotion {
    /// The family's parameter.
    pub parameter: f64,
    /// State at phase zero.
    pub state: Vec<f64>,
}

/// A motion found at a fixed parameter.
#[derive(Debug, Clone)]
pub struct Solved {
    /// State at phase zero.
    pub state: Vec<f64>,
    /// Multipliers over the motion's period.
    pub multipliers: Vec<Complex>,
    /// Largest scaled residual.
    pub residual: f64,
    /// What is reported of it.
    pub motion: Motion,
}

/// All that is needed to find and follow motions of one family by one method.
pub struct Setup {
    family: Arc<dyn SystemFamily>,
    method: Tracing,
    /// Periods of the load after which motions repeat.
    pub periods: usize,
    /// Range of the family's parameter.
    pub range: (f64, f64),
    /// Typical sizes of the state's entries.
    pub scales: Vec<f64>,
    /// Typical size of the parameter.
    pub parameter_scale: f64,
}

/// Samples of a period from which harmonic balance starts.
const START_SAMPLES: usize = 256;

impl Setup {
    /// The setup for a quantity over a range.
    ///
    /// # Errors
    /// [`StudyError::Flow`] if there is no flow at the ends of the range.
    pub fn new(
        quantity: &Quantity,
        method: Tracing,
        periods: usize,
        range: (f64, f64),
    ) -> Result<Self, StudyError> {
        use slackside_continuation::Family;
        let mut shooting = Shooting::new(quantity.family.clone(), range.1, periods)
            .or_else(|_| Shooting::new(quantity.family.clone(), 0.5 * (range.0 + range.1), periods))?;
        // A key is measured by its range: it has no natural size.
        if !quantity.is_frequency() {
            shooting.set_parameter_scale(0.5 * (range.1 - range.0));
        }
        Ok(Self {
            family: quantity.family.clone(),
            method,
            periods,
            range,
            scales: shooting.unknown_scales(),
            parameter_scale: shooting.parameter_scale(),
        })
    }

    /// The same for motions of another period.
    pub fn with_periods(&self, periods: usize) -> Self {
        Self {
            family: self.family.clone(),
            periods,
            scales: self.scales.clone(),
            ..*self
        }
    }

    /// The same by shooting.
    pub fn by_shooting(&self) -> Self {
        Self {
            method: Tracing::Shooting,
            ..self.with_periods(self.periods)
        }
    }

    /// The setup with the period and the method of a branch.
    pub fn of_curve(&self, curve: &Curve) -> Self {
        let setup = self.with_periods(curve.periods);
        if curve.by_shooting {
            setup.by_shooting()
        } else {
            setup
        }
    }

    /// Whether motions are found by shooting, so that unknowns are states.
    pub fn is_shooting(&self) -> bool {
        self.method == Tracing::Shooting
    }

    /// The systems over the parameter.
    pub fn systems(&self) -> &dyn SystemFamily {
        self.family.as_ref()
    }

    /// The system and frequency at a parameter.
    ///
    /// # Errors
    /// [`StudyError::OutsideDomain`].
    pub fn point(&self, parameter: f64) -> Result<OperatingPoint, StudyError> {
        Ok(self.family.at(parameter)?)
    }

    /// Shooting at a parameter.
    ///
    /// # Errors
    /// [`StudyError::Flow`].
    pub fn shooting(&self, parameter: f64) -> Result<Shooting, StudyError> {
        let mut shooting = Shooting::new(self.family.clone(), parameter, self.periods)?;
        shooting.set_parameter_scale(self.parameter_scale);
        Ok(shooting)
    }

    /// The family to follow and the unknowns of a known motion in it.
    ///
    /// # Errors
    /// [`StudyError`] if the method does not find the motion.
    pub fn family(&self, known: &KnownMotion) -> Result<(Box<dyn BranchFamily>, Vec<f64>), StudyError> {
        match self.method {
            Tracing::Shooting => Ok((Box::new(self.shooting(known.parameter)?), known.state.clone())),
            Tracing::HarmonicBalance { .. } => {
                let orbit = self.harmonic_orbit(known)?.orbit;
                let settings = Settings {
                    harmonics: orbit.harmonics,
                    ..self.settings()
                };
                let mut family = HarmonicBalance::new(self.family.clone(), known.parameter, settings)
                    .map_err(|error| StudyError::NoAnswer(error.to_string()))?;
                let unknowns = family.unknowns(&orbit);
                Ok((Box::new(family), unknowns))
            }
        }
    }

    /// The state at phase zero of a point of a branch.
    ///
    /// # Errors
    /// [`StudyError`] if the method does not recover it.
    pub fn state(&self, point: &BranchPoint) -> Result<Vec<f64>, StudyError> {
        match self.method {
            Tracing::Shooting => Ok(point.unknowns.clone()),
            Tracing::HarmonicBalance { .. } => Ok(self.recovered(point)?.initial_state()),
        }
    }

    /// The motion at a point of a branch.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn motion(
        &self,
        shooting: &mut Shooting,
        point: &BranchPoint,
        harmonics: usize,
    ) -> Result<Motion, StudyError> {
        match self.method {
            Tracing::Shooting => {
                let system = self.point(point.parameter)?.system;
                let request = Request {
                    harmonics,
                    extremes: true,
                    account: true,
                    ..Request::default()
                };
                let record =
                    shooting.summarize(&point.unknowns, point.parameter, &system.outputs, &request)?;
                Ok(motion(&system, &record, self.periods))
            }
            Tracing::HarmonicBalance { .. } => Ok(harmonic_motion(&self.recovered(point)?, harmonics)),
        }
    }

    /// The motion near a state at a fixed parameter, with what is reported of it.
    ///
    /// # Errors
    /// [`StudyError::NoAnswer`] if the method does not converge.
    pub fn solve(&self, near: &KnownMotion, harmonics: usize) -> Result<Solved, StudyError> {
        match self.method {
            Tracing::Shooting => {
                let mut shooting = self.shooting(near.parameter)?;
                let orbit = shooting
                    .solve(&near.state, near.parameter)
                    .map_err(|error| StudyError::NoAnswer(error.to_string()))?;
                let point = BranchPoint {
                    parameter: near.parameter,
                    unknowns: orbit.start.clone(),
                    multipliers: Vec::new(),
                    events: 0,
                    residual: orbit.residual,
                    arclength: 0.0,
                };
                Ok(Solved {
                    motion: self.motion(&mut shooting, &point, harmonics)?,
                    state: orbit.start,
                    multipliers: orbit.multipliers,
                    residual: orbit.residual,
                })
            }
            Tracing::HarmonicBalance { .. } => {
                let solution = self.harmonic_orbit(near)?;
                let stability = solution
                    .orbit
                    .stability()
                    .map_err(|error| StudyError::NoAnswer(error.to_string()))?;
                Ok(Solved {
                    motion: harmonic_motion(&solution.orbit, harmonics),
                    state: solution.orbit.initial_state(),
                    multipliers: stability.multipliers,
                    residual: solution.residual,
                })
            }
        }
    }

    fn settings(&self) -> Settings {
        let settings = match self.method {
            Tracing::HarmonicBalance { harmonics: Some(h) } => Settings::fixed(h),
            _ => Settings::default(),
        };
        Settings {
            subharmonic: self.periods,
            harmonics: settings.harmonics * self.periods,
            ..settings
        }
    }

    /// The motion by harmonic balance, from the motion that the flow makes of the known state.
    fn harmonic_orbit(&self, known: &KnownMotion) -> Result<Solution, StudyError> {
        let point = self.point(known.parameter)?;
        let ports: Vec<Output> = point
            .system
            .elements
            .iter()
            .map(|element| Output {
                displacement: element.port.terms().to_vec(),
                ..Output::default()
            })
            .collect();
        let request = Request {
            samples: START_SAMPLES,
            ..Request::default()
        };
        let record = open(&point)?.record(&mut known.state.clone(), self.periods, &ports, &request)?;
        let solution = solve(&point, Start::Samples(&record.samples), &self.settings())
            .map_err(|error| StudyError::NoAnswer(error.to_string()))?;
        converged(solution)
    }

    /// The motion whose unknowns a point of a branch holds. It is read off, not solved for again: at a fold that would be
    /// ill-posed.
    fn recovered(&self, point: &BranchPoint) -> Result<HarmonicOrbit, StudyError> {
        let system = self.point(point.parameter)?.system;
        let nonlinear = system
            .elements
            .iter()
            .filter(|element| element.law.regimes().is_none_or(|table| table.regimes.len() > 1))
            .count();
        let per_element = point.unknowns.len() / nonlinear.max(1);
        let settings = Settings {
            harmonics: per_element.saturating_sub(1) / 2,
            adaptation: None,
            ..self.settings()
        };
        HarmonicBalance::new(self.family.clone(), point.parameter, settings)
            .map_err(|error| StudyError::NoAnswer(error.to_string()))?
            .orbit(&point.unknowns, point.parameter)
            .map_err(|error| StudyError::NoAnswer(error.to_string()))
    }
}

fn converged(solution: Solution) -> Result<Solution, StudyError> {
    match solution.stop {
        SolveStop::Converged | SolveStop::HarmonicLimit => Ok(solution),
        // At a fold Newton's method stalls where it stands: the motion is known, only not to the last digit.
        _ if solution.residual < 1e-6 => Ok(solution),
        stop => Err(StudyError::NoAnswer(format!(
            "harmonic balance did not converge ({stop:?} after {} iterations, residual {:.1e})",
            solution.iterations, solution.residual
        ))),
    }
}

/// What is reported of a motion known by its harmonics.
pub fn harmonic_motion(orbit: &HarmonicOrbit, harmonics: usize) -> Motion {
    let mut measures = orbit.measures();
    for measure in &mut measures {
        let kept = if harmonics == 0 { 0 } else { harmonics + 1 };
        measure.harmonics.truncate(kept);
    }
    let ratios = orbit.transmitting.iter().copied();
    assemble(&orbit.system, &measures, &orbit.events, ratios, orbit.subharmonic)
}
