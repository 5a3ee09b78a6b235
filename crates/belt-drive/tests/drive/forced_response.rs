//! Harmonic response of random drives: power balance, reciprocity of excitations, static limit (theory 04 §3.7, §3.8).

use crate::drives::{Case, close, config, running};
use proptest::prelude::*;
use slackside_belt_drive::drive::{BeltDamping, Drive, Guide, LossFactor, ModalDamping, Mount};
use slackside_belt_drive::forced_response::{HarmonicLoad, forced_response};
use slackside_belt_drive::model::{Coordinate, LinearModel, Motion};
use slackside_belt_drive::steady::SteadyState;
use slackside_linalg::{Complex, is_positive_definite};

fn damped(case: &Case) -> Drive {
    let mut drive = case.drive.clone();
    drive.belt.damping = BeltDamping {
        span_dashpot: 20.0,
        loss_factor: Some(LossFactor {
            value: 0.04,
            reference_frequency: 500.0,
        }),
        external: 0.4,
        ..BeltDamping::default()
    };
    drive
        .pulleys
        .iter_mut()
        .for_each(|pulley| pulley.bearing_damping = 2e-3);
    drive
        .tensioners
        .iter_mut()
        .for_each(|tensioner| tensioner.damping = 0.5);
    drive
}

/// Mean power that bearings, arms, belt stretch and the air take, from the motion itself.
fn dissipated(drive: &Drive, steady: &SteadyState, model: &LinearModel, motion: &Motion) -> f64 {
    let omega = motion.frequency;
    let half = 0.5 * omega * omega;
    let at = |k: usize| motion.amplitudes[k];
    let mut power = 0.0;
    for (j, pulley) in drive.pulleys.iter().enumerate() {
        let frame = match pulley.mount {
            Mount::Carried { tensioner, .. }
                if matches!(drive.tensioners[tensioner].guide, Guide::Rotary { .. }) =>
            {
                at(model.coordinates.arm(tensioner))
            }
            _ => Complex::ZERO,
        };
        power += half * 2e-3 * (pulley.sense.sign() * at(j) - frame).norm_sqr();
    }
    for arm in 0..drive.tensioners.len() {
        power += half * 0.5 * at(model.coordinates.arm(arm)).norm_sqr();
    }
    for i in 0..drive.pulleys.len() {
        let stretch: Complex = model
            .stretch
            .row(i)
            .iter()
            .zip(&motion.amplitudes)
            .map(|(a, b)| b * *a)
            .sum();
        let length = steady.layout.spans[i].length;
        power += half * (20.0 + 0.04 * drive.belt.axial_stiffness / length / 500.0) * stretch.norm_sqr();
        power += half * 0.4 * length * model.span_motion(steady, motion, i).mean_amplitude().powi(2);
    }
    power
}

/// Torque that the driver's shaft supplies for a motion: its inertia and bearing, and the pull of the spans at its rim.
fn shaft_torque(drive: &Drive, model: &LinearModel, motion: &Motion) -> Complex {
    let (driver, omega) = (drive.driver, motion.frequency);
    let pulley = &drive.pulleys[driver];
    let pull =
        model.dynamic_tension(motion, drive.span_before(driver)) - model.dynamic_tension(motion, driver);
    let mut torque = pulley.radius * pull;
    torque += motion.amplitudes[driver]
        * Complex::new(-omega * omega * pulley.inertia, omega * pulley.bearing_damping);
    if let Mount::Carried { tensioner, .. } = pulley.mount
        && matches!(drive.tensioners[tensioner].guide, Guide::Rotary { .. })
    {
        let arm = motion.amplitudes[model.coordinates.arm(tensioner)];
        torque -= arm * Complex::new(0.0, omega * pulley.bearing_damping * pulley.sense.sign());
    }
    torque
}

/// Where the drive is statically stable.
fn stable(drive: &Drive, model: &LinearModel) -> bool {
    is_positive_definite(&model.stiffness.selected(&model.free_coordinates(drive, false)))
}

proptest! {
    #![proptest_config(config(24))]

    #[test]
    fn power_into_the_driver_is_dissipated(case in running(), frequency in 20.0..2000.0_f64) {
        let (drive, steady) = (damped(&case), case.steady());
        let model = LinearModel::new(&drive, &steady);
        prop_assume!(stable(&drive, &model));
        let motion = forced_response(&drive, &model, frequency, HarmonicLoad::DriverRotation(Complex::new(0.01, 0.003))).unwrap();
        let torque = shaft_torque(&drive, &model, &motion);
        let velocity = Complex::new(0.0, frequency) * motion.amplitudes[drive.driver];
        let supplied = 0.5 * (torque * velocity.conj()).re;
        let lost = dissipated(&drive, &steady, &model, &motion);
        prop_assert!(lost > 0.0);
        close(supplied, lost, 1e-9, 1e-7 * (torque * velocity).norm(), "power");
        // A torque on the free driver that equals this one makes the same motion.
        let driven = forced_response(&drive, &model, frequency, HarmonicLoad::DriverTorque(torque)).unwrap();
        let size = motion.amplitudes.iter().map(|a| a.norm()).fold(0.0, f64::max);
        for (a, b) in motion.amplitudes.iter().zip(&driven.amplitudes) {
            prop_assert!((a - b).norm() < 1e-7 * size, "{a} and {b} of {size}");
        }
    }

    /// Slowly, the whole drive turns with its driver and nothing else happens.
    #[test]
    fn slow_rotation_only_turns_the_drive(case in running()) {
        let (drive, steady) = (case.drive.clone(), case.steady());
        let model = LinearModel::new(&drive, &steady);
        prop_assume!(stable(&drive, &model));
        let motion = forced_response(&drive, &model, 1e-3, HarmonicLoad::DriverRotation(Complex::new(0.01, 0.0))).unwrap();
        let way = 0.01 * drive.pulleys[drive.driver].radius;
        for (k, coordinate) in model.coordinates.iter().enumerate() {
            let expected = match coordinate {
                Coordinate::Pulley(j) => way / drive.pulleys[j].radius,
                _ => 0.0,
            };
            prop_assert!((motion.amplitudes[k] - expected).norm() < 1e-6 * 0.01, "{coordinate:?}");
        }
        for i in 0..drive.pulleys.len() {
            prop_assert!(model.dynamic_tension(&motion, i).norm() < 1e-3 * steady.tensions[i]);
        }
    }

    /// Newton's law for every pulley and, with the hub loads, for every arm: what is read from a motion fits together.
    #[test]
    fn outputs_obey_the_equations_of_motion(case in running(), frequency in 20.0..900.0_f64, torque in 1.0..5.0_f64) {
        let (drive, steady) = (case.drive.clone(), case.steady());
        let model = LinearModel::new(&drive, &steady);
        prop_assume!(stable(&drive, &model));
        let excited = (drive.driver + 1) % drive.pulleys.len();
        let load = HarmonicLoad::PulleyTorque { pulley: excited, torque: Complex::new(torque, 0.0) };
        let Ok(motion) = forced_response(&drive, &model, frequency, load) else { return Ok(()); };
        for (j, pulley) in drive.pulleys.iter().enumerate().filter(|(j, _)| *j != drive.driver) {
            let (before, after) = (model.dynamic_tension(&motion, drive.span_before(j)), model.dynamic_tension(&motion, j));
            let moved = -frequency * frequency * pulley.inertia * motion.amplitudes[j];
            let applied = Complex::new(if j == excited { torque } else { 0.0 }, 0.0);
            let residual = moved + pulley.radius * (before - after) - applied;
            let size = moved.norm() + pulley.radius * (before.norm() + after.norm());
            prop_assert!(residual.norm() <= 1e-8 * size.max(1e-9), "pulley {j}: {residual} of {size}");
        }
        for arm in case.free_arms() {
            let tensioner = &drive.tensioners[arm];
            let position = motion.amplitudes[model.coordinates.arm(arm)];
            let mut inertia = tensioner.inertia;
            let mut stiffness = tensioner.spring_rate;
            let mut pushed = Complex::ZERO;
            let mut size = 0.0;
            for j in drive.carried_by(arm) {
                let rate = steady.kinematics.centre_rates[j][arm];
                inertia += drive.pulleys[j].mass * rate.length_squared();
                stiffness -= steady.belt_forces[j].dot(steady.kinematics.centre_curvatures[j][arm]);
                let [x, y] = model.dynamic_hub_load(&drive, &steady, &motion, j);
                pushed += x * rate.x + y * rate.y;
                size += (x.norm() + y.norm()) * rate.length();
            }
            let own = (stiffness - frequency * frequency * inertia) * position;
            prop_assert!((own - pushed).norm() <= 1e-8 * (size + own.norm()).max(1e-9), "arm {arm}: {own} and {pushed}");
        }
    }

    /// Without belt speed the response at one pulley to a torque at another is that at the other to a torque at the first.
    #[test]
    fn responses_are_reciprocal_at_rest(case in running(), frequency in 20.0..900.0_f64) {
        prop_assume!(case.drive.pulleys.len() >= 3);
        let drive = damped(&case);
        let installed = case.installed();
        let steady = SteadyState::solve(&drive, &installed, 0.0);
        prop_assume!(steady.is_ok());
        let steady = steady.unwrap();
        let model = LinearModel::new(&drive, &steady);
        let others: Vec<usize> = (0..drive.pulleys.len()).filter(|j| *j != drive.driver).collect();
        let (a, b) = (others[0], others[1]);
        let response = |at: usize, by: usize| {
            let load = HarmonicLoad::PulleyTorque { pulley: by, torque: Complex::new(1.0, 0.0) };
            forced_response(&drive, &model, frequency, load).unwrap().amplitudes[at]
        };
        let (there, back) = (response(a, b), response(b, a));
        prop_assert!((there - back).norm() <= 1e-8 * there.norm().max(1e-9));
    }

    /// Modal damping gives every mode without gyroscopic terms its ratio.
    #[test]
    fn modal_damping_gives_its_ratios(case in running(), ratio in 0.005..0.1_f64) {
        let mut drive = case.drive.clone();
        drive.belt.damping.modal = Some(ModalDamping::Each(vec![2.0 * ratio, ratio]));
        let steady = SteadyState::solve(&drive, &case.installed(), 0.0);
        prop_assume!(steady.is_ok());
        let model = LinearModel::new(&drive, &steady.unwrap());
        prop_assume!(stable(&drive, &model));
        let modes = slackside_belt_drive::modes::damped_modes(&drive, &model, false).unwrap();
        close(modes[0].damping_ratio, 2.0 * ratio, 1e-6, 0.0, "lowest mode");
        for mode in &modes[1..] {
            close(mode.damping_ratio, ratio, 1e-6, 0.0, "further modes");
        }
    }
}
