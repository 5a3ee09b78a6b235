//! Condensed harmonic balance of dry friction and of a clutch before a free accessory (theory 05 §5.3, §5.4).

use serde_json::{Value, json};
use slackside_continuation::{Evaluation, Family};
use slackside_dynamics::orbit::harmonic_balance::{
    ForceMethod, HarmonicBalance, HarmonicBalanceError, HarmonicOrbit, Settings, SolveStop, Start, solve,
};
use slackside_linalg::Complex;
use slackside_mechanics::laws::{Smoothed, SmoothedGraph, Smoothing, coulomb, one_way, one_way_damper};
use slackside_mechanics::{FrequencyFamily, Law, OperatingPoint, OutsideDomain, SystemFamily};
use slackside_testkit::nonsmooth_reference::{Machine, Place, nonsmooth_reference, operating_point};
use slackside_testkit::{number, numbers};
use std::f64::consts::TAU;
use std::sync::Arc;

const ARM: usize = 1;
const PULLEY: usize = 2;

/// Exactly as many harmonics and samples as given.
fn fixed(harmonics: usize, samples: usize) -> Settings {
    Settings {
        samples,
        refine_samples: false,
        ..Settings::fixed(harmonics)
    }
}

/// The drive with friction at its arm, smoothed over `width`.
fn friction(file: &Value, input: &Value, smoothing: Smoothing, width: f64) -> OperatingPoint {
    let law = |_: Place, input: &Value| -> Arc<dyn Law> {
        Arc::new(SmoothedGraph::new(coulomb(number(&input["Q"]), 1.0), smoothing, width).unwrap())
    };
    operating_point(file, Machine::Friction, input, &law)
}

/// The drive with a clutch at its accessory.
fn clutch(file: &Value, input: &Value, law: impl Law + Clone + 'static) -> OperatingPoint {
    let law = |_: Place, _: &Value| -> Arc<dyn Law> { Arc::new(law.clone()) };
    operating_point(file, Machine::Clutch, input, &law)
}

fn rms(amplitudes: &[Complex]) -> f64 {
    (0.5 * amplitudes.iter().skip(1).map(|h| h.norm_sqr()).sum::<f64>()).sqrt()
}

fn periodic<'a>(file: &'a Value, name: &str) -> &'a Value {
    let entries = file["periodic"].as_array().unwrap();
    entries
        .iter()
        .find(|entry| entry["input"]["name"] == name)
        .unwrap()
}

#[test]
fn smoothed_friction_of_the_reference() {
    let file = nonsmooth_reference();
    for entry in file["harmonic_balance"].as_array().unwrap() {
        let input = &entry["input"];
        let count = |key: &str| input[key].as_u64().unwrap() as usize;
        let smoothing = match input["kind"].as_str().unwrap() {
            "tanh" => Smoothing::Tanh,
            "atan" => Smoothing::Arctan,
            other => panic!("{other}"),
        };
        let harmonics = count("H");
        let point = friction(&file, input, smoothing, number(&input["eps"]));
        let solution = solve(&point, Start::Linear, &fixed(harmonics, count("N"))).unwrap();
        assert_eq!(solution.stop, SolveStop::Converged);
        assert!(solution.iterations <= 45, "{} steps", solution.iterations);
        assert_eq!(solution.orbit.samples, count("N"));
        let orbit = &solution.orbit;
        for (key, found) in [
            ("arm_harmonics", &orbit.coordinates[ARM]),
            ("pulley_harmonics", &orbit.coordinates[PULLEY]),
            ("friction_harmonics", &orbit.forces[0]),
        ] {
            let size = rms(&found[..=harmonics]);
            for (k, expected) in entry[key].as_array().unwrap().iter().enumerate() {
                let expected = numbers(expected);
                let difference = (found[k] - Complex::new(expected[0], expected[1])).norm();
                assert!(
                    difference <= 1e-11 * size,
                    "{key} {k}: {difference:e} of {size:e}"
                );
            }
        }
        // Dissipation over a period, (T/2) Σ Re(f_k (ikΩ U_k)*).
        let work: f64 = (1..=harmonics)
            .map(|k| {
                let rate = Complex::new(0.0, k as f64 * point.frequency) * orbit.coordinates[ARM][k];
                (orbit.forces[0][k] * rate.conj()).re
            })
            .sum();
        let dissipation = 0.5 * orbit.period() * work;
        let expected = number(&entry["dissipation_per_period"]);
        assert!(
            (dissipation - expected).abs() <= 1e-10 * expected,
            "{dissipation} {expected}"
        );
    }
}

/// Relative error of the arm's rms by harmonic balance against the exact orbit.
fn arm_error(file: &Value, name: &str, harmonics: usize, relative_width: f64) -> f64 {
    let entry = periodic(file, name);
    let exact = number(&entry["q"]["rms"][ARM]);
    // The width in parts of the velocity of the frictionless arm.
    let free = friction(file, &entry["input"], Smoothing::Tanh, 1e9);
    let linear = solve(&free, Start::Linear, &fixed(1, 64)).unwrap();
    let width = relative_width * free.frequency * linear.orbit.coordinates[ARM][1].norm();
    let point = friction(file, &entry["input"], Smoothing::Tanh, width);
    let solution = solve(&point, Start::Linear, &fixed(harmonics, 16384)).unwrap();
    assert_eq!(solution.stop, SolveStop::Converged, "{name} H = {harmonics}");
    rms(&solution.orbit.coordinates[ARM][..=harmonics]) / exact - 1.0
}

#[test]
fn convergence_towards_the_exact_orbits() {
    let file = nonsmooth_reference();
    for (name, expected) in [
        ("friction slip", [6e-4, 4e-4, 3e-4, 1e-4, 8e-5]),
        ("friction 600", [8e-2, 5e-2, 1.5e-2, 4e-3, 3e-3]),
        ("friction 240", [15e-2, 10e-2, 3e-2, 1.8e-2, 1.3e-2]),
    ] {
        for (harmonics, expected) in [3, 7, 15, 31, 63].into_iter().zip(expected) {
            let error = arm_error(&file, name, harmonics, 1e-3).abs();
            println!("{name} H = {harmonics}: {error:.1e}, table {expected:.1e}");
            assert!(
                error <= 1.5 * expected,
                "{name} H = {harmonics}: {error:e} above {expected:e}"
            );
        }
    }
}

#[test]
fn exact_sign_converges_without_smoothing() {
    let file = nonsmooth_reference();
    let entry = periodic(&file, "friction slip");
    let exact = number(&entry["q"]["rms"][ARM]);
    let law = |_: Place, input: &Value| -> Arc<dyn Law> { Arc::new(coulomb(number(&input["Q"]), 1.0)) };
    let point = operating_point(&file, Machine::Friction, &entry["input"], &law);
    let mut before = f64::INFINITY;
    for harmonics in [3, 9, 27, 81] {
        let solution = solve(&point, Start::Linear, &Settings::fixed(harmonics)).unwrap();
        assert_eq!(solution.stop, SolveStop::Converged);
        assert!(solution.iterations <= 7, "{} steps", solution.iterations);
        assert_eq!(solution.orbit.samples, 0);
        let error = (rms(&solution.orbit.coordinates[ARM][..=harmonics]) / exact - 1.0).abs();
        println!("H = {harmonics}: {error:.1e} in {}", solution.iterations);
        assert!(error < before, "H = {harmonics}: {error:e} after {before:e}");
        before = error;
        // Slipping one way and the other, half a period each.
        let phases: Vec<f64> = solution.orbit.events.iter().map(|e| e.phase / TAU).collect();
        assert_eq!(phases.len(), 2);
        assert!((phases[1] - phases[0] - 0.5).abs() < 1e-10);
        // Odd forcing and an odd law: no even harmonics.
        let even = solution.orbit.coordinates[ARM].iter().step_by(2);
        assert!(even.into_iter().all(|h| h.norm() < 1e-12 * exact));
        assert!(matches!(
            solution.orbit.stability(),
            Err(HarmonicBalanceError::NoTangent { .. })
        ));
    }
    assert!(before < 7e-5);
}

fn evaluation(family: &mut HarmonicBalance, z: &[f64], p: f64) -> Evaluation {
    let mut evaluation = Evaluation::new(family.dimension());
    family.evaluate(z, p, &mut evaluation).unwrap();
    evaluation
}

/// Some unknowns of about the size of the solution, reproducible.
fn unknowns(count: usize, size: f64) -> Vec<f64> {
    (0..count)
        .map(|i| size * ((1.7 * i as f64).sin() + 0.3) / (1.0 + i as f64))
        .collect()
}

/// Jacobian and derivative with respect to frequency of the equations of `point` against differences of relative size
/// `step`, compared with the largest entry.
fn check_derivatives(point: &OperatingPoint, settings: Settings, size: f64, step: f64, what: &str) {
    let family = Arc::new(FrequencyFamily::new(point.system.clone()));
    let mut family = HarmonicBalance::new(family, point.frequency, settings).unwrap();
    let z = unknowns(family.dimension(), size);
    let at = evaluation(&mut family, &z, point.frequency);
    let difference = |values: [Vec<f64>; 4], h: f64| -> Vec<f64> {
        let [a, b, c, d] = values;
        (0..a.len())
            .map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h))
            .collect()
    };
    let largest = at.jacobian.max_abs();
    for j in 0..z.len() {
        let h = step * size;
        let values = [-2.0, -1.0, 1.0, 2.0].map(|multiple| {
            let mut moved = z.clone();
            moved[j] += multiple * h;
            evaluation(&mut family, &moved, point.frequency).residual
        });
        for (i, expected) in difference(values, h).iter().enumerate() {
            let found = at.jacobian[(i, j)];
            assert!(
                (found - expected).abs() <= 1e-7 * largest,
                "{what} ({i}, {j}): {found} {expected}"
            );
        }
    }
    let h = 0.1 * step * point.frequency;
    let values = [-2.0, -1.0, 1.0, 2.0]
        .map(|multiple| evaluation(&mut family, &z, point.frequency + multiple * h).residual);
    let largest = at.by_parameter.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    for (i, expected) in difference(values, h).iter().enumerate() {
        let found = at.by_parameter[i];
        assert!(
            (found - expected).abs() <= 1e-7 * largest,
            "{what} d/dΩ {i}: {found} {expected}"
        );
    }
}

#[test]
fn derivatives_agree_with_differences() {
    let file = nonsmooth_reference();
    let arm = friction(&file, &json!({"W": 300.0, "Q": 1.0}), Smoothing::Tanh, 5.0);
    check_derivatives(&arm, fixed(6, 256), 0.05, 1e-4, "friction");
    let smooth = Smoothed::new(one_way_damper(5.0), Smoothing::Tanh, 4.0);
    let point = clutch(&file, &json!({"W": 400.0, "Ml": 3.0}), smooth);
    check_derivatives(&point, fixed(6, 256), 0.03, 1e-4, "smoothed clutch");
    // Switching angles move; the differences then have few good derivatives, and small steps serve them better.
    let point = clutch(&file, &json!({"W": 400.0, "Ml": 3.0}), one_way_damper(5.0));
    check_derivatives(
        &point,
        Settings::fixed(6),
        0.03,
        1e-6,
        "clutch by switching angles",
    );
    let law = |_: Place, input: &Value| -> Arc<dyn Law> { Arc::new(coulomb(number(&input["Q"]), 1.0)) };
    let point = operating_point(&file, Machine::Friction, &json!({"W": 300.0, "Q": 1.0}), &law);
    check_derivatives(&point, Settings::fixed(6), 0.05, 1e-6, "exact sign");
}

/// The drive over its friction torque.
struct OverTorque(Value);

impl SystemFamily for OverTorque {
    fn at(&self, torque: f64) -> Result<OperatingPoint, OutsideDomain> {
        let input = json!({"W": 300.0, "Q": torque});
        Ok(friction(&self.0, &input, Smoothing::Tanh, 0.5))
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

#[test]
fn derivative_with_respect_to_the_torque() {
    let file = nonsmooth_reference();
    let mut family = HarmonicBalance::new(Arc::new(OverTorque(file)), 1.0, fixed(6, 512)).unwrap();
    let z = unknowns(family.dimension(), 0.05);
    let found = evaluation(&mut family, &z, 1.0).by_parameter;
    // The residual is linear in the torque.
    let (low, high) = (
        evaluation(&mut family, &z, 0.5).residual,
        evaluation(&mut family, &z, 1.5).residual,
    );
    let largest = found.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    for i in 0..z.len() {
        assert!((found[i] - (high[i] - low[i])).abs() <= 1e-9 * largest);
    }
}

/// Residual of the full equations in all coordinates with the forces from `samples` points, relative to the load.
fn full_residual(point: &OperatingPoint, orbit: &HarmonicOrbit, samples: usize) -> f64 {
    let (system, n, harmonics) = (&point.system, point.system.order(), orbit.harmonics);
    let mut forces = vec![vec![Complex::new(0.0, 0.0); harmonics + 1]; n];
    for s in 0..samples {
        let turn = |k: usize| Complex::cis(TAU * (k * s % samples) as f64 / samples as f64);
        let value = |q: &Vec<Complex>| (0..=harmonics).map(|k| (q[k] * turn(k)).re).sum::<f64>();
        let rate = |q: &Vec<Complex>| {
            let term = |k: usize| (q[k] * turn(k) * Complex::new(0.0, k as f64 * point.frequency)).re;
            (0..=harmonics).map(term).sum::<f64>()
        };
        let displacements: Vec<f64> = orbit.coordinates.iter().map(value).collect();
        let rates = orbit.coordinates.iter().zip(&orbit.coordinate_drifts);
        let rates: Vec<f64> = rates.map(|(q, drift)| rate(q) + drift).collect();
        for element in &system.elements {
            let (u, v) = (element.port.project(&displacements), element.port.project(&rates));
            let force = element.law.response(u, v).force;
            for &(i, factor) in element.port.terms() {
                for (k, f) in forces[i].iter_mut().enumerate() {
                    let weight = if k == 0 { 1.0 } else { 2.0 };
                    *f += weight / samples as f64 * factor * force * turn(k).conj();
                }
            }
        }
    }
    let (mut largest, mut size) = (0.0_f64, 0.0_f64);
    for k in 0..=harmonics {
        let stiffness = system.dynamic_stiffness(k as f64 * point.frequency, point.frequency);
        let column: Vec<_> = orbit.coordinates.iter().map(|q| q[k]).collect();
        let mut residual = stiffness.times(&column);
        if k == 0 {
            let drag = system.damping_at(point.frequency).times(&orbit.coordinate_drifts);
            for (r, (drag, load)) in residual.iter_mut().zip(drag.iter().zip(&system.forcing.constant)) {
                *r += drag - load;
            }
        }
        for load in system.forcing.harmonics.iter().filter(|load| load.order == k) {
            for (r, (c, s)) in residual.iter_mut().zip(load.cosine.iter().zip(&load.sine)) {
                *r -= Complex::new(*c, -s);
                size = size.max(c.hypot(*s));
            }
        }
        for (r, f) in residual.iter().zip(&forces) {
            largest = largest.max((r + f[k]).norm());
        }
    }
    largest / size
}

#[test]
fn condensed_solutions_satisfy_the_full_equations() {
    let file = nonsmooth_reference();
    let arm = friction(&file, &json!({"W": 240.0, "Q": 1.2}), Smoothing::Tanh, 0.05);
    let smooth = Smoothed::new(one_way_damper(5.0), Smoothing::Tanh, 0.2);
    let accessory = clutch(&file, &json!({"W": 400.0, "Ml": 3.0}), smooth);
    for (point, what) in [(arm, "friction"), (accessory, "clutch")] {
        let solution = solve(&point, Start::Linear, &fixed(12, 512)).unwrap();
        assert_eq!(solution.stop, SolveStop::Converged, "{what}");
        let residual = full_residual(&point, &solution.orbit, 512);
        println!("{what}: {residual:.1e} in {} steps", solution.iterations);
        assert!(residual < 1e-11, "{what}: {residual:e}");
    }
}

#[test]
fn a_one_way_damper_lets_the_accessory_drift() {
    let file = nonsmooth_reference();
    let entry = periodic(&file, "viscous one-way");
    let damping = number(&entry["input"]["clutch"]["c"]);
    let point = clutch(&file, &entry["input"], one_way_damper(damping));
    // The torque has kinks, and the error falls with the third power of the harmonics.
    let solution = solve(&point, Start::Linear, &Settings::fixed(480)).unwrap();
    assert_eq!(solution.stop, SolveStop::Converged);
    let orbit = &solution.orbit;
    let measures = orbit.measures();
    for (index, rms) in entry["q"]["rms"].as_array().unwrap().iter().enumerate() {
        let Some(expected) = rms.as_f64() else { continue };
        let found = measures[index].rms;
        assert!(
            (found / expected - 1.0).abs() < 1e-6,
            "{index}: {found} {expected}"
        );
    }
    for (index, mean) in numbers(&entry["qdot"]["mean"]).iter().enumerate() {
        let found = orbit.coordinate_drifts[index];
        assert!((found - mean).abs() < 1e-6, "{index}: {found} {mean}");
    }
    let torque = point.system.output_index("clutch_torque").unwrap();
    let (found, expected) = (&measures[torque], &entry["element_force"]);
    for (found, key) in [(found.mean, "mean"), (found.rms, "rms"), (found.max, "max")] {
        let expected = number(&expected[key][0]);
        assert!((found / expected - 1.0).abs() < 2e-7, "{key}: {found} {expected}");
    }
    // The accessory overruns by the drift per period.
    let overrun = -orbit.drifts[0] * orbit.period();
    assert!((overrun / number(&entry["drift_per_period"]) - 1.0).abs() < 2e-7);
    let multipliers = orbit.stability().unwrap().multipliers;
    for (found, expected) in multipliers.iter().zip(numbers(&entry["floquet_moduli"])) {
        assert!((found.norm() - expected).abs() < 1e-6, "{found} {expected}");
    }
}

#[test]
fn mean_torque_is_the_load_without_accessory_damping() {
    let file = nonsmooth_reference();
    let input = json!({"W": 400.0, "Ml": 3.0, "c_accessory": 0.0});
    let smooth = Smoothed::new(one_way_damper(5.0), Smoothing::Tanh, 0.2);
    let point = clutch(&file, &input, smooth);
    let solution = solve(&point, Start::Linear, &fixed(12, 512)).unwrap();
    assert_eq!(solution.stop, SolveStop::Converged);
    assert!((solution.orbit.forces[0][0].re - 3.0).abs() < 1e-11);
}

#[test]
fn a_set_valued_clutch_is_told_to_be_one() {
    let file = nonsmooth_reference();
    let point = clutch(&file, &json!({"W": 400.0, "Ml": 3.0}), one_way());
    let error = solve(&point, Start::Linear, &Settings::fixed(5)).unwrap_err();
    assert!(error.to_string().contains("\"clutch\""), "{error}");
    assert!(matches!(
        error,
        HarmonicBalanceError::NotCovered { kind: "one-way", .. }
    ));
}

#[test]
fn too_few_samples_are_refused() {
    let file = nonsmooth_reference();
    let point = friction(&file, &json!({"W": 300.0, "Q": 1.0}), Smoothing::Tanh, 0.5);
    let settings = Settings {
        force_method: ForceMethod::Sampled,
        ..fixed(9, 37)
    };
    let error = solve(&point, Start::Linear, &settings).unwrap_err();
    assert!(matches!(
        error,
        HarmonicBalanceError::Setting { name: "samples", .. }
    ));
}
