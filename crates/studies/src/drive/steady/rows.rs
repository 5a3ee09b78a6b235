//! Rows of the steady sheet from a steady state, and what is remarked about them.

use super::document::{Outcome, PulleyRow, SpanRow, StateRow, TensionerRow};
use crate::drive::{InstalledDrive, RPM};
use crate::{Header, Texts};
use slackside_belt_drive::creep;
use slackside_belt_drive::drive::{Condition, Guide, Mount, SpanEnds};
use slackside_belt_drive::steady::SteadyState;
use std::f64::consts::TAU;

/// Sag indicator above which the choice of span ends matters (theory 04 §8.1).
const NOTICEABLE_SAG: f64 = 0.1;
/// Slip safety below which a warning is given.
const LOW_SLIP_SAFETY: f64 = 1.2;
/// Strain above which a warning is given.
const LARGE_STRAIN: f64 = 0.015;

/// Units of the document's numbers by key.
pub(super) fn units() -> Texts {
    let units = [
        ("speed", "rpm"),
        ("belt.speed", "m/s"),
        ("length", "m"),
        ("tension", "N"),
        ("frequency_1", "Hz"),
        ("wrap", "rad"),
        ("torque", "N m"),
        ("hub_load", "N"),
        ("angle", "rad"),
        ("take_up", "m/rad"),
    ];
    Texts(units.map(|(key, unit)| (key.to_owned(), unit.to_owned())).into())
}

pub(super) fn warn(header: &mut Header, at: &InstalledDrive, spans: &[SpanRow], pulleys: &[PulleyRow]) {
    for pulley in pulleys {
        if let Some(safety) = pulley.slip_safety
            && safety < LOW_SLIP_SAFETY
        {
            header.warnings.push(format!(
                "\"{}\": safety against slip is only {safety:.2}; raise the tension, the wrap or the friction",
                pulley.name
            ));
        }
    }
    let strain = spans
        .iter()
        .map(|span| span.tension / at.drive.belt.axial_stiffness)
        .fold(0.0, f64::max);
    if strain > LARGE_STRAIN {
        header.warnings.push(format!(
            "the belt is stretched by {:.1} %, more than belts bear for long; take a longer belt or lower the tension",
            100.0 * strain
        ));
    }
    let largest = spans.iter().map(|span| span.sag_indicator).fold(0.0, f64::max);
    if largest > NOTICEABLE_SAG && at.drive.belt.span_ends == SpanEnds::Tangent {
        header.warnings.push(format!(
            "the sag indicator χ reaches {largest:.2}: with `span_ends = \"tangent\"` bending softens the belt more than it \
             does in a real drive; for design work set `belt.span_ends = \"contact\"`"
        ));
    }
}

pub(super) fn span_row(at: &InstalledDrive, state: &SteadyState, i: usize) -> SpanRow {
    let geometry = &state.layout.spans[i];
    SpanRow {
        from: at.drive.pulleys[i].name.clone(),
        to: at.drive.pulleys[at.drive.next(i)].name.clone(),
        length: geometry.length,
        tension: state.tensions[i],
        effective_tension: state.effective_tensions[i],
        frequency_1: state.span_frequency(&at.drive, i) / TAU,
        sag_indicator: state.sag_indicator(&at.drive, i),
        ends: [geometry.start.into(), geometry.end.into()],
    }
}

pub(super) fn pulley_row(
    at: &InstalledDrive,
    state: &SteadyState,
    creep: Option<&creep::Creep>,
    j: usize,
) -> PulleyRow {
    let drive = &at.drive;
    let pulley = &drive.pulleys[j];
    let force = state.belt_forces[j];
    let ratio = drive.pulleys[drive.driver].radius / pulley.radius;
    let creep = creep.map(|creep| &creep.pulleys[j]);
    let loss = creep.map(|creep| creep.speed_loss);
    PulleyRow {
        name: pulley.name.clone(),
        driver: j == drive.driver,
        tensioner: match pulley.mount {
            Mount::Fixed(_) => None,
            Mount::Carried { tensioner, .. } => Some(drive.tensioners[tensioner].name.clone()),
        },
        center: state.layout.centres[j].into(),
        radius: pulley.radius,
        sense: pulley.sense.sign(),
        wrap: state.layout.wraps[j],
        ratio,
        speed: at.driver_speed / RPM * ratio,
        speed_with_creep: loss.map(|loss| at.driver_speed / RPM * ratio * (1.0 - loss)),
        speed_loss: loss,
        slip_arc: creep.map(|creep| creep.contact.slip_arc),
        torque: if j == drive.driver {
            state.driver_torque
        } else {
            state.loads[j]
        },
        hub_load: force.into(),
        hub_load_magnitude: force.length(),
        hub_load_direction: force.to_angle(),
        slip_safety: finite(state.slip_safety(drive, j)),
        slip_torque: state.slip_torque(drive, j),
    }
}

pub(super) fn tensioner_row(at: &InstalledDrive, state: &SteadyState, arm: usize) -> TensionerRow {
    let tensioner = &at.drive.tensioners[arm];
    let position = state.positions[arm];
    let take_up = state.kinematics.take_up[arm];
    let (kind, angle, place, pivot, direction) = match tensioner.guide {
        Guide::Rotary { pivot } => ("rotary", Some(position), None, Some(pivot.into()), None),
        Guide::Linear { direction } => ("linear", None, Some(position), None, Some(direction.into())),
    };
    TensionerRow {
        name: tensioner.name.clone(),
        kind,
        angle,
        position: place,
        travel: position - tensioner.reference,
        take_up,
        torque: (if tensioner.locked {
            state.holding_torques[arm]
        } else {
            state.spring_torques[arm]
        }) * take_up.signum(),
        pivot,
        stops: tensioner.stops,
        direction,
    }
}

pub(super) fn outcome(at: &InstalledDrive, condition: &Condition) -> Outcome {
    let (drive, installed) = at.installed.in_condition(&at.drive, condition);
    match SteadyState::solve(&drive, &installed, at.driver_speed) {
        Err(error) => Outcome::Impossible {
            impossible: error.to_string(),
        },
        Ok(state) => Outcome::State(StateRow {
            hub_loads: state.belt_forces.iter().map(|force| [force.x, force.y]).collect(),
            slip_safeties: (0..drive.pulleys.len())
                .map(|j| finite(state.slip_safety(&drive, j)))
                .collect(),
            wraps: state.layout.wraps,
            tensions: state.tensions,
            effective_tensions: state.effective_tensions,
            positions: state.positions,
        }),
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
