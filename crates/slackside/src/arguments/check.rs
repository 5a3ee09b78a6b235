//! Options of `check`.

use super::{Common, not_for_drives, only_for_drives};
use crate::failure::Failure;
use clap::Args;
use slackside_studies::check::Check;
use slackside_studies::drive::Places;
use slackside_studies::drive::steady::SteadySheet;
use slackside_studies::{Range, Subject};

#[derive(Debug, Clone, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub common: Common,
    /// Of a drive: tensions, hub loads and arms over `speed` (rpm of the driver) or any key (SI units)
    #[arg(long, value_name = "KEY=FROM:TO[:STEP]")]
    pub over: Option<Range>,
    /// Of a drive: speed of the driver (rpm) in place of the file's
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    pub speed: Option<f64>,
    /// Of a drive: computes the steady state a second time, by the geometrically exact belt
    #[arg(long)]
    pub cross_check: bool,
    /// Frequency of the load, for matrices that depend on it (Hz where the file has units)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub frequency: Option<f64>,
}

impl CheckArguments {
    pub fn study(self, subject: Subject) -> Result<Check, Failure> {
        only_for_drives("--over", self.over.is_some())?;
        only_for_drives("--cross-check", self.cross_check)?;
        only_for_drives("--speed", self.speed.is_some())?;
        Ok(Check {
            subject,
            frequency: self.frequency,
        })
    }

    /// The question about a drive.
    pub fn drive_study(self, subject: Subject) -> Result<SteadySheet, Failure> {
        not_for_drives("--frequency", self.frequency.is_some())?;
        Ok(SteadySheet {
            places: Places::new(subject, self.speed, self.over)?,
            cross_check: self.cross_check,
        })
    }
}
