//! Options of `simulate`.

use super::{Common, initial};
use crate::failure::Failure;
use clap::Args;
use slackside_studies::Subject;
use slackside_studies::simulate::{Initial, Simulate};

#[derive(Debug, Clone, Args)]
pub struct SimulateArguments {
    #[command(flatten)]
    pub common: Common,
    /// Frequency of the load (Hz where the file has units)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub frequency: Option<f64>,
    /// Periods of the load
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub periods: usize,
    /// Samples per period
    #[arg(long, value_name = "N", default_value_t = 128)]
    pub samples: usize,
    /// Initial state: COORD=VALUE,COORD.rate=VALUE,… (the others at rest in the static equilibrium), `rest` or `zero`
    #[arg(long, value_name = "STATE", default_value = "rest", value_parser = initial)]
    pub initial: Initial,
}

impl SimulateArguments {
    pub fn study(self, subject: Subject) -> Result<Simulate, Failure> {
        Ok(Simulate {
            subject,
            frequency: self.frequency,
            periods: self.periods,
            samples: self.samples,
            initial: self.initial,
        })
    }
}
