//! Closed forms against the nonsmooth reference (theory 05 §12), whose numbers come from events, and against identities.

use serde_json::{Value, json};
use slackside_dynamics::closed_form::{
    DenHartog, ImpactOscillator, LockedElement, critical_load, critical_torque, critical_values,
    optimum_torque, slip_orbit,
};
use slackside_linalg::Matrix;
use slackside_mechanics::laws::{coulomb, one_way, wrap_spring};
use slackside_mechanics::{
    Element, Forcing, FrequencyFamily, Harmonic, Law, OperatingPoint, OutsideDomain, Port, System,
    SystemFamily,
};
use slackside_testkit::nonsmooth_reference::{Machine, Place, nonsmooth_reference, operating_point};
use slackside_testkit::{assert_close, number};
use std::sync::Arc;

fn law(place: Place, input: &Value) -> Arc<dyn Law> {
    match place {
        Place::Clutch => Arc::new(one_way()),
        Place::Arm => Arc::new(coulomb(input.get("Q").map_or(1.0, number), 1.0)),
    }
}

fn point(file: &Value, machine: Machine, input: &Value) -> OperatingPoint {
    operating_point(file, machine, input, &law)
}

fn list<'a>(file: &'a Value, key: &str) -> &'a [Value] {
    let list = file[key].as_array().unwrap();
    assert!(!list.is_empty());
    list
}

fn assert_relative(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert_close(found / expected, 1.0, tolerance, what);
}

/// The reference's clutch over its bias load, on which the belt tension depends.
struct OverLoad<'a> {
    file: &'a Value,
    input: Value,
}

impl SystemFamily for OverLoad<'_> {
    fn at(&self, load: f64) -> Result<OperatingPoint, OutsideDomain> {
        let mut input = self.input.clone();
        input["Ml"] = json!(load);
        Ok(point(self.file, Machine::Clutch, &input))
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

#[test]
fn critical_loads_agree_with_bisection_on_events() {
    let file = nonsmooth_reference();
    for entry in list(&file, "critical_load") {
        let input = &entry["input"];
        let expected = number(&entry["M_crit"]);
        let found = if input["load_dependent_tension"] == true {
            let family = OverLoad {
                file: &file,
                input: input.clone(),
            };
            let grid: Vec<f64> = (1..=40).map(|i| 5.0 * f64::from(i)).collect();
            let roots = critical_values(&family, 0, &grid).unwrap();
            assert_eq!(roots.len(), 1);
            assert!(roots[0].locked_above);
            roots[0].value
        } else {
            critical_load(&point(&file, Machine::Clutch, input), 0)
                .unwrap()
                .critical
        };
        assert_relative(found, expected, 1e-12, &format!("critical load at {input}"));
    }
}

#[test]
fn a_locked_clutch_transmits_its_bias_in_the_mean() {
    let file = nonsmooth_reference();
    let input = json!({ "W": 260.0, "Ml": 3.0 });
    let load = critical_load(&point(&file, Machine::Clutch, &input), 0).unwrap();
    assert_close(load.mean.unwrap(), 3.0, 1e-13, "mean torque");
    assert_close(
        load.amplitude_factor().unwrap(),
        3.0 / load.critical,
        1e-15,
        "amplitude factor",
    );
}

#[test]
fn the_amplitude_factor_makes_a_load_critical() {
    let file = nonsmooth_reference();
    let load = critical_load(
        &point(&file, Machine::Clutch, &json!({ "W": 260.0, "Ml": 3.0 })),
        0,
    )
    .unwrap();
    let amplitude = 0.005 * load.amplitude_factor().unwrap();
    let scaled = json!({ "W": 260.0, "Ml": 3.0, "theta": [[1, amplitude, 0.0]] });
    let critical = critical_load(&point(&file, Machine::Clutch, &scaled), 0).unwrap();
    assert_close(
        critical.critical,
        3.0,
        1e-12,
        "critical load of the scaled excitation",
    );
}

#[test]
fn sensitivity_to_the_inertia_ratio_agrees_with_differences() {
    let file = nonsmooth_reference();
    let two = json!([[1, 0.005, 0.0], [2, 0.0012, 0.0009]]);
    for theta in [json!([[1, 0.005, 0.0]]), two] {
        for frequency in [200.0, 300.0, 400.0] {
            let value = |alpha: f64| {
                let input = json!({ "W": frequency, "alpha": alpha, "theta": theta });
                critical_load(&point(&file, Machine::Clutch, &input), 0)
                    .unwrap()
                    .critical
            };
            let step = 1e-4;
            let difference = (value(8.0 - 2.0 * step) - 8.0 * value(8.0 - step) + 8.0 * value(8.0 + step)
                - value(8.0 + 2.0 * step))
                / (12.0 * step);
            let at = point(
                &file,
                Machine::Clutch,
                &json!({ "W": frequency, "alpha": 8.0, "theta": theta }),
            );
            let pulley = at.system.mass[(2, 2)];
            let mut locked = LockedElement::new(&at.system, 0).unwrap();
            let rate = pulley * locked.critical_load_by_inertia(3, frequency).unwrap();
            assert_relative(rate, difference, 1e-8, "dM_cr/dα");
        }
    }
}

#[test]
fn the_clutch_has_no_effect_without_accessory_inertia() {
    let file = nonsmooth_reference();
    let value = |alpha: f64| {
        let input = json!({ "W": 300.0, "alpha": alpha, "c_accessory": 0.0 });
        critical_load(&point(&file, Machine::Clutch, &input), 0)
            .unwrap()
            .critical
    };
    assert_relative(
        value(1e-5) / value(1e-6),
        10.0,
        1e-4,
        "critical load falls with the inertia",
    );
}

#[test]
fn critical_torques_agree_with_bisection_on_events() {
    let file = nonsmooth_reference();
    for entry in list(&file, "critical_torque") {
        let input = &entry["input"];
        let found = critical_torque(&point(&file, Machine::Friction, input), 0).unwrap();
        let expected = number(&entry["Q_cr"]);
        assert_relative(
            found.critical,
            expected,
            1e-12,
            &format!("critical torque at {input}"),
        );
        assert_close(
            found.minimum / expected,
            number(&entry["tau_min"]) / expected,
            1e-12,
            "τ min",
        );
        assert_close(
            found.maximum / expected,
            number(&entry["tau_max"]) / expected,
            1e-12,
            "τ max",
        );
        assert_relative(
            found.stiffness,
            number(&entry["k_eff"]),
            1e-12,
            "static stiffness",
        );
        assert_close(
            found.offset.unwrap(),
            number(&entry["arm_offset"]),
            1e-13,
            "arm offset",
        );
    }
}

#[test]
fn one_harmonic_gives_the_source_over_the_receptance() {
    // (5.1): |τ_1| = |u_lin,1 / R_1|, and the estimate of the optimum knows the same critical torque.
    let file = nonsmooth_reference();
    for entry in list(&file, "optimum_torque") {
        let at = point(&file, Machine::Friction, &entry["input"]);
        let estimate = optimum_torque(&at, 0).unwrap();
        assert_relative(
            estimate.critical,
            number(&entry["Q_cr"]),
            1e-11,
            "critical torque",
        );
        // theory 05 §5.6: errors of 1 to 13 % in the torque and −1 to 24 % in the energy.
        assert_relative(estimate.torque, number(&entry["Q_opt"]), 0.15, "optimum torque");
        let energy = estimate.dissipation / number(&entry["E_max"]);
        assert!((0.98..1.25).contains(&energy), "energy {energy}");
    }
}

#[test]
fn orbits_of_pure_slip_agree_with_events() {
    let file = nonsmooth_reference();
    for entry in list(&file, "matrix_den_hartog") {
        let at = point(&file, Machine::Friction, entry);
        let torque = number(&entry["Q"]);
        let orbit = slip_orbit(&at, 0, torque).unwrap();
        let what = format!("W = {}, Q = {torque}", entry["W"]);
        assert_relative(orbit.extreme, number(&entry["arm_extreme"]), 1e-11, &what);
        assert_relative(orbit.dissipation, number(&entry["dissipation"]), 1e-11, &what);
        assert!(orbit.without_stops, "{what}");
    }
}

#[test]
fn orbits_with_stops_are_told_from_orbits_without() {
    let file = nonsmooth_reference();
    let mut kinds = [0, 0];
    for entry in list(&file, "dissipation_table") {
        let at = point(&file, Machine::Friction, entry);
        let stops = number(&entry["stops_per_half"]) > 0.0;
        kinds[usize::from(stops)] += 1;
        let found = slip_orbit(&at, 0, number(&entry["Q"]));
        if stops {
            assert!(!found.is_ok_and(|orbit| orbit.without_stops), "{entry}");
        } else {
            let orbit = found.unwrap();
            assert!(orbit.without_stops, "{entry}");
            assert_relative(orbit.dissipation, number(&entry["E"]), 1e-11, "dissipation");
        }
    }
    assert!(kinds[0] > 0 && kinds[1] > 0, "{kinds:?}");
}

/// `x″ + 2ζx′ + x + F sgn x′ = cos rt`.
fn oscillator(ratio: f64, zeta: f64, friction: f64) -> OperatingPoint {
    let mut forcing = Forcing::none(1);
    forcing.add_harmonic(Harmonic {
        order: 1,
        cosine: vec![1.0],
        sine: vec![0.0],
    });
    let system = System {
        coordinates: vec!["x".into()],
        mass: Matrix::identity(1),
        damping: Matrix::diagonal(&[2.0 * zeta]),
        stiffness: Matrix::identity(1),
        damping_linear_in_frequency: None,
        stiffness_quadratic_in_frequency: None,
        forcing,
        elements: vec![Element::new(
            "friction",
            Port::new([(0, 1.0)]),
            coulomb(friction, 1.0),
        )],
        outputs: vec![],
    };
    OperatingPoint {
        system: Arc::new(system),
        frequency: ratio,
    }
}

#[test]
fn den_hartogs_functions_agree_with_the_table_and_with_the_matrix_form() {
    let file = nonsmooth_reference();
    for entry in list(&file["den_hartog"], "table") {
        let (ratio, friction) = (number(&entry["r"]), number(&entry["F_over_P"]));
        let functions = DenHartog::new(ratio);
        let what = format!("r = {ratio}, F/P = {friction}");
        assert_relative(functions.damping, number(&entry["U"]), 1e-12, &what);
        assert_relative(functions.response, number(&entry["V"]), 1e-12, &what);
        assert_relative(functions.stop, number(&entry["S"]), 1e-10, &what);
        assert_relative(functions.limit(), number(&entry["nonstop_limit"]), 1e-10, &what);
        let amplitude = functions.amplitude(friction);
        assert_eq!(amplitude.is_some(), entry["nonstop"] == true, "{what}");
        let orbit = slip_orbit(&oscillator(ratio, 0.0, friction), 0, friction);
        let without_stops = orbit.as_ref().is_ok_and(|orbit| orbit.without_stops);
        assert_eq!(without_stops, amplitude.is_some(), "{what}");
        if let Some(amplitude) = amplitude {
            assert_relative(amplitude, number(&entry["x0_over_static"]), 1e-12, &what);
            let orbit = orbit.unwrap();
            assert_relative(orbit.extreme, amplitude, 1e-11, &what);
            // The load at the maximum of the displacement.
            let phase = functions.phase(friction).unwrap();
            let load = ratio * orbit.maximum_at;
            assert_close((load - phase).sin(), 0.0, 1e-9, &what);
            assert_close((load - phase).cos(), 1.0, 1e-9, &what);
        }
    }
}

#[test]
fn viscous_damping_beside_friction_agrees_with_events() {
    let file = nonsmooth_reference();
    for entry in list(&file["den_hartog"], "viscous") {
        let (ratio, friction) = (number(&entry["r"]), number(&entry["F_over_P"]));
        let at = oscillator(ratio, number(&entry["zeta"]), friction);
        let orbit = slip_orbit(&at, 0, friction).unwrap();
        assert!(orbit.without_stops);
        assert_relative(
            orbit.extreme,
            number(&entry["x0_over_static"]),
            1e-12,
            "amplitude",
        );
    }
}

#[test]
fn the_limit_of_motions_without_stops_is_where_the_certificate_says() {
    for ratio in [0.45, 0.6, 0.8, 1.2, 1.7] {
        let limit = DenHartog::new(ratio).limit();
        for (factor, expected) in [(1.0 - 1e-4, true), (1.0 + 1e-4, false)] {
            let friction = factor * limit;
            let found = slip_orbit(&oscillator(ratio, 0.0, friction), 0, friction);
            assert_eq!(
                found.is_ok_and(|orbit| orbit.without_stops),
                expected,
                "{ratio} {factor}"
            );
        }
    }
}

#[test]
fn impact_motions_agree_with_the_table() {
    let file = nonsmooth_reference();
    for entry in list(&file, "impact") {
        let oscillator = ImpactOscillator {
            ratio: number(&entry["r"]),
            damping_ratio: number(&entry["zeta"]),
            restitution: number(&entry["e"]),
            gap: number(&entry["gap"]),
        };
        let expected = number(&entry["impact_speed"]);
        let motions = oscillator.motions(1).unwrap();
        let found = (motions.iter())
            .min_by(|a, b| {
                (a.impact_speed - expected)
                    .abs()
                    .total_cmp(&(b.impact_speed - expected).abs())
            })
            .unwrap();
        assert_relative(found.impact_speed, expected, 1e-12, "impact speed");
        assert_close(found.phase, number(&entry["phase"]), 1e-12, "phase");
        assert_eq!(found.admissible, entry["admissible"] == true);
    }
}

#[test]
fn a_critical_frequency_is_a_zero_of_the_margin() {
    // The arm with friction 3 N m slips where Q_cr exceeds it; the zeros over frequency must be where Q_cr = 3 N m.
    let file = nonsmooth_reference();
    struct OverFrequency<'a>(&'a Value);
    impl SystemFamily for OverFrequency<'_> {
        fn at(&self, frequency: f64) -> Result<OperatingPoint, OutsideDomain> {
            Ok(point(
                self.0,
                Machine::Friction,
                &json!({ "W": frequency, "Q": 3.0 }),
            ))
        }
        fn is_frequency(&self) -> bool {
            false
        }
    }
    let family = OverFrequency(&file);
    let grid: Vec<f64> = (0..=100).map(|i| 200.0 + 3.0 * f64::from(i)).collect();
    let found = critical_values(&family, 0, &grid).unwrap();
    assert!(found.len() >= 2, "{found:?}");
    assert!(!found[0].locked_above);
    for root in &found {
        let at = family.at(root.value).unwrap();
        assert_relative(
            critical_torque(&at, 0).unwrap().critical,
            3.0,
            1e-10,
            "Q_cr at the zero",
        );
    }
}

#[test]
fn elements_that_do_not_move_are_as_good_as_rigid() {
    let file = nonsmooth_reference();
    // With the clutch held the accessory belongs to its pulley: the friction system of twelve coordinates.
    let input = json!({ "W": 300.0, "Ml": 3.0, "Q": 1.0 });
    let both = point(&file, Machine::Clutch, &input);
    let mut arm = LockedElement::among_engaged(&both.system, 1).unwrap();
    let merged = critical_torque(&point(&file, Machine::Friction, &input), 0).unwrap();
    let found = arm.critical_torque(300.0).unwrap();
    assert_relative(
        found.critical,
        merged.critical,
        1e-11,
        "critical torque with the clutch held",
    );
    assert_relative(
        found.stiffness,
        merged.stiffness,
        1e-11,
        "static stiffness with the clutch held",
    );
    assert_eq!(arm.held[0].name, "clutch");
    // The clutch's own margin: mean load less the dynamic torque while the arm is held too.
    let force = arm.force(300.0).unwrap();
    let margins = arm.holding_margins(&force, 300.0).unwrap();
    let mut clutch = LockedElement::among_engaged(&both.system, 0).unwrap();
    let load = clutch.critical_load(300.0).unwrap();
    assert_relative(margins[0], 3.0 - load.critical, 1e-9, "margin of the clutch");
    let force = clutch.force(300.0).unwrap();
    let margins = clutch.holding_margins(&force, 300.0).unwrap();
    assert_relative(margins[0], 1.0 - merged.critical, 1e-9, "margin of the arm");
    // A spring that stays engaged counts as linear.
    let mut sprung = (*both.system).clone();
    sprung.elements[1].law = Arc::new(wrap_spring(50.0));
    let mut stiff = (*point(&file, Machine::Clutch, &json!({ "W": 300.0, "Ml": 3.0 })).system).clone();
    stiff.stiffness[(1, 1)] += 50.0;
    let mut engaged = LockedElement::among_engaged(&sprung, 0).unwrap();
    assert_eq!(engaged.engaged, ["arm"]);
    let expected = LockedElement::new(&stiff, 0)
        .unwrap()
        .critical_load(300.0)
        .unwrap();
    let found = engaged.critical_load(300.0).unwrap();
    assert_relative(
        found.critical,
        expected.critical,
        1e-11,
        "critical load beside a spring",
    );
}

#[test]
fn what_has_no_closed_form_is_refused_with_the_reason() {
    let file = nonsmooth_reference();
    let both = point(
        &file,
        Machine::Clutch,
        &json!({ "W": 300.0, "Ml": 3.0, "Q": 1.0 }),
    );
    let message = critical_load(&both, 0).unwrap_err().to_string();
    assert!(message.contains("\"arm\""), "{message}");
    let clutch = point(&file, Machine::Clutch, &json!({ "W": 300.0 }));
    let message = critical_torque(&clutch, 0).unwrap_err().to_string();
    assert!(message.contains("no dry friction"), "{message}");
    let two = json!({ "W": 300.0, "theta": [[1, 0.005, 0.0], [2, 0.001, 0.0]] });
    let message = slip_orbit(&point(&file, Machine::Friction, &two), 0, 1.0)
        .unwrap_err()
        .to_string();
    assert!(message.contains("[1, 2]"), "{message}");
    let message = critical_load(&oscillator(1.5, 0.0, 1.0), 3)
        .unwrap_err()
        .to_string();
    assert!(message.contains("no element 3"), "{message}");
    let mut silent = (*oscillator(1.5, 0.0, 1.0).system).clone();
    silent.forcing = Forcing::none(1);
    let family = FrequencyFamily::new(Arc::new(silent));
    assert!(critical_values(&family, 0, &[1.0, 2.0]).is_err());
}
