//! Reference files and models shared by tests. Not for use outside tests: it panics on any surprise.

pub mod nonsmooth_file;
pub mod nonsmooth_reference;

use serde_json::Value;
use slackside_belt_drive::prototypes::TwoPulley;
use std::path::PathBuf;

/// The folder of reference files.
pub fn reference_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../validation/reference")
}

/// A reference file, parsed.
pub fn reference(name: &str) -> Value {
    let path = reference_folder().join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// A number of a reference file, given as a number or as decimal text.
pub fn number(value: &Value) -> f64 {
    match value {
        Value::Number(number) => number.as_f64().expect("a double"),
        Value::String(text) => text.parse().expect("decimal text"),
        other => panic!("expected a number, found {other}"),
    }
}

/// A list of numbers.
pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

/// The dimensionless two-pulley system from its parameters `α, β, K_b, K_d, M, A_m, ζ₁, ζ₂`.
pub fn two_pulley(
    alpha: f64,
    beta: f64,
    belt: f64,
    clutch: f64,
    preload: f64,
    amplitude: f64,
    zeta: [f64; 2],
) -> TwoPulley {
    TwoPulley {
        pulley_inertia: 1.0,
        accessory_inertia: alpha,
        belt_stiffness: belt,
        clutch_stiffness: clutch,
        preload,
        excitation: beta * belt * amplitude,
        damping_ratio: zeta,
        smoothing: None,
    }
}

/// The nominal system of theory 02 §14, with the parameters of `changed` (named as in the reference file) replaced.
pub fn nominal(changed: &Value) -> TwoPulley {
    let value = |key: &str, default: f64| changed.get(key).map_or(default, number);
    two_pulley(
        value("alpha", 1.6),
        value("beta", 2.0),
        value("Kb", 2.6),
        value("Kd", 24.0),
        value("M", 1.0),
        value("Am", 0.05),
        [value("zeta1", 0.03), value("zeta2", 0.03)],
    )
}

/// The shared benchmark problem (α = 2, β = 1, K_b = 20, K_d = 10, M = 1, ζ = 3 %).
pub fn benchmark(amplitude: f64) -> TwoPulley {
    two_pulley(2.0, 1.0, 20.0, 10.0, 1.0, amplitude, [0.03, 0.03])
}

/// Asserts that two numbers agree to an absolute tolerance.
#[track_caller]
pub fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: found {found}, expected {expected}, difference {:.1e} above {tolerance:.1e}",
        (found - expected).abs()
    );
}

/// RMS of the wind-up over the 400 legs of the benchmark's sweep, up and then down, as computed by an independent integrator
/// (heyoka); `benchmarks/README.md` tells how.
pub fn sweep_of_independent_integrator() -> Vec<f64> {
    let path = reference_folder().join("../../benchmarks/reference/sweep_heyoka.csv");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|line| {
        line.rsplit(',')
            .next()
            .and_then(|v| v.trim().parse().ok())
            .expect("a number")
    })
    .collect()
}
