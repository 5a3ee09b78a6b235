//! The strong form against closed forms and against the sine series.

use crate::six_pulleys::{six_pulleys, steady};
use glam::DVec2;
use slackside_belt_drive::drive::{
    BeltModel, Coupling, Drive, Installation, Load, LossFactor, ModalDamping, Mount, Sense, SpanEnds,
};
use slackside_belt_drive::forced_response::{self, forced_response};
use slackside_belt_drive::model::LinearModel;
use slackside_belt_drive::modes::{damped_modes, undamped_modes};
use slackside_belt_drive::prototypes::three_pulley;
use slackside_belt_drive::strong_form::{
    Configuration, DriverMotion, HarmonicLoad, StrongForm, StrongFormError,
};
use slackside_linalg::Complex;
use std::f64::consts::PI;

fn free_driver() -> Configuration {
    Configuration {
        driver: DriverMotion::Free,
        ..Configuration::default()
    }
}

#[test]
fn travelling_strings_between_fixed_centres() {
    let mut drive = three_pulley(0.0);
    drive.belt.model = BeltModel::String;
    drive.tensioners[0].locked = true;
    let state = steady(&drive, 200.0);
    let form = StrongForm::new(&drive, &state, Configuration::default()).unwrap();
    let mut expected: Vec<f64> = (0..3)
        .flat_map(|i| {
            let wave_speed = (state.tensions[i] / drive.belt.mass_per_length).sqrt();
            let base = PI * (wave_speed.powi(2) - state.belt_speed.powi(2))
                / (wave_speed * state.layout.spans[i].length);
            (1..20).map(move |n| f64::from(n) * base)
        })
        .filter(|frequency| *frequency < 2000.0)
        .collect();
    expected.sort_by(f64::total_cmp);
    for frequency in expected {
        let found = form.natural_motion((frequency * 1.0002).into()).unwrap();
        assert!(
            (found.frequency - frequency).norm() < 1e-12 * frequency,
            "{} {frequency}",
            found.frequency
        );
        assert!(found.last_change < 1e-11);
    }
}

/// Two equal pulleys on fixed centres.
fn two_equal_pulleys() -> Drive {
    let mut drive = three_pulley(0.03);
    drive.pulleys.truncate(2);
    drive.tensioners.clear();
    drive.belt.terms = vec![10; 2];
    for (k, pulley) in drive.pulleys.iter_mut().enumerate() {
        pulley.radius = 0.04;
        pulley.inertia = 5e-4;
        pulley.sense = Sense::CounterClockwise;
        pulley.mount = Mount::Fixed(DVec2::new(0.3 * k as f64, 0.0));
        pulley.load = Load::NONE;
    }
    drive.installation = Installation::Tension(250.0);
    drive
}

#[test]
fn two_equal_pulleys_at_rest_satisfy_their_secular_equations() {
    let drive = two_equal_pulleys();
    let state = steady(&drive, 0.0);
    let form = StrongForm::new(&drive, &state, Configuration::default()).unwrap();
    let (span, length, mass) = (
        &state.spans[0],
        state.layout.spans[0].length,
        drive.belt.mass_per_length,
    );
    let stiffness = drive.belt.axial_stiffness / length;
    // Σ h_n²/(K_nn − ω² mL/2): the static sum in closed form, the rest converges fast.
    let sum = |frequency: f64| -> f64 {
        let inertia = 0.5 * mass * length * frequency * frequency;
        let rest: f64 = (1..2000)
            .map(|n| {
                let term = span.term_stiffness(n);
                span.coupling(n).powi(2) * inertia / ((term - inertia) * term)
            })
            .sum();
        span.sag_compliance() + rest
    };
    let in_phase = |frequency: f64| 1.0 + stiffness * sum(frequency);
    let opposed = |frequency: f64| {
        in_phase(frequency)
            - 2.0 * stiffness * drive.pulleys[1].radius.powi(2)
                / (drive.pulleys[1].inertia * frequency * frequency)
    };
    let pinned = |n: usize| (span.term_stiffness(n) / (0.5 * mass * length)).sqrt();
    // Distance of a frequency from the zero of a function, relative, by its slope.
    let distance = |f: &dyn Fn(f64) -> f64, frequency: f64| {
        let step = 1e-6 * frequency;
        let slope = (f(frequency + step) - f(frequency - step)) / (2.0 * step);
        (f(frequency) / slope / frequency).abs()
    };
    let found = form.natural_motions(100.0, 3000.0).unwrap();
    let mut kinds = [0; 3];
    for motion in &found {
        let frequency = motion.frequency.re;
        let even = (1..10)
            .map(|n| (pinned(2 * n) / frequency - 1.0).abs())
            .fold(f64::INFINITY, f64::min);
        let errors = [
            even,
            distance(&in_phase, frequency),
            distance(&opposed, frequency),
        ];
        let kind = (0..3).min_by(|a, b| errors[*a].total_cmp(&errors[*b])).unwrap();
        assert!(errors[kind] < 1e-9, "{frequency} {errors:?}");
        kinds[kind] += 1;
    }
    // The even terms of the two spans have the same frequencies, each of which a scan lists once.
    let even = (1..40).filter(|n| n % 2 == 0 && pinned(*n) < 3000.0).count();
    assert!(kinds[0] == even && kinds[1] >= 2 && kinds[2] >= 3, "{kinds:?}");
}

#[test]
fn natural_frequencies_agree_with_the_series_on_a_drive_with_arm_slide_and_isolator() {
    let drive = six_pulleys();
    let state = steady(&drive, 250.0);
    let model = LinearModel::new(&drive, &state);
    for (configuration, is_free) in [(Configuration::default(), false), (free_driver(), true)] {
        let form = StrongForm::new(&drive, &state, configuration).unwrap();
        let modes = undamped_modes(&drive, &model, is_free).unwrap();
        let mut worst = 0.0_f64;
        for mode in modes.iter().filter(|mode| mode.frequency > 0.0).take(15) {
            let found = form.natural_motion(mode.frequency.into()).unwrap();
            worst = worst.max((found.frequency / mode.frequency - 1.0).norm());
        }
        assert!(worst < 1e-5, "{worst:.1e}");
        let highest = 1.001 * modes[14].frequency;
        let lowest = 0.9 * modes[usize::from(is_free)].frequency;
        let scanned = form.natural_motions(lowest, highest).unwrap();
        assert_eq!(scanned.len(), 15 - usize::from(is_free));
    }
}

/// The six-pulley drive with every kind of damping that both models have.
fn damped() -> Drive {
    let mut drive = six_pulleys();
    drive.belt.damping.span_dashpot = 5.0;
    drive.belt.damping.loss_factor = Some(LossFactor {
        value: 0.01,
        reference_frequency: 600.0,
    });
    drive.belt.damping.external = 0.2;
    drive.belt.damping.drag = 0.1;
    for tensioner in &mut drive.tensioners {
        tensioner.damping = 0.01 * tensioner.spring_rate / 30.0;
    }
    for pulley in &mut drive.pulleys {
        pulley.bearing_damping = 2e-3;
        if let Coupling::Isolator(part) = &mut pulley.coupling {
            part.damping = 0.05;
        }
    }
    drive
}

#[test]
fn damped_frequencies_agree_with_the_series() {
    let drive = damped();
    let state = steady(&drive, 250.0);
    let form = StrongForm::new(&drive, &state, Configuration::default()).unwrap();
    let modes = damped_modes(&drive, &LinearModel::new(&drive, &state), false).unwrap();
    for mode in modes.iter().take(15) {
        let expected =
            mode.frequency * Complex::new((1.0 - mode.damping_ratio.powi(2)).sqrt(), mode.damping_ratio);
        let found = form.natural_motion(expected).unwrap();
        assert!(expected.im > 0.0);
        assert!(
            (found.frequency - expected).norm() < 2e-5 * mode.frequency,
            "{} {expected}",
            found.frequency
        );
    }
}

#[test]
fn forced_response_agrees_with_the_series() {
    let drive = damped();
    let state = steady(&drive, 250.0);
    let model = LinearModel::new(&drive, &state);
    let rotation = Complex::new(0.01, 0.003);
    let torque = Complex::new(0.0, 2.0);
    let mut by_pulley = HarmonicLoad::driver_rotation(&drive, Complex::ZERO);
    by_pulley.pulley_torques[3] = torque;
    let mut by_driver = by_pulley.clone();
    by_driver.pulley_torques = vec![Complex::ZERO; 6];
    by_driver.pulley_torques[0] = torque;
    let cases = [
        (
            Configuration::default(),
            HarmonicLoad::driver_rotation(&drive, rotation),
            forced_response::HarmonicLoad::DriverRotation(rotation),
        ),
        (
            Configuration::default(),
            by_pulley,
            forced_response::HarmonicLoad::PulleyTorque { pulley: 3, torque },
        ),
        (
            free_driver(),
            by_driver,
            forced_response::HarmonicLoad::DriverTorque(torque),
        ),
    ];
    for frequency in [90.0, 333.0, 800.0] {
        for (configuration, load, of_series) in &cases {
            let form = StrongForm::new(&drive, &state, configuration.clone()).unwrap();
            let exact = form.respond(frequency, load).unwrap();
            let series = forced_response(&drive, &model, frequency, *of_series).unwrap();
            let compare = |exact: &[Complex], series: &[Complex], what: &str, tolerance: f64| {
                let size = exact.iter().map(|value| value.norm()).fold(0.0, f64::max);
                for (a, b) in exact.iter().zip(series) {
                    assert!(
                        (a - b).norm() < tolerance * size,
                        "{what} at {frequency}: {a} {b}"
                    );
                }
            };
            let coordinates = &model.coordinates;
            let of = |index: usize| series.amplitudes[index];
            let rotations: Vec<Complex> = (0..6).map(|j| of(coordinates.pulley(j))).collect();
            compare(&exact.rotations, &rotations, "rotations", 5e-5);
            let arms: Vec<Complex> = (0..2).map(|arm| of(coordinates.arm(arm))).collect();
            compare(&exact.arms, &arms, "arms", 5e-5);
            let accessory = exact.accessory_rotations[3].unwrap();
            compare(
                &[accessory],
                &[of(coordinates.accessory(3).unwrap())],
                "accessory",
                5e-5,
            );
            let tensions: Vec<Complex> = (0..6).map(|i| model.dynamic_tension(&series, i)).collect();
            compare(&exact.tensions, &tensions, "tensions", 5e-5);
            for i in 0..6 {
                // The displacement lacks the static part of the terms that are left out.
                let motion = model.span_motion(&state, &series, i);
                let places = [0.0, 0.3, 0.5, 1.0].map(|share| share * state.layout.spans[i].length);
                let found = places.map(|x| exact.spans[i].displacement(x));
                compare(&found, &places.map(|x| motion.at(x)), "displacements", 2e-3);
            }
        }
    }
}

#[test]
fn reactions_are_what_enforces_prescribed_motion() {
    // The torque of a prescribed driver, applied to a free one, moves it as prescribed; and so for a held arm.
    let drive = damped();
    let state = steady(&drive, 250.0);
    let rotation = Complex::new(0.01, 0.0);
    let prescribed = Configuration {
        held: vec![1],
        ..Configuration::default()
    };
    let load = HarmonicLoad::driver_rotation(&drive, rotation);
    let first = StrongForm::new(&drive, &state, prescribed)
        .unwrap()
        .respond(400.0, &load)
        .unwrap();
    assert_eq!(first.arms[1], Complex::ZERO);
    let mut torques = HarmonicLoad::driver_rotation(&drive, Complex::ZERO);
    torques.pulley_torques[0] = first.driver_torque;
    torques.arm_torques[1] = first.holding_torques[1];
    let second = StrongForm::new(&drive, &state, free_driver())
        .unwrap()
        .respond(400.0, &torques)
        .unwrap();
    assert!((second.rotations[0] - rotation).norm() < 1e-11 * rotation.norm());
    assert!(second.arms[1].norm() < 1e-12);
    assert!((second.arms[0] - first.arms[0]).norm() < 1e-10 * first.arms[0].norm());
    assert_eq!(second.driver_torque, Complex::ZERO);
}

/// Something that is done to a drive.
type Change<'a> = &'a dyn Fn(&mut Drive);

#[test]
fn what_has_no_strong_form() {
    let refused = |change: Change<'_>| {
        let mut drive = three_pulley(0.015);
        change(&mut drive);
        let state = steady(&drive, 100.0);
        match StrongForm::new(&drive, &state, Configuration::default()) {
            Err(StrongFormError::NotInStrongForm { what }) => what,
            other => panic!("{other:?}"),
        }
    };
    let changes: [(Change<'_>, &str); 5] = [
        (&|d| d.belt.span_ends = SpanEnds::Contact, "free contact points"),
        (
            &|d| d.belt.model = BeltModel::Spring,
            "spans without motion of their own",
        ),
        (
            &|d| d.belt.damping.internal_bending = 1e-4,
            "internal bending damping",
        ),
        (&|d| d.belt.damping.rayleigh_mass = 1.0, "Rayleigh damping"),
        (
            &|d| d.belt.damping.modal = Some(ModalDamping::Common(0.01)),
            "modal damping",
        ),
    ];
    for (change, what) in changes {
        assert_eq!(refused(change), what);
    }
}

#[test]
fn impossible_requests() {
    let drive = three_pulley(0.015);
    let state = steady(&drive, 100.0);
    let form = StrongForm::new(&drive, &state, Configuration::default()).unwrap();
    let load = HarmonicLoad::driver_rotation(&drive, Complex::new(0.01, 0.0));
    for frequency in [0.0, -1.0, f64::NAN] {
        assert!(matches!(
            form.respond(frequency, &load),
            Err(StrongFormError::Frequency { .. })
        ));
        assert!(form.natural_motion(frequency.into()).is_err());
    }
    let mut short = load;
    short.arm_torques.clear();
    let error = form.respond(100.0, &short).unwrap_err();
    assert!(
        matches!(
            error,
            StrongFormError::Count {
                expected: 1,
                found: 0,
                ..
            }
        ),
        "{error}"
    );
}
