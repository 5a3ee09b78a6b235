//! Options of `basin`.

use super::{Common, initial};
use crate::failure::Failure;
use clap::Args;
use slackside_studies::basin::Basin;
use slackside_studies::simulate::Initial;
use slackside_studies::{Range, StudyError, Subject};

#[derive(Debug, Clone, Args)]
pub struct BasinArguments {
    #[command(flatten)]
    pub common: Common,
    /// Two entries of the initial state and their values, for example --over pulley=-0.2:0.2 --over pulley.rate=-1:1
    #[arg(long, value_name = "COORD=FROM:TO[:STEP]", required = true)]
    pub over: Vec<Range>,
    /// Frequency of the load (Hz where the file has units)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub frequency: Option<f64>,
    /// The other entries of the initial state: COORD=VALUE,COORD.rate=VALUE,…, `rest` or `zero`
    #[arg(long, value_name = "STATE", default_value = "rest", value_parser = initial)]
    pub initial: Initial,
    /// Periods after which a motion that has not settled is given up
    #[arg(long, value_name = "N")]
    pub periods: Option<usize>,
}

impl BasinArguments {
    pub fn study(self, subject: Subject) -> Result<Basin, Failure> {
        let Ok([across, down]) = <[Range; 2]>::try_from(self.over) else {
            return Err(
                StudyError::question("--over", "give it twice, once for each direction of the grid").into(),
            );
        };
        let mut basin = Basin {
            subject,
            frequency: self.frequency,
            across,
            down,
            initial: self.initial,
            options: Default::default(),
        };
        if let Some(periods) = self.periods {
            basin.options.periods = periods;
        }
        Ok(basin)
    }
}
