//! Tasks (d) and (e): the eight-pulley accessory drive of `examples/drives`, 10 sine terms for each span.
//!
//! (d) 1,000 steady states with everything that a design sheet states, from 600 to 6,000 rpm of the crank.
//! (e) A Campbell diagram of 100 speeds over the same range, the 20 lowest modes followed.

use crate::timing::{Timing, measure};
use serde_json::{Value, json};
use slackside_belt_drive::drive::Drive;
use slackside_belt_drive::model::LinearModel;
use slackside_belt_drive::modes::{Campbell, campbell, undamped_modes};
use slackside_belt_drive::steady::{Installed, SteadyState};
use slackside_linalg::Matrix;
use slackside_model_file::Document;
use std::f64::consts::PI;
use std::path::Path;

const SHEETS: usize = 1000;
const SPEEDS: usize = 100;
const TERMS: usize = 10;
const CURVES: usize = 20;

fn drive() -> Drive {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/drives/eight-pulley.toml");
    let document = Document::read(&path).expect("the example can be read");
    let (model, _) = document.model().expect("the example is sound");
    let described = model.drive().expect("the example is a drive");
    let mut drive = described.belt_drive().expect("the example has a belt path");
    drive.belt.terms = vec![TERMS; drive.pulleys.len()];
    drive
}

/// Speed of the crank, rad/s.
fn speed(k: usize, count: usize) -> f64 {
    (600.0 + 5400.0 * k as f64 / (count - 1) as f64) * PI / 30.0
}

fn steady(drive: &Drive, installed: &Installed, speed: f64) -> SteadyState {
    SteadyState::solve(drive, installed, speed).expect("the example runs at every speed")
}

/// Everything on the sheet, added up so that nothing is left out.
fn sheet(drive: &Drive, speed: f64) -> f64 {
    let installed = Installed::new(drive).expect("the example can be installed");
    let state = steady(drive, &installed, speed);
    let pulleys = 0..drive.pulleys.len();
    let of_pulleys: f64 = pulleys
        .clone()
        .map(|j| state.belt_forces[j].length() + state.tension_ratio(drive, j))
        .sum();
    let of_spans: f64 = pulleys
        .map(|i| {
            state.tensions[i]
                + state.span_frequency(drive, i)
                + state.sag_indicator(drive, i)
                + state.bending_indicator(i)
                + state.spans[i].deflection(0.5 * state.layout.spans[i].length)
        })
        .sum();
    of_pulleys + of_spans
}

pub(crate) fn sheets(repeats: usize) -> Value {
    let drive = drive();
    let timing: Timing<f64> = measure(repeats, || {
        (0..SHEETS).map(|k| sheet(&drive, speed(k, SHEETS))).sum()
    });
    let installed = Installed::new(&drive).expect("the example can be installed");
    let state = steady(&drive, &installed, speed(SHEETS / 2, SHEETS));
    // The moment of all belt forces is that of the shafts' torques.
    let moment: f64 = drive
        .pulleys
        .iter()
        .enumerate()
        .map(|(j, pulley)| {
            let torque = if j == drive.driver {
                -state.driver_torque
            } else {
                state.loads[j]
            };
            state.layout.centres[j].perp_dot(state.belt_forces[j]) + pulley.sense.sign() * torque
        })
        .sum();
    let accuracy = json!({
        "driver_torque": state.driver_torque,
        "moment_imbalance": moment.abs() / state.driver_torque,
    });
    timing.line(
        "d",
        "A",
        accuracy,
        f64::NAN,
        "1,000 steady states of the eight-pulley drive: installation, Newton, sheet; operations not counted",
    )
}

pub(crate) fn diagram(repeats: usize) -> Value {
    let drive = drive();
    let installed = Installed::new(&drive).expect("the example can be installed");
    let speeds: Vec<f64> = (0..SPEEDS).map(|k| speed(k, SPEEDS)).collect();
    let timing: Timing<Campbell> = measure(repeats, || {
        campbell(&drive, &installed, &speeds, false, CURVES).expect("the example is stable at every speed")
    });
    let state = steady(&drive, &installed, speeds[SPEEDS / 2]);
    let model = LinearModel::new(&drive, &state);
    let free = model.free_coordinates(&drive, false).len();
    let accuracy = json!({
        "coordinates": free,
        "largest_jump_of_a_curve": largest_jump(&timing.result),
    });
    let flops = SPEEDS as f64 * 18.0 * (2.0 * free as f64).powi(3);
    timing.line(
        "e",
        "A",
        accuracy,
        flops,
        "steady states, matrices, all modes, following; operations of the eigenproblems estimated as 18 (2n)³",
    )
}

/// Largest relative change of a followed frequency from one speed to the next.
fn largest_jump(diagram: &Campbell) -> f64 {
    diagram
        .points
        .windows(2)
        .flat_map(|pair| pair[0].modes.iter().zip(&pair[1].modes))
        .map(|(before, after)| (after.frequency / before.frequency - 1.0).abs())
        .fold(0.0, f64::max)
}

/// Matrices and frequencies (rad/s) at the middle speed, for peers.
pub(crate) fn matrices() -> Value {
    let drive = drive();
    let installed = Installed::new(&drive).expect("the example can be installed");
    let state = steady(&drive, &installed, speed(SPEEDS / 2, SPEEDS));
    let model = LinearModel::new(&drive, &state);
    let free = model.free_coordinates(&drive, false);
    let modes = undamped_modes(&drive, &model, false).expect("the example is stable");
    let rows = |matrix: &Matrix| -> Vec<Vec<f64>> {
        let part = matrix.selected(&free);
        (0..part.rows()).map(|i| part.row(i).to_vec()).collect()
    };
    json!({
        "speeds": SPEEDS,
        "mass": rows(&model.mass),
        "gyroscopic": rows(&model.gyroscopic),
        "stiffness": rows(&model.stiffness),
        "frequencies": modes.iter().map(|mode| mode.frequency).collect::<Vec<_>>(),
    })
}
