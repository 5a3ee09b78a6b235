//! Linear response of a drive to harmonic excitation (theory 04 §3.7).

use crate::drive::Drive;
use crate::model::{LinearModel, Motion};
use slackside_linalg::{Complex, LinalgError};

/// What excites the drive at one frequency; complex amplitudes of `e^{iωt}`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HarmonicLoad {
    /// Prescribed rotation of the driver, rad.
    DriverRotation(Complex),
    /// Torque on a driver that turns freely with its inertia, N·m.
    DriverTorque(Complex),
    /// Torque along a pulley's rotation with the driver's motion prescribed to be steady, N·m.
    PulleyTorque {
        /// The pulley.
        pulley: usize,
        /// The torque.
        torque: Complex,
    },
}

/// The steady vibration at angular frequency `ω` (rad/s) under one harmonic load.
///
/// # Errors
/// [`LinalgError::Singular`] at an undamped resonance.
pub fn forced_response(
    drive: &Drive,
    model: &LinearModel,
    frequency: f64,
    load: HarmonicLoad,
) -> Result<Motion, LinalgError> {
    let driver_is_free = matches!(load, HarmonicLoad::DriverTorque(_));
    let free = model.free_coordinates(drive, driver_is_free);
    let mut force = vec![Complex::ZERO; model.coordinates.len()];
    let mut amplitudes = vec![Complex::ZERO; model.coordinates.len()];
    match load {
        HarmonicLoad::DriverRotation(rotation) => {
            amplitudes[model.driver] = rotation;
            for (row, value) in force.iter_mut().enumerate() {
                let at = (row, model.driver);
                let coupling = Complex::new(
                    model.stiffness[at] + model.circulatory[at] - frequency * frequency * model.mass[at],
                    frequency * (model.damping[at] + model.gyroscopic[at]),
                );
                *value = -coupling * rotation;
            }
        }
        HarmonicLoad::DriverTorque(torque) => force[model.driver] = torque,
        HarmonicLoad::PulleyTorque { pulley, torque } => {
            force[model.coordinates.pulley(pulley)] = torque;
        }
    }
    let dynamic = model.dynamic_stiffness(drive, &free, frequency)?;
    let right: Vec<Complex> = free.iter().map(|index| force[*index]).collect();
    let solution = dynamic.lu()?.solve(&right);
    for (index, value) in free.iter().zip(solution) {
        amplitudes[*index] = value;
    }
    Ok(Motion {
        frequency,
        amplitudes,
    })
}
