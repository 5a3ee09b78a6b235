//! Creep against an integration along the contacts, its balance of power, and drives that slip.

use crate::six_pulleys::{six_pulleys, steady};
use slackside_belt_drive::creep::{CreepError, SlipDirection, TwoPulleyBelt, steady_creep};
use slackside_numerics::ode::{DormandPrince, Limits, Tolerance};

/// Integrates `y' = f(y)` over an arc.
fn march(arc: f64, start: &[f64], rates: &dyn Fn(&[f64], &mut [f64])) -> Vec<f64> {
    let tolerance = Tolerance {
        relative: vec![1e-14; start.len()],
        floor: start.iter().map(|value| value.abs().max(1e-3)).collect(),
        block: start.len(),
    };
    let limits = Limits {
        max_step: 0.05,
        max_steps: 100_000,
    };
    let mut y = start.to_vec();
    DormandPrince::new(tolerance, limits)
        .integrate(
            &mut |_, y: &[f64], rate: &mut [f64]| rates(y, rate),
            0.0,
            arc,
            &mut y,
            None,
        )
        .unwrap();
    y
}

fn belt(crossed: bool) -> TwoPulleyBelt {
    let mut belt = TwoPulleyBelt {
        radii: [0.07, 0.04],
        distance: 0.35,
        crossed,
        mass_per_natural_length: 0.15,
        axial_stiffness: 40e3,
        friction: [0.6, 0.8],
        natural_length: 0.0,
    };
    belt.natural_length = belt.natural_length_at_rest(500.0).unwrap();
    belt
}

#[test]
fn two_pulleys_agree_with_the_equations_marched_round_the_loop() {
    for crossed in [false, true] {
        let belt = belt(crossed);
        for (speed, share) in [(1.0, 0.2), (200.0, 0.7), (500.0, 0.99)] {
            let torque = share * belt.largest_torque(speed).unwrap().torque;
            let found = belt.creep(speed, torque).unwrap();
            let flux = found.mass_flux;
            let velocity =
                |tension: f64| flux / belt.mass_per_natural_length * (1.0 + tension / belt.axial_stiffness);
            let tensions = [found.tight_tension, found.slack_tension];
            let mut length: f64 = tensions
                .iter()
                .map(|tension| belt.span_length().unwrap() / (1.0 + tension / belt.axial_stiffness))
                .sum();
            let mut lost = 0.0;
            for pulley in 0..2 {
                let (entry, exit) = (tensions[pulley], tensions[1 - pulley]);
                let (radius, friction) = (belt.radii[pulley], belt.friction[pulley]);
                length += radius * found.adhesion_arcs[pulley] / (1.0 + entry / belt.axial_stiffness);
                // The belt lags on the driving pulley and runs ahead on the driven one.
                let sign = if pulley == 0 { -1.0 } else { 1.0 };
                // Tension, natural length, work of friction per time; (N − Gv)' + q_t = 0 with |q_t| = μ (N − Gv)/r.
                let end = march(found.slip_arcs[pulley], &[entry, 0.0, 0.0], &|y, rate| {
                    let friction_force = friction * (y[0] - flux * velocity(y[0]));
                    let inertial = flux * flux / (belt.mass_per_natural_length * belt.axial_stiffness);
                    rate[0] = sign * friction_force / (1.0 - inertial);
                    rate[1] = radius / (1.0 + y[0] / belt.axial_stiffness);
                    rate[2] = friction_force * (velocity(y[0]) - velocity(entry)).abs();
                });
                assert!((end[0] / exit - 1.0).abs() < 1e-12, "{} {exit}", end[0]);
                assert!((end[2] / found.power_lost[pulley] - 1.0).abs() < 1e-10);
                length += end[1];
                lost += end[2];
            }
            assert!((length / belt.natural_length - 1.0).abs() < 1e-13);
            let balance = found.driving_torque * speed - found.driven_torque * found.driven_speed;
            assert!((balance / lost - 1.0).abs() < 1e-8, "{balance} {lost}");
            assert!((found.driven_torque / torque - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn two_pulleys_without_load_do_not_slip() {
    let found = belt(false).creep(100.0, 0.0).unwrap();
    assert_eq!(found.slip_arcs, [0.0; 2]);
    assert_eq!((found.speed_loss, found.efficiency), (0.0, 1.0));
    assert_eq!(found.tight_tension, found.slack_tension);
}

#[test]
fn impossible_pairs_of_pulleys() {
    let tight = belt(false);
    assert!(matches!(
        tight.creep(1.0, -1.0),
        Err(CreepError::NegativeTorque { torque: -1.0 })
    ));
    // The weaker contact is the one that slips.
    let error = tight.creep(1.0, 1e3).unwrap_err();
    assert!(
        matches!(error, CreepError::TorqueTooLarge { pulley: 1, .. }),
        "{error}"
    );
    // A belt held by its stretch alone lifts off at some speed.
    assert!(matches!(tight.creep(1e4, 0.0), Err(CreepError::TooLong { .. })));
    let short = TwoPulleyBelt {
        natural_length: 0.0,
        ..tight
    };
    assert!(matches!(short.creep(1.0, 0.0), Err(CreepError::TooShort { .. })));
    let overlapping = TwoPulleyBelt {
        distance: 0.1,
        ..tight
    };
    assert!(matches!(
        overlapping.creep(1.0, 0.0),
        Err(CreepError::Overlap { .. })
    ));
}

#[test]
fn creep_of_a_drive_agrees_with_its_slip_arcs_marched() {
    let drive = six_pulleys();
    let state = steady(&drive, 250.0);
    let creep = steady_creep(&drive, &state).unwrap();
    let stiffness = drive.belt.axial_stiffness;
    let entry_of_driver = 1.0 + state.tensions[5] / stiffness;
    let velocity = |tension: f64| state.belt_speed * (1.0 + tension / stiffness) / entry_of_driver;
    let momentum_flux = drive.belt.mass_per_length * state.belt_speed.powi(2);
    for (j, pulley) in creep.pulleys.iter().enumerate() {
        let (entry, exit) = (state.tensions[drive.span_before(j)], state.tensions[j]);
        let (sign, direction) = if j == drive.driver {
            (-1.0, SlipDirection::BeltBehind)
        } else {
            (1.0, SlipDirection::BeltAhead)
        };
        assert_eq!(pulley.contact.direction, direction);
        let friction = drive.pulleys[j].friction;
        let end = march(pulley.contact.slip_arc, &[entry, 0.0], &|y, rate| {
            rate[0] = sign * friction * (y[0] - momentum_flux);
            rate[1] = rate[0].abs() * (velocity(y[0]) - velocity(entry)).abs();
        });
        assert!((end[0] / exit - 1.0).abs() < 1e-12, "{} {exit}", end[0]);
        assert!(
            (end[1] / pulley.power_lost - 1.0).abs() < 1e-9,
            "{} {pulley:?}",
            end[1]
        );
        let speed = velocity(entry);
        assert!((pulley.surface_speed_ratio * state.belt_speed / speed - 1.0).abs() < 1e-14);
        assert!((pulley.speed_loss - (1.0 - pulley.surface_speed_ratio)).abs() < 1e-15);
        assert!(
            (pulley.contact.slip_arc + pulley.contact.adhesion_arc - state.layout.wraps[j]).abs() < 1e-14
        );
        assert!((pulley.contact.safety / state.slip_safety(&drive, j) - 1.0).abs() < 1e-12);
    }
    assert!((creep.power_in - creep.power_out - creep.power_lost).abs() < 1e-11 * creep.power_in);
    let efficiency = creep.efficiency.unwrap();
    assert!((efficiency - creep.power_out / creep.power_in).abs() < 1e-14);
    assert!(efficiency < 1.0 && efficiency > 0.99);
}

#[test]
fn gross_slip_names_the_pulley() {
    let mut drive = six_pulleys();
    let state = steady(&drive, 250.0);
    drive.pulleys[3].friction = 0.05;
    let error = steady_creep(&drive, &state).unwrap_err();
    match &error {
        CreepError::GrossSlip {
            pulley,
            slip_arc,
            wrap,
        } => assert!(pulley == "alternator" && slip_arc > wrap),
        other => panic!("{other}"),
    }
    assert!(error.to_string().contains("\"alternator\""), "{error}");
    drive.pulleys[3].friction = 0.0;
    let error = steady_creep(&drive, &state).unwrap_err();
    assert!(matches!(error, CreepError::GrossSlip { slip_arc, .. } if slip_arc.is_infinite()));
}
