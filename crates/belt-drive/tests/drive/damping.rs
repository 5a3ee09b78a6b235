//! Damping matrices against quadrature and against their own definitions (theory 04 §3.6).

use crate::drives::{config, running};
use crate::matrices::{quadrature, same_matrix};
use proptest::prelude::*;
use slackside_belt_drive::drive::{BeltDamping, Guide, LossFactor, Mount};
use slackside_belt_drive::model::{Coordinate, LinearModel};
use slackside_belt_drive::steady::SteadyState;
use slackside_linalg::Matrix;

/// The block of one span over its sines.
fn sines(matrix: &Matrix, model: &LinearModel, span: usize) -> Matrix {
    matrix.selected(&model.coordinates.sines(span).collect::<Vec<_>>())
}

fn without_ramps(local: &Matrix) -> Matrix {
    local.selected(&(2..local.rows()).collect::<Vec<_>>())
}

proptest! {
    #![proptest_config(config(16))]

    #[test]
    fn transverse_damping_is_quadrature(case in running()) {
        let mut drive = case.drive.clone();
        let (external, drag, bending) = (0.7, 1.3, 2e-5);
        drive.belt.damping = BeltDamping { external, drag, internal_bending: bending, ..BeltDamping::default() };
        let steady = case.steady();
        let model = LinearModel::new(&drive, &steady);
        let speed = steady.belt_speed;
        for i in 0..drive.pulleys.len() {
            let (length, size) = (steady.layout.spans[i].length, model.spans[i].mass.rows());
            let rate = quadrature(size, length, |a, b| (external + drag) * a[0] * b[0] + bending * a[2] * b[2]);
            let turning = quadrature(size, length, |a, b| speed * (drag * a[0] * b[1] + bending * a[2] * b[3]));
            same_matrix(&sines(&model.damping, &model, i), &without_ramps(&rate), 1e-11, "C of a span");
            same_matrix(&sines(&model.circulatory, &model, i), &without_ramps(&turning), 1e-9, "K_c of a span");
            for arm in 0..drive.tensioners.len() {
                let rates = &steady.kinematics.spans[i][arm];
                for (n, column) in model.coordinates.sines(i).enumerate() {
                    let at = (model.coordinates.arm(arm), column);
                    let both = |local: &Matrix| {
                        rates.across_start * local[(0, 2 + n)] + rates.across_end * local[(1, 2 + n)]
                    };
                    prop_assert!((model.damping[at] - both(&rate)).abs() < 1e-11 * rate.max_abs());
                    prop_assert!((model.circulatory[at] - both(&turning)).abs() < 1e-11 * turning.max_abs().max(1.0));
                }
            }
        }
    }

    /// Power in bearings, arms and spans against `q̇ᵀC q̇`.
    #[test]
    fn dissipated_power(case in running(), velocities in proptest::collection::vec(-1.0..1.0_f64, 120)) {
        let mut drive = case.drive.clone();
        let (dashpot, loss, reference) = (3.0, 0.05, 400.0);
        drive.belt.damping = BeltDamping {
            span_dashpot: dashpot,
            loss_factor: Some(LossFactor { value: loss, reference_frequency: reference }),
            ..BeltDamping::default()
        };
        drive.pulleys.iter_mut().enumerate().for_each(|(j, pulley)| pulley.bearing_damping = 1e-3 * (j + 1) as f64);
        drive.tensioners.iter_mut().for_each(|tensioner| tensioner.damping = 0.8);
        let steady = case.steady();
        let model = LinearModel::new(&drive, &steady);
        let velocities = &velocities[..model.coordinates.len()];
        let mut expected = 0.0;
        for (j, pulley) in drive.pulleys.iter().enumerate() {
            // CCW rotation of the pulley against the body that holds it.
            let frame = match pulley.mount {
                Mount::Carried { tensioner, .. } if matches!(drive.tensioners[tensioner].guide, Guide::Rotary { .. }) =>
                    velocities[model.coordinates.arm(tensioner)],
                _ => 0.0,
            };
            let relative = pulley.sense.sign() * velocities[model.coordinates.pulley(j)] - frame;
            expected += pulley.bearing_damping * relative * relative;
        }
        for arm in 0..drive.tensioners.len() {
            expected += 0.8 * velocities[model.coordinates.arm(arm)].powi(2);
        }
        for i in 0..drive.pulleys.len() {
            let rate: f64 = model.stretch.row(i).iter().zip(velocities).map(|(a, b)| a * b).sum();
            let spring = drive.belt.axial_stiffness / steady.layout.spans[i].length;
            expected += (dashpot + loss * spring / reference) * rate * rate;
        }
        let forces = model.damping.times(velocities);
        let found: f64 = forces.iter().zip(velocities).map(|(a, b)| a * b).sum();
        prop_assert!((found - expected).abs() < 1e-11 * expected);
    }
}

#[test]
fn proportional_damping_is_proportional() {
    let mut drive = slackside_belt_drive::prototypes::three_pulley(0.015);
    drive.belt.damping.rayleigh_mass = 3.0;
    drive.belt.damping.rayleigh_stiffness = 2e-5;
    let installed = slackside_belt_drive::steady::Installed::new(&drive).unwrap();
    let model = LinearModel::new(&drive, &SteadyState::solve(&drive, &installed, 100.0).unwrap());
    let mut expected = model.mass.scaled(3.0);
    expected.add_scaled(2e-5, &model.stiffness);
    same_matrix(&model.damping, &expected, 1e-15, "C");
}

/// An accessory behind a spring, and the same one let loose.
#[test]
fn couplings() {
    use slackside_belt_drive::drive::{Coupling, Flexible};
    let mut drive = slackside_belt_drive::prototypes::three_pulley(0.015);
    let part = Flexible {
        accessory_inertia: 4e-3,
        stiffness: 35.0,
        damping: 0.02,
    };
    drive.pulleys[2].coupling = Coupling::Decoupler {
        spring: part,
        preload: 0.0,
    };
    let installed = slackside_belt_drive::steady::Installed::new(&drive).unwrap();
    let steady = SteadyState::solve(&drive, &installed, 100.0).unwrap();
    let model = LinearModel::new(&drive, &steady);
    let rotor = model.coordinates.accessory(2).unwrap();
    let pulley = model.coordinates.pulley(2);
    assert_eq!(model.mass[(rotor, rotor)], 4e-3);
    assert_eq!(model.mass[(pulley, pulley)], drive.pulleys[2].inertia);
    assert_eq!(
        (model.stiffness[(rotor, rotor)], model.stiffness[(rotor, pulley)]),
        (35.0, -35.0)
    );
    assert_eq!(
        (model.damping[(rotor, rotor)], model.damping[(pulley, rotor)]),
        (0.02, -0.02)
    );
    let open = LinearModel::with_disengaged(&drive, &steady, &[2]);
    assert!(open.stiffness.row(rotor).iter().all(|entry| *entry == 0.0));
    let stays: Vec<usize> = (0..open.coordinates.len())
        .filter(|k| *k != rotor && *k != pulley)
        .collect();
    assert_eq!(open.stiffness.selected(&stays), model.stiffness.selected(&stays));
    drive.pulleys[2].coupling = Coupling::OneWay {
        accessory_inertia: 4e-3,
    };
    let locked = LinearModel::new(&drive, &steady);
    assert_eq!(locked.coordinates.accessory(2), None);
    assert_eq!(locked.mass[(pulley, pulley)], drive.pulleys[2].inertia + 4e-3);
    let open = LinearModel::with_disengaged(&drive, &steady, &[2]);
    assert_eq!(open.mass[(pulley, pulley)], drive.pulleys[2].inertia);
    assert!(matches!(
        open.coordinates.iter().nth(3),
        Some(Coordinate::Accessory(2))
    ));
}
