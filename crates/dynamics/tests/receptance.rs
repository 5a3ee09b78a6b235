//! Receptances, poles and the certificate of uniqueness against the nonsmooth reference and on random systems.

use serde_json::{Value, json};
use slackside_dynamics::receptance::{Doubt, LinearSystem, Mobility, Uniqueness, uniqueness};
use slackside_linalg::{Complex, Matrix};
use slackside_mechanics::laws::{Isolator, coulomb, one_way, stop};
use slackside_mechanics::{Element, Forcing, Harmonic, Law, OperatingPoint, Port, System};
use slackside_testkit::nonsmooth_reference::{Machine, Place, nonsmooth_reference, operating_point};
use slackside_testkit::{assert_close, number, numbers};
use std::sync::Arc;

fn law(place: Place, _: &Value) -> Arc<dyn Law> {
    match place {
        Place::Clutch => Arc::new(one_way()),
        Place::Arm => Arc::new(coulomb(1.0, 1.0)),
    }
}

fn point(file: &Value, machine: Machine, input: &Value) -> OperatingPoint {
    operating_point(file, machine, input, &law)
}

/// Poles that the reference lists: one of each pair, by rising imaginary part.
fn assert_poles(found: &[Complex], expected: &Value, what: &str) {
    let expected: Vec<Complex> = (expected.as_array().unwrap().iter())
        .map(|pole| Complex::new(number(&pole[0]), number(&pole[1])))
        .collect();
    let upper: Vec<&Complex> = found.iter().filter(|pole| pole.im > 0.0).collect();
    assert_eq!(upper.len(), expected.len(), "{what}");
    for (found, expected) in upper.iter().zip(&expected) {
        assert!(
            (*found - expected).norm() < 1e-10 * expected.norm(),
            "{what}: {found} {expected}"
        );
    }
}

#[test]
fn receptances_and_poles_agree_with_the_reference() {
    let file = nonsmooth_reference();
    let entries = file["receptance"].as_array().unwrap();
    assert_eq!(entries.len(), 2);
    for entry in entries {
        let frequency = number(&entry["input"]["W"]);
        let arm = point(&file, Machine::Friction, &entry["input"]);
        let open = LinearSystem::new(&arm.system, &[0]).unwrap();
        for (k, expected) in entry["R"].as_array().unwrap().iter().enumerate() {
            let found = open.receptance(k as f64 * frequency, frequency).unwrap()[(0, 0)];
            let expected = numbers(expected);
            let difference = found - Complex::new(expected[0], expected[1]);
            assert!(
                difference.norm() < 1e-11 * found.norm(),
                "R_{k} at {frequency}: {difference}"
            );
        }
        // The accessory locked to its pulley: as a system of twelve coordinates, and by locking the clutch's port.
        assert_poles(&open.poles(frequency).unwrap(), &entry["poles_locked"], "merged");
        let clutch = point(&file, Machine::Clutch, &entry["input"]);
        let locked = LinearSystem::new(&clutch.system, &[0]).unwrap().locked().unwrap();
        assert_poles(
            &locked.poles(frequency).unwrap(),
            &entry["poles_locked"],
            "port locked",
        );
        // Re Y grows like ω² from zero; the reference gives its smallest value from 1 rad/s on.
        let mobility = Mobility::new(&open, frequency).unwrap();
        let found = mobility.smallest_real_part(1.0, 2e4).unwrap();
        assert_close(
            found.minimum / number(&entry["min_real_mobility"]),
            1.0,
            1e-8,
            "smallest real mobility",
        );
        assert_eq!(found.omega, 1.0);
        assert!(found.lower_bound <= found.minimum && found.lower_bound > 0.999 * found.minimum);
        assert_eq!(mobility.is_positive_real().unwrap().0, Some(true));
    }
}

#[test]
fn velocity_laws_on_the_reference_drive_have_a_unique_response() {
    let file = nonsmooth_reference();
    for machine in [Machine::Friction, Machine::Clutch] {
        let at = point(&file, machine, &json!({ "W": 300.0, "Ml": 3.0 }));
        assert_eq!(uniqueness(&at).unwrap(), Uniqueness::Energy);
    }
    // Without damping of the accessory a free rate remains, and less is proved.
    let at = point(
        &file,
        Machine::Clutch,
        &json!({ "W": 300.0, "Ml": 3.0, "c_accessory": 0.0 }),
    );
    let found = uniqueness(&at).unwrap();
    assert_eq!(found, Uniqueness::EnergyWithoutFullDamping);
    assert!(!found.is_unique() && found.excludes_jumps());
}

/// A deterministic stream of numbers in `(−1, 1)`.
struct Stream(u64);

impl Stream {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn matrix(&mut self, n: usize) -> Matrix {
        let rows: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| self.next()).collect()).collect();
        Matrix::from_rows(&rows).unwrap()
    }

    /// `AᵀA + floor`.
    fn positive(&mut self, n: usize, floor: f64) -> Matrix {
        let a = self.matrix(n);
        let mut result = a.transpose().product(&a);
        result.add_scaled(floor, &Matrix::identity(n));
        result
    }

    fn skew(&mut self, n: usize) -> Matrix {
        let a = self.matrix(n);
        let mut result = a.clone();
        result.add_scaled(-1.0, &a.transpose());
        result
    }

    /// A gyroscopic system with damping and two ports.
    fn system(&mut self, n: usize) -> System {
        let mut damping = self.positive(n, 0.02).scaled(0.1);
        damping.add_scaled(0.7, &self.skew(n));
        let mut forcing = Forcing::none(n);
        for order in [1, 3] {
            forcing.add_harmonic(Harmonic {
                order,
                cosine: (0..n).map(|_| self.next()).collect(),
                sine: (0..n).map(|_| self.next()).collect(),
            });
        }
        forcing.constant = (0..n).map(|_| self.next()).collect();
        System {
            coordinates: (0..n).map(|i| format!("x{i}")).collect(),
            mass: self.positive(n, 0.5),
            damping,
            stiffness: self.positive(n, 0.3),
            damping_linear_in_frequency: Some(self.skew(n)),
            stiffness_quadratic_in_frequency: None,
            forcing,
            elements: vec![
                Element::new("first", Port::new([(0, 1.0), (1, -2.0)]), coulomb(1.0, 1.0)),
                Element::new("second", Port::new([(1, 0.5), (2, 1.0)]), coulomb(1.0, 1.0)),
            ],
            outputs: vec![],
        }
    }
}

#[test]
fn constraint_forces_keep_the_ports_at_rest() {
    let mut stream = Stream(3);
    for n in [3, 5, 8] {
        for frequency in [0.4, 1.3] {
            let system = stream.system(n);
            let open = LinearSystem::new(&system, &[0, 1]).unwrap();
            let mut locked = open.locked().unwrap();
            for (place, order) in [(0, 1), (1, 3)] {
                let mut forces = [Complex::ZERO; 2];
                locked.force_of(place, frequency, &mut forces).unwrap();
                // u_lin − R f must vanish at both ports (5.1).
                let omega = f64::from(order) * frequency;
                let receptance = open.receptance(omega, frequency).unwrap();
                let displacements = open.open_displacements(order as usize, frequency).unwrap();
                for i in 0..2 {
                    let moved: Complex = (0..2).map(|j| receptance[(i, j)] * forces[j]).sum();
                    assert!((displacements[i] - moved).norm() < 1e-11 * displacements[i].norm());
                }
                let response = locked.response_of(place, frequency).unwrap();
                for element in &system.elements {
                    let moved: Complex = (element.port.terms().iter()).map(|&(i, b)| b * response[i]).sum();
                    assert!(moved.norm() < 1e-13);
                }
            }
            // The static stiffness of the ports is the inverse of their static receptance.
            let product = locked.static_stiffness(frequency).unwrap();
            let receptance = open.receptance(0.0, frequency).unwrap();
            for i in 0..2 {
                for j in 0..2 {
                    let entry: f64 = (0..2).map(|k| product[(i, k)] * receptance[(k, j)].re).sum();
                    assert_close(entry, f64::from(u8::from(i == j)), 1e-11, "k_eff R_0");
                }
            }
        }
    }
}

#[test]
fn force_rates_by_inertia_agree_with_differences() {
    let mut stream = Stream(11);
    let system = stream.system(5);
    let frequency = 0.9;
    let forces = |inertia: f64| {
        let mut changed = system.clone();
        changed.mass[(1, 1)] += inertia;
        let mut locked = LinearSystem::new(&changed, &[0, 1]).unwrap().locked().unwrap();
        let mut forces = [Complex::ZERO; 2];
        locked.force_of(1, frequency, &mut forces).unwrap();
        forces
    };
    let step = 1e-5;
    let (above, below) = (forces(step), forces(-step));
    let mut locked = LinearSystem::new(&system, &[0, 1]).unwrap().locked().unwrap();
    let mut rates = [Complex::ZERO; 2];
    locked.force_rate_by_inertia(1, 1, frequency, &mut rates).unwrap();
    for port in 0..2 {
        let difference = (above[port] - below[port]) / (2.0 * step);
        assert!((rates[port] - difference).norm() < 1e-7 * rates[port].norm());
    }
}

#[test]
fn the_sum_over_poles_is_the_mobility() {
    let mut stream = Stream(5);
    for n in [3, 6] {
        let system = stream.system(n);
        let open = LinearSystem::new(&system, &[0, 1]).unwrap();
        let mobility = Mobility::new(&open, 1.1).unwrap();
        for omega in [0.1, 0.9, 2.3, 17.0] {
            let direct = open.receptance(omega, 1.1).unwrap();
            let sum = mobility.at(omega);
            for i in 0..2 {
                for j in 0..2 {
                    let expected = direct[(i, j)] * Complex::new(0.0, omega);
                    assert!((sum[(i, j)] - expected).norm() < 1e-11);
                }
            }
        }
    }
}

fn at(system: System) -> OperatingPoint {
    OperatingPoint {
        system: Arc::new(system),
        frequency: 0.8,
    }
}

#[test]
fn passive_systems_are_certified_by_energy_and_by_mobility_alike() {
    let mut stream = Stream(17);
    for n in [3, 5, 7] {
        let system = stream.system(n);
        let open = LinearSystem::new(&system, &[0, 1]).unwrap();
        let (verdict, _) = Mobility::new(&open, 0.8).unwrap().is_positive_real().unwrap();
        assert_eq!(verdict, Some(true));
        assert_eq!(uniqueness(&at(system)).unwrap(), Uniqueness::Energy);
    }
}

#[test]
fn a_little_circulatory_stiffness_is_certified_by_mobility_and_much_is_not() {
    let mut stream = Stream(23);
    let system = stream.system(4);
    let circulatory = stream.skew(4);
    let with = |share: f64, ports: usize| {
        let mut changed = system.clone();
        changed.stiffness.add_scaled(share, &circulatory);
        changed.elements.truncate(ports);
        uniqueness(&at(changed)).unwrap()
    };
    assert_eq!(with(1e-4, 1), Uniqueness::PositiveReal);
    // Between two ports any circulatory stiffness drives slow cycles.
    for (share, ports) in [(0.5, 1), (1e-4, 2), (0.5, 2)] {
        let Uniqueness::NotGuaranteed(doubts) = with(share, ports) else {
            panic!("too much is claimed");
        };
        assert!(doubts.contains(&Doubt::Stiffness), "{doubts:?}");
        assert!(doubts.len() == 2, "{doubts:?}");
    }
}

#[test]
fn negative_real_mobility_is_found_where_it_is() {
    let mut stream = Stream(29);
    let mut system = stream.system(4);
    // One direction is driven, which the whole survives.
    system.damping[(3, 3)] -= 0.3;
    let open = LinearSystem::new(&system, &[0, 1]).unwrap();
    let mobility = Mobility::new(&open, 0.8).unwrap();
    let lowest = mobility.smallest_real_part(0.0025, 50.0).unwrap();
    let value = |omega: f64| {
        let y = mobility.at(omega);
        let (a, d) = (y[(0, 0)].re, y[(1, 1)].re);
        let b = 0.5 * (y[(0, 1)] + y[(1, 0)].conj());
        0.5 * (a + d) - (0.25 * (a - d) * (a - d) + b.norm_sqr()).sqrt()
    };
    let coarse = (1..=20_000).map(|i| 0.0025 * f64::from(i));
    let fine = (-10_000..=10_000).map(|i| lowest.omega * (1.0 + 1e-6 * f64::from(i)));
    let sampled = coarse.chain(fine).map(value).fold(f64::INFINITY, f64::min);
    assert!(sampled < -1e-3, "{sampled}");
    assert_close(
        lowest.minimum / value(lowest.omega),
        1.0,
        1e-10,
        "value at the minimum",
    );
    assert!(lowest.lower_bound <= lowest.minimum && lowest.lower_bound <= sampled);
    assert!(
        lowest.minimum - sampled < 1e-8 * sampled.abs(),
        "{} {sampled}",
        lowest.minimum
    );
    assert_ne!(mobility.is_positive_real().unwrap().0, Some(true));
}

#[test]
fn doubts_are_named() {
    let mut stream = Stream(31);
    let mut system = stream.system(3);
    system.elements[0].law = Arc::new(coulomb(1.0, 1.3));
    let found = uniqueness(&at(system.clone())).unwrap();
    let text = found.to_string();
    assert!(
        text.contains("not guaranteed") && text.contains("\"first\""),
        "{text}"
    );
    system.elements[0].law = Arc::new(stop(0.1, 3.0));
    assert!(!uniqueness(&at(system.clone())).unwrap().excludes_jumps());
    system.elements.clear();
    assert_eq!(uniqueness(&at(system.clone())).unwrap(), Uniqueness::Linear);
    // An isolator belongs to the linear part, whatever its stiffness.
    let isolator = Isolator {
        stiffness: 2.0,
        damping: 0.1,
    };
    system
        .elements
        .push(Element::new("isolator", Port::new([(0, 1.0)]), isolator));
    assert_eq!(uniqueness(&at(system.clone())).unwrap(), Uniqueness::Linear);
    system.damping = Matrix::identity(3).scaled(-0.1);
    system.elements.clear();
    system
        .elements
        .push(Element::new("clutch", Port::new([(0, 1.0)]), one_way()));
    let text = uniqueness(&at(system)).unwrap().to_string();
    assert!(text.contains("negative eigenvalue"), "{text}");
}
