//! Task (c): one motion of 2,000 periods at frequency 1.6 with its 3,998 events.

use crate::timing::measure;
use serde_json::{Value, json};
use slackside_dynamics::flow::{Flow, Record, Request, open};
use slackside_mechanics::OperatingPoint;
use slackside_testkit::{benchmark, number, numbers, reference};
use std::f64::consts::TAU;
use std::sync::Arc;

const PERIODS: usize = 2000;

fn compute() -> ([f64; 4], Record) {
    let system = Arc::new(benchmark(0.05).system().expect("the benchmark system is sound"));
    let mut flow: Box<dyn Flow> = open(&OperatingPoint {
        system,
        frequency: 1.6,
    })
    .expect("the exact flow applies");
    let mut state = [0.0, -0.1, 0.0, 0.0];
    let record = flow
        .record(&mut state, PERIODS, &[], &Request::default())
        .expect("the motion is bounded");
    (state, record)
}

pub(crate) fn run(repeats: usize) -> Value {
    let timing = measure(repeats, compute);
    let expected = &reference("clutch_benchmark.json")["task_c_exact"];
    let (state, record) = &timing.result;
    let phase_error = |index: usize, key: &str| {
        let fraction = (record.events[index].phase / TAU).fract();
        (fraction - number(&expected[key])).abs()
    };
    let last = record.events.len() - 2;
    let end = numbers(&expected["x_end"]);
    let accuracy = json!({
        "events": record.events.len(),
        "end_state_error": state.iter().zip(&end).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
        "disengage_phase_error": phase_error(last, "disengage_phase"),
        "engage_phase_error": phase_error(last + 1, "engage_phase"),
    });
    let flops = record.events.len() as f64 * crate::flops::EVENT;
    timing.line(
        "c",
        "A",
        accuracy,
        flops,
        "exact flow with the event list; flops estimated from counted events",
    )
}
