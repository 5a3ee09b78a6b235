//! The shared benchmark problem (`clutch_benchmark.json`): 30-digit and independent double-precision results.

use crate::common::{WINDUP, distance, maximize, point, record, shooting};
use slackside_continuation::{Options, StopReason};
use slackside_dynamics::branch::{Branch, BranchOptions, SpecialKind, follow};
use slackside_dynamics::flow::{Request, open};
use slackside_mechanics::System;
use slackside_testkit::{
    assert_close, benchmark, number, numbers, reference, sweep_of_independent_integrator,
};
use std::sync::Arc;

const RANGE: (f64, f64) = (0.3, 8.0);

fn system(amplitude: f64) -> Arc<System> {
    Arc::new(benchmark(amplitude).system().unwrap())
}

/// The branch over the whole range, from low frequencies up.
fn curve(system: &Arc<System>) -> Branch {
    let mut shooting = shooting(system, RANGE.0, 1);
    let start = shooting.solve(&[0.0, -0.1, 0.0, 0.0], RANGE.0).unwrap().start;
    let options = BranchOptions {
        continuation: Options::over(RANGE.0, RANGE.1),
        direction: 1.0,
    };
    let branch = follow(&mut shooting, &start, RANGE.0, &options, &mut |_| true);
    assert_eq!(branch.stop, StopReason::RangeLimit);
    branch
}

#[test]
fn problem_matrices() {
    let file = reference("clutch_benchmark.json");
    let system = system(0.05);
    for (mode, omega) in slackside_mechanics::modes(&system, 1.0, true)
        .unwrap()
        .iter()
        .zip(numbers(&file["problem"]["omega"]))
    {
        assert_close(mode.frequency, omega, 1e-14, "natural frequency");
    }
    for i in 0..2 {
        for (j, expected) in numbers(&file["problem"]["C"][i]).into_iter().enumerate() {
            assert_close(system.damping[(i, j)], expected, 1e-15, "damping matrix");
        }
    }
}

#[test]
fn case_a_folds_with_their_motions_and_the_peaks_between() {
    let file = reference("clutch_benchmark.json");
    let system = system(0.05);
    let branch = curve(&system);
    let folds: Vec<_> = branch
        .special
        .iter()
        .filter(|s| s.kind == SpecialKind::Fold)
        .collect();
    let expected = file["caseA_exact"]["folds"].as_array().unwrap();
    assert_eq!(folds.len(), expected.len());
    for expected in expected {
        let frequency = number(&expected["W"]);
        let label = format!("fold at {frequency}");
        let fold = folds
            .iter()
            .min_by(|a, b| {
                let off =
                    |s: &&&slackside_dynamics::branch::SpecialPoint| (s.point.parameter - frequency).abs();
                off(a).total_cmp(&off(b))
            })
            .unwrap();
        assert_close(fold.point.parameter, frequency, 1e-14, &label);
        let motion = record(&system, fold.point.parameter, &fold.point.unknowns, 1, 0, 0);
        let windup = &motion.measures[WINDUP];
        assert_close(windup.rms, number(&expected["rms"]), 1e-14, &label);
        assert_close(windup.mean, number(&expected["mean"]), 1e-14, &label);
        let share = number(&expected["disengaged_fraction"]);
        assert_close(motion.fractions[0][0], share, 6e-9, &label);
    }
    for kind in [
        SpecialKind::PeriodDoubling,
        SpecialKind::NeimarkSacker,
        SpecialKind::BranchPoint,
    ] {
        assert!(branch.special_parameters(kind).is_empty(), "{kind:?}");
    }
    // Between the folds of a pair motions are unstable, elsewhere stable.
    let turns: Vec<f64> = folds.iter().map(|fold| fold.point.arclength).collect();
    for point in &branch.points {
        let passed = turns.iter().filter(|&&turn| turn < point.arclength).count();
        let near = turns.iter().any(|turn| (turn - point.arclength).abs() < 1e-6);
        assert!(
            near || point.is_stable() == (passed % 2 == 0),
            "at {}",
            point.parameter
        );
    }

    let mut shooting = shooting(&system, 1.0, 1);
    let outputs = [system.outputs[WINDUP].clone()];
    let mut rms = |state: &[f64], frequency: f64| {
        let record = shooting.summarize(state, frequency, &outputs, &Request::default());
        record.unwrap().measures[0].rms
    };
    let along: Vec<f64> = branch
        .points
        .iter()
        .map(|p| rms(&p.unknowns, p.parameter))
        .collect();
    let peaks: Vec<usize> = (1..along.len() - 1)
        .filter(|&i| along[i] > along[i - 1] && along[i] > along[i + 1])
        .collect();
    let expected = file["caseA_exact"]["rms_peaks"].as_array().unwrap();
    assert_eq!(peaks.len(), expected.len());
    for (&i, expected) in peaks.iter().zip(expected) {
        let (before, here, after) = (&branch.points[i - 1], &branch.points[i], &branch.points[i + 1]);
        let ends = (
            before.parameter.min(after.parameter),
            before.parameter.max(after.parameter),
        );
        let mut solver = crate::common::shooting(&system, here.parameter, 1);
        let (at, value) = maximize(ends.0, ends.1, &mut |w| {
            let orbit = solver.solve(&here.unknowns, w).unwrap();
            let record = solver.summarize(&orbit.start, w, &outputs, &Request::default());
            record.unwrap().measures[0].rms
        });
        // The file cuts the last place off.
        assert_close(at, number(&expected["W"]), 1e-7, "place of the peak");
        assert_close(value, number(&expected["rms"]), 5.1e-11, "peak");
    }
}

#[test]
fn case_b_special_points_in_their_order_along_the_branch() {
    let file = reference("clutch_benchmark.json");
    let system = system(0.1);
    let branch = curve(&system);
    let exact = &file["caseB_exact"];
    for (kind, key) in [
        (SpecialKind::Fold, "LP"),
        (SpecialKind::PeriodDoubling, "PD"),
        (SpecialKind::NeimarkSacker, "TR"),
    ] {
        let found = branch.special_parameters(kind);
        let expected = numbers(&exact[key]);
        assert_eq!(found.len(), expected.len(), "{key}: {found:?}");
        for (a, b) in found.iter().zip(&expected) {
            assert_close(*a, *b, 5.1e-11, key);
        }
    }
    let order: Vec<(&str, f64)> = branch
        .special
        .iter()
        .filter_map(|s| match s.kind {
            SpecialKind::Fold => Some(("LP", s.point.parameter)),
            SpecialKind::PeriodDoubling => Some(("PD", s.point.parameter)),
            SpecialKind::NeimarkSacker => Some(("TR", s.point.parameter)),
            _ => None,
        })
        .collect();
    let text = exact["order_along_branch"].as_str().unwrap();
    let expected: Vec<_> = text.split(", ").collect();
    assert_eq!(order.len(), expected.len());
    for (found, expected) in order.iter().zip(expected) {
        let mut words = expected.split(' ');
        assert_eq!(found.0, words.next().unwrap(), "{expected}");
        let frequency: f64 = words.next().unwrap().parse().unwrap();
        assert_close(found.1, frequency, 5.1e-6, expected);
        if words.next() == Some("(4") {
            let special = branch
                .special
                .iter()
                .find(|s| s.point.parameter == found.1)
                .unwrap();
            assert_eq!(special.point.events, 4, "{expected}");
        }
    }
    let folds = branch.special.iter().filter(|s| s.kind == SpecialKind::Fold);
    for (fold, rms) in folds.zip(numbers(&exact["LP_rms"])) {
        let motion = record(&system, fold.point.parameter, &fold.point.unknowns, 1, 0, 0);
        assert_close(motion.measures[WINDUP].rms, rms, 5.1e-9, "rms at a fold");
    }
}

#[test]
fn twice_preload_and_amplitude_is_case_a_again() {
    let mut model = benchmark(0.1);
    model.preload = 2.0;
    let system = Arc::new(model.system().unwrap());
    let mut solver = shooting(&system, RANGE.0, 1);
    let start = solver.solve(&[0.0, -0.2, 0.0, 0.0], RANGE.0).unwrap().start;
    let options = BranchOptions {
        continuation: Options::over(RANGE.0, RANGE.1),
        direction: 1.0,
    };
    let mut folds =
        follow(&mut solver, &start, RANGE.0, &options, &mut |_| true).special_parameters(SpecialKind::Fold);
    let file = reference("clutch_benchmark.json");
    let list = file["caseA_exact"]["folds"].as_array().unwrap();
    let mut expected: Vec<f64> = list.iter().map(|fold| number(&fold["W"])).collect();
    folds.sort_by(f64::total_cmp);
    expected.sort_by(f64::total_cmp);
    assert!(distance(&folds, &expected) < 1e-14, "{folds:?}");
}

#[test]
fn task_b_sweep_agrees_with_an_independent_integrator_and_jumps_where_it_should() {
    let file = reference("clutch_benchmark.json");
    let expected = sweep_of_independent_integrator();
    let system = system(0.05);
    let frequency = |i: usize| 0.3 + 7.7 * i as f64 / 199.0;
    let mut flow = open(&point(&system, frequency(0))).unwrap();
    let outputs = [system.outputs[WINDUP].clone()];
    let request = Request {
        samples: 100,
        ..Request::default()
    };
    let mut state = [0.0, -0.1, 0.0, 0.0];
    let legs: Vec<f64> = (0..200)
        .chain((0..200).rev())
        .map(|i| {
            assert!(flow.set_frequency(frequency(i)));
            flow.advance(&mut state, 300, &mut []).unwrap();
            let record = flow.record(&mut state, 50, &outputs, &request).unwrap();
            let samples = &record.samples[0];
            let count = samples.len() as f64;
            let mean = samples.iter().sum::<f64>() / count;
            (samples.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / count).sqrt()
        })
        .collect();
    assert_eq!(expected.len(), legs.len());
    for (i, (found, expected)) in legs.iter().zip(&expected).enumerate() {
        assert_close(*found, *expected, 2e-13, &format!("leg {i}"));
    }
    // A jump is where a leg's RMS leaves that of its neighbour by more than a third.
    let jumps = |legs: &[f64], at: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
        (1..legs.len())
            .filter(|&i| (legs[i] / legs[i - 1]).ln().abs() > 0.3)
            .map(|i| [at(i - 1), at(i)])
            .collect()
    };
    for (found, key) in [
        (jumps(&legs[..200], &frequency), "up_jumps_between"),
        (jumps(&legs[200..], &|i| frequency(199 - i)), "down_jumps_between"),
    ] {
        for pair in file["task_b_exact"][key].as_array().unwrap().iter().map(numbers) {
            let seen = found.iter().any(|jump| distance(jump, &pair) < 5.1e-5);
            assert!(seen, "{key} {pair:?}: {found:?}");
        }
    }
}

#[test]
fn task_c_two_thousand_periods() {
    let file = reference("clutch_benchmark.json");
    let expected = &file["task_c_exact"];
    let (system, frequency) = (system(0.05), 1.6);
    let mut flow = open(&point(&system, frequency)).unwrap();
    let mut state = vec![0.0, -0.1, 0.0, 0.0];
    let events = flow.advance(&mut state, 2000, &mut []).unwrap();
    assert_eq!(events as u64, expected["events"].as_u64().unwrap());
    let end = numbers(&expected["x_end"]);
    assert!(distance(&state, &end) < 5e-15, "{:.1e}", distance(&state, &end));
    let orbit = shooting(&system, frequency, 1).solve(&end, frequency).unwrap();
    assert!(
        distance(&orbit.start, &end) < 5e-15,
        "{:.1e}",
        distance(&orbit.start, &end)
    );
    let motion = record(&system, frequency, &state, 1, 0, 0);
    let turn = std::f64::consts::TAU;
    // Phases are shares of the period.
    let phase = |from: usize| motion.events.iter().find(|e| e.from == from).unwrap().phase / turn;
    assert_close(
        phase(1),
        number(&expected["disengage_phase"]),
        2e-15,
        "disengages",
    );
    assert_close(phase(0), number(&expected["engage_phase"]), 2e-15, "engages");
    // What the file calls `rms` here is the mean of the wind-up (its own `x_end` has an RMS of 0.177 about that mean).
    let windup = &motion.measures[WINDUP];
    assert_close(windup.mean, number(&expected["rms"]), 1e-15, "mean");
    let by_samples = {
        let samples = &record(&system, frequency, &end, 1, 0, 4096).samples[WINDUP];
        let mean = samples.iter().sum::<f64>() / 4096.0;
        (samples.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / 4096.0).sqrt()
    };
    assert_close(windup.rms, by_samples, 1e-14, "rms");
    for (re, im) in [
        (0.497147107771, 0.808539060595),
        (0.00301370749407, 0.439754751161),
    ] {
        let nearest = orbit
            .multipliers
            .iter()
            .map(|m| (m.re - re).abs().max((m.im - im).abs()))
            .fold(f64::INFINITY, f64::min);
        assert!(
            nearest < 1e-12,
            "multiplier {re} + {im} i is missed by {nearest:.1e}"
        );
    }
}
