//! `sweep`: the settled motion while a quantity is stepped up and down, each value starting from where the motion of the
//! previous one was (theory 02 §9).

use crate::drive::trust::in_words;
use crate::response::periodic::line::{Line, Station};
use crate::simulate::{Initial, initial_state, state_names};
use crate::{
    Header, Method, Motion, Parameter, Progress, Quantity, Range, Signal, Study, StudyError, Subject, motion,
};
use serde::{Deserialize, Serialize};
use slackside_dynamics::attractor::{
    Attractor, SweepOptions, SweepStep, SweepStop, amplitude_spectrum, sweep,
};
use slackside_dynamics::flow::Record;
use slackside_mechanics::System;

/// Values of a range without a step.
const USUAL_VALUES: usize = 101;

/// The direction in which the quantity is stepped. One direction is one job: its values follow from each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Towards larger values.
    Up,
    /// Towards smaller values.
    Down,
}

impl Direction {
    /// `up` or `down`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

/// The question: the settled motion over values of the frequency or of a key, stepped in one or both directions.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The model.
    pub subject: Subject,
    /// The quantity and its values in the user's unit; 101 of them without a step.
    pub over: Range,
    /// Frequency of the load in the user's unit when another key is stepped.
    pub frequency: Option<f64>,
    /// Directions.
    pub directions: Vec<Direction>,
    /// State from which each direction starts, at its first value.
    pub initial: Initial,
    /// Transient, records and classification.
    pub options: SweepOptions,
    /// Spectra up to this multiple of the load's frequency; zero for none.
    pub spectrum_orders: usize,
}

impl Sweep {
    /// A sweep in both directions from rest with the usual options and spectra up to the eighth order.
    pub fn new(subject: Subject, over: Range) -> Self {
        Self {
            subject,
            over,
            frequency: None,
            directions: vec![Direction::Up, Direction::Down],
            initial: Initial::Rest,
            options: SweepOptions::default(),
            spectrum_orders: 8,
        }
    }

    /// The values in the order of a direction, in the user's unit.
    fn values(&self, direction: Direction) -> Vec<f64> {
        let mut values = self.over.values(USUAL_VALUES);
        if (self.over.to > self.over.from) != (direction == Direction::Up) {
            values.reverse();
        }
        values
    }

    fn quantity(&self) -> Result<Quantity, StudyError> {
        self.subject.quantity(&self.over.key, self.frequency)
    }
}

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct SweepDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// Names of the state entries in `poincare`: coordinates, then their rates.
    pub state: Vec<String>,
    /// Steps towards larger values, in their order.
    pub up: Vec<SweepRow>,
    /// Steps towards smaller values, in their order.
    pub down: Vec<SweepRow>,
}

/// The settled motion at one value.
#[derive(Debug, Clone, Serialize)]
pub struct SweepRow {
    /// The value.
    #[serde(flatten)]
    pub at: Parameter,
    /// `periodic-1`, `periodic-2`, …, `quasi-periodic`, `chaotic`, or `unsettled` if none of these could be shown.
    pub kind: String,
    /// Periods of the load over which measures were taken: those after which the motion repeats, or the recorded ones.
    pub periods: usize,
    /// Measures and shares of time; events only of a motion that repeats.
    #[serde(flatten)]
    pub motion: Motion,
    /// Modulus of the largest Floquet multiplier of a periodic motion that was refined to an exact orbit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_multiplier: Option<f64>,
    /// Turns per period of a quasi-periodic motion (per `curves` periods if its points visit several curves in turn).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_number: Option<f64>,
    /// Number of closed curves of a quasi-periodic motion, if more than one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curves: Option<usize>,
    /// Leading Lyapunov exponents of a motion that does not repeat, per unit of time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lyapunov: Option<Lyapunov>,
    /// Stroboscopic points.
    pub poincare: Vec<Vec<f64>>,
    /// Spectra of all measures, for waterfall diagrams and tables; too long for the document.
    #[serde(skip)]
    pub spectra: Spectra,
}

/// Lyapunov exponents and their standard errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Lyapunov {
    /// Exponents, falling. One of a direction that events squeeze to nothing is minus infinity (`null` in JSON).
    pub exponents: Vec<f64>,
    /// Standard errors.
    pub standard_errors: Vec<f64>,
}

/// Amplitude spectra of all measures at one value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spectra {
    /// Frequencies of the lines in the user's unit.
    pub frequency: Vec<f64>,
    /// Name and amplitudes of each measure, with a Hann window corrected for amplitude.
    pub measures: Vec<(String, Vec<f64>)>,
}

/// Steps of one direction.
#[derive(Debug, Clone)]
pub struct DirectionRows {
    direction: Direction,
    steps: Vec<SweepRow>,
    warnings: Vec<String>,
}

impl Study for Sweep {
    type Job = Direction;
    type Rows = DirectionRows;
    type Document = SweepDocument;

    fn plan(&self) -> Result<Vec<Direction>, StudyError> {
        let quantity = self.quantity()?;
        let (low, _) = self.over.bounds();
        let point = quantity
            .family
            .at(quantity.parameter(low))
            .map_err(|reason| StudyError::question("--over", reason.to_string()))?;
        let option = if quantity.is_frequency() {
            "--over"
        } else {
            "--frequency"
        };
        crate::check_period(&point.system, point.frequency, option)?;
        Ok(self.directions.clone())
    }

    /// Steps through all values of a direction; an interruption or a failure keeps the steps before it.
    fn run(&self, direction: &Direction, signal: &Signal) -> Result<DirectionRows, StudyError> {
        let quantity = self.quantity()?;
        let parameters: Vec<f64> = self
            .values(*direction)
            .into_iter()
            .map(|value| quantity.parameter(value))
            .collect();
        let mut rows = DirectionRows {
            direction: *direction,
            steps: Vec::with_capacity(parameters.len()),
            warnings: Vec::new(),
        };
        let Some(&first) = parameters.first() else {
            return Ok(rows);
        };
        let point = quantity.family.at(first)?;
        let mut state = initial_state(&point.system, point.frequency, &self.initial)?;
        let line = Line::new(&self.subject, &self.over.key, self.frequency)?;
        let mut remarks = Vec::new();
        let stop = sweep(
            quantity.family.as_ref(),
            &parameters,
            &mut state,
            &self.options,
            &mut |step| {
                let row = self.row(&quantity, &point.system, &step);
                signal.tell(Progress::Step(format!(
                    "{} to {} = {}: {}",
                    direction.name(),
                    row.at.key,
                    row.at.value,
                    row.kind
                )));
                if let Ok(Station { belt: Some(belt), .. }) = line.at(row.at.value) {
                    let seen = Record {
                        measures: step.record.measures.clone(),
                        samples: step.samples.clone(),
                        ..Record::default()
                    };
                    remarks.extend(
                        belt.remarks(&seen)
                            .into_iter()
                            .map(|remark| (row.at.value, remark)),
                    );
                }
                rows.steps.push(row);
                !signal.is_interrupted()
            },
        );
        rows.warnings.extend(in_words(&remarks, Some(&quantity.key)));
        match stop {
            SweepStop::Finished => {}
            SweepStop::Asked => rows.warnings.push(format!(
                "interrupted: the sweep {} has {} of {} values",
                direction.name(),
                rows.steps.len(),
                parameters.len()
            )),
            SweepStop::Failed { error, .. } if rows.steps.is_empty() => return Err(error.into()),
            SweepStop::Failed { parameter, error } => rows.warnings.push(format!(
                "the sweep {} ended before {} = {}: {error}",
                direction.name(),
                quantity.key,
                quantity.value(parameter)
            )),
        }
        Ok(rows)
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<DirectionRows, StudyError>>>,
        interrupted: bool,
    ) -> Result<SweepDocument, StudyError> {
        let options = &self.options;
        let method = Method::new("stepping")
            .with("transient_periods", options.transient_periods)
            .with("record_periods", options.record_periods)
            .with("tolerance", options.classify.recognition.tolerance)
            .with("longest_period", options.classify.recognition.longest_period)
            .with("lyapunov_periods", options.classify.lyapunov.periods);
        let mut document = SweepDocument {
            header: self.subject.header("sweep", method),
            state: state_names(self.subject.system()?.as_ref()),
            up: Vec::new(),
            down: Vec::new(),
        };
        let mut failed = None;
        for found in rows.into_iter().flatten() {
            match found {
                Ok(found) => {
                    document.header.warnings.extend(found.warnings);
                    match found.direction {
                        Direction::Up => document.up = found.steps,
                        Direction::Down => document.down = found.steps,
                    }
                }
                Err(error) => {
                    failed.get_or_insert(error);
                }
            }
        }
        match failed {
            Some(error) if document.up.is_empty() && document.down.is_empty() => Err(error),
            Some(error) => {
                document.header.warnings.push(error.to_string());
                Ok(document)
            }
            None if interrupted && document.up.is_empty() && document.down.is_empty() => {
                Err(StudyError::Interrupted)
            }
            None => Ok(document),
        }
    }
}

impl Sweep {
    fn row(&self, quantity: &Quantity, system: &System, step: &SweepStep) -> SweepRow {
        let mut motion = motion(system, &step.record, step.measured_periods);
        let periodic = match &step.attractor {
            Attractor::Periodic(periodic) => Some(periodic),
            _ => None,
        };
        if periodic.is_none_or(|periodic| periodic.orbit.is_none()) {
            motion.events.clear();
        }
        let (rotation, spectrum) = match &step.attractor {
            Attractor::Periodic(_) => (None, None),
            Attractor::QuasiPeriodic { rotation, spectrum } => (Some(rotation), Some(spectrum)),
            Attractor::Chaotic { spectrum } | Attractor::Unsettled { spectrum, .. } => (None, Some(spectrum)),
        };
        SweepRow {
            at: Parameter {
                key: quantity.key.clone(),
                value: quantity.value(step.parameter),
            },
            kind: kind(&step.attractor),
            periods: step.measured_periods,
            motion,
            largest_multiplier: periodic
                .and_then(|periodic| periodic.orbit.as_ref()?.multipliers.first())
                .map(|multiplier| multiplier.norm()),
            rotation_number: rotation.map(|rotation| rotation.value),
            curves: rotation
                .map(|rotation| rotation.curves)
                .filter(|&curves| curves > 1),
            lyapunov: spectrum.map(|spectrum| Lyapunov {
                exponents: spectrum.exponents.clone(),
                standard_errors: spectrum.standard_errors.clone(),
            }),
            poincare: step.points.points().map(<[f64]>::to_vec).collect(),
            spectra: self.spectra(system, step),
        }
    }

    fn spectra(&self, system: &System, step: &SweepStep) -> Spectra {
        if self.spectrum_orders == 0 || step.samples.is_empty() {
            return Spectra::default();
        }
        let periods = self.options.record_periods.max(1);
        let lines = self.spectrum_orders * periods + 1;
        let spacing = self.subject.units.user_frequency(step.frequency) / periods as f64;
        let measures: Vec<(String, Vec<f64>)> = system
            .outputs
            .iter()
            .zip(&step.samples)
            .map(|(output, samples)| {
                let mut amplitudes = amplitude_spectrum(samples);
                amplitudes.truncate(lines);
                (output.name.clone(), amplitudes)
            })
            .collect();
        let count = measures.first().map_or(0, |(_, amplitudes)| amplitudes.len());
        Spectra {
            frequency: (0..count).map(|k| k as f64 * spacing).collect(),
            measures,
        }
    }
}

/// The kind of a motion as documents name it.
pub(crate) fn kind(attractor: &Attractor) -> String {
    match attractor {
        Attractor::Periodic(periodic) => format!("periodic-{}", periodic.periods),
        Attractor::QuasiPeriodic { .. } => "quasi-periodic".to_owned(),
        Attractor::Chaotic { .. } => "chaotic".to_owned(),
        Attractor::Unsettled { .. } => "unsettled".to_owned(),
    }
}
