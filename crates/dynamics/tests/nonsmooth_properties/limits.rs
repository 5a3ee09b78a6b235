//! Limits in which the motion is known otherwise (theory 05 §9).

use crate::random_systems::{ARM, Kind, Random, add, add_clutch, bare, difference, point, rms, solve};
use slackside_linalg::{Complex, Matrix};
use slackside_mechanics::System;
use slackside_mechanics::laws::{Decoupler, coulomb, one_way, one_way_damper};

const SYSTEMS: u64 = 20;

/// RMS values of coordinates and rates of the linear system whose coordinates are `basis · y`.
fn linear_rms(system: &System, frequency: f64, basis: &Matrix) -> Vec<f64> {
    let n = system.order();
    let mut squares = vec![0.0; 2 * n];
    for harmonic in &system.forcing.harmonics {
        let omega = harmonic.order as f64 * frequency;
        let full = system.dynamic_stiffness(omega, frequency);
        let m = basis.columns();
        let mut reduced = slackside_linalg::ComplexMatrix::zeros(m, m);
        let mut load = vec![Complex::ZERO; m];
        for a in 0..m {
            for i in 0..n {
                load[a] += Complex::new(harmonic.cosine[i], -harmonic.sine[i]) * basis[(i, a)];
                for j in 0..n {
                    for b in 0..m {
                        reduced[(a, b)] += full[(i, j)] * (basis[(i, a)] * basis[(j, b)]);
                    }
                }
            }
        }
        let y = reduced.lu().unwrap().solve(&load);
        for i in 0..n {
            let amplitude: Complex = (0..m).map(|a| y[a] * basis[(i, a)]).sum();
            squares[i] += 0.5 * amplitude.norm_sqr();
            squares[n + i] += 0.5 * amplitude.norm_sqr() * omega * omega;
        }
    }
    squares.iter().map(|square| square.sqrt()).collect()
}

/// A basis of all coordinates but some that are zero, or equal to another one.
fn basis(n: usize, columns: &[&[usize]]) -> Matrix {
    let mut basis = Matrix::zeros(n, columns.len());
    for (a, coordinates) in columns.iter().enumerate() {
        for &i in *coordinates {
            basis[(i, a)] = 1.0;
        }
    }
    basis
}

#[test]
fn strong_friction_holds_the_arm() {
    for seed in 0..SYSTEMS {
        let mut random = Random::new(seed);
        let (mut system, frequency) = bare(&mut random, Kind::FRICTION);
        let n = system.order();
        let columns: Vec<Vec<usize>> = (1..n).map(|i| vec![i]).collect();
        let columns: Vec<&[usize]> = columns.iter().map(Vec::as_slice).collect();
        let expected = linear_rms(&system, frequency, &basis(n, &columns));
        add(&mut system, "arm", &[(ARM, 1.0)], coulomb(100.0, 1.0));
        let point = point(system, frequency);
        let (motion, record) = solve(&point);
        assert!(record.events.is_empty() && motion.stuck == [0], "seed {seed}");
        let found = difference(&rms(&point, &record), &expected);
        assert!(found < 1e-11, "seed {seed}: {found:e}");
    }
}

#[test]
fn a_heavily_loaded_clutch_stays_locked() {
    for seed in 0..SYSTEMS {
        let mut random = Random::new(seed);
        let (mut system, frequency) = bare(&mut random, Kind::CLUTCH);
        let n = system.order();
        let mut columns: Vec<Vec<usize>> = (0..n - 2).map(|i| vec![i]).collect();
        columns.push(vec![n - 2, n - 1]);
        let columns: Vec<&[usize]> = columns.iter().map(Vec::as_slice).collect();
        let mut expected = linear_rms(&system, frequency, &basis(n, &columns));
        // The angle of the accessory is cyclic.
        expected.remove(n - 1);
        add_clutch(&mut system, 200.0, one_way());
        let point = point(system, frequency);
        let (_, record) = solve(&point);
        assert!(record.events.is_empty(), "seed {seed}");
        let found = difference(&rms(&point, &record), &expected);
        assert!(found < 1e-11, "seed {seed}: {found:e}");
    }
}

#[test]
fn weak_friction_tends_linearly_to_none() {
    for seed in 0..SYSTEMS {
        let distance = |torque: f64| {
            let mut random = Random::new(seed);
            let (mut system, frequency) = bare(&mut random, Kind::FRICTION);
            let columns: Vec<Vec<usize>> = (0..system.order()).map(|i| vec![i]).collect();
            let columns: Vec<&[usize]> = columns.iter().map(Vec::as_slice).collect();
            let free = linear_rms(&system, frequency, &basis(system.order(), &columns));
            add(&mut system, "arm", &[(ARM, 1.0)], coulomb(torque, 1.0));
            let point = point(system, frequency);
            difference(&rms(&point, &solve(&point).1), &free)
        };
        let ratio = distance(1e-5) / distance(1e-6);
        assert!((ratio - 10.0).abs() < 0.01, "seed {seed}: {ratio}");
    }
}

#[test]
fn stiff_decouplers_and_strong_one_way_dampers_are_clutches() {
    for seed in 0..4 {
        let with = |law: &dyn Fn(&mut System, f64)| {
            let mut random = Random::new(seed);
            let (mut system, frequency) = bare(&mut random, Kind::CLUTCH);
            law(&mut system, random.between(0.1, 0.5));
            let point = point(system, frequency);
            rms(&point, &solve(&point).1)
        };
        let clutch = with(&|system, load| add_clutch(system, load, one_way()));
        let damper = |damping: f64| {
            let found = with(&|system, load| add_clutch(system, load, one_way_damper(damping)));
            difference(&found, &clutch)
        };
        let (coarse, fine) = (damper(1e4), damper(1e5));
        assert!(
            (coarse / fine - 10.0).abs() < 0.2,
            "seed {seed}: {coarse:e} {fine:e}"
        );
        let decoupler = |stiffness: f64| {
            let law = Decoupler::new(stiffness, 0.0, 0.0).unwrap();
            difference(&with(&|system, load| add_clutch(system, load, law)), &clutch)
        };
        let (coarse, fine) = (decoupler(1e4), decoupler(1e6));
        assert!(
            fine < 1e-3 && fine < 0.2 * coarse,
            "seed {seed}: {coarse:e} {fine:e}"
        );
    }
}
