//! Figures of one motion.

use crate::answers::regimes::{is_friction, lanes, regime};
use crate::plots;
use slackside_report::Figure;
use slackside_report::figures::{
    Curve, FrictionLoop, PhasePortrait, PointSet, RegimeTimeline, Spectrum, SpectrumStyle, TimeHistory,
    TimePanel, TorqueAngle, phase_portrait, regime_timeline, spectrum, time_history, torque_angle,
};
use slackside_report::plot::Axis;
use slackside_studies::Event;
use slackside_studies::simulate::SimulateDocument;

/// Periods shown in a time history: the last ones.
const PERIODS_SHOWN: usize = 6;

/// All figures of the document.
pub fn all(document: &SimulateDocument) -> Vec<(String, Figure)> {
    let mut figures = vec![("time_history".to_owned(), history(document))];
    figures.extend(timeline(document).map(|figure| ("timeline".to_owned(), figure)));
    figures.extend(friction_loop(document).map(|figure| ("torque_angle".to_owned(), figure)));
    figures.extend(amplitudes(document).map(|figure| ("spectrum".to_owned(), figure)));
    figures.extend(portrait(document).map(|figure| ("phase_portrait".to_owned(), figure)));
    figures
}

/// Regimes of all elements below the main measures, over the last periods; `None` where no element sticks or opens.
fn timeline(document: &SimulateDocument) -> Option<Figure> {
    let drawn = document.regimes.0.iter();
    let mut named = drawn
        .flat_map(|(_, shares)| &shares.0)
        .filter(|(name, _)| regime(name).is_some());
    named.next()?;
    let first = first_shown(document);
    let time = &document.series.time[first..];
    let (start, end) = (
        time.first().copied().unwrap_or(0.0),
        document.period * document.periods as f64,
    );
    let events: Vec<(f64, &Event)> = document
        .events
        .iter()
        .map(|timed| (timed.time, &timed.event))
        .collect();
    let mut measures: Vec<&str> = Vec::new();
    for (element, _) in &document.regimes.0 {
        let rest = element.split_once('.').map_or(element.as_str(), |(_, rest)| rest);
        for name in [
            format!("arm.{rest}"),
            format!("friction_torque.{rest}"),
            format!("clutch_torque.{rest}"),
            format!("overrun.{rest}"),
            element.clone(),
        ] {
            if let Some((known, _)) = document.series.measures.iter().find(|(known, _)| *known == name)
                && !measures.contains(&known.as_str())
            {
                measures.push(known);
            }
        }
    }
    if measures.is_empty() {
        measures = main_measures(document);
    }
    measures.truncate(4);
    let panel = |name: &&str| TimePanel {
        y: plots::axis(name, document.header.units.measures.get(name)),
        curves: vec![Curve {
            name: String::new(),
            x: time.to_vec(),
            y: document
                .series
                .get(name)
                .map_or(Vec::new(), |values| values[first..].to_vec()),
        }],
    };
    Some(regime_timeline(
        &RegimeTimeline {
            time: Axis::linear("Time", document.header.units.time.clone()).with_limits(start, end),
            panels: measures.iter().map(panel).collect(),
            lanes: lanes(&events, &document.regimes, [start, end], false),
            repetition: None,
        },
        &plots::options(),
    ))
}

/// Friction torque over the position of the arm in the last period, of each tensioner with friction.
fn friction_loop(document: &SimulateDocument) -> Option<Figure> {
    let first = document.periods.saturating_sub(1) * samples(document);
    let rubbing = document
        .regimes
        .0
        .iter()
        .filter(|(_, shares)| is_friction(shares));
    let loops = rubbing.filter_map(|(element, _)| {
        let arm = element.strip_prefix("friction.")?;
        let angle = document.series.get(&format!("arm.{arm}"))?;
        let torque = document.series.get(&format!("friction_torque.{arm}"))?;
        Some(FrictionLoop {
            name: arm.to_owned(),
            angle: angle[first..].to_vec(),
            torque: torque[first..].to_vec(),
            sticks: Vec::new(),
            dissipation: None,
        })
    });
    let loops: Vec<FrictionLoop> = loops.collect();
    (!loops.is_empty()).then(|| {
        torque_angle(
            &TorqueAngle {
                angle: Axis::linear("Position of the arm", document.header.units.angle.clone()),
                torque: Axis::linear("Friction torque", document.header.units.torque.clone()),
                loops,
            },
            &plots::options(),
        )
    })
}

/// Samples per period of the series.
fn samples(document: &SimulateDocument) -> usize {
    document.series.time.len() / document.periods.max(1)
}

/// Number of the first sample of the last periods.
fn first_shown(document: &SimulateDocument) -> usize {
    document.periods.saturating_sub(PERIODS_SHOWN) * samples(document)
}

/// The measure that matters most, and the one for the second panel.
fn main_measures(document: &SimulateDocument) -> Vec<&str> {
    let names: Vec<&str> = document
        .series
        .measures
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    let preferred: Vec<&str> = ["windup", "clutch_torque"]
        .into_iter()
        .filter(|name| names.contains(name))
        .collect();
    if preferred.is_empty() {
        // Rates tell little that displacements do not.
        let told = names.iter().filter(|name| !name.ends_with(".rate"));
        told.take(3).copied().collect()
    } else {
        preferred
    }
}

fn history(document: &SimulateDocument) -> Figure {
    let first = first_shown(document);
    let time = &document.series.time[first..];
    let panel = |name: &&str| TimePanel {
        y: plots::axis(name, document.header.units.measures.get(name)),
        curves: vec![Curve {
            name: String::new(),
            x: time.to_vec(),
            y: document
                .series
                .get(name)
                .map_or(Vec::new(), |values| values[first..].to_vec()),
        }],
    };
    let start = time.first().copied().unwrap_or(0.0);
    let end = document.period * document.periods as f64;
    time_history(
        &TimeHistory {
            time: Axis::linear("Time", document.header.units.time.clone()).with_limits(start, end),
            panels: main_measures(document).iter().map(panel).collect(),
            disengaged: disengaged(document, start, end),
        },
        &plots::options(),
    )
}

/// Intervals in which the element of the first event does not transmit.
fn disengaged(document: &SimulateDocument, start: f64, end: f64) -> Vec<[f64; 2]> {
    let Some(first) = document.events.first() else {
        return Vec::new();
    };
    let events = document.events.iter();
    let of_element = events.filter(|timed| timed.event.element == first.event.element);
    let mut intervals = Vec::new();
    // Before the first event the element does the opposite of what it does after it.
    let mut since = first.event.engaged.then_some(0.0);
    for timed in of_element {
        match (since, timed.event.engaged) {
            (Some(from), true) => {
                intervals.push([from, timed.time]);
                since = None;
            }
            (None, false) => since = Some(timed.time),
            _ => {}
        }
    }
    intervals.extend(since.map(|from| [from, end]));
    intervals.retain(|interval| interval[1] > start);
    for interval in &mut intervals {
        interval[0] = interval[0].max(start);
    }
    intervals
}

fn amplitudes(document: &SimulateDocument) -> Option<Figure> {
    let name = *main_measures(document).first()?;
    let (_, values) = document
        .spectrum
        .amplitudes
        .0
        .iter()
        .find(|(known, _)| known == name)?;
    let largest = values
        .iter()
        .skip(1)
        .map(|[re, im]| re.hypot(*im))
        .fold(0.0, f64::max);
    // Lines below a millionth of the largest are rounding and end of transients.
    let lines = values.iter().zip(&document.spectrum.frequency).skip(1);
    let (x, y) = lines
        .map(|([re, im], frequency)| (*frequency, re.hypot(*im)))
        .filter(|(_, amplitude)| *amplitude > 1e-6 * largest)
        .unzip();
    Some(spectrum(
        &Spectrum {
            frequency: Axis::linear("Response frequency", document.header.units.frequency.clone()),
            amplitude: Axis::logarithmic(
                format!("Amplitude of {}", plots::words(name)),
                document.header.units.measures.get(name),
            ),
            spectra: vec![Curve {
                name: String::new(),
                x,
                y,
            }],
            style: SpectrumStyle::Stems,
        },
        &plots::options(),
    ))
}

fn portrait(document: &SimulateDocument) -> Option<Figure> {
    let measures = &document.series.measures;
    let pair = |name: &str| {
        let rate = format!("{name}.rate");
        Some((
            name.to_owned(),
            document.series.get(name)?,
            document.series.get(&rate)?,
            rate,
        ))
    };
    let (name, values, rates, rate) =
        pair("windup").or_else(|| measures.iter().find_map(|(name, _)| pair(name)))?;
    let first = first_shown(document);
    let step = samples(document).max(1);
    let section = (first..values.len()).step_by(step).map(|i| [values[i], rates[i]]);
    Some(phase_portrait(
        &PhasePortrait {
            x: plots::axis(&name, document.header.units.measures.get(&name)),
            y: plots::axis(&rate, document.header.units.measures.get(&rate)),
            orbits: vec![Curve {
                name: String::new(),
                x: values[first..].to_vec(),
                y: rates[first..].to_vec(),
            }],
            poincare: vec![PointSet {
                name: "once per period".to_owned(),
                points: section.collect(),
            }],
        },
        &plots::options(),
    ))
}
