//! Branches of the nominal clutch and of its variations against the reference special points.

use serde_json::{Value, json};
use slackside_continuation::Options;
use slackside_dynamics::branch::{Branch, BranchOptions, SpecialKind, follow};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_mechanics::FrequencyFamily;
use slackside_testkit::{nominal, number, reference};
use std::sync::Arc;

/// Follows the branch of period one from the non-separating response at `from` down to `to`.
fn branch(changed: &Value, from: f64, to: f64) -> Branch {
    let model = nominal(changed);
    let family = Arc::new(FrequencyFamily::new(Arc::new(model.system().unwrap())));
    let mut shooting = Shooting::new(family, from, 1).unwrap();
    let rest = [0.0, -model.static_windup(), 0.0, 0.0];
    let start = shooting.solve(&rest, from).unwrap().start;
    let options = BranchOptions {
        continuation: Options::over(to, from),
        direction: -1.0,
    };
    follow(&mut shooting, &start, from, &options, &mut |_| true)
}

fn name(kind: SpecialKind) -> Option<&'static str> {
    match kind {
        SpecialKind::Fold => Some("fold"),
        SpecialKind::PeriodDoubling => Some("period_doubling"),
        SpecialKind::NeimarkSacker => Some("neimark_sacker"),
        _ => None,
    }
}

/// All reference points are found, in any order, and no others.
fn check(branch: &Branch, expected: &Value, tolerance: f64, label: &str) {
    let faults = faults(branch, expected, tolerance);
    assert!(faults.is_none(), "{label}: {faults:?}");
}

fn faults(branch: &Branch, expected: &Value, tolerance: f64) -> Option<String> {
    let mut found: Vec<(&str, f64)> = branch
        .special
        .iter()
        .filter_map(|s| Some((name(s.kind)?, s.point.parameter)))
        .collect();
    let mut expected: Vec<(&str, f64)> = expected
        .as_array()
        .unwrap()
        .iter()
        .filter(|s| s["type"] != "neutral_saddle")
        .map(|s| (s["type"].as_str().unwrap(), number(&s["Omega"])))
        .collect();
    let order = |a: &(&str, f64), b: &(&str, f64)| a.0.cmp(b.0).then(a.1.total_cmp(&b.1));
    found.sort_by(order);
    expected.sort_by(order);
    let missing: Vec<_> = expected
        .iter()
        .filter(|e| !found.iter().any(|f| f.0 == e.0 && (f.1 - e.1).abs() <= tolerance))
        .collect();
    let extra: Vec<_> = found
        .iter()
        .filter(|f| {
            !expected
                .iter()
                .any(|e| f.0 == e.0 && (f.1 - e.1).abs() <= tolerance)
        })
        .collect();
    let sound = missing.is_empty() && extra.is_empty();
    let found = (branch.points.len(), &branch.stop);
    (!sound).then(|| format!("missing {missing:?}, extra {extra:?}, points and end {found:?}"))
}

#[test]
fn nominal_second_resonance() {
    let file = reference("clutch_nominal.json");
    let found = branch(&json!({}), 8.5, 3.6);
    check(
        &found,
        &file["branches"]["second_resonance"]["special_points"],
        1e-11,
        "second resonance",
    );
}

#[test]
fn nominal_first_resonance() {
    let file = reference("clutch_nominal.json");
    let found = branch(&json!({}), 1.5, 0.55);
    check(
        &found,
        &file["branches"]["first_resonance"]["special_points"],
        1e-11,
        "first resonance",
    );
}

#[test]
fn variations_of_the_nominal_parameters() {
    let file = reference("clutch_nominal.json");
    let mut wrong = Vec::new();
    for variation in file["variations"].as_array().unwrap() {
        let changed = &variation["changed"];
        let omega = variation["omega"].as_array().unwrap();
        let (w1, w2) = (number(&omega[0]), number(&omega[1]));
        let resonances = [("second", 1.35 * w2, 1.9 * w1), ("first", 1.5 * w1, 0.0)];
        for (name, from, lowest) in resonances {
            let reference = &variation[name];
            let found = branch(changed, from, number(&reference["reached"]).max(lowest));
            if let Some(faults) = faults(&found, &reference["special_points"], 1e-10) {
                wrong.push(format!("{changed} {name}: {faults}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
