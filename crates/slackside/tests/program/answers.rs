//! Documents of all verbs and their numbers. References: `validation/reference/clutch_nominal.json`.

use super::{close, document, example, slackside, special};
use serde_json::Value;
use slackside_testkit::{number, numbers, reference};

fn nominal() -> String {
    example("two_pulley_nominal.toml")
}

fn assert_head(document: &Value, command: &str) {
    assert_eq!(document["slackside"], env!("CARGO_PKG_VERSION"));
    assert_eq!(document["command"], command);
    assert_eq!(document["input"]["sha256"].as_str().unwrap().len(), 64);
    assert!(document["input"]["file"].as_str().unwrap().ends_with(".toml"));
    assert!(document["method"]["name"].is_string());
    assert!(document["units"]["frequency"].is_string());
    assert!(document["warnings"].is_array());
}

#[test]
fn check_tells_rest_modes_and_onset() {
    let found = document(&["check", &nominal()]);
    assert_head(&found, "check");
    let clutch = &found["equilibrium"]["elements"][0];
    close(&clutch["displacement"], 1.0 / 24.0, 1e-15, "static wind-up");
    assert_eq!(clutch["regime"], "engaged");
    close(
        &found["modes"][0]["frequency"],
        0.9796106880251735,
        1e-13,
        "first mode",
    );
    close(
        &found["modes"][1]["frequency"],
        6.374979443096805,
        1e-13,
        "second mode",
    );
    close(&found["critical_preload"], 2.625637136, 1e-9, "critical preload");
    let onset = found["separation"][0]["onset"].as_array().unwrap();
    let expected = numbers(&reference("clutch_nominal.json")["separation_onset"]["Omega"]);
    assert_eq!(onset.len(), expected.len());
    for (found, expected) in onset.iter().zip(expected) {
        close(found, expected, 1e-12, "onset of separation");
    }
}

#[test]
fn modes_follow_any_key() {
    let found = document(&[
        "modes",
        &nominal(),
        "--over",
        "dimensionless.clutch_stiffness=12:36:12",
    ]);
    assert_head(&found, "modes");
    let over = found["over"].as_array().unwrap();
    assert_eq!(over.len(), 3);
    close(&over[1]["dimensionless.clutch_stiffness"], 24.0, 0.0, "value");
    close(
        &over[1]["modes"][1]["frequency"],
        6.374979443096805,
        1e-13,
        "mode at the nominal value",
    );
    let shares = over[1]["modes"][1]["shares"].as_object().unwrap();
    let sum: f64 = shares.values().map(|share| share.as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-12);
}

#[test]
fn simulate_lists_every_event() {
    let found = document(&[
        "simulate",
        &nominal(),
        "--frequency",
        "0.97",
        "--periods",
        "9",
        "--samples",
        "16",
        "--initial",
        "pulley=0,accessory=0.2,pulley.rate=0,accessory.rate=0",
    ]);
    assert_head(&found, "simulate");
    let events = found["events"].as_array().unwrap();
    close(&events[0]["time"], 0.483_493_704_281_484_6, 1e-12, "first event");
    close(&events[1]["time"], 1.073_330_055_268_368_3, 1e-12, "second event");
    assert_eq!(events[0]["element"], "clutch");
    assert_eq!(events[0]["from"], "disengaged");
    assert_eq!(events[0]["to"], "engaged");
    // The pair that a test of signs at the ends of steps misses (theory 02 §3.1).
    let near = |time: f64| {
        let mut times = events.iter().map(|event| event["time"].as_f64().unwrap());
        times.any(|t| (t - time).abs() < 1e-8)
    };
    assert!(near(9.113_838_07) && near(9.126_219_84));
    let time = found["series"]["time"].as_array().unwrap();
    assert_eq!(time.len(), 9 * 16);
    assert_eq!(found["series"]["windup"].as_array().unwrap().len(), time.len());
}

#[test]
fn response_finds_folds_and_every_motion_at_a_value() {
    let found = document(&[
        "response",
        &nominal(),
        "--over",
        "frequency=3.6:8.5",
        "--at",
        "5.5",
    ]);
    assert_head(&found, "response");
    let branches = found["branches"].as_array().unwrap();
    assert_eq!(branches.len(), 1);
    let folds = special(&branches[0], "fold");
    assert_eq!(folds.len(), 2);
    assert!((folds[0] - 4.480823726243).abs() < 1e-11, "{folds:?}");
    assert!((folds[1] - 5.892698667133).abs() < 1e-11, "{folds:?}");
    let point = &branches[0]["points"][0];
    for key in [
        "frequency",
        "stable",
        "multipliers",
        "residual",
        "measures",
        "events",
        "engaged_ratio",
    ] {
        assert!(!point[key].is_null(), "{key} is missing");
    }
    let windup = &point["measures"]["windup"];
    for key in ["mean", "rms", "max", "min", "harmonics"] {
        assert!(!windup[key].is_null(), "{key} is missing");
    }
    assert_eq!(windup["harmonics"].as_array().unwrap().len(), 17);
    let at = found["at"].as_array().unwrap();
    let mut motions: Vec<(f64, bool)> = at
        .iter()
        .map(|orbit| {
            close(&orbit["frequency"], 5.5, 0.0, "value");
            let rms = orbit["measures"]["windup"]["rms"].as_f64().unwrap();
            (rms, orbit["stable"].as_bool().unwrap())
        })
        .collect();
    motions.sort_by(|a, b| a.0.total_cmp(&b.0));
    let expected = [(0.0179100277, true), (0.0497216921, false), (0.0650155787, true)];
    assert_eq!(motions.len(), 3);
    for (motion, expected) in motions.iter().zip(expected) {
        assert!(
            (motion.0 - expected.0).abs() < 1e-10 && motion.1 == expected.1,
            "{motion:?}"
        );
    }
}

#[test]
fn harmonic_balance_agrees_with_shooting() {
    let arguments = [
        "response",
        &nominal(),
        "--over",
        "frequency=4.2:6.2",
        "--at",
        "5.5",
    ];
    let exact = document(&arguments);
    let balance = document(&[&arguments[..], &["--method", "harmonic-balance"]].concat());
    assert_eq!(balance["method"]["name"], "harmonic-balance");
    let (a, b) = (
        special(&exact["branches"][0], "fold"),
        special(&balance["branches"][0], "fold"),
    );
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9), "{a:?} {b:?}");
    for (a, b) in exact["at"]
        .as_array()
        .unwrap()
        .iter()
        .zip(balance["at"].as_array().unwrap())
    {
        close(
            &b["measures"]["windup"]["rms"],
            a["measures"]["windup"]["rms"].as_f64().unwrap(),
            1e-8,
            "rms",
        );
        assert_eq!(a["stable"], b["stable"]);
        assert_eq!(
            a["events"].as_array().unwrap().len(),
            b["events"].as_array().unwrap().len()
        );
    }
}

#[test]
fn physical_units_give_the_same_response_in_hertz() {
    let found = document(&[
        "response",
        &example("two_pulley_physical.toml"),
        "--over",
        "frequency=150:350",
        "--at",
        "200",
    ]);
    assert_eq!(found["units"]["frequency"], "Hz");
    let folds = special(&found["branches"][0], "fold");
    // ω₀ = √(K r²/(J_p + J_a)) (theory 02 (C1)).
    let hertz = (4e4_f64 * 9e-4 / 5.2e-4).sqrt() / std::f64::consts::TAU;
    assert!((folds[0] / hertz - 4.480823726243).abs() < 1e-9, "{folds:?}");
    assert_eq!(found["at"].as_array().unwrap().len(), 3);
}

#[test]
fn a_key_can_vary_at_fixed_frequency() {
    let found = document(&[
        "response",
        &nominal(),
        "--over",
        "dimensionless.preload=0.5:2",
        "--frequency",
        "5.5",
        "--at",
        "1",
    ]);
    let rms: Vec<f64> = found["at"]
        .as_array()
        .unwrap()
        .iter()
        .map(|orbit| orbit["measures"]["windup"]["rms"].as_f64().unwrap())
        .collect();
    for expected in [0.0179100277, 0.0497216921, 0.0650155787] {
        assert!(rms.iter().any(|rms| (rms - expected).abs() < 1e-10), "{rms:?}");
    }
    assert!(found["branches"][0]["points"][0]["dimensionless.preload"].is_number());
}

#[test]
fn period_doublings_start_branches_of_twice_the_period() {
    let found = document(&[
        "response",
        &nominal(),
        "--over",
        "frequency=1.01:1.2",
        "--doublings",
        "1",
        "--at",
        "1.02",
    ]);
    let branches = found["branches"].as_array().unwrap();
    let doubled: Vec<&Value> = branches.iter().filter(|branch| branch["periods"] == 2).collect();
    assert!(!doubled.is_empty());
    // The doubled branch begins at the doubling itself.
    let first = doubled[0]["points"][0]["frequency"].as_f64().unwrap();
    let doublings = special(&branches[0], "period-doubling");
    assert!(
        doublings.iter().any(|p| (p - first).abs() < 1e-9),
        "{first} {doublings:?}"
    );
    let mut found: Vec<(f64, bool)> = found["at"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|orbit| orbit["periods"] == 2)
        .map(|orbit| {
            let max = orbit["measures"]["pulley"]["max"].as_f64().unwrap();
            (max, orbit["stable"].as_bool().unwrap())
        })
        .collect();
    let file = reference("clutch_nominal.json");
    let mut expected: Vec<(f64, bool)> = file["period2"]["orbits"]
        .as_array()
        .unwrap()
        .iter()
        .map(|orbit| {
            (
                number(&orbit["theta_p"]["max"]),
                orbit["stable"].as_bool().unwrap(),
            )
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert!(
            (found.0 - expected.0).abs() < 1e-10 && found.1 == expected.1,
            "{found:?} {expected:?}"
        );
    }
}

#[test]
fn amplitude_folds_at_fixed_frequency() {
    let found = document(&[
        "response",
        &nominal(),
        "--over",
        "dimensionless.crank_amplitude=0.02:0.1",
        "--frequency",
        "5.5",
    ]);
    let special = found["branches"][0]["special"].as_array().unwrap().iter();
    let folds: Vec<f64> = special
        .filter(|point| point["kind"] == "fold")
        .map(|point| point["dimensionless.crank_amplitude"].as_f64().unwrap())
        .collect();
    let file = reference("clutch_nominal.json");
    let expected = file["amplitude_folds"]["folds"].as_array().unwrap();
    assert_eq!(folds.len(), expected.len());
    for expected in expected {
        let expected = number(&expected["Am"]);
        assert!(
            folds.iter().any(|fold| (fold - expected).abs() < 1e-11),
            "{folds:?}"
        );
    }
}

#[test]
fn a_family_has_branches_for_each_value() {
    let found = document(&[
        "response",
        &nominal(),
        "--over",
        "frequency=4:8",
        "--for",
        "dimensionless.crank_amplitude=0.03,0.05",
    ]);
    let branches = found["branches"].as_array().unwrap();
    let values: Vec<f64> = branches
        .iter()
        .map(|branch| branch["for"]["dimensionless.crank_amplitude"].as_f64().unwrap())
        .collect();
    assert_eq!(values, [0.03, 0.05]);
    assert!((special(&branches[1], "fold")[0] - 4.480823726243).abs() < 1e-11);
}

#[test]
fn overrides_change_the_answer_and_the_check_sum() {
    let usual = document(&["check", &nominal()]);
    let changed = document(&["check", &nominal(), "--set", "dimensionless.preload=2"]);
    close(
        &changed["equilibrium"]["elements"][0]["force"],
        2.0,
        1e-14,
        "force at rest",
    );
    assert_ne!(usual["input"]["sha256"], changed["input"]["sha256"]);
    assert_eq!(changed["input"]["settings"][0], "dimensionless.preload=2");
}

#[test]
fn sweeps_settle_on_the_branches() {
    let nominal = nominal();
    let sweep = document(&["sweep", &nominal, "--over", "frequency=5.4:5.6:0.1"]);
    assert_head(&sweep, "sweep");
    close(
        &sweep["up"][1]["measures"]["windup"]["rms"],
        0.0179100277,
        1e-10,
        "settled motion",
    );
    assert_eq!(sweep["up"][1]["kind"], "periodic-1");
    let basin = document(&[
        "basin",
        &nominal,
        "--frequency",
        "5.5",
        "--over",
        "pulley=-0.1:0.1:0.05",
        "--over",
        "accessory=-0.1:0.1:0.05",
    ]);
    assert_head(&basin, "basin");
    assert_eq!(basin["cells"].as_array().unwrap().len(), 5);
    assert!(!basin["attractors"].as_array().unwrap().is_empty());
}

#[test]
fn smooth_and_other_systems_are_answered_too() {
    let duffing = document(&[
        "response",
        &example("duffing.toml"),
        "--over",
        "frequency=0.8:2.2",
    ]);
    assert_eq!(special(&duffing["branches"][0], "fold").len(), 2);
    let backlash = document(&["simulate", &example("backlash_oscillator.toml"), "--periods", "5"]);
    assert!(!backlash["events"].as_array().unwrap().is_empty());
    let matrices = document(&[
        "response",
        &example("two_pulley_as_matrices.toml"),
        "--over",
        "frequency=4:8",
    ]);
    assert!((special(&matrices["branches"][0], "fold")[0] - 4.480823726243).abs() < 1e-10);
}

#[test]
fn the_schema_names_all_kinds() {
    let output = slackside(&["schema"]);
    let schema: Value = serde_json::from_slice(&output.stdout).unwrap();
    let text = schema.to_string();
    assert!(text.contains("two-pulley-clutch") && text.contains("mechanical-system"));
}
