//! `simulate`: one motion from a given initial state, with time histories and the exact event list.

use crate::drive::running::RunningDrive;
use crate::drive::trust::{Belt, in_words};
use crate::{
    ElementRow, Energy, Event, Header, Measure, Measures, Method, Named, Progress, Ratios, Signal, Study,
    StudyError, Subject, document, pair, rest_state,
};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use slackside_dynamics::flow::{Account, ElementAccount, Record, Request, open};
use slackside_mechanics::System;
use std::f64::consts::TAU;

/// Values that all time histories together may have.
const MOST_VALUES: usize = 20_000_000;
/// Periods integrated between two looks at the signal.
const CHUNK: usize = 32;
/// Periods at the end whose spectrum is taken, and orders of the load that it reaches.
const SPECTRUM: (usize, usize) = (16, 10);

/// The state at the start.
#[derive(Debug, Clone, PartialEq)]
pub enum Initial {
    /// Rest in the static equilibrium.
    Rest,
    /// All coordinates and rates zero.
    Zero,
    /// Rest in the static equilibrium but for the entries named: coordinates `pulley`, rates `pulley.rate`, wind-ups of
    /// elements that have one under the element's name.
    Given(Vec<(String, f64)>),
}

/// The question.
#[derive(Debug, Clone)]
pub struct Simulate {
    /// The model.
    pub subject: Subject,
    /// Frequency of the load in the user's unit.
    pub frequency: Option<f64>,
    /// Periods of the load.
    pub periods: usize,
    /// Samples per period.
    pub samples: usize,
    /// The state at the start.
    pub initial: Initial,
}

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct SimulateDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// Frequency of the load.
    pub frequency: f64,
    /// Period of the load.
    pub period: f64,
    /// Periods computed.
    pub periods: usize,
    /// The state at the start, by coordinate, rates with `.rate`, wind-ups by element.
    pub initial: Ratios,
    /// The state at the end.
    pub r#final: Ratios,
    /// All events in order.
    pub events: Vec<TimedEvent>,
    /// Statistics of the whole motion.
    pub measures: Measures,
    /// Share of time of every element in each of its regimes; empty for a smooth system.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub regimes: Named<Ratios>,
    /// Energy of the whole motion, where the method keeps an account.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<Energy>,
    /// What the elements do in it.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub elements: Named<ElementRow>,
    /// Amplitudes at the end of the motion.
    pub spectrum: Spectrum,
    /// Time histories.
    pub series: Series,
}

/// An event with its time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimedEvent {
    /// Time since the start.
    pub time: f64,
    /// What happens; its phase is a fraction of the period of the load.
    #[serde(flatten)]
    pub event: Event,
}

/// Spectrum over the last periods: complex amplitudes at multiples of a fraction of the load's frequency.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Spectrum {
    /// Number of periods it is taken over.
    pub periods: usize,
    /// Frequencies in the user's unit.
    pub frequency: Vec<f64>,
    /// Complex amplitudes of each measure.
    pub amplitudes: Spectra,
}

/// Complex amplitudes by measure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spectra(pub Vec<(String, Vec<[f64; 2]>)>);

impl Serialize for Spectra {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, values)| (name, values)))
    }
}

/// Time histories at equal intervals.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Times.
    pub time: Vec<f64>,
    /// Values of each measure.
    pub measures: Vec<(String, Vec<f64>)>,
}

impl Series {
    /// The values of a measure.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        let found = self.measures.iter().find(|(known, _)| known == name);
        found.map(|(_, values)| values.as_slice())
    }
}

impl Serialize for Series {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.measures.len() + 1))?;
        map.serialize_entry("time", &self.time)?;
        for (name, values) in &self.measures {
            map.serialize_entry(name, values)?;
        }
        map.end()
    }
}

/// The state `(q, q', ζ)` that a user describes.
///
/// # Errors
/// [`StudyError`] if a name is unknown or there is no static equilibrium to start from.
pub fn initial_state(system: &System, frequency: f64, initial: &Initial) -> Result<Vec<f64>, StudyError> {
    let names = state_names(system);
    if *initial == Initial::Zero {
        return Ok(vec![0.0; names.len()]);
    }
    let given = match initial {
        Initial::Given(values) => values.as_slice(),
        _ => &[],
    };
    // Where all coordinates are given there need not be an equilibrium.
    let complete = system
        .coordinates
        .iter()
        .all(|name| given.iter().any(|(known, _)| known == name));
    let mut state = if complete {
        vec![0.0; names.len()]
    } else {
        rest_state(system, frequency)?
    };
    for (name, value) in given {
        let Some(index) = names.iter().position(|known| known == name) else {
            return Err(StudyError::question(
                "--initial",
                format!(
                    "there is no coordinate \"{name}\"; known are {}",
                    names.join(", ")
                ),
            ));
        };
        if !value.is_finite() {
            return Err(StudyError::question(
                "--initial",
                format!("the value of \"{name}\" must be a finite number"),
            ));
        }
        state[index] = *value;
    }
    Ok(state)
}

/// Names of the state's entries: coordinates, their rates with `.rate`, elements that have an internal state (a wind-up).
pub fn state_names(system: &System) -> Vec<String> {
    let rates = system.coordinates.iter().map(|name| format!("{name}.rate"));
    let internal = system
        .elements
        .iter()
        .filter(|element| element.law.has_internal_state());
    let coordinates = system.coordinates.iter().cloned();
    coordinates
        .chain(rates)
        .chain(internal.map(|element| element.name.clone()))
        .collect()
}

/// One motion.
#[derive(Debug)]
pub struct Trajectory {
    start: Vec<f64>,
    end: Vec<f64>,
    periods: usize,
    chunks: Vec<(usize, Record)>,
    spectrum: Option<(usize, Record)>,
}

impl Study for Simulate {
    type Job = ();
    type Rows = Trajectory;
    type Document = SimulateDocument;

    fn plan(&self) -> Result<Vec<()>, StudyError> {
        if self.periods == 0 {
            return Err(StudyError::question("--periods", "at least one period is needed"));
        }
        let outputs = self.subject.system()?.outputs.len().max(1);
        let values = self
            .periods
            .checked_mul(self.samples)
            .and_then(|samples| samples.checked_mul(outputs));
        if values.is_none_or(|values| values > MOST_VALUES) {
            return Err(StudyError::question(
                "--samples",
                format!(
                    "{} periods with {} samples of {outputs} measures are too many values to keep; take fewer samples",
                    self.periods, self.samples
                ),
            ));
        }
        Ok(vec![()])
    }

    fn run(&self, (): &(), signal: &Signal) -> Result<Trajectory, StudyError> {
        let point = self.subject.operating_point(self.frequency)?;
        let outputs = &point.system.outputs;
        let start = initial_state(&point.system, point.frequency, &self.initial)?;
        let mut flow = open(&point)?;
        let mut end = start.clone();
        let mut chunks = Vec::new();
        let mut spectrum = None;
        let mut done = 0;
        let last = self.periods.saturating_sub(SPECTRUM.0);
        while done < self.periods && !signal.is_interrupted() {
            let until = if done < last { last } else { self.periods };
            let periods = CHUNK.min(until - done);
            let before = end.clone();
            let request = Request {
                harmonics: 0,
                extremes: true,
                samples: self.samples,
                account: true,
            };
            chunks.push((periods, flow.record(&mut end, periods, outputs, &request)?));
            done += periods;
            if done == self.periods {
                let request = Request {
                    harmonics: periods * SPECTRUM.1,
                    ..Request::default()
                };
                let record = flow.record(&mut before.clone(), periods, outputs, &request)?;
                spectrum = Some((periods, record));
            }
            signal.tell(Progress::Step(format!("period {done} of {}", self.periods)));
        }
        Ok(Trajectory {
            start,
            end,
            periods: done,
            chunks,
            spectrum,
        })
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Trajectory, StudyError>>>,
        interrupted: bool,
    ) -> Result<SimulateDocument, StudyError> {
        let Some(trajectory) = rows.into_iter().flatten().next() else {
            return Err(StudyError::Interrupted);
        };
        let trajectory = trajectory?;
        if trajectory.periods == 0 {
            return Err(StudyError::Interrupted);
        }
        let point = self.subject.operating_point(self.frequency)?;
        let system = &point.system;
        let method = if system.is_piecewise_linear() {
            "exact flow"
        } else {
            "adaptive integration"
        };
        let method = Method::new(method).with("samples", self.samples);
        let mut header = self.subject.header("simulate", method);
        if self.subject.model.drive().is_some() {
            let belt = Belt::new(&RunningDrive::new(&self.subject, self.frequency)?);
            let remarks = trajectory
                .chunks
                .iter()
                .flat_map(|(_, record)| belt.remarks(record));
            let remarks: Vec<_> = remarks.map(|remark| (0.0, remark)).collect();
            header.warnings.extend(in_words(&remarks, None));
        }
        if interrupted {
            header.warnings.push(format!(
                "interrupted after {} of {} periods",
                trajectory.periods, self.periods
            ));
        }
        let period = TAU / point.frequency;
        let state = |values: &[f64]| {
            Ratios(
                state_names(system)
                    .into_iter()
                    .zip(values.iter().copied())
                    .collect(),
            )
        };
        let (energy, elements) = match account(&trajectory) {
            Some(account) => {
                let (energy, mut elements) = document::energy(system, &account);
                // Counts of a motion that repeats say nothing of one that does not.
                for (_, row) in &mut elements.0 {
                    (row.velocity_reversals, row.force_reversals) = (None, None);
                }
                (Some(energy), elements)
            }
            None => (None, Named::default()),
        };
        Ok(SimulateDocument {
            header,
            frequency: self.subject.units.user_frequency(point.frequency),
            period,
            periods: trajectory.periods,
            initial: state(&trajectory.start),
            r#final: state(&trajectory.end),
            events: events(system, point.frequency, &trajectory),
            measures: measures(system, &trajectory),
            regimes: document::regime_shares(system, &fractions(&trajectory)),
            energy,
            elements,
            spectrum: self.spectrum(system, point.frequency, &trajectory),
            series: series(system, period, self.samples, &trajectory),
        })
    }
}

impl Simulate {
    fn spectrum(&self, system: &System, frequency: f64, trajectory: &Trajectory) -> Spectrum {
        let Some((periods, record)) = &trajectory.spectrum else {
            return Spectrum::default();
        };
        let lines = record.measures.first().map_or(0, |m| m.harmonics.len());
        let line = self.subject.units.user_frequency(frequency) / *periods as f64;
        let amplitudes = system.outputs.iter().zip(&record.measures);
        Spectrum {
            periods: *periods,
            frequency: (0..lines).map(|k| k as f64 * line).collect(),
            amplitudes: Spectra(
                amplitudes
                    .map(|(output, m)| (output.name.clone(), m.harmonics.iter().map(pair).collect()))
                    .collect(),
            ),
        }
    }
}

fn events(system: &System, frequency: f64, trajectory: &Trajectory) -> Vec<TimedEvent> {
    let mut events = Vec::new();
    let mut before = 0;
    for (periods, record) in &trajectory.chunks {
        for event in &record.events {
            let turns = event.phase / TAU;
            events.push(TimedEvent {
                time: (TAU * before as f64 + event.phase) / frequency,
                event: Event::named(system, event, turns - turns.floor()),
            });
        }
        before += periods;
    }
    events
}

/// The account of the whole from those of its parts; `None` if a part has none.
fn account(trajectory: &Trajectory) -> Option<Account> {
    let mut sum = Account::default();
    for (_, record) in &trajectory.chunks {
        let part = record.account.as_ref()?;
        sum.load += part.load;
        sum.viscous += part.viscous;
        sum.stored += part.stored;
        sum.elements
            .resize(part.elements.len(), ElementAccount::default());
        for (sum, part) in sum.elements.iter_mut().zip(&part.elements) {
            sum.work += part.work;
            sum.impact_loss += part.impact_loss;
            sum.impacts += part.impacts;
            sum.stops += part.stops;
        }
    }
    Some(sum)
}

/// Shares of time of the whole from those of its parts.
fn fractions(trajectory: &Trajectory) -> Vec<Vec<f64>> {
    let mut sum: Vec<Vec<f64>> = Vec::new();
    for (periods, record) in &trajectory.chunks {
        let share = *periods as f64 / trajectory.periods as f64;
        sum.resize(record.fractions.len(), Vec::new());
        for (sum, part) in sum.iter_mut().zip(&record.fractions) {
            sum.resize(part.len(), 0.0);
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += share * part;
            }
        }
    }
    sum
}

/// Statistics of the whole from those of its parts.
fn measures(system: &System, trajectory: &Trajectory) -> Measures {
    let total = trajectory.periods as f64;
    let named = system.outputs.iter().enumerate().map(|(i, output)| {
        let parts = || {
            let chunks = trajectory.chunks.iter();
            chunks
                .filter_map(move |(periods, record)| Some((*periods as f64 / total, record.measures.get(i)?)))
        };
        let mean: f64 = parts().map(|(share, m)| share * m.mean).sum();
        let square: f64 = parts()
            .map(|(share, m)| share * (m.rms * m.rms + (m.mean - mean).powi(2)))
            .sum();
        let measure = Measure {
            mean,
            rms: square.sqrt(),
            max: parts().fold(f64::NEG_INFINITY, |a, (_, m)| a.max(m.max)),
            min: parts().fold(f64::INFINITY, |a, (_, m)| a.min(m.min)),
            harmonics: Vec::new(),
        };
        (output.name.clone(), measure)
    });
    Measures(named.collect())
}

fn series(system: &System, period: f64, samples: usize, trajectory: &Trajectory) -> Series {
    let count = trajectory.periods * samples;
    let named = system.outputs.iter().enumerate().map(|(i, output)| {
        let mut values = Vec::with_capacity(count);
        for (_, record) in &trajectory.chunks {
            values.extend(record.samples.get(i).into_iter().flatten());
        }
        (output.name.clone(), values)
    });
    Series {
        time: (0..count)
            .map(|k| k as f64 * period / samples.max(1) as f64)
            .collect(),
        measures: named.collect(),
    }
}
