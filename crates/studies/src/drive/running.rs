//! A drive at one operating point as a mechanical system, together with the steady state about which it moves.

use super::InstalledDrive;
use crate::{StudyError, Subject};
use slackside_belt_drive::drive::{Drive, Excitation};
use slackside_belt_drive::steady::SteadyState;
use slackside_belt_drive::system::{CommonOrder, DriveSystem};
use std::f64::consts::TAU;

/// A running drive.
pub struct RunningDrive {
    /// The drive.
    pub drive: Drive,
    /// Its steady state.
    pub steady: SteadyState,
    /// Its equations of motion, with measures that count from the steady state.
    pub system: DriveSystem,
}

impl RunningDrive {
    /// The drive at the subject's speed; with the lowest order of the excitation at `frequency` (Hz) if one is given.
    ///
    /// # Errors
    /// [`StudyError`] if there is no steady state or no equation of motion.
    pub fn new(subject: &Subject, frequency: Option<f64>) -> Result<Self, StudyError> {
        let installed = InstalledDrive::new(subject)?;
        let speed = subject.driver_speed.unwrap_or(installed.driver_speed);
        let steady = installed.steady(speed)?;
        let InstalledDrive {
            drive, excitation, ..
        } = installed;
        let system = match frequency {
            None => DriveSystem::new(&drive, &steady, &excitation)?,
            Some(hertz) => {
                let fundamental = hertz * radians_per_hertz(&excitation)?;
                DriveSystem::at_frequency(&drive, &steady, &excitation, fundamental)?
            }
        };
        Ok(Self {
            drive,
            steady,
            system,
        })
    }
}

/// Fundamental angular frequency of an excitation per hertz of its lowest order.
///
/// # Errors
/// [`StudyError::Question`] if its orders have no common period.
pub(crate) fn radians_per_hertz(excitation: &Excitation) -> Result<f64, StudyError> {
    let common = CommonOrder::of(excitation)?;
    let lowest = common.multiples.iter().copied().min().unwrap_or(1);
    Ok(TAU / lowest as f64)
}
