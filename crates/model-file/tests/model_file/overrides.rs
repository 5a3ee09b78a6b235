//! `--set KEY=VALUE`.

use slackside_model_file::{Document, Problem};

use crate::{DIMENSIONLESS, MATRICES, PHYSICAL};

fn document(text: &str) -> Document {
    Document::parse("test.toml", text).unwrap()
}

/// The number at `key` after one override of it.
#[track_caller]
fn number_after(text: &str, key: &str, value: &str) -> f64 {
    let mut document = document(text);
    document.set(key, value).unwrap();
    document.model().unwrap().0.number(key).unwrap()
}

#[test]
fn values_are_toml_or_texts_with_units() {
    assert_eq!(number_after(DIMENSIONLESS, "dimensionless.preload", "0.5"), 0.5);
    assert_eq!(number_after(PHYSICAL, "physical.preload", "4.5 N m"), 4.5);
    assert_eq!(number_after(PHYSICAL, "physical.preload", "\"4.5 N m\""), 4.5);
    assert_eq!(number_after(PHYSICAL, "physical.pulley_radius", "0.03"), 0.03);
    let mut document = document(DIMENSIONLESS);
    document
        .set("dimensionless.damping_ratio", "[0.03, 0.05]")
        .unwrap();
    let (model, _) = document.model().unwrap();
    assert_eq!(model.number("dimensionless.damping_ratio.1").unwrap(), 0.05);
    assert_eq!(document.settings(), ["dimensionless.damping_ratio=[0.03, 0.05]"]);
}

#[test]
fn items_of_lists_go_by_name_or_position() {
    for key in ["element.clutch.law.stiffness", "element.0.law.stiffness"] {
        assert_eq!(number_after(MATRICES, key, "20"), 20.0);
    }
    assert_eq!(number_after(MATRICES, "damping.0.1", "0.25"), 0.25);
    assert_eq!(
        number_after(MATRICES, "excitation.harmonics.0.cos.pulley", "0.3"),
        0.3
    );
    assert_eq!(
        number_after(MATRICES, "output.tension.displacement.pulley", "2"),
        2.0
    );
}

#[test]
fn optional_keys_are_created() {
    assert_eq!(
        number_after(MATRICES, "excitation.harmonics.0.sin.accessory", "0.1"),
        0.1
    );
    assert_eq!(
        number_after(MATRICES, "output.tension.velocity.pulley", "0.1"),
        0.1
    );
    let mut document = document(DIMENSIONLESS);
    document.set("smoothing.kind", "tanh").unwrap();
    document.set("smoothing.width", "0.001").unwrap();
    document.set("name", "smooth").unwrap();
    let (model, _) = document.model().unwrap();
    assert_eq!(model.number("smoothing.width").unwrap(), 0.001);
    assert_eq!(model.name(), Some("smooth"));
}

#[test]
fn unknown_keys_leave_the_document_unchanged() {
    let mut document = document(MATRICES);
    let before = document.model().unwrap().0;
    for (key, expected) in [
        (
            "elment.clutch.law.stiffness",
            "--set elment.clutch.law.stiffness=1: elment: unknown key \"elment\"; did you mean \"element\"?",
        ),
        (
            "element.clutsch.law.stiffness",
            "--set element.clutsch.law.stiffness=1: element has no item \"clutsch\"; did you mean \"clutch\"?",
        ),
        (
            "element.clutch.law.stifness",
            "--set element.clutch.law.stifness=1: unknown key \"stifness\"; did you mean \"stiffness\"?",
        ),
        (
            "element.clutch.port.x",
            "--set element.clutch.port.x=1: there is no coordinate \"x\"; the coordinates are pulley and accessory",
        ),
        (
            "mass.0.7",
            "--set mass.0.7=1: mass.0 has no item \"7\"; its items are 0 to 1",
        ),
        (
            "excitation..frequency",
            "--set excitation..frequency=1: a key is missing before or after a dot; write KEY=VALUE, for example \
             dimensionless.preload=0.5",
        ),
    ] {
        let error = document.set(key, "1").unwrap_err();
        assert_eq!(error.problem(), Problem::UnknownKey, "{key}");
        assert_eq!(error.to_string(), expected);
        assert_eq!(error.place(), None);
    }
    let error = document.set("excitation.frequency.x", "1").unwrap_err();
    assert_eq!(
        error.to_string(),
        "--set excitation.frequency.x=1: excitation.frequency is a number, which has no key \"x\"; set \
         excitation.frequency itself"
    );
    assert_eq!(document.model().unwrap().0, before);
    assert!(document.settings().is_empty());
}

#[test]
fn unsound_values_name_the_override_instead_of_a_line() {
    let mut document = document(PHYSICAL);
    document.set("physical.preload", "4.5 N").unwrap();
    let error = document.model().unwrap_err();
    assert_eq!(error.setting(), Some("physical.preload=4.5 N"));
    assert_eq!(error.place(), None);
    assert_eq!(
        error.to_string(),
        "--set physical.preload=4.5 N: expected a torque such as \"4.5 N m\", found \"4.5 N\"; correct the unit, or write \
         a number without quotes in SI units"
    );
    // A later override repairs it.
    document.set("physical.preload", "4.5 N m").unwrap();
    document.model().unwrap();
}

#[test]
fn overrides_may_belong_together() {
    let mut document = document(MATRICES);
    document.set("mass.0.1", "0.1").unwrap();
    assert_eq!(
        document.model().unwrap_err().message(),
        "the mass matrix is not symmetric: mass.0.1 is 0.1"
    );
    document.set("mass.1.0", "0.1").unwrap();
    document.model().unwrap();
}
