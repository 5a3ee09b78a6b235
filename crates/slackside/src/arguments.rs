//! The command line.

use crate::failure::Failure;
use clap::{Args, Parser, Subcommand, ValueEnum};
use slackside_studies::basin::Basin;
use slackside_studies::check::Check;
use slackside_studies::compare::Compare;
use slackside_studies::drive::Places;
use slackside_studies::drive::modes::DriveModes;
use slackside_studies::drive::response::DriveResponse;
use slackside_studies::drive::steady::SteadySheet;
use slackside_studies::modes::Modes;
use slackside_studies::response::{Order, Response, ResponseMethod};
use slackside_studies::simulate::{Initial, Simulate};
use slackside_studies::sweep::{Direction, Sweep};
use slackside_studies::{Range, StudyError, Subject};
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
    /// Which attractor each initial state of a grid reaches
    Basin(BasinArguments),
    /// The JSON Schema of the model file
    Schema,
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Shooting on the exact flow
    Shooting,
    /// Multi-term harmonic balance
    HarmonicBalance,
    /// Multiple scales: closed forms near a primary resonance of a clutch with preload
    MultipleScales,
}

#[derive(Debug, Clone, Args)]
pub struct ResponseArguments {
    #[command(flatten)]
    pub common: Common,
    /// What varies along the branches: `frequency` (Hz where the file has units) or any key (SI units); of a drive also
    /// `speed` (rpm of the driver)
    #[arg(long, value_name = "KEY=FROM:TO[:STEP]")]
    pub over: Range,
    /// Frequency of the load when another key is varied (Hz where the file has units)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub frequency: Option<f64>,
    /// Of a drive: speed of the driver (rpm) in place of the file's
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    pub speed: Option<f64>,
    /// How motions are found: by shooting if nothing is said; of a drive always linearly
    #[arg(long, value_enum)]
    pub method: Option<MethodName>,
    /// Order of multiple scales
    #[arg(long, value_name = "1|2", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=2))]
    pub order: u8,
    /// Mode whose primary resonance multiple scales treats, from 1; by default all in the range
    #[arg(long, value_name = "N")]
    pub mode: Option<usize>,
    /// Harmonics: of the method for harmonic balance (adaptive by default), and reported of each measure (16 by default)
    #[arg(long, value_name = "N")]
    pub harmonics: Option<usize>,
    /// Periods of the load after which motions repeat
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub periods: usize,
    /// Follows branches of twice the period from period doublings, N generations of them
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=6))]
    pub doublings: u8,
    /// Reports every motion at exact values of the varied key
    #[arg(
        long,
        value_name = "V1,V2,…",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub at: Vec<f64>,
    /// Branches for each of several values of another key (SI units)
    #[arg(long = "for", value_name = "KEY=V1,V2,…", value_parser = family)]
    pub family: Option<Family>,
    /// Measure and statistic of the main figure, for example windup.rms
    #[arg(long, value_name = "MEASURE.STATISTIC")]
    pub measure: Option<String>,
    /// Checks the branches by time integration at N values, up and down
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub check: usize,
    /// Largest number of points of one branch and direction
    #[arg(long, value_name = "N", default_value_t = 20_000)]
    pub max_points: usize,
    /// One resonance by multiple scales (both orders), harmonic balance and shooting, with the errors of each; --at gives
    /// histories
    #[arg(long, conflicts_with_all = ["method", "periods", "doublings", "measure", "order"])]
    pub compare: bool,
    /// Error that counts as small, for example 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "1%", value_parser = share, requires = "compare")]
    pub tolerance: f64,
    /// Maps over two keys (SI units) where the approximations are within the tolerance; give it twice
    #[arg(long, value_name = "KEY=FROM:TO[:STEP]", requires = "compare")]
    pub map: Vec<Range>,
}

fn share(text: &str) -> Result<f64, String> {
    let (number, factor) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let number: Result<f64, _> = number.trim().parse();
    number
        .map(|number| number * factor)
        .map_err(|_| "write a share such as 0.01 or 1%".to_owned())
}

/// A key and its values.
#[derive(Debug, Clone)]
pub struct Family {
    pub key: String,
    pub values: Vec<f64>,
}

fn family(text: &str) -> Result<Family, String> {
    let (key, values) = text
        .split_once('=')
        .ok_or("write KEY=V1,V2,…, for example dimensionless.clutch_stiffness=10,24")?;
    let values: Result<Vec<f64>, String> = values
        .split(',')
        .map(|value| {
            let number: f64 = value
                .trim()
                .parse()
                .map_err(|_| format!("`{}` is not a number", value.trim()))?;
            Ok(number)
        })
        .collect();
    Ok(Family {
        key: key.trim().to_owned(),
        values: values?,
    })
}

impl ResponseArguments {
    /// The comparison of methods that `--compare` asks for.
    pub fn comparison(self, subject: Subject) -> Result<Compare, Failure> {
        let map = match <[Range; 2]>::try_from(self.map.clone()) {
            Ok(map) => Some(map),
            Err(given) if given.is_empty() => None,
            Err(_) => return Err(StudyError::question("--map", "give it twice, once for each key").into()),
        };
        let (mode, harmonics, tolerance) = (self.mode, self.harmonics, self.tolerance);
        let mut response = self.study(subject)?;
        // `--harmonics` is that of harmonic balance here.
        response.harmonics = 0;
        Ok(Compare {
            response,
            mode,
            harmonics,
            tolerance,
            map,
        })
    }

    /// The question about a drive.
    pub fn drive_study(self, subject: Subject) -> Result<DriveResponse, Failure> {
        not_for_drives("--compare", self.compare)?;
        not_for_drives("--frequency", self.frequency.is_some())?;
        not_for_drives("--method", self.method.is_some())?;
        not_for_drives("--periods", self.periods != 1)?;
        not_for_drives("--doublings", self.doublings != 0)?;
        not_for_drives("--at", !self.at.is_empty())?;
        not_for_drives("--for", self.family.is_some())?;
        not_for_drives("--check", self.check != 0)?;
        Ok(DriveResponse::new(Places::new(
            subject,
            self.speed,
            Some(self.over),
        )?)?)
    }

    pub fn study(self, subject: Subject) -> Result<Response, Failure> {
        only_for_drives("--speed", self.speed.is_some())?;
        Ok(Response {
            subject,
            over: self.over,
            frequency: self.frequency,
            method: match self.method.unwrap_or(MethodName::Shooting) {
                MethodName::Shooting => ResponseMethod::Shooting,
                MethodName::HarmonicBalance => ResponseMethod::HarmonicBalance {
                    harmonics: self.harmonics,
                },
                MethodName::MultipleScales => ResponseMethod::MultipleScales {
                    order: if self.order == 1 {
                        Order::First
                    } else {
                        Order::Second
                    },
                    mode: self.mode,
                },
            },
            periods: self.periods,
            doublings: usize::from(self.doublings),
            at: self.at,
            family: self.family.map(|family| (family.key, family.values)),
            harmonics: self.harmonics.unwrap_or(16),
            max_points: self.max_points,
            check: self.check,
        })
    }
}
