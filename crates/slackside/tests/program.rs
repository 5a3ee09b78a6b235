//! The program as its users meet it: documents, numbers, messages, exit statuses, files.

#[path = "program/answers.rs"]
mod answers;
#[path = "program/drive.rs"]
mod drive;
#[path = "program/files.rs"]
mod files;
#[path = "program/limit.rs"]
mod limit;
#[path = "program/messages.rs"]
mod messages;
#[path = "program/multiple_scales.rs"]
mod multiple_scales;
#[path = "program/set_valued.rs"]
mod set_valued;

use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Output};

/// An example file by name.
fn example(name: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    folder.join(name).display().to_string()
}

/// Runs the program.
fn slackside(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_slackside"))
        .args(arguments)
        .output()
        .unwrap()
}

/// The JSON document that `arguments` with `--json` print, and nothing else.
fn document(arguments: &[&str]) -> Value {
    let mut all = arguments.to_vec();
    all.push("--json");
    let output = slackside(&all);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Exit status and standard error of a run that fails.
fn failure(arguments: &[&str]) -> (i32, String) {
    let output = slackside(arguments);
    assert!(!output.status.success(), "{arguments:?} should fail");
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(!errors.contains("panicked"), "{errors}");
    (output.status.code().unwrap(), errors)
}

fn close(found: &Value, expected: f64, tolerance: f64, what: &str) {
    let found = found.as_f64().unwrap_or_else(|| panic!("{what}: {found}"));
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found}, expected {expected}"
    );
}

/// Parameters of the special points of one kind on a branch.
fn special(branch: &Value, kind: &str) -> Vec<f64> {
    let all = branch["special"].as_array().unwrap().iter();
    all.filter(|point| point["kind"] == kind)
        .map(|point| point["frequency"].as_f64().unwrap())
        .collect()
}
