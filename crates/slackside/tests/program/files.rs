//! Directories of results: complete, replaced as a whole, never half-written.

use super::{example, failure, slackside};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_result_has_tables_figures_and_json_and_is_replaced_whole() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("deep/result");
    let target = out.to_str().unwrap();
    let nominal = example("two_pulley_nominal.toml");
    let run = slackside(&[
        "response",
        &nominal,
        "--over",
        "frequency=4:8",
        "--at",
        "5",
        "--out",
        target,
    ]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let first = names(&out);
    for expected in [
        "at.csv",
        "branches.csv",
        "branches.parquet",
        "engagement.png",
        "events.csv",
        "response_pulley_max.svg",
        "response_windup_rms.png",
        "response_windup_rms.svg",
        "result.json",
        "special.csv",
    ] {
        assert!(
            first.iter().any(|name| name == expected),
            "{expected} is not in {first:?}"
        );
    }
    let table = std::fs::read_to_string(out.join("special.csv")).unwrap();
    assert!(
        table.lines().any(|line| line.contains("fold,4.48082372624")),
        "{table}"
    );
    let run = slackside(&["simulate", &nominal, "--frequency", "5", "--out", target]);
    assert!(run.status.success());
    let second = names(&out);
    assert!(second.contains(&"time_history.svg".to_owned()));
    assert!(
        !second.contains(&"branches.csv".to_owned()),
        "the old result is still there"
    );
    assert_eq!(
        names(&folder.path().join("deep")),
        ["result"],
        "nothing else is left"
    );
}

#[test]
fn a_directory_that_holds_something_else_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("thesis.tex"), "years of work").unwrap();
    let target = folder.path().to_str().unwrap();
    let (status, message) = failure(&["check", &example("two_pulley_nominal.toml"), "--out", target]);
    assert_eq!(status, 2);
    assert!(message.contains("choose another directory"), "{message}");
    assert_eq!(names(folder.path()), ["thesis.tex"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_what_is_finished_and_nothing_half_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("result");
    let nominal = example("two_pulley_nominal.toml");
    let mut run = Command::new(env!("CARGO_BIN_EXE_slackside"))
        .args(["simulate", &nominal, "--frequency", "5", "--periods", "50000000"])
        .args(["--samples", "0", "--out", out.to_str().unwrap()])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    let killed = Command::new("kill")
        .args(["-INT", &run.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    let status = run.wait().unwrap();
    assert_eq!(status.code(), Some(1));
    let result: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("result.json")).unwrap()).unwrap();
    let warning = result["warnings"][0].as_str().unwrap();
    assert!(warning.starts_with("interrupted after"), "{warning}");
    assert_eq!(names(folder.path()), ["result"]);
}
