//! The exact steady state: ways of installing a drive, the limit of small bending stiffness, what it refuses.

use crate::six_pulleys::{six_pulleys, steady};
use slackside_belt_drive::drive::{BeltModel, Installation, SpanEnds};
use slackside_belt_drive::elastica::{ElasticaError, ElasticaState};
use slackside_belt_drive::prototypes::three_pulley;

#[test]
fn ways_of_installing_lead_to_the_same_state() {
    let mut drive = three_pulley(0.015);
    drive.tensioners[0].spring_preload = Some(20.0);
    drive.installation = Installation::OperatingPosition { driver_speed: 200.0 };
    let first = ElasticaState::solve(&drive, 200.0).unwrap();
    assert!((first.positions[0] - drive.tensioners[0].reference).abs() < 1e-11);
    let elsewhere = ElasticaState::solve(&drive, 350.0).unwrap();
    assert!((elsewhere.positions[0] - first.positions[0]).abs() > 1e-3);
    assert!((elsewhere.natural_length - first.natural_length).abs() < 1e-12);
    drive.installation = Installation::NaturalLength(first.natural_length);
    let second = ElasticaState::solve(&drive, 200.0).unwrap();
    for (a, b) in first.spans.iter().zip(&second.spans) {
        assert!((a.force / b.force - 1.0).abs() < 1e-10, "{} {}", a.force, b.force);
    }
}

#[test]
fn balances_hold_on_a_drive_with_arm_and_slide() {
    let mut drive = six_pulleys();
    drive.belt.bending_stiffness = 0.004;
    let found = ElasticaState::solve(&drive, 250.0).unwrap();
    for (j, pulley) in drive.pulleys.iter().enumerate() {
        let before = drive.span_before(j);
        let rise = found.spans[j].end_tensions[0] - found.spans[before].end_tensions[1];
        if j != drive.driver {
            assert!((pulley.radius * rise - found.loads[j]).abs() < 1e-9, "{rise}");
        }
        // The belt meets and leaves the pulley on its pitch circle, square to the radius.
        let (meets, leaves) = (&found.spans[before], &found.spans[j]);
        let chord = meets.contact_points[1].distance(leaves.contact_points[0]);
        assert!((chord - 2.0 * pulley.radius * (0.5 * found.wraps[j]).sin()).abs() < 1e-12);
    }
    // The slide: belt and spring along its direction.
    let pushed = found.belt_forces[5].x + found.spring_torques[1] - 25e3 * found.positions[1];
    assert!(pushed.abs() < 1e-7, "{pushed}");
    let ordinary = steady(&drive, 250.0);
    for (span, tension) in found.spans.iter().zip(&ordinary.effective_tensions) {
        assert!(
            (span.force / tension - 1.0).abs() < 0.02,
            "{} {tension}",
            span.force
        );
    }
}

#[test]
fn small_bending_stiffness_leads_to_the_ordinary_state_with_free_contact_points() {
    let distance = |stiffness: f64| {
        let mut drive = six_pulleys();
        drive.belt.bending_stiffness = stiffness;
        drive.belt.span_ends = SpanEnds::Contact;
        let exact = ElasticaState::solve(&drive, 150.0).unwrap();
        let ordinary = steady(&drive, 150.0);
        (exact.spans[0].force / ordinary.effective_tensions[0] - 1.0).abs()
    };
    let (large, small) = (distance(4e-3), distance(5e-4));
    // The contact points move by 1/λ into arcs that stretch differently from the spans: a difference of order √EI.
    assert!(small < 2e-4 && small < 0.5 * large, "{large} {small}");
}

#[test]
fn what_has_no_exact_steady_state() {
    let mut string = three_pulley(0.015);
    string.belt.model = BeltModel::String;
    assert_eq!(
        ElasticaState::solve(&string, 0.0),
        Err(ElasticaError::NoBendingStiffness)
    );
    let mut impossible = three_pulley(0.015);
    impossible.installation = Installation::NaturalLength(1.0);
    impossible.tensioners[0].spring_preload = Some(20.0);
    let error = ElasticaState::solve(&impossible, 0.0).unwrap_err();
    assert!(
        matches!(error, ElasticaError::Start(_) | ElasticaError::Slender { .. }),
        "{error}"
    );
    // A light wrap on a small idler: the belt leaves 1/λ before either tangent point.
    let error = ElasticaState::solve(&six_pulleys(), 250.0).unwrap_err();
    assert!(
        matches!(&error, ElasticaError::Lifted { pulley } if pulley == "arm idler"),
        "{error}"
    );
    let mut placed = six_pulleys();
    placed.belt.bending_stiffness = 0.004;
    placed.installation = Installation::OperatingPosition { driver_speed: 0.0 };
    for (tensioner, preload) in placed.tensioners.iter_mut().zip([10.0, 100.0]) {
        tensioner.spring_preload = Some(preload);
    }
    assert!(ElasticaState::solve(&placed, 0.0).is_err());
}
