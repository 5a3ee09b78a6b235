//! Branches followed by harmonic balance: folds and bifurcations against those of shooting.

use serde_json::{Value, json};
use slackside_continuation::{Options, StopReason};
use slackside_dynamics::branch::{Branch, BranchOptions, SpecialKind, follow};
use slackside_dynamics::orbit::harmonic_balance::{Adaptation, HarmonicBalance, Settings, Start, solve};
use slackside_mechanics::{FrequencyFamily, OperatingPoint, OutsideDomain, SystemFamily};
use slackside_testkit::{assert_close, benchmark, nominal, number, reference};
use std::sync::Arc;

fn over_frequency(from: f64, to: f64, settings: Settings) -> Branch {
    let family = FrequencyFamily::new(Arc::new(nominal(&json!({})).system().unwrap()));
    branch(Arc::new(family), from, to, settings)
}

fn branch(family: Arc<dyn SystemFamily>, from: f64, to: f64, settings: Settings) -> Branch {
    let start = solve(&family.at(from).unwrap(), Start::Linear, &settings).unwrap();
    let mut balance = HarmonicBalance::new(family, from, settings).unwrap();
    let z = balance.unknowns(&start.orbit);
    let options = BranchOptions {
        continuation: Options::over(from.min(to), from.max(to)),
        direction: to - from,
    };
    follow(&mut balance, &z, from, &options, &mut |_| true)
}

fn parameters(branch: &Branch, kind: SpecialKind) -> Vec<f64> {
    let of_kind = branch.special.iter().filter(|s| s.kind == kind);
    let mut result: Vec<f64> = of_kind.map(|s| s.point.parameter).collect();
    result.sort_by(f64::total_cmp);
    result
}

fn expected(points: &Value, kind: &str) -> Vec<f64> {
    let of_kind = points.as_array().unwrap().iter().filter(|p| p["type"] == kind);
    let mut result: Vec<f64> = of_kind.map(|p| number(&p["Omega"])).collect();
    result.sort_by(f64::total_cmp);
    result
}

#[test]
fn folds_of_the_second_resonance() {
    let file = reference("clutch_nominal.json");
    let found = over_frequency(8.4, 3.7, Settings::default());
    assert_eq!(found.stop, StopReason::RangeLimit);
    let folds = expected(&file["branches"]["second_resonance"]["special_points"], "fold");
    let located = parameters(&found, SpecialKind::Fold);
    assert_eq!(located.len(), folds.len(), "{located:?}");
    for (a, b) in located.iter().zip(&folds) {
        assert_close(*a, *b, 1e-10, "fold");
    }
    assert!(parameters(&found, SpecialKind::PeriodDoubling).is_empty());
    assert!(parameters(&found, SpecialKind::NeimarkSacker).is_empty());
    // The number of harmonics follows the motion: few where the clutch does not separate, more where it does.
    let harmonics = |point: &slackside_dynamics::branch::BranchPoint| point.unknowns.len() / 2;
    let closed = found.points.iter().filter(|p| p.events == 0).map(harmonics).min();
    let separating = found.points.iter().map(harmonics).max();
    assert!(
        closed <= Some(8) && separating > Some(24),
        "{closed:?} {separating:?}"
    );
    assert!(
        found
            .points
            .iter()
            .all(|p| p.multipliers.len() == 4 && (p.events == 0 || p.events == 2))
    );
}

#[test]
fn bifurcations_above_the_first_resonance() {
    let file = reference("clutch_nominal.json");
    let found = over_frequency(1.2, 1.03, Settings::fixed(120));
    let points = &file["branches"]["first_resonance"]["special_points"];
    for (kind, name) in [
        (SpecialKind::PeriodDoubling, "period_doubling"),
        (SpecialKind::NeimarkSacker, "neimark_sacker"),
    ] {
        let above: Vec<f64> = expected(points, name).into_iter().filter(|&p| p > 1.03).collect();
        let located = parameters(&found, kind);
        assert_eq!(located.len(), above.len(), "{name}: {located:?} {above:?}");
        for (a, b) in located.iter().zip(above) {
            assert_close(*a, b, 1e-7, name);
        }
    }
}

#[test]
fn folds_of_the_shared_benchmark() {
    let file = reference("clutch_benchmark.json");
    let listed = file["caseA_exact"]["folds"].as_array().unwrap();
    let mut folds: Vec<f64> = listed.iter().map(|fold| number(&fold["W"])).collect();
    folds.sort_by(f64::total_cmp);
    let family = FrequencyFamily::new(Arc::new(benchmark(0.05).system().unwrap()));
    let settings = Settings {
        adaptation: Some(Adaptation {
            tail: 1e-5,
            ..Adaptation::default()
        }),
        ..Settings::default()
    };
    let found = branch(Arc::new(family), 8.0, 1.2, settings);
    let located = parameters(&found, SpecialKind::Fold);
    assert_eq!(located.len(), folds.len(), "{located:?}");
    for (a, b) in located.iter().zip(folds) {
        assert_close(*a, b, 1e-8, "fold of the benchmark");
    }
}

/// The nominal system at a fixed frequency under a crankshaft motion of varying amplitude.
struct Amplitude(f64);

impl SystemFamily for Amplitude {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        let system = nominal(&json!({ "Am": parameter })).system();
        Ok(OperatingPoint {
            system: Arc::new(system.map_err(|error| OutsideDomain(error.to_string()))?),
            frequency: self.0,
        })
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

#[test]
fn folds_in_the_excitation_amplitude() {
    let file = reference("clutch_nominal.json");
    let expected = &file["amplitude_folds"];
    let family = Arc::new(Amplitude(number(&expected["Omega"])));
    let found = branch(family, 0.02, 0.1, Settings::fixed(40));
    let mut folds: Vec<f64> = expected["folds"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| number(&f["Am"]))
        .collect();
    folds.sort_by(f64::total_cmp);
    let located = parameters(&found, SpecialKind::Fold);
    assert_eq!(located.len(), 2, "{located:?}");
    for (a, b) in located.iter().zip(folds) {
        assert_close(*a, b, 1e-8, "fold in the amplitude");
    }
}
