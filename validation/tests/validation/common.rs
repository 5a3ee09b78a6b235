//! What the tests share.

use serde_json::json;
use slackside_dynamics::flow::{Record, Request, open};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_linalg::Complex;
use slackside_mechanics::{FrequencyFamily, OperatingPoint, System};
use slackside_testkit::nominal;
use std::sync::Arc;

/// Positions of the measures of the two-pulley system.
pub const PULLEY: usize = 0;
pub const WINDUP: usize = 2;
pub const TORQUE: usize = 3;

/// The nominal system of theory 02 §14.
pub fn nominal_system() -> Arc<System> {
    Arc::new(nominal(&json!({})).system().unwrap())
}

/// A system under a load of the given frequency.
pub fn point(system: &Arc<System>, frequency: f64) -> OperatingPoint {
    OperatingPoint {
        system: system.clone(),
        frequency,
    }
}

/// Shooting for motions of one system over frequency.
pub fn shooting(system: &Arc<System>, frequency: f64, periods: usize) -> Shooting {
    Shooting::new(Arc::new(FrequencyFamily::new(system.clone())), frequency, periods).unwrap()
}

/// All measures of the system, with extremes, from a start over whole periods of the load.
pub fn record(
    system: &Arc<System>,
    frequency: f64,
    start: &[f64],
    periods: usize,
    harmonics: usize,
    samples: usize,
) -> Record {
    let request = Request {
        harmonics,
        extremes: true,
        samples,
        account: false,
    };
    let mut flow = open(&point(system, frequency)).unwrap();
    flow.record(&mut start.to_vec(), periods, &system.outputs, &request)
        .unwrap()
}

/// Largest difference of two vectors.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |worst, (x, y)| worst.max((x - y).abs()))
}

/// Coefficients of `Π (x − μ_i)`: single multipliers are ill-conditioned near double values, these are not.
pub fn characteristic_polynomial(multipliers: &[Complex]) -> Vec<f64> {
    let mut coefficients = vec![Complex::new(1.0, 0.0)];
    for root in multipliers {
        coefficients.push(Complex::new(0.0, 0.0));
        for i in (1..coefficients.len()).rev() {
            let previous = coefficients[i - 1];
            coefficients[i] -= root * previous;
        }
    }
    coefficients.iter().map(|c| c.re).collect()
}

/// The zero of `f` between `low` and `high`, where its signs differ, by bisection to rounding.
pub fn bisect(low: f64, high: f64, f: &mut dyn FnMut(f64) -> f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let sign = f(low).signum();
    assert!(sign * f(high) <= 0.0, "no change of sign from {low} to {high}");
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low.min(high) || middle >= low.max(high) {
            break;
        }
        if sign * f(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Place and value of the maximum of `f` between `low` and `high` by the golden section. The place is good to the square
/// root of rounding, the value to rounding.
pub fn maximize(low: f64, high: f64, f: &mut dyn FnMut(f64) -> f64) -> (f64, f64) {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (low, high);
    let (mut c, mut d) = (b - share * (b - a), a + share * (b - a));
    let (mut fc, mut fd) = (f(c), f(d));
    while b - a > 2e-9 * (1.0 + a.abs()) {
        if fc > fd {
            (b, d, fd) = (d, c, fc);
            c = b - share * (b - a);
            fc = f(c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + share * (b - a);
            fd = f(d);
        }
    }
    if fc > fd { (c, fc) } else { (d, fd) }
}
