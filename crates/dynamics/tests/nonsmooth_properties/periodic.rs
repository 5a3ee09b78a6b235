//! Properties of periodic motions (theory 05 §2.1).

use crate::random_systems::{
    ARM, Kind, Random, add, add_clutch, bare, difference, output, point, rms, solve, solve_from,
};
use slackside_mechanics::laws::{coulomb, one_way, one_way_damper};
use slackside_mechanics::{Harmonic, OperatingPoint};

/// Number of random systems of each test.
const SYSTEMS: u64 = 40;

/// Clutch and friction together.
fn clutch_and_friction(seed: u64, scale: f64) -> OperatingPoint {
    let mut random = Random::new(seed);
    let (mut system, frequency) = bare(&mut random, Kind::CLUTCH);
    let (load, friction) = (random.between(0.05, 1.0), random.between(0.02, 0.6));
    add_clutch(&mut system, load, one_way());
    // Only the friction law holds the load's scale; the clutch is conical.
    add(
        &mut system,
        "friction",
        &[(ARM, 1.0)],
        coulomb(friction * scale, 1.0),
    );
    for value in &mut system.forcing.constant {
        *value *= scale;
    }
    for Harmonic { cosine, sine, .. } in &mut system.forcing.harmonics {
        cosine.iter_mut().chain(sine).for_each(|value| *value *= scale);
    }
    point(system, frequency)
}

#[test]
fn the_energy_of_a_cycle_is_balanced() {
    let mut events = 0;
    for seed in 0..SYSTEMS {
        let point = clutch_and_friction(seed, 1.0);
        let (motion, record) = solve(&point);
        let account = record.account.unwrap();
        events += motion.events;
        assert!(account.imbalance() < 1e-10, "seed {seed}: {account:?}");
        // A clutch dissipates nothing, friction does and gives nothing back; nothing is stored over a cycle.
        assert!(
            account.elements[0].work.abs() < 1e-10 * account.load,
            "seed {seed}"
        );
        assert!(account.elements[1].work > -1e-12 * account.load, "seed {seed}");
        assert!(account.stored.abs() < 1e-10 * account.load, "seed {seed}");
    }
    // The systems are such that things happen.
    assert!(events > 4 * SYSTEMS as usize, "{events}");
}

#[test]
fn the_response_is_homogeneous_in_all_loads_together() {
    let factor = 3.7;
    for seed in 0..SYSTEMS {
        let (one, other) = (clutch_and_friction(seed, 1.0), clutch_and_friction(seed, factor));
        let (a, b) = (solve(&one).1, solve(&other).1);
        assert_eq!(a.events.len(), b.events.len(), "seed {seed}");
        for (a, b) in a.events.iter().zip(&b.events) {
            assert_eq!(
                (a.element, a.from, a.to),
                (b.element, b.from, b.to),
                "seed {seed}"
            );
            assert!((a.phase - b.phase).abs() < 1e-10, "seed {seed}: {a:?} {b:?}");
        }
        let scaled: Vec<f64> = rms(&one, &a).iter().map(|value| factor * value).collect();
        let found = difference(&rms(&other, &b), &scaled);
        assert!(found < 1e-10, "seed {seed}: {found:e}");
    }
}

#[test]
fn symmetric_friction_has_no_even_harmonics_and_clutches_do() {
    for seed in 0..SYSTEMS {
        let mut random = Random::new(seed);
        let (mut system, frequency) = bare(&mut random, Kind::FRICTION);
        add(
            &mut system,
            "arm",
            &[(ARM, 1.0)],
            coulomb(random.between(0.05, 0.8), 1.0),
        );
        let point = point(system, frequency);
        let (_, record) = solve(&point);
        for measure in &record.measures {
            let size = measure.harmonics[1].norm().max(1e-3);
            for even in measure.harmonics.iter().step_by(2) {
                assert!(even.norm() < 1e-12 * size, "seed {seed}: {even} of {size}");
            }
        }
    }
    // A law that is not odd has even harmonics under the same loads. (Friction that only differs between the directions has
    // none: it is symmetric friction and a constant load.)
    let mut random = Random::new(1);
    let (mut system, frequency) = bare(&mut random, Kind::FRICTION);
    add(&mut system, "arm", &[(ARM, 1.0)], one_way_damper(0.5));
    let (_, record) = solve(&point(system, frequency));
    assert!(record.measures[ARM].harmonics[2].norm() > 1e-4);
}

#[test]
fn five_random_starts_lead_to_one_motion() {
    for seed in 0..SYSTEMS / 2 {
        let point = clutch_and_friction(seed, 1.0);
        let cyclic = point.system.cyclic_coordinates();
        let mut random = Random::new(1000 + seed);
        let reached: Vec<Vec<f64>> = (0..5)
            .map(|_| {
                let start = random.vector(2 * point.system.order(), 5.0);
                let mut state = solve_from(&point, &start).0.start;
                for &i in &cyclic {
                    state[i] = 0.0;
                }
                state
            })
            .collect();
        let (first, others) = reached.split_first().unwrap();
        let stuck = solve(&point).0.stuck;
        for other in others {
            let found = difference(other, first);
            assert!(found < 1e-10, "seed {seed}: {found:e}, stuck {stuck:?}");
        }
    }
}

#[test]
fn the_mean_torque_of_a_clutch_is_the_load() {
    for seed in 0..SYSTEMS {
        let mut random = Random::new(seed);
        let kind = Kind {
            accessory_damping: false,
            ..Kind::CLUTCH
        };
        let (mut system, frequency) = bare(&mut random, kind);
        let load = random.between(0.1, 1.0);
        add_clutch(&mut system, load, one_way());
        let point = point(system, frequency);
        let (_, record) = solve(&point);
        let mean = record.measures[output(&point, "clutch")].mean;
        assert!((mean - load).abs() < 1e-11 * load, "seed {seed}: {mean} {load}");
    }
    // With damping of the accessory, and any one-way law: the load and the mean drag (theory 05 §2.1).
    for seed in 0..SYSTEMS {
        let mut random = Random::new(seed);
        let (mut system, frequency) = bare(&mut random, Kind::CLUTCH);
        let load = random.between(0.1, 1.0);
        add_clutch(&mut system, load, one_way_damper(5.0));
        let (accessory, _) = Kind::CLUTCH.accessory_and_pulley(&system);
        let drag = system.damping[(accessory, accessory)];
        let point = point(system, frequency);
        let (_, record) = solve(&point);
        let mean = record.measures[output(&point, "clutch")].mean;
        let expected = load + drag * record.measures[output(&point, "accessory.rate")].mean;
        assert!(
            (mean - expected).abs() < 1e-11 * load,
            "seed {seed}: {mean} {expected}"
        );
    }
}

#[test]
fn shares_of_time_add_up_and_a_drift_is_the_mean_rate() {
    for seed in 0..SYSTEMS {
        let point = clutch_and_friction(seed, 1.0);
        let (_, record) = solve(&point);
        for shares in &record.fractions {
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-13, "seed {seed}");
        }
        let (accessory, _) = Kind::CLUTCH.accessory_and_pulley(&point.system);
        let period = std::f64::consts::TAU / point.frequency;
        let mean = record.measures[output(&point, "accessory.rate")].mean;
        let size = record.measures[output(&point, "accessory.rate")].rms.max(1e-6);
        let difference = record.drift[accessory] / period - mean;
        assert!(difference.abs() < 1e-11 * size, "seed {seed}: {difference:e}");
        assert!(mean > -1e-11 * size, "the accessory overruns, seed {seed}");
    }
}
