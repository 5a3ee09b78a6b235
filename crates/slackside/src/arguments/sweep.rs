//! Options of `sweep`.

use super::{Common, initial};
use crate::failure::Failure;
use clap::{Args, ValueEnum};
use slackside_studies::simulate::Initial;
use slackside_studies::sweep::{Direction, Sweep};
use slackside_studies::{Range, Subject};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DirectionName {
    /// Towards larger values
    Up,
    /// Towards smaller values
    Down,
    /// Both
    Both,
}

#[derive(Debug, Clone, Args)]
pub struct SweepArguments {
    #[command(flatten)]
    pub common: Common,
    /// What is stepped: `frequency` (Hz where the file has units) or any key (SI units); 101 values without a step
    #[arg(long, value_name = "KEY=FROM:TO[:STEP]")]
    pub over: Range,
    /// Frequency of the load when another key is stepped (Hz where the file has units)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub frequency: Option<f64>,
    /// Direction in which values follow
    #[arg(long, value_enum, default_value = "both")]
    pub direction: DirectionName,
    /// State from which each direction starts: COORD=VALUE,COORD.rate=VALUE,…, `rest` or `zero`
    #[arg(long, value_name = "STATE", default_value = "rest", value_parser = initial)]
    pub initial: Initial,
    /// Periods discarded at each value
    #[arg(long, value_name = "N", default_value_t = 600)]
    pub transient: usize,
    /// Periods recorded at each value
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub periods: u32,
    /// Harmonics reported of each measure
    #[arg(long, value_name = "N", default_value_t = 16)]
    pub harmonics: usize,
    /// Stroboscopic points of motions that do not repeat
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub points: usize,
    /// Measure and statistic of the main figure, for example windup.rms
    #[arg(long, value_name = "MEASURE.STATISTIC")]
    pub measure: Option<String>,
}

impl SweepArguments {
    pub fn study(self, subject: Subject) -> Result<Sweep, Failure> {
        let mut sweep = Sweep::new(subject, self.over);
        sweep.frequency = self.frequency;
        sweep.directions = match self.direction {
            DirectionName::Up => vec![Direction::Up],
            DirectionName::Down => vec![Direction::Down],
            DirectionName::Both => vec![Direction::Up, Direction::Down],
        };
        sweep.initial = self.initial;
        sweep.options.transient_periods = self.transient;
        sweep.options.record_periods = self.periods as usize;
        sweep.options.harmonics = self.harmonics;
        sweep.options.poincare_points = self.points;
        Ok(sweep)
    }
}
