//! Matrices, natural frequencies and forced response of the three-pulley prototype against `drive_three_pulley.json`
//! (theory 04 §7).

use crate::drive_steady::steady;
use serde_json::Value;
use slackside_belt_drive::dimensionless::Dimensionless;
use slackside_belt_drive::drive::{BeltModel, Coupling, Drive, Load, SpanEnds};
use slackside_belt_drive::forced_response::{HarmonicLoad, forced_response};
use slackside_belt_drive::model::LinearModel;
use slackside_belt_drive::modes::{Mode, damped_modes, undamped_modes};
use slackside_belt_drive::prototypes::three_pulley;
use slackside_linalg::{Complex, Matrix};
use slackside_testkit::{assert_close, number, numbers, reference};
use std::f64::consts::TAU;

fn with_terms(mut drive: Drive, terms: usize, static_correction: bool) -> Drive {
    drive.belt.terms = vec![terms; 3];
    drive.belt.static_correction = static_correction;
    drive
}

fn undamped(drive: &Drive, rpm: f64, driver_is_free: bool) -> Vec<Mode> {
    let state = steady(drive, rpm);
    undamped_modes(drive, &LinearModel::new(drive, &state), driver_is_free).unwrap()
}

#[track_caller]
fn compare_hertz(modes: &[Mode], expected: &[f64], tolerance: f64, what: &str) {
    assert!(modes.len() >= expected.len(), "{what}: too few modes");
    for (mode, expected) in modes.iter().zip(expected) {
        assert_close(
            mode.frequency / TAU / expected.max(1.0),
            expected / expected.max(1.0),
            tolerance,
            what,
        );
    }
}

fn compare_matrix(found: &Matrix, expected: &Value, what: &str) {
    let rows: Vec<Vec<f64>> = expected.as_array().unwrap().iter().map(numbers).collect();
    let largest = rows.iter().flatten().fold(0.0_f64, |a, v| a.max(v.abs()));
    for (i, row) in rows.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            assert_close(
                found[(i, j)] / largest,
                value / largest,
                1e-13,
                &format!("{what}[{i}, {j}]"),
            );
        }
    }
}

#[test]
fn matrices() {
    let expected = &reference("drive_three_pulley.json")["matrices"];
    let rpm = number(&expected["crank_rpm"]);
    let plain = with_terms(three_pulley(number(&expected["EI"])), 3, false);
    let model = LinearModel::new(&plain, &steady(&plain, rpm));
    compare_matrix(&model.mass, &expected["M"], "M");
    compare_matrix(&model.gyroscopic, &expected["G"], "G");
    compare_matrix(&model.stiffness, &expected["K"], "K");
    compare_matrix(&model.stretch, &expected["stretch_rows"], "D");
    let corrected = with_terms(plain.clone(), 3, true);
    let with_correction = LinearModel::new(&corrected, &steady(&corrected, rpm));
    for (model, key) in [
        (&model, "span_stiffness"),
        (&with_correction, "static_residual_span_stiffness"),
    ] {
        for (found, expected) in model.span_stiffness.iter().zip(numbers(&expected[key])) {
            assert_close(found / expected, 1.0, 1e-12, key);
        }
    }
}

#[test]
fn galerkin_frequencies_and_shares() {
    let file = reference("drive_three_pulley.json");
    for case in file["cases"].as_array().unwrap() {
        let drive = three_pulley(number(&case["EI"]));
        let rpm = number(&case["crank_rpm"]);
        let expected = &case["frequencies_crank_prescribed"];
        for terms in [3, 5, 10] {
            for (suffix, correction) in [("", false), ("_residual", true)] {
                let key = format!("galerkin_{terms}{suffix}_hz");
                let modes = undamped(&with_terms(drive.clone(), terms, correction), rpm, false);
                compare_hertz(&modes, &numbers(&expected[&key]), 1e-11, &key);
            }
        }
        let fine = with_terms(drive.clone(), 60, true);
        let modes = undamped(&fine, rpm, false);
        compare_hertz(&modes, &numbers(&expected["exact_hz"]), 1e-5, "exact");
        let free = undamped(&fine, rpm, true);
        compare_hertz(
            &free,
            &numbers(&expected["crank_free_exact_hz"]),
            1e-5,
            "crank free",
        );
        for (mode, shares) in modes.iter().zip(expected["kinetic_shares"].as_array().unwrap()) {
            let rotation: f64 = mode.shares.rotation.iter().sum();
            assert_close(rotation, number(&shares["rotation"]), 1e-4, "rotation");
            assert_close(mode.shares.arms[0], number(&shares["arm"]), 1e-4, "arm");
            for (found, expected) in mode.shares.spans.iter().zip(numbers(&shares["spans"])) {
                assert_close(*found, expected, 1e-4, "span");
            }
        }
    }
}

#[test]
fn string_and_spring_models() {
    let file = reference("drive_three_pulley.json");
    for row in file["string_and_spring_models"].as_array().unwrap() {
        let rpm = number(&row["crank_rpm"]);
        let mut drive = with_terms(three_pulley(0.0), 120, true);
        drive.belt.model = BeltModel::Spring;
        compare_hertz(
            &undamped(&drive, rpm, false),
            &numbers(&row["spring_hz"]),
            1e-11,
            "spring",
        );
        drive.belt.model = BeltModel::String;
        // The sines of a string between moving ends converge with the third power only.
        compare_hertz(
            &undamped(&drive, rpm, false),
            &numbers(&row["string_exact_hz"]),
            5e-5,
            "string",
        );
    }
}

#[test]
fn contact_ends() {
    let expected = &reference("drive_three_pulley.json")["free_contact_points"];
    let mut drive = with_terms(three_pulley(number(&expected["EI"])), 60, true);
    drive.belt.span_ends = SpanEnds::Contact;
    let modes = undamped(&drive, number(&expected["crank_rpm"]), false);
    compare_hertz(
        &modes,
        &numbers(&expected["corrected_galerkin_60_hz"]),
        1e-11,
        "corrected",
    );
    compare_hertz(
        &modes,
        &numbers(&expected["fe_clamped_hz"])[..8],
        4e-3,
        "finite elements clamped at the departure points",
    );
}

#[test]
fn locked_and_disengaged_clutch() {
    let expected = &reference("drive_three_pulley.json")["clutch_configurations"];
    let rpm = number(&expected["crank_rpm"]);
    for case in expected["cases"].as_array().unwrap() {
        let mut drive = with_terms(three_pulley(number(&expected["EI"])), 60, true);
        drive.pulleys[2].inertia = number(&case["pulley_inertia"]);
        drive.pulleys[2].coupling = Coupling::OneWay {
            accessory_inertia: number(&case["accessory_inertia"]),
        };
        let locked = undamped(&drive, rpm, false);
        compare_hertz(&locked, &numbers(&case["locked_exact_hz"]), 1e-5, "locked");
        let state = steady(&drive, rpm);
        let model = LinearModel::with_disengaged(&drive, &state, &[2]);
        let open = undamped_modes(&drive, &model, false).unwrap();
        assert_eq!(open[0].frequency, 0.0);
        compare_hertz(
            &open[1..],
            &numbers(&case["disengaged_exact_hz"]),
            1e-5,
            "disengaged",
        );
    }
}

fn complex(value: &Value) -> Complex {
    let parts = numbers(value);
    Complex::new(parts[0], parts[1])
}

/// The reference's damped drive with many terms.
fn damped_prototype(expected: &Value) -> Drive {
    let mut drive = with_terms(three_pulley(number(&expected["EI"])), 120, true);
    drive.belt.damping.span_dashpot = number(&expected["span_dashpot"]);
    drive.tensioners[0].damping = number(&expected["arm_damping"]);
    for pulley in &mut drive.pulleys[1..] {
        pulley.bearing_damping = number(&expected["bearing_damping_per_pulley"]);
    }
    drive
}

#[test]
fn response_to_crank_rotation() {
    let expected = &reference("drive_three_pulley.json")["forced_response"];
    let drive = damped_prototype(expected);
    let state = steady(&drive, number(&expected["crank_rpm"]));
    let model = LinearModel::new(&drive, &state);
    let amplitude = Complex::new(number(&expected["crank_amplitude_rad"]), 0.0);
    for case in expected["cases"].as_array().unwrap() {
        let frequency = TAU * number(&case["frequency_hz"]);
        let motion =
            forced_response(&drive, &model, frequency, HarmonicLoad::DriverRotation(amplitude)).unwrap();
        // The file gives how far 120 sine terms are from its exact values; ours must be as near. Displacements of the spans
        // converge more slowly.
        let tolerance = 1.5 * number(&case["relative_difference_to_galerkin_120"]) + 1e-9;
        let compare = |found: Complex, expected: Complex, scale: f64, what: &str| {
            let tolerance = if what == "middle of the span" {
                2e-5
            } else {
                tolerance
            };
            assert_close((found - expected).norm() / scale, 0.0, tolerance, what);
        };
        let arm = complex(&case["arm"][0]);
        compare(motion.amplitudes[3], arm, arm.norm(), "arm");
        let largest = |key: &str| {
            let list = case[key].as_array().unwrap();
            list.iter().map(|v| complex(v).norm()).fold(0.0, f64::max)
        };
        for i in 0..3 {
            compare(
                motion.amplitudes[i],
                complex(&case["pulley_rotation"][i]),
                largest("pulley_rotation"),
                "pulley",
            );
            compare(
                model.dynamic_tension(&motion, i),
                complex(&case["dynamic_tension"][i]),
                largest("dynamic_tension"),
                "tension",
            );
            let middle = 0.5 * state.layout.spans[i].length;
            compare(
                model.span_motion(&state, &motion, i).at(middle),
                complex(&case["mid_span_displacement"][i]),
                largest("mid_span_displacement"),
                "middle of the span",
            );
        }
    }
}

#[test]
fn dimensionless_groups() {
    let expected = &reference("drive_three_pulley.json")["dimensionless"];
    let drive = with_terms(three_pulley(number(&expected["EI"])), 60, true);
    let state = steady(&drive, number(&expected["crank_rpm"]));
    let model = LinearModel::new(&drive, &state);
    let span = number(&expected["reference_span"]) as usize;
    let form = Dimensionless::new(&drive, &state, &model, span, number(&expected["force"]));
    let compare = |found: f64, expected: f64, what: &str| {
        assert_close(found, expected, 1e-12 * expected.abs().max(1.0), what);
    };
    compare(form.length, number(&expected["length"]), "length");
    compare(form.time, number(&expected["time"]), "time");
    compare(form.speed, number(&expected["s"]), "s");
    compare(form.bending, number(&expected["epsilon"]), "epsilon");
    compare(form.stretch, number(&expected["gamma"]), "gamma");
    compare(form.arm_inertia[0], number(&expected["arm_inertia"]), "arm");
    compare(form.arm_spring[0], number(&expected["arm_spring"]), "spring");
    for j in 0..3 {
        compare(
            form.pulley_inertia[j],
            numbers(&expected["pulley_inertia"])[j],
            "inertia",
        );
        compare(form.load[j], numbers(&expected["load"])[j], "load");
    }
    // The scaled matrices have the scaled frequencies.
    let free = model.free_coordinates(&drive, false);
    let scaled = slackside_linalg::gyroscopic_modes(
        &form.mass(&model.mass).selected(&free),
        &form.damping(&model.gyroscopic).selected(&free),
        &form.stiffness(&model.stiffness).selected(&free),
    )
    .unwrap();
    for (found, expected) in scaled.frequencies.iter().zip(numbers(&expected["frequencies"])) {
        assert_close(found / expected, 1.0, 1e-5, "frequency");
    }
}

#[test]
fn damped_modes_without_damping_are_the_undamped_ones() {
    let drive = three_pulley(0.015);
    let state = steady(&drive, 2000.0);
    let model = LinearModel::new(&drive, &state);
    let hermitian = undamped_modes(&drive, &model, false).unwrap();
    let general = damped_modes(&drive, &model, false).unwrap();
    assert_eq!(hermitian.len(), general.len());
    for (a, b) in hermitian.iter().zip(&general) {
        assert_close(b.frequency / a.frequency, 1.0, 1e-11, "frequency");
        assert_close(b.damping_ratio, 0.0, 1e-10, "damping ratio");
    }
}

#[test]
fn a_light_load_on_the_arm_moves_it_as_the_steady_solver_says() {
    // The static response of the linear model to a small torque of the arm's spring against two steady states. They differ
    // by terms of P/EA (theory 04 §7): 100 times the axial stiffness makes that 2e-5.
    let mut drive = with_terms(three_pulley(0.015), 60, true);
    drive.belt.axial_stiffness *= 100.0;
    drive.pulleys[2].load = Load::Torque(2.0);
    let installed = slackside_belt_drive::steady::Installed::new(&drive).unwrap();
    let solve =
        |installed: &_| slackside_belt_drive::steady::SteadyState::solve(&drive, installed, 150.0).unwrap();
    let at_rest = solve(&installed);
    let mut pushed = installed.clone();
    let torque = 1e-4;
    pushed.spring_torques[0] += torque;
    let arm_moved = solve(&pushed).positions[0] - at_rest.positions[0];
    let model = LinearModel::new(&drive, &at_rest);
    let free = model.free_coordinates(&drive, false);
    let mut right = vec![0.0; free.len()];
    let arm = free
        .iter()
        .position(|index| *index == model.coordinates.arm(0))
        .unwrap();
    right[arm] = torque;
    let solution = slackside_linalg::Lu::new(&model.stiffness.selected(&free))
        .unwrap()
        .solve(&right);
    assert_close(solution[arm] / arm_moved, 1.0, 1e-4, "arm");
}
