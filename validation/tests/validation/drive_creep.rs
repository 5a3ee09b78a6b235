//! Steady creep against `drive_three_pulley.json` (theory 04 §6.2, §7).

use crate::drive_steady::steady;
use slackside_belt_drive::creep::{CreepError, TwoPulleyBelt, steady_creep};
use slackside_belt_drive::prototypes::three_pulley;
use slackside_testkit::{assert_close, number, numbers, reference};

/// Relative agreement of all numbers below.
const DIGITS: f64 = 1e-12;

#[track_caller]
fn agree(found: f64, expected: f64, scale: f64, what: &str) {
    assert_close(found / scale, expected / scale, DIGITS, what);
}

#[test]
fn creep_on_the_three_pulleys() {
    let file = reference("drive_three_pulley.json");
    let block = &file["creep_and_slip"];
    let mut drive = three_pulley(number(&block["EI"]));
    for (pulley, friction) in drive
        .pulleys
        .iter_mut()
        .zip(numbers(&block["effective_friction"]))
    {
        pulley.friction = friction;
    }
    let state = steady(&drive, number(&block["crank_rpm"]));
    let creep = steady_creep(&drive, &state).unwrap();
    for (found, expected) in creep.pulleys.iter().zip(block["pulleys"].as_array().unwrap()) {
        agree(
            found.contact.slip_arc,
            number(&expected["slip_arc"]),
            1.0,
            "slip arc",
        );
        agree(
            found.contact.adhesion_arc,
            number(&expected["adhesion_arc"]),
            1.0,
            "adhesion arc",
        );
        agree(
            found.surface_speed_ratio,
            number(&expected["surface_speed_ratio"]),
            1.0,
            "surface speed",
        );
        agree(
            found.speed_loss,
            number(&expected["speed_loss"]),
            1.0,
            "speed loss",
        );
    }
    agree(
        creep.efficiency.unwrap(),
        number(&block["efficiency"]),
        1.0,
        "efficiency",
    );
}

fn two_pulley_belt() -> TwoPulleyBelt {
    let file = reference("drive_three_pulley.json");
    let input = &file["two_pulley_creep"]["input"];
    let value = |key: &str| number(&input[key]);
    let mut belt = TwoPulleyBelt {
        radii: [value("R1"), value("R2")],
        distance: value("D"),
        crossed: value("crossed") != 0.0,
        mass_per_natural_length: value("m0"),
        axial_stiffness: value("EA"),
        friction: [value("mu1"), value("mu2")],
        natural_length: 0.0,
    };
    belt.natural_length = belt.natural_length_at_rest(value("P0")).unwrap();
    agree(
        belt.natural_length,
        value("natural_length"),
        1.0,
        "natural length",
    );
    belt
}

#[test]
fn two_pulleys() {
    let file = reference("drive_three_pulley.json");
    let block = &file["two_pulley_creep"];
    let belt = two_pulley_belt();
    let torques = numbers(&block["input"]["M2"]);
    for (k, case) in block["cases"].as_array().unwrap().iter().enumerate() {
        let torque = torques[k / 2];
        let found = belt.creep(number(&case["omega1"]), torque).unwrap();
        for (key, value) in [
            ("Pt", found.tight_tension),
            ("Ps", found.slack_tension),
            ("G", found.mass_flux),
            ("gam", found.flux_number),
            ("vt", found.belt_speeds[0]),
            ("vs", found.belt_speeds[1]),
            ("Zt", found.effective_tensions[0]),
            ("Zs", found.effective_tensions[1]),
            ("slip1", found.slip_arcs[0]),
            ("slip2", found.slip_arcs[1]),
            ("natural", found.natural_length),
            ("omega2", found.driven_speed),
            ("M1", found.driving_torque),
            ("M2", found.driven_torque),
            ("speed_loss", found.speed_loss),
            ("efficiency", found.efficiency),
            ("loss", found.power_lost.iter().sum()),
            ("margin1", found.adhesion_arcs[0]),
            ("margin2", found.adhesion_arcs[1]),
        ] {
            let expected = number(&case[key]);
            // The file has its losses and speed losses from differences of nearly equal numbers.
            let lost_digits = if key.ends_with("loss") { 30.0 } else { 1.0 };
            agree(value, expected, lost_digits * expected, key);
        }
    }
}

#[test]
fn largest_moment_of_two_pulleys() {
    let file = reference("drive_three_pulley.json");
    let belt = two_pulley_belt();
    for case in file["two_pulley_creep"]["max_moment"].as_array().unwrap() {
        let speed = number(&case["omega1"]);
        let largest = belt.largest_torque(speed).unwrap();
        agree(largest.torque, number(&case["M2_max"]), 10.0, "largest moment");
        assert_eq!(largest.pulley, 2);
        let error = belt.creep(speed, largest.torque * (1.0 + 1e-9)).unwrap_err();
        assert!(
            matches!(error, CreepError::TorqueTooLarge { pulley: 2, .. }),
            "{error}"
        );
        let limit = belt.creep(speed, largest.torque).unwrap();
        assert_close(limit.adhesion_arcs[1], 0.0, 1e-12, "adhesion arc at the limit");
    }
}
