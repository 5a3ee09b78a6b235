//! Set-valued harmonic balance against the periodic orbits of the nonsmooth reference (theory 05 §5.4, §12).

use serde_json::{Value, json};
use slackside_dynamics::orbit::set_valued::{SetValuedMotion, Settings, solve};
use slackside_mechanics::Law;
use slackside_mechanics::laws::{asymmetric_coulomb, coulomb, one_way, one_way_damper};
use slackside_testkit::nonsmooth_reference::{Machine, Place, nonsmooth_reference, operating_point};
use slackside_testkit::number;
use std::sync::Arc;

fn law(place: Place, input: &Value) -> Arc<dyn Law> {
    match (place, input.get("law"), input.get("clutch")) {
        (Place::Clutch, _, None) => Arc::new(one_way()),
        (Place::Clutch, _, Some(clutch)) => Arc::new(one_way_damper(number(&clutch["c"]))),
        (Place::Arm, None, _) => Arc::new(coulomb(number(&input["Q"]), 1.0)),
        (Place::Arm, Some(law), _) => match law["type"].as_str().unwrap() {
            "asymmetric" => Arc::new(asymmetric_coulomb(
                number(&law["Q_minus"]),
                number(&law["Q_plus"]),
                1.0,
            )),
            "one_way_damper" => Arc::new(one_way_damper(number(&law["c"]))),
            other => panic!("unknown law {other}"),
        },
    }
}

/// Largest relative error of the RMS of coordinates, and rates of cyclic ones.
fn error(motion: &SetValuedMotion, orbit: &Value) -> f64 {
    let mut worst = 0.0_f64;
    for (i, rms) in orbit["q"]["rms"].as_array().unwrap().iter().enumerate() {
        let (found, expected) = if rms.is_null() {
            (motion.rms_of_rate(i), number(&orbit["qdot"]["rms"][i]))
        } else {
            (motion.rms(i), number(rms))
        };
        // A locked arm does not move.
        let scale = if expected == 0.0 { 1e-3 } else { expected };
        worst = worst.max((found - expected).abs() / scale);
    }
    worst
}

fn found(file: &Value, input: &Value, samples: usize, iterations: usize) -> SetValuedMotion {
    let point = operating_point(file, Machine::of(input), input, &law);
    let settings = Settings {
        samples,
        iterations,
        tolerance: 1e-6,
    };
    solve(&point, &settings).unwrap()
}

#[test]
fn motions_agree_with_event_driven_orbits_to_the_order_of_the_sampling() {
    let file = nonsmooth_reference();
    let mut cases = 0;
    for orbit in file["periodic"].as_array().unwrap() {
        let input = &orbit["input"];
        // These laws are no monotone graphs of the velocity.
        if input["name"] == "decoupler" || input["name"] == "static ratio 1.3" {
            continue;
        }
        cases += 1;
        let motion = found(&file, input, 256, 5000);
        let error = error(&motion, orbit);
        assert!(error < 1e-2, "{}: {error:.1e}", input["name"]);
        // Clutches converge slowly, but to this residual always (theory 05 §5.4).
        assert!(
            motion.residual < 1e-4,
            "{}: {:.1e}",
            input["name"],
            motion.residual
        );
        for (port, element) in orbit["fraction"].as_array().unwrap().iter().enumerate() {
            let share = element.get("S").map_or(0.0, number);
            // A stop loses up to a few samples at its ends, where the velocity is small.
            assert!(
                (motion.share_at_rest(port) - share).abs() < 0.07,
                "{}: at rest {} {share}",
                input["name"],
                motion.share_at_rest(port)
            );
        }
    }
    assert_eq!(cases, 24);
}

#[test]
fn four_times_the_samples_give_a_fraction_of_the_error() {
    let file = nonsmooth_reference();
    for name in [
        "friction slip",
        "friction bias",
        "asymmetric friction",
        "viscous one-way",
    ] {
        let orbits = file["periodic"].as_array().unwrap();
        let orbit = orbits
            .iter()
            .find(|orbit| orbit["input"]["name"] == name)
            .unwrap();
        let errors = [256, 1024].map(|samples| {
            let motion = found(&file, &orbit["input"], samples, 1000);
            assert!(motion.converged, "{name}: {:.1e}", motion.residual);
            error(&motion, orbit)
        });
        assert!(
            errors[1] < 0.4 * errors[0] && errors[1] < 1e-3,
            "{name}: {errors:?}"
        );
    }
}

#[test]
fn means_of_a_slipping_clutch_are_balanced() {
    let file = nonsmooth_reference();
    for name in ["clutch 400", "clutch no accessory damping", "clutch low load"] {
        let orbits = file["periodic"].as_array().unwrap();
        let orbit = orbits
            .iter()
            .find(|orbit| orbit["input"]["name"] == name)
            .unwrap();
        let motion = found(&file, &orbit["input"], 512, 4000);
        let mean = motion.forces[0].iter().sum::<f64>() / 512.0;
        let expected = number(&orbit["element_force"]["mean"][0]);
        assert!(
            (mean / expected - 1.0).abs() < 1e-4,
            "{name}: mean torque {mean} {expected}"
        );
        let drift = number(&orbit["qdot"]["mean"][3]);
        assert!(
            (motion.mean_rates[3] / drift - 1.0).abs() < 1e-2,
            "{name}: {} {drift}",
            motion.mean_rates[3]
        );
    }
}

#[test]
fn the_state_at_phase_zero_moves_the_ports_as_the_samples_do() {
    let file = nonsmooth_reference();
    let orbits = file["periodic"].as_array().unwrap();
    for orbit in orbits.iter().filter(|orbit| orbit["input"].get("Q").is_some()) {
        let input = &orbit["input"];
        if input["name"] == "static ratio 1.3" {
            continue;
        }
        let point = operating_point(&file, Machine::of(input), input, &law);
        let motion = found(&file, input, 512, 2000);
        let state = motion.state_at_phase_zero();
        let rates = &state[point.system.order()..];
        for (port, &element) in motion.elements.iter().enumerate() {
            let rate = point.system.elements[element].port.project(rates);
            let size = motion.velocities[port]
                .iter()
                .fold(0.0_f64, |a, v| a.max(v.abs()));
            let difference = (rate - motion.velocities[port][0]).abs();
            assert!(
                difference <= 1e-2 * size + 1e-6,
                "{}: {difference} {size}",
                input["name"]
            );
        }
    }
}

#[test]
fn laws_that_are_no_monotone_graphs_are_refused() {
    let file = nonsmooth_reference();
    let input = json!({ "system": "friction", "W": 240.0, "Q": 1.0 });
    let sticky = |_: Place, _: &Value| -> Arc<dyn Law> { Arc::new(coulomb(1.0, 1.3)) };
    let point = operating_point(&file, Machine::Friction, &input, &sticky);
    let message = solve(&point, &Settings::default()).unwrap_err().to_string();
    assert!(message.contains("\"arm\" (coulomb)"), "{message}");
}
