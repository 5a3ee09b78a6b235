//! Task (b): 200 frequencies up and 200 down, 300 periods to settle and 50 sampled at 100 points each.

use crate::timing::measure;
use serde_json::{Value, json};
use slackside_dynamics::flow::{Flow, Request, open};
use slackside_mechanics::OperatingPoint;
use slackside_testkit::{benchmark, reference_folder};
use std::sync::Arc;

const LEGS: usize = 200;

fn frequency(i: usize) -> f64 {
    0.3 + 7.7 * i as f64 / (LEGS - 1) as f64
}

fn rms(samples: &[f64]) -> f64 {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    (samples.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// RMS of every leg, and the operations spent, estimated from counted events and settled samples.
fn compute() -> (Vec<f64>, f64) {
    let system = Arc::new(benchmark(0.05).system().expect("the benchmark system is sound"));
    let windup = vec![system.outputs[2].clone()];
    let point = OperatingPoint {
        system,
        frequency: frequency(0),
    };
    let mut flow: Box<dyn Flow> = open(&point).expect("the exact flow applies");
    let mut state = [0.0, -0.1, 0.0, 0.0];
    let request = Request {
        harmonics: 0,
        extremes: false,
        samples: 100,
        ..Request::default()
    };
    let mut flops = 0.0;
    let legs = (0..LEGS)
        .chain((0..LEGS).rev())
        .map(|i| {
            flow.set_frequency(frequency(i));
            let events = flow
                .advance(&mut state, 300, &mut [])
                .expect("the motion is bounded");
            let record = flow
                .record(&mut state, 50, &windup, &request)
                .expect("the motion is bounded");
            flops += (events + record.events.len()) as f64 * crate::flops::EVENT;
            flops += record.samples[0].len() as f64 * crate::flops::SETTLED_SAMPLE;
            rms(&record.samples[0])
        })
        .collect();
    (legs, flops)
}

/// Largest difference from the sweep of an independent integrator.
fn worst_difference(found: &[f64]) -> f64 {
    let path = reference_folder().join("../../benchmarks/reference/sweep_heyoka.csv");
    let text = std::fs::read_to_string(path).expect("the reference sweep is in the repository");
    let expected: Vec<f64> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| {
            line.rsplit(',')
                .next()
                .and_then(|v| v.trim().parse().ok())
                .expect("a number")
        })
        .collect();
    assert_eq!(expected.len(), found.len(), "one row per leg");
    found
        .iter()
        .zip(&expected)
        .map(|(f, e)| (f - e).abs())
        .fold(0.0, f64::max)
}

pub(crate) fn run(repeats: usize) -> Value {
    let timing = measure(repeats, compute);
    let accuracy = json!({ "rms_difference_from_heyoka": worst_difference(&timing.result.0) });
    timing.line(
        "b",
        "A",
        accuracy,
        timing.result.1,
        "exact flow; a leg that provably stays in one regime ends in closed form, all others run over all their periods; \
         flops estimated from counted events and samples",
    )
}
