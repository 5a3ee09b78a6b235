//! Questions about a serpentine drive: the steady sheet, natural modes, the linear response to engine orders.

mod at;
pub mod matrices;
pub mod modes;
pub mod response;
pub(crate) mod running;
pub mod steady;
pub(crate) mod trust;

pub use at::{Place, Places};

use slackside_belt_drive::drive::{Drive, Excitation};
use slackside_belt_drive::modes::ModesError;
use slackside_belt_drive::steady::{Installed, SteadyError, SteadyState};
use std::f64::consts::PI;

use crate::{StudyError, Subject};

/// Radians per second in one revolution per minute.
pub(crate) const RPM: f64 = PI / 30.0;

/// A drive with its installation, and what shakes it.
#[derive(Debug, Clone)]
pub struct InstalledDrive {
    /// The drive.
    pub drive: Drive,
    /// What its installation fixes.
    pub installed: Installed,
    /// What shakes the driver.
    pub excitation: Excitation,
    /// Speed of the driver at the operating point, rad/s.
    pub driver_speed: f64,
}

impl InstalledDrive {
    /// The drive of a model file.
    ///
    /// # Errors
    /// [`StudyError::Model`] for a layout that no belt can follow, [`StudyError::NoAnswer`] if its installation is
    /// impossible, [`StudyError::Question`] if the model is no drive.
    pub fn new(subject: &Subject) -> Result<Self, StudyError> {
        let Some(file) = subject.model.drive() else {
            return Err(StudyError::question(
                "FILE",
                format!(
                    "this needs a model of kind \"drive\", not \"{}\"",
                    subject.model.kind()
                ),
            ));
        };
        let drive = file.belt_drive()?;
        Ok(Self {
            installed: Installed::new(&drive)?,
            drive,
            excitation: file.excitation(),
            driver_speed: file.operating_speed(),
        })
    }

    /// The steady state at a driver speed, rad/s.
    ///
    /// # Errors
    /// [`StudyError::NoAnswer`].
    pub fn steady(&self, driver_speed: f64) -> Result<SteadyState, StudyError> {
        Ok(SteadyState::solve(&self.drive, &self.installed, driver_speed)?)
    }
}

impl From<SteadyError> for StudyError {
    fn from(error: SteadyError) -> Self {
        Self::NoAnswer(error.to_string())
    }
}

impl From<ModesError> for StudyError {
    fn from(error: ModesError) -> Self {
        Self::NoAnswer(error.to_string())
    }
}
