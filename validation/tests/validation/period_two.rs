//! The branch of twice the period (theory 02 §6, §16 pitfall 10).

use crate::common::{distance, nominal_system, record, shooting};
use slackside_continuation::{Family, Options, StopReason};
use slackside_dynamics::branch::{BranchOptions, doubling_start, follow_from};
use slackside_testkit::{assert_close, number, numbers, reference};
use std::f64::consts::TAU;

#[test]
fn the_doubled_branch_closes_and_holds_the_reference_orbits() {
    let file = reference("clutch_nominal.json");
    let at = number(&file["period2"]["from_period_doubling_Omega"]);
    let special = file["branches"]["first_resonance"]["special_points"]
        .as_array()
        .unwrap();
    let doubling = special
        .iter()
        .find(|s| s["type"] == "period_doubling" && (number(&s["Omega"]) - at).abs() < 1e-9)
        .unwrap();
    let system = nominal_system();
    let mut single = shooting(&system, at, 1);
    let orbit = single.solve(&numbers(&doubling["x0"]), at).unwrap();
    let mut double = shooting(&system, at, 2);
    let start = doubling_start(&orbit.start, &orbit.monodromy, &double.unknown_scales(), 0.02).unwrap();
    let options = BranchOptions {
        continuation: Options::over(0.99, 1.06),
        direction: -1.0,
    };
    let branch = follow_from(
        &mut double,
        &start.state,
        at,
        &start.tangent,
        &options,
        &mut |_| true,
    );
    assert_eq!(branch.stop, StopReason::Closed, "{} points", branch.points.len());

    // All motions of the loop at 1.02, each solved from where the branch passes.
    let frequency = 1.02;
    let mut states: Vec<Vec<f64>> = Vec::new();
    for pair in branch.points.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        if (a.parameter - frequency) * (b.parameter - frequency) > 0.0 {
            continue;
        }
        let share = (frequency - a.parameter) / (b.parameter - a.parameter);
        let guess: Vec<f64> = a
            .unknowns
            .iter()
            .zip(&b.unknowns)
            .map(|(x, y)| x + share * (y - x))
            .collect();
        states.push(double.solve(&guess, frequency).unwrap().start);
    }
    // A loop through two phases meets each motion twice, one period of the load apart.
    for expected in file["period2"]["orbits"].as_array().unwrap() {
        for key in ["x0", "x0_one_period_later"] {
            let nearest = states
                .iter()
                .map(|state| distance(state, &numbers(&expected[key])))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 2e-13,
                "{key}, stable {}: {nearest:.1e}",
                expected["stable"]
            );
        }
    }
}

#[test]
fn a_motion_of_twice_the_period_seen_one_period_later_is_the_same_motion() {
    let file = reference("clutch_nominal.json");
    let system = nominal_system();
    for expected in file["period2"]["orbits"].as_array().unwrap() {
        let frequency = number(&expected["Omega"]);
        let mut double = shooting(&system, frequency, 2);
        let first = double.solve(&numbers(&expected["x0"]), frequency).unwrap();
        let second = double
            .solve(&numbers(&expected["x0_one_period_later"]), frequency)
            .unwrap();
        let mut end = first.start.clone();
        double
            .flow(frequency)
            .unwrap()
            .advance(&mut end, 1, &mut [])
            .unwrap();
        assert!(distance(&end, &second.start) < 1e-13);
        let (a, b) = (
            record(&system, frequency, &first.start, 2, 4, 0),
            record(&system, frequency, &second.start, 2, 4, 0),
        );
        for (x, y) in a.measures.iter().zip(&b.measures) {
            assert_close(x.rms, y.rms, 1e-13, "rms");
            assert_close(x.mean, y.mean, 1e-13, "mean");
            assert_close(x.max, y.max, 1e-13, "max");
            // Odd multiples of half the load's frequency change sign, even ones do not.
            for k in 0..=4 {
                let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
                assert!(
                    (x.harmonics[k] - y.harmonics[k] * sign).norm() < 1e-12,
                    "harmonic {k}"
                );
            }
        }
        let mut shifted: Vec<f64> = b.events.iter().map(|e| (e.phase + TAU) % (2.0 * TAU)).collect();
        shifted.sort_by(f64::total_cmp);
        let phases: Vec<f64> = a.events.iter().map(|e| e.phase).collect();
        assert!(distance(&phases, &shifted) < 5e-13);
    }
}
