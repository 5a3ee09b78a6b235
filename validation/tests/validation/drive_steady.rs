//! Geometry and steady state of the three-pulley prototype against `drive_three_pulley.json` (theory 04 §7).

use serde_json::Value;
use slackside_belt_drive::drive::{BeltModel, Drive, SpanEnds};
use slackside_belt_drive::prototypes::three_pulley;
use slackside_belt_drive::steady::{Installed, SteadyState};
use slackside_testkit::{assert_close, number, numbers, reference};
use std::f64::consts::PI;

/// Relative agreement of all numbers below, as measured: 2e-13 and better.
const DIGITS: f64 = 1e-12;

#[track_caller]
fn agree(found: f64, expected: f64, scale: f64, what: &str) {
    assert_close(found / scale, expected / scale, DIGITS, what);
}

/// The steady state of a drive at a crank speed in rpm.
pub fn steady(drive: &Drive, rpm: f64) -> SteadyState {
    let installed = Installed::new(drive).unwrap();
    SteadyState::solve(drive, &installed, rpm * PI / 30.0).unwrap()
}

#[test]
fn natural_length_and_spring_torque() {
    for row in reference("drive_three_pulley.json")["natural_belt_length_and_spring"]
        .as_array()
        .unwrap()
    {
        let drive = three_pulley(number(&row["EI"]));
        let installed = Installed::new(&drive).unwrap();
        agree(
            installed.natural_length,
            number(&row["natural_length"]),
            1.0,
            "natural length",
        );
        let expected = numbers(&row["spring_torque_at_reference"])[0];
        agree(installed.spring_torques[0], expected, 20.0, "spring torque");
    }
}

#[test]
fn steady_states() {
    let file = reference("drive_three_pulley.json");
    let cases = file["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 9);
    for case in cases {
        let drive = three_pulley(number(&case["EI"]));
        let state = steady(&drive, number(&case["crank_rpm"]));
        let expected = &case["steady"];
        agree(state.belt_speed, number(&case["belt_speed"]), 10.0, "belt speed");
        agree(
            state.positions[0],
            numbers(&expected["arm_coordinate"])[0],
            0.1,
            "arm",
        );
        agree(
            state.driver_torque,
            number(&expected["driver_torque"]),
            10.0,
            "driver torque",
        );
        for (i, span) in expected["spans"].as_array().unwrap().iter().enumerate() {
            compare_span(&drive, &state, i, span);
        }
        for (j, pulley) in expected["pulleys"].as_array().unwrap().iter().enumerate() {
            compare_pulley(&drive, &state, j, pulley);
        }
    }
}

fn compare_span(drive: &Drive, state: &SteadyState, i: usize, expected: &Value) {
    let (geometry, shape) = (&state.layout.spans[i], &state.spans[i]);
    let compare = |key: &str, found: f64| {
        let value = number(&expected[key]);
        agree(found, value, value.abs(), key);
    };
    compare("length", geometry.length);
    compare("direction_angle", geometry.angle);
    compare("tension", state.tensions[i]);
    compare("effective_tension", state.effective_tensions[i]);
    compare("lam_L", shape.slenderness());
    compare("shear_Q", shape.shear());
    compare("excess_length", shape.excess_length());
    compare("int_w2_squared", shape.curvature_integral());
    compare("Gamma", state.bending_indicator(i));
    compare("sag_compliance", shape.sag_compliance());
    compare("stretch_compliance", geometry.length / drive.belt.axial_stiffness);
    compare("curvature_start", shape.curvature(0.0));
    compare("curvature_end", shape.curvature(geometry.length));
    for (n, expected) in numbers(&expected["h"]).into_iter().enumerate() {
        agree(shape.coupling(n + 1), expected, expected.abs(), "coupling");
    }
    for (k, expected) in numbers(&expected["w_at_quarter_half_threequarter"])
        .into_iter()
        .enumerate()
    {
        let x = 0.25 * (k + 1) as f64 * geometry.length;
        agree(shape.deflection(x), expected, 1e-3, "deflection");
    }
}

fn compare_pulley(drive: &Drive, state: &SteadyState, j: usize, expected: &Value) {
    let point = |key: &str| numbers(&expected[key]);
    let before = drive.span_before(j);
    for (key, found) in [
        ("center", state.layout.centres[j]),
        ("tangent_in", state.layout.spans[before].end),
        ("tangent_out", state.layout.spans[j].start),
    ] {
        agree(found.x, point(key)[0], 0.1, key);
        agree(found.y, point(key)[1], 0.1, key);
    }
    let force = point("belt_force");
    agree(state.belt_forces[j].x, force[0], 100.0, "belt force");
    agree(state.belt_forces[j].y, force[1], 100.0, "belt force");
    agree(state.layout.wraps[j], number(&expected["wrap"]), 1.0, "wrap");
    agree(
        state.tension_ratio(drive, j),
        number(&expected["effective_tension_ratio"]),
        1.0,
        "tension ratio",
    );
}

#[test]
fn string_states() {
    let file = reference("drive_three_pulley.json");
    for row in file["string_and_spring_models"].as_array().unwrap() {
        let mut drive = three_pulley(0.0);
        drive.belt.model = BeltModel::String;
        let state = steady(&drive, number(&row["crank_rpm"]));
        agree(state.positions[0], numbers(&row["arm_coordinate"])[0], 0.1, "arm");
        for (found, expected) in state.tensions.iter().zip(numbers(&row["tension"])) {
            agree(*found, expected, expected, "tension");
        }
    }
}

#[test]
fn contact_ends() {
    let file = reference("drive_three_pulley.json");
    for key in ["contact_corrected_steady_state", "free_contact_points"] {
        let expected = &file[key];
        let mut drive = three_pulley(number(&expected["EI"]));
        drive.belt.span_ends = SpanEnds::Contact;
        let state = steady(&drive, 2000.0);
        agree(
            state.positions[0],
            numbers(&expected["arm_coordinate"])[0],
            0.1,
            "arm",
        );
        for (found, expected) in state.tensions.iter().zip(numbers(&expected["tension"])) {
            agree(*found, expected, expected, "tension");
        }
    }
}
