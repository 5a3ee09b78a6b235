//! Branches over the crank amplitude and over the preload at a fixed frequency (theory 02 §1.10, §12).

use crate::common::{WINDUP, distance, record};
use serde_json::json;
use slackside_continuation::{Options, StopReason};
use slackside_dynamics::branch::{Branch, BranchOptions, SpecialKind, follow};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_mechanics::{OperatingPoint, OutsideDomain, SystemFamily};
use slackside_testkit::{assert_close, nominal, number, numbers, reference};
use std::sync::Arc;

const FREQUENCY: f64 = 5.5;

/// The nominal system with one parameter varied.
struct Over(&'static str);

impl SystemFamily for Over {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        let system = nominal(&json!({ self.0: parameter })).system();
        Ok(OperatingPoint {
            system: Arc::new(system.map_err(|error| OutsideDomain(error.to_string()))?),
            frequency: FREQUENCY,
        })
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

fn branch(key: &'static str, from: f64, to: f64, preload: f64) -> Branch {
    let family = Arc::new(Over(key));
    let mut shooting = Shooting::new(family, from, 1).unwrap();
    shooting.set_parameter_scale(0.05);
    let start = shooting
        .solve(&[0.0, -preload / 24.0, 0.0, 0.0], from)
        .unwrap()
        .start;
    let options = BranchOptions {
        continuation: Options::over(from.min(to), from.max(to)),
        direction: to - from,
    };
    follow(&mut shooting, &start, from, &options, &mut |_| true)
}

#[test]
fn folds_over_the_crank_amplitude() {
    let file = reference("clutch_nominal.json");
    let found = branch("Am", 0.01, 0.12, 1.0);
    assert_eq!(found.stop, StopReason::RangeLimit);
    let folds: Vec<_> = found
        .special
        .iter()
        .filter(|s| s.kind == SpecialKind::Fold)
        .collect();
    let expected = file["amplitude_folds"]["folds"].as_array().unwrap();
    assert_eq!(folds.len(), expected.len());
    for (fold, expected) in folds.iter().zip(expected) {
        let amplitude = number(&expected["Am"]);
        let label = format!("fold at A_m = {amplitude}");
        assert_close(fold.point.parameter, amplitude, 1e-13, &label);
        let error = distance(&fold.point.unknowns, &numbers(&expected["x0"]));
        assert!(error < 2e-13, "{label}: state is off by {error:.1e}");
        let system = Over("Am").at(fold.point.parameter).unwrap().system;
        let motion = record(&system, FREQUENCY, &fold.point.unknowns, 1, 0, 0);
        let rms = number(&expected["delta_rms_ac"]);
        assert_close(motion.measures[WINDUP].rms, rms, 1e-13, &label);
        assert!((fold.point.multipliers[0].norm() - 1.0).abs() < 1e-6, "{label}");
    }
    assert_eq!(
        found
            .special
            .iter()
            .filter(|s| s.kind == SpecialKind::PeriodDoubling)
            .count(),
        0
    );
}

#[test]
fn folds_over_the_preload_are_those_over_the_amplitude() {
    // Homogeneity: only A_m / M matters, so a fold at A_m = a for M = 1 is one at M = 0.05 / a for A_m = 0.05.
    let file = reference("clutch_nominal.json");
    let found = branch("M", 3.0, 0.45, 3.0).special_parameters(SpecialKind::Fold);
    let expected: Vec<f64> = file["amplitude_folds"]["folds"]
        .as_array()
        .unwrap()
        .iter()
        .map(|fold| 0.05 / number(&fold["Am_over_M"]))
        .collect();
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(&expected) {
        assert_close(*a, *b, 3e-12, "fold over the preload");
    }
}

#[test]
fn derivative_with_respect_to_the_amplitude_agrees_with_differences_and_with_homogeneity() {
    let amplitude = 0.05;
    let mut shooting = Shooting::new(Arc::new(Over("Am")), amplitude, 1).unwrap();
    let x = [0.02, -0.03, 0.2, -0.1];
    let (end, map, by_amplitude) = shooting.map(&x, amplitude).unwrap();
    let mut over_preload = Shooting::new(Arc::new(Over("M")), 1.0, 1).unwrap();
    let by_preload = over_preload.map(&x, 1.0).unwrap().2;
    let h = 1e-4 * amplitude;
    let ahead = shooting.map(&x, amplitude + h).unwrap().0;
    let behind = shooting.map(&x, amplitude - h).unwrap().0;
    let moved = map.times(&x);
    for i in 0..4 {
        assert_close(
            by_amplitude[i],
            (ahead[i] - behind[i]) / (2.0 * h),
            3e-8,
            "∂x/∂A_m",
        );
        // Euler's theorem for a map that is homogeneous in (x, M, A_m).
        let euler = moved[i] + by_preload[i] + amplitude * by_amplitude[i];
        assert_close(euler, end[i], 1e-12, "homogeneity");
    }
}
