//! `response --method multiple-scales` and `response --compare`.

use super::{close, document, example, failure, slackside, special};
use serde_json::Value;

fn nominal() -> String {
    example("two_pulley_nominal.toml")
}

const RANGE: [&str; 2] = ["--over", "frequency=4:8"];

#[test]
fn both_orders_have_the_folds_of_the_reference() {
    // Reference file, multiple_scales.second_mode.
    for (order, folds) in [
        ("1", [5.543629812059435, 5.918833967062869]),
        ("2", [4.929832399246849, 5.892823308906404]),
    ] {
        let file = nominal();
        let arguments = [
            &["response", &file][..],
            &RANGE,
            &["--method", "multiple-scales", "--order", order],
        ];
        let answer = document(&arguments.concat());
        assert_eq!(answer["method"]["name"], "multiple-scales");
        let branch = &answer["branches"][0];
        let mut found = special(branch, "fold");
        found.sort_by(f64::total_cmp);
        for (a, b) in found.iter().zip(folds) {
            assert!((a - b).abs() < 1e-8, "{a} {b}");
        }
        assert_eq!(found.len(), 2);
        assert_eq!(special(branch, "grazing").len(), 2);
        let points = branch["points"].as_array().unwrap();
        assert!(points.iter().any(|point| point["stable"] == false));
        assert!(
            points
                .iter()
                .all(|point| point["multipliers"].as_array().unwrap().len() == 2)
        );
        let open = |point: &&Value| point["engaged_ratio"].as_f64().unwrap() < 1.0;
        assert!(
            points
                .iter()
                .filter(open)
                .all(|point| point["events"].as_array().unwrap().len() == 2)
        );
    }
}

#[test]
fn states_at_a_value_are_those_of_the_reference() {
    let file = nominal();
    let arguments = [
        &["response", &file][..],
        &RANGE,
        &["--method", "multiple-scales", "--at", "6.2"],
    ];
    let answer = document(&arguments.concat());
    let at = &answer["at"][0];
    let scales = &at["multiple_scales"];
    close(&scales["amplitude"], 0.05094661523999639, 1e-9, "a");
    close(&scales["phase"], 2.5272014362378243, 1e-8, "psi");
    close(&scales["gamma"], 0.6419005273539534, 1e-8, "gamma");
    close(&at["measures"]["windup"]["rms"], 0.04582505875141709, 1e-9, "rms");
    close(
        &at["measures"]["windup"]["mean"],
        0.037412763731576155,
        1e-9,
        "mean",
    );
    assert_eq!(scales["validated"], true);
}

#[test]
fn physical_units_give_the_same_folds_in_hertz() {
    let file = example("two_pulley_physical.toml");
    let answer = document(&[
        "response",
        &file,
        "--over",
        "frequency=180:330",
        "--method",
        "multiple-scales",
    ]);
    let folds = special(&answer["branches"][0], "fold");
    // One unit of dimensionless frequency is 263.11740579 rad/s.
    let unit = 263.11740579 / std::f64::consts::TAU;
    assert!(
        folds
            .iter()
            .any(|fold| (fold / unit - 5.892823308906404).abs() < 1e-7),
        "{folds:?}"
    );
}

#[test]
fn without_separation_the_linear_response_is_given_and_said_so() {
    let file = nominal();
    let set = ["--set", "dimensionless.preload=2.7", "--at", "6.4"];
    let scales = [
        &["response", &file][..],
        &RANGE,
        &["--method", "multiple-scales"],
        &set,
    ]
    .concat();
    let shooting = [&["response", &file][..], &RANGE, &set].concat();
    let (scales, shooting) = (document(&scales), document(&shooting));
    let said = scales["warnings"].as_array().unwrap().iter();
    assert!(
        said.clone()
            .any(|text| text.as_str().unwrap().contains("linear response is exact"))
    );
    for measure in ["windup", "pulley", "clutch_torque"] {
        for statistic in ["mean", "rms", "max", "min"] {
            let of = |answer: &Value| answer["at"][0]["measures"][measure][statistic].as_f64().unwrap();
            assert!(
                (of(&scales) - of(&shooting)).abs() < 1e-12,
                "{measure}.{statistic}"
            );
        }
    }
}

#[test]
fn what_it_does_not_cover_is_answered_in_words() {
    let file = nominal();
    let method = ["--method", "multiple-scales"];
    let cases: [(Vec<&str>, i32, &str); 6] = [
        (vec!["--over", "frequency=2:3"], 1, "no primary resonance"),
        (
            vec!["--over", "frequency=4:8", "--mode", "3"],
            2,
            "there is no mode 3",
        ),
        (
            vec!["--over", "frequency=4:8", "--mode", "0"],
            2,
            "counted from 1",
        ),
        (
            vec!["--over", "frequency=4:8", "--periods", "2"],
            2,
            "the load's period only",
        ),
        (
            vec![
                "--over",
                "frequency=4:8",
                "--set",
                "dimensionless.damping_ratio=0",
            ],
            1,
            "no damping",
        ),
        (
            vec![
                "--over",
                "frequency=4:8",
                "--set",
                "smoothing.kind=tanh",
                "--set",
                "smoothing.width=0.002",
            ],
            1,
            "two straight pieces",
        ),
    ];
    for (options, status, text) in cases {
        let (found, message) = failure(&[&["response", &file][..], &options, &method].concat());
        assert!(message.contains(text), "{options:?}: {message}");
        assert_eq!(found, status, "{options:?}: {message}");
    }
}

#[test]
fn a_comparison_tells_errors_and_where_they_are_small() {
    let file = nominal();
    let set = ["--set", "dimensionless.damping_ratio=0.05", "--at", "6.2"];
    let answer = document(&[&["response", &file][..], &RANGE, &["--compare"], &set].concat());
    let errors = answer["errors"].as_array().unwrap();
    assert!(errors.len() > 30);
    for row in errors {
        let gamma = row["gamma"].as_f64().unwrap();
        // Theory 02 §11, with its worst case over several loads.
        let allowed = [
            (0.9, 0.0002),
            (0.8, 0.0007),
            (0.7, 0.0025),
            (0.6, 0.007),
            (0.5, 0.016),
        ];
        let bound = allowed
            .iter()
            .find(|(g, _)| gamma >= *g)
            .map_or(0.04, |(_, bound)| *bound);
        let second = row["second_order"].as_f64().unwrap();
        assert!(second < 1.1 * bound, "{gamma}: {second:e}");
        // The peak itself is flat: there interpolation between points is all that is seen.
        assert!(row["harmonic_balance"].as_f64().unwrap() < 5e-3, "{row}");
    }
    let within = answer["within"].as_array().unwrap();
    let of = |method: &str| within.iter().find(|row| row["method"] == method).unwrap();
    assert_eq!(of("second-order")["everywhere"], true);
    assert_eq!(of("first-order")["everywhere"], false);
    close(
        &of("first-order")["gamma"],
        0.79,
        0.03,
        "gamma of the first order",
    );
    let histories = answer["histories"].as_array().unwrap();
    assert_eq!(histories.len(), 3);
    let largest = |row: &Value| {
        let samples = row["deflection"].as_array().unwrap().iter();
        samples
            .map(|u| u.as_f64().unwrap())
            .fold(f64::NEG_INFINITY, f64::max)
    };
    assert!((largest(&histories[1]) / largest(&histories[0]) - 1.0).abs() < 0.02);
}

#[test]
fn a_validity_map_knows_all_four_kinds_of_cell() {
    let file = nominal();
    let maps = [
        "--map",
        "dimensionless.preload=0.5:2.7:1.1",
        "--map",
        "dimensionless.damping_ratio=0.03:0.07:0.04",
    ];
    let answer = document(
        &[
            &["response", &file][..],
            &RANGE,
            &["--compare", "--tolerance", "2%"],
            &maps,
        ]
        .concat(),
    );
    let cells = answer["map"]["cells"].as_array().unwrap();
    let kind = |row: usize, column: usize| cells[row][column]["validity"].as_str().unwrap().to_owned();
    assert_eq!((cells.len(), cells[0].as_array().unwrap().len()), (2, 3));
    assert_eq!(kind(0, 0), "neither");
    assert_eq!(kind(0, 1), "second-order");
    assert_eq!(kind(0, 2), "linear");
    assert_eq!(kind(1, 2), "linear");
    let output = slackside(&[
        "response",
        &file,
        "--over",
        "frequency=4:8",
        "--map",
        "dimensionless.preload=1:2",
    ]);
    assert_eq!(output.status.code(), Some(2));
}
