//! The verbs on drives: documents, numbers, files, messages. Reference: `validation/reference/drive_three_pulley.json`.

use super::{close, document, example, failure, slackside};
use serde_json::Value;
use slackside_testkit::{number, numbers, reference};

fn prototype() -> String {
    example("drives/three-pulley.toml")
}

/// The reference's case with EI = 0.015 N·m² at 2000 rpm, that of the example.
fn case() -> Value {
    let file = reference("drive_three_pulley.json");
    let mut cases = file["cases"].as_array().unwrap().iter();
    cases
        .find(|case| number(&case["EI"]) == 0.015 && number(&case["crank_rpm"]) == 2000.0)
        .cloned()
        .unwrap()
}

#[test]
fn check_gives_the_steady_sheet() {
    let found = document(&["check", &prototype(), "--cross-check"]);
    let expected = case();
    let steady = &expected["steady"];
    for (i, span) in steady["spans"].as_array().unwrap().iter().enumerate() {
        close(
            &found["spans"][i]["length"],
            number(&span["length"]),
            1e-13,
            "length",
        );
        close(
            &found["spans"][i]["tension"],
            number(&span["tension"]),
            1e-9,
            "tension",
        );
    }
    for (j, pulley) in steady["pulleys"].as_array().unwrap().iter().enumerate() {
        let row = &found["pulleys"][j];
        close(&row["wrap"], number(&pulley["wrap"]), 1e-12, "wrap");
        for axis in 0..2 {
            let force = numbers(&pulley["belt_force"])[axis];
            close(&row["hub_load"][axis], force, 1e-9, "hub load");
        }
    }
    let arm = numbers(&steady["arm_coordinate"])[0];
    close(&found["tensioners"][0]["angle"], arm, 1e-12, "arm");
    close(
        &found["driver_torque"],
        number(&steady["driver_torque"]),
        1e-10,
        "torque",
    );
    let file = reference("drive_three_pulley.json");
    let exact = &file["elastica_steady_state"]["span_force_plus_mc2"];
    for (i, tension) in numbers(exact).into_iter().enumerate() {
        close(
            &found["cross_check"]["tensions"][i],
            tension,
            1e-6,
            "exact tension",
        );
    }
    assert_eq!(found["units"]["measures"]["tension"], "N");
}

#[test]
fn modes_agree_with_the_reference_and_the_strong_form() {
    let found = document(&[
        "modes",
        &prototype(),
        "--cross-check",
        "--over",
        "speed=0:4000:500",
    ]);
    let expected = case();
    let frequencies = &expected["frequencies_crank_prescribed"];
    let series = numbers(&frequencies["galerkin_10_residual_hz"]);
    let exact = numbers(&frequencies["exact_hz"]);
    for (k, (series, exact)) in series.iter().zip(&exact).enumerate() {
        let mode = &found["modes"][k];
        close(&mode["frequency_hz"], *series, 1e-8, "frequency");
        close(&mode["strong_form_hz"], *exact, 1e-8, "strong form");
    }
    let over = found["over"].as_array().unwrap();
    assert_eq!(over.len(), 9);
    assert_eq!(over[4]["value"], 2000.0);
    close(&over[4]["frequencies_hz"][0], series[0], 1e-8, "Campbell diagram");
    // The excitation of the example has order 2: its line meets the first span mode at its frequency.
    let first = &found["resonances"][0];
    assert_eq!(first["order"], 2.0);
    let speed = first["speed"].as_f64().unwrap();
    close(&first["frequency_hz"], 2.0 * speed / 60.0, 1e-9, "on the line");
}

#[test]
fn matrices_agree_with_the_reference() {
    let found = document(&[
        "modes",
        &prototype(),
        "--matrices",
        "--set",
        "belt.modes_per_span=3",
        "--set",
        "belt.static_correction=false",
    ]);
    let file = reference("drive_three_pulley.json");
    for (ours, theirs) in [
        ("mass", "M"),
        ("gyroscopic", "G"),
        ("stiffness", "K"),
        ("stretch", "stretch_rows"),
    ] {
        let expected = file["matrices"][theirs].as_array().unwrap();
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in numbers(row).into_iter().enumerate() {
                let tolerance = 1e-11 * value.abs().max(1e-3);
                close(&found["matrices"][ours][i][j], value, tolerance, ours);
            }
        }
    }
}

#[test]
fn response_at_a_fixed_speed_agrees_with_the_reference() {
    let file = reference("drive_three_pulley.json");
    let forced = &file["forced_response"];
    // The reference's damping and amplitude (theory 04 §7), with sixty sine terms.
    let found = document(&[
        "response",
        &prototype(),
        "--over",
        "frequency=33:66:33",
        "--set",
        "excitation.motion.0.amplitude=0.01",
        "--set",
        "belt.damping={ span_dashpot = 20.0 }",
        "--set",
        "belt.modes_per_span=60",
        "--set",
        "tensioner.tensioner.damping=0.05",
        "--set",
        "pulley.tensioner pulley.bearing_damping=1e-4",
        "--set",
        "pulley.accessory.bearing_damping=1e-4",
    ]);
    let points = found["points"].as_array().unwrap();
    for (point, case) in points.iter().zip(forced["cases"].as_array().unwrap()) {
        let expected = numbers(&case["dynamic_tension"][2]);
        let tension = &point["measures"]["tension.accessory-crank"];
        let size = expected[0].hypot(expected[1]);
        for part in 0..2 {
            close(
                &tension["orders"][0][part],
                expected[part],
                5e-5 * size,
                "tension",
            );
        }
        close(
            &tension["rms"],
            size / 2f64.sqrt(),
            5e-5 * size,
            "root mean square",
        );
    }
}

#[test]
fn results_hold_tables_and_figures() {
    let folder = tempfile::tempdir().unwrap();
    let drive = example("drives/six-pulley.toml");
    for (verb, over, files) in [
        (
            "check",
            "speed=600:6000:600",
            &[
                "layout.png",
                "tensions.svg",
                "hub_loads.svg",
                "arm_1.svg",
                "over.csv",
                "spans.parquet",
            ][..],
        ),
        (
            "modes",
            "speed=0:6000:600",
            &[
                "mode_shapes_1.png",
                "campbell.svg",
                "campbell.csv",
                "modes.parquet",
            ],
        ),
        (
            "response",
            "speed=600:6000:600",
            &["tensions.svg", "hub_loads.png", "arms.svg", "response.csv"],
        ),
    ] {
        let out = folder.path().join(verb);
        let text = out.display().to_string();
        let output = slackside(&[verb, &drive, "--over", over, "--out", &text]);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{errors}");
        for file in files.iter().chain(&["result.json"]) {
            let size = std::fs::metadata(out.join(file)).map_or(0, |found| found.len());
            assert!(size > 100, "{verb}: {file}");
        }
    }
}

#[test]
fn impossible_drives_and_wrong_options_are_told() {
    let drive = prototype();
    let stops = "tensioner.tensioner.stops=[\"-4 deg\", \"10 deg\"]";
    for (arguments, status, parts) in [
        (
            vec!["check", &drive, "--set", stops],
            1,
            vec!["beyond its stop at -4.00°", "tensioner"],
        ),
        (
            vec![
                "check",
                &drive,
                "--set",
                "pulley.accessory.center=[\"0.5 m\", \"0 m\"]",
            ],
            2,
            vec!["\"crank\"", "\"accessory\"", "overlap"],
        ),
        (
            vec![
                "check",
                &drive,
                "--set",
                "belt.installation={ tension = \"30 N\" }",
                "--set",
                "belt.model=string",
                "--set",
                "tensioner.tensioner.locked=true",
                "--speed",
                "6000",
            ],
            1,
            vec!["no effective tension", "6000 rpm"],
        ),
        (
            vec!["check", &drive, "--over", "frequency=1:2"],
            2,
            vec!["--over", "speed"],
        ),
        (
            vec!["check", &drive, "--frequency", "3"],
            2,
            vec!["--frequency", "leave it out"],
        ),
        (
            vec![
                "response",
                &drive,
                "--over",
                "speed=600:700:50",
                "--measure",
                "tension.x",
            ],
            2,
            vec!["tension.x", "tension.accessory-crank"],
        ),
        (
            vec!["modes", &drive, "--speed", "-5"],
            2,
            vec!["--speed", "negative"],
        ),
        (vec!["simulate", &drive, "--speed", "900"], 2, vec!["--speed"]),
    ] {
        let (found, message) = failure(&arguments);
        assert_eq!(found, status, "{arguments:?}: {message}");
        for part in parts {
            assert!(message.contains(part), "{arguments:?}: {message}");
        }
    }
    let clutch = example("two_pulley_nominal.toml");
    let (status, message) = failure(&["check", &clutch, "--over", "speed=1:2"]);
    assert_eq!(status, 2);
    assert!(message.contains("drive"), "{message}");
}
