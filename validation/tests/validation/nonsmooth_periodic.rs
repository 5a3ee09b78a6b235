//! The reference's periodic motions with one-way clutches and dry friction (theory 05 §12), from model files and through
//! the document that users read.

use crate::nonsmooth_files::subject;
use serde_json::{Value, json};
use slackside_studies::Subject;
use slackside_testkit::nonsmooth_reference::nonsmooth_reference;
use slackside_testkit::number;
use std::collections::BTreeMap;

/// The motion at the file's frequency, as the document of `response` has it.
pub fn orbit(subject: &Subject) -> Value {
    use slackside_dynamics::flow::{Request, open};
    use slackside_dynamics::orbit::periodic::{PeriodicSearch, PeriodicSettings};
    let point = subject.operating_point(None).unwrap();
    let mut flow = open(&point).unwrap();
    let start = vec![0.0; 2 * point.system.order() + point.system.internal_states()];
    let mut search = PeriodicSearch::new(flow.as_mut(), &point.system, PeriodicSettings::default());
    let motion = search.from_state(&start).unwrap();
    let request = Request {
        extremes: true,
        account: true,
        ..Request::default()
    };
    let record = search.record(&motion, &point.system.outputs, &request).unwrap();
    let mut value = serde_json::to_value(slackside_studies::motion(&point.system, &record, 1)).unwrap();
    let multipliers = motion.multipliers().unwrap();
    value["multipliers"] = multipliers.iter().map(|m| json!([m.re, m.im])).collect();
    value
}

/// The largest differences seen, by what they are differences of.
#[derive(Debug, Default)]
pub struct Differences(BTreeMap<&'static str, f64>);

impl Differences {
    pub fn see(&mut self, what: &'static str, difference: f64) {
        let largest = self.0.entry(what).or_default();
        // NaN is the largest difference of all.
        if difference.is_nan() || difference > *largest {
            *largest = difference;
        }
    }

    pub fn relative(&mut self, what: &'static str, found: f64, expected: f64) {
        self.see(what, (found - expected).abs() / expected.abs());
    }

    #[track_caller]
    pub fn assert(&self, tolerances: &[(&'static str, f64)]) {
        let shown = self.0.iter().map(|(what, value)| format!("{what} {value:.1e}"));
        println!("{}", shown.collect::<Vec<_>>().join(", "));
        let seen: Vec<&str> = self.0.keys().copied().collect();
        let mut expected: Vec<&str> = tolerances.iter().map(|(what, _)| *what).collect();
        expected.sort_unstable();
        assert_eq!(seen, expected, "compared");
        for (what, tolerance) in tolerances {
            let largest = self.0[what];
            assert!(largest <= *tolerance, "{what}: {largest:e}");
        }
    }
}

/// The status letter of the reference for a regime of the program.
fn letter(regime: &Value) -> &'static str {
    match regime.as_str().unwrap() {
        "overrunning" | "slip-" | "free-wheeling" => "L",
        "locked" | "stick" => "S",
        "slip+" | "driving" => "R",
        "engaged" => "E",
        other => panic!("unknown regime {other}"),
    }
}

/// The elements of a document in the order of the reference.
fn elements(input: &Value) -> Vec<&'static str> {
    let clutch = (input["system"] == "clutch").then_some("clutch");
    let friction = (input["system"] == "friction" || input.get("Q").is_some()).then_some("arm_friction");
    clutch.into_iter().chain(friction).collect()
}

/// Compares events in order: element, statuses before and after, phase.
pub fn compare_events(
    found: &Value,
    expected: &Value,
    input: &Value,
    label: &str,
    differences: &mut Differences,
    phase: impl Fn(&Value) -> f64,
) {
    let names = elements(input);
    let (found, expected) = (found.as_array().unwrap(), expected.as_array().unwrap());
    assert!(found.len() >= expected.len(), "{label}: {found:?}");
    for (found, expected) in found.iter().zip(expected) {
        let element = expected["element"].as_u64().unwrap() as usize;
        assert_eq!(found["element"], names[element], "{label}: {found}");
        for (here, there) in [("from", "before"), ("to", "after")] {
            // With two elements the statuses of both are listed: "S/L". An open decoupler is called O.
            let mut all = expected[there].as_str().unwrap().split('/');
            let status = if names.len() > 1 {
                all.nth(element)
            } else {
                all.next()
            };
            let status = status.unwrap().replace('O', "L");
            assert_eq!(letter(&found[here]), status, "{label}: {found} {expected}");
        }
        let difference = phase(found) - number(&expected["t_over_T"]);
        differences.see("event phases", (difference - difference.round()).abs());
    }
}

fn compare_measures(
    found: &Value,
    entry: &Value,
    group: &str,
    names: &[String],
    label: &str,
    differences: &mut Differences,
) {
    let expected = &entry[group];
    for (i, name) in names.iter().enumerate() {
        // Cyclic coordinates have no statistics.
        if expected["rms"][i].is_null() {
            continue;
        }
        let measure = &found["measures"][name];
        assert!(measure.is_object(), "{label}: no measure {name}");
        let size = ["mean", "rms", "max", "min"]
            .map(|statistic| number(&expected[statistic][i]).abs())
            .into_iter()
            .fold(0.0, f64::max);
        for (statistic, what) in [
            ("mean", "means"),
            ("rms", "rms"),
            ("max", "extremes"),
            ("min", "extremes"),
        ] {
            let difference = (number(&measure[statistic]) - number(&expected[statistic][i])).abs();
            // A coordinate that dry friction holds is zero but for rounding.
            if size < 1e-12 {
                differences.see("held coordinates", difference);
            } else {
                differences.see(what, difference / size);
            }
        }
    }
}

/// Letters of an element's regimes from the one at phase zero on, as the reference's `seq`.
pub fn sequence(motion: &Value, element: &str) -> String {
    let events = motion["events"].as_array().unwrap().iter();
    let own: Vec<&Value> = events.filter(|event| event["element"] == element).collect();
    match own.first() {
        Some(first) => {
            let after = own.iter().map(|event| letter(&event["to"]));
            std::iter::once(letter(&first["from"])).chain(after).collect()
        }
        None => {
            let regimes = motion["regimes"][element].as_object().unwrap().iter();
            let (name, _) = regimes
                .max_by(|a, b| number(a.1).total_cmp(&number(b.1)))
                .unwrap();
            letter(&json!(name)).to_owned()
        }
    }
}

#[test]
fn periodic_motions_from_files_agree_with_the_reference() {
    let file = nonsmooth_reference();
    let mut differences = Differences::default();
    for entry in file["periodic"].as_array().unwrap() {
        let input = &entry["input"];
        let label = input["name"].as_str().unwrap();
        let subject = subject(&file, input);
        let found = orbit(&subject);
        compare_events(
            &found["events"],
            &entry["events"],
            input,
            label,
            &mut differences,
            |event| number(&event["phase"]),
        );
        assert_eq!(
            found["events"].as_array().unwrap().len(),
            entry["events"].as_array().unwrap().len(),
            "{label}"
        );
        let point = subject.operating_point(None).unwrap();
        let coordinates = &point.system.coordinates;
        let rates: Vec<String> = coordinates.iter().map(|name| format!("{name}.rate")).collect();
        let names = elements(input);
        let forces: Vec<String> = names.iter().map(ToString::to_string).collect();
        let tensions: Vec<String> = (1..=3).map(|span| format!("tension_{span}")).collect();
        for (group, names) in [
            ("q", coordinates),
            ("qdot", &rates),
            ("element_force", &forces),
            ("tension_dynamic", &tensions),
        ] {
            compare_measures(&found, entry, group, names, label, &mut differences);
        }
        for (element, shares) in names.iter().zip(entry["fraction"].as_array().unwrap()) {
            for (status, share) in shares.as_object().unwrap() {
                let regimes = found["regimes"][element].as_object().unwrap().iter();
                let same = regimes.filter(|(name, _)| letter(&json!(name)) == status.replace('O', "L"));
                let sum: f64 = same.map(|(_, share)| number(share)).sum();
                differences.see("shares of time", (sum - number(share)).abs());
            }
        }
        if let Some(drift) = entry.get("drift_per_period") {
            let (found, expected) = (number(&found["drift"]["accessory"]), number(drift));
            // A locked clutch does not drift but for rounding.
            differences.see("drift", (found - expected).abs() / expected.max(1e-3));
        }
        let dissipation = |name: &str| number(&found["elements"][name]["dissipation"]);
        if let Some(expected) = entry.get("dissipation_per_period") {
            let (found, expected) = (dissipation("arm_friction"), number(expected));
            let size = if expected == 0.0 { 1.0 } else { expected };
            differences.see("dissipation", (found - expected).abs() / size);
        }
        if let Some(reversals) = entry.get("reversals") {
            let row = &found["elements"]["arm_friction"];
            for (here, there) in [("velocity_reversals", "nu"), ("stops", "stops")] {
                assert_eq!(
                    number(&row[here]),
                    2.0 * number(&reversals[there]),
                    "{label}: {here}"
                );
            }
            assert_eq!(sequence(&found, "arm_friction"), reversals["seq"], "{label}");
        }
        let energy = &entry["energy"];
        let size = number(&energy["input"]);
        let work: f64 = names.iter().map(|name| dissipation(name)).sum();
        for (found, expected) in [
            (number(&found["energy"]["load"]), "input"),
            (number(&found["energy"]["viscous"]), "viscous"),
            (work, "elements"),
        ] {
            differences.see("energy", (found - number(&energy[expected])).abs() / size);
        }
        differences.see("energy balance", number(&found["energy"]["imbalance"]));
        if let Some(moduli) = entry.get("floquet_moduli") {
            let multipliers = found["multipliers"].as_array().unwrap().iter();
            let mut found: Vec<f64> = multipliers.map(|m| number(&m[0]).hypot(number(&m[1]))).collect();
            found.sort_by(|a, b| b.total_cmp(a));
            for (found, expected) in found.iter().zip(moduli.as_array().unwrap()) {
                differences.see("Floquet moduli", (found - number(expected)).abs());
            }
        }
    }
    differences.assert(&[
        ("event phases", 1e-10),
        ("means", 1e-9),
        ("rms", 1e-9),
        ("extremes", 1e-9),
        ("held coordinates", 1e-12),
        ("shares of time", 1e-10),
        ("drift", 1e-9),
        ("dissipation", 1e-9),
        ("energy", 1e-9),
        ("energy balance", 1e-9),
        ("Floquet moduli", 1e-9),
    ]);
}
