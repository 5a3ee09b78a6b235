//! The geometrically exact steady state against `drive_three_pulley.json` (theory 04 §2.8, §7, §8.1).

use crate::drive_steady::steady;
use slackside_belt_drive::drive::{Drive, SpanEnds};
use slackside_belt_drive::elastica::ElasticaState;
use slackside_belt_drive::prototypes::three_pulley;
use slackside_testkit::{assert_close, number, numbers, reference};
use std::f64::consts::PI;

#[test]
fn exact_steady_state() {
    let file = reference("drive_three_pulley.json");
    let expected = &file["elastica_steady_state"];
    let drive = three_pulley(number(&expected["EI"]));
    let speed = number(&expected["belt_speed"]) / drive.pulleys[0].radius;
    let found = ElasticaState::solve(&drive, speed).unwrap();
    let momentum_flux = drive.belt.mass_per_length * found.belt_speed.powi(2);
    let forces: Vec<f64> = found
        .spans
        .iter()
        .map(|span| span.force + momentum_flux)
        .collect();
    for (key, values, scale) in [
        ("span_force_plus_mc2", &forces, 300.0),
        ("arm_coordinate", &found.positions, 0.1),
        ("wrap", &found.wraps, 1.0),
        ("spring_torque_at_reference", &found.spring_torques, 20.0),
        ("natural_length", &vec![found.natural_length], 1.0),
    ] {
        let expected = if key == "natural_length" {
            vec![number(&expected[key])]
        } else {
            numbers(&expected[key])
        };
        assert_eq!(values.len(), expected.len());
        for (value, expected) in values.iter().zip(expected) {
            assert_close(value / scale, expected / scale, 1e-12, key);
        }
    }
}

#[test]
fn ordinary_steady_state_approaches_the_exact_one_and_more_so_with_corrected_ends() {
    // Theory 04 §8.1; relative differences of the effective tension as measured, with ends at the tangent points and with
    // corrected ones: 1.6e-4 and 1.5e-4, 9.1e-4 and 6.3e-4, 4.0e-3 and 3.3e-3.
    for (stiffness, rpm, bound) in [(0.005, 0.0, 3e-4), (0.015, 2000.0, 1e-3), (0.05, 4000.0, 5e-3)] {
        let mut drive = three_pulley(stiffness);
        let exact = ElasticaState::solve(&drive, rpm * PI / 30.0).unwrap();
        let distance = |drive: &Drive| {
            let ordinary = steady(drive, rpm);
            let tension = ordinary.effective_tensions[0] / exact.spans[0].force - 1.0;
            (tension.abs(), (ordinary.positions[0] - exact.positions[0]).abs())
        };
        let tangent = distance(&drive);
        drive.belt.span_ends = SpanEnds::Contact;
        let contact = distance(&drive);
        assert!(contact.0 < bound, "{contact:?}");
        assert!(
            contact.0 < tangent.0 && contact.1 < tangent.1,
            "{contact:?} {tangent:?}"
        );
    }
}
