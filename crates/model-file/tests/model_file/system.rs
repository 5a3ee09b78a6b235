//! The equations of motion that a model gives.

use slackside_mechanics::{RegimeTable, System, Transition, modes};

use crate::{DIMENSIONLESS, MATRICES, PHYSICAL, example, read, with_line};

fn system(text: &str) -> System {
    read(text).0.system().unwrap()
}

/// theory 02 §15
const NOMINAL_FREQUENCIES: [f64; 2] = [0.9796106880251735, 6.374979443096805];

#[test]
fn two_pulleys_and_their_matrices_are_the_same_system() {
    let model = system(&example("two_pulley_nominal.toml"));
    let matrices = system(&example("two_pulley_as_matrices.toml"));
    assert_eq!(model.coordinates, matrices.coordinates);
    assert_eq!(model.mass, matrices.mass);
    assert_eq!(model.stiffness, matrices.stiffness);
    assert_eq!(model.forcing.constant, matrices.forcing.constant);
    for (left, right) in model.damping.as_slice().iter().zip(matrices.damping.as_slice()) {
        assert!((left - right).abs() < 1e-14);
    }
    let (left, right) = (&model.forcing.harmonics[0], &matrices.forcing.harmonics[0]);
    assert_eq!((left.order, &left.sine), (right.order, &right.sine));
    assert!((left.cosine[0] - right.cosine[0]).abs() < 1e-15);
    let found = modes(&matrices, 1.0, true).unwrap();
    for (mode, expected) in found.iter().zip(NOMINAL_FREQUENCIES) {
        assert!((mode.frequency - expected).abs() < 1e-13);
        assert!((mode.damping_ratio - 0.03).abs() < 1e-14);
    }
    for name in ["pulley", "accessory", "windup", "clutch_torque", "pulley.rate"] {
        assert!(model.output_index(name).is_some(), "{name}");
        assert!(matrices.output_index(name).is_some(), "{name}");
    }
}

#[test]
fn physical_units_scale_frequency_and_torque() {
    // theory 02 §1.3: omega_0 = 263.11740579 rad/s, J_p omega_0^2 = 13.846153846 N m.
    let (omega_0, torque): (f64, f64) = (263.117405792, 13.846153846153847);
    let dimensionless = system(&example("two_pulley_nominal.toml"));
    let (model, _) = read(&example("two_pulley_physical.toml"));
    let physical = model.system().unwrap();
    let found = modes(&physical, 1.0, true).unwrap();
    for (mode, expected) in found.iter().zip(NOMINAL_FREQUENCIES) {
        assert!((mode.frequency / omega_0 - expected).abs() < 1e-9);
        assert!((mode.damping_ratio - 0.03).abs() < 1e-14);
    }
    let excitation = |system: &System| system.forcing.harmonics[0].cosine[0];
    assert!((excitation(&physical) / torque - excitation(&dimensionless)).abs() < 1e-14);
    assert!((physical.forcing.constant[0] / torque - 1.0).abs() < 1e-14);
    let units = model.units();
    assert_eq!((units.frequency, units.torque), ("Hz", "N m"));
    assert!((units.user_frequency(omega_0) - 41.876).abs() < 1e-3);
    assert_eq!(units.user_frequency(units.angular_frequency(7.0)), 7.0);
}

#[test]
fn every_part_of_a_mechanical_system_arrives() {
    let text = r#"
kind = "mechanical-system"
coordinates = ["a", "b"]
mass = [[2.0, 0.5], [0.5, 1.0]]
damping = [[0.1, 0.2], [-0.2, 0.3]]
stiffness = [[3.0, -1.0], [-1.0, 4.0]]
damping_linear_in_frequency = [[0.0, 1.0], [-1.0, 0.0]]
stiffness_quadratic_in_frequency = [[-0.1, 0.0], [0.0, -0.2]]
[[element]]
name = "stop"
port = { b = -2.0, a = 1.0 }
law = { kind = "stop", gap = 0.5, stiffness = 10.0 }
[[element]]
name = "mount"
port = { a = 1.0 }
law = { kind = "isolator", stiffness = 7.0, damping = 0.7 }
[excitation]
frequency = "2 rpm"
constant = { b = 3.0 }
harmonics = [{ order = 3, sin = { b = 0.3 } }, { order = 1, cos = { a = 0.1 }, sin = { a = 0.2 } }]
[[output]]
name = "probe"
displacement = { b = 5.0 }
velocity = { a = 6.0 }
force = { mount = 8.0 }
"#;
    let (model, _) = read(text);
    assert_eq!(model.coordinates(), ["a", "b"]);
    assert!((model.frequency().unwrap() - std::f64::consts::PI / 15.0).abs() < 1e-15);
    let system = model.system().unwrap();
    system.check().unwrap();
    assert_eq!(system.mass.as_slice(), [2.0, 0.5, 0.5, 1.0]);
    assert_eq!(system.damping_at(2.0).as_slice(), [0.1, 2.2, -2.2, 0.3]);
    assert_eq!(
        system.stiffness_at(2.0).as_slice(),
        [3.0 - 0.4, -1.0, -1.0, 4.0 - 0.8]
    );
    assert_eq!(system.forcing.constant, [0.0, 3.0]);
    let orders: Vec<usize> = system
        .forcing
        .harmonics
        .iter()
        .map(|harmonic| harmonic.order)
        .collect();
    assert_eq!(orders, [1, 3]);
    assert_eq!(system.forcing.harmonics[0].cosine, [0.1, 0.0]);
    assert_eq!(system.forcing.harmonics[0].sine, [0.2, 0.0]);
    assert_eq!(system.forcing.harmonics[1].sine, [0.0, 0.3]);
    assert_eq!(system.elements[0].port.terms(), [(0, 1.0), (1, -2.0)]);
    assert_eq!(system.elements[0].law.kind(), "stop");
    let probe = &system.outputs[system.output_index("probe").unwrap()];
    assert_eq!(probe.displacement, [(1, 5.0)]);
    assert_eq!(probe.velocity, [(0, 6.0)]);
    assert_eq!(probe.force, [(1, 8.0)]);
    let deflection = &system.outputs[system.output_index("stop.deflection").unwrap()];
    assert_eq!(deflection.displacement, [(0, 1.0), (1, -2.0)]);
}

#[test]
fn laws_have_the_forces_that_the_file_says() {
    /// Deflection, rate and force.
    type Point = (f64, f64, f64);
    let cases: &[(&str, &[Point])] = &[
        (
            r#"{ kind = "wrap-spring", stiffness = 2 }"#,
            &[(-1.0, 0.0, 0.0), (1.5, 0.0, 3.0)],
        ),
        (
            r#"{ kind = "backlash", stiffness = 2, clearance = 0.5 }"#,
            &[(-1.0, 0.0, -1.0), (0.3, 0.0, 0.0), (1.0, 0.0, 1.0)],
        ),
        (
            r#"{ kind = "stop", stiffness = 2, gap = 0.5 }"#,
            &[(-1.0, 0.0, 0.0), (0.3, 0.0, 0.0), (1.0, 0.0, 1.0)],
        ),
        (
            r#"{ kind = "piecewise-linear", breakpoints = [-1, 2], slopes = [5, 1, 3] }"#,
            &[(-2.0, 0.0, -6.0), (1.0, 0.0, 1.0), (3.0, 0.0, 5.0)],
        ),
        (
            r#"{ kind = "one-way-damper", damping = 2 }"#,
            &[(9.0, -1.0, 0.0), (9.0, 1.0, 2.0)],
        ),
        (
            r#"{ kind = "isolator", stiffness = 2, damping = 3 }"#,
            &[(1.0, 1.0, 5.0), (-1.0, 0.0, -2.0)],
        ),
        (
            r#"{ kind = "cubic", linear = 2, cubic = 3 }"#,
            &[(2.0, 0.0, 28.0)],
        ),
        (r#"{ kind = "one-way" }"#, &[(3.0, -1.0, 0.0)]),
        (
            r#"{ kind = "coulomb", torque = 2, damping = 0.5 }"#,
            &[(9.0, -1.0, -2.5), (9.0, 2.0, 3.0)],
        ),
        (
            r#"{ kind = "coulomb", negative_torque = 1, positive_torque = 3, static_ratio = 1.5 }"#,
            &[(9.0, -1.0, -1.0), (9.0, 2.0, 3.0)],
        ),
        (
            r#"{ kind = "coulomb", torque = 0, damping = 0.5 }"#,
            &[(9.0, -1.0, -0.5), (9.0, 0.0, 0.0), (9.0, 2.0, 1.0)],
        ),
        (
            r#"{ kind = "decoupler", stiffness = 7, preload = 2 }"#,
            &[(9.0, -1.0, 0.0), (9.0, 1.0, 2.0)],
        ),
        (
            r#"{ kind = "decoupler", stiffness = 7, damping = 2 }"#,
            &[(9.0, -1.0, 0.0), (9.0, 1.5, 3.0)],
        ),
        (
            r#"{ kind = "stop", gap = 0.5, restitution = 0.8 }"#,
            &[(0.4, 1.0, 0.0)],
        ),
        (
            r#"{ kind = "stop", gap = 0.5, stiffness = 2, damping = 4 }"#,
            &[(0.4, 1.0, 0.0), (1.0, 0.5, 3.0), (1.0, -0.5, 0.0)],
        ),
        (
            r#"{ kind = "spring-slider", stiffness = 7, torque = 2 }"#,
            &[(9.0, -1.0, -2.0), (9.0, 1.0, 2.0)],
        ),
        (
            r#"{ kind = "coulomb", torque = 2, damping = 0.5, smoothing = { kind = "quadratic", width = 0.4 } }"#,
            &[(9.0, -1.0, -2.5), (9.0, 0.2, 1.1)],
        ),
        (
            r#"{ kind = "hysteresis-loop", displacements = [-1, 1], loading = [1, 5], unloading = [0, 2] }"#,
            &[
                (-9.0, 1.0, 1.0),
                (0.0, 1.0, 3.0),
                (0.0, -1.0, 1.0),
                (0.5, 1.0, 4.0),
                (9.0, -1.0, 2.0),
            ],
        ),
    ];
    for (law, points) in cases {
        let system = system(&with_line(MATRICES, "law", &format!("law = {law}")));
        for (displacement, velocity, force) in *points {
            let response = system.elements[0].law.response(*displacement, *velocity);
            assert!(
                (response.force - force).abs() < 1e-14,
                "{law} at {displacement}, {velocity}"
            );
        }
    }
}

#[test]
fn keys_of_laws_with_a_memory_reach_their_equations() {
    // Deflection, rate and internal state; force and rate of the internal state.
    let cases: &[(&str, [f64; 3], [f64; 2])] = &[
        (
            r#"{ kind = "dahl", stiffness = 4, torque = 2 }"#,
            [9.0, -1.0, 0.25],
            [1.0, -1.0 - 2.0 * 0.25],
        ),
        (
            r#"{ kind = "lugre", stiffness = 4, damping = 0.5, viscous_damping = 0.25, torque = 2 }"#,
            [9.0, 2.0, 0.25],
            [1.0 + 0.5 * 1.0 + 0.25 * 2.0, 2.0 - 4.0 * 0.25],
        ),
        (
            r#"{ kind = "valanis", stiffness = 4, slip_stiffness = 1, torque = 2, sharpness = 0 }"#,
            [2.0, 3.0, 4.0],
            [4.0, 3.0 * 1.0],
        ),
    ];
    for (law, [u, v, internal], [force, rate]) in cases {
        let system = system(&with_line(MATRICES, "law", &format!("law = {law}")));
        let found = system.elements[0]
            .law
            .memory()
            .unwrap()
            .evaluate(*u, *v, *internal);
        assert!((found.force - force).abs() < 1e-14, "{law}: {found:?}");
        assert!((found.rate - rate).abs() < 1e-14, "{law}: {found:?}");
    }
}

#[test]
fn keys_of_switching_laws_reach_their_regimes() {
    let table = |law: &str| {
        let system = system(&with_line(MATRICES, "law", &format!("law = {law}")));
        let law = std::sync::Arc::clone(&system.elements[0].law);
        (law.regimes().unwrap(), law.is_monotone(), law.locks())
    };
    let limits = |table: &RegimeTable, name: &str| -> Vec<f64> {
        let regime = table.regimes.iter().find(|regime| regime.name == name).unwrap();
        regime.guards.iter().map(|guard| guard.constant).collect()
    };
    let (clutch, monotone, locks) = table(r#"{ kind = "one-way" }"#);
    assert!(monotone && locks && !clutch.internal);
    assert_eq!(limits(&clutch, "locked"), [0.0]);
    let (friction, monotone, locks) =
        table(r#"{ kind = "coulomb", negative_torque = 1, positive_torque = 3, static_ratio = 1.5 }"#);
    assert!(!monotone && !locks);
    assert_eq!(limits(&friction, "stick"), [1.5, 4.5]);
    let (friction, monotone, _) = table(r#"{ kind = "coulomb", torque = 2 }"#);
    assert!(monotone);
    assert_eq!(limits(&friction, "stick"), [2.0, 2.0]);
    let (slider, _, _) = table(r#"{ kind = "spring-slider", stiffness = 7, torque = 2 }"#);
    assert!(slider.internal);
    assert_eq!(limits(&slider, "stick"), [2.0, 2.0]);
    let (decoupler, _, _) = table(r#"{ kind = "decoupler", stiffness = 7, preload = 2 }"#);
    assert!(decoupler.internal);
    assert_eq!(limits(&decoupler, "locked"), [0.0, 2.0]);
    let (stop, _, _) = table(r#"{ kind = "stop", gap = 0.5, restitution = 0.8 }"#);
    assert_eq!(
        stop.regimes[0].guards[0].transition,
        Transition::Impact {
            restitution: 0.8,
            rest: 0
        }
    );
    assert_eq!(limits(&stop, "free"), [0.5]);
    let (measured, _, _) = table(
        r#"{ kind = "hysteresis-loop", displacements = [-1, 1], loading = [1, 5], unloading = [0, 2] }"#,
    );
    assert_eq!(measured.regimes.len(), 9);
}

#[test]
fn measures_may_have_prescribed_parts() {
    let line = "displacement = { pulley = 1.0 }\nconstant = 3.0\n\
                harmonics = [{ order = 1, cos = 0.5, sin = 0.25 }]";
    let (model, _) = read(&with_line(MATRICES, "displacement", line));
    let system = model.system().unwrap();
    let tension = &system.outputs[system.output_index("tension").unwrap()];
    assert_eq!(tension.constant, 3.0);
    assert_eq!(tension.harmonics, [(1, 0.5, 0.25)]);
    assert_eq!(model.number("output.tension.constant").unwrap(), 3.0);
    let changed = model.with_number("output.tension.harmonics.0.sin", 0.75).unwrap();
    assert_eq!(
        changed.system().unwrap().outputs.last().unwrap().harmonics,
        [(1, 0.5, 0.75)]
    );
}

#[test]
fn smoothing_reaches_the_law() {
    // theory 02 §4: at u = 0 the quadratic law is eps/4 times the stiffness, the quartic 3 eps/16, cosh eps ln2/2.
    for (kind, at_zero) in [
        ("tanh", 0.0),
        ("arctan", 0.0),
        ("cosh", 0.5 * std::f64::consts::LN_2),
        ("quadratic", 0.25),
        ("quartic", 3.0 / 16.0),
    ] {
        let smoothing = format!("[smoothing]\nkind = \"{kind}\"\nwidth = 0.001\n");
        let law = format!(
            "law = {{ kind = \"wrap-spring\", stiffness = 24.0, smoothing = {{ kind = \"{kind}\", width = 0.001 }} }}"
        );
        for text in [
            format!("{DIMENSIONLESS}{smoothing}"),
            with_line(MATRICES, "law", &law),
        ] {
            let response = system(&text).elements[0].law.response(0.0, 0.0);
            assert!((response.force - 24.0 * 0.001 * at_zero).abs() < 1e-14, "{kind}");
        }
        let (model, _) = read(&format!("{PHYSICAL}{smoothing}"));
        assert!(!model.system().unwrap().is_piecewise_linear());
    }
    assert!(system(DIMENSIONLESS).is_piecewise_linear());
}

#[test]
fn values_that_overflow_together_are_an_error() {
    let text = with_line(PHYSICAL, "belt_stiffness", "belt_stiffness = 1e308").replace("\"30 mm\"", "1e10");
    let error = read(&text).0.system().unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("the parameters cannot be combined to a system: "),
        "{error}"
    );
}

#[test]
fn rounding_does_not_make_a_mass_matrix_asymmetric() {
    let rounded = with_line(
        MATRICES,
        "mass",
        "mass = [[1.0, 0.3], [0.30000000000000004, 1.6]]",
    );
    assert_eq!(system(&rounded).mass.as_slice(), [1.0, 0.3, 0.3, 1.6]);
}
