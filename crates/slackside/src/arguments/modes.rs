//! Options of `modes`.

use super::{Common, not_for_drives, only_for_drives};
use crate::failure::Failure;
use clap::Args;
use slackside_studies::drive::Places;
use slackside_studies::drive::modes::DriveModes;
use slackside_studies::modes::Modes;
use slackside_studies::{Range, Subject};

#[derive(Debug, Clone, Args)]
pub struct ModesArguments {
    #[command(flatten)]
    pub common: Common,
    /// Natural frequencies over a key of the file (SI units), for example dimensionless.clutch_stiffness=1:50; of a drive
    /// also over `speed` (rpm of the driver): the Campbell diagram
    #[arg(long, value_name = "KEY=FROM:TO[:STEP]")]
    pub over: Option<Range>,
    /// Of a drive: speed of the driver (rpm) in place of the file's
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    pub speed: Option<f64>,
    /// Of a drive: number of the lowest modes
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u16).range(1..=400))]
    pub count: u16,
    /// Of a drive: the driver turns freely with its inertia instead of at a prescribed speed
    #[arg(long)]
    pub driver_free: bool,
    /// Of a drive: highest speed (rpm) up to which the end of stability is sought
    #[arg(long, value_name = "RPM")]
    pub limit_speed: Option<f64>,
    /// Of a drive: computes the frequencies a second time, from the strong form of the equations
    #[arg(long)]
    pub cross_check: bool,
    /// Of a drive: adds the matrices of the linear model to the JSON document
    #[arg(long)]
    pub matrices: bool,
    /// Frequency of the load, for matrices that depend on it (Hz where the file has units)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub frequency: Option<f64>,
}

impl ModesArguments {
    pub fn study(self, subject: Subject) -> Result<Modes, Failure> {
        only_for_drives("--speed", self.speed.is_some())?;
        only_for_drives("--driver-free", self.driver_free)?;
        only_for_drives("--matrices", self.matrices)?;
        only_for_drives("--cross-check", self.cross_check)?;
        only_for_drives("--limit-speed", self.limit_speed.is_some())?;
        Ok(Modes {
            subject,
            over: self.over,
            frequency: self.frequency,
        })
    }

    /// The question about a drive.
    pub fn drive_study(self, subject: Subject) -> Result<DriveModes, Failure> {
        not_for_drives("--frequency", self.frequency.is_some())?;
        Ok(DriveModes {
            places: Places::new(subject, self.speed, self.over)?,
            count: usize::from(self.count),
            driver_is_free: self.driver_free,
            limit: self.limit_speed,
            cross_check: self.cross_check,
            matrices: self.matrices,
        })
    }
}
