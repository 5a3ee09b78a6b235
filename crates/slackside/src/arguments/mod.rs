//! The command line, options of each verb in a file of their own.

mod basin;
mod check;
mod figure;
mod limit;
mod modes;
mod response;
mod simulate;
mod sweep;

pub use basin::BasinArguments;
pub use check::CheckArguments;
pub use figure::FigureArguments;
pub use limit::LimitArguments;
pub use modes::ModesArguments;
pub use response::{Question, ResponseArguments};
pub use simulate::SimulateArguments;
pub use sweep::SweepArguments;

use crate::failure::Failure;
use clap::{Args, Parser, Subcommand};
use slackside_studies::StudyError;
use slackside_studies::simulate::Initial;
use std::path::PathBuf;
use std::str::FromStr;

/// Nonlinear dynamics of belt-pulley drives with one-way clutches.
#[derive(Debug, Parser)]
#[command(name = "slackside", version, arg_required_else_help = true)]
pub struct Arguments {
    #[command(subcommand)]
    pub verb: Verb,
}

#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Is the file sound; of a clutch rest, natural frequencies and onset of separation, of a drive the steady sheet
    Check(CheckArguments),
    /// Natural frequencies, damping, shapes and what moves; over any key
    Modes(ModesArguments),
    /// One motion from a given initial state: time histories and the exact event list
    Simulate(SimulateArguments),
    /// Branches of periodic motions over frequency or any key, with stability and special points
    Response(ResponseArguments),
    /// Settled motions stepped up and down over frequency or any key: kinds, Poincaré points, spectra
    Sweep(SweepArguments),
    /// Critical load of a one-way clutch or critical torque of dry friction over frequency, speed or any key
    Limit(LimitArguments),
    /// Which attractor each initial state of a grid reaches
    Basin(BasinArguments),
    /// The figures of the dissertation, or of a recipe of one's own: commands, figures, and what they show in numbers
    Figure(FigureArguments),
    /// The JSON Schema of the model file
    Schema,
}

impl Verb {
    /// The options that all verbs share that read a model file.
    pub fn common(&self) -> Option<&Common> {
        match self {
            Self::Check(options) => Some(&options.common),
            Self::Modes(options) => Some(&options.common),
            Self::Simulate(options) => Some(&options.common),
            Self::Response(options) => Some(&options.common),
            Self::Sweep(options) => Some(&options.common),
            Self::Limit(options) => Some(&options.common),
            Self::Basin(options) => Some(&options.common),
            Self::Figure(_) | Self::Schema => None,
        }
    }
}

/// Options of all verbs that read a file.
#[derive(Debug, Clone, Args)]
pub struct Common {
    /// Model file (TOML)
    pub file: PathBuf,
    /// Replaces a value of the file, for example dimensionless.preload=0.5; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<Setting>,
    /// Prints one JSON document instead of a summary
    #[arg(long, conflicts_with = "out")]
    pub json: bool,
    /// Writes tables (CSV, Parquet), figures (SVG, PNG) and JSON into a directory, replaced only as a whole
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of threads; all cores by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Shows neither progress nor warnings
    #[arg(long)]
    pub quiet: bool,
}

/// `KEY=VALUE`.
#[derive(Debug, Clone)]
pub struct Setting {
    pub key: String,
    pub value: String,
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((key, value)) if !key.trim().is_empty() => Ok(Self {
                key: key.trim().to_owned(),
                value: value.trim().to_owned(),
            }),
            _ => Err("write KEY=VALUE, for example dimensionless.preload=0.5".to_owned()),
        }
    }
}

/// An option that only a drive has.
fn only_for_drives(option: &str, is_given: bool) -> Result<(), Failure> {
    if is_given {
        return Err(StudyError::question(option, "only a model of kind \"drive\" has this option").into());
    }
    Ok(())
}

/// An option that a drive does not have.
fn not_for_drives(option: &str, is_given: bool) -> Result<(), Failure> {
    if is_given {
        return Err(StudyError::question(
            option,
            "the linear analysis of a drive does not have this option; leave it out",
        )
        .into());
    }
    Ok(())
}

/// An initial state as users write it.
fn initial(text: &str) -> Result<Initial, String> {
    match text.trim() {
        "rest" => return Ok(Initial::Rest),
        "zero" => return Ok(Initial::Zero),
        _ => {}
    }
    let entries: Result<Vec<(String, f64)>, String> = text
        .split(',')
        .map(|entry| {
            let (name, value) = entry
                .split_once('=')
                .ok_or_else(|| format!("`{}` is not COORD=VALUE", entry.trim()))?;
            let value: f64 = value
                .trim()
                .parse()
                .map_err(|_| format!("`{}` is not a number", value.trim()))?;
            Ok((name.trim().to_owned(), value))
        })
        .collect();
    Ok(Initial::Given(entries?))
}
