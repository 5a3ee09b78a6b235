//! Frequencies and limits that are known in closed form (theory 04 §4.4, §4.5).

use crate::drives::{close, config, ring_of};
use proptest::prelude::*;
use slackside_belt_drive::drive::{BeltModel, Drive, Load};
use slackside_belt_drive::model::LinearModel;
use slackside_belt_drive::modes::{Kind, SpeedLimit, limit_speed, undamped_modes};
use slackside_belt_drive::steady::{Installed, SteadyError, SteadyState};
use slackside_linalg::gyroscopic_modes;
use std::f64::consts::PI;

fn solved(drive: &Drive, speed: f64) -> (SteadyState, LinearModel) {
    let installed = Installed::new(drive).unwrap();
    let steady = SteadyState::solve(drive, &installed, speed).unwrap();
    let model = LinearModel::new(drive, &steady);
    (steady, model)
}

fn frequencies(drive: &Drive, speed: f64, driver_is_free: bool) -> Vec<f64> {
    let (_, model) = solved(drive, speed);
    undamped_modes(drive, &model, driver_is_free)
        .unwrap()
        .iter()
        .map(|mode| mode.frequency)
        .collect()
}

#[track_caller]
fn contains(frequencies: &[f64], expected: f64, tolerance: f64, what: &str) {
    let nearest = frequencies
        .iter()
        .map(|found| (found / expected - 1.0).abs())
        .fold(f64::INFINITY, f64::min);
    assert!(
        nearest <= tolerance,
        "{what}: nearest to {expected} is off by {nearest:e}"
    );
}

proptest! {
    #![proptest_config(config(8))]

    /// Spans of a string drive between fixed centres are travelling strings, `ω_n = nπ(c_0² − c²)/(c_0 L)`.
    #[test]
    fn travelling_strings(count in 2_usize..5, belt_speed in 0.0..40.0_f64, load in 0.0..5.0_f64) {
        let mut drive = ring_of(count, 0.045, 3e-3, BeltModel::String);
        drive.belt.terms = vec![24; count];
        drive.pulleys[1].load = Load::Torque(load);
        let (steady, model) = solved(&drive, belt_speed / 0.045);
        let modes = undamped_modes(&drive, &model, false).unwrap();
        let found: Vec<f64> = modes.iter().map(|mode| mode.frequency).collect();
        for i in 0..count {
            let wave_speed = (steady.tensions[i] / drive.belt.mass_per_length).sqrt();
            let length = steady.layout.spans[i].length;
            for n in 1..=3 {
                let expected = n as f64 * PI * (wave_speed.powi(2) - belt_speed.powi(2)) / (wave_speed * length);
                contains(&found, expected, 5e-4, "travelling string");
            }
            close(
                steady.span_frequency(&drive, i),
                PI * (wave_speed.powi(2) - belt_speed.powi(2)) / (wave_speed * length),
                1e-13, 0.0, "frequency on the sheet",
            );
        }
        // Strings do not couple with fixed pulleys: every mode is one or the other (spans of one tension may mix).
        for mode in &modes {
            let rotation: f64 = mode.shares.rotation.iter().sum();
            prop_assert!(rotation.min(1.0 - rotation) < 1e-9);
        }
    }

    /// Pulleys and springs in a ring: `ω_k = 2r √(k/J) |sin(πk/n)|`.
    #[test]
    fn ring_of_springs(count in 3_usize..9, inertia in 1e-4..1e-2_f64) {
        let drive = ring_of(count, 0.02, inertia, BeltModel::Spring);
        let (steady, model) = solved(&drive, 50.0);
        let stiffness = drive.belt.axial_stiffness / steady.layout.spans[0].length;
        let mut expected: Vec<f64> = (0..count)
            .map(|k| 2.0 * 0.02 * (stiffness / inertia).sqrt() * (PI * k as f64 / count as f64).sin().abs())
            .collect();
        expected.sort_by(f64::total_cmp);
        let found = undamped_modes(&drive, &model, true).unwrap();
        for (mode, expected) in found.iter().zip(&expected) {
            close(mode.frequency, *expected, 1e-9, 1.0, "ring of springs");
            prop_assert_eq!(mode.kind, Kind::Rotation);
        }
    }

    /// Two pulleys and springs: `r √(2k(1/J_1 + 1/J_2))` free, `r √(2k/J_2)` with the first one held.
    #[test]
    fn two_pulleys_and_springs(first in 1e-4..1e-2_f64, second in 1e-4..1e-2_f64) {
        let mut drive = ring_of(2, 0.05, first, BeltModel::Spring);
        drive.pulleys[1].inertia = second;
        let (steady, _) = solved(&drive, 0.0);
        let stiffness = drive.belt.axial_stiffness / steady.layout.spans[0].length;
        let free = frequencies(&drive, 0.0, true);
        close(free[1], 0.05 * (2.0 * stiffness * (1.0 / first + 1.0 / second)).sqrt(), 1e-12, 0.0, "free");
        let held = frequencies(&drive, 0.0, false);
        close(held[0], 0.05 * (2.0 * stiffness / second).sqrt(), 1e-12, 0.0, "held");
    }

    /// Two equal pulleys and a beam at rest: even span modes are those of a pinned beam, odd ones obey the secular
    /// equations of the stretch that they share with the springs and with the rotation.
    #[test]
    fn two_pulleys_and_beams(inertia in 5e-4..1e-2_f64, bending in 0.005..0.05_f64) {
        let mut drive = ring_of(2, 0.05, inertia, BeltModel::Beam);
        drive.belt.static_correction = false;
        drive.belt.bending_stiffness = bending;
        let (steady, _) = solved(&drive, 0.0);
        let (span, length) = (&steady.spans[0], steady.layout.spans[0].length);
        let mass = 0.5 * drive.belt.mass_per_length * length;
        let stiffness = drive.belt.axial_stiffness / length;
        let found = frequencies(&drive, 0.0, false);
        for n in [2, 4, 6] {
            prop_assert!(span.coupling(n).abs() < 1e-9 * span.coupling(1).abs());
            contains(&found, (span.term_stiffness(n) / mass).sqrt(), 1e-9, "pinned beam");
        }
        let sag = |omega: f64| -> f64 {
            (1..=12).map(|n| span.coupling(n).powi(2) / (span.term_stiffness(n) - omega * omega * mass)).sum()
        };
        let in_phase = |omega: f64| 1.0 + stiffness * sag(omega);
        let antiphase = |omega: f64| in_phase(omega) - 2.0 * stiffness * 0.05 * 0.05 / (inertia * omega * omega);
        // Every mode is an even one or a zero of one of the two functions: the function changes sign across it.
        for omega in &found {
            let even = (1..=6).any(|n| ((span.term_stiffness(2 * n) / mass).sqrt() / omega - 1.0).abs() < 1e-9);
            let crosses = |f: &dyn Fn(f64) -> f64| f(omega * (1.0 - 1e-8)) * f(omega * (1.0 + 1e-8)) < 0.0;
            prop_assert!(even || crosses(&in_phase) || crosses(&antiphase), "{omega} is none of them");
        }
    }

    /// A string between fixed centres keeps its tension, so it diverges at `c = √(P/m)`, where it goes slack.
    #[test]
    fn limit_of_a_string_drive(count in 2_usize..5, tension in 100.0..600.0_f64) {
        let mut drive = ring_of(count, 0.05, 1e-3, BeltModel::String);
        drive.belt.terms = vec![4; count];
        drive.installation = slackside_belt_drive::drive::Installation::Tension(tension);
        let critical = (tension / drive.belt.mass_per_length).sqrt() / 0.05;
        let installed = Installed::new(&drive).unwrap();
        let limit = limit_speed(&drive, &installed, 1.3 * critical, 10).unwrap();
        close(limit.driver_speed, critical, 1e-8, 0.0, "limit speed");
        if let SpeedLimit::NoSteadyState(error) = limit.limit {
            prop_assert!(matches!(*error, SteadyError::NoEffectiveTension { .. }), "{error}");
        }
        prop_assert!(limit_speed(&drive, &installed, 0.9 * critical, 10).is_none());
    }
}

/// A belt with bending stiffness does not diverge where a string does: bending lengthens the spans, which keeps them taut
/// (theory 04 §4.4).
#[test]
fn a_curved_beam_does_not_diverge() {
    let drive = ring_of(3, 0.05, 1e-3, BeltModel::Beam);
    let installed = Installed::new(&drive).unwrap();
    let critical = (500.0_f64 / drive.belt.mass_per_length).sqrt() / 0.05;
    assert_eq!(limit_speed(&drive, &installed, 2.0 * critical, 20), None);
    let fast = SteadyState::solve(&drive, &installed, 1.5 * critical).unwrap();
    assert!(fast.effective_tensions[0] > 0.0 && fast.tensions[0] > 2.2 * 500.0);
}

/// Moving pinned beams with `m = L = P = 1` (theory 04 §4.5): the sine block of a span between fixed centres.
#[test]
fn moving_pinned_beams() {
    for (speed, bending, expected) in [
        (0.6, 0.03, vec![2.81711524, 8.49699034, 17.31986432]),
        (
            0.5128,
            0.04,
            vec![3.19542466, 9.58616424, 19.65262329, 33.56227203],
        ),
    ] {
        let mut drive = ring_of(2, 0.19, 1e-3, BeltModel::Beam);
        drive.belt.terms = vec![60; 2];
        let length = solved(&drive, 0.0).0.layout.spans[0].length;
        // At rest the installation's tension is the effective one: T = P (1 − c²).
        let force = 500.0 / (1.0 - speed * speed);
        drive.belt.bending_stiffness = bending * force * length * length;
        let (_, at_rest) = solved(&drive, 0.0);
        let sines: Vec<usize> = (2..62).collect();
        let block = |matrix: &slackside_linalg::Matrix| matrix.selected(&sines);
        // The gyroscopic matrix of the same span at some speed, turned to the one that is wanted.
        drive.belt.bending_stiffness = 0.0;
        let (moving, turning) = solved(&drive, 100.0);
        let wanted = speed * (force / drive.belt.mass_per_length).sqrt();
        let modes = gyroscopic_modes(
            &block(&at_rest.spans[0].mass),
            &block(&turning.spans[0].gyroscopic).scaled(wanted / moving.belt_speed),
            &block(&at_rest.spans[0].stiffness),
        )
        .unwrap();
        let unit = (force / drive.belt.mass_per_length).sqrt() / length;
        for (found, expected) in modes.frequencies.iter().zip(&expected) {
            close(found / unit, *expected, 1e-8, 0.0, "moving pinned beam");
        }
    }
}
