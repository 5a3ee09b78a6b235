//! The strong form of the linear model against `drive_three_pulley.json` (theory 04 §4.6, §7).

use crate::drive_steady::steady;
use serde_json::Value;
use slackside_belt_drive::drive::{BeltModel, Coupling, Drive};
use slackside_belt_drive::prototypes::three_pulley;
use slackside_belt_drive::steady::SteadyState;
use slackside_belt_drive::strong_form::{Configuration, DriverMotion, HarmonicLoad, StrongForm};
use slackside_linalg::Complex;
use slackside_testkit::{assert_close, number, numbers, reference};
use std::f64::consts::TAU;

/// Newton's method from estimates that are off by alternating signs of this size, relative.
const OFF: f64 = 2e-4;

/// Largest relative difference of natural frequencies, each found from an estimate, and of those found by a scan.
fn compare(drive: &Drive, state: &SteadyState, configuration: &Configuration, expected: &[f64]) -> f64 {
    let form = StrongForm::new(drive, state, configuration.clone()).unwrap();
    let mut worst = 0.0_f64;
    for (k, hertz) in expected.iter().enumerate() {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        let estimate = TAU * hertz * (1.0 + sign * OFF);
        let found = form.natural_motion(estimate.into()).unwrap();
        worst = worst.max((found.hertz() / hertz - 1.0).abs());
        assert!(
            found.frequency.im.abs() < 1e-10 * found.frequency.re,
            "{}",
            found.frequency
        );
    }
    let (low, high) = (
        0.97 * TAU * expected[0],
        1.0001 * TAU * expected[expected.len() - 1],
    );
    let scanned = form.natural_motions(low, high).unwrap();
    assert_eq!(
        scanned.len(),
        expected.len(),
        "a scan finds all frequencies and no others"
    );
    for (found, hertz) in scanned.iter().zip(expected) {
        worst = worst.max((found.hertz() / hertz - 1.0).abs());
    }
    worst
}

fn free_driver() -> Configuration {
    Configuration {
        driver: DriverMotion::Free,
        ..Configuration::default()
    }
}

#[test]
fn natural_frequencies_of_the_beam_with_the_crank_prescribed_and_free() {
    let file = reference("drive_three_pulley.json");
    let mut worst = 0.0_f64;
    for case in file["cases"].as_array().unwrap() {
        let drive = three_pulley(number(&case["EI"]));
        let state = steady(&drive, number(&case["crank_rpm"]));
        let expected = &case["frequencies_crank_prescribed"];
        let prescribed = compare(
            &drive,
            &state,
            &Configuration::default(),
            &numbers(&expected["exact_hz"]),
        );
        // The first of the free frequencies is that of the rotation as a whole, zero.
        let free = numbers(&expected["crank_free_exact_hz"]);
        let free = compare(&drive, &state, &free_driver(), &free[1..]);
        worst = worst.max(prescribed).max(free);
    }
    assert!(worst < 1e-12, "{worst:.1e}");
}

#[test]
fn natural_frequencies_of_the_string() {
    let file = reference("drive_three_pulley.json");
    let mut worst = 0.0_f64;
    for row in file["string_and_spring_models"].as_array().unwrap() {
        let mut drive = three_pulley(0.0);
        drive.belt.model = BeltModel::String;
        let state = steady(&drive, number(&row["crank_rpm"]));
        let expected = numbers(&row["string_exact_hz"]);
        worst = worst.max(compare(&drive, &state, &Configuration::default(), &expected));
    }
    assert!(worst < 1e-12, "{worst:.1e}");
}

#[test]
fn natural_frequencies_with_the_clutch_locked_and_disengaged() {
    let file = reference("drive_three_pulley.json");
    let block = &file["clutch_configurations"];
    let mut worst = 0.0_f64;
    for case in block["cases"].as_array().unwrap() {
        let mut drive = three_pulley(number(&block["EI"]));
        drive.pulleys[2].inertia = number(&case["pulley_inertia"]);
        drive.pulleys[2].coupling = Coupling::OneWay {
            accessory_inertia: number(&case["accessory_inertia"]),
        };
        let state = steady(&drive, number(&block["crank_rpm"]));
        let locked = Configuration::default();
        let disengaged = Configuration {
            disengaged: vec![2],
            ..Configuration::default()
        };
        worst = worst
            .max(compare(
                &drive,
                &state,
                &locked,
                &numbers(&case["locked_exact_hz"]),
            ))
            .max(compare(
                &drive,
                &state,
                &disengaged,
                &numbers(&case["disengaged_exact_hz"]),
            ));
    }
    assert!(worst < 1e-12, "{worst:.1e}");
}

/// The prototype with the damping of a block of the file.
fn damped(block: &Value) -> Drive {
    let mut drive = three_pulley(number(&block["EI"]));
    drive.belt.damping.span_dashpot = number(&block["span_dashpot"]);
    drive.tensioners[0].damping = number(&block["arm_damping"]);
    for pulley in &mut drive.pulleys[1..] {
        pulley.bearing_damping = number(&block["bearing_damping_per_pulley"]);
    }
    drive
}

#[test]
fn forced_response() {
    let file = reference("drive_three_pulley.json");
    let block = &file["forced_response"];
    let drive = damped(block);
    let state = steady(&drive, number(&block["crank_rpm"]));
    let form = StrongForm::new(&drive, &state, Configuration::default()).unwrap();
    let load = HarmonicLoad::driver_rotation(&drive, number(&block["crank_amplitude_rad"]).into());
    let mut worst = 0.0_f64;
    for case in block["cases"].as_array().unwrap() {
        let found = form.respond(TAU * number(&case["frequency_hz"]), &load).unwrap();
        let middles: Vec<Complex> = found
            .spans
            .iter()
            .zip(&state.layout.spans)
            .map(|(motion, geometry)| motion.displacement(0.5 * geometry.length))
            .collect();
        for (key, values) in [
            ("arm", &found.arms),
            ("pulley_rotation", &found.rotations),
            ("dynamic_tension", &found.tensions),
            ("mid_span_displacement", &middles),
        ] {
            let expected: Vec<Complex> = case[key]
                .as_array()
                .unwrap()
                .iter()
                .map(|pair| Complex::new(numbers(pair)[0], numbers(pair)[1]))
                .collect();
            let scale = expected.iter().map(|value| value.norm()).fold(0.0, f64::max);
            for (a, b) in values.iter().zip(&expected) {
                worst = worst.max((a - b).norm() / scale);
            }
        }
    }
    assert!(worst < 1e-12, "{worst:.1e}");
}

#[test]
fn torque_that_holds_the_arm() {
    // The file's numbers agree with finite elements to 6e-8; they have the damping of the forced response.
    let file = reference("drive_three_pulley.json");
    let block = &file["arm_locked_by_friction"];
    let drive = damped(&file["forced_response"]);
    let state = steady(&drive, number(&block["crank_rpm"]));
    let held = Configuration {
        held: vec![0],
        ..Configuration::default()
    };
    let form = StrongForm::new(&drive, &state, held).unwrap();
    let load = HarmonicLoad::driver_rotation(&drive, number(&block["crank_amplitude_rad"]).into());
    for case in block["cases"].as_array().unwrap() {
        let found = form.respond(TAU * number(&case["frequency_hz"]), &load).unwrap();
        let expected = number(&case["critical_friction_torque"]);
        assert_close(
            found.holding_torques[0].norm() / expected,
            1.0,
            1e-7,
            "holding torque",
        );
        assert_eq!(found.arms, vec![Complex::ZERO]);
    }
}
