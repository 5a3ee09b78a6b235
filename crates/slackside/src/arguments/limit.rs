//! Options of `limit`.

use super::Common;
use crate::failure::Failure;
use clap::{Args, ValueEnum};
use slackside_studies::limit::{Limit, LimitKind};
use slackside_studies::{Range, Subject};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LimitName {
    /// Mean torque above which a one-way clutch never opens
    CriticalLoad,
    /// Friction torque above which an arm (or any port with dry friction) never slips
    CriticalTorque,
}

#[derive(Debug, Clone, Args)]
pub struct LimitArguments {
    /// What is sought
    #[arg(value_enum)]
    pub limit: LimitName,
    #[command(flatten)]
    pub common: Common,
    /// What is varied: `frequency` (Hz where the file has units), of a drive `speed` (rpm of the driver), or any key (SI
    /// units); 401 values without a step
    #[arg(long, value_name = "KEY=FROM:TO[:STEP]")]
    pub over: Range,
    /// Frequency of the load when another key is varied (Hz where the file has units)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub frequency: Option<f64>,
    /// Of a drive: speed of the driver (rpm) in place of the file's
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    pub speed: Option<f64>,
    /// Name of the clutch or friction element, where the model has several
    #[arg(long, value_name = "NAME")]
    pub element: Option<String>,
}

impl LimitArguments {
    pub fn study(self, subject: Subject) -> Result<Limit, Failure> {
        let subject = match self.speed {
            Some(speed) => subject.at_speed(speed)?,
            None => subject,
        };
        Ok(Limit {
            subject,
            kind: match self.limit {
                LimitName::CriticalLoad => LimitKind::CriticalLoad,
                LimitName::CriticalTorque => LimitKind::CriticalTorque,
            },
            over: self.over,
            frequency: self.frequency,
            element: self.element,
        })
    }
}
