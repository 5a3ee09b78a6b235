//! Figures of the motions at single values: timelines of regimes, torque–angle loops of friction.

use crate::answers::regimes::{is_clutch, is_friction, lanes};
use crate::plots;
use slackside_report::Figure;
use slackside_report::figures::{
    Curve, FrictionLoop, RegimeTimeline, Repetition, TimePanel, TorqueAngle, regime_timeline, torque_angle,
};
use slackside_report::plot::Axis;
use slackside_studies::response::{History, OrbitRow, ResponseDocument};
use slackside_studies::{Event, Header};

/// Timelines drawn at most.
const MOST: usize = 12;
/// Periods drawn in a timeline.
const PERIODS: usize = 2;

/// A timeline for each motion, and one figure with the loops of all.
pub fn all(document: &ResponseDocument) -> Vec<(String, Figure)> {
    let with_history = || {
        let motions = document.at.iter();
        motions.filter_map(|motion| Some((motion, motion.history.as_ref()?)))
    };
    let mut figures: Vec<(String, Figure)> = with_history()
        .take(MOST)
        .enumerate()
        .map(|(i, (motion, history))| (format!("timeline_{}", i + 1), timeline(document, motion, history)))
        .collect();
    let several = document.at.len() > 1;
    let loops: Vec<FrictionLoop> = with_history()
        .flat_map(|(motion, history)| friction_loops(motion, history, several))
        .collect();
    if !loops.is_empty() {
        figures.push((
            "torque_angle".to_owned(),
            torque_angle(
                &TorqueAngle {
                    angle: Axis::linear("Position of the arm", displacement_unit(&document.header)),
                    torque: Axis::linear("Friction torque", document.header.units.torque.clone()),
                    loops,
                },
                &plots::options(),
            ),
        ));
    }
    figures
}

fn displacement_unit(header: &Header) -> String {
    header.units.angle.clone()
}

fn name(motion: &OrbitRow) -> String {
    let value = format!(
        "{} = {}",
        plots::words(&motion.at.key),
        plots::short(motion.at.value)
    );
    match &motion.label {
        Some(label) => format!("{}, {value}", plots::label(label)),
        None => value,
    }
}

/// The measures worth a panel above the lanes: speeds and torques of clutches, arms and their friction.
fn panels(header: &Header, motion: &OrbitRow, history: &History) -> Vec<TimePanel> {
    let known = |name: &str| history.measures.get(name).is_some();
    let panel = |title: String, unit: &str, curves: Vec<(String, String)>| TimePanel {
        y: Axis::linear(title, unit),
        curves: curves
            .into_iter()
            .filter_map(|(measure, name)| {
                Some(Curve {
                    name,
                    x: history.phase.clone(),
                    y: history.measures.get(&measure)?.clone(),
                })
            })
            .collect(),
    };
    let mut panels = Vec::new();
    for (element, shares) in &motion.motion.regimes.0 {
        if let Some(pulley) = element.strip_prefix("coupling.").filter(|_| is_clutch(shares)) {
            let speeds = vec![
                (format!("rotation.{pulley}.rate"), "pulley".to_owned()),
                (
                    format!("rotation.{pulley}.accessory.rate"),
                    "accessory".to_owned(),
                ),
            ];
            panels.push(panel(format!("Speeds of {pulley}"), "rad/s", speeds));
            let torque = format!("clutch_torque.{pulley}");
            panels.push(panel(
                "Clutch torque".to_owned(),
                "N m",
                vec![(torque, String::new())],
            ));
        }
        if let Some(tensioner) = element.strip_prefix("friction.").filter(|_| is_friction(shares)) {
            for (measure, title) in [
                (format!("arm.{tensioner}"), "Arm position"),
                (format!("friction_torque.{tensioner}"), "Friction torque"),
            ] {
                let unit = header.units.measures.get(&measure);
                panels.push(panel(title.to_owned(), unit, vec![(measure, String::new())]));
            }
        }
        // In other systems measures of the element's force carry its name.
        if known(element) {
            let unit = header.units.measures.get(element);
            panels.push(panel(
                plots::capital(&plots::words(element)),
                unit,
                vec![(element.clone(), String::new())],
            ));
        }
    }
    panels.retain(|panel| !panel.curves.is_empty());
    if panels.is_empty()
        && let Some((measure, _)) = history.measures.0.first()
    {
        let unit = header.units.measures.get(measure);
        panels.push(panel(
            plots::capital(&plots::words(measure)),
            unit,
            vec![(measure.clone(), String::new())],
        ));
    }
    panels
}

fn timeline(document: &ResponseDocument, motion: &OrbitRow, history: &History) -> Figure {
    let events: Vec<(f64, &Event)> = motion
        .motion
        .events
        .iter()
        .map(|event| (event.phase, event))
        .collect();
    let mut options = plots::options();
    options.title = Some(name(motion));
    regime_timeline(
        &RegimeTimeline {
            time: Axis::linear("Phase of the period", "–"),
            panels: panels(&document.header, motion, history),
            lanes: lanes(&events, &motion.motion.regimes, [0.0, 1.0], true),
            repetition: Some(Repetition {
                period: 1.0,
                count: PERIODS,
            }),
        },
        &options,
    )
}

/// Torque over position of each friction element of a drive's tensioners, or of an element whose coordinate has its name.
fn friction_loops(motion: &OrbitRow, history: &History, several: bool) -> Vec<FrictionLoop> {
    let mut loops = Vec::new();
    for (element, shares) in motion
        .motion
        .regimes
        .0
        .iter()
        .filter(|(_, shares)| is_friction(shares))
    {
        let tensioner = element.strip_prefix("friction.").unwrap_or(element);
        let angle = history.measures.get(&format!("arm.{tensioner}"));
        let torque = history
            .measures
            .get(&format!("friction_torque.{tensioner}"))
            .or_else(|| history.measures.get(element));
        let (Some(angle), Some(torque)) = (angle, torque) else {
            continue;
        };
        let events: Vec<&Event> = motion
            .motion
            .events
            .iter()
            .filter(|event| event.element == *element)
            .collect();
        let sticks_always = shares.get("stick").is_some_and(|share| share >= 1.0 - 1e-9);
        let sticks = history.phase.iter().map(|phase| {
            let before = events.iter().rev().find(|event| event.phase <= *phase);
            before
                .or(events.last())
                .map_or(sticks_always, |event| event.to == "stick")
        });
        loops.push(FrictionLoop {
            name: if several {
                name(motion)
            } else {
                tensioner.to_owned()
            },
            angle: angle.clone(),
            torque: torque.clone(),
            sticks: sticks.collect(),
            dissipation: motion.motion.elements.get(element).map(|row| row.dissipation),
        });
    }
    loops
}
