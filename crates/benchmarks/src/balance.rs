//! Task (k): condensed harmonic balance of a drive of thirteen coordinates with dry friction at its arm, over frequency.

use crate::timing::measure;
use serde_json::{Value, json};
use slackside_dynamics::orbit::harmonic_balance::{HarmonicOrbit, Settings, SolveStop, Start, solve};
use slackside_mechanics::laws::{Isolator, SmoothedGraph, Smoothing, coulomb};
use slackside_mechanics::{Law, OperatingPoint};
use slackside_testkit::nonsmooth_reference::{Machine, Place, nonsmooth_reference, operating_point};
use std::sync::Arc;

/// Frequencies, rad/s.
const SWEEP: (f64, f64, usize) = (150.0, 900.0, 300);
const HARMONICS: usize = 20;
const SAMPLES: usize = 256;
/// Friction torque, N m, and width of its transition at rest, rad/s.
const FRICTION: (f64, f64) = (1.0, 0.5);

/// The drive with friction at its arm and an isolator, which is linear, at its accessory.
fn points() -> Vec<OperatingPoint> {
    let file = nonsmooth_reference();
    let law = |place: Place, _: &Value| -> Arc<dyn Law> {
        match place {
            Place::Clutch => Arc::new(Isolator {
                stiffness: 5000.0,
                damping: 0.1,
            }),
            Place::Arm => {
                let exact = coulomb(FRICTION.0, 1.0);
                let smooth = SmoothedGraph::new(exact, Smoothing::Tanh, FRICTION.1);
                Arc::new(smooth.expect("friction has two sides"))
            }
        }
    };
    let (from, to, count) = SWEEP;
    (0..count)
        .map(|k| {
            let frequency = from + (to - from) * k as f64 / (count - 1) as f64;
            let input = json!({"W": frequency, "Ml": 3.0, "Q": FRICTION.0});
            operating_point(&file, Machine::Clutch, &input, &law)
        })
        .collect()
}

#[derive(Default)]
struct Counts {
    iterations: usize,
    failures: usize,
    largest_arm: f64,
}

impl Counts {
    fn take(&mut self, orbit: &HarmonicOrbit, stop: SolveStop, iterations: usize) {
        self.iterations += iterations;
        self.failures += usize::from(stop != SolveStop::Converged);
        let arm = orbit.coordinates[1].iter().skip(1);
        let rms = (0.5 * arm.map(|h| h.norm_sqr()).sum::<f64>()).sqrt();
        self.largest_arm = self.largest_arm.max(rms);
    }
}

/// All points, each from the one before or from its own linear response.
fn sweep(points: &[OperatingPoint], settings: &Settings, from_before: bool) -> Counts {
    let mut counts = Counts::default();
    let mut before: Option<HarmonicOrbit> = None;
    for point in points {
        let start = match &before {
            Some(orbit) if from_before => Start::Harmonics(&orbit.displacements),
            _ => Start::Linear,
        };
        let solution = solve(point, start, settings).expect("the system is sound");
        counts.take(&solution.orbit, solution.stop, solution.iterations);
        before = Some(solution.orbit);
    }
    counts
}

pub(crate) fn run(repeats: usize) -> Value {
    let points = points();
    let settings = Settings {
        samples: SAMPLES,
        refine_samples: false,
        ..Settings::fixed(HARMONICS)
    };
    let count = points.len();
    let timing = measure(repeats, || sweep(&points, &settings, true)).divided(count);
    let cold = measure(repeats, || sweep(&points, &settings, false)).divided(count);
    let accuracy = json!({
        "coordinates": points[0].system.order(),
        "points": count,
        "newton_steps_per_point": timing.result.iterations as f64 / count as f64,
        "not_converged": timing.result.failures,
        "largest_arm_rms": timing.result.largest_arm,
        "cpu_seconds_from_linear_response": cold.least(),
        "newton_steps_from_linear_response": cold.result.iterations as f64 / count as f64,
        "not_converged_from_linear_response": cold.result.failures,
        "difference": (timing.result.largest_arm / cold.result.largest_arm - 1.0).abs(),
    });
    // An elimination of order 2H + 1 per Newton step, and one of all coordinates per harmonic.
    let order = (2 * HARMONICS + 1) as f64;
    let steps = timing.result.iterations as f64 / count as f64;
    let n = points[0].system.order() as f64;
    let flops = steps * 2.0 / 3.0 * order.powi(3) + 5.0 * HARMONICS as f64 * 8.0 / 3.0 * n.powi(3);
    timing.line(
        "k",
        "friction",
        accuracy,
        flops,
        "a point of condensed harmonic balance, 20 harmonics, 256 samples, recovery of all coordinates to 80 harmonics \
         included; each from the one before; flops of eliminations only",
    )
}
