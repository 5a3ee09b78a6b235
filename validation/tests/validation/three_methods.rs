//! Shooting, harmonic balance and long integration of the same motions (theory 02 §8, §16 pitfall 7).

use crate::common::{WINDUP, distance, nominal_system, point, record, shooting};
use serde_json::Value;
use slackside_dynamics::flow::open;
use slackside_dynamics::orbit::harmonic_balance::{Settings, SolveStop, Start, solve};
use slackside_dynamics::orbit::shooting::Orbit;
use slackside_linalg::{Complex, eigen};
use slackside_testkit::{assert_close, number, numbers, reference};

fn reference_orbits() -> Vec<Value> {
    let file = reference("clutch_nominal.json");
    [
        &file["branches"]["second_resonance"]["orbits"],
        &file["branches"]["first_resonance"]["orbits"],
        &file["period2"]["orbits"],
    ]
    .into_iter()
    .flat_map(|list| list.as_array().unwrap().clone())
    .collect()
}

#[test]
fn integration_over_thousands_of_periods_ends_on_every_stable_orbit() {
    let system = nominal_system();
    let mut checked = 0;
    for expected in reference_orbits().iter().filter(|o| o["stable"] == true) {
        let frequency = number(&expected["Omega"]);
        let periods = expected["period_n"].as_u64().unwrap() as usize;
        let label = format!("{} at {frequency}", expected["label"]);
        let mut solver = shooting(&system, frequency, periods);
        let by_shooting = solver.solve(&numbers(&expected["x0"]), frequency).unwrap();
        // From 1e-3 off, as many periods as take the slowest direction below rounding, and at least 700.
        let rate = by_shooting.multipliers[0].norm().ln();
        let count = ((-37.0 / rate).ceil() as usize).max(700) * periods;
        let mut state: Vec<f64> = by_shooting.start.iter().map(|x| x + 1e-3).collect();
        let mut flow = open(&point(&system, frequency)).unwrap();
        flow.advance(&mut state, count, &mut []).unwrap();
        let off = distance(&state, &by_shooting.start);
        assert!(
            off < 3e-13,
            "{label}: integration is {off:.1e} from shooting after {count} periods"
        );
        let integrated = record(&system, frequency, &state, periods, 0, 0);

        let motion = record(&system, frequency, &by_shooting.start, periods, 60, 0);
        let harmonics = if frequency > 2.0 { 80 } else { 240 * periods };
        let settings = Settings {
            subharmonic: periods,
            ..Settings::fixed(harmonics)
        };
        let start = [motion.measures[WINDUP].harmonics.clone()];
        let balanced = solve(&point(&system, frequency), Start::Harmonics(&start), &settings).unwrap();
        assert_eq!(balanced.stop, SolveStop::Converged, "{label}");
        let by_balance = balanced.orbit.measures();
        for i in 0..3 {
            let (a, b, c) = (&motion.measures[i], &integrated.measures[i], &by_balance[i]);
            assert_close(a.rms, b.rms, 1e-13, &format!("{label}: rms by integration"));
            assert_close(a.mean, b.mean, 1e-13, &format!("{label}: mean by integration"));
            assert_close(a.max, b.max, 1e-13, &format!("{label}: max by integration"));
            assert_close(a.rms, c.rms, 2e-9, &format!("{label}: rms by harmonic balance"));
            assert_close(
                a.mean,
                c.mean,
                1e-9,
                &format!("{label}: mean by harmonic balance"),
            );
            assert_close(a.max, c.max, 5e-9, &format!("{label}: max by harmonic balance"));
        }
        assert_eq!(motion.events.len(), integrated.events.len(), "{label}");
        assert_eq!(motion.events.len(), balanced.orbit.events.len(), "{label}");
        for ((a, b), c) in motion
            .events
            .iter()
            .zip(&integrated.events)
            .zip(&balanced.orbit.events)
        {
            assert_close(a.phase, b.phase, 1e-12, &format!("{label}: event by integration"));
            assert_close(
                a.phase,
                c.phase,
                5e-8,
                &format!("{label}: event by harmonic balance"),
            );
        }
        let off = distance(&balanced.orbit.initial_state(), &by_shooting.start);
        assert!(off < 5e-7, "{label}: state by harmonic balance is {off:.1e} off");
        checked += 1;
    }
    assert!(checked >= 15, "{checked}");
}

/// The eigenvector of the transposed monodromy matrix for the largest multiplier: along it a small disturbance grows by
/// exactly that factor per period of the motion.
fn leading_left_eigenvector(orbit: &Orbit) -> Vec<Complex> {
    let decomposition = eigen(&orbit.monodromy.transpose()).unwrap();
    let leading = (0..orbit.start.len())
        .max_by(|&i, &j| {
            decomposition.values[i]
                .norm()
                .total_cmp(&decomposition.values[j].norm())
        })
        .unwrap();
    (0..orbit.start.len())
        .map(|i| decomposition.vectors[(i, leading)])
        .collect()
}

#[test]
fn integration_leaves_every_unstable_orbit_at_the_rate_of_its_largest_multiplier() {
    let system = nominal_system();
    let mut checked = 0;
    for expected in reference_orbits().iter().filter(|o| o["stable"] == false) {
        let frequency = number(&expected["Omega"]);
        let periods = expected["period_n"].as_u64().unwrap() as usize;
        let label = format!("{} at {frequency}", expected["label"]);
        let orbit = shooting(&system, frequency, periods)
            .solve(&numbers(&expected["x0"]), frequency)
            .unwrap();
        let largest = orbit.multipliers[0].norm();
        let left = leading_left_eigenvector(&orbit);
        let along = |state: &[f64]| {
            let terms = (0..4).map(|i| left[i] * (state[i] - orbit.start[i]));
            terms.sum::<Complex>().norm()
        };
        let mut flow = open(&point(&system, frequency)).unwrap();
        let mut state: Vec<f64> = orbit.start.iter().map(|x| x + 1e-6).collect();
        let first = along(&state);
        let mut count = 0;
        // Linear growth holds while the disturbance is small; the events limit it to some 1e-4.
        while along(&state) < 100.0 * first {
            flow.advance(&mut state, periods, &mut []).unwrap();
            count += 1;
            assert!(count < 200, "{label}: does not leave");
        }
        let growth = (along(&state) / first).ln() / count as f64;
        let error = (growth / largest.ln() - 1.0).abs();
        assert!(
            error < 2e-3,
            "{label}: grows by {growth}, multiplier {}",
            largest.ln()
        );
        // And it does not come back.
        flow.advance(&mut state, 100 * periods, &mut []).unwrap();
        assert!(distance(&state, &orbit.start) > 1e-3, "{label}");
        checked += 1;
    }
    assert!(checked >= 5, "{checked}");
}
