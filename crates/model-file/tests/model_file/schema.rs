//! The JSON Schema against files and against the readers.

use serde_json::Value;

use crate::{
    DIMENSIONLESS, DRIVE, MATRICES, PHYSICAL, drives_with_every_form, example_drives, example_files, message,
    read, with_line,
};

/// The document as JSON, as an editor would hand it to a validator.
fn as_json(text: &str) -> Value {
    serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap()
}

#[test]
fn examples_are_valid() {
    let validator = jsonschema::validator_for(&slackside_model_file::schema()).unwrap();
    for (name, text) in example_files().into_iter().chain(example_drives()) {
        let document = as_json(&text);
        let errors: Vec<_> = validator
            .iter_errors(&document)
            .map(|error| error.to_string())
            .collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
    }
}

#[test]
fn resolved_models_are_valid() {
    let validator = jsonschema::validator_for(&slackside_model_file::schema()).unwrap();
    for text in [DIMENSIONLESS, PHYSICAL, MATRICES] {
        assert!(validator.is_valid(&read(text).0.resolved()));
    }
}

#[test]
fn every_form_of_a_drive_is_valid_as_written_and_resolved() {
    let validator = jsonschema::validator_for(&slackside_model_file::schema()).unwrap();
    let drives = example_drives().into_iter().map(|(_, text)| text);
    for text in drives.chain([DRIVE.to_owned()]).chain(drives_with_every_form()) {
        for document in [as_json(&text), read(&text).0.resolved()] {
            let errors: Vec<_> = validator
                .iter_errors(&document)
                .map(|error| error.to_string())
                .collect();
            assert!(errors.is_empty(), "{text}: {errors:?}");
        }
    }
}

#[test]
fn drives_of_the_wrong_shape_are_invalid() {
    let validator = jsonschema::validator_for(&slackside_model_file::schema()).unwrap();
    for (start, line) in [
        ("model", "model = \"bean\""),
        ("model", ""),
        ("axial_stiffness", "axial_stifness = 1"),
        ("natural_length", ""),
        ("natural_length", "natural_length = 1\neffective_length = 1"),
        (
            "natural_length",
            "installation = { tension = 1, operating_position = true }",
        ),
        ("radius = \"88.9 mm\"", ""),
        ("radius = \"88.9 mm\"", "radius = 1\noutside_diameter = 1"),
        ("radius = \"88.9 mm\"", "radius = \"88.9 mm\"\nzzz = 1"),
        ("center = [\"0", ""),
        ("center = [\"0", "center = [1, 2, 3]"),
        ("contact = \"back\"", "contact = \"rear\""),
        ("load", "load = { speed = [1, 2], torque = [1, 2], zzz = 1 }"),
        ("kind = \"one-way\"", "kind = \"one\""),
        ("kind = \"rotary\"", "kind = \"linear\""),
        ("pivot", ""),
        ("stops", "stops = [1]"),
        ("friction = { torque", "friction = { tork = 1 }"),
        ("speed", ""),
        ("motion", "motion = [{ order = 2 }]"),
        ("temperature_change", "temperature = 1"),
    ] {
        let text = with_line(DRIVE, start, line);
        message(&text);
        assert!(!validator.is_valid(&as_json(&text)), "{text}");
    }
}

#[test]
fn every_kind_of_law_is_valid_and_no_other() {
    let validator = jsonschema::validator_for(&slackside_model_file::schema()).unwrap();
    let smoothing = r#"smoothing = { kind = "tanh", width = "0.1 deg" }"#;
    for law in [
        format!(r#"{{ kind = "wrap-spring", stiffness = "24 N m/rad", {smoothing} }}"#),
        format!(r#"{{ kind = "backlash", stiffness = 1, clearance = 1, {smoothing} }}"#),
        format!(r#"{{ kind = "stop", stiffness = 1, gap = 1, {smoothing} }}"#),
        format!(r#"{{ kind = "piecewise-linear", breakpoints = [1], slopes = [0, 1], {smoothing} }}"#),
        r#"{ kind = "one-way-damper", damping = 1, smoothing = { kind = "tanh", width = 0.1 } }"#.to_owned(),
        r#"{ kind = "isolator", stiffness = 1, damping = 1 }"#.to_owned(),
        r#"{ kind = "one-way" }"#.to_owned(),
        r#"{ kind = "coulomb", torque = "2 N m" }"#.to_owned(),
        r#"{ kind = "coulomb", torque = 2, static_ratio = "120 %", damping = 1 }"#.to_owned(),
        r#"{ kind = "coulomb", negative_torque = 2, positive_torque = "3 N m", static_ratio = 1.2 }"#.to_owned(),
        r#"{ kind = "decoupler", stiffness = 1 }"#.to_owned(),
        r#"{ kind = "decoupler", stiffness = 1, preload = 1 }"#.to_owned(),
        r#"{ kind = "decoupler", stiffness = 1, preload = 0, damping = 1 }"#.to_owned(),
        r#"{ kind = "stop", gap = "1 deg", restitution = "50 %" }"#.to_owned(),
        r#"{ kind = "stop", gap = 1, stiffness = 1, damping = 1 }"#.to_owned(),
        r#"{ kind = "spring-slider", stiffness = 1, torque = 1 }"#.to_owned(),
        r#"{ kind = "hysteresis-loop", displacements = ["-1 deg", 1], loading = [1, 2], unloading = [0, 1] }"#.to_owned(),
        r#"{ kind = "coulomb", torque = 2, smoothing = { kind = "tanh", width = "0.1 rad/s" } }"#.to_owned(),
        r#"{ kind = "dahl", stiffness = "3 N m/rad", torque = "1 N m" }"#.to_owned(),
        r#"{ kind = "lugre", stiffness = 3, torque = 1 }"#.to_owned(),
        r#"{ kind = "lugre", stiffness = 3, damping = 1, viscous_damping = 1, torque = 1, static_ratio = "120 %", stribeck_rate = 1 }"#.to_owned(),
        r#"{ kind = "valanis", stiffness = 3, torque = 1 }"#.to_owned(),
        r#"{ kind = "valanis", stiffness = 3, slip_stiffness = 1, torque = 1, sharpness = "50 %" }"#.to_owned(),
        r#"{ kind = "cubic", linear = 1, cubic = 1 }"#.to_owned(),
    ] {
        let text = with_line(MATRICES, "law", &format!("law = {law}"));
        let (model, _) = read(&text);
        assert!(validator.is_valid(&as_json(&text)), "{law}");
        assert!(validator.is_valid(&model.resolved()), "{law}");
    }
    for law in [
        r#"{ kind = "dahl", torque = 1 }"#,
        r#"{ kind = "coulomb", tork = 1 }"#,
        r#"{ kind = "one-way", stiffness = 1 }"#,
        r#"{ kind = "stop", stiffness = 1 }"#,
        r#"{ kind = "wrap-spring", stiffness = 24.0, clearance = 1 }"#,
        r#"{ kind = "wrap-spring" }"#,
        r#"{ stiffness = 24.0 }"#,
    ] {
        let text = with_line(MATRICES, "law", &format!("law = {law}"));
        message(&text);
        assert!(!validator.is_valid(&as_json(&text)), "{law}");
    }
}

#[test]
fn ratios_may_be_percentages() {
    let validator = jsonschema::validator_for(&slackside_model_file::schema()).unwrap();
    for ratio in ["\"3 %\"", "[0.03, \"3 %\"]"] {
        let text = with_line(
            DIMENSIONLESS,
            "damping_ratio",
            &format!("damping_ratio = {ratio}"),
        );
        assert!(validator.is_valid(&as_json(&text)), "{ratio}");
        read(&text);
    }
}

#[test]
fn files_of_the_wrong_shape_are_invalid() {
    let validator = jsonschema::validator_for(&slackside_model_file::schema()).unwrap();
    for text in [
        with_line(DIMENSIONLESS, "preload", "pre_load = 1.0"),
        with_line(DIMENSIONLESS, "preload", ""),
        with_line(DIMENSIONLESS, "kind", "kind = \"drive\""),
        with_line(DIMENSIONLESS, "kind", "kind = \"engine\""),
        with_line(DIMENSIONLESS, "kind", ""),
        with_line(DIMENSIONLESS, "damping_ratio", "damping_ratio = [0.1, 0.2, 0.3]"),
        with_line(DIMENSIONLESS, "kind", "kind = \"two-pulley-clutch\"\nzzz = 1"),
        with_line(MATRICES, "mass", "mass = 1"),
        with_line(MATRICES, "harmonics", "harmonics = [{ order = 0 }]"),
        with_line(MATRICES, "name = \"clutch\"", ""),
        format!(
            "{DIMENSIONLESS}{}",
            PHYSICAL.replace("kind = \"two-pulley-clutch\"\n", "")
        ),
    ] {
        message(&text);
        assert!(!validator.is_valid(&as_json(&text)), "{text}");
    }
}

#[test]
fn every_key_is_described() {
    fn visit(value: &Value, path: &str, missing: &mut Vec<String>) {
        match value {
            Value::Object(map) => {
                if let Some(Value::Object(properties)) = map.get("properties") {
                    for (key, property) in properties {
                        // Constants (the word of `kind`) are described by the alternative they select.
                        let described = property.get("description").is_some()
                            || property.get("const").is_some()
                            || property.get("$ref").is_some();
                        if !described {
                            missing.push(format!("{path}.{key}"));
                        }
                    }
                }
                for (key, child) in map {
                    visit(child, &format!("{path}.{key}"), missing);
                }
            }
            Value::Array(items) => items.iter().for_each(|item| visit(item, path, missing)),
            _ => {}
        }
    }
    let schema = slackside_model_file::schema();
    let mut missing = Vec::new();
    visit(&schema, "", &mut missing);
    assert!(missing.is_empty(), "{missing:?}");
    let text = schema.to_string();
    assert!(text.contains("Constant torque of the accessory, N m."));
}
