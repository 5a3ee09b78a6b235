//! Task (f): the second resonance, from 3.2 to 8, as a curve of 1,000 points by first-order multiple scales, and by shooting
//! in the same run. The system has half the crank amplitude of case A, for which both curves cover the same range.

use crate::timing::measure;
use serde_json::{Value, json};
use slackside_continuation::Options;
use slackside_dynamics::branch::{BranchOptions, follow};
use slackside_dynamics::flow::Request;
use slackside_dynamics::orbit::multiple_scales::{ModalForm, PrimaryResonance};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_mechanics::FrequencyFamily;
use slackside_testkit::benchmark;
use std::sync::Arc;

const RANGE: (f64, f64) = (3.2, 8.0);
const AMPLITUDE: f64 = 0.025;
const POINTS: usize = 1000;
/// Curves in one timed run: a single one is too short for the clock.
const CURVES: usize = 1000;

/// RMS at every point of the curve by shooting.
fn by_shooting() -> Vec<f64> {
    let model = benchmark(AMPLITUDE);
    let system = model.system().expect("the benchmark system is sound");
    let windup = vec![system.outputs[2].clone()];
    let family = Arc::new(FrequencyFamily::new(Arc::new(system)));
    let mut shooting = Shooting::new(family, RANGE.1, 1).expect("the exact flow applies");
    let rest = [0.0, -model.static_windup(), 0.0, 0.0];
    let start = shooting
        .solve(&rest, RANGE.1)
        .expect("the linear response exists at high frequency");
    let options = BranchOptions {
        continuation: Options {
            max_step: 0.18,
            ..Options::over(RANGE.0, RANGE.1)
        },
        direction: -1.0,
    };
    let branch = follow(&mut shooting, &start.start, RANGE.1, &options, &mut |_| true);
    let request = Request {
        harmonics: 0,
        extremes: false,
        samples: 0,
        ..Request::default()
    };
    let points = branch.points.iter();
    points
        .map(|point| {
            let record = shooting.summarize(&point.unknowns, point.parameter, &windup, &request);
            record.expect("the motion is known").measures[0].rms
        })
        .collect()
}

pub(crate) fn run(repeats: usize) -> Value {
    let system = benchmark(AMPLITUDE)
        .system()
        .expect("the benchmark system is sound");
    let form = ModalForm::new(&system).expect("a clutch with preload");
    let resonance = PrimaryResonance::new(form, 1).expect("the second mode resonates");
    let mut curve = Vec::with_capacity(POINTS);
    let timing = measure(repeats, || {
        let mut largest = 0.0_f64;
        for _ in 0..CURVES {
            resonance.first_order_curve(RANGE.0, RANGE.1, POINTS, &mut curve);
            largest = largest.max(curve.iter().fold(0.0, |a, point| a.max(point.rms)));
        }
        largest
    })
    .divided(CURVES);
    let shooting = measure(repeats, by_shooting);
    let exact = shooting.result.iter().copied().fold(0.0, f64::max);
    let accuracy = json!({
        "points": POINTS,
        "largest_rms": timing.result,
        "largest_rms_by_shooting": exact,
        "points_by_shooting": shooting.result.len(),
        "cpu_seconds_by_shooting": shooting.least(),
        "ratio_to_shooting": shooting.least() / timing.least(),
    });
    // An exponential, an arctangent and two roots a point, counted as twenty operations each.
    let flops = POINTS as f64 * (4.0 * 20.0 + 40.0);
    timing.line(
        "f",
        "A",
        accuracy,
        flops,
        "multiple scales of first order in closed form, stability at every point, mean of 1,000 curves; shooting in the same \
         run with the steps of task (a)",
    )
}
