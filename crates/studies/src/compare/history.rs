//! One period of the stable motions at given values, by shooting and by both orders of multiple scales.

use super::{Compare, Contestant, HistoryRow};
use crate::document::Event;
use crate::response::Order;
use crate::response::multiple_scales::fault;
use crate::{Label, LabelValue, Parameter, Quantity, Signal, Study, StudyError};
use slackside_dynamics::flow::{Request, open};
use slackside_dynamics::orbit::multiple_scales::{ModalForm, PrimaryResonance};
use slackside_mechanics::{OperatingPoint, Output};
use std::f64::consts::TAU;

/// Samples of a period.
const SAMPLES: usize = 512;
/// Harmonics reported of the deflection.
const HARMONICS: usize = 16;

/// The histories at all values asked for.
///
/// # Errors
/// [`StudyError`] if the exact branch is not found.
pub(super) fn rows(
    study: &Compare,
    value: Option<f64>,
    signal: &Signal,
) -> Result<Vec<HistoryRow>, StudyError> {
    let quantity = study.response.quantity(value)?;
    let window = study.window(&quantity, &mut Vec::new())?;
    let mut exact = study.by(Contestant::Shooting, &quantity, &window);
    let inside = |at: &&f64| (exact.over.from..=exact.over.to).contains(*at);
    exact.at = study.response.at.iter().filter(inside).copied().collect();
    exact.check = 0;
    let found = exact.run(&value, signal)?;
    let mut rows = Vec::new();
    for at in &exact.at {
        let point = quantity.family.at(quantity.parameter(*at))?;
        let label = study.response.family.as_ref().zip(value);
        let label = label.map(|((key, _), value)| Label {
            key: key.clone(),
            value: LabelValue::Number(value),
        });
        let place = Place {
            quantity: &quantity,
            point: &point,
            at: *at,
            label,
        };
        for orbit in found
            .orbits
            .iter()
            .filter(|orbit| orbit.at.value == *at && orbit.stable)
        {
            rows.push(place.exact(&orbit.start, orbit.motion.engaged_ratio)?);
        }
        let form = ModalForm::new(&point.system).map_err(fault)?;
        let resonance = PrimaryResonance::new(form, window.mode).map_err(fault)?;
        for (method, order) in [
            (Contestant::SecondOrder, Order::Second),
            (Contestant::FirstOrder, Order::First),
        ] {
            let states = resonance.states_at(order, point.frequency);
            for state in states.iter().filter(|state| resonance.is_stable(order, state)) {
                rows.push(place.approximate(method, order, &resonance, state)?);
            }
        }
    }
    Ok(rows)
}

/// Where histories are taken.
struct Place<'a> {
    quantity: &'a Quantity,
    point: &'a OperatingPoint,
    at: f64,
    label: Option<Label>,
}

impl Place<'_> {
    fn element(&self) -> Result<usize, StudyError> {
        Ok(ModalForm::new(&self.point.system).map_err(fault)?.element)
    }

    fn row(
        &self,
        method: Contestant,
        deflection: Vec<f64>,
        engaged_ratio: Option<f64>,
    ) -> Result<HistoryRow, StudyError> {
        let system = &self.point.system;
        let law = &system.elements[self.element()?].law;
        Ok(HistoryRow {
            at: Parameter {
                key: self.quantity.key.clone(),
                value: self.at,
            },
            label: self.label.clone(),
            method,
            phase: (0..deflection.len()).map(|i| i as f64 / SAMPLES as f64).collect(),
            force: deflection.iter().map(|u| law.response(*u, 0.0).force).collect(),
            deflection,
            events: Vec::new(),
            engaged_ratio,
            amplitudes: Vec::new(),
        })
    }

    fn exact(&self, start: &[f64], engaged_ratio: Option<f64>) -> Result<HistoryRow, StudyError> {
        let system = &self.point.system;
        let output = Output {
            displacement: system.elements[self.element()?].port.terms().to_vec(),
            ..Output::default()
        };
        let request = Request {
            harmonics: HARMONICS,
            extremes: false,
            samples: SAMPLES,
            ..Request::default()
        };
        let record = open(self.point)?.record(&mut start.to_vec(), 1, &[output], &request)?;
        let mut samples = record.samples.into_iter().next().unwrap_or_default();
        // The period is closed by its first sample.
        samples.extend(samples.first().copied());
        let mut row = self.row(Contestant::Shooting, samples, engaged_ratio)?;
        row.events = record
            .events
            .iter()
            .map(|event| Event::named(system, event, event.phase / TAU))
            .collect();
        let summary = record.measures.first();
        row.amplitudes = summary.map_or(Vec::new(), |m| m.harmonics.iter().map(|h| h.norm()).collect());
        Ok(row)
    }

    fn approximate(
        &self,
        method: Contestant,
        order: Order,
        resonance: &PrimaryResonance,
        state: &slackside_dynamics::orbit::multiple_scales::SteadyState,
    ) -> Result<HistoryRow, StudyError> {
        let system = &self.point.system;
        let element = self.element()?;
        let motion = resonance
            .motion(system, order, state)
            .map_err(|error| StudyError::NoAnswer(error.to_string()))?;
        let port = &system.elements[element].port;
        let samples = (0..=SAMPLES).map(|i| port.project(&motion.state_at(TAU * i as f64 / SAMPLES as f64)));
        let ratio = motion.transmitting.get(element).copied().flatten();
        let mut row = self.row(method, samples.collect(), ratio)?;
        row.events = motion
            .events
            .iter()
            .map(|event| Event::named(system, event, event.phase / TAU))
            .collect();
        let amplitudes = motion.displacements[element].iter().take(HARMONICS + 1);
        row.amplitudes = amplitudes.map(|h| h.norm()).collect();
        Ok(row)
    }
}
