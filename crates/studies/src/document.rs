//! The parts that all result documents share, as users read them in JSON.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::Value;
use slackside_dynamics::flow::{Account, Record};
use slackside_dynamics::orbit::{EventRecord, MeasureSummary};
use slackside_linalg::Complex;
use slackside_mechanics::System;
use slackside_model_file::Units;
use std::f64::consts::TAU;

/// The head of every document.
#[derive(Debug, Clone, Serialize)]
pub struct Header {
    /// Version of the program.
    pub slackside: String,
    /// The verb.
    pub command: String,
    /// The model.
    pub input: Input,
    /// How the answer was found.
    pub method: Method,
    /// Units of all numbers.
    pub units: UnitLabels,
    /// What may surprise.
    pub warnings: Vec<String>,
}

/// Where a model comes from.
#[derive(Debug, Clone, Serialize)]
pub struct Input {
    /// Name of the file as it was given.
    pub file: String,
    /// SHA-256 of the resolved model.
    pub sha256: String,
    /// The model's own name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Overrides, as `KEY=VALUE`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub settings: Vec<String>,
}

/// A method and its settings.
#[derive(Debug, Clone)]
pub struct Method {
    /// Its name, for example `shooting`.
    pub name: String,
    /// Tolerances, harmonics, steps.
    pub settings: Vec<(String, Value)>,
}

impl Method {
    /// A method without settings.
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            settings: Vec::new(),
        }
    }

    /// The same method with one more setting.
    pub fn with(mut self, key: &str, value: impl Into<Value>) -> Self {
        self.settings.push((key.to_owned(), value.into()));
        self
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.settings.len() + 1))?;
        map.serialize_entry("name", &self.name)?;
        for (key, value) in &self.settings {
            map.serialize_entry(key, value)?;
        }
        map.end()
    }
}

/// Texts by name, in order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Texts(pub Vec<(String, String)>);

impl Texts {
    /// The text under a name; empty if there is none.
    pub fn get(&self, name: &str) -> &str {
        let found = self.0.iter().find(|(known, _)| known == name);
        found.map_or("", |(_, text)| text)
    }
}

impl Serialize for Texts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, text)| (name, text)))
    }
}

/// Units of a document's numbers; `–` for what has none.
#[derive(Debug, Clone, Serialize)]
pub struct UnitLabels {
    /// Frequencies.
    pub frequency: String,
    /// Rotations, or coordinates in general.
    pub angle: String,
    /// Torques, or forces in general.
    pub torque: String,
    /// Times.
    pub time: String,
    /// Each measure.
    pub measures: Texts,
}

impl UnitLabels {
    /// Labels for the measures of a model.
    pub(crate) fn new(units: Units, measures: Vec<(String, String)>) -> Self {
        Self {
            measures: Texts(measures),
            frequency: units.frequency.to_owned(),
            angle: units.angle.to_owned(),
            torque: units.torque.to_owned(),
            time: units.time.to_owned(),
        }
    }
}

/// The value of the varied quantity, under its own name: `"frequency": 5.5`.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// `frequency`, or a key of the model.
    pub key: String,
    /// Value in the user's unit.
    pub value: f64,
}

impl Serialize for Parameter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1))?;
        map.serialize_entry(&self.key, &self.value)?;
        map.end()
    }
}

/// Complex number as users read it.
pub fn pair(value: &Complex) -> [f64; 2] {
    [value.re, value.im]
}

/// Summary of one measure over the motion's period.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measure {
    /// Mean.
    pub mean: f64,
    /// Root mean square about the mean.
    pub rms: f64,
    /// Largest value.
    pub max: f64,
    /// Smallest value.
    pub min: f64,
    /// Complex amplitudes of the multiples of the motion's frequency, the mean first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub harmonics: Vec<[f64; 2]>,
}

impl From<&MeasureSummary> for Measure {
    fn from(summary: &MeasureSummary) -> Self {
        Self {
            mean: summary.mean,
            rms: summary.rms,
            max: summary.max,
            min: summary.min,
            harmonics: summary.harmonics.iter().map(pair).collect(),
        }
    }
}

/// Measures by name, in the order of the model's outputs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measures(pub Vec<(String, Measure)>);

impl Measures {
    /// The measure with this name.
    pub fn get(&self, name: &str) -> Option<&Measure> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, m)| m)
    }
}

impl Serialize for Measures {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, measure)| (name, measure)))
    }
}

/// Numbers by name: fractions of time by element, states by coordinate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ratios(pub Vec<(String, f64)>);

impl Ratios {
    /// The number under a name.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.0
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, ratio)| *ratio)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl Serialize for Ratios {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, ratio)| (name, ratio)))
    }
}

/// Rows by name, in order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Named<T>(pub Vec<(String, T)>);

impl<T> Named<T> {
    /// The row with this name.
    pub fn get(&self, name: &str) -> Option<&T> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, row)| row)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, row)| (name, row)))
    }
}

/// Where the energy of a motion goes: `load = viscous + stored + Σ elements` (theory 05 §4.3).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Energy {
    /// Work of the load, constant part and harmonics.
    pub load: f64,
    /// What linear damping takes.
    pub viscous: f64,
    /// Change of kinetic energy and work against the linear springs; zero for a motion that repeats.
    pub stored: f64,
    /// What is missing in the balance, relative to its largest term.
    pub imbalance: f64,
}

/// What one element does in a motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ElementRow {
    /// Work done on it without impacts; over a motion that repeats what it dissipates.
    pub dissipation: f64,
    /// Kinetic energy that its impacts take.
    pub impact_loss: f64,
    /// Number of its impacts.
    pub impacts: usize,
    /// How often its port comes to rest for a while.
    pub stops: usize,
    /// Changes of sign of its port's velocity, stops in between skipped; of a motion that repeats.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_reversals: Option<usize>,
    /// Changes of sign of its force; of a motion that repeats.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_reversals: Option<usize>,
}

/// The energy and the elements of an account.
pub(crate) fn energy(system: &System, account: &Account) -> (Energy, Named<ElementRow>) {
    let elements = system.elements.iter().zip(&account.elements);
    let rows = elements.map(|(element, account)| {
        let row = ElementRow {
            dissipation: account.work,
            impact_loss: account.impact_loss,
            impacts: account.impacts,
            stops: account.stops,
            velocity_reversals: Some(account.velocity_reversals),
            force_reversals: Some(account.force_reversals),
        };
        (element.name.clone(), row)
    });
    let energy = Energy {
        load: account.load,
        viscous: account.viscous,
        stored: account.stored,
        imbalance: account.imbalance(),
    };
    (energy, Named(rows.collect()))
}

/// Shares of time by element and regime; regimes of equal name (the segments of a measured loop) are added.
pub(crate) fn regime_shares(system: &System, fractions: &[Vec<f64>]) -> Named<Ratios> {
    let elements = system.elements.iter().zip(fractions);
    let rows = elements.filter_map(|(element, fractions)| {
        let table = element.law.regimes()?;
        let mut shares: Vec<(String, f64)> = Vec::new();
        for (regime, fraction) in table.regimes.iter().zip(fractions) {
            match shares.iter_mut().find(|(name, _)| name == regime.name) {
                Some((_, share)) => *share += fraction,
                None => shares.push((regime.name.to_owned(), *fraction)),
            }
        }
        Some((element.name.clone(), Ratios(shares)))
    });
    Named(rows.collect())
}

/// An element passes from one regime to another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Event {
    /// When, as a fraction of the motion's period.
    pub phase: f64,
    /// Name of the element.
    pub element: String,
    /// Name of the regime before.
    pub from: String,
    /// Name of the regime after.
    pub to: String,
    /// Whether the element transmits after it; not part of the JSON document, since it follows from the regime.
    #[serde(skip)]
    pub engaged: bool,
}

/// What is reported of a periodic motion besides its stability.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Motion {
    /// Summaries of all measures.
    pub measures: Measures,
    /// Events in order.
    pub events: Vec<Event>,
    /// Fraction of the period in which the first element transmits; absent for a smooth system.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub engaged_ratio: Option<f64>,
    /// The same for every element, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub engaged_ratios: Option<Ratios>,
    /// Share of time of every element in each of its regimes; empty for a smooth system.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub regimes: Named<Ratios>,
    /// By how much the coordinates on which nothing depends (an overrunning accessory) move on in one period of the motion.
    #[serde(skip_serializing_if = "Ratios::is_empty")]
    pub drift: Ratios,
    /// Energy over the motion's period, where the method keeps an account.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<Energy>,
    /// What the elements do in it.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub elements: Named<ElementRow>,
}

impl Event {
    /// The event of a record, by names; `phase` in the unit that the document wants.
    pub(crate) fn named(system: &System, event: &EventRecord, phase: f64) -> Self {
        let element = system.elements.get(event.element);
        let table = element.and_then(|element| element.law.regimes());
        let regime = |index: usize| table.as_ref().and_then(|table| table.regimes.get(index));
        let name = |index: usize| regime(index).map_or_else(String::new, |regime| regime.name.to_owned());
        Self {
            phase,
            element: element.map_or_else(String::new, |element| element.name.clone()),
            from: name(event.from),
            to: name(event.to),
            engaged: regime(event.to).is_some_and(|regime| regime.transmitting),
        }
    }
}

/// Names the parts of a record over `periods` periods of the load by the system's outputs, elements and regimes.
pub fn motion(system: &System, record: &Record, periods: usize) -> Motion {
    let ratios = system
        .elements
        .iter()
        .zip(&record.fractions)
        .map(|(element, fractions)| {
            let table = element.law.regimes()?;
            let shares = table.regimes.iter().zip(fractions);
            Some(
                shares
                    .filter(|(regime, _)| regime.transmitting)
                    .map(|(_, fraction)| fraction)
                    .sum(),
            )
        });
    let mut motion = assemble(system, &record.measures, &record.events, ratios, periods);
    motion.regimes = regime_shares(system, &record.fractions);
    if !record.drift.is_empty() {
        let cyclic = system.cyclic_coordinates().into_iter();
        let moved = cyclic.filter_map(|i| Some((system.coordinates[i].clone(), *record.drift.get(i)?)));
        motion.drift = Ratios(moved.collect());
    }
    if let Some(account) = &record.account {
        let (balance, elements) = energy(system, account);
        motion.energy = Some(balance);
        motion.elements = elements;
    }
    motion
}

/// A motion from its parts, by whichever method they were found; `ratios` are the engaged ratios of the elements.
pub(crate) fn assemble(
    system: &System,
    measures: &[MeasureSummary],
    events: &[EventRecord],
    ratios: impl Iterator<Item = Option<f64>>,
    periods: usize,
) -> Motion {
    let measures = system
        .outputs
        .iter()
        .zip(measures)
        .map(|(output, summary)| (output.name.clone(), Measure::from(summary)))
        .collect();
    let events = events
        .iter()
        .map(|event| Event::named(system, event, event.phase / (TAU * periods as f64)))
        .collect();
    let ratios: Vec<(String, f64)> = system
        .elements
        .iter()
        .zip(ratios)
        .filter_map(|(element, ratio)| Some((element.name.clone(), ratio?)))
        .collect();
    Motion {
        measures: Measures(measures),
        events,
        engaged_ratio: ratios.first().map(|(_, ratio)| *ratio),
        engaged_ratios: (ratios.len() > 1).then_some(Ratios(ratios)),
        regimes: Named::default(),
        drift: Ratios::default(),
        energy: None,
        elements: Named::default(),
    }
}
