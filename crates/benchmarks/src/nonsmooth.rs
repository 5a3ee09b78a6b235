//! Tasks (g), (h) and (j): the thirteen-coordinate drive with an overrunning clutch: periodic motions with statistics, and its
//! critical load.

use crate::timing::measure;
use serde_json::{Value, json};
use slackside_dynamics::closed_form::LockedElement;
use slackside_dynamics::flow::{ExactFlow, Record, Request};
use slackside_dynamics::orbit::periodic::{PeriodicMotion, PeriodicSearch, PeriodicSettings};
use slackside_mechanics::OperatingPoint;
use slackside_mechanics::laws::one_way;
use slackside_testkit::nonsmooth_reference::{Machine, nonsmooth_reference, operating_point};
use slackside_testkit::number;
use std::sync::Arc;

/// Frequencies of the sweep, rad/s.
const SWEEP: (f64, f64, usize) = (150.0, 900.0, 300);

fn at(file: &Value, frequency: f64) -> OperatingPoint {
    let input = json!({"W": frequency, "Ml": 3.0});
    operating_point(file, Machine::Clutch, &input, &|_, _| Arc::new(one_way()))
}

/// The motion reached from a state, with RMS and extremes of all measures.
fn orbit(point: &OperatingPoint, start: &[f64], settings: PeriodicSettings) -> (PeriodicMotion, Record) {
    let mut flow = ExactFlow::new(point).expect("the exact flow applies");
    let mut search = PeriodicSearch::new(&mut flow, &point.system, settings);
    let motion = search
        .from_state(start)
        .expect("the motion is unique and attracts");
    let request = Request {
        extremes: true,
        ..Request::default()
    };
    let record = search
        .record(&motion, &point.system.outputs, &request)
        .expect("the motion is known");
    (motion, record)
}

/// One orbit from rest, at the frequency 400 rad/s of the reference.
pub(crate) fn one(repeats: usize) -> Value {
    let file = nonsmooth_reference();
    let entries = file["periodic"].as_array().expect("a list");
    let reference = entries
        .iter()
        .find(|entry| entry["input"]["name"] == "clutch 400")
        .expect("the orbit is in the reference");
    let point = at(&file, number(&reference["input"]["W"]));
    let rest = vec![0.0; 2 * point.system.order()];
    let count = 20;
    let timing = measure(repeats, || {
        (0..count)
            .map(|_| orbit(&point, &rest, PeriodicSettings::default()))
            .next_back()
            .expect("there is one")
    })
    .divided(count);
    let (motion, record) = &timing.result;
    let expected = number(&reference["q"]["rms"][2]);
    let accuracy = json!({
        "coordinates": point.system.order(),
        "residual": motion.residual,
        "periods_marched": motion.marched,
        "newton_steps": motion.iterations,
        "events": motion.events,
        "rms_error": (record.measures[2].rms / expected - 1.0).abs(),
    });
    timing.line(
        "g",
        "clutch",
        accuracy,
        0.0,
        "one periodic orbit from rest with statistics; tables included; operations not counted",
    )
}

/// 300 orbits over frequency, each from the one before; matrices and tables are new at each.
pub(crate) fn sweep(repeats: usize) -> Value {
    let file = nonsmooth_reference();
    let (from, to, count) = SWEEP;
    let points: Vec<OperatingPoint> = (0..count)
        .map(|k| at(&file, from + (to - from) * k as f64 / (count - 1) as f64))
        .collect();
    let timing = measure(repeats, || {
        let mut start = vec![0.0; 2 * points[0].system.order()];
        let mut rows = Vec::with_capacity(count);
        for point in &points {
            let (motion, record) = orbit(point, &start, PeriodicSettings::default());
            start.copy_from_slice(&motion.start);
            rows.push((motion.residual, record.measures[2].rms));
        }
        rows
    });
    let residual = timing.result.iter().map(|row| row.0).fold(0.0, f64::max);
    let largest = timing.result.iter().map(|row| row.1).fold(0.0, f64::max);
    let accuracy = json!({"points": count, "largest_residual": residual, "largest_rms": largest});
    timing.line(
        "h",
        "clutch",
        accuracy,
        0.0,
        "300 periodic orbits over frequency with statistics; operations not counted",
    )
}

/// The critical load at 1,000 frequencies.
pub(crate) fn critical_load(repeats: usize) -> Value {
    let file = nonsmooth_reference();
    let point = at(&file, 400.0);
    let count = 1000;
    let timing = measure(repeats, || {
        let mut clutch = LockedElement::new(&point.system, 0).expect("a clutch can lock");
        (0..count)
            .map(|k| {
                let frequency = 150.0 + 1050.0 * k as f64 / (count - 1) as f64;
                let found = clutch.critical_load(frequency);
                found.expect("no resonance is undamped").critical
            })
            .fold(0.0_f64, f64::max)
    })
    .divided(count);
    let mut clutch = LockedElement::new(&point.system, 0).expect("a clutch can lock");
    let found = clutch
        .critical_load(400.0)
        .expect("no resonance is undamped")
        .critical;
    let expected = file["critical_load"]
        .as_array()
        .expect("a list")
        .iter()
        .find(|entry| entry["input"] == json!({"W": 400.0}))
        .map_or(f64::NAN, |entry| number(&entry["M_crit"]));
    let accuracy = json!({"points": count, "error": (found / expected - 1.0).abs()});
    timing.line(
        "j",
        "clutch",
        accuracy,
        0.0,
        "critical load, one frequency of 1,000; operations not counted",
    )
}
