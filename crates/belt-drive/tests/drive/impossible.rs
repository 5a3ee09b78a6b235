//! Drives that cannot run: what is said about each, and that extreme numbers end in an answer or in an error.

use crate::drives::{config, ring_of, running};
use glam::DVec2;
use proptest::prelude::*;
use slackside_belt_drive::drive::{BeltModel, Drive, Guide, Installation, Load, Mount, Sense, SpanEnds};
use slackside_belt_drive::layout::{LayoutError, infer_rotation};
use slackside_belt_drive::model::LinearModel;
use slackside_belt_drive::modes::{ModesError, limit_speed, undamped_modes};
use slackside_belt_drive::prototypes::three_pulley;
use slackside_belt_drive::steady::{Installed, SteadyError, SteadyState};

fn square() -> Drive {
    ring_of(4, 0.05, 1e-3, BeltModel::Beam)
}

#[track_caller]
fn layout_error(drive: &Drive) -> LayoutError {
    match Installed::new(drive) {
        Err(SteadyError::Layout(error)) => error,
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn at_rest(drive: &Drive) -> SteadyError {
    let installed = Installed::new(drive).unwrap();
    SteadyState::solve(drive, &installed, 0.0).unwrap_err()
}

#[track_caller]
fn says(error: &impl ToString, words: &[&str]) {
    let text = error.to_string();
    for word in words {
        assert!(text.contains(word), "\"{word}\" is missing in: {text}");
    }
    assert!(!text.contains("NaN"), "{text}");
}

#[test]
fn layouts() {
    let mut drive = square();
    drive.pulleys[1].mount = Mount::Fixed(DVec2::new(0.2, 0.06));
    let error = layout_error(&drive);
    assert!(
        matches!(&error, LayoutError::Overlap { first, second, .. } if first == "pulley 0" && second == "pulley 1")
    );
    says(
        &error,
        &["pulley 0", "pulley 1", "overlap", "60.0 mm", "100.0 mm"],
    );

    // A pulley within another: not even a tangent.
    let mut drive = square();
    drive.pulleys[1].mount = Mount::Fixed(DVec2::new(0.19, 0.0));
    drive.pulleys[1].radius = 0.01;
    let error = layout_error(&drive);
    assert!(matches!(error, LayoutError::NoTangent { .. }));
    says(&error, &["pulley 0", "pulley 1", "tangent"]);

    // All in the wrong sense, and in the wrong order.
    let error = layout_error(&square().reversed());
    assert!(matches!(error, LayoutError::Turning { .. }));
    says(&error, &["simple loop", "360°"]);
    let mut drive = square();
    drive.pulleys.swap(1, 2);
    let error = layout_error(&drive);
    assert!(
        matches!(
            error,
            LayoutError::Turning { .. } | LayoutError::SpansCross { .. } | LayoutError::SpanHitsPulley { .. }
        ),
        "{error}"
    );

    // An inside pulley that stands inside the path of the belt.
    let mut drive = square();
    drive.pulleys[1].mount = Mount::Fixed(DVec2::new(0.02, -0.02));
    let error = layout_error(&drive);
    assert!(
        matches!(&error, LayoutError::NotTouched { pulley, .. } if pulley == "pulley 1"),
        "{error}"
    );
    says(&error, &["does not touch", "pulley 1", "pulley 0", "pulley 2"]);

    // A back-side pulley pushed so far in that the belt runs through the opposite pulley.
    let mut drive = square();
    drive.pulleys[1].sense = Sense::Clockwise;
    drive.pulleys[1].radius = 0.03;
    drive.pulleys[1].mount = Mount::Fixed(DVec2::new(-0.17, -0.12));
    drive.pulleys[3].radius = 0.14;
    let error = layout_error(&drive);
    assert!(
        matches!(&error, LayoutError::SpanHitsPulley { pulley, .. } if pulley == "pulley 3"),
        "{error}"
    );
    says(&error, &["pulley 0-pulley 1", "pulley 3", "140.0 mm"]);

    // A back-side pulley beyond the opposite side of the loop: spans cross.
    let mut drive = square();
    drive.pulleys.iter_mut().for_each(|pulley| pulley.radius = 0.01);
    drive.pulleys[1].sense = Sense::Clockwise;
    drive.pulleys[1].mount = Mount::Fixed(DVec2::new(-0.14, -0.12));
    let error = layout_error(&drive);
    assert!(matches!(error, LayoutError::SpansCross { .. }), "{error}");
    says(&error, &["cross", "contact"]);
}

#[test]
fn the_sense_of_rotation_is_found() {
    assert_eq!(infer_rotation(&square()), Ok(Sense::CounterClockwise));
    assert_eq!(infer_rotation(&square().reversed()), Ok(Sense::CounterClockwise));
    let mut impossible = square();
    impossible.pulleys[1].mount = Mount::Fixed(DVec2::new(0.2, 0.06));
    assert!(matches!(
        infer_rotation(&impossible),
        Err(LayoutError::Overlap { .. })
    ));
}

#[test]
fn belts_that_do_not_fit() {
    let drive = three_pulley(0.015);
    let installed = Installed::new(&drive).unwrap();
    let fitted = |change: f64, stops: Option<[f64; 2]>| {
        let mut drive = drive.clone();
        let mut other = installed.clone();
        other.natural_length += change;
        drive.tensioners[0].stops = stops;
        SteadyState::solve(&drive, &other, 100.0)
    };
    assert!(fitted(0.0, None).is_ok());
    let error = fitted(0.2, None).unwrap_err();
    assert!(matches!(error, SteadyError::NoEffectiveTension { .. }), "{error}");
    let error = fitted(-1.4, None).unwrap_err();
    assert!(matches!(error, SteadyError::BeltTooShort { .. }), "{error}");
    says(&error, &["too short", "mm"]);
    let reference = drive.tensioners[0].reference;
    let error = fitted(0.004, Some([reference - 0.02, reference + 0.02])).unwrap_err();
    assert!(
        matches!(
            error,
            SteadyError::ArmBeyondStop {
                belt_is_long: true,
                ..
            }
        ),
        "{error}"
    );
    says(&error, &["tensioner", "shorter belt", "°"]);
    let error = fitted(-0.004, Some([reference - 0.02, reference + 0.02])).unwrap_err();
    assert!(
        matches!(
            error,
            SteadyError::ArmBeyondStop {
                belt_is_long: false,
                ..
            }
        ),
        "{error}"
    );
    says(&error, &["longer belt"]);
    // Nowhere between its stops, and no balance beyond them either.
    let error = fitted(0.2, Some([reference - 0.1, reference + 0.1])).unwrap_err();
    says(&error, &["tensioner"]);
}

#[test]
fn dead_centre() {
    // The arm along the bisector of its spans, pointing away from the loop: it takes up nothing.
    let mut drive = three_pulley(0.0);
    drive.installation = Installation::NaturalLength(1.55);
    drive.tensioners[0].spring_preload = Some(10.0);
    let layout = slackside_belt_drive::layout::Layout::new(&drive, &drive.reference_positions()).unwrap();
    let bisector = layout.spans[1].direction - layout.spans[0].direction;
    let centre = layout.centres[1];
    let arm = bisector.normalize() * 0.08;
    drive.tensioners[0].guide = Guide::Rotary { pivot: centre - arm };
    drive.tensioners[0].reference = arm.to_angle();
    drive.pulleys[1].mount = Mount::Carried {
        tensioner: 0,
        place: DVec2::new(0.08, 0.0),
    };
    let error = Installed::new(&drive).unwrap_err();
    assert!(matches!(error, SteadyError::DeadCentre { .. }), "{error}");
    says(&error, &["tensioner", "dead centre"]);
}

#[test]
fn slack_spans() {
    // Fixed centres: the centrifugal tension takes all there is.
    let drive = ring_of(3, 0.05, 1e-3, BeltModel::String);
    let installed = Installed::new(&drive).unwrap();
    let critical = (500.0_f64 / drive.belt.mass_per_length).sqrt() / 0.05;
    let error = SteadyState::solve(&drive, &installed, 1.1 * critical).unwrap_err();
    assert!(matches!(error, SteadyError::NoEffectiveTension { .. }), "{error}");
    says(&error, &["no effective tension", "rpm", "mc²"]);
    // A load that the belt cannot carry: it would have to push. Strings and beams say the same.
    for model in [BeltModel::String, BeltModel::Beam] {
        let mut drive = ring_of(3, 0.05, 1e-3, model);
        drive.pulleys[1].load = Load::Torque(600.0);
        let error = at_rest(&drive);
        assert!(
            matches!(&error, SteadyError::NoEffectiveTension { span, .. } if span == "pulley 0-pulley 1"),
            "{model:?}: {error}"
        );
        says(&error, &["pulley 0-pulley 1", "lower the loads"]);
        assert_eq!(
            model == BeltModel::String,
            error.to_string().contains("a belt cannot push"),
            "{error}"
        );
    }
    let mut drive = three_pulley(0.015);
    drive.pulleys[2].load = Load::Torque(-60.0);
    let error = at_rest(&drive);
    says(&error, &["accessory-crank", "no effective tension"]);
}

#[test]
fn installations_that_say_too_little_or_too_much() {
    let mut drive = three_pulley(0.015);
    drive.installation = Installation::NaturalLength(1.5);
    let error = Installed::new(&drive).unwrap_err();
    assert!(matches!(error, SteadyError::NoPreload { .. }));
    says(&error, &["spring.preload", "tensioner"]);

    let mut drive = square();
    drive.installation = Installation::OperatingPosition { driver_speed: 100.0 };
    let error = Installed::new(&drive).unwrap_err();
    assert_eq!(error, SteadyError::NothingFixesTheTension);

    let mut drive = three_pulley(0.015);
    drive.tensioners.insert(0, drive.tensioners[0].clone());
    drive.tensioners[0].name = "held".into();
    drive.tensioners[0].locked = true;
    if let Mount::Carried { tensioner, .. } = &mut drive.pulleys[1].mount {
        *tensioner = 1;
    }
    drive.installation = Installation::OperatingPosition { driver_speed: 0.0 };
    drive.tensioners[1].spring_preload = Some(-10.0);
    let error = Installed::new(&drive).unwrap_err();
    assert!(
        matches!(&error, SteadyError::SpringPushesAway { tensioner, .. } if tensioner == "tensioner"),
        "{error}"
    );
    says(&error, &["preload"]);
}

#[test]
fn two_arms_that_need_different_tensions() {
    let mut drive = two_arms();
    drive.installation = Installation::OperatingPosition { driver_speed: 0.0 };
    drive.tensioners[0].spring_preload = Some(10.0);
    drive.tensioners[1].spring_preload = Some(30.0);
    assert_eq!(Installed::new(&drive).unwrap_err(), SteadyError::ArmsDisagree);
}

/// A square whose upper and lower corner stand on slides that move outwards.
fn two_arms() -> Drive {
    let mut drive = square();
    for (arm, j) in [1, 3].into_iter().enumerate() {
        let Mount::Fixed(centre) = drive.pulleys[j].mount else {
            unreachable!()
        };
        let mut slide = three_pulley(0.015).tensioners[0].clone();
        slide.name = format!("slide {arm}");
        slide.guide = Guide::Linear {
            direction: centre.normalize(),
        };
        slide.reference = 0.0;
        slide.spring_rate = 5e3;
        slide.inertia = 0.3;
        drive.pulleys[j].mount = Mount::Carried {
            tensioner: arm,
            place: centre,
        };
        drive.tensioners.push(slide);
    }
    drive
}

#[test]
fn no_equilibrium() {
    // Two arms and a belt that is far too short: the search has no single arm to look through.
    let drive = two_arms();
    let mut installed = Installed::new(&drive).unwrap();
    assert!(SteadyState::solve(&drive, &installed, 0.0).is_ok());
    installed.natural_length = 0.3;
    let error = SteadyState::solve(&drive, &installed, 100.0).unwrap_err();
    says(&error, &["955 rpm", "belt length"]);
    installed.natural_length = f64::NAN;
    let error = SteadyState::solve(&drive, &installed, 100.0).unwrap_err();
    assert!(matches!(error, SteadyError::NoEquilibrium { .. }), "{error}");
    says(&error, &["955 rpm"]);
}

#[test]
fn coordinates_without_inertia() {
    let mut drive = square();
    drive.pulleys[2].inertia = 0.0;
    let installed = Installed::new(&drive).unwrap();
    let steady = SteadyState::solve(&drive, &installed, 0.0).unwrap();
    let error = undamped_modes(&drive, &LinearModel::new(&drive, &steady), false).unwrap_err();
    assert!(matches!(error, ModesError::NoInertia { .. }));
    says(&error, &["rotation.pulley 2", "inertia"]);
}

#[test]
fn an_unstable_arm() {
    // A slide whose spring has a negative rate.
    let mut drive = two_arms();
    drive.tensioners[0].spring_rate = -1e8;
    let installed = Installed::new(&drive).unwrap();
    let steady = SteadyState::solve(&drive, &installed, 0.0).unwrap();
    let error = undamped_modes(&drive, &LinearModel::new(&drive, &steady), false).unwrap_err();
    assert_eq!(error, ModesError::Unstable);
}

/// Numbers from the far ends of what can be written, zeros, infinities and NaN.
fn extreme() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(-1.0),
        Just(f64::MIN_POSITIVE),
        Just(f64::MAX),
        (-300.0..300.0_f64).prop_map(|exponent| 10_f64.powf(exponent)),
        (-3.0..3.0_f64).prop_map(|exponent| -10_f64.powf(exponent)),
    ]
}

/// Puts a number into one place of a drive.
fn spoil(drive: &mut Drive, place: usize, index: usize, value: f64) {
    let pulley = index % drive.pulleys.len();
    match place {
        0 => drive.pulleys[pulley].radius = value,
        1 => drive.pulleys[pulley].load = Load::Torque(value),
        2 => drive.pulleys[pulley].inertia = value,
        3 => drive.belt.axial_stiffness = value,
        4 => drive.belt.bending_stiffness = value,
        5 => drive.belt.mass_per_length = value,
        6 => drive.installation = Installation::Tension(value),
        7 => drive.installation = Installation::NaturalLength(value),
        8 => drive.pulleys[pulley].mount = Mount::Fixed(DVec2::new(value, 0.1)),
        9 => drive.pulleys[pulley].load = Load::Power(value),
        _ => {
            if let Some(tensioner) = drive.tensioners.first_mut() {
                match place {
                    10 => tensioner.reference = value,
                    11 => tensioner.spring_rate = value,
                    12 => tensioner.stops = Some([value, 1.0]),
                    13 => tensioner.inertia = value,
                    _ => {
                        tensioner.guide = Guide::Rotary {
                            pivot: DVec2::new(0.0, value),
                        }
                    }
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(config(300))]

    /// Whatever the numbers, the answer is a finite state or an error.
    #[test]
    fn extreme_numbers_never_panic(
        case in running(), place in 0_usize..15, index in 0_usize..8, value in extreme(), speed in prop_oneof![4 => Just(None), 1 => extreme().prop_map(Some)],
    ) {
        let mut drive = case.drive.clone();
        drive.belt.terms = vec![2; drive.pulleys.len()];
        spoil(&mut drive, place, index, value);
        let speed = speed.unwrap_or(case.speed);
        let _ = infer_rotation(&drive).map_err(|error| error.to_string());
        let installed = match Installed::new(&drive) {
            Ok(installed) => installed,
            Err(error) => { prop_assert!(!error.to_string().is_empty()); return Ok(()); }
        };
        let steady = match SteadyState::solve(&drive, &installed, speed) {
            Ok(steady) => steady,
            Err(error) => { prop_assert!(!error.to_string().is_empty()); return Ok(()); }
        };
        let numbers = steady.tensions.iter().chain(&steady.effective_tensions).chain(&steady.positions);
        prop_assert!(numbers.chain([&steady.driver_torque, &steady.natural_length]).all(|number| number.is_finite()), "{steady:?}");
        prop_assert!(steady.belt_forces.iter().all(|force| force.is_finite()));
        let model = LinearModel::new(&drive, &steady);
        if let Ok(modes) = undamped_modes(&drive, &model, index % 2 == 0) {
            prop_assert!(modes.iter().all(|mode| mode.frequency.is_finite()), "{modes:?}");
        }
        let _ = slackside_belt_drive::modes::damped_modes(&drive, &model, false);
    }
}

#[test]
fn a_search_without_steps_looks_at_the_ends() {
    let drive = ring_of(3, 0.05, 1e-3, BeltModel::String);
    let installed = Installed::new(&drive).unwrap();
    assert_eq!(limit_speed(&drive, &installed, 100.0, 0), None);
    assert!(limit_speed(&drive, &installed, 1e5, 0).is_some());
}

#[test]
fn free_contact_points_soften_less() {
    let mut drive = square();
    let indicator = |drive: &Drive| {
        let installed = Installed::new(drive).unwrap();
        SteadyState::solve(drive, &installed, 0.0)
            .unwrap()
            .sag_indicator(drive, 0)
    };
    let tangent = indicator(&drive);
    drive.belt.span_ends = SpanEnds::Contact;
    assert!((indicator(&drive) / tangent - 1.0 / 3.0).abs() < 1e-12);
}
