//! Folds and period doublings of the smoothed benchmark clutch against AUTO and harmonic balance.

use slackside_continuation::Options;
use slackside_dynamics::branch::{Branch, BranchOptions, SpecialKind, follow};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_mechanics::FrequencyFamily;
use slackside_mechanics::laws::Smoothing;
use slackside_testkit::{assert_close, benchmark, numbers, reference};
use std::sync::Arc;

/// The branch of period one of case A with the tanh law, from the frequency `from` down to `to`.
fn branch(width: f64, from: f64, to: f64) -> Branch {
    let mut model = benchmark(0.05);
    model.smoothing = Some((Smoothing::Tanh, width));
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

/// All of one kind within the range are found, in any order, and no others.
fn check(branch: &Branch, kind: SpecialKind, expected: &[f64], tolerance: f64) {
    let mut found = branch.special_parameters(kind);
    let mut expected = expected.to_vec();
    found.sort_by(f64::total_cmp);
    expected.sort_by(f64::total_cmp);
    assert_eq!(found.len(), expected.len(), "{kind:?}: {found:?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert_close(*found, *expected, tolerance, kind.name());
    }
}

#[test]
fn folds_of_the_upper_resonance() {
    let file = reference("clutch_benchmark.json");
    for (width, key, tolerance) in [(0.01, "eps=0.01", 1e-7), (0.001, "eps=0.001", 2e-6)] {
        let mut expected = numbers(&file["caseA_smoothed"][key]["LP"]);
        expected.retain(|&frequency| frequency > 4.0);
        let found = branch(width, 5.8, 4.6);
        check(&found, SpecialKind::Fold, &expected, tolerance);
        check(&found, SpecialKind::PeriodDoubling, &[], 0.0);
    }
}

#[test]
#[ignore = "about a thousand motions, 6 s"]
fn wide_smoothing_makes_a_pair_of_folds_and_period_doublings_of_its_own() {
    let file = reference("clutch_benchmark.json");
    let expected = &file["caseA_smoothed"]["eps=0.01"];
    let found = branch(0.01, 6.5, 1.2);
    check(&found, SpecialKind::Fold, &numbers(&expected["LP"]), 1e-7);
    check(
        &found,
        SpecialKind::PeriodDoubling,
        &numbers(&expected["PD"]),
        1e-5,
    );
}

#[test]
#[ignore = "about a thousand motions, 6 s"]
fn narrow_smoothing_has_the_folds_of_the_exact_law() {
    let file = reference("clutch_benchmark.json");
    let expected = &file["caseA_smoothed"]["eps=0.001"];
    let found = branch(0.001, 6.5, 1.2);
    check(&found, SpecialKind::Fold, &numbers(&expected["LP"]), 2e-6);
    check(&found, SpecialKind::PeriodDoubling, &[], 0.0);
}
