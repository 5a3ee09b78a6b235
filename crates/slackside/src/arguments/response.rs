//! Options of `response`.

use super::{Common, not_for_drives, only_for_drives};
use crate::failure::Failure;
use clap::{Args, ValueEnum};
use slackside_studies::compare::Compare;
use slackside_studies::drive::Places;
use slackside_studies::drive::response::DriveResponse;
use slackside_studies::response::{Order, Response, ResponseMethod};
use slackside_studies::{Range, StudyError, Subject};

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
