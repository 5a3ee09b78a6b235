//! Wrong input ends with status 2 and says where; questions without an answer end with status 1.

use super::{example, failure};

#[test]
fn wrong_input_is_told_where() {
    let nominal = example("two_pulley_nominal.toml");
    let nominal = nominal.as_str();
    let over = "frequency=4:6";
    let cases: &[(&[&str], &[&str])] = &[
        (
            &["check", "no_such_file.toml"],
            &["no_such_file.toml", "cannot read"],
        ),
        (
            &["check", nominal, "--set", "dimensionless.preload=0"],
            &["--set dimensionless.preload=0", "no preload"],
        ),
        (
            &["check", nominal, "--set", "dimensionless.preloat=1"],
            &["preloat", "preload"],
        ),
        (
            &["check", nominal, "--set", "dimensionless.preload"],
            &["KEY=VALUE"],
        ),
        (
            &["response", nominal, "--over", "frequency=4"],
            &["two or three numbers"],
        ),
        (
            &["response", nominal, "--over", "frequency=-1:4"],
            &["--over", "positive"],
        ),
        (
            &["response", nominal, "--over", "dimensionless.preload=1:2"],
            &["--frequency"],
        ),
        (
            &["response", nominal, "--over", "preload=1:2", "--frequency", "5"],
            &["dimensionless.preload"],
        ),
        (
            &["response", nominal, "--over", over, "--frequency", "5"],
            &["--frequency", "leave"],
        ),
        (
            &["response", nominal, "--over", over, "--at", "7"],
            &["--at", "outside"],
        ),
        (
            &["response", nominal, "--over", over, "--periods", "0"],
            &["--periods"],
        ),
        (
            &["response", nominal, "--over", over, "--measure", "torque"],
            &["--measure", "clutch_torque"],
        ),
        (
            &["response", nominal, "--over", over, "--method", "magic"],
            &["harmonic-balance"],
        ),
        (
            &["response", nominal, "--over", over, "--for", "frequency=1,2"],
            &["--for", "already varied"],
        ),
        (&["simulate", nominal], &["--frequency"]),
        (&["simulate", nominal, "--frequency", "-5"], &["positive"]),
        (
            &["simulate", nominal, "--frequency", "5", "--initial", "crank=1"],
            &["crank", "accessory.rate"],
        ),
        (
            &["simulate", nominal, "--frequency", "5", "--initial", "pulley"],
            &["COORD=VALUE"],
        ),
        (
            &["simulate", nominal, "--frequency", "5", "--samples", "100000000"],
            &["--samples"],
        ),
        (
            &["simulate", nominal, "--frequency", "1e-12"],
            &["--frequency", "higher"],
        ),
        (
            &["response", nominal, "--over", "frequency=1e-9:1"],
            &["--over", "higher"],
        ),
        (
            &[
                "response",
                nominal,
                "--over",
                over,
                "--method",
                "harmonic-balance",
                "--harmonics",
                "0",
            ],
            &["--harmonics", "highest order"],
        ),
        (&["modes", nominal, "--over", "frequency=1:2"], &["do not depend"]),
        (
            &["basin", nominal, "--frequency", "5", "--over", "pulley=0:1"],
            &["--over", "twice"],
        ),
        (&["check", nominal, "--json", "--out", "somewhere"], &["--json"]),
    ];
    for (arguments, parts) in cases {
        let (status, message) = failure(arguments);
        assert_eq!(status, 2, "{arguments:?}: {message}");
        for part in *parts {
            assert!(message.contains(part), "{arguments:?}: no `{part}` in {message}");
        }
    }
}

#[test]
fn a_mistake_in_the_file_is_one_line_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wrong.toml");
    let text = std::fs::read_to_string(example("two_pulley_nominal.toml")).unwrap();
    std::fs::write(
        &path,
        text.replace("preload          = 1.0", "preload = \"3 kg\""),
    )
    .unwrap();
    let (status, message) = failure(&["check", path.to_str().unwrap()]);
    assert_eq!(status, 2);
    assert!(
        message.contains("wrong.toml:12: dimensionless.preload"),
        "{message}"
    );
    assert_eq!(message.trim_end().lines().count(), 1, "{message}");
}

#[test]
fn a_question_without_an_answer_has_status_1() {
    let nominal = example("two_pulley_nominal.toml");
    // No motion of period seven exists far above the resonances.
    let (status, message) = failure(&[
        "response",
        &nominal,
        "--over",
        "frequency=20:21",
        "--periods",
        "7",
    ]);
    assert_eq!(status, 1, "{message}");
    assert!(message.contains("no motion that repeats after 7"), "{message}");
}
