//! Linear blocks of the reference file and what follows from the linear response (theory 02 §1.6–§1.9).

use crate::common::{WINDUP, bisect, maximize, nominal_system, record, shooting};
use serde_json::json;
use slackside_continuation::Options;
use slackside_dynamics::branch::{BranchOptions, SpecialKind, follow};
use slackside_linalg::{Complex, Matrix, eigenvalues};
use slackside_mechanics::{System, modes};
use slackside_testkit::{assert_close, nominal, number, numbers, reference};
use std::sync::Arc;

/// Stiffness with the clutch as a spring, or without it.
fn stiffness(system: &System, engaged: bool) -> Matrix {
    let mut stiffness = system.stiffness.clone();
    if engaged {
        let (spring, _) = system.elements[0].law.linearized();
        for (i, a) in [1.0, -1.0].into_iter().enumerate() {
            for (j, b) in [1.0, -1.0].into_iter().enumerate() {
                stiffness[(i, j)] += spring * a * b;
            }
        }
    }
    stiffness
}

/// `D(Ω)` of (C7): amplitude of the wind-up with the clutch engaged for good.
fn amplitude(system: &System, frequency: f64) -> Complex {
    let mut closed = system.clone();
    closed.stiffness = stiffness(system, true);
    let load = &system.forcing.harmonics[0];
    let right = [
        Complex::new(load.cosine[0], 0.0),
        Complex::new(load.cosine[1], 0.0),
    ];
    let q = closed
        .dynamic_stiffness(frequency, frequency)
        .lu()
        .unwrap()
        .solve(&right);
    q[0] - q[1]
}

fn state_eigenvalues(system: &System, engaged: bool) -> Vec<Complex> {
    let stiffness = stiffness(system, engaged);
    let mut a = Matrix::zeros(4, 4);
    for i in 0..2 {
        a[(i, 2 + i)] = 1.0;
        for j in 0..2 {
            a[(2 + i, j)] = -stiffness[(i, j)] / system.mass[(i, i)];
            a[(2 + i, 2 + j)] = -system.damping[(i, j)] / system.mass[(i, i)];
        }
    }
    eigenvalues(&a).unwrap()
}

#[test]
fn modes_damping_and_eigenvalues() {
    let file = reference("clutch_nominal.json");
    let expected = &file["linear"];
    let system = nominal_system();
    let found = modes(&system, 1.0, true).unwrap();
    let omega = numbers(&expected["engaged_omega"]);
    let stored: Vec<f64> = numbers(&expected["d_modal"]);
    for (j, mode) in found.iter().enumerate() {
        assert_close(mode.frequency, omega[j], 1e-14, "natural frequency");
        assert_close(mode.damping_ratio, 0.03, 1e-15, "damping ratio");
        // The file scales shapes so that the clutch deflects by a positive d.
        let d = mode.shape[0] - mode.shape[1];
        assert_close(d.abs(), stored[j], 1e-14, "deflection of the clutch");
        for i in 0..2 {
            let shape = numbers(&expected["Phi_rows_theta_p_theta_a"][i])[j];
            assert_close(mode.shape[i] * d.signum(), shape, 1e-14, "shape");
        }
    }
    for i in 0..2 {
        let row = numbers(&expected["C"][i]);
        for j in 0..2 {
            assert_close(system.damping[(i, j)], row[j], 1e-15, "damping matrix");
        }
    }
    for (engaged, key) in [
        (true, "engaged_state_eigenvalues"),
        (false, "disengaged_state_eigenvalues"),
    ] {
        let values = state_eigenvalues(&system, engaged);
        for value in expected[key].as_array().unwrap().iter().map(numbers) {
            let target = Complex::new(value[0], value[1]);
            let nearest = values
                .iter()
                .map(|v| (v - target).norm())
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-13, "{key}: {target} is missed by {nearest:.1e}");
        }
    }
    let open: Vec<f64> = modes(&system, 1.0, false)
        .unwrap()
        .iter()
        .map(|m| m.frequency)
        .collect();
    for (found, expected) in open.iter().zip(numbers(&expected["disengaged_undamped_omega"])) {
        assert_close(*found, expected, 1e-14, "open clutch");
    }
    // (C4)
    let sum = |f: &dyn Fn(f64, f64, f64) -> f64| -> f64 {
        found
            .iter()
            .map(|m| f(m.shape[0], m.shape[0] - m.shape[1], m.frequency.powi(2)))
            .sum()
    };
    assert_close(sum(&|p, d, _| p * d), 1.0, 1e-14, "(C4) first");
    assert_close(sum(&|_, d, l| d * d / l), 1.0 / 24.0, 1e-15, "(C4) second");
    assert_close(sum(&|p, d, l| p * d / l), 0.0, 1e-15, "(C4) third");
}

#[test]
fn response_without_separation_by_matrices_and_by_motion() {
    let file = reference("clutch_nominal.json");
    for row in file["linear"]["response"].as_array().unwrap() {
        let frequency = number(&row["Omega"]);
        let (size, phase) = (number(&row["delta_amplitude"]), number(&row["delta_phase_rad"]));
        let label = format!("Ω = {frequency}");
        let found = amplitude(&nominal_system(), frequency);
        assert_close(found.norm(), size, 1e-15, &label);
        assert_close(found.arg(), phase, 1e-13, &label);
        // A preload of three keeps the clutch engaged at all frequencies and leaves the amplitude alone.
        let system = Arc::new(nominal(&json!({ "M": 3.0 })).system().unwrap());
        let orbit = shooting(&system, frequency, 1)
            .solve(&[0.0, -0.125, 0.0, 0.0], frequency)
            .unwrap();
        let motion = record(&system, frequency, &orbit.start, 1, 2, 0);
        assert!(motion.events.is_empty() && orbit.is_stable(), "{label}");
        let harmonics = &motion.measures[WINDUP].harmonics;
        assert!((harmonics[1] - found).norm() < 1e-14, "{label}: {}", harmonics[1]);
        assert!(harmonics[2].norm() < 1e-14, "{label}");
        assert_close(harmonics[0].re, 0.125, 1e-15, &label);
    }
}

#[test]
fn onset_of_separation_by_the_linear_response_and_by_grazing_points_of_branches() {
    let file = reference("clutch_nominal.json");
    let expected = numbers(&file["separation_onset"]["Omega"]);
    let system = nominal_system();
    let brackets = [(0.7, 0.97), (0.99, 1.3), (5.0, 6.37), (6.38, 8.0)];
    for (onset, (low, high)) in expected.iter().zip(brackets) {
        let found = bisect(low, high, &mut |w| amplitude(&system, w).norm() - 1.0 / 24.0);
        assert_close(found, *onset, 2e-15, "|D| = δ_s");
    }
    let mut grazing = Vec::new();
    for (from, to) in [(8.5, 3.6), (1.5, 0.55)] {
        let mut shooting = shooting(&system, from, 1);
        let start = shooting.solve(&[0.0, -1.0 / 24.0, 0.0, 0.0], from).unwrap().start;
        let options = BranchOptions {
            continuation: Options::over(to, from),
            direction: -1.0,
        };
        let branch = follow(&mut shooting, &start, from, &options, &mut |_| true);
        grazing.extend(branch.special_parameters(SpecialKind::Grazing));
    }
    for onset in &expected {
        let nearest = grazing
            .iter()
            .map(|w| (w - onset).abs())
            .fold(f64::INFINITY, f64::min);
        assert!(
            nearest < 3e-11,
            "grazing point at {onset} is missed by {nearest:.1e}"
        );
    }
}

#[test]
fn smallest_preload_without_separation_at_any_frequency() {
    // theory 02 §1.9: M > K_d max |D(Ω)|, nominal 2.625637136.
    let system = nominal_system();
    let (at, largest) = [(0.9, 1.1), (6.0, 7.0)]
        .map(|(low, high)| maximize(low, high, &mut |w| amplitude(&system, w).norm()))
        .into_iter()
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap();
    let preload = 24.0 * largest;
    assert_close(preload, 2.625637136, 5e-10, "preload");
    for (factor, events) in [(1.0 + 1e-9, 0), (1.0 - 1e-9, 2)] {
        let changed = json!({ "M": preload * factor });
        let system = Arc::new(nominal(&changed).system().unwrap());
        let guess = [0.0, -preload / 24.0, 0.0, 0.0];
        let start = shooting(&system, at, 1).solve(&guess, at).unwrap().start;
        assert_eq!(record(&system, at, &start, 1, 0, 0).events.len(), events);
    }
}
