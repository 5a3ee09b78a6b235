//! Drives over the driver's speed, and over the frequency of their excitation. Measures are totals, steady value and motion
//! together.

use super::DriveSystem;
use crate::drive::{Drive, Excitation};
use crate::steady::{Installed, SteadyState};
use slackside_mechanics::{OperatingPoint, OutsideDomain, SystemFamily};

/// A drive over the speed of its driver (rad/s): steady state, belt speed, loads and excitation all follow.
#[derive(Debug, Clone)]
pub struct DriveSpeedFamily {
    /// The drive.
    pub drive: Drive,
    /// What its installation fixes.
    pub installed: Installed,
    /// What shakes the driver.
    pub excitation: Excitation,
}

impl SystemFamily for DriveSpeedFamily {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        if !(parameter.is_finite() && parameter > 0.0) {
            return Err(OutsideDomain(format!(
                "the driver's speed must be positive, but is {parameter} rad/s"
            )));
        }
        let steady = SteadyState::solve(&self.drive, &self.installed, parameter).map_err(outside)?;
        DriveSystem::new(&self.drive, &steady, &self.excitation)
            .map(DriveSystem::into_operating_point)
            .map_err(outside)
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

/// A drive at one speed over the fundamental frequency (rad/s) of its excitation, whose amplitudes stay those of the speed.
#[derive(Debug, Clone)]
pub struct ExcitationFrequencyFamily {
    /// The drive.
    pub drive: Drive,
    /// Its steady state.
    pub steady: SteadyState,
    /// What shakes the driver.
    pub excitation: Excitation,
}

impl SystemFamily for ExcitationFrequencyFamily {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        DriveSystem::at_frequency(&self.drive, &self.steady, &self.excitation, parameter)
            .map(DriveSystem::into_operating_point)
            .map_err(outside)
    }

    /// The load of a prescribed motion grows with its frequency, so that the system changes too.
    fn is_frequency(&self) -> bool {
        false
    }
}

fn outside(error: impl std::error::Error) -> OutsideDomain {
    OutsideDomain(error.to_string())
}
