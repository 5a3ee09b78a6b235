//! Properties of motions from arbitrary states.

use crate::random_systems::{ARM, Kind, Random, add, add_clutch, bare, difference, output, point};
use slackside_dynamics::flow::{ExactFlow, Flow, Record, Request};
use slackside_linalg::{Matrix, dot};
use slackside_mechanics::laws::{
    Decoupler, HysteresisLoop, asymmetric_coulomb, coulomb, damped_stop, one_way, rigid_stop, spring_slider,
};
use slackside_mechanics::{OperatingPoint, System};

const SYSTEMS: u64 = 30;

/// Clutch and friction together, by a seed.
fn clutch_and_friction(seed: u64) -> (OperatingPoint, Random) {
    let mut random = Random::new(seed);
    let (mut system, frequency) = bare(&mut random, Kind::CLUTCH);
    add_clutch(&mut system, random.between(0.05, 1.0), one_way());
    add(
        &mut system,
        "friction",
        &[(ARM, 1.0)],
        coulomb(random.between(0.02, 0.6), 1.0),
    );
    (point(system, frequency), random)
}

/// A state in which the accessory is not slower than its pulley.
fn start(point: &OperatingPoint, random: &mut Random) -> Vec<f64> {
    let n = point.system.order();
    let mut state = random.vector(2 * n, 3.0);
    state[2 * n - 1] = state[2 * n - 1].max(state[2 * n - 2] + 0.1);
    state.resize(2 * n + point.system.internal_states(), 0.0);
    state
}

fn run(point: &OperatingPoint, start: &[f64], periods: usize, samples: usize) -> (Vec<f64>, Record) {
    let mut state = start.to_vec();
    let request = Request {
        samples,
        extremes: true,
        account: true,
        ..Request::default()
    };
    let record = ExactFlow::new(point)
        .unwrap()
        .record(&mut state, periods, &point.system.outputs, &request)
        .unwrap();
    (state, record)
}

#[test]
fn two_motions_never_part() {
    for seed in 0..SYSTEMS {
        let (point, mut random) = clutch_and_friction(seed);
        let n = point.system.order();
        let starts = [start(&point, &mut random), start(&point, &mut random)];
        let records = starts.map(|start| run(&point, &start, 6, 200).1);
        // The outputs begin with coordinates and rates; the accessory's angle stores no energy.
        let distance = |k: usize| {
            let d: Vec<f64> = (0..2 * n)
                .map(|i| records[0].samples[i][k] - records[1].samples[i][k])
                .collect();
            let energy = |matrix: &Matrix, d: &[f64]| 0.5 * dot(d, &matrix.times(d));
            energy(&point.system.stiffness, &d[..n]) + energy(&point.system.mass, &d[n..])
        };
        let first = distance(0);
        let mut last = first;
        for k in 1..6 * 200 {
            let now = distance(k);
            assert!(
                now <= last + 1e-12 * first,
                "seed {seed}, sample {k}: {last:e} {now:e}"
            );
            last = now;
        }
        assert!(last < 0.9 * first, "seed {seed}");
    }
}

#[test]
fn derivatives_of_the_map_are_those_of_differences() {
    let mut events = 0;
    for seed in 0..SYSTEMS {
        let (point, mut random) = clutch_and_friction(seed);
        let x = start(&point, &mut random);
        let nx = x.len();
        let mut flow = ExactFlow::new(&point).unwrap();
        let mut variations = Matrix::identity(nx).as_slice().to_vec();
        let mut end = x.clone();
        events += flow.advance(&mut end, 2, &mut variations).unwrap();
        let mut moved = |j: usize, by: f64| {
            let mut state = x.clone();
            state[j] += by;
            flow.advance(&mut state, 2, &mut []).unwrap();
            state
        };
        for j in 0..nx {
            let h = 1e-4;
            let pairs = [1.0, 2.0].map(|k| (moved(j, k * h), moved(j, -k * h)));
            let column: Vec<f64> = (0..nx)
                .map(|i| {
                    let of = |k: usize| pairs[k].0[i] - pairs[k].1[i];
                    (8.0 * of(0) - of(1)) / (12.0 * h)
                })
                .collect();
            let computed = &variations[j * nx..(j + 1) * nx];
            let size = column.iter().fold(0.0_f64, |a, v| a.max(v.abs())).max(0.1);
            let found = difference(computed, &column) * size.min(1.0);
            assert!(found < 1e-7, "seed {seed}, column {j}: {found:e}");
        }
    }
    assert!(events > 4 * SYSTEMS as usize, "{events}");
}

/// The same system with an idle coordinate of its own that is so fast that steps become a small fraction.
fn with_short_steps(point: &OperatingPoint, factor: f64) -> OperatingPoint {
    let old = &point.system;
    let n = old.order();
    // The highest natural frequency is below the square root of the norm of the stiffness, and the clutch adds none.
    let fast = (factor * 4.0 * (1.0 + old.stiffness.norm_infinity())).powi(2);
    let widened = |matrix: &Matrix, corner: f64| {
        let mut result = Matrix::zeros(n + 1, n + 1);
        for i in 0..n {
            result.row_mut(i)[..n].copy_from_slice(matrix.row(i));
        }
        result[(n, n)] = corner;
        result
    };
    let mut system = System {
        mass: widened(&old.mass, 1.0),
        damping: widened(&old.damping, 0.0),
        stiffness: widened(&old.stiffness, fast),
        ..(**old).clone()
    };
    system.coordinates.push("idle".into());
    system.forcing.constant.push(0.0);
    for harmonic in &mut system.forcing.harmonics {
        harmonic.cosine.push(0.0);
        harmonic.sine.push(0.0);
    }
    crate::random_systems::point(system, point.frequency)
}

#[test]
fn events_do_not_depend_on_the_steps() {
    let mut events = 0;
    for seed in 0..SYSTEMS {
        let (point, mut random) = clutch_and_friction(seed);
        let n = point.system.order();
        let x = start(&point, &mut random);
        let (end, record) = run(&point, &x, 5, 0);
        let mut wide = x[..n].to_vec();
        wide.push(0.0);
        wide.extend(&x[n..]);
        wide.push(0.0);
        let (fine_end, fine) = run(&with_short_steps(&point, 5.0), &wide, 5, 0);
        assert_eq!(record.events.len(), fine.events.len(), "seed {seed}");
        for (a, b) in record.events.iter().zip(&fine.events) {
            assert_eq!(
                (a.element, a.from, a.to),
                (b.element, b.from, b.to),
                "seed {seed}"
            );
            assert!((a.phase - b.phase).abs() < 1e-10, "seed {seed}: {a:?} {b:?}");
        }
        let mut without = fine_end[..n].to_vec();
        without.extend(&fine_end[n + 1..2 * n + 1]);
        let found = difference(&without, &end);
        assert!(found < 1e-10, "seed {seed}: {found:e}");
        events += record.events.len();
    }
    assert!(events > 10 * SYSTEMS as usize, "{events}");
}

/// Systems with each law in turn, by a seed.
fn with_law(seed: u64, law: usize) -> (OperatingPoint, Random) {
    let mut random = Random::new(seed);
    let clutched = matches!(law, 0..=2);
    let kind = if clutched { Kind::CLUTCH } else { Kind::FRICTION };
    let (mut system, frequency) = bare(&mut random, kind);
    let (a, b) = (random.between(0.1, 0.6), random.between(0.1, 0.6));
    let arm = &[(ARM, 1.0)];
    match law {
        0 => add_clutch(&mut system, a, Decoupler::new(20.0, 0.0, 0.0).unwrap()),
        1 => add_clutch(&mut system, a, Decoupler::new(20.0, 0.0, b).unwrap()),
        2 => add_clutch(&mut system, a, Decoupler::new(20.0, 0.5, 0.0).unwrap()),
        3 => add(&mut system, "law", arm, asymmetric_coulomb(a, b, 1.3)),
        4 => add(&mut system, "law", arm, spring_slider(10.0, a)),
        5 => {
            let points = vec![-0.3, 0.1, 0.4];
            let loop_ = HysteresisLoop::new(points, vec![a, 1.5 * a, 2.0 * a], vec![-b, 0.0, 0.5 * a]);
            add(&mut system, "law", arm, loop_.unwrap());
        }
        6 => add(&mut system, "law", arm, rigid_stop(0.3 * a, b)),
        7 => add(&mut system, "law", arm, damped_stop(0.3 * a, 50.0, 1.0)),
        other => panic!("no law {other}"),
    }
    (point(system, frequency), random)
}

#[test]
fn every_run_has_its_energy_accounted_for() {
    for law in 0..=7 {
        let mut events = 0;
        for seed in 0..SYSTEMS / 2 {
            let (point, mut random) = with_law(seed, law);
            let mut x = random.vector(2 * point.system.order(), 0.5);
            if law > 2 {
                // Not beyond the stop.
                x[ARM] = -x[ARM].abs();
            } else {
                let n = point.system.order();
                x[2 * n - 1] = x[2 * n - 2] + 0.1;
            }
            x.resize(x.len() + point.system.internal_states(), 0.0);
            let (_, record) = run(&point, &x, 8, 0);
            let account = record.account.unwrap();
            events += record.events.len();
            assert!(account.imbalance() < 1e-9, "law {law}, seed {seed}: {account:?}");
            assert!(account.elements[0].impact_loss >= 0.0, "law {law}, seed {seed}");
        }
        assert!(events > 3 * SYSTEMS as usize, "law {law}: {events}");
    }
}

#[test]
fn forces_and_displacements_keep_within_their_bounds() {
    for seed in 0..SYSTEMS / 2 {
        for (law, low, high) in [(4, -1.0, 1.0), (6, 0.0, f64::INFINITY), (7, 0.0, f64::INFINITY)] {
            let (point, mut random) = with_law(seed, law);
            let torque = Random::first(seed, Kind::FRICTION);
            let mut x = random.vector(2 * point.system.order(), 0.5);
            x[ARM] = -x[ARM].abs();
            x.resize(x.len() + point.system.internal_states(), 0.0);
            let (_, record) = run(&point, &x, 8, 0);
            let force = &record.measures[output(&point, "law")];
            let slack = 1e-12 * (force.max.abs() + 1.0);
            assert!(
                force.min >= low * torque - slack,
                "law {law}, seed {seed}: {force:?}"
            );
            assert!(
                force.max <= high * torque + slack,
                "law {law}, seed {seed}: {force:?}"
            );
            if law == 6 {
                let largest = record.measures[ARM].max;
                assert!(largest <= 0.3 * torque + 1e-12, "seed {seed}: {largest}");
            }
        }
    }
}
