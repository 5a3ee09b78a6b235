//! The periodic motions along a pass, each from the one before.

use super::Trust;
use super::line::{Line, Station};
use crate::drive::trust::{self, Remark};
use crate::response::document::multiplier_pairs;
use crate::response::{History, PointRow};
use crate::{Motion, Named, Parameter, Ratios, Signal, motion, rest_state};
use slackside_dynamics::flow::{Request, open};
use slackside_dynamics::orbit::periodic::{PeriodicSearch, PeriodicSettings};
use slackside_dynamics::receptance::{Uniqueness, uniqueness};
use slackside_mechanics::OperatingPoint;
use std::sync::Arc;

/// Periods marched when the motion at a neighbouring value is known; Newton's method comes sooner then.
const MARCH_FROM_NEIGHBOUR: usize = 4;

/// What is wanted of each motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted {
    /// Periods of the load after which motions repeat.
    pub periods: usize,
    /// Harmonics of each measure.
    pub harmonics: usize,
    /// Samples of the histories; zero for none.
    pub samples: usize,
}

/// What is found at one value.
pub(super) struct Outcome {
    /// The value, user's unit.
    pub value: f64,
    /// The motion, or why there is none.
    pub found: Result<PointRow, String>,
    /// What is known of its uniqueness.
    pub uniqueness: Option<Uniqueness>,
    /// What is known of it among motions that do not reach the stops, if this one does not and that makes a difference.
    pub between_stops: Option<Uniqueness>,
}

/// Where motions start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Start {
    /// Each from the one before, the first from rest.
    Neighbour,
    /// Each from rest.
    Rest,
}

/// The motions at values in their order; an interruption ends them early.
pub(super) fn pass(
    line: &Line,
    values: &[f64],
    start: Start,
    wanted: Wanted,
    signal: &Signal,
) -> Vec<Outcome> {
    let mut outcomes = Vec::with_capacity(values.len());
    let mut state: Option<Vec<f64>> = None;
    for &value in values {
        if signal.is_interrupted() {
            break;
        }
        let station = match line.at(value) {
            Ok(station) => station,
            // The plan has found operating points elsewhere: that there is none here is told beside the others.
            Err(error) => {
                outcomes.push(Outcome {
                    value,
                    found: Err(error.to_string()),
                    uniqueness: None,
                    between_stops: None,
                });
                continue;
            }
        };
        let near = match start {
            Start::Neighbour => state.as_deref(),
            Start::Rest => None,
        };
        let found = solve(&station, &line.quantity.key, value, near, wanted).map(|(point, _)| point);
        if let Ok(point) = &found {
            state = Some(point.start.clone());
        }
        let certificate = uniqueness(&station.point).ok();
        let between_stops = match (&certificate, &found) {
            (Some(Uniqueness::NotGuaranteed(_)), Ok(motion)) => between_stops(&station.point, &motion.motion),
            _ => None,
        };
        outcomes.push(Outcome {
            value,
            found,
            uniqueness: certificate,
            between_stops,
        });
    }
    outcomes
}

/// The certificate of the system without stops that a motion does not reach; `None` where that guarantees nothing either.
fn between_stops(point: &OperatingPoint, motion: &Motion) -> Option<Uniqueness> {
    let mut system = point.system.as_ref().clone();
    let count = system.elements.len();
    system.elements.retain(|element| {
        let shares = motion.regimes.get(&element.name);
        shares.is_none_or(|shares| shares.get("free").is_none_or(|share| share < 1.0))
    });
    if system.elements.len() == count {
        return None;
    }
    let point = OperatingPoint {
        system: Arc::new(system),
        frequency: point.frequency,
    };
    uniqueness(&point).ok().filter(Uniqueness::excludes_jumps)
}

/// The periodic motion at an operating point that is reached from a state, or from rest.
pub(super) fn solve(
    station: &Station,
    key: &str,
    value: f64,
    near: Option<&[f64]>,
    wanted: Wanted,
) -> Result<(PointRow, Option<History>), String> {
    let point = &station.point;
    let text = |error: &dyn std::error::Error| error.to_string();
    let mut flow = open(point).map_err(|error| text(&error))?;
    let dimension = flow.dimension();
    let mut settings = PeriodicSettings {
        periods: wanted.periods,
        ..PeriodicSettings::default()
    };
    let start = match near.filter(|state| state.len() == dimension) {
        Some(state) => {
            settings.march = MARCH_FROM_NEIGHBOUR;
            state.to_vec()
        }
        // Where nothing carries the constant load at rest the motion may still repeat.
        None => rest_state(&point.system, point.frequency).unwrap_or_else(|_| vec![0.0; dimension]),
    };
    let mut search = PeriodicSearch::new(flow.as_mut(), &point.system, settings);
    let found = search.from_state(&start).map_err(|error| text(&error))?;
    let request = Request {
        harmonics: wanted.harmonics,
        extremes: true,
        samples: match (wanted.samples, &station.belt) {
            (0, Some(_)) => trust::SAMPLES,
            (samples, _) => samples,
        },
        account: point.system.is_piecewise_linear(),
    };
    let record = search
        .record(&found, station.outputs(), &request)
        .map_err(|error| text(&error))?;
    let multipliers = found.multipliers().map_err(|error| text(&error))?;
    let remarks: Vec<Remark> = station
        .belt
        .as_ref()
        .map_or_else(Vec::new, |belt| belt.remarks(&record));
    let stuck = found.stuck.iter();
    let history = (wanted.samples > 0).then(|| History {
        phase: (0..wanted.samples * wanted.periods)
            .map(|k| k as f64 / (wanted.samples * wanted.periods) as f64)
            .collect(),
        measures: Named(
            station
                .outputs()
                .iter()
                .zip(&record.samples)
                .map(|(output, values)| (output.name.clone(), values.clone()))
                .collect(),
        ),
    });
    let row = PointRow {
        at: Parameter {
            key: key.to_owned(),
            value,
        },
        stable: multipliers.iter().all(|multiplier| multiplier.norm() < 1.0),
        multipliers: multiplier_pairs(&multipliers),
        residual: found.residual,
        start: found.start.clone(),
        multiple_scales: None,
        trust: Some(Trust {
            stuck: stuck
                .map(|element| point.system.elements[*element].name.clone())
                .collect(),
            remarks,
            steady: Ratios(station.steady.clone()),
        }),
        motion: motion(&point.system, &record, wanted.periods),
    };
    Ok((row, history))
}
