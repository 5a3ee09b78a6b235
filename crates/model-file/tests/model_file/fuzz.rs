//! No text may cause a panic.

use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use slackside_model_file::Document;

use crate::{
    DIMENSIONLESS, DRIVE, MATRICES, PHYSICAL, drives_with_every_form, example_drives, example_files,
};

/// One change of a text: where (as a fraction), how many characters go, what comes.
#[derive(Clone, Debug)]
struct Mutation {
    position: f64,
    removed: usize,
    inserted: String,
}

fn texts() -> Vec<String> {
    let files = example_files().into_iter().chain(example_drives());
    let mut texts: Vec<String> = files.map(|(_, text)| text).collect();
    texts.extend([DIMENSIONLESS, PHYSICAL, MATRICES, DRIVE].map(str::to_owned));
    texts.extend(drives_with_every_form());
    texts.push(format!(
        "{DIMENSIONLESS}[smoothing]\nkind = \"arctan\"\nwidth = \"1 deg\"\n"
    ));
    for law in [
        r#"{ kind = "stop", gap = 0.1, stiffness = 3, smoothing = { kind = "cosh", width = 0.01 } }"#,
        r#"{ kind = "one-way-damper", damping = "2 N m s/rad" }"#,
        r#"{ kind = "piecewise-linear", breakpoints = [-1, 0, 1], slopes = [1, 2, 3, 4] }"#,
        r#"{ kind = "one-way" }"#,
        r#"{ kind = "coulomb", torque = "2 N m", static_ratio = 1.2, damping = 0.1 }"#,
        r#"{ kind = "coulomb", negative_torque = 2, positive_torque = 3 }"#,
        r#"{ kind = "decoupler", stiffness = 1, preload = "1 N m" }"#,
        r#"{ kind = "stop", gap = 1, restitution = 0.5 }"#,
        r#"{ kind = "stop", gap = 1, stiffness = 2, damping = 1 }"#,
        r#"{ kind = "spring-slider", stiffness = 1, torque = 1 }"#,
        r#"{ kind = "dahl", stiffness = 3, torque = "1 N m" }"#,
        r#"{ kind = "lugre", stiffness = 3, torque = 1, static_ratio = 1.2, stribeck_rate = 1 }"#,
        r#"{ kind = "valanis", stiffness = 3, slip_stiffness = 1, torque = 1, sharpness = 0.5 }"#,
        r#"{ kind = "hysteresis-loop", displacements = [-1, 1], loading = [1, 2], unloading = [0, 1] }"#,
    ] {
        texts.push(crate::with_line(MATRICES, "law", &format!("law = {law}")));
    }
    texts
}

/// Pieces that files are made of, and some that they are not.
fn fragment() -> impl Strategy<Value = String> {
    let pieces = [
        "",
        "0",
        "-1",
        "1e308",
        "1e-308",
        "nan",
        "inf",
        "-inf",
        "99999999999999999999",
        "0x1F",
        "true",
        "1979-05-27",
        "\"",
        "'",
        "\"\"\"",
        "[",
        "]",
        "[[",
        "]]",
        "{",
        "}",
        "=",
        ".",
        ",",
        "\n",
        "#",
        "\\",
        "\u{0}",
        "é",
        "🦀",
        "\"4.5 N m\"",
        "\"3 mm/(s\"",
        "\"1 m^9/s^-9\"",
        "[]",
        "{}",
        "[[1.0]]",
        "kind = \"drive\"",
        "[element]",
        "[[element]]",
        "a.b.c.d = 1",
        "port = {}",
        "name",
        "pulley",
        "\"stop\"",
        "\"cubic\"",
        "\"one-way\"",
        "\"coulomb\"",
        "\"hysteresis-loop\"",
        "torque = 0",
        "static_ratio = 0.5",
        "restitution = 0.5",
        "harmonics = [{ order = 1, cos = 1 }]",
        "\"mechanical-system\"",
        "\"two-pulley-clutch\"",
        "smoothing = { kind = \"tanh\", width = 1 }",
        "[physical]",
        "[dimensionless]",
        "[[pulley]]",
        "[[tensioner]]",
        "[belt]",
        "\"tensioner\"",
        "driver = true",
        "contact = \"back\"",
        "\"1 kW\"",
        "{ speed = [1, 2], power = [1, 2] }",
        "installation = { tension = 1 }",
    ];
    prop_oneof![
        4 => proptest::sample::select(pieces.to_vec()).prop_map(str::to_owned),
        1 => any::<f64>().prop_map(|number| number.to_string()),
        1 => ".{0,8}",
    ]
}

fn mutation() -> impl Strategy<Value = Mutation> {
    (0.0..1.0f64, 0..30usize, fragment()).prop_map(|(position, removed, inserted)| Mutation {
        position,
        removed,
        inserted,
    })
}

fn mutated() -> impl Strategy<Value = String> {
    let texts = proptest::sample::select(texts());
    (texts, proptest::collection::vec(mutation(), 1..4)).prop_map(|(text, mutations)| {
        let mut characters: Vec<char> = text.chars().collect();
        for mutation in mutations {
            // A fraction below one of a length is an index.
            let start = (mutation.position * characters.len() as f64) as usize;
            let end = (start + mutation.removed).min(characters.len());
            characters.splice(start..end, mutation.inserted.chars());
        }
        characters.into_iter().collect()
    })
}

/// Everything a program does with a file and an override; only panics fail.
fn exercise(text: &str, key: &str, value: &str) {
    let mut document = match Document::parse("fuzz.toml", text) {
        Ok(document) => document,
        Err(error) => {
            check_message(&error.to_string());
            return;
        }
    };
    exercise_model(&document);
    match document.set(key, value) {
        Ok(()) => exercise_model(&document),
        Err(error) => check_message(&error.to_string()),
    }
}

fn exercise_model(document: &Document) {
    match document.model() {
        Ok((model, warnings)) => {
            for warning in warnings {
                check_message(&warning.to_string());
            }
            for key in model.numeric_keys() {
                let value = model.number(&key).unwrap();
                assert!(value.is_finite(), "{key}");
                assert_eq!(model.with_number(&key, value).unwrap(), model);
                let _ = model.with_number(&key, -value);
            }
            assert_eq!(model.sha256().len(), 64);
            if let Err(error) = model.system() {
                check_message(&error.to_string());
            }
            if let Some(drive) = model.drive() {
                let _ = (drive.excitation(), drive.conditions());
                if let Err(error) = drive.belt_drive() {
                    check_message(&error.to_string());
                }
            }
        }
        Err(error) => {
            check_message(&error.to_string());
            if let Some(place) = error.place() {
                assert!(error.text().get(place.span.clone()).is_some(), "{place:?}");
            }
        }
    }
}

/// A message is one line that says something.
fn check_message(message: &str) {
    assert!(!message.trim().is_empty());
    assert!(!message.contains('\n'), "{message:?}");
}

fn key() -> impl Strategy<Value = String> {
    prop_oneof![
        proptest::sample::select(vec![
            "dimensionless.preload",
            "physical.preload",
            "element.clutch.law.stiffness",
            "element.0.law.kind",
            "mass.0.0",
            "excitation.harmonics.0.cos.pulley",
            "smoothing.width",
            "name",
            "belt.model",
            "pulley.alternator.load",
            "pulley.0.center.0",
            "tensioner.tensioner.stops",
            "operating.speed",
        ])
        .prop_map(str::to_owned),
        ".{0,12}",
        "[a-z]{0,5}(\\.[a-z0-9]{0,3}){0,4}",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_files_never_panic(text in mutated(), key in key(), value in fragment()) {
        exercise(&text, &key, &value);
    }

    #[test]
    fn arbitrary_quantities_never_panic(text in ".{0,20}", number in any::<f64>(), unit in "[ mNsradkg/()^*·0-9²-]{0,12}") {
        use slackside_model_file::units::{quantities, read};
        for quantity in [quantities::NUMBER, quantities::LENGTH, quantities::GENERALISED_STIFFNESS] {
            for written in [text.clone(), format!("{number} {unit}"), format!("{number}{unit}")] {
                if let Ok(value) = read(&written, &quantity) {
                    prop_assert!(value.is_finite());
                }
            }
        }
    }
}

#[test]
fn deeply_nested_files_are_errors() {
    let dotted = format!("{} = 1\n", vec!["a"; 70].join("."));
    let arrays = format!("a = {}{}\n", "[".repeat(10_000), "]".repeat(10_000));
    let key = vec!["a"; 79].join(".");
    let tables = format!("{}1{}\n", format!("{key} = {{ ").repeat(78), " }".repeat(78));
    for text in [dotted, arrays, tables] {
        let error = Document::parse("deep.toml", &text).unwrap_err();
        check_message(&error.to_string());
    }
    let mut document = Document::parse("deep.toml", DIMENSIONLESS).unwrap();
    for (key, value) in [
        (vec!["name"; 100_000].join("."), "1".to_owned()),
        (
            "name".to_owned(),
            format!("{}1{}", "[".repeat(40), "]".repeat(40)),
        ),
    ] {
        check_message(&document.set(&key, &value).unwrap_err().to_string());
    }
    // What is no TOML value is a text.
    exercise(DIMENSIONLESS, "name", &"[".repeat(10_000));
}

#[test]
#[ignore = "runs for SLACKSIDE_FUZZ_SECONDS (60 if unset)"]
fn fuzz_for_a_while() {
    let seconds = std::env::var("SLACKSIDE_FUZZ_SECONDS")
        .ok()
        .and_then(|seconds| seconds.parse().ok())
        .unwrap_or(60);
    let strategy = (mutated(), key(), fragment());
    let mut runner = TestRunner::default();
    let start = Instant::now();
    let mut cases = 0_u64;
    while start.elapsed() < Duration::from_secs(seconds) {
        let (text, key, value) = strategy.new_tree(&mut runner).unwrap().current();
        let result = std::panic::catch_unwind(|| exercise(&text, &key, &value));
        assert!(result.is_ok(), "panic for --set {key:?}={value:?} on:\n{text}");
        cases += 1;
    }
    println!("{cases} texts without a panic");
}
