//! Event times against a 50-digit computation (theory 02 §3.1, §14).

use crate::common::{distance, nominal_system, point};
use serde_json::json;
use slackside_dynamics::flow::{Record, Request, open};
use slackside_mechanics::{Output, System};
use slackside_testkit::{assert_close, nominal, number, numbers, reference};
use std::sync::Arc;

/// The states `θ_p, θ_a` and their rates, then the wind-up.
fn state_outputs(system: &System) -> Vec<Output> {
    let find = |name| system.outputs[system.output_index(name).unwrap()].clone();
    ["pulley", "accessory", "pulley.rate", "accessory.rate", "windup"]
        .map(find)
        .into()
}

fn run(system: &Arc<System>, frequency: f64, start: &[f64], periods: usize, samples: usize) -> Record {
    let request = Request {
        samples,
        ..Request::default()
    };
    let mut flow = open(&point(system, frequency)).unwrap();
    flow.record(&mut start.to_vec(), periods, &state_outputs(system), &request)
        .unwrap()
}

fn times(record: &Record, frequency: f64) -> Vec<f64> {
    record
        .events
        .iter()
        .map(|event| event.phase / frequency)
        .collect()
}

/// The polynomial through `(i, y_i)` at `x`, by Neville's scheme.
fn interpolate(y: &[f64], x: f64) -> f64 {
    let mut p = y.to_vec();
    for level in 1..p.len() {
        for i in 0..p.len() - level {
            let (left, right) = (i as f64, (i + level) as f64);
            p[i] = ((x - right) * p[i] - (x - left) * p[i + 1]) / (left - right);
        }
    }
    p[0]
}

#[test]
fn first_twenty_events_of_the_reference_motions_and_the_state_at_the_last() {
    let system = nominal_system();
    for problem in reference("clutch_nominal.json")["initial_value_problems"]
        .as_array()
        .unwrap()
    {
        let frequency = number(&problem["Omega"]);
        let label = format!("Ω = {frequency}");
        let expected = numbers(&problem["event_times"]);
        let samples = 4096;
        let record = run(&system, frequency, &numbers(&problem["x0"]), 12, samples);
        let found = times(&record, frequency);
        assert_eq!(
            record.events[0].from as u64,
            problem["regime0"].as_u64().unwrap(),
            "{label}"
        );
        for (k, (a, b)) in found.iter().zip(&expected).enumerate() {
            assert_close(*a, *b, 2e-13, &format!("{label}: event {k}"));
            assert_eq!(record.events[k].from, 1 - record.events[k].to);
        }
        // The dense output before the event, continued to it: the motion is smooth up to there.
        let spacing = std::f64::consts::TAU / frequency / samples as f64;
        let last = expected[19] / spacing;
        let first = last.floor() as usize - 7;
        assert!(
            found[18] < first as f64 * spacing,
            "{label}: no event among the samples"
        );
        let state: Vec<f64> = record.samples[..4]
            .iter()
            .map(|y| interpolate(&y[first..first + 8], last - first as f64))
            .collect();
        let error = distance(&state, &numbers(&problem["state_at_last_event"]));
        assert!(
            error < 5e-14,
            "{label}: state at the last event is off by {error:.1e}"
        );
    }
}

#[test]
fn the_pair_that_sign_tests_at_steps_lose_is_found() {
    let (system, frequency) = (nominal_system(), 0.97);
    let record = run(&system, frequency, &[0.0, 0.2, 0.0, 0.0], 10, 0);
    let all = times(&record, frequency);
    let within: Vec<f64> = all.into_iter().filter(|&t| t <= 60.0).collect();
    assert_eq!(within.len(), 58);
    // 50 digits: 9.113838068320961231, 9.1262198367275430421.
    assert_close(within[13], 9.11383806832096, 2e-13, "disengages");
    assert_close(within[14], 9.126219836727543, 2e-13, "re-engages");
    assert_close(within[14] - within[13], 0.01238, 5e-6, "duration");
    // Sampling with steps of 0.1 and comparing signs sees two less.
    let samples = (std::f64::consts::TAU / frequency / 0.1).ceil() as usize;
    let windup = &run(&system, frequency, &[0.0, 0.2, 0.0, 0.0], 10, samples).samples[4];
    let step = std::f64::consts::TAU / frequency / samples as f64;
    let seen = windup
        .windows(2)
        .enumerate()
        .filter(|(i, pair)| (*i + 1) as f64 * step <= 60.0 && pair[0] * pair[1] < 0.0)
        .count();
    assert!(seen < 58, "{seen}");
}

#[test]
fn a_dip_of_relative_depth_1e_8_is_two_events() {
    let file = reference("clutch_nominal.json");
    let problem = &file["grazing_ivp"];
    let frequency = number(&problem["Omega"]);
    let system = Arc::new(nominal(&json!({ "M": problem["M"] })).system().unwrap());
    let record = run(&system, frequency, &numbers(&problem["x0"]), 1, 4000);
    let found = times(&record, frequency);
    let expected = numbers(&problem["event_times"]);
    assert_eq!(found.len(), 2, "{found:?}");
    let duration = number(&problem["duration"]);
    let relative = ((found[1] - found[0]) / duration - 1.0).abs();
    assert_close(found[0], expected[0], 5e-12, "disengages");
    assert_close(found[1], expected[1], 5e-12, "re-engages");
    assert!(relative < 3e-7, "duration is off by {relative:.1e}");
    let windup = &record.samples[4];
    assert!(windup.iter().all(|&y| y > 0.0), "no sample of 4000 sees the dip");
    // None is left when preload and start are moved so that the wind-up is larger by 1e-7 of its static value.
    let higher = number(&problem["M"]) * (1.0 + 1e-7);
    let system = Arc::new(nominal(&json!({ "M": higher })).system().unwrap());
    let mut rest = numbers(&problem["x0"]);
    rest[1] -= 1e-7 * number(&problem["M"]) / 24.0;
    assert!(run(&system, frequency, &rest, 1, 0).events.is_empty());
}
