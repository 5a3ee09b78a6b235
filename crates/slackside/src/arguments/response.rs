//! Options of `response`.

use super::{Common, not_for_drives, only_for_drives};
use crate::failure::Failure;
use clap::{Args, ValueEnum};
use slackside_model_file::Document;
use slackside_studies::compare::Compare;
use slackside_studies::drive::Places;
use slackside_studies::drive::response::DriveResponse;
use slackside_studies::response::periodic::{Family, Objective, PeriodicResponse, is_set_valued};
use slackside_studies::response::{Order, Response, ResponseMethod};
use slackside_studies::{LabelValue, Range, StudyError, Subject};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// The periodic motion at each value, from the one before, with the certificate of uniqueness; further motions where it
    /// fails: for one-way clutches, dry friction, stops, and drives
    Periodic,
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
    /// How motions are found: `periodic` for laws that stick, hit or remember and for drives with one-way couplings, friction or
    /// stops, otherwise `shooting`
    #[arg(long, value_enum)]
    pub method: Option<MethodName>,
    /// Of a drive: the linear response to each order, with all couplings engaged and without friction and stops (what a drive
    /// without them gives anyway)
    #[arg(long, conflicts_with_all = ["method", "optimum", "at", "family"])]
    pub linear: bool,
    /// Finds the best value of the varied key: `dissipation` (in a period, of all elements), `dissipation.ELEMENT`,
    /// `MEASURE.rms` or `MEASURE.max` (smallest), `MEASURE.min` (largest)
    #[arg(long, value_name = "OF", num_args = 0..=1, default_missing_value = "dissipation")]
    pub optimum: Option<Objective>,
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
    /// Branches for each of several values of another key: numbers (SI units), quantities with units, or words, for example
    /// pulley.alternator.coupling.kind=rigid,one-way
    #[arg(long = "for", value_name = "KEY=V1,V2,…", value_parser = family)]
    pub family: Option<FamilyOption>,
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
pub struct FamilyOption {
    pub key: String,
    pub values: Vec<LabelValue>,
}

impl FamilyOption {
    /// The values as numbers, which is what following branches needs.
    fn numbers(self) -> Result<(String, Vec<f64>), Failure> {
        let numbers = self.values.into_iter().map(|value| match value {
            LabelValue::Number(value) => Ok(value),
            LabelValue::Text(text) => Err(StudyError::question(
                "--for",
                format!("\"{text}\" is not a number; words need --method periodic"),
            )),
        });
        Ok((self.key, numbers.collect::<Result<_, StudyError>>()?))
    }

    /// The models of all values.
    fn models(self, document: &Document, subject: &Subject) -> Result<Family, Failure> {
        let members = self.values.into_iter().map(|value| {
            let changed = match &value {
                LabelValue::Number(number) => subject.with_number(&self.key, *number)?,
                LabelValue::Text(text) => {
                    let mut document = document.clone();
                    document.set(&self.key, text)?;
                    Subject {
                        driver_speed: subject.driver_speed,
                        ..Subject::new(&document)?
                    }
                }
            };
            Ok((value, changed))
        });
        Ok(Family {
            members: members.collect::<Result<_, Failure>>()?,
            key: self.key,
        })
    }
}

fn family(text: &str) -> Result<FamilyOption, String> {
    let (key, values) = text
        .split_once('=')
        .ok_or("write KEY=V1,V2,…, for example dimensionless.clutch_stiffness=10,24")?;
    let mut read = Vec::new();
    for value in values.split(',').map(str::trim) {
        if value.is_empty() {
            return Err("a value is missing between two commas".to_owned());
        }
        let value = match value.parse::<f64>() {
            Ok(number) => LabelValue::Number(number),
            Err(_) => LabelValue::Text(value.to_owned()),
        };
        if read.contains(&value) {
            return Err(format!("{value} stands there twice"));
        }
        read.push(value);
    }
    Ok(FamilyOption {
        key: key.trim().to_owned(),
        values: read,
    })
}

/// What is asked of `response`.
pub enum Question {
    /// Branches that are followed.
    Branches(Response),
    /// The periodic motion at each value.
    Periodic(PeriodicResponse),
    /// The linear response of a drive by orders.
    Orders(DriveResponse),
    /// Approximations beside exact motions.
    Comparison(Compare),
}

impl ResponseArguments {
    /// The comparison of methods that `--compare` asks for.
    fn comparison(self, subject: Subject) -> Result<Compare, Failure> {
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

    /// The question with the method that suits the model.
    pub fn question(self, document: &Document, subject: Subject) -> Result<Question, Failure> {
        let is_drive = subject.model.drive().is_some();
        if self.compare {
            not_for_drives("--compare", is_drive)?;
            return Ok(Question::Comparison(self.comparison(subject)?));
        }
        let subject = match self.speed {
            Some(speed) => subject.at_speed(speed)?,
            None => subject,
        };
        if self.linear && !is_drive {
            only_for_drives("--linear", true)?;
        }
        let family = match &self.family {
            Some(family) if family.key == self.over.key => {
                let reason = "the key is already varied by --over; choose another";
                return Err(StudyError::question("--for", reason).into());
            }
            Some(family) if self.method.is_none_or(|method| method == MethodName::Periodic) => {
                Some(family.clone().models(document, &subject)?)
            }
            _ => None,
        };
        if is_drive && self.method.is_none() && (self.linear || self.is_linear_drive(&subject)?) {
            not_for_drives("--frequency", self.frequency.is_some())?;
            not_for_drives("--periods", self.periods != 1)?;
            not_for_drives("--doublings", self.doublings != 0)?;
            not_for_drives("--check", self.check != 0)?;
            let places = Places::new(subject, self.speed, Some(self.over))?;
            return Ok(Question::Orders(DriveResponse::new(places)?));
        }
        let is_periodic = match self.method {
            Some(method) => method == MethodName::Periodic,
            None => is_drive || self.optimum.is_some() || is_any_set_valued(&subject, family.as_ref())?,
        };
        if !is_periodic {
            if self.optimum.is_some() {
                return Err(StudyError::question("--optimum", "it needs --method periodic").into());
            }
            return Ok(Question::Branches(self.study(subject)?));
        }
        for (option, is_given) in [("--doublings", self.doublings != 0), ("--check", self.check != 0)] {
            if is_given {
                let message =
                    "the method `periodic` has no branches to follow; take --method shooting or leave it out";
                return Err(StudyError::question(option, message).into());
            }
        }
        Ok(Question::Periodic(PeriodicResponse {
            subject,
            over: self.over,
            frequency: self.frequency,
            periods: self.periods,
            at: self.at,
            family,
            harmonics: self.harmonics.unwrap_or(16),
            optimum: self.optimum,
        }))
    }

    /// Whether nothing is asked of a drive that its linear response by orders does not answer.
    fn is_linear_drive(&self, subject: &Subject) -> Result<bool, Failure> {
        let asks_more = self.family.is_some() || !self.at.is_empty() || self.optimum.is_some();
        Ok(!asks_more && subject.system()?.elements.is_empty())
    }

    fn study(self, subject: Subject) -> Result<Response, Failure> {
        let family = self.family.map(FamilyOption::numbers).transpose()?;
        Ok(Response {
            subject,
            over: self.over,
            frequency: self.frequency,
            method: match self.method {
                Some(MethodName::HarmonicBalance) => ResponseMethod::HarmonicBalance {
                    harmonics: self.harmonics,
                },
                Some(MethodName::MultipleScales) => ResponseMethod::MultipleScales {
                    order: if self.order == 1 {
                        Order::First
                    } else {
                        Order::Second
                    },
                    mode: self.mode,
                },
                Some(MethodName::Shooting | MethodName::Periodic) | None => ResponseMethod::Shooting,
            },
            periods: self.periods,
            doublings: usize::from(self.doublings),
            at: self.at,
            family,
            harmonics: self.harmonics.unwrap_or(16),
            max_points: self.max_points,
            check: self.check,
        })
    }
}

/// Whether the model, or one of the family's, has laws that are better not followed.
fn is_any_set_valued(subject: &Subject, family: Option<&Family>) -> Result<bool, Failure> {
    let members = family.iter().flat_map(|family| &family.members);
    for subject in std::iter::once(subject).chain(members.map(|(_, subject)| subject)) {
        if is_set_valued(subject.system()?.as_ref()) {
            return Ok(true);
        }
    }
    Ok(false)
}
