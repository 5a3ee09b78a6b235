//! Random drives: a gyroscopic system of several coordinates with an accessory behind a clutch and friction at an arm.

use slackside_dynamics::flow::{ExactFlow, Record, Request};
use slackside_dynamics::orbit::periodic::{PeriodicMotion, PeriodicSearch, PeriodicSettings};
use slackside_linalg::Matrix;
use slackside_mechanics::{Element, Forcing, Harmonic, Law, OperatingPoint, Output, Port, System};
use std::sync::Arc;

/// Coordinates: the arm first, then spans, then the accessory's pulley and last, on a clutch, the accessory.
pub const ARM: usize = 0;

/// A generator of numbers (SplitMix64), so that every run draws the same systems.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// A number between two bounds.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * (z >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Numbers of one range.
    pub fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| self.between(-size, size)).collect()
    }

    /// A matrix of numbers from −1 to 1.
    fn matrix(&mut self, n: usize) -> Matrix {
        let rows: Vec<Vec<f64>> = (0..n).map(|_| self.vector(n, 1.0)).collect();
        Matrix::from_rows(&rows).unwrap()
    }

    /// A symmetric positive definite matrix with eigenvalues of the size of `diagonal` and more.
    fn definite(&mut self, n: usize, diagonal: f64, share: f64) -> Matrix {
        let a = self.matrix(n);
        let mut result = a.transpose().product(&a).scaled(share * diagonal);
        for i in 0..n {
            result[(i, i)] += diagonal;
            for j in 0..i {
                result[(i, j)] = result[(j, i)];
            }
        }
        result
    }
}

/// What a random drive has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kind {
    /// Whether there is an accessory.
    pub accessory: bool,
    /// Whether the accessory has damping of its own.
    pub accessory_damping: bool,
    /// Whether the load has a second harmonic.
    pub even_orders: bool,
}

impl Kind {
    pub const CLUTCH: Self = Self {
        accessory: true,
        accessory_damping: true,
        even_orders: true,
    };
    pub const FRICTION: Self = Self {
        accessory: false,
        accessory_damping: false,
        even_orders: false,
    };
}

/// A random system without elements, and its frequency.
pub fn bare(random: &mut Random, kind: Kind) -> (System, f64) {
    let held = 2 + random.between(0.0, 3.0) as usize;
    let n = held + usize::from(kind.accessory);
    let widened = |inner: Matrix, corner: f64| {
        let mut matrix = Matrix::zeros(n, n);
        for i in 0..held {
            matrix.row_mut(i)[..held].copy_from_slice(inner.row(i));
        }
        if kind.accessory {
            matrix[(held, held)] = corner;
        }
        matrix
    };
    let inertia = random.between(0.5, 4.0);
    let drag = if kind.accessory_damping {
        random.between(0.01, 0.1)
    } else {
        0.0
    };
    let mass = widened(random.definite(held, 1.0, 0.1), inertia);
    let stiffness = widened(random.definite(held, 1.0, 2.0), 0.0);
    let mut damping = random.definite(held, 0.05, 0.3);
    let gyroscopic = random.matrix(held);
    damping.add_scaled(0.1, &gyroscopic);
    damping.add_scaled(-0.1, &gyroscopic.transpose());
    let damping = widened(damping, drag);
    let orders: &[usize] = if kind.even_orders { &[1, 2] } else { &[1, 3] };
    let mut forcing = Forcing::none(n);
    for &order in orders {
        let size = if order == 1 { 1.0 } else { 0.3 };
        let mut part = || {
            let mut load = random.vector(held, size);
            load.resize(n, 0.0);
            load
        };
        forcing.add_harmonic(Harmonic {
            order,
            cosine: part(),
            sine: part(),
        });
    }
    let mut coordinates: Vec<String> = (0..held).map(|i| format!("q{i}")).collect();
    if kind.accessory {
        coordinates.push("accessory".into());
    }
    let mut outputs = Vec::new();
    for (i, name) in coordinates.iter().enumerate() {
        outputs.push(Output::coordinate(name.clone(), i));
    }
    for (i, name) in coordinates.iter().enumerate() {
        outputs.push(Output {
            name: format!("{name}.rate"),
            velocity: vec![(i, 1.0)],
            ..Output::default()
        });
    }
    let system = System {
        coordinates,
        mass,
        damping,
        stiffness,
        damping_linear_in_frequency: None,
        stiffness_quadratic_in_frequency: None,
        forcing,
        elements: Vec::new(),
        outputs,
    };
    (system, random.between(0.4, 2.5))
}

impl Random {
    /// The first number between 0.1 and 0.6 that is drawn after the system of a seed.
    pub fn first(seed: u64, kind: Kind) -> f64 {
        let mut random = Self::new(seed);
        bare(&mut random, kind);
        random.between(0.1, 0.6)
    }
}

impl Kind {
    /// The accessory of a system of this kind, and its pulley.
    pub fn accessory_and_pulley(self, system: &System) -> (usize, usize) {
        assert!(self.accessory);
        (system.order() - 1, system.order() - 2)
    }
}

/// Puts an element into a system and its force among the outputs.
pub fn add(system: &mut System, name: &str, port: &[(usize, f64)], law: impl Law + 'static) {
    let index = system.elements.len();
    let port = Port::new(port.iter().copied());
    system.elements.push(Element::new(name, port, law));
    system.outputs.push(Output::element_force(name, index));
}

/// A clutch with the law between the last two coordinates, and a load on the accessory.
pub fn add_clutch(system: &mut System, load: f64, law: impl Law + 'static) {
    let n = system.order();
    add(system, "clutch", &[(n - 2, 1.0), (n - 1, -1.0)], law);
    system.forcing.constant[n - 2] += load;
    system.forcing.constant[n - 1] -= load;
}

pub fn point(system: System, frequency: f64) -> OperatingPoint {
    system.check().unwrap();
    OperatingPoint {
        system: Arc::new(system),
        frequency,
    }
}

/// All of a periodic motion that is reached from a start.
pub fn solve_from(point: &OperatingPoint, start: &[f64]) -> (PeriodicMotion, Record) {
    let mut flow = ExactFlow::new(point).unwrap();
    let mut search = PeriodicSearch::new(&mut flow, &point.system, PeriodicSettings::default());
    let motion = search.from_state(start).unwrap();
    let request = Request {
        extremes: true,
        account: true,
        harmonics: 12,
        ..Request::default()
    };
    let record = search.record(&motion, &point.system.outputs, &request).unwrap();
    (motion, record)
}

/// The periodic motion that is reached from the origin.
pub fn solve(point: &OperatingPoint) -> (PeriodicMotion, Record) {
    let state = 2 * point.system.order() + point.system.internal_states();
    solve_from(point, &vec![0.0; state])
}

/// Position of an output.
pub fn output(point: &OperatingPoint, name: &str) -> usize {
    point.system.output_index(name).unwrap()
}

/// Largest difference of two lists over the largest entry of the second.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let size = b.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    let largest = a.iter().zip(b).fold(0.0_f64, |l, (a, b)| l.max((a - b).abs()));
    largest / size.max(f64::MIN_POSITIVE)
}

/// RMS values of the coordinates that are not cyclic and of all rates.
pub fn rms(point: &OperatingPoint, record: &Record) -> Vec<f64> {
    let n = point.system.order();
    let cyclic = point.system.cyclic_coordinates();
    (0..2 * n)
        .filter(|i| !cyclic.contains(i))
        .map(|i| record.measures[i].rms)
        .collect()
}
