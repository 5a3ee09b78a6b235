//! Shooting against the reference orbits of the nominal clutch, and its derivatives against differences.

use serde_json::{Value, json};
use slackside_dynamics::flow::Request;
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_mechanics::FrequencyFamily;
use slackside_testkit::{assert_close, nominal, number, numbers, reference};
use std::sync::Arc;

fn shooting(frequency: f64, periods: usize) -> (Shooting, Vec<slackside_mechanics::Output>) {
    let system = nominal(&json!({})).system().unwrap();
    let outputs = system.outputs.clone();
    let family = Arc::new(FrequencyFamily::new(Arc::new(system)));
    (Shooting::new(family, frequency, periods).unwrap(), outputs)
}

fn check_orbit(reference: &Value) {
    let frequency = number(&reference["Omega"]);
    let periods = reference["period_n"].as_u64().unwrap() as usize;
    let label = format!("{} at {frequency}", reference["label"]);
    let (mut shooting, outputs) = shooting(frequency, periods);
    let start = numbers(&reference["x0"]);
    // A start that is off by 1e-5 shows that Newton's method, not the guess, makes the digits.
    let guess: Vec<f64> = start.iter().map(|x| x + 1e-5).collect();
    let orbit = shooting.solve(&guess, frequency).unwrap();
    for (found, expected) in orbit.start.iter().zip(&start) {
        assert_close(*found, *expected, 1e-12, &label);
    }
    assert_eq!(
        orbit.is_stable(),
        reference["stable"].as_bool().unwrap(),
        "{label}"
    );
    let request = Request {
        harmonics: 7,
        extremes: true,
        samples: 0,
        ..Request::default()
    };
    let summary = shooting
        .summarize(&orbit.start, frequency, &outputs, &request)
        .unwrap();
    for (name, index) in [("theta_p", 0), ("theta_a", 1), ("delta", 2)] {
        let (found, expected) = (&summary.measures[index], &reference[name]);
        assert_close(found.mean, number(&expected["mean"]), 1e-13, &label);
        assert_close(found.rms, number(&expected["rms_ac"]), 1e-13, &label);
        assert_close(found.max, number(&expected["max"]), 1e-12, &label);
        assert_close(found.min, number(&expected["min"]), 1e-12, &label);
    }
    let fourier = reference["delta_fourier_c"].as_array().unwrap();
    for (k, expected) in fourier.iter().enumerate().skip(1) {
        let expected = numbers(expected);
        // The reference lists two-sided coefficients from harmonic balance with 320 harmonics.
        assert_close(
            0.5 * summary.measures[2].harmonics[k].re,
            expected[0],
            1e-9,
            &label,
        );
        assert_close(
            0.5 * summary.measures[2].harmonics[k].im,
            expected[1],
            1e-9,
            &label,
        );
    }
    let phases = numbers(&reference["event_phases_rad"]);
    assert_eq!(summary.events.len(), phases.len(), "{label}");
    for (found, expected) in summary.events.iter().zip(&phases) {
        assert_close(found.phase, *expected, 1e-11, &label);
    }
    assert_close(
        summary.fractions[0][1],
        number(&reference["engaged_fraction"]),
        1e-12,
        &label,
    );
    // Individual multipliers lose digits near double values; their elementary symmetric functions do not.
    let product: f64 = orbit.multipliers.iter().map(|m| m.norm()).product();
    let omega = [0.9796106880251735, 6.374979443096805];
    let decay = -0.06 * (omega[0] + omega[1]) * std::f64::consts::TAU * periods as f64 / frequency;
    assert_close(product, decay.exp(), 1e-13, &label);
    for (found, expected) in orbit
        .multipliers
        .iter()
        .zip(reference["multiplier_moduli"].as_array().unwrap())
    {
        assert_close(found.norm(), number(expected), 2e-8, &label);
    }
}

#[test]
fn reference_orbits_of_both_resonances_and_of_period_two() {
    let file = reference("clutch_nominal.json");
    for list in [
        &file["branches"]["second_resonance"]["orbits"],
        &file["branches"]["first_resonance"]["orbits"],
        &file["period2"]["orbits"],
    ] {
        for orbit in list.as_array().unwrap() {
            check_orbit(orbit);
        }
    }
}

#[test]
fn derivative_with_respect_to_frequency_agrees_with_differences() {
    let (mut shooting, _) = shooting(5.5, 1);
    let x = [0.02, -0.03, 0.2, -0.1];
    let (_, _, by_parameter) = shooting.map(&x, 5.5).unwrap();
    let h = 1e-5;
    let ahead = shooting.map(&x, 5.5 + h).unwrap().0;
    let behind = shooting.map(&x, 5.5 - h).unwrap().0;
    for i in 0..4 {
        assert_close(by_parameter[i], (ahead[i] - behind[i]) / (2.0 * h), 1e-9, "∂x/∂Ω");
    }
}

#[test]
fn long_runs_agree_with_period_by_period_runs() {
    use slackside_dynamics::flow::open;
    use slackside_mechanics::OperatingPoint;
    let system = Arc::new(nominal(&json!({})).system().unwrap());
    for frequency in [0.93, 0.97, 1.3, 3.1, 5.5, 7.33] {
        let point = OperatingPoint {
            system: system.clone(),
            frequency,
        };
        let mut flow = open(&point).unwrap();
        let (mut far, mut near) = ([0.1, -0.1, 0.5, 0.0], [0.1, -0.1, 0.5, 0.0]);
        let events = flow.advance(&mut far, 40, &mut []).unwrap();
        let mut count = 0;
        for _ in 0..40 {
            count += flow.advance(&mut near, 1, &mut []).unwrap();
        }
        assert_eq!(events, count, "events at {frequency}");
        for i in 0..4 {
            // Chaotic transients amplify rounding; 40 periods leave eleven digits.
            assert_close(far[i], near[i], 1e-11, &format!("state at {frequency}"));
        }
    }
}

#[test]
fn records_of_a_settled_motion_in_closed_form_agree_with_those_by_pieces() {
    use slackside_dynamics::flow::open;
    use slackside_mechanics::OperatingPoint;
    let system = Arc::new(nominal(&json!({})).system().unwrap());
    let point = OperatingPoint {
        system: system.clone(),
        frequency: 3.1,
    };
    // Near the non-separating response, with a transient that has not died out.
    let start = [0.001, -1.0 / 24.0, 0.0, 0.002];
    let record = |extremes: bool| {
        let mut state = start;
        let request = Request {
            harmonics: 30,
            extremes,
            samples: 7,
            ..Request::default()
        };
        let record = open(&point)
            .unwrap()
            .record(&mut state, 12, &system.outputs, &request)
            .unwrap();
        assert!(record.events.is_empty());
        (record, state)
    };
    let ((closed, end_closed), (pieces, end_pieces)) = (record(false), record(true));
    for (a, b) in end_closed.iter().zip(&end_pieces) {
        assert_close(*a, *b, 1e-14, "end state");
    }
    assert_eq!(closed.fractions.len(), pieces.fractions.len());
    assert_close(
        closed.fractions[0][1],
        pieces.fractions[0][1],
        1e-13,
        "engaged ratio",
    );
    for (a, b) in closed.measures.iter().zip(&pieces.measures) {
        assert_close(a.mean, b.mean, 1e-13, "mean");
        assert_close(a.rms, b.rms, 1e-13, "rms");
        for (x, y) in a.harmonics.iter().zip(&b.harmonics) {
            assert_close((x - y).norm(), 0.0, 1e-13, "harmonic");
        }
    }
    for (a, b) in closed
        .samples
        .iter()
        .flatten()
        .zip(pieces.samples.iter().flatten())
    {
        assert_close(*a, *b, 1e-13, "sample");
    }
}
