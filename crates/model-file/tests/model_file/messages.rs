//! What users read when a file is wrong or surprising (theory 02 §13).

use slackside_model_file::{Document, Problem};

use crate::{DIMENSIONLESS, MATRICES, PHYSICAL, message, read, with_line};

/// All kinds of law, as messages list them.
const KINDS_OF_LAW: &str = "wrap-spring, backlash, stop, piecewise-linear, one-way, one-way-damper, decoupler, coulomb, \
                            spring-slider, hysteresis-loop, dahl, lugre, valanis, isolator and cubic";

/// Asserts the message that a text gives when the line starting with `start` is replaced.
#[track_caller]
fn assert_message(text: &str, start: &str, line: &str, expected: &str) {
    assert_eq!(message(&with_line(text, start, line)), expected);
}

#[test]
fn dimensionless_values_out_of_bounds_are_rejected() {
    let positive = [
        ("inertia_ratio", 3),
        ("radius_ratio", 4),
        ("belt_stiffness", 5),
        ("clutch_stiffness", 6),
    ];
    for (key, line) in positive {
        for value in ["0", "-1.5"] {
            assert_message(
                DIMENSIONLESS,
                key,
                &format!("{key} = {value}"),
                &format!(
                    "test.toml:{line}: dimensionless.{key} = {value}: must be greater than zero; give a value greater \
                     than zero"
                ),
            );
        }
    }
    assert_message(
        DIMENSIONLESS,
        "preload",
        "preload = 0",
        "test.toml:7: dimensionless.preload = 0: no preload: the clutch has no engaged equilibrium; give a value greater \
         than zero",
    );
    assert_message(
        DIMENSIONLESS,
        "crank_amplitude",
        "crank_amplitude = -0.1",
        "test.toml:8: dimensionless.crank_amplitude = -0.1: must not be negative; give zero or a positive value",
    );
    assert_message(
        DIMENSIONLESS,
        "damping_ratio",
        "damping_ratio = -0.1",
        "test.toml:9: dimensionless.damping_ratio = -0.1: must not be negative; give zero or a positive value",
    );
    assert_message(
        DIMENSIONLESS,
        "damping_ratio",
        "damping_ratio = [0.03, -0.1]",
        "test.toml:9: dimensionless.damping_ratio.1 = -0.1: must not be negative; give zero or a positive value",
    );
}

#[test]
fn physical_values_out_of_bounds_are_rejected_as_they_were_written() {
    let keys = [
        ("pulley_inertia", "-2e-4 kg m^2", 3),
        ("accessory_inertia", "0 kg m^2", 4),
        ("pulley_radius", "0 mm", 5),
        ("crank_radius", "-60 mm", 6),
        ("belt_stiffness", "0 N/m", 7),
        ("clutch_stiffness", "-1 N m/deg", 8),
    ];
    for (key, value, line) in keys {
        assert_message(
            PHYSICAL,
            key,
            &format!("{key} = \"{value}\""),
            &format!(
                "test.toml:{line}: physical.{key} = \"{value}\": must be greater than zero; give a value greater than zero"
            ),
        );
    }
    assert_message(
        PHYSICAL,
        "preload",
        "preload = \"-1 N m\"",
        "test.toml:9: physical.preload = \"-1 N m\": no preload: the clutch has no engaged equilibrium; give a value \
         greater than zero",
    );
}

#[test]
fn numbers_that_are_not_finite_are_rejected() {
    for value in ["nan", "inf", "-inf"] {
        assert_message(
            DIMENSIONLESS,
            "preload",
            &format!("preload = {value}"),
            &format!(
                "test.toml:7: dimensionless.preload = {}: is not a finite number; give a finite number",
                value
            ),
        );
    }
    assert_message(
        MATRICES,
        "stiffness",
        "stiffness = [[2.6, nan], [0.0, 0.0]]",
        "test.toml:5: stiffness.0.1 = nan: is not a finite number; give a finite number",
    );
    assert_message(
        MATRICES,
        "constant",
        "constant = { pulley = inf }",
        "test.toml:12: excitation.constant.pulley = inf: is not a finite number; give a finite number",
    );
}

#[test]
fn wrong_units_name_the_expected_one() {
    assert_message(
        PHYSICAL,
        "preload",
        "preload = \"4.5 N\"",
        "test.toml:9: physical.preload = \"4.5 N\": expected a torque such as \"4.5 N m\", found \"4.5 N\"; correct the \
         unit, or write a number without quotes in SI units",
    );
    assert_message(
        PHYSICAL,
        "pulley_radius",
        "pulley_radius = \"30 MM\"",
        "test.toml:5: physical.pulley_radius = \"30 MM\": expected a length such as \"120 mm\", found \"30 MM\", whose \
         unit \"MM\" is not known; did you mean \"mm\"?",
    );
    assert_message(
        DIMENSIONLESS,
        "preload",
        "preload = \"4.5 N m\"",
        "test.toml:7: dimensionless.preload = \"4.5 N m\": expected a plain number such as 2.0, found \"4.5 N m\"; write \
         a number without quotes",
    );
}

#[test]
fn unknown_and_missing_keys_are_named() {
    assert_message(
        DIMENSIONLESS,
        "preload",
        "pre_load = 1.0",
        "test.toml:7: dimensionless.pre_load: unknown key \"pre_load\"; did you mean \"preload\"?",
    );
    assert_message(
        DIMENSIONLESS,
        "preload",
        "",
        "test.toml:2: dimensionless.preload: is missing; add a line such as `preload = 2.0`",
    );
    assert_message(
        PHYSICAL,
        "preload",
        "",
        "test.toml:2: physical.preload: is missing; add a line such as `preload = \"4.5 N m\"`",
    );
    assert_message(
        MATRICES,
        "name = \"clutch\"",
        "nme = \"clutch\"",
        "test.toml:7: element.0.nme: unknown key \"nme\"; did you mean \"name\"?",
    );
    assert_eq!(
        message("kind = \"two-pulley-clutch\"\nzzz = 1\n"),
        "test.toml:2: zzz: unknown key \"zzz\"; known keys here are kind, name, description, dimensionless, physical and \
         smoothing"
    );
}

#[test]
fn the_kind_must_be_known() {
    assert_eq!(
        message("name = \"x\"\n"),
        "test.toml:1: kind: the file does not say what it describes; add a line `kind = \"…\"`; known are \
         two-pulley-clutch, drive and mechanical-system"
    );
    assert_eq!(
        message("kind = \"engine\"\n"),
        "test.toml:1: kind = \"engine\": unknown kind of model; known are two-pulley-clutch, drive and mechanical-system"
    );
    assert_eq!(
        message("kind = \"two-pulley\"\n"),
        "test.toml:1: kind = \"two-pulley\": unknown kind of model; did you mean \"two-pulley-clutch\"? Known are \
         two-pulley-clutch, drive and mechanical-system"
    );
}

#[test]
fn exactly_one_table_of_parameters_is_needed() {
    assert_eq!(
        message("kind = \"two-pulley-clutch\"\n"),
        "test.toml:1: dimensionless: the parameters are missing; add a table [dimensionless] or a table [physical]"
    );
    assert_eq!(
        message(&format!("{DIMENSIONLESS}[physical]\npreload = 1\n")),
        "test.toml:10: physical: the file has both [dimensionless] and [physical]; keep one of the two tables"
    );
}

#[test]
fn damping_ratios_are_one_or_two() {
    assert_message(
        DIMENSIONLESS,
        "damping_ratio",
        "damping_ratio = [0.1, 0.2, 0.3]",
        "test.toml:9: dimensionless.damping_ratio = [0.1, 0.2, 0.3]: expected two damping ratios, one for each mode, \
         found 3; write one number for both modes, or two in brackets",
    );
    assert_message(
        DIMENSIONLESS,
        "damping_ratio",
        "damping_ratio = true",
        "test.toml:9: dimensionless.damping_ratio = true: expected one damping ratio or a list of two, found a boolean",
    );
}

#[test]
fn smoothing_needs_a_known_kind_and_a_positive_width() {
    let smoothed = |table: &str| format!("{DIMENSIONLESS}[smoothing]\n{table}\n");
    assert_eq!(
        message(&smoothed("kind = \"tanh\"\nwidth = 0.0")),
        "test.toml:12: smoothing.width = 0.0: must be greater than zero; give a value greater than zero"
    );
    assert_eq!(
        message(&smoothed("kind = \"tan\"\nwidth = 0.001")),
        "test.toml:11: smoothing.kind = \"tan\": unknown kind of smoothing; did you mean \"tanh\"? Known are tanh, \
         arctan, cosh, quadratic and quartic"
    );
    assert_eq!(
        message(&smoothed("kind = \"tanh\"\nwidth = \"1 mm\"")),
        "test.toml:12: smoothing.width = \"1 mm\": expected an angle such as \"0.57 deg\", found \"1 mm\"; correct the \
         unit, or write a number without quotes in SI units"
    );
}

#[test]
fn text_that_is_not_toml_is_located() {
    let error = Document::parse("test.toml", "kind = \"two-pulley-clutch\"\n[dimensionless\n").unwrap_err();
    assert_eq!(error.problem(), Problem::Syntax);
    assert_eq!(error.place().unwrap().line, 2);
    assert!(
        error.to_string().starts_with("test.toml:2: not valid TOML: "),
        "{error}"
    );
    assert!(!error.to_string().contains('\n'));
    let error = Document::parse("test.toml", "a = 1\na = 2\n").unwrap_err();
    assert_eq!(error.place().unwrap().line, 2);
}

#[test]
fn an_error_carries_what_is_needed_to_draw_it() {
    let text = with_line(DIMENSIONLESS, "preload", "preload = 0.0");
    let error = Document::parse("test.toml", &text).unwrap().model().unwrap_err();
    assert_eq!(error.problem(), Problem::WrongValue);
    assert_eq!(error.source_name(), "test.toml");
    assert_eq!(error.key(), "dimensionless.preload");
    assert_eq!(error.value(), Some("0.0"));
    assert_eq!(
        error.message(),
        "no preload: the clutch has no engaged equilibrium"
    );
    assert_eq!(error.help(), Some("give a value greater than zero"));
    assert_eq!(error.setting(), None);
    let place = error.place().unwrap();
    assert_eq!((place.line, place.column), (7, 11));
    assert_eq!(&error.text()[place.span.clone()], "0.0");
}

#[test]
fn unreadable_files_are_named() {
    let error = Document::read(std::path::Path::new("no/such/file.toml")).unwrap_err();
    assert_eq!(error.problem(), Problem::Unreadable);
    assert!(
        error
            .to_string()
            .starts_with("no/such/file.toml: cannot read the file: "),
        "{error}"
    );
}

#[test]
fn matrices_must_fit_the_coordinates() {
    assert_message(
        MATRICES,
        "mass",
        "mass = [[1.0]]",
        "test.toml:3: mass: 1 row for 2 coordinates; give one row and one column for each coordinate",
    );
    assert_message(
        MATRICES,
        "damping",
        "damping = [[0.1, 0.0], [0.1]]",
        "test.toml:4: damping.1 = [0.1]: 1 column for 2 coordinates; give one row and one column for each coordinate",
    );
    assert_message(
        MATRICES,
        "stiffness",
        "stiffness = 2.6",
        "test.toml:5: stiffness = 2.6: expected a matrix, written as a list of rows, found a number",
    );
    assert_message(
        MATRICES,
        "stiffness",
        "stiffness = [[\"2.6 m\", 0], [0, 0]]",
        "test.toml:5: stiffness.0.0 = \"2.6 m\": expected a stiffness such as \"332 N m/rad\", found \"2.6 m\"; correct \
         the unit, or write a number without quotes in SI units",
    );
}

#[test]
fn mass_must_define_a_kinetic_energy() {
    assert_message(
        MATRICES,
        "mass",
        "mass = [[1.0, 0.1], [0.2, 1.6]]",
        "test.toml:3: mass.1.0 = 0.2: the mass matrix is not symmetric: mass.0.1 is 0.1; give both entries the same value",
    );
    assert_message(
        MATRICES,
        "mass",
        "mass = [[1.0, 0.0], [0.0, 0.0]]",
        "test.toml:3: mass.1.1 = 0.0: the mass matrix is not positive definite: coordinate \"accessory\" has no positive \
         mass; give every coordinate a positive mass",
    );
    assert_message(
        MATRICES,
        "mass",
        "mass = [[1.0, 2.0], [2.0, 1.6]]",
        "test.toml:3: mass: the mass matrix is not positive definite: some motion has no positive kinetic energy; reduce \
         the entries off the diagonal or increase those on it",
    );
}

#[test]
fn names_must_exist_and_be_usable() {
    assert_message(
        MATRICES,
        "port",
        "port = { puley = 1.0 }",
        "test.toml:8: element.clutch.port.puley: there is no coordinate \"puley\"; did you mean \"pulley\"?",
    );
    assert_message(
        MATRICES,
        "port",
        "port = { pulley = 0.0 }",
        "test.toml:8: element.clutch.port: the port is zero: the element is not connected to anything; name at least one \
         coordinate, as in `port = { pulley = 1.0 }`",
    );
    assert_message(
        MATRICES,
        "harmonics",
        "harmonics = [{ order = 1, sin = { x = 1 } }]",
        "test.toml:13: excitation.harmonics.0.sin.x: there is no coordinate \"x\"; the coordinates are pulley and accessory",
    );
    assert_message(
        MATRICES,
        "displacement",
        "force = { clutsch = 1.0 }",
        "test.toml:16: output.tension.force.clutsch: there is no element \"clutsch\"; did you mean \"clutch\"?",
    );
    for (name, complaint) in [
        ("", "a name must not be empty; give a name"),
        (
            "a.b",
            "a name must not contain dots, commas, equals signs or line breaks; use letters, digits, - and _",
        ),
        (
            "12",
            "a name must not be a number, which means a position in a list; add a letter",
        ),
        ("pulley", "the name is already taken; choose another name"),
    ] {
        assert_message(
            MATRICES,
            "name = \"clutch\"",
            &format!("name = \"{name}\""),
            &format!("test.toml:7: element.0.name = \"{name}\": {complaint}"),
        );
    }
    assert_message(
        MATRICES,
        "coordinates",
        "coordinates = [\"pulley\", \"pulley\"]",
        // The port is read before the names are checked.
        "test.toml:8: element.clutch.port.accessory: there is no coordinate \"accessory\"; the coordinates are pulley and \
         pulley",
    );
    assert_eq!(
        message(
            "kind = \"mechanical-system\"\ncoordinates = [\"q\", \"q\"]\nmass = [[1, 0], [0, 1]]\ndamping = [[0, 0], [0, \
             0]]\nstiffness = [[0, 0], [0, 0]]\n"
        ),
        "test.toml:2: coordinates.1 = \"q\": the name is already taken; choose another name"
    );
    assert_eq!(
        message("kind = \"mechanical-system\"\ncoordinates = []\nmass = []\ndamping = []\nstiffness = []\n"),
        "test.toml:2: coordinates = []: there is no coordinate; name at least one"
    );
}

#[test]
fn laws_have_known_kinds_and_sound_values() {
    let law = |law: &str| message(&with_line(MATRICES, "law", &format!("law = {law}")));
    let positive = "must be greater than zero; give a value greater than zero";
    for (written, key, shown) in [
        (r#"{ kind = "wrap-spring", stiffness = 0 }"#, "stiffness", "0"),
        (
            r#"{ kind = "backlash", stiffness = -1, clearance = 1 }"#,
            "stiffness",
            "-1",
        ),
        (
            r#"{ kind = "backlash", stiffness = 1, clearance = 0 }"#,
            "clearance",
            "0",
        ),
        (r#"{ kind = "stop", stiffness = 0, gap = 1 }"#, "stiffness", "0"),
        (r#"{ kind = "one-way-damper", damping = 0 }"#, "damping", "0"),
    ] {
        assert_eq!(
            law(written),
            format!("test.toml:9: element.clutch.law.{key} = {shown}: {positive}")
        );
    }
    assert_eq!(
        law(r#"{ kind = "stop", stiffness = 1, gap = -1 }"#),
        "test.toml:9: element.clutch.law.gap = -1: must not be negative; give zero or a positive value"
    );
    assert_eq!(
        law(r#"{ kind = "isolator", stiffness = 1, damping = -1 }"#),
        "test.toml:9: element.clutch.law.damping = -1: must not be negative; give zero or a positive value"
    );
    assert_eq!(
        law(r#"{ kind = "piecewise-linear", breakpoints = [0, 1], slopes = [1, 0] }"#),
        "test.toml:9: element.clutch.law.slopes: 2 slopes for 2 breakpoints; give one more slope than breakpoints: below, \
         between and above them"
    );
    assert_eq!(
        law(r#"{ kind = "piecewise-linear", breakpoints = [1, 1], slopes = [1, 0, 1] }"#),
        "test.toml:9: element.clutch.law.breakpoints.1 = 1: breakpoints must increase; give a value above 1.0"
    );
    assert_eq!(
        law(r#"{ kind = "piecewise-linear", breakpoints = [], slopes = [1] }"#),
        "test.toml:9: element.clutch.law.breakpoints = []: there is no breakpoint; give at least one, or use a law of \
         kind \"isolator\" for a linear spring"
    );
    assert_eq!(
        law(r#"{ kind = "cubic", linear = 1, cubic = nan }"#),
        "test.toml:9: element.clutch.law.cubic = nan: is not a finite number; give a finite number"
    );
    assert_eq!(
        law(r#"{ kind = "wrapspring", stiffness = 1 }"#),
        format!(
            "test.toml:9: element.clutch.law.kind = \"wrapspring\": unknown kind of law; did you mean \"wrap-spring\"? \
             Known are {KINDS_OF_LAW}"
        )
    );
    assert_eq!(
        law("{ stiffness = 1 }"),
        format!(
            "test.toml:9: element.clutch.law.kind: the kind of the law is missing; add `kind = …`; known are \
             {KINDS_OF_LAW}"
        )
    );
    assert_eq!(
        law(r#"{ kind = "cubic", linear = 1, cubic = 1, smoothing = { kind = "tanh", width = 1 } }"#),
        "test.toml:9: element.clutch.law.smoothing: unknown key \"smoothing\"; known keys here are kind, linear and cubic"
    );
    assert_eq!(
        law(
            r#"{ kind = "backlash", stiffness = 1, clearance = 1, smoothing = { kind = "tanh", width = -1 } }"#
        ),
        "test.toml:9: element.clutch.law.smoothing.width = -1: must be greater than zero; give a value greater than zero"
    );
}

#[test]
fn clutches_friction_and_stops_have_sound_values() {
    let law = |law: &str| message(&with_line(MATRICES, "law", &format!("law = {law}")));
    for (written, complaint) in [
        (
            r#"{ kind = "one-way", stiffness = 1 }"#,
            ".stiffness: unknown key \"stiffness\"; known keys here are kind",
        ),
        (
            r#"{ kind = "decoupler", stiffness = 0 }"#,
            ".stiffness = 0: must be greater than zero; give a value greater than zero",
        ),
        (
            r#"{ kind = "decoupler", stiffness = 1, preload = -1 }"#,
            ".preload = -1: must not be negative; give zero or a positive value",
        ),
        (
            r#"{ kind = "decoupler", stiffness = 1, preload = 1, damping = 2 }"#,
            ".damping = 2: a decoupler with a preload has no damping: the spring rests against a stop inside it; leave \
             out `damping` or `preload`",
        ),
        (
            r#"{ kind = "coulomb" }"#,
            ".torque: nothing says how large the friction is; add `torque`, or `negative_torque` and `positive_torque`",
        ),
        (
            r#"{ kind = "coulomb", tork = 1 }"#,
            ".tork: unknown key \"tork\"; did you mean \"torque\"?",
        ),
        (
            r#"{ kind = "coulomb", torque = "1 N/m" }"#,
            ".torque = \"1 N/m\": expected a force or a torque such as \"4.5 N m\", found \"1 N/m\"; correct the unit, \
             or write a number without quotes in SI units",
        ),
        (
            r#"{ kind = "coulomb", torque = -1 }"#,
            ".torque = -1: must not be negative; give zero or a positive value",
        ),
        (
            r#"{ kind = "coulomb", torque = 1, negative_torque = 2 }"#,
            ".negative_torque = 2: the friction is already given by `torque`; keep `torque`, or `negative_torque` and \
             `positive_torque`",
        ),
        (
            r#"{ kind = "coulomb", torque = 1, positive_torque = 2 }"#,
            ".positive_torque = 2: the friction is already given by `torque`; keep `torque`, or `negative_torque` and \
             `positive_torque`",
        ),
        (
            r#"{ kind = "coulomb", negative_torque = 2 }"#,
            ".positive_torque: is missing; friction that depends on the direction has `negative_torque` and \
             `positive_torque`; for one value write `torque`",
        ),
        (
            r#"{ kind = "coulomb", torque = 1, static_ratio = 0.9 }"#,
            ".static_ratio = 0.9: friction at rest is not below that in motion; give a ratio of at least 1",
        ),
        (
            r#"{ kind = "coulomb", torque = 1, damping = -1 }"#,
            ".damping = -1: must not be negative; give zero or a positive value",
        ),
        (
            r#"{ kind = "coulomb", torque = 1, static_ratio = 2, smoothing = { kind = "tanh", width = 1 } }"#,
            ".static_ratio = 2: smoothed friction creeps at rest and has no limit of its own there; leave out `smoothing` \
             or `static_ratio`",
        ),
        (
            r#"{ kind = "coulomb", torque = 1, smoothing = { kind = "tanh", width = "1 mm" } }"#,
            ".smoothing.width = \"1 mm\": expected a velocity or an angular velocity such as \"0.1 rad/s\", found \"1 \
             mm\"; correct the unit, or write a number without quotes in SI units",
        ),
        (
            r#"{ kind = "one-way", smoothing = { kind = "tanh", width = 1 } }"#,
            ".smoothing: a one-way clutch has no torque to smooth between; use `kind = \"one-way-damper\"` with a large \
             `damping`, which may be smoothed",
        ),
        (
            r#"{ kind = "dahl", torque = 1 }"#,
            ".stiffness: is missing; add a line such as `stiffness = \"332 N m/rad\"`",
        ),
        (
            r#"{ kind = "lugre", stiffness = 1, torque = 1, static_ratio = 1.2 }"#,
            ".stribeck_rate: nothing says at which rate the friction falls; add `stribeck_rate`, or leave out \
             `static_ratio`",
        ),
        (
            r#"{ kind = "lugre", stiffness = 1, torque = 1, static_ratio = 0.5 }"#,
            ".static_ratio = 0.5: friction of slow sliding is not below that of fast sliding; give a ratio of at least 1",
        ),
        (
            r#"{ kind = "valanis", stiffness = 1, slip_stiffness = 2, torque = 1 }"#,
            ".slip_stiffness = 2: is too large; give a value below `stiffness`",
        ),
        (
            r#"{ kind = "valanis", stiffness = 1, torque = 1, sharpness = 1 }"#,
            ".sharpness = 1: is too large; give a value below 1",
        ),
        (
            r#"{ kind = "spring-slider", stiffness = 1, torque = 0 }"#,
            ".torque = 0: must be greater than zero; give a value greater than zero",
        ),
        (
            r#"{ kind = "spring-slider", stiffness = 1 }"#,
            ".torque: is missing; add a line such as `torque = \"4.5 N m\"`",
        ),
        (
            r#"{ kind = "stop", gap = 1 }"#,
            ".stiffness: nothing says whether the stop is compliant or rigid; add `stiffness`, or for a rigid stop \
             `restitution`",
        ),
        (
            r#"{ kind = "stop", gap = 1, restitution = 1.5 }"#,
            ".restitution = 1.5: must lie between zero and one; give a share from 0 to 1",
        ),
        (
            r#"{ kind = "stop", gap = 1, restitution = 0.5, stiffness = 2 }"#,
            ".stiffness = 2: a stop with `restitution` is rigid and has no stiffness; leave out `restitution` for a \
             compliant stop",
        ),
        (
            r#"{ kind = "stop", gap = 1, restitution = 0.5, damping = 2 }"#,
            ".damping = 2: a stop with `restitution` is rigid and has no damping; leave out `restitution` for a \
             compliant stop",
        ),
        (
            r#"{ kind = "stop", gap = 1, restitution = 0.5, smoothing = { kind = "tanh", width = 1 } }"#,
            ".smoothing: a stop with `restitution` is rigid and has no smoothing; leave out `restitution` for a \
             compliant stop",
        ),
        (
            r#"{ kind = "stop", gap = 1, stiffness = 1, damping = 2, smoothing = { kind = "tanh", width = 1 } }"#,
            ".smoothing: only a stop without damping can be smoothed; leave out `smoothing` or `damping`",
        ),
        (
            r#"{ kind = "hysteresis-loop", displacements = [0, 1], loading = [1, 2] }"#,
            ".unloading: is missing; add a line such as `unloading = [-6.0, 4.0]`",
        ),
        (
            r#"{ kind = "hysteresis-loop", displacements = [0], loading = [1], unloading = [0] }"#,
            ".displacements: a loop has at least two points; give the ends of the stroke",
        ),
        (
            r#"{ kind = "hysteresis-loop", displacements = [0, 1], loading = [1, 2], unloading = [0] }"#,
            ".unloading: 1 value for 2 displacements; give one value for each displacement",
        ),
        (
            r#"{ kind = "hysteresis-loop", displacements = [0, 0], loading = [1, 2], unloading = [0, 1] }"#,
            ".displacements.1 = 0: displacements must increase; give a value above 0.0",
        ),
        (
            r#"{ kind = "hysteresis-loop", displacements = [0, 1], loading = [1, nan], unloading = [0, 1] }"#,
            ".loading.1 = nan: is not a finite number; give a finite number",
        ),
        (
            r#"{ kind = "hysteresis-loop", displacements = [0, 1], loading = [1, 2], unloading = [0, 3] }"#,
            ".loading.1 = 2: the loop gives energy: unloading.1 is 3.0; loading is nowhere below unloading",
        ),
    ] {
        assert_eq!(
            law(written),
            format!("test.toml:9: element.clutch.law{complaint}")
        );
    }
}

#[test]
fn measures_have_names_of_their_own() {
    for (name, complaint) in [
        ("pulley", "the name is already taken; choose another name"),
        ("clutch", "the name is already taken; choose another name"),
        (
            "pulley.rate",
            "a name must not contain dots, commas, equals signs or line breaks; use letters, digits, - and _",
        ),
    ] {
        assert_message(
            MATRICES,
            "name = \"tension\"",
            &format!("name = \"{name}\""),
            &format!("test.toml:15: output.0.name = \"{name}\": {complaint}"),
        );
    }
}

#[test]
fn prescribed_parts_of_measures_must_be_sound() {
    let output = |line: &str| message(&with_line(MATRICES, "displacement", line));
    for (line, complaint) in [
        (
            "constant = inf",
            "constant = inf: is not a finite number; give a finite number",
        ),
        (
            "harmonics = [{ order = 1, cos = nan }]",
            "harmonics.0.cos = nan: is not a finite number; give a finite number",
        ),
        (
            "harmonics = [{ order = 0, cos = 1 }]",
            "harmonics.0.order = 0: the order of a harmonic is a whole number from 1 up; put the constant part into \
             `constant`",
        ),
        (
            "harmonics = [{ order = 1, kos = 1 }]",
            "harmonics.0.kos: unknown key \"kos\"; did you mean \"cos\"?",
        ),
    ] {
        assert_eq!(output(line), format!("test.toml:16: output.tension.{complaint}"));
    }
}

#[test]
fn excitations_must_be_sound() {
    for value in ["0", "-5.5"] {
        assert_message(
            MATRICES,
            "frequency",
            &format!("frequency = {value}"),
            &format!(
                "test.toml:11: excitation.frequency = {value}: must be greater than zero; give a value greater than zero"
            ),
        );
    }
    assert_message(
        MATRICES,
        "harmonics",
        "harmonics = [{ order = 0, cos = { pulley = 0.26 } }]",
        "test.toml:13: excitation.harmonics.0.order = 0: the order of a harmonic is a whole number from 1 up; put the \
         constant part into excitation.constant",
    );
    assert_message(
        MATRICES,
        "harmonics",
        "harmonics = [{ order = 1.5, cos = { pulley = 0.26 } }]",
        "test.toml:13: excitation.harmonics.0.order = 1.5: expected a whole number such as 1, found a number",
    );
    assert_message(
        MATRICES,
        "harmonics",
        "harmonics = [{ order = 2 }, { order = 2 }]",
        "test.toml:13: excitation.harmonics.1.order = 2: the order is already given by excitation.harmonics.0; put both \
         into one item",
    );
}

#[test]
fn what_may_surprise_is_said() {
    let warnings = |text: &str| -> Vec<String> {
        let (_, warnings) = read(text);
        warnings.iter().map(ToString::to_string).collect()
    };
    assert_eq!(warnings(DIMENSIONLESS), Vec::<String>::new());
    assert_eq!(
        warnings(&with_line(
            DIMENSIONLESS,
            "damping_ratio",
            "damping_ratio = [0.03, 0.2]"
        )),
        [
            "test.toml:9: dimensionless.damping_ratio: a damping ratio of 0.2 or more makes the multiple-scales solution \
             unreliable"
        ]
    );
    assert_eq!(
        warnings(&with_line(DIMENSIONLESS, "damping_ratio", "damping_ratio = 0")),
        [
            "test.toml:9: dimensionless.damping_ratio: without damping, motions need not settle to a steady state"
        ]
    );
    assert_eq!(
        warnings(&with_line(
            DIMENSIONLESS,
            "crank_amplitude",
            "crank_amplitude = 0"
        )),
        [
            "test.toml:8: dimensionless.crank_amplitude: the crank does not vibrate: only the static state is found"
        ]
    );
    assert_eq!(
        warnings(
            &format!("{DIMENSIONLESS}smoothing.width = 0.01\n")
                .replace("smoothing.width", "[smoothing]\nkind = \"tanh\"\nwidth")
        ),
        [
            "test.toml:12: smoothing.width: the width 0.01 is more than a fifth of the static clutch deflection 0.041667: \
             the smooth law differs visibly from the clutch"
        ]
    );
    assert_eq!(
        warnings(&format!(
            "{DIMENSIONLESS}[smoothing]\nkind = \"arctan\"\nwidth = 0.001\n"
        )),
        [
            "test.toml:11: smoothing.kind: arctan smoothing is only first-order accurate: it leaves a constant torque on \
             both sides; tanh or cosh of the same width is closer to the exact law"
        ]
    );
    // omega_2/omega_1 = 6.507 at K_d = 24 is near 6 at K_d = 20.15: (C3) gives 6.0102.
    assert_eq!(
        warnings(&with_line(
            DIMENSIONLESS,
            "clutch_stiffness",
            "clutch_stiffness = 20.15"
        )),
        [
            "test.toml:2: dimensionless: the natural frequencies of the engaged system are near an internal resonance \
             (ratio 6.0102): the multiple-scales solution of the first mode is not valid"
        ]
    );
    assert_eq!(
        warnings(&with_line(MATRICES, "harmonics", "harmonics = []")),
        ["test.toml:10: excitation: no force varies in time: there is nothing to respond to"]
    );
}
