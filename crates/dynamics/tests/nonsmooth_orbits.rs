//! Periodic motions with one-way clutches and dry friction against the reference of theory 05 §12.

use serde_json::Value;
use slackside_dynamics::attractor::{Recognition, RecognitionOptions, Recognizer};
use slackside_dynamics::flow::{ExactFlow, Record, Request};
use slackside_dynamics::orbit::periodic::{PeriodicMotion, PeriodicSearch, PeriodicSettings};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_mechanics::laws::{Decoupler, asymmetric_coulomb, coulomb, one_way, one_way_damper};
use slackside_mechanics::{Law, OperatingPoint, OutsideDomain, SystemFamily};
use slackside_testkit::nonsmooth_reference::{Machine, Place, nonsmooth_reference, operating_point};
use slackside_testkit::number;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The law that an input asks for.
fn law(place: Place, input: &Value) -> Arc<dyn Law> {
    let value = |key: &str, default: f64| input.get(key).map_or(default, number);
    match place {
        Place::Clutch => match input["clutch"]["type"].as_str() {
            None => Arc::new(one_way()),
            Some("decoupler") => Arc::new(Decoupler::new(number(&input["clutch"]["k"]), 0.0, 0.0).unwrap()),
            Some("viscous") => Arc::new(one_way_damper(number(&input["clutch"]["c"]))),
            Some(other) => panic!("unknown clutch {other}"),
        },
        Place::Arm => match input["law"]["type"].as_str() {
            None => Arc::new(coulomb(value("Q", 0.0), value("static_ratio", 1.0))),
            Some("asymmetric") => Arc::new(asymmetric_coulomb(
                number(&input["law"]["Q_minus"]),
                number(&input["law"]["Q_plus"]),
                1.0,
            )),
            Some("one_way_damper") => Arc::new(one_way_damper(number(&input["law"]["c"]))),
            Some(other) => panic!("unknown law {other}"),
        },
    }
}

fn solve(point: &OperatingPoint) -> (PeriodicMotion, Record) {
    let mut flow = ExactFlow::new(point).unwrap();
    let start = vec![0.0; 2 * point.system.order() + point.system.internal_states()];
    let mut search = PeriodicSearch::new(&mut flow, &point.system, PeriodicSettings::default());
    let motion = search.from_state(&start).unwrap();
    let request = Request {
        extremes: true,
        account: true,
        ..Request::default()
    };
    let record = search.record(&motion, &point.system.outputs, &request).unwrap();
    (motion, record)
}

/// The status letter of a regime in the reference.
fn letter(name: &str) -> &'static str {
    match name {
        "overrunning" | "slip-" | "free-wheeling" => "L",
        "locked" | "stick" => "S",
        "slip+" | "driving" => "R",
        "engaged" => "E",
        other => panic!("unknown regime {other}"),
    }
}

#[test]
fn periodic_motions_of_the_reference() {
    let file = nonsmooth_reference();
    for entry in file["periodic"].as_array().unwrap() {
        let input = &entry["input"];
        let name = input["name"].as_str().unwrap();
        let point = operating_point(&file, Machine::of(input), input, &law);
        let (motion, record) = solve(&point);
        assert!(motion.residual < 1e-13, "{name}: {:.1e}", motion.residual);
        let tables: Vec<_> = (point.system.elements.iter())
            .map(|element| element.law.regimes().unwrap())
            .collect();
        let events = entry["events"].as_array().unwrap();
        let found: Vec<String> = record
            .events
            .iter()
            .map(|e| format!("{:.12} {} {}→{}", e.phase / TAU, e.element, e.from, e.to))
            .collect();
        assert_eq!(events.len(), record.events.len(), "{name}: {found:?} {events:?}");
        for (event, expected) in record.events.iter().zip(events) {
            let difference = (event.phase / TAU - number(&expected["t_over_T"])).abs();
            assert!(difference < 1e-11, "{name}: event {difference:.1e} {found:?}");
            let regimes = &tables[event.element].regimes;
            // With two elements the statuses of both are listed: "S/L".
            let status = |key: &str| {
                let all = expected[key].as_str().unwrap().split('/').collect::<Vec<_>>();
                all[if all.len() > 1 { event.element } else { 0 }].to_owned()
            };
            for (regime, key) in [(event.from, "before"), (event.to, "after")] {
                let known = status(key).replace('O', "L");
                assert_eq!(
                    letter(regimes[regime].name),
                    known,
                    "{name}: {found:?} {expected}"
                );
            }
        }
        let n = point.system.order();
        let torques = point.system.elements.len();
        let groups = [
            ("q", 0),
            ("qdot", n),
            ("element_force", 2 * n),
            ("tension_dynamic", 2 * n + torques),
        ];
        for (group, first) in groups {
            for statistic in ["mean", "rms", "max", "min"] {
                let list = entry[group][statistic].as_array().unwrap();
                for (i, expected) in list.iter().enumerate() {
                    let Some(expected) = expected.as_f64() else {
                        continue;
                    };
                    let measure = &record.measures[first + i];
                    let found = match statistic {
                        "mean" => measure.mean,
                        "rms" => measure.rms,
                        "max" => measure.max,
                        _ => measure.min,
                    };
                    let size = expected.abs().max(measure.rms).max(1e-5);
                    assert!(
                        (found - expected).abs() <= 1e-9 * size,
                        "{name} {group}[{i}] {statistic}: {found} {expected}"
                    );
                }
            }
        }
        let imbalance = record.account.as_ref().unwrap().imbalance();
        assert!(imbalance < 1e-12, "{name}: energy account {imbalance:.1e}");
    }
}

/// The accessory's angle is free: shooting turns it back, and finds the motions that the search finds.
#[test]
fn continuation_by_shooting_passes_over_cyclic_coordinates() {
    let file = nonsmooth_reference();
    let input = serde_json::json!({"W": 400.0, "Ml": 3.0, "system": "clutch"});
    let family = Arc::new(OverFrequency { file, input });
    let mut shooting = Shooting::new(family.clone(), 400.0, 1).unwrap();
    let (motion, _) = solve(&family.at(400.0).unwrap());
    let orbit = shooting.solve(&motion.start, 400.0).unwrap();
    assert!(orbit.residual < 1e-11 && orbit.is_stable());
    // The derivative with respect to the frequency, on which load and matrices depend, against differences.
    let (_, _, rate) = shooting.map(&orbit.start, 400.0).unwrap();
    let end = |w: f64| {
        Shooting::new(family.clone(), w, 1)
            .unwrap()
            .map(&orbit.start, w)
            .unwrap()
            .0
    };
    let step = 1e-3;
    let (plus, minus) = (end(400.0 + step), end(400.0 - step));
    let size = rate.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    for i in 0..rate.len() {
        let difference = (plus[i] - minus[i]) / (2.0 * step);
        assert!(
            (difference - rate[i]).abs() < 1e-6 * size,
            "{i}: {difference} {}",
            rate[i]
        );
    }
}

struct OverFrequency {
    file: Value,
    input: Value,
}

impl SystemFamily for OverFrequency {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        let mut input = self.input.clone();
        input["W"] = Value::from(parameter);
        Ok(operating_point(&self.file, Machine::of(&input), &input, &law))
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

/// Over frequency, inertia ratio, load and friction from a thousandth of the critical value to above it, the search converges, and
/// a start far away leads to the same motion.
#[test]
fn the_search_converges_everywhere_and_from_anywhere() {
    let file = nonsmooth_reference();
    // Points of a lattice in four dimensions, by multiples of irrational numbers.
    let fraction = |k: usize, step: f64| (k as f64 * step).fract();
    for k in 1..=120 {
        let frequency = 24.0 * (1260.0_f64 / 24.0).powf(fraction(k, 0.618_034));
        let share = 10.0_f64.powf(-3.0 + 3.04 * fraction(k, 0.414_214));
        let alpha = 0.2 * (24.0_f64 / 0.2).powf(fraction(k, 0.732_051));
        let input = if k % 2 == 0 {
            serde_json::json!({"W": frequency, "Ml": 20.0 * share, "alpha": alpha, "system": "clutch"})
        } else {
            serde_json::json!({"W": frequency, "Q": 5.0 * share, "system": "friction"})
        };
        let point = operating_point(&file, Machine::of(&input), &input, &law);
        let n = point.system.order();
        let far: Vec<f64> = (0..2 * n)
            .map(|i| if i < n { 0.02 } else { 4.0 } * (fraction(k + i, 0.236_068) - 0.5))
            .collect();
        let mut flow = ExactFlow::new(&point).unwrap();
        let mut search = PeriodicSearch::new(&mut flow, &point.system, PeriodicSettings::default());
        let mut records = Vec::new();
        for start in [vec![0.0; 2 * n], far] {
            let motion = search
                .from_state(&start)
                .unwrap_or_else(|error| panic!("{input}: {error}"));
            assert!(motion.residual <= 1e-12, "{input}: {:.1e}", motion.residual);
            records.push(
                search
                    .record(&motion, &point.system.outputs, &Request::default())
                    .unwrap(),
            );
        }
        let size = |from: usize| {
            records[0].measures[from..from + n]
                .iter()
                .map(|m| m.rms)
                .fold(0.0, f64::max)
        };
        for (group, size) in [(0, size(0)), (n, size(n))] {
            for i in group..group + n {
                let (a, b) = (records[0].measures[i].rms, records[1].measures[i].rms);
                // The angle of the accessory is cyclic: its RMS depends on where the motion begins.
                let cyclic = group == 0 && k % 2 == 0 && i == 3;
                assert!(cyclic || (a - b).abs() < 1e-9 * size, "{input} {i}: {a} {b}");
            }
        }
    }
}

/// Just above the critical torque the arm creeps for ever at the edge of the places where it may stick; the motion at rest in
/// their middle is the answer, as it is well above.
#[test]
fn just_above_the_critical_torque_the_arm_is_at_rest() {
    let file = nonsmooth_reference();
    for entry in file["critical_torque"].as_array().unwrap() {
        for factor in [1.001, 1.05] {
            let mut input = entry["input"].clone();
            input["Q"] = Value::from(factor * number(&entry["Q_cr"]));
            input["system"] = Value::from("friction");
            let point = operating_point(&file, Machine::Friction, &input, &law);
            let (motion, record) = solve(&point);
            assert_eq!(motion.stuck, [0], "{input}: {:?}", record.events);
            assert!(record.events.is_empty());
            let offset = record.measures[1].mean - number(&entry["arm_offset"]);
            assert!(offset.abs() < 1e-11, "{input}: {offset:.1e}");
        }
    }
}

/// A motion with an overrunning accessory repeats although the accessory's angle drifts, and a sweep sees that.
#[test]
fn a_sweep_recognises_motions_that_drift() {
    let file = nonsmooth_reference();
    let input = serde_json::json!({"W": 400.0, "Ml": 3.0, "system": "clutch"});
    let point = operating_point(&file, Machine::Clutch, &input, &law);
    let mut recognizer = Recognizer::new(&point, RecognitionOptions::default()).unwrap();
    let mut state = vec![0.0; 2 * point.system.order()];
    recognizer.flow().advance(&mut state, 300, &mut []).unwrap();
    assert!(
        state[3].abs() > 1.0,
        "the accessory has overrun by {} rad",
        state[3]
    );
    let Recognition::Periodic(found) = recognizer.recognize(&state).unwrap() else {
        panic!("not recognised");
    };
    assert!(found.periods == 1 && found.orbit.is_some());
}
