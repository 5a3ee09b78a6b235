//! Harmonic balance against the reference orbits of the nominal clutch (theory 02 §14), which come from shooting.

use serde_json::{Value, json};
use slackside_dynamics::flow::Request;
use slackside_dynamics::orbit::harmonic_balance::{
    Adaptation, ForceMethod, HarmonicOrbit, Settings, Solution, SolveStop, StabilityMethod, Start, solve,
};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_linalg::Complex;
use slackside_mechanics::laws::Smoothing;
use slackside_mechanics::{FrequencyFamily, OperatingPoint};
use slackside_testkit::{assert_close, nominal, number, numbers, reference};
use std::sync::Arc;

fn point(frequency: f64, smoothing: Option<(Smoothing, f64)>) -> OperatingPoint {
    let mut model = nominal(&json!({}));
    model.smoothing = smoothing;
    OperatingPoint {
        system: Arc::new(model.system().unwrap()),
        frequency,
    }
}

/// Amplitudes of the clutch deflection from the two-sided coefficients of a reference orbit.
fn start(orbit: &Value) -> Vec<Vec<Complex>> {
    let coefficients = orbit["delta_fourier_c"].as_array().unwrap().iter().map(numbers);
    let amplitudes = coefficients
        .enumerate()
        .map(|(k, c)| Complex::new(c[0], c[1]) * if k == 0 { 1.0 } else { 2.0 });
    vec![amplitudes.collect()]
}

/// The same from shooting, for motions that seven harmonics do not tell from their neighbours.
fn shooting_start(orbit: &Value, harmonics: usize) -> Vec<Vec<Complex>> {
    let system = point(1.0, None).system;
    let frequency = number(&orbit["Omega"]);
    let periods = orbit["period_n"].as_u64().unwrap() as usize;
    let windup = system.outputs[system.output_index("windup").unwrap()].clone();
    let mut shooting = Shooting::new(Arc::new(FrequencyFamily::new(system)), frequency, periods).unwrap();
    let request = Request {
        harmonics,
        ..Request::default()
    };
    let summary = shooting
        .summarize(&numbers(&orbit["x0"]), frequency, &[windup], &request)
        .unwrap();
    vec![summary.measures[0].harmonics.clone()]
}

fn found(orbit: &Value, settings: &Settings) -> Solution {
    let start = if orbit["period_n"] == 1 {
        start(orbit)
    } else {
        shooting_start(orbit, 100)
    };
    let settings = Settings {
        subharmonic: orbit["period_n"].as_u64().unwrap() as usize,
        ..settings.clone()
    };
    let at = point(number(&orbit["Omega"]), None);
    let solution = solve(&at, Start::Harmonics(&start), &settings).unwrap();
    assert_eq!(
        solution.stop,
        SolveStop::Converged,
        "{} at {}",
        orbit["label"],
        orbit["Omega"]
    );
    solution
}

struct Tolerance {
    rms: f64,
    mean: f64,
    extremum: f64,
    phase: f64,
    state: f64,
    multipliers: f64,
}

/// Compares everything the file tells of an orbit; `mean` is relative to the static wind-up, the rest to one.
fn check(orbit: &HarmonicOrbit, expected: &Value, tolerance: &Tolerance) {
    let label = format!("{} at {}", expected["label"], expected["Omega"]);
    let measures = orbit.measures();
    let names: Vec<_> = orbit
        .system
        .outputs
        .iter()
        .map(|output| output.name.as_str())
        .collect();
    for (name, key) in [
        ("windup", "delta"),
        ("pulley", "theta_p"),
        ("accessory", "theta_a"),
    ] {
        let measure = &measures[names.iter().position(|n| *n == name).unwrap()];
        let reference = &expected[key];
        let rms = number(&reference["rms_ac"]);
        assert!(
            (measure.rms / rms - 1.0).abs() < tolerance.rms,
            "{label}: rms of {name}: {} {rms}",
            measure.rms
        );
        assert_close(
            measure.mean,
            number(&reference["mean"]),
            tolerance.mean,
            &format!("{label}: mean of {name}"),
        );
        assert_close(
            measure.max,
            number(&reference["max"]),
            tolerance.extremum,
            &format!("{label}: max of {name}"),
        );
        assert_close(
            measure.min,
            number(&reference["min"]),
            tolerance.extremum,
            &format!("{label}: min of {name}"),
        );
    }
    let torque = &measures[names.iter().position(|n| *n == "clutch_torque").unwrap()];
    assert_close(
        torque.mean,
        1.0,
        1e-12,
        &format!("{label}: the mean clutch torque is the preload"),
    );
    let phases = numbers(&expected["event_phases_rad"]);
    assert_eq!(orbit.events.len(), phases.len(), "{label}");
    for (event, phase) in orbit.events.iter().zip(phases) {
        assert_close(event.phase, phase, tolerance.phase, &format!("{label}: event"));
    }
    assert_eq!(
        orbit.regimes_at_start[0].unwrap() as u64,
        expected["regime_at_phase0"].as_u64().unwrap()
    );
    let share = orbit.transmitting[0].unwrap();
    assert_close(
        share,
        number(&expected["engaged_fraction"]),
        tolerance.phase,
        &format!("{label}: engaged"),
    );
    for (x, y) in orbit.initial_state().iter().zip(numbers(&expected["x0"])) {
        assert_close(*x, y, tolerance.state, &format!("{label}: state"));
    }
    let stability = orbit.stability().unwrap();
    assert_eq!(stability.method, StabilityMethod::Switching);
    let multipliers: Vec<_> = expected["multipliers"]
        .as_array()
        .unwrap()
        .iter()
        .map(numbers)
        .collect();
    let reference: Vec<_> = multipliers.iter().map(|m| Complex::new(m[0], m[1])).collect();
    for (x, y) in polynomial(&stability.multipliers)
        .iter()
        .zip(polynomial(&reference))
    {
        assert_close(
            *x,
            y,
            tolerance.multipliers,
            &format!("{label}: characteristic polynomial"),
        );
    }
    assert_eq!(
        stability.is_stable(),
        expected["stable"].as_bool().unwrap(),
        "{label}"
    );
    // Product of the multipliers, whatever the events: exp(−2 (ζ₁ω₁ + ζ₂ω₂) T) (theory 02 §1.10).
    let decay = 0.06 * (0.9796106880251735 + 6.374979443096805);
    let product: Complex = stability.multipliers.iter().product();
    let exact = (-decay * orbit.period()).exp();
    assert!(
        (product.re / exact - 1.0).abs() < 1e-9 && product.im.abs() < 1e-9 * exact,
        "{label}: product"
    );
}

/// Coefficients of `Π (x − μ_i)`, by which multipliers are compared: single ones are ill-conditioned near double values.
fn polynomial(roots: &[Complex]) -> Vec<f64> {
    let mut coefficients = vec![Complex::new(1.0, 0.0)];
    for root in roots {
        coefficients.push(Complex::new(0.0, 0.0));
        for i in (1..coefficients.len()).rev() {
            let previous = coefficients[i - 1];
            coefficients[i] -= root * previous;
        }
    }
    coefficients.iter().map(|c| c.re).collect()
}

#[test]
fn second_resonance_with_forty_harmonics() {
    let file = reference("clutch_nominal.json");
    for expected in file["branches"]["second_resonance"]["orbits"].as_array().unwrap() {
        let solution = found(expected, &Settings::fixed(40));
        assert!(solution.iterations <= 8, "{} iterations", solution.iterations);
        let tolerance = Tolerance {
            rms: 1e-8,
            mean: 1e-9,
            extremum: 1e-8,
            phase: 1e-7,
            state: 3e-7,
            multipliers: 5e-7,
        };
        check(&solution.orbit, expected, &tolerance);
    }
}

#[test]
fn first_resonance_with_many_harmonics() {
    let file = reference("clutch_nominal.json");
    for expected in file["branches"]["first_resonance"]["orbits"].as_array().unwrap() {
        let solution = found(expected, &Settings::fixed(320));
        let tolerance = Tolerance {
            rms: 2e-9,
            mean: 1e-9,
            extremum: 1e-8,
            phase: 1e-7,
            state: 3e-7,
            multipliers: 1e-6,
        };
        check(&solution.orbit, expected, &tolerance);
    }
}

#[test]
fn motions_of_twice_the_period() {
    let file = reference("clutch_nominal.json");
    for expected in file["period2"]["orbits"].as_array().unwrap() {
        let solution = found(expected, &Settings::fixed(480));
        let tolerance = Tolerance {
            rms: 2e-9,
            mean: 1e-9,
            extremum: 1e-8,
            phase: 1e-7,
            state: 3e-7,
            multipliers: 1e-6,
        };
        check(&solution.orbit, expected, &tolerance);
    }
}

#[test]
fn harmonics_adapt_until_the_tail_is_small_and_the_switchings_settle() {
    let file = reference("clutch_nominal.json");
    for expected in file["branches"]["second_resonance"]["orbits"].as_array().unwrap() {
        let settings = Settings {
            harmonics: 4,
            ..Settings::default()
        };
        let orbit = found(expected, &settings).orbit;
        assert!(orbit.tail <= 1e-7, "{}", orbit.tail);
        let separates = number(&expected["engaged_fraction"]) < 1.0;
        assert_eq!(orbit.harmonics > 16, separates, "{} harmonics", orbit.harmonics);
        let rms = number(&expected["delta"]["rms_ac"]);
        let windup = orbit.system.output_index("windup").unwrap();
        assert!((orbit.measures()[windup].rms / rms - 1.0).abs() < 1e-8);
    }
    let coarse = Settings {
        harmonics: 8,
        adaptation: Some(Adaptation {
            maximum: 12,
            ..Adaptation::default()
        }),
        ..Settings::default()
    };
    let expected = &file["branches"]["second_resonance"]["orbits"][8];
    let at = point(number(&expected["Omega"]), None);
    let stopped = solve(&at, Start::Harmonics(&start(expected)), &coarse).unwrap();
    assert_eq!(stopped.stop, SolveStop::HarmonicLimit);
    assert_eq!(stopped.orbit.harmonics, 12);
}

#[test]
fn linear_response_is_the_start_where_nothing_separates() {
    let solution = solve(&point(4.6, None), Start::Linear, &Settings::fixed(8)).unwrap();
    assert_eq!(solution.stop, SolveStop::Converged);
    assert!(solution.orbit.events.is_empty());
    assert!(solution.iterations <= 1);
}

/// The orbit at the upper branch of 5.5 with a smoothed clutch.
fn smoothed(smoothing: Smoothing, width: f64, harmonics: usize) -> HarmonicOrbit {
    let file = reference("clutch_nominal.json");
    let upper = file["branches"]["second_resonance"]["orbits"].as_array().unwrap();
    let upper = upper
        .iter()
        .find(|o| o["Omega"] == 5.5 && o["label"] == "second_resonance/2")
        .unwrap();
    let at = point(5.5, Some((smoothing, width)));
    let solution = solve(&at, Start::Harmonics(&start(upper)), &Settings::fixed(harmonics)).unwrap();
    assert_eq!(solution.stop, SolveStop::Converged);
    solution.orbit
}

#[test]
fn smoothed_clutch_agrees_with_the_reference_integration() {
    let file = reference("clutch_nominal.json");
    let expected = &file["tanh_smoothing"];
    let orbit = smoothed(Smoothing::Tanh, number(&expected["eps"]), 160);
    let windup = &orbit.measures()[orbit.system.output_index("windup").unwrap()];
    assert!((windup.rms / number(&expected["delta"]["rms_ac"]) - 1.0).abs() < 1e-11);
    assert!((windup.mean / number(&expected["delta"]["mean"]) - 1.0).abs() < 1e-10);
    for (x, y) in orbit.initial_state().iter().zip(numbers(&expected["x0"])) {
        assert_close(*x, y, 1e-8, "state of the smoothed clutch");
    }
    assert!(orbit.samples >= 4096);
    assert_eq!(orbit.transmitting, [None]);
}

#[test]
fn smoothing_errors_follow_the_reference_table() {
    let file = reference("clutch_nominal.json");
    let rows = file["smoothing_convergence"]["rows"].as_array().unwrap();
    let kinds = [
        ("tanh", Smoothing::Tanh),
        ("arctan", Smoothing::Arctan),
        ("cosh", Smoothing::Cosh),
        ("poly2", Smoothing::Quadratic),
        ("poly4", Smoothing::Quartic),
    ];
    for (name, smoothing) in kinds {
        let of_law = rows
            .iter()
            .filter(|row| row["law"] == name && number(&row["eps"]) >= 0.004);
        for row in of_law {
            let width = number(&row["eps"]);
            let orbit = smoothed(smoothing, width, 60);
            let windup = &orbit.measures()[orbit.system.output_index("windup").unwrap()];
            let expected = number(&row["delta_rms_ac"]);
            assert!(
                (windup.rms / expected - 1.0).abs() < 3e-9,
                "{name} {width}: {} against {expected}",
                windup.rms
            );
        }
    }
}

fn upper_orbit(harmonics: usize) -> (HarmonicOrbit, Vec<f64>) {
    let file = reference("clutch_nominal.json");
    let orbits = file["branches"]["second_resonance"]["orbits"].as_array().unwrap();
    let upper = orbits
        .iter()
        .find(|o| o["Omega"] == 5.5 && o["label"] == "second_resonance/2")
        .unwrap();
    let multipliers: Vec<_> = upper["multipliers"]
        .as_array()
        .unwrap()
        .iter()
        .map(numbers)
        .collect();
    let roots: Vec<_> = multipliers.iter().map(|m| Complex::new(m[0], m[1])).collect();
    (
        found(upper, &Settings::fixed(harmonics)).orbit,
        polynomial(&roots),
    )
}

#[test]
fn hill_converges_with_the_third_power_of_the_harmonics() {
    let mut errors = Vec::new();
    for harmonics in [20, 40, 80] {
        let (orbit, exact) = upper_orbit(harmonics);
        let stability = orbit.stability_by(StabilityMethod::Hill).unwrap();
        assert_eq!(stability.multipliers.len(), 4);
        let found = polynomial(&stability.multipliers);
        let error = found
            .iter()
            .zip(&exact)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        errors.push(error);
    }
    // theory 02 §7: 6e-5, 7e-6, 8e-7 for the largest multiplier alone.
    assert!(errors[0] < 1e-4 && errors[2] < 2e-6, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((6.0..10.0).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

#[test]
fn three_methods_agree_on_the_multipliers() {
    let (orbit, exact) = upper_orbit(80);
    let magnus = orbit.stability_by(StabilityMethod::Magnus).unwrap();
    let switching = orbit.stability_by(StabilityMethod::Switching).unwrap();
    for ((a, b), c) in polynomial(&magnus.multipliers)
        .iter()
        .zip(polynomial(&switching.multipliers))
        .zip(exact)
    {
        assert_close(*a, b, 1e-9, "Magnus against switching");
        assert_close(b, c, 5e-8, "switching against the reference");
    }
    // A smooth law: Magnus is the default, and Hill agrees.
    let orbit = smoothed(Smoothing::Tanh, 0.016, 40);
    let magnus = orbit.stability().unwrap();
    assert_eq!(magnus.method, StabilityMethod::Magnus);
    assert!(magnus.error_estimate.unwrap() < 1e-8);
    let hill = orbit.stability_by(StabilityMethod::Hill).unwrap();
    for (a, b) in polynomial(&magnus.multipliers)
        .iter()
        .zip(polynomial(&hill.multipliers))
    {
        assert_close(*a, b, 1e-6, "Magnus against Hill");
    }
    assert!(orbit.stability_by(StabilityMethod::Switching).is_err());
}

#[test]
fn sampled_evaluation_of_the_exact_law_tends_to_the_exact_one() {
    let file = reference("clutch_nominal.json");
    let expected = &file["branches"]["second_resonance"]["orbits"][1];
    let settings = Settings {
        force_method: ForceMethod::Sampled,
        samples: 16384,
        ..Settings::fixed(30)
    };
    let at = point(number(&expected["Omega"]), None);
    let solution = solve(&at, Start::Harmonics(&start(expected)), &settings).unwrap();
    let windup = solution.orbit.system.output_index("windup").unwrap();
    let rms = number(&expected["delta"]["rms_ac"]);
    assert!((solution.orbit.measures()[windup].rms / rms - 1.0).abs() < 1e-6);
    assert_eq!(solution.orbit.events.len(), 2);
}

#[test]
fn samples_are_refined_from_a_coarse_start() {
    // The transition takes two of 256 samples.
    let at = point(6.2, Some((Smoothing::Tanh, 0.002)));
    let settings = Settings {
        samples: 256,
        ..Settings::fixed(16)
    };
    let smooth = solve(&at, Start::Linear, &settings).unwrap();
    assert_eq!(smooth.stop, SolveStop::Converged);
    assert!(smooth.orbit.samples > 256, "{}", smooth.orbit.samples);
    let exact = solve(&point(6.2, None), Start::Linear, &Settings::fixed(40)).unwrap();
    let windup = exact.orbit.system.output_index("windup").unwrap();
    let (a, b) = (
        smooth.orbit.measures()[windup].rms,
        exact.orbit.measures()[windup].rms,
    );
    // theory 02 §4: an error of κ ε² in proportion to that of 1.2e-5 at 5.5.
    assert!((a - b).abs() < 3e-5 && a != b, "{a} {b}");
}
