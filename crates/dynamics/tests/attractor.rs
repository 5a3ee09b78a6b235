//! Attractors of the nominal clutch against the reference file: sweeps, tori, exponents, basins (theory 02 §9, §14).

use serde_json::{Value, json};
use slackside_dynamics::attractor::basin::{self, Axis, BasinMap, BasinOptions, Cell, Grid, GridError};
use slackside_dynamics::attractor::{
    Attractor, ClassifyOptions, LyapunovOptions, Recognition, RecognitionOptions, Recognizer, SweepOptions,
    SweepStep, SweepStop, classify, lyapunov, rotation_number, settle, stroboscopic, sweep,
};
use slackside_dynamics::flow::open;
use slackside_mechanics::{FrequencyFamily, OperatingPoint};
use slackside_testkit::{assert_close, nominal, number, numbers, reference};
use std::sync::Arc;

/// Sum of the exponents, `−2(ζ₁ω₁ + ζ₂ω₂)`.
const SUM: f64 = -0.06 * (0.9796106880251735 + 6.374979443096805);
const STATIC_WINDUP: f64 = 1.0 / 24.0;

fn point(frequency: f64) -> OperatingPoint {
    OperatingPoint {
        system: Arc::new(nominal(&json!({})).system().unwrap()),
        frequency,
    }
}

fn rest() -> Vec<f64> {
    vec![0.0, -STATIC_WINDUP, 0.0, 0.0]
}

fn quick() -> SweepOptions {
    SweepOptions {
        record_periods: 4,
        samples: 16,
        poincare_points: 100,
        ..SweepOptions::default()
    }
}

fn run(frequencies: &[f64], start: &[f64], options: &SweepOptions) -> Vec<SweepStep> {
    let family = FrequencyFamily::new(point(1.0).system);
    let mut steps = Vec::new();
    let stop = sweep(&family, frequencies, &mut start.to_vec(), options, &mut |step| {
        steps.push(step);
        true
    });
    assert_eq!(stop, SweepStop::Finished);
    steps
}

fn check_sweep(rows: &[Value]) {
    let frequencies: Vec<f64> = rows.iter().map(|row| number(&row["Omega"])).collect();
    let steps = run(&frequencies, &rest(), &quick());
    assert_eq!(steps.len(), 33);
    for (step, row) in steps.iter().zip(rows) {
        let label = format!("Ω = {}", step.frequency);
        let Attractor::Periodic(periodic) = &step.attractor else {
            panic!("{label}: {:?}", step.attractor);
        };
        assert_eq!(
            periodic.periods as u64,
            row["period"].as_u64().unwrap(),
            "{label}"
        );
        assert!(periodic.orbit.is_some(), "{label}");
        assert_close(
            step.record.measures[2].rms,
            number(&row["delta_rms_ac"]),
            1e-12,
            &label,
        );
        assert_close(
            step.record.measures[0].max,
            number(&row["theta_p_max"]),
            1e-12,
            &label,
        );
        for (found, expected) in step.points.point(0).iter().zip(numbers(&row["x0"])) {
            assert_close(*found, expected, 1e-11, &label);
        }
        assert_eq!(step.samples[2].len(), 4 * 16);
        // The motion as it ran has arrived at the orbit, whose first point is the first sample.
        assert_close(step.samples[0][0], periodic.points[0][0], 1e-5, &label);
    }
}

#[test]
fn sweep_down_over_the_second_resonance() {
    check_sweep(
        reference("clutch_nominal.json")["sweeps"]["down"]["rows"]
            .as_array()
            .unwrap(),
    );
}

#[test]
fn sweep_up_over_the_second_resonance() {
    check_sweep(
        reference("clutch_nominal.json")["sweeps"]["up"]["rows"]
            .as_array()
            .unwrap(),
    );
}

#[test]
fn a_sweep_stops_when_asked_and_where_there_is_no_system() {
    let family = FrequencyFamily::new(point(1.0).system);
    let options = quick();
    let mut seen = Vec::new();
    let mut state = rest();
    let stop = sweep(&family, &[7.0, 6.9, 6.8], &mut state, &options, &mut |step| {
        seen.push(step.parameter);
        step.parameter > 6.95
    });
    assert_eq!((seen, stop), (vec![7.0, 6.9], SweepStop::Asked));
    let before = state.clone();
    let stop = sweep(&family, &[-1.0], &mut state, &options, &mut |_| true);
    assert!(matches!(stop, SweepStop::Failed { parameter, .. } if parameter == -1.0));
    assert_eq!(state, before);
}

/// Downwards through the first resonance: theory 02 §12, "histories, phase plane, Poincaré near the first resonance".
#[test]
fn kinds_of_motion_through_the_first_resonance() {
    let frequencies = [1.06, 1.04, 1.02, 1.0, 0.97, 0.955, 0.95, 0.945, 0.93];
    let steps = run(&frequencies, &rest(), &quick());
    let kinds: Vec<String> = steps.iter().map(|step| kind(&step.attractor)).collect();
    assert_eq!(
        kinds,
        [
            "period 1", "period 1", "period 2", "chaos", "chaos", "torus", "torus", "torus", "period 1"
        ]
    );
    assert_eq!(steps[3].points.len(), 100);
    assert_eq!(steps[2].points.len(), 2);
    assert_close(steps[2].record.measures[2].rms, 0.085711614489, 1e-12, "period 2");
    assert_eq!(steps[2].measured_periods, 2);
}

fn kind(attractor: &Attractor) -> String {
    match attractor {
        Attractor::Periodic(periodic) => format!("period {}", periodic.periods),
        Attractor::QuasiPeriodic { .. } => "torus".into(),
        Attractor::Chaotic { .. } => "chaos".into(),
        Attractor::Unsettled { .. } => "unsettled".into(),
    }
}

#[test]
fn rotation_numbers_of_the_reference_tori() {
    for row in reference("clutch_nominal.json")["quasi_periodic"]
        .as_array()
        .unwrap()
    {
        let frequency = number(&row["Omega"]);
        let mut flow = open(&point(frequency)).unwrap();
        let mut state = vec![0.3, 0.1, 0.0, 0.4];
        settle(flow.as_mut(), &mut state, 3000).unwrap();
        let map = stroboscopic(flow.as_mut(), &mut state, 10_000).unwrap();
        let found = rotation_number(&map).unwrap();
        assert_close(
            found.value,
            number(&row["rotation_number"]),
            1e-9,
            "rotation number",
        );
        assert!(found.change < 1e-7 && found.drift < 1e-3, "{found:?}");
        assert_eq!(found.curves, 1);
    }
}

#[test]
fn lyapunov_exponents_of_the_reference_chaos() {
    let file = reference("clutch_nominal.json");
    let row = &file["lyapunov"][0];
    let mut flow = open(&point(number(&row["Omega"]))).unwrap();
    let mut state = rest();
    settle(flow.as_mut(), &mut state, 1000).unwrap();
    let options = LyapunovOptions {
        periods: 40_000,
        ..LyapunovOptions::default()
    };
    let found = lyapunov(flow.as_mut(), &mut state, &options).unwrap();
    // Both numbers scatter: the reference by the spread of its three runs, this run by its standard error.
    let spreads = numbers(&row["exponents_spread"]);
    for (i, expected) in numbers(&row["exponents_mean"]).iter().enumerate() {
        let error = found.standard_errors[i];
        assert!(error < 1e-3 && error > 1e-5);
        assert_close(
            found.exponents[i],
            *expected,
            3.0 * spreads[i].hypot(error),
            "exponent",
        );
    }
    assert_close(found.sum(), number(&row["sum_exact"]), 1e-12, "sum");
    assert_eq!(found.positive(), 2);

    // Leading exponents alone follow the same directions.
    let mut again = state.clone();
    let short = LyapunovOptions {
        periods: 500,
        ..LyapunovOptions::default()
    };
    let all = lyapunov(flow.as_mut(), &mut state, &short).unwrap();
    let leading = LyapunovOptions {
        count: Some(2),
        ..short
    };
    let two = lyapunov(flow.as_mut(), &mut again, &leading).unwrap();
    assert_eq!(two.exponents.len(), 2);
    assert_close(two.exponents[0], all.exponents[0], 1e-9, "leading exponent");
    assert_close(two.exponents[1], all.exponents[1], 1e-9, "second exponent");
}

#[test]
fn exponents_of_a_periodic_motion_are_those_of_its_multipliers() {
    let point = point(5.5);
    let mut recognizer = Recognizer::new(&point, RecognitionOptions::default()).unwrap();
    let mut state = rest();
    settle(recognizer.flow(), &mut state, 600).unwrap();
    let Recognition::Periodic(attractor) = recognizer.recognize(&state).unwrap() else {
        panic!("not periodic");
    };
    let period = std::f64::consts::TAU / 5.5;
    let options = LyapunovOptions {
        periods: 2000,
        ..LyapunovOptions::default()
    };
    let found = lyapunov(recognizer.flow(), &mut state, &options).unwrap();
    for (exponent, multiplier) in found.exponents.iter().zip(attractor.orbit.unwrap().multipliers) {
        // Directions of a complex pair turn: their growth is periodic and its mean known to one turn in the window.
        assert_close(*exponent, multiplier.norm().ln() / period, 2e-3, "exponent");
    }
    assert_close(found.sum(), SUM, 1e-12, "sum");
}

/// A motion that has not arrived yet, but will: Newton's method finds where.
#[test]
fn a_slow_approach_is_recognised_before_it_ends() {
    let point = point(5.5);
    let mut recognizer = Recognizer::new(&point, RecognitionOptions::default()).unwrap();
    let mut state = rest();
    settle(recognizer.flow(), &mut state, 150).unwrap();
    let Recognition::Periodic(attractor) = recognizer.recognize(&state).unwrap() else {
        panic!("not recognised");
    };
    assert!(attractor.mismatch > 1e-7);
    let orbit = attractor.orbit.unwrap();
    let frequency = point.frequency;
    let summary = recognizer
        .shooting(1)
        .unwrap()
        .summarize(
            &orbit.start,
            frequency,
            &point.system.outputs,
            &Default::default(),
        )
        .unwrap();
    assert_close(summary.measures[2].rms, 0.017910027661, 1e-12, "lower motion");
}

/// Motions that 40 periods do not show: one that repeats after 32 but is approached slowly, one that repeats after 64.
#[test]
fn a_negative_exponent_leads_to_the_periodic_motion_behind_it() {
    let starts = [
        (0.9572, [-0.33426, -0.35137, 0.36846, 0.71898], 32),
        (1.0292, [-0.48765, -0.58642, 0.27840, 0.38981], 64),
    ];
    for (frequency, start, periods) in starts {
        let mut recognizer = Recognizer::new(&point(frequency), RecognitionOptions::default()).unwrap();
        let mut state = start.to_vec();
        let found = classify(&mut recognizer, &mut state, &ClassifyOptions::default()).unwrap();
        let Attractor::Periodic(periodic) = found else {
            panic!("{found:?}");
        };
        assert_eq!(periodic.periods, periods);
        assert!(periodic.orbit.unwrap().is_stable());
    }
}

#[test]
fn a_start_on_an_unstable_orbit_is_followed_until_it_leaves() {
    let point = point(5.5);
    let mut recognizer = Recognizer::new(&point, RecognitionOptions::default()).unwrap();
    let file = reference("clutch_nominal.json");
    let middle = file["branches"]["second_resonance"]["orbits"]
        .as_array()
        .unwrap()
        .iter()
        .find(|orbit| number(&orbit["Omega"]) == 5.5 && orbit["stable"] == false)
        .unwrap();
    let mut state = numbers(&middle["x0"]);
    assert!(matches!(
        recognizer.recognize(&state).unwrap(),
        Recognition::NotPeriodic { mismatch, .. } if mismatch < 1e-7
    ));
    let found = classify(&mut recognizer, &mut state, &ClassifyOptions::default()).unwrap();
    assert_eq!(kind(&found), "period 1");
}

/// The map of the reference grid, 31 by 31 starts at rest of the accessory, and the number of its cells.
fn basin_map() -> (BasinMap, usize) {
    let values = |limit: f64| -> Vec<f64> {
        (0..31)
            .map(|i| -limit + 2.0 * limit * f64::from(i) / 30.0)
            .collect()
    };
    let across = Axis {
        entry: 0,
        values: values(0.3),
    };
    let down = Axis {
        entry: 2,
        values: values(1.5),
    };
    let rows = down.values.len();
    let grid = Grid::new(rest(), across, down).unwrap();
    // Rows in reverse: the merged map must not depend on who finishes first.
    let map = basin::merge(
        (0..rows)
            .rev()
            .map(|row| basin::row(&point(5.5), &grid, row, &BasinOptions::default()).unwrap())
            .collect(),
    );
    (map, rows * rows)
}

fn check_basin(map: &BasinMap, cells: usize, upper: std::ops::RangeInclusive<usize>) {
    assert_eq!(map.attractors.len(), 2);
    assert_eq!(map.count(Cell::NotPeriodic) + map.count(Cell::Failed), 0);
    let largest = |number: usize| map.attractors[number].points[0][2].abs();
    let number = if largest(0) > largest(1) { 0 } else { 1 };
    assert!(
        upper.contains(&map.count(Cell::Attractor(number))),
        "{} of {cells}",
        map.count(Cell::Attractor(number))
    );
    assert_eq!(
        map.count(Cell::Attractor(0)) + map.count(Cell::Attractor(1)),
        cells
    );
}

#[test]
fn basin_of_the_upper_motion_on_the_reference_grid() {
    let file = reference("clutch_nominal.json");
    let expected = file["basin"]["count_upper"].as_u64().unwrap() as usize;
    let (map, cells) = basin_map();
    assert_eq!(cells as u64, file["basin"]["n_cells"].as_u64().unwrap());
    check_basin(&map, cells, expected - 2..=expected + 2);
}

/// At a chaotic frequency no cell may be given to a periodic motion.
#[test]
fn cells_that_reach_no_periodic_motion_stay_apart() {
    let axis = |entry| Axis {
        entry,
        values: vec![-0.1, 0.2],
    };
    let grid = Grid::new(rest(), axis(0), axis(2)).unwrap();
    let row = basin::row(&point(1.0), &grid, 1, &BasinOptions::default()).unwrap();
    assert_eq!(row.cells, [Cell::NotPeriodic, Cell::NotPeriodic]);
    assert!(row.attractors.is_empty());
    assert!(
        basin::row(&point(1.0), &grid, 2, &BasinOptions::default())
            .unwrap()
            .cells
            .is_empty()
    );
    let error = Grid::new(rest(), axis(0), axis(0)).unwrap_err();
    assert_eq!(error, GridError::SameEntry { entry: 0 });
    let error = Grid::new(rest(), axis(0), axis(4)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the grid varies state entry 4, but the state has 4 entries"
    );
}
