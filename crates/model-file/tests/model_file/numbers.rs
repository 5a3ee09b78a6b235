//! Numbers by key path, as continuation and studies use them; the resolved model.

use std::time::Instant;

use slackside_model_file::Problem;

use crate::{
    DIMENSIONLESS, DRIVE, MATRICES, PHYSICAL, drives_with_every_form, example_drives, example_files, read,
    with_line,
};

#[test]
fn every_numeric_key_can_be_read_and_changed() {
    let files = example_files().into_iter().chain(example_drives());
    let mut texts: Vec<String> = files.map(|(_, text)| text).collect();
    texts.push(DRIVE.to_owned());
    texts.extend(drives_with_every_form());
    texts.push(with_line(
        DIMENSIONLESS,
        "damping_ratio",
        "damping_ratio = [0.02, 0.03]",
    ));
    texts.push(format!(
        "{DIMENSIONLESS}[smoothing]\nkind = \"tanh\"\nwidth = 0.001\n"
    ));
    for law in [
        r#"{ kind = "stop", gap = 0.1, stiffness = 3, smoothing = { kind = "cosh", width = 0.01 } }"#,
        r#"{ kind = "one-way-damper", damping = 2, smoothing = { kind = "quartic", width = 0.1 } }"#,
        r#"{ kind = "isolator", stiffness = 3, damping = 1 }"#,
        r#"{ kind = "one-way" }"#,
        r#"{ kind = "coulomb", torque = 0, static_ratio = 1, damping = 0.1 }"#,
        r#"{ kind = "coulomb", negative_torque = 2, positive_torque = 3 }"#,
        r#"{ kind = "decoupler", stiffness = 1, damping = 1 }"#,
        r#"{ kind = "stop", gap = 1, restitution = 0.5 }"#,
        r#"{ kind = "stop", gap = 1, stiffness = 2, damping = 1 }"#,
        r#"{ kind = "spring-slider", stiffness = 1, torque = 1 }"#,
        r#"{ kind = "hysteresis-loop", displacements = [-1, 1], loading = [1, 2], unloading = [0, 1] }"#,
        r#"{ kind = "piecewise-linear", breakpoints = [-1, 0, 1], slopes = [1, 2, 3, 4] }"#,
    ] {
        texts.push(with_line(MATRICES, "law", &format!("law = {law}")));
    }
    for text in texts {
        let (model, _) = read(&text);
        let keys = model.numeric_keys();
        assert!(keys.len() >= 6);
        for key in keys {
            let value = model.number(&key).unwrap();
            // Slightly more of everything is still a sound model.
            let larger = if value == 0.0 {
                1e-3
            } else {
                value + 0.01 * value.abs()
            };
            let changed = model.with_number(&key, larger).unwrap();
            assert_eq!(changed.number(&key).unwrap(), larger, "{key}");
            assert_eq!(changed.numeric_keys(), model.numeric_keys());
            assert_ne!(changed.sha256(), model.sha256(), "{key}");
            assert_eq!(changed.with_number(&key, value).unwrap(), model, "{key}");
        }
    }
}

#[test]
fn keys_are_listed_in_full() {
    let (model, _) = read(DIMENSIONLESS);
    assert_eq!(
        model.numeric_keys().join(" "),
        "dimensionless.inertia_ratio dimensionless.radius_ratio dimensionless.belt_stiffness \
         dimensionless.clutch_stiffness dimensionless.preload dimensionless.crank_amplitude dimensionless.damping_ratio"
    );
    let (model, _) = read(MATRICES);
    assert_eq!(
        model.numeric_keys().join(" "),
        "mass.0.0 mass.0.1 mass.1.0 mass.1.1 damping.0.0 damping.0.1 damping.1.0 damping.1.1 stiffness.0.0 \
         stiffness.0.1 stiffness.1.0 stiffness.1.1 element.clutch.port.accessory element.clutch.port.pulley \
         element.clutch.law.stiffness excitation.frequency excitation.constant.accessory excitation.constant.pulley \
         excitation.harmonics.0.cos.pulley output.tension.displacement.pulley"
    );
}

#[test]
fn keys_of_a_drive_are_listed_in_full() {
    let (model, _) = read(DRIVE);
    assert_eq!(
        model.numeric_keys().join("\n"),
        "belt.axial_stiffness\nbelt.bending_stiffness\nbelt.mass_per_length\nbelt.natural_length\nbelt.friction\n\
         belt.cord_offset_ribs\nbelt.thermal_expansion\nbelt.arc_participation\nbelt.damping.loss_factor\n\
         belt.damping.span_dashpot\nbelt.damping.external\nbelt.damping.drag\nbelt.damping.internal_bending\n\
         pulley.crank.center.0\npulley.crank.center.1\npulley.crank.radius\npulley.crank.inertia\n\
         pulley.crank.bearing_damping\npulley.tensioner pulley.mass\n\
         pulley.tensioner pulley.radius\npulley.tensioner pulley.inertia\npulley.tensioner pulley.bearing_damping\n\
         pulley.tensioner pulley.load\npulley.alternator.center.0\npulley.alternator.center.1\n\
         pulley.alternator.radius\npulley.alternator.inertia\n\
         pulley.alternator.bearing_damping\npulley.alternator.load\npulley.alternator.coupling.accessory_inertia\npulley.alternator.coupling.accessory_damping\n\
         tensioner.tensioner.pivot.0\ntensioner.tensioner.pivot.1\ntensioner.tensioner.arm_length\n\
         tensioner.tensioner.arm_angle\ntensioner.tensioner.inertia\ntensioner.tensioner.spring.rate\n\
         tensioner.tensioner.spring.preload\ntensioner.tensioner.damping\ntensioner.tensioner.one_way_damping\ntensioner.tensioner.friction.torque\n\
         tensioner.tensioner.friction.static_ratio\ntensioner.tensioner.stops.0\ntensioner.tensioner.stops.1\n\
         operating.speed\nexcitation.motion.0.order\nexcitation.motion.0.amplitude\nexcitation.motion.0.phase\n\
         condition.hot.temperature_change\ncondition.hot.length_change\ncondition.hot.elongation\n\
         condition.hot.structure_expansion\ncondition.hot.spring_factor"
    );
}

#[test]
fn numbers_are_in_si() {
    let (model, _) = read(PHYSICAL);
    assert_eq!(model.number("physical.pulley_radius").unwrap(), 0.03);
    assert_eq!(model.number("physical.clutch_stiffness").unwrap(), 332.0);
}

#[test]
fn changes_are_checked() {
    let (model, _) = read(DIMENSIONLESS);
    let error = model.with_number("dimensionless.preload", -1.0).unwrap_err();
    assert_eq!(error.problem(), Problem::WrongValue);
    assert_eq!(
        error.to_string(),
        "dimensionless.preload = -1.0: no preload: the clutch has no engaged equilibrium; give a value greater than zero"
    );
    assert!(model.with_number("dimensionless.preload", f64::NAN).is_err());
    let error = model.with_number("preload", 1.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "preload: the model has no number \"preload\"; did you mean \"dimensionless.preload\"?"
    );
    let (model, _) = read(MATRICES);
    assert!(model.with_number("mass.0.0", 0.0).is_err());
    assert!(model.with_number("stiffness.0.0", f64::INFINITY).is_err());
    assert!(model.with_number("element.clutch.law.stiffness", 0.0).is_err());
    assert!(model.with_number("excitation.frequency", 0.0).is_err());
    assert!(
        model
            .with_number("output.tension.displacement.pulley", f64::NAN)
            .is_err()
    );
    for key in [
        "",
        ".",
        "mass",
        "mass.0",
        "mass.0.2",
        "mass.x.0",
        "element.clutch.law",
        "name",
    ] {
        assert_eq!(
            model.number(key).unwrap_err().problem(),
            Problem::UnknownKey,
            "{key}"
        );
    }
}

#[test]
fn an_entry_of_the_mass_matrix_changes_with_its_mirror_image() {
    let (model, _) = read(MATRICES);
    let changed = model.with_number("mass.0.1", 0.2).unwrap();
    assert_eq!(changed.number("mass.1.0").unwrap(), 0.2);
}

#[test]
fn changing_a_number_takes_microseconds() {
    for (text, key) in [
        (DIMENSIONLESS, "dimensionless.clutch_stiffness"),
        (PHYSICAL, "physical.damping_ratio"),
        (MATRICES, "element.clutch.law.stiffness"),
        (DRIVE, "pulley.alternator.load"),
    ] {
        let (model, _) = read(text);
        let start = Instant::now();
        const CALLS: u32 = 2000;
        for call in 0..CALLS {
            let value = 0.1 + f64::from(call) * 1e-5;
            std::hint::black_box(model.with_number(key, value).unwrap());
        }
        let each = start.elapsed() / CALLS;
        println!("{key}: {each:?} a call");
        // Ten times the time of an idle machine and an optimised build, since tests run beside others.
        assert!(each.as_micros() < 50, "{key}: {each:?}");
    }
}

#[test]
fn the_resolved_model_does_not_depend_on_how_it_was_written() {
    let (written, _) = read(PHYSICAL);
    let text = PHYSICAL.replace("\"30 mm\"", "0.03").replace(
        "kind = \"two-pulley-clutch\"\n",
        "kind='two-pulley-clutch' # the same\n",
    );
    let (rewritten, _) = read(&text);
    assert_eq!(written.resolved(), rewritten.resolved());
    assert_eq!(written.sha256(), rewritten.sha256());
    assert_eq!(written.sha256().len(), 64);
    let (other, _) = read(&with_line(PHYSICAL, "pulley_radius", "pulley_radius = \"31 mm\""));
    assert_ne!(written.sha256(), other.sha256());
}

#[test]
fn the_resolved_model_is_canonical() {
    let (model, _) = read(DIMENSIONLESS);
    assert_eq!(
        model.resolved().to_string(),
        r#"{"dimensionless":{"belt_stiffness":2.6,"clutch_stiffness":24.0,"crank_amplitude":0.05,"damping_ratio":0.03,"inertia_ratio":1.6,"preload":1.0,"radius_ratio":2.0},"kind":"two-pulley-clutch"}"#
    );
}
