//! The reference's tables over load, friction and frequency (theory 05 §12), and its motions from rest, from model files.

use crate::nonsmooth_files::subject;
use crate::nonsmooth_periodic::{Differences, compare_events, orbit, sequence};
use serde_json::{Value, json};
use slackside_studies::simulate::{Initial, Simulate};
use slackside_studies::{Signal, execute};
use slackside_testkit::nonsmooth_reference::nonsmooth_reference;
use slackside_testkit::number;

/// The motion of the reference's drive with the given input.
fn motion(file: &Value, input: &Value) -> Value {
    orbit(&subject(file, input))
}

fn friction(row: &Value) -> Value {
    json!({"system": "friction", "W": row["W"], "Q": row["Q"]})
}

#[test]
fn motions_from_rest_have_the_events_of_the_reference() {
    let file = nonsmooth_reference();
    let mut differences = Differences::default();
    for entry in file["transients"].as_array().unwrap() {
        let input = &entry["input"];
        let label = input["name"].as_str().unwrap();
        let study = Simulate {
            subject: subject(&file, input),
            frequency: None,
            periods: input["t_end_periods"].as_u64().unwrap() as usize,
            samples: 16,
            initial: Initial::Zero,
        };
        let found = serde_json::to_value(execute(&study, &Signal::none()).unwrap()).unwrap();
        let period = number(&found["period"]);
        compare_events(
            &found["events"],
            &entry["events"],
            input,
            label,
            &mut differences,
            |event| number(&event["time"]) / period,
        );
        let events = found["events"].as_array().unwrap().iter();
        for (event, expected) in events.zip(entry["events"].as_array().unwrap()) {
            let difference = (number(&event["time"]) - number(&expected["t"])).abs();
            differences.see("event times, in periods", difference / period);
        }
        differences.see("energy balance", number(&found["energy"]["imbalance"]));
    }
    differences.assert(&[
        ("event phases", 1e-10),
        ("event times, in periods", 1e-10),
        ("energy balance", 1e-9),
    ]);
}

#[test]
fn engaged_time_over_the_load() {
    let file = nonsmooth_reference();
    let mut differences = Differences::default();
    for row in file["engaged_table"].as_array().unwrap() {
        let found = motion(
            &file,
            &json!({"system": "clutch", "W": row["W"], "Ml": row["Ml"]}),
        );
        differences.see(
            "engaged share of time",
            (number(&found["engaged_ratio"]) - number(&row["engaged"])).abs(),
        );
        let events = found["events"].as_array().unwrap().iter();
        let openings = events.filter(|event| event["to"] == "overrunning").count();
        let expected = row.get("disengagements").map_or(0.0, number);
        assert_eq!(openings as f64, expected, "{row}");
    }
    differences.assert(&[("engaged share of time", 1e-10)]);
}

#[test]
fn dissipation_over_the_friction() {
    let file = nonsmooth_reference();
    let mut differences = Differences::default();
    for row in file["dissipation_table"].as_array().unwrap() {
        let found = motion(&file, &friction(row));
        let arm = &found["elements"]["arm_friction"];
        let (dissipation, expected) = (number(&arm["dissipation"]), number(&row["E"]));
        let size = if expected == 0.0 { 1.0 } else { expected };
        differences.see("dissipation", (dissipation - expected).abs() / size);
        differences.see(
            "sticking share of time",
            (number(&found["regimes"]["arm_friction"]["stick"]) - number(&row["stick_fraction"])).abs(),
        );
        assert_eq!(
            number(&arm["velocity_reversals"]),
            2.0 * number(&row["reversals_per_half"]),
            "{row}"
        );
        assert_eq!(
            number(&arm["stops"]),
            2.0 * number(&row["stops_per_half"]),
            "{row}"
        );
        assert_eq!(sequence(&found, "arm_friction"), row["sequence"], "{row}");
    }
    for row in file["matrix_den_hartog"].as_array().unwrap() {
        let found = motion(&file, &friction(row));
        let arm = &found["measures"]["arm"];
        differences.relative(
            "arm's amplitude",
            number(&arm["max"]),
            number(&row["arm_extreme"]),
        );
        differences.relative(
            "dissipation",
            number(&found["elements"]["arm_friction"]["dissipation"]),
            number(&row["dissipation"]),
        );
        assert_eq!(sequence(&found, "arm_friction"), row["sequence"], "{row}");
    }
    differences.assert(&[
        ("dissipation", 1e-9),
        ("sticking share of time", 1e-10),
        ("arm's amplitude", 1e-9),
    ]);
}

#[test]
fn the_friction_that_dissipates_most() {
    let file = nonsmooth_reference();
    let mut differences = Differences::default();
    for row in file["optimum_torque"].as_array().unwrap() {
        let (best, most) = (number(&row["Q_opt"]), number(&row["E_max"]));
        let dissipation = |torque: f64| {
            let input = json!({"system": "friction", "W": row["input"]["W"], "Q": torque});
            let found = motion(&file, &input);
            number(&found["elements"]["arm_friction"]["dissipation"])
        };
        differences.relative("dissipation at the optimum", dissipation(best), most);
        // The slope by differences of fourth order on either side of the optimum, and its zero.
        let slope = |torque: f64| {
            let h = 1e-3 * best;
            let pair = |k: f64| dissipation(torque + k * h) - dissipation(torque - k * h);
            (8.0 * pair(1.0) - pair(2.0)) / (12.0 * h)
        };
        let (mut low, mut high) = (0.999 * best, 1.001 * best);
        let (mut at_low, mut at_high) = (slope(low), slope(high));
        assert!(at_low > 0.0 && at_high < 0.0);
        for _ in 0..3 {
            let zero = low - at_low * (high - low) / (at_high - at_low);
            let value = slope(zero);
            if value > 0.0 {
                (low, at_low) = (zero, value);
            } else {
                (high, at_high) = (zero, value);
            }
        }
        let zero = low - at_low * (high - low) / (at_high - at_low);
        differences.relative("optimum", zero, best);
    }
    differences.assert(&[("dissipation at the optimum", 1e-9), ("optimum", 1e-8)]);
}

#[test]
fn critical_loads_and_torques_divide_locked_motions_from_others() {
    let file = nonsmooth_reference();
    for entry in file["critical_load"].as_array().unwrap() {
        let mut input = entry["input"].clone();
        input["system"] = json!("clutch");
        for (share, opens) in [(1.0 + 1e-6, false), (1.0 - 1e-6, true)] {
            input["Ml"] = json!(share * number(&entry["M_crit"]));
            let found = motion(&file, &input);
            assert_eq!(!found["events"].as_array().unwrap().is_empty(), opens, "{input}");
        }
    }
    for entry in file["critical_torque"].as_array().unwrap() {
        let mut input = entry["input"].clone();
        input["system"] = json!("friction");
        for (share, slips) in [(1.0 + 1e-3, false), (1.0 - 1e-3, true)] {
            input["Q"] = json!(share * number(&entry["Q_cr"]));
            let found = motion(&file, &input);
            // Ever smaller slips may lead to the locked motion (theory 05 §5.2): what they dissipate is rounding.
            let slip = number(&found["elements"]["arm_friction"]["dissipation"]) / number(&input["Q"]);
            assert_eq!(slip > 1e-9, slips, "{input}: {slip:e}");
            if found["events"].as_array().unwrap().is_empty() {
                // The middle of the places in which the arm may stick.
                let arm = number(&found["measures"]["arm"]["mean"]);
                assert!(
                    (arm - number(&entry["arm_offset"])).abs() < 1e-9,
                    "{input}: {arm}"
                );
            }
        }
    }
}
