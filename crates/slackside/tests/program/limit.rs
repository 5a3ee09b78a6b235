//! `limit` against the nonsmooth reference (theory 05 §12), from a model file per case.

use super::{close, document, example, failure};
use serde_json::{Value, json};
use slackside_testkit::nonsmooth_file::model_file;
use slackside_testkit::nonsmooth_reference::nonsmooth_reference;
use slackside_testkit::number;
use std::path::PathBuf;
use tempfile::TempDir;

/// A model file with this text.
fn written(folder: &TempDir, name: &str, text: &str) -> String {
    let path: PathBuf = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// The document at one frequency and a neighbour, for an entry's input with further keys.
fn limit(folder: &TempDir, file: &Value, kind: &str, input: &Value, more: Value) -> Value {
    let mut input = input.clone();
    for (key, value) in more.as_object().unwrap() {
        input[key] = value.clone();
    }
    let path = written(folder, "case.toml", &model_file(file, &input));
    let frequency = number(&input["W"]);
    let over = format!("frequency={}:{}:1", frequency, frequency + 1.0);
    document(&["limit", kind, &path, "--over", &over])
}

#[test]
fn critical_loads_agree_with_the_reference() {
    let folder = TempDir::new().unwrap();
    let file = nonsmooth_reference();
    for entry in file["critical_load"].as_array().unwrap() {
        let expected = number(&entry["M_crit"]);
        // Where the tension follows the load, the critical load is the one that is critical at itself.
        let more = json!({ "system": "clutch", "Ml": expected });
        let found = limit(&folder, &file, "critical-load", &entry["input"], more);
        assert_eq!(found["element"], "clutch");
        let point = &found["points"][0];
        close(&point["value"], expected, 1e-11 * expected, "critical load");
        close(&point["present"], expected, 1e-11 * expected, "load of the file");
        close(&point["minimum"], -expected, 1e-11 * expected, "smallest torque");
    }
}

#[test]
fn critical_torques_agree_with_the_reference() {
    let folder = TempDir::new().unwrap();
    let file = nonsmooth_reference();
    for entry in file["critical_torque"].as_array().unwrap() {
        let expected = number(&entry["Q_cr"]);
        for (share, locked) in [(0.99, false), (1.01, true)] {
            let more = json!({ "system": "friction", "Q": share * expected });
            let found = limit(&folder, &file, "critical-torque", &entry["input"], more);
            assert_eq!(found["element"], "arm_friction");
            let point = &found["points"][0];
            let size = 1e-11 * expected;
            close(&point["value"], expected, size, "critical torque");
            close(&point["minimum"], number(&entry["tau_min"]), size, "τ min");
            close(&point["maximum"], number(&entry["tau_max"]), size, "τ max");
            close(
                &point["stiffness"],
                number(&entry["k_eff"]),
                1e-9,
                "static stiffness",
            );
            close(&point["offset"], number(&entry["arm_offset"]), 1e-12, "offset");
            close(&point["present"], share * expected, size, "friction of the file");
            assert_eq!(point["locked"], locked);
        }
    }
}

/// A pulley on a belt with an accessory on a one-way clutch.
const CLUTCH: &str = r#"
kind = "mechanical-system"
coordinates = ["pulley", "accessory"]
mass      = [[1.0, 0.0], [0.0, 1.6]]
damping   = [[0.1, 0.0], [0.0, 0.02]]
stiffness = [[2.6, 0.0], [0.0, 0.0]]

[[element]]
name = "clutch"
port = { pulley = 1.0, accessory = -1.0 }
law  = { kind = "one-way" }

[excitation]
frequency = 0.9
constant  = { pulley = 0.3, accessory = -0.3 }
harmonics = [{ order = 1, cos = { pulley = 0.26 } }]
"#;

#[test]
fn transitions_are_where_the_load_is_critical_and_resonances_where_the_locked_system_has_them() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "clutch.toml", CLUTCH);
    let found = document(&["limit", "critical-load", &path, "--over", "frequency=0.2:3"]);
    // Locked: (M s² + c s + k) of 2.6, 0.12, 2.6 shakes the accessory with −Ω² 1.6 + iΩ 0.02.
    let critical = |w: f64| {
        let (re, im) = (2.6 - 2.6 * w * w, 0.12 * w);
        0.26 * (1.6 * w * w).hypot(0.02 * w) / re.hypot(im)
    };
    let points = found["points"].as_array().unwrap();
    assert_eq!(points.len(), 401);
    for point in points {
        let w = point["frequency"].as_f64().unwrap();
        close(&point["value"], critical(w), 1e-12 * critical(w), "critical load");
        assert_eq!(point["locked"], critical(w) <= 0.3);
    }
    let transitions = found["transitions"].as_array().unwrap();
    assert_eq!(transitions.len(), 2);
    for (transition, above) in transitions.iter().zip([false, true]) {
        let w = transition["frequency"].as_f64().unwrap();
        assert!((critical(w) - 0.3).abs() < 1e-12, "{w}");
        assert_eq!(transition["locked_above"], above);
    }
    let resonance = &found["resonances"][0];
    let expected = (1.0 - (0.06_f64 / 2.6).powi(2)).sqrt();
    close(
        &resonance["frequency"],
        expected,
        1e-9,
        "damped natural frequency",
    );
    assert_eq!((&resonance["order"], &resonance["mode"]), (&json!(1), &json!(1)));
}

#[test]
fn any_key_can_be_varied() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "clutch.toml", CLUTCH);
    let found = document(&[
        "limit",
        "critical-load",
        &path,
        "--over",
        "excitation.constant.accessory=-2:-0.1",
        "--set",
        "excitation.constant.pulley=0",
    ]);
    // The accessory alone carries the load: the clutch transmits as much in the mean.
    let transition = &found["transitions"][0];
    let load = found["points"][0]["value"].as_f64().unwrap();
    close(
        &transition["excitation.constant.accessory"],
        -load,
        1e-12,
        "critical load of the accessory",
    );
    assert_eq!(transition["locked_above"], false);
}

#[test]
fn elements_beside_the_one_asked_about_are_told() {
    let folder = TempDir::new().unwrap();
    let file = nonsmooth_reference();
    let input = json!({ "W": 300.0 });
    let more = json!({ "system": "clutch", "Ml": 3.0, "Q": 1.0 });
    let found = limit(&folder, &file, "critical-torque", &input, more);
    assert_eq!(found["held"], json!(["clutch"]));
    let warnings = found["warnings"].as_array().unwrap();
    assert!(
        warnings.iter().any(|warning| warning
            .as_str()
            .unwrap()
            .contains("\"clutch\" is taken as held at rest, but")),
        "{warnings:?}"
    );
    let entry = &file["critical_torque"][3];
    assert_eq!(entry["input"], input);
    let expected = number(&entry["Q_cr"]);
    close(
        &found["points"][0]["value"],
        expected,
        1e-10 * expected,
        "with the clutch held",
    );
}

#[test]
fn a_drive_answers_over_speed() {
    let drive = example("drives/overrunning-alternator.toml");
    let found = document(&["limit", "critical-load", &drive, "--over", "speed=1000:3000:500"]);
    let points = found["points"].as_array().unwrap();
    assert_eq!(points.len(), 5);
    assert_eq!(points[2]["speed"], 2000.0);
    assert!(points.iter().all(|point| point["value"].as_f64().unwrap() > 0.0));
    assert!(
        points
            .iter()
            .all(|point| point["present"].as_f64().unwrap() > 0.0)
    );
}

#[test]
fn tables_and_figure_are_saved() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "clutch.toml", CLUTCH);
    let out = folder.path().join("out");
    let arguments = [
        "limit",
        "critical-load",
        &path,
        "--over",
        "frequency=0.2:3",
        "--out",
        &out.display().to_string(),
    ];
    assert!(super::slackside(&arguments).status.success());
    let table = std::fs::read_to_string(out.join("limit.csv")).unwrap();
    assert!(table.starts_with("frequency"), "{table}");
    assert_eq!(table.lines().count(), 402);
    for file in [
        "limit.parquet",
        "limit.svg",
        "limit.png",
        "transitions.csv",
        "resonances.csv",
        "result.json",
    ] {
        assert!(out.join(file).exists(), "{file}");
    }
    let figure = std::fs::read_to_string(out.join("limit.svg")).unwrap();
    assert!(figure.contains("resonance of the locked system"));
}

#[test]
fn wrong_questions_are_told_what_to_do() {
    let folder = TempDir::new().unwrap();
    let clutch = written(&folder, "clutch.toml", CLUTCH);
    let still = written(
        &folder,
        "still.toml",
        &CLUTCH.replace("harmonics = [{ order = 1, cos = { pulley = 0.26 } }]", ""),
    );
    let spring = example("two_pulley_as_matrices.toml");
    let over = ["--over", "frequency=1:2:0.5"];
    let cases: [(&str, &str, &[&str], &[&str]); 6] = [
        ("critical-torque", &clutch, &[], &["no dry friction"]),
        ("critical-load", &spring, &[], &["no one-way clutch"]),
        (
            "critical-load",
            &clutch,
            &["--element", "clutsh"],
            &["--element", "\"clutch\""],
        ),
        (
            "critical-torque",
            &clutch,
            &["--element", "clutch"],
            &["--element", "is no dry friction"],
        ),
        ("critical-load", &still, &[], &["no harmonics"]),
        (
            "critical-load",
            &clutch,
            &["--speed", "900"],
            &["--speed", "drive"],
        ),
    ];
    for (kind, path, more, expected) in cases {
        let mut arguments = vec!["limit", kind, path];
        arguments.extend(over);
        arguments.extend(more);
        let (status, message) = failure(&arguments);
        assert_eq!(status, 2, "{arguments:?}: {message}");
        for part in expected {
            assert!(message.contains(part), "{arguments:?}: {message}");
        }
    }
}
