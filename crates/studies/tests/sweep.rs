//! Sweeps and basins of the nominal clutch as studies: numbers, documents, interruption.

use serde_json::Value;
use slackside_dynamics::attractor::SweepOptions;
use slackside_dynamics::attractor::basin::BasinOptions;
use slackside_model_file::Document;
use slackside_studies::basin::Basin;
use slackside_studies::simulate::Initial;
use slackside_studies::sweep::{Direction, Sweep};
use slackside_studies::{Progress, Signal, StudyError, Subject, execute};
use slackside_testkit::{assert_close, number, reference};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

fn nominal() -> Subject {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples/two_pulley_nominal.toml");
    Subject::new(&Document::read(&path).unwrap()).unwrap()
}

fn quick(over: &str) -> Sweep {
    Sweep {
        options: SweepOptions {
            record_periods: 16,
            samples: 32,
            poincare_points: 50,
            ..SweepOptions::default()
        },
        ..Sweep::new(nominal(), over.parse().unwrap())
    }
}

#[test]
fn both_directions_agree_with_the_reference_and_part_between_the_folds() {
    let document = execute(&quick("frequency=4:7.2:0.1"), &Signal::none()).unwrap();
    let file = reference("clutch_nominal.json");
    for (rows, direction) in [(&document.up, "up"), (&document.down, "down")] {
        let expected = file["sweeps"][direction]["rows"].as_array().unwrap();
        assert_eq!(rows.len(), expected.len());
        for (row, expected) in rows.iter().zip(expected) {
            let label = format!("{direction} at {}", row.at.value);
            assert_close(row.at.value, number(&expected["Omega"]), 1e-12, &label);
            assert_eq!(row.kind, "periodic-1", "{label}");
            let windup = row.motion.measures.get("windup").unwrap();
            assert_close(windup.rms, number(&expected["delta_rms_ac"]), 1e-11, &label);
            assert!(row.largest_multiplier.unwrap() < 1.0);
        }
    }
    // The fundamental line of the motion as it ran, with 16 periods at line 16.
    let row = &document.up[0];
    let (name, amplitudes) = &row.spectra.measures[2];
    assert_eq!(name, "windup");
    assert_close(row.spectra.frequency[16], 4.0, 1e-12, "frequency of the line");
    let rms = row.motion.measures.get("windup").unwrap().rms;
    // At 4.0 the clutch stays engaged: the motion is a sinusoid.
    assert_close(amplitudes[16], rms * 2.0_f64.sqrt(), 1e-8, "fundamental");
    assert!(amplitudes[32] < 1e-6 * amplitudes[16]);

    let json = serde_json::to_value(&document).unwrap();
    assert_eq!(json["command"], "sweep");
    assert_eq!(json["down"][0]["frequency"], 7.2);
    assert_eq!(json["down"][0]["kind"], "periodic-1");
    assert!(json["down"][0]["measures"]["pulley"]["max"].is_number());
    assert_eq!(json["down"][0]["poincare"][0].as_array().unwrap().len(), 4);
    assert_eq!(
        json["state"],
        serde_json::json!(["pulley", "accessory", "pulley.rate", "accessory.rate"])
    );
}

#[test]
fn motions_that_do_not_repeat_carry_what_shows_it() {
    let study = Sweep {
        directions: vec![Direction::Down],
        ..quick("frequency=0.95:1:0.05")
    };
    let document = execute(&study, &Signal::none()).unwrap();
    assert!(document.up.is_empty());
    let [chaos, torus] = &document.down[..] else {
        panic!("two steps");
    };
    assert_eq!((chaos.at.value, chaos.kind.as_str()), (1.0, "chaotic"));
    let lyapunov = chaos.lyapunov.as_ref().unwrap();
    assert!(lyapunov.exponents[0] > 0.02 && chaos.rotation_number.is_none());
    assert!(chaos.motion.events.is_empty());
    assert_eq!(
        (torus.kind.as_str(), torus.poincare.len()),
        ("quasi-periodic", 50)
    );
    assert_close(
        torus.rotation_number.unwrap(),
        0.22361080720346,
        1e-7,
        "rotation number",
    );
    // Broad band: chaos has amplitudes between the lines of the load (16 and 32), where a periodic motion has none.
    let amplitudes = &chaos.spectra.measures[2].1;
    let between = amplitudes[19..30].iter().copied().fold(0.0, f64::max);
    assert!(
        between > 1e-2 * amplitudes[16],
        "{between} beside {}",
        amplitudes[16]
    );
}

#[test]
fn interruption_keeps_the_steps_that_are_done() {
    let steps = Arc::new(AtomicUsize::new(0));
    let interrupted = Arc::new(AtomicBool::new(false));
    let (count, flag) = (steps.clone(), interrupted.clone());
    let signal = Signal::new(interrupted, move |progress| {
        if matches!(progress, Progress::Step(_)) && count.fetch_add(1, Ordering::Relaxed) == 2 {
            flag.store(true, Ordering::Relaxed);
        }
    });
    let study = Sweep {
        directions: vec![Direction::Up],
        ..quick("frequency=4:7.2:0.1")
    };
    let document = execute(&study, &signal).unwrap();
    assert_eq!((document.up.len(), document.down.len()), (3, 0));
    assert_eq!(
        document.header.warnings,
        ["interrupted: the sweep up has 3 of 33 values"]
    );
    assert!(matches!(execute(&study, &signal), Err(StudyError::Interrupted)));
}

#[test]
fn a_key_of_the_model_is_swept_at_a_frequency() {
    // theory 02 §12: at 5.5 the motion jumps up at A_m = 0.0853070 and down at 0.0329107.
    let study = Sweep {
        frequency: Some(5.5),
        ..quick("dimensionless.crank_amplitude=0.02:0.1:0.01")
    };
    let document = execute(&study, &Signal::none()).unwrap();
    let jump = |rows: &[slackside_studies::sweep::SweepRow]| {
        let rms: Vec<f64> = rows
            .iter()
            .map(|row| row.motion.measures.get("windup").unwrap().rms / row.at.value)
            .collect();
        let at = (1..rms.len())
            .max_by(|&a, &b| {
                (rms[a] / rms[a - 1])
                    .ln()
                    .abs()
                    .total_cmp(&(rms[b] / rms[b - 1]).ln().abs())
            })
            .unwrap();
        (rows[at - 1].at.value, rows[at].at.value)
    };
    let (before, after) = jump(&document.up);
    assert!(before < 0.0853070 && 0.0853070 < after, "{before} {after}");
    let (before, after) = jump(&document.down);
    assert!(after < 0.0329107 && 0.0329107 < before, "{before} {after}");
}

#[test]
fn wrong_questions_are_told_what_to_do() {
    let message = |study: &Sweep| execute(study, &Signal::none()).unwrap_err().to_string();
    let study = Sweep {
        initial: Initial::Given(vec![("crank".into(), 0.0)]),
        ..quick("frequency=4:5")
    };
    assert_eq!(
        message(&study),
        "--initial: there is no coordinate \"crank\"; known are pulley, accessory, pulley.rate, accessory.rate"
    );
    assert!(
        execute(&quick("dimensionless.preload=0.5:1"), &Signal::none())
            .unwrap_err()
            .is_input()
    );

    let mut map = basin(7);
    map.down.key = "crank".into();
    assert_eq!(
        execute(&map, &Signal::none()).unwrap_err().to_string(),
        "--over: `crank` is no entry of the state; choose from pulley, accessory, pulley.rate, accessory.rate"
    );
    map.down.key = "pulley".into();
    assert_eq!(
        execute(&map, &Signal::none()).unwrap_err().to_string(),
        "--over: both directions of the grid vary state entry 0: choose two different ones"
    );
}

fn basin(count: usize) -> Basin {
    let step = |limit: f64| 2.0 * limit / (count - 1) as f64;
    Basin {
        subject: nominal(),
        frequency: Some(5.5),
        across: format!("pulley=-0.3:0.3:{}", step(0.3)).parse().unwrap(),
        down: format!("pulley.rate=-1.5:1.5:{}", step(1.5)).parse().unwrap(),
        initial: Initial::Rest,
        options: BasinOptions::default(),
    }
}

#[test]
fn basins_count_the_cells_of_the_reference() {
    let document = execute(&basin(31), &Signal::none()).unwrap();
    assert_eq!(
        (document.not_periodic, document.failed, document.not_computed),
        (0, 0, 0)
    );
    let [a, b] = &document.attractors[..] else {
        panic!("{} attractors", document.attractors.len());
    };
    assert_eq!(a.cells + b.cells, 961);
    let rms = |row: &slackside_studies::basin::AttractorRow| row.measures.get("windup").unwrap().rms;
    let (upper, lower) = if rms(a) > rms(b) { (a, b) } else { (b, a) };
    assert_close(rms(upper), 0.065015578691, 1e-11, "upper motion");
    assert_close(rms(lower), 0.017910027661, 1e-11, "lower motion");
    assert!(upper.cells.abs_diff(673) <= 2, "{}", upper.cells);
    let json: Value = serde_json::to_value(&document).unwrap();
    assert_eq!(json["cells"].as_array().unwrap().len(), 31);
    assert_eq!(json["frequency"], 5.5);
    assert_eq!(json["down"]["entry"], "pulley.rate");
}

#[test]
fn an_interrupted_map_keeps_its_rows() {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = interrupted.clone();
    let signal = Signal::new(interrupted, move |progress| {
        if matches!(progress, Progress::Jobs { done, .. } if done >= 2) {
            flag.store(true, Ordering::Relaxed);
        }
    });
    let document = execute(&basin(31), &signal).unwrap();
    let missing = document.not_computed / 31;
    // Rows that ran beside the second one still end.
    assert!((1..=29).contains(&missing), "{missing}");
    assert_eq!(
        document.header.warnings,
        [format!("interrupted: {missing} rows of the map are missing")]
    );
    let empty = document
        .cells
        .iter()
        .filter(|row| row.iter().all(Option::is_none))
        .count();
    assert_eq!(empty, missing);
}
