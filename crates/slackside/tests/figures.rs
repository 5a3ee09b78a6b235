//! Every figure shows on numbers what its recipe says; recipes that ask for too much say so.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn slackside(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_slackside"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn figures() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../figures")
}

#[test]
fn every_figure_shows_its_phenomenon() {
    let folder = tempfile::tempdir().unwrap();
    let output = slackside(&["figure", "all", "--json", "--quiet"], folder.path());
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let found = document["figures"].as_array().unwrap();
    let recipes = std::fs::read_dir(figures()).unwrap();
    let recipes = recipes.filter(|entry| {
        entry
            .as_ref()
            .unwrap()
            .path()
            .extension()
            .is_some_and(|e| e == "toml")
    });
    assert_eq!(found.len(), recipes.count(), "every recipe is embedded");
    for figure in found {
        assert_eq!(figure["shown"], true, "{figure}");
        assert!(!figure["checks"].as_array().unwrap().is_empty());
    }
}

#[test]
fn a_figure_is_written_with_its_tables_and_recipe() {
    let folder = tempfile::tempdir().unwrap();
    let output = slackside(&["figure", "2.11", "--quiet"], folder.path());
    assert!(output.status.success());
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.starts_with("Figure 2.11: from K_d = 1 to 100"), "{told}");
    for name in [
        "natural_frequencies.svg",
        "natural_frequencies.png",
        "over.csv",
        "over.parquet",
        "recipe.toml",
        "result.json",
    ] {
        assert!(
            folder.path().join("out/figure_2.11").join(name).is_file(),
            "{name}"
        );
    }
}

#[test]
fn a_recipe_that_does_not_hold_ends_with_status_one() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(figures().join("2.14.toml")).unwrap();
    let wrong = text.replace("low_end < low", "low < low_end");
    assert_ne!(text, wrong);
    std::fs::write(folder.path().join("mine.toml"), wrong).unwrap();
    let output = slackside(&["figure", "mine.toml", "--json", "--quiet"], folder.path());
    assert_eq!(output.status.code(), Some(1));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("low < low_end")
    );
}

#[test]
fn mistakes_of_recipes_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(figures().join("2.14.toml")).unwrap();
    for (from, to, told) in [
        (
            "engaged.1.frequency",
            "engaged.9.frequency",
            "it has dimensionless.inertia_ratio",
        ),
        ("table = \"over\"", "table = \"under\"", "it gives modes, over"),
        (
            "inertia_ratio=0.2:6",
            "inertia_ratio=0.2:6 --json",
            "leave out --json",
        ),
        ("slackside modes", "slackside moods", "moods"),
        ("title", "titel", "titel"),
    ] {
        std::fs::write(folder.path().join("mine.toml"), text.replacen(from, to, 1)).unwrap();
        let output = slackside(&["figure", "mine.toml", "--quiet"], folder.path());
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(errors.contains(told) && !errors.contains("panicked"), "{errors}");
    }
    let output = slackside(&["figure", "9.9"], folder.path());
    assert_eq!(output.status.code(), Some(2));
}
