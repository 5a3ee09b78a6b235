//! Matrices of the linear model against quadrature and the geometry (theory 04 §3).

use crate::drives::{Case, close, config, running};
use crate::span::integral;
use proptest::prelude::*;
use slackside_belt_drive::drive::{BeltModel, Guide};
use slackside_belt_drive::layout::Layout;
use slackside_belt_drive::model::{Coordinate, LinearModel};
use slackside_linalg::Matrix;
use std::f64::consts::PI;

/// Value, first, second and third derivative of a local shape: start ramp, end ramp, sines.
pub(crate) fn shape(index: usize, length: f64, x: f64) -> [f64; 4] {
    match index {
        0 => [1.0 - x / length, -1.0 / length, 0.0, 0.0],
        1 => [x / length, 1.0 / length, 0.0, 0.0],
        n => {
            let beta = (n - 1) as f64 * PI / length;
            let (sine, cosine) = (beta * x).sin_cos();
            [sine, beta * cosine, -beta * beta * sine, -beta.powi(3) * cosine]
        }
    }
}

/// `∫ density(φ_a, φ_b) dx` of all pairs of local shapes.
pub(crate) fn quadrature(size: usize, length: f64, density: impl Fn([f64; 4], [f64; 4]) -> f64) -> Matrix {
    let mut matrix = Matrix::zeros(size, size);
    for a in 0..size {
        for b in 0..size {
            matrix[(a, b)] = integral(length, size + 2, |x| {
                density(shape(a, length, x), shape(b, length, x))
            });
        }
    }
    matrix
}

#[track_caller]
pub(crate) fn same_matrix(found: &Matrix, expected: &Matrix, tolerance: f64, what: &str) {
    let scale = expected.max_abs().max(1e-3);
    for i in 0..expected.rows() {
        for j in 0..expected.columns() {
            let (a, b) = (found[(i, j)], expected[(i, j)]);
            assert!(
                (a - b).abs() <= tolerance * scale,
                "{what}[{i}, {j}]: {a} and {b} of {scale}"
            );
        }
    }
}

fn model(case: &Case) -> LinearModel {
    LinearModel::new(&case.drive, &case.steady())
}

proptest! {
    #![proptest_config(config(16))]

    #[test]
    fn span_matrices_are_quadratures(case in running()) {
        let (steady, belt) = (case.steady(), &case.drive.belt);
        let model = model(&case);
        for (i, span) in model.spans.iter().enumerate() {
            let (length, tension) = (steady.layout.spans[i].length, steady.effective_tensions[i]);
            let (mass, speed) = (belt.mass_per_length, steady.belt_speed);
            let size = span.mass.rows();
            prop_assert_eq!(size, 2 + belt.terms[i]);
            same_matrix(&span.mass, &quadrature(size, length, |a, b| mass * a[0] * b[0]), 1e-12, "M");
            same_matrix(
                &span.gyroscopic,
                &quadrature(size, length, |a, b| mass * speed * (a[0] * b[1] - a[1] * b[0])),
                1e-12, "G",
            );
            same_matrix(
                &span.stiffness,
                &quadrature(size, length, |a, b| tension * a[1] * b[1] + belt.bending_stiffness * a[2] * b[2]),
                1e-12, "K",
            );
        }
    }

    #[test]
    fn mass_and_stiffness_are_symmetric_and_the_gyroscopic_matrix_is_skew(case in running()) {
        let model = model(&case);
        same_matrix(&model.mass.transpose(), &model.mass, 1e-15, "M");
        same_matrix(&model.stiffness.transpose(), &model.stiffness, 1e-15, "K");
        same_matrix(&model.gyroscopic.transpose(), &model.gyroscopic.scaled(-1.0), 1e-15, "G");
        prop_assert_eq!(model.damping.max_abs(), 0.0);
        prop_assert_eq!(model.circulatory.max_abs(), 0.0);
        prop_assert!(slackside_linalg::is_positive_definite(&model.mass));
    }

    /// A rigid rotation of the whole drive stretches nothing and meets no gyroscopic force.
    #[test]
    fn rotation_of_the_whole_drive_is_free(case in running()) {
        let model = model(&case);
        let motion: Vec<f64> = model.coordinates.iter().map(|coordinate| match coordinate {
            Coordinate::Pulley(j) | Coordinate::Accessory(j) => 1.0 / case.drive.pulleys[j].radius,
            _ => 0.0,
        }).collect();
        let largest = model.stiffness.max_abs() * 50.0;
        for (elastic, gyroscopic) in model.stiffness.times(&motion).iter().zip(model.gyroscopic.times(&motion)) {
            prop_assert!(elastic.abs() < 1e-14 * largest);
            prop_assert_eq!(gyroscopic, 0.0);
        }
    }

    /// A span stretches by what its ends move apart along it beyond what it wraps onto the pulleys, by the rotation of the
    /// downstream pulley, and minus that of the upstream one.
    #[test]
    fn stretch_rows_follow_from_the_geometry(case in running()) {
        let (drive, steady) = (&case.drive, case.steady());
        let model = model(&case);
        for i in 0..drive.pulleys.len() {
            for (k, coordinate) in model.coordinates.iter().enumerate() {
                let found = model.stretch[(i, k)];
                match coordinate {
                    Coordinate::Pulley(j) => {
                        let radius = drive.pulleys[j].radius;
                        let expected = f64::from(j == drive.next(i)) * radius - f64::from(j == i) * radius;
                        prop_assert_eq!(found, expected);
                    }
                    Coordinate::Arm(arm) => {
                        let step = match drive.tensioners[arm].guide {
                            Guide::Rotary { .. } => 1e-4,
                            Guide::Linear { .. } => 1e-5,
                        };
                        let at = |factor: f64| {
                            let mut positions = steady.positions.clone();
                            positions[arm] += factor * step;
                            let span = Layout::new(drive, &positions).unwrap().spans[i];
                            span.length - span.offset * steady.layout.spans[i].direction.angle_to(span.direction)
                        };
                        close(found, (at(1.0) - at(-1.0)) / (2.0 * step), 1e-6, 0.1, "stretch by an arm");
                    }
                    Coordinate::Sine { span, term } => {
                        let expected = if span == i { steady.spans[i].coupling(term) } else { 0.0 };
                        prop_assert_eq!(found, expected);
                    }
                    Coordinate::Accessory(_) => prop_assert_eq!(found, 0.0),
                }
            }
        }
    }

    /// With the sine amplitudes following statically, a span is as soft as belt stretch and sag make it, however many
    /// terms it has.
    #[test]
    fn static_compliance_does_not_depend_on_the_terms(case in running(), terms in 0_usize..15) {
        let mut other = case.clone();
        other.drive.belt.terms = vec![terms; case.drive.pulleys.len()];
        let compliances = |case: &Case| -> Vec<f64> {
            let (steady, model) = (case.steady(), model(case));
            (0..case.drive.pulleys.len()).map(|i| {
                let sines: f64 = (1..=case.drive.belt.terms[i])
                    .map(|n| steady.spans[i].coupling(n).powi(2) / steady.spans[i].term_stiffness(n)).sum();
                1.0 / model.span_stiffness[i] + sines
            }).collect()
        };
        for (a, b) in compliances(&case).iter().zip(compliances(&other)) {
            close(*a, b, 1e-12, 0.0, "compliance of a span");
        }
    }

    #[test]
    fn without_sines_arms_feel_taut_strings(case in running()) {
        let mut drive = case.drive.clone();
        drive.belt.model = BeltModel::Spring;
        let installed = slackside_belt_drive::steady::Installed::new(&drive).unwrap();
        let steady = slackside_belt_drive::steady::SteadyState::solve(&drive, &installed, case.speed);
        prop_assume!(steady.is_ok());
        let steady = steady.unwrap();
        let model = LinearModel::new(&drive, &steady);
        prop_assert_eq!(model.coordinates.len(), drive.pulleys.len() + drive.tensioners.len());
        prop_assert_eq!(model.gyroscopic.max_abs(), 0.0);
        for arm in 0..drive.tensioners.len() {
            let at = model.coordinates.arm(arm);
            let spans: f64 = (0..drive.pulleys.len()).map(|i| {
                let rates = &steady.kinematics.spans[i][arm];
                let length = steady.layout.spans[i].length;
                drive.belt.axial_stiffness / length * rates.along().powi(2)
                    + steady.effective_tensions[i] / length * rates.across().powi(2)
            }).sum();
            let geometric: f64 = drive.carried_by(arm).map(|j| match drive.tensioners[arm].guide {
                Guide::Rotary { pivot } => steady.belt_forces[j].dot(steady.layout.centres[j] - pivot),
                Guide::Linear { .. } => 0.0,
            }).sum();
            close(model.stiffness[(at, at)], drive.tensioners[arm].spring_rate + geometric + spans, 1e-12, 0.0, "arm stiffness");
            let carried: f64 = drive.carried_by(arm)
                .map(|j| drive.pulleys[j].mass * steady.kinematics.centre_rates[j][arm].length_squared()).sum();
            close(model.mass[(at, at)], drive.tensioners[arm].inertia + carried, 1e-14, 0.0, "arm inertia");
        }
    }
}
