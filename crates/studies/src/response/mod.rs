//! `response`: branches of periodic motions over a frequency or any key, with stability and special points.
//!
//! One job per value of the family key (or one in all): it finds starts (linear response at both ends, settled motions in
//! between), follows the branch of each that is not known yet in both directions, and, if asked to, the branches of twice
//! the period that start at period doublings.

mod curve;
mod document;
mod doubling;
mod integration;
pub(crate) mod multiple_scales;
pub mod periodic;
pub(crate) mod start;
pub(crate) mod tracer;
mod values;

pub use document::{
    BranchRow, History, OrbitRow, ParameterRow, PointRow, ResponseDocument, ScalesRow, SpecialRow,
    SweepPointRow,
};

use crate::{
    Label, LabelValue, Method, Progress, Quantity, Range, Signal, Study, StudyError, Subject, check_period,
};
use curve::Curve;
use rayon::prelude::*;
use slackside_continuation::Options;
pub use slackside_dynamics::orbit::multiple_scales::Order;
use tracer::{Setup, Tracing};

/// How periodic motions are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResponseMethod {
    /// Shooting on the flow, exact for piecewise-linear systems.
    Shooting,
    /// Multi-term harmonic balance; with a fixed number of harmonics, or one that follows the motion.
    HarmonicBalance {
        /// Number of harmonics; `None` adapts it.
        harmonics: Option<usize>,
    },
    /// The method of multiple scales, at the primary resonances that the range holds or at that of one mode.
    MultipleScales {
        /// Order of the expansion.
        order: Order,
        /// Number of the mode, from one; `None` for all in the range.
        mode: Option<usize>,
    },
}

/// The question.
#[derive(Debug, Clone)]
pub struct Response {
    /// The model.
    pub subject: Subject,
    /// The parameter along the branches and its range, in the user's unit.
    pub over: Range,
    /// Frequency of the load in the user's unit, when another key is varied.
    pub frequency: Option<f64>,
    /// How motions are found.
    pub method: ResponseMethod,
    /// Periods of the load after which motions repeat.
    pub periods: usize,
    /// How often branches of twice the period are followed from period doublings.
    pub doublings: usize,
    /// Values of the parameter at which all motions are reported.
    pub at: Vec<f64>,
    /// Another key and its values, for each of which branches are followed.
    pub family: Option<(String, Vec<f64>)>,
    /// Harmonics reported of each measure.
    pub harmonics: usize,
    /// Largest number of points of one branch and direction.
    pub max_points: usize,
    /// Number of values at which a time integration checks the branches, up and down; zero for no check.
    pub check: usize,
}

/// What one job gives: the branches at one value of the family key.
pub struct Found {
    pub(crate) value: Option<f64>,
    pub(crate) branches: Vec<BranchRow>,
    pub(crate) orbits: Vec<OrbitRow>,
    pub(crate) up: Vec<SweepPointRow>,
    pub(crate) down: Vec<SweepPointRow>,
    pub(crate) warnings: Vec<String>,
}

impl Response {
    fn label(&self, value: Option<f64>) -> Option<Label> {
        let (key, _) = self.family.as_ref()?;
        Some(Label {
            key: key.clone(),
            value: LabelValue::Number(value?),
        })
    }

    pub(crate) fn quantity(&self, value: Option<f64>) -> Result<Quantity, StudyError> {
        match (&self.family, value) {
            (Some((key, _)), Some(value)) => self
                .subject
                .with_number(key, value)?
                .quantity(&self.over.key, self.frequency),
            _ => self.subject.quantity(&self.over.key, self.frequency),
        }
    }

    pub(crate) fn options(&self, quantity: &Quantity) -> Options {
        let (low, high) = self.over.bounds();
        Options {
            max_points: self.max_points,
            ..Options::over(quantity.parameter(low), quantity.parameter(high))
        }
    }

    fn method_row(&self, options: &Options) -> Method {
        let method = match self.method {
            ResponseMethod::Shooting => Method::new("shooting"),
            ResponseMethod::HarmonicBalance { harmonics: Some(h) } => {
                Method::new("harmonic-balance").with("harmonics", h)
            }
            ResponseMethod::HarmonicBalance { harmonics: None } => {
                Method::new("harmonic-balance").with("harmonics", "adaptive")
            }
            ResponseMethod::MultipleScales { order, mode } => {
                let method =
                    Method::new("multiple-scales").with("order", if order == Order::First { 1 } else { 2 });
                match mode {
                    Some(mode) => method.with("mode", mode),
                    None => method,
                }
            }
        };
        method
            .with("tolerance", options.tolerance)
            .with("max_step", options.max_step)
            .with("periods", self.periods)
            .with("reported_harmonics", self.harmonics)
    }
}

impl Study for Response {
    type Job = Option<f64>;
    type Rows = Found;
    type Document = ResponseDocument;

    fn plan(&self) -> Result<Vec<Option<f64>>, StudyError> {
        if self.periods == 0 {
            return Err(StudyError::question("--periods", "at least one period is needed"));
        }
        if matches!(self.method, ResponseMethod::MultipleScales { .. })
            && (self.periods > 1 || self.doublings > 0)
        {
            return Err(StudyError::question(
                "--method",
                "multiple scales finds motions of the load's period only; leave --periods and --doublings out",
            ));
        }
        let (low, high) = self.over.bounds();
        if let Some(outside) = self.at.iter().find(|value| !(low..=high).contains(*value)) {
            return Err(StudyError::question(
                "--at",
                format!("{outside} is outside the range {low} to {high} of --over"),
            ));
        }
        let quantity = self.quantity(None)?;
        for end in [low, high] {
            let point = quantity
                .family
                .at(quantity.parameter(end))
                .map_err(|reason| StudyError::question("--over", reason.to_string()))?;
            let option = if quantity.is_frequency() {
                "--over"
            } else {
                "--frequency"
            };
            check_period(&point.system, point.frequency, option)?;
            if let ResponseMethod::HarmonicBalance { harmonics: Some(h) } = self.method
                && h < point.system.forcing.highest_order().max(1)
            {
                return Err(StudyError::question(
                    "--harmonics",
                    "harmonic balance needs at least the highest order of the load",
                ));
            }
        }
        match &self.family {
            None => Ok(vec![None]),
            Some((key, values)) => {
                if *key == quantity.key {
                    return Err(StudyError::question(
                        "--for",
                        "the key is already varied by --over; choose another",
                    ));
                }
                for value in values {
                    self.subject.with_number(key, *value)?;
                }
                Ok(values.iter().copied().map(Some).collect())
            }
        }
    }

    fn run(&self, job: &Option<f64>, signal: &Signal) -> Result<Found, StudyError> {
        let quantity = self.quantity(*job)?;
        let options = self.options(&quantity);
        let tracing = match self.method {
            ResponseMethod::Shooting => Tracing::Shooting,
            ResponseMethod::HarmonicBalance { harmonics } => Tracing::HarmonicBalance { harmonics },
            ResponseMethod::MultipleScales { order, mode } => {
                let mut found = multiple_scales::run(self, &quantity, (order, mode), *job, &options, signal)?;
                if self.check > 0 {
                    let setup = Setup::new(&quantity, Tracing::Shooting, 1, options.range)?;
                    let label = self.label(*job);
                    (found.up, found.down) = integration::up_and_down(
                        &setup,
                        &quantity,
                        &self.over,
                        self.check,
                        label.as_ref(),
                        signal,
                    )?;
                }
                return Ok(found);
            }
        };
        let setup = Setup::new(&quantity, tracing, self.periods, options.range)?;
        let told = |text: String| {
            signal.tell(Progress::Step(match job {
                Some(value) => format!("{value}: {text}"),
                None => text,
            }));
        };
        let mut warnings = Vec::new();
        let mut curves: Vec<Curve> = Vec::new();
        let starts = start::find(&setup, signal);
        let none_known = starts.is_empty();
        for start in starts {
            if signal.is_interrupted() {
                break;
            }
            if curves.iter().any(|curve| curve.contains(&setup, &start)) {
                continue;
            }
            match curve::follow_both(&setup, &start, &options, signal, &|p| {
                told(format!("{} = {:.4}", quantity.key, quantity.value(p)));
            }) {
                Ok(curve) => curves.push(curve),
                Err(reason) => warnings.push(format!(
                    "no branch from the motion at {} = {}: {reason}",
                    quantity.key,
                    quantity.value(start.parameter)
                )),
            }
        }
        if curves.is_empty() && !signal.is_interrupted() {
            return Err(StudyError::NoAnswer(if none_known {
                format!(
                    "no motion that repeats after {} period(s) was found in the range; long integrations settled on none",
                    self.periods
                )
            } else {
                warnings.join("; ")
            }));
        }
        doubling::follow_all(&setup, &mut curves, self.doublings, &options, signal)?;
        for curve in &curves {
            warnings.extend(curve.remarks(&quantity));
        }
        let rows: Result<Vec<BranchRow>, StudyError> = curves
            .par_iter()
            .map(|curve| document::branch_row(&setup, curve, &quantity, self.label(*job), self.harmonics))
            .collect();
        let orbits = values::orbits(
            &setup,
            &curves,
            &quantity,
            &self.at,
            self.label(*job),
            self.harmonics,
        )?;
        let label = self.label(*job);
        let (up, down) =
            integration::up_and_down(&setup, &quantity, &self.over, self.check, label.as_ref(), signal)?;
        Ok(Found {
            value: *job,
            up,
            down,
            branches: rows?,
            orbits,
            warnings,
        })
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Found, StudyError>>>,
        interrupted: bool,
    ) -> Result<ResponseDocument, StudyError> {
        let quantity = self.quantity(None)?;
        let method = self.method_row(&self.options(&quantity));
        let mut header = self.subject.header("response", method);
        let (mut branches, mut at) = (Vec::new(), Vec::new());
        let (mut up, mut down) = (Vec::new(), Vec::new());
        let count = rows.len();
        for row in rows.into_iter().flatten() {
            match row {
                Ok(found) => {
                    let first = branches.len();
                    branches.extend(found.branches);
                    up.extend(found.up);
                    down.extend(found.down);
                    at.extend(found.orbits.into_iter().map(|orbit| OrbitRow {
                        branch: orbit.branch + first,
                        ..orbit
                    }));
                    let about = found.value.map_or(String::new(), |value| format!("{value}: "));
                    let warnings = found.warnings.iter();
                    header
                        .warnings
                        .extend(warnings.map(|warning| format!("{about}{warning}")));
                }
                Err(error) if count == 1 => return Err(error),
                Err(error) => header.warnings.push(error.to_string()),
            }
        }
        if branches.is_empty() {
            return Err(if interrupted {
                StudyError::Interrupted
            } else {
                StudyError::NoAnswer(header.warnings.join("; "))
            });
        }
        if interrupted {
            header
                .warnings
                .push("interrupted: branches end where they stood".to_owned());
        }
        Ok(ResponseDocument {
            header,
            parameter: document::ParameterRow {
                key: quantity.key,
                unit: quantity.unit,
                from: self.over.from,
                to: self.over.to,
            },
            branches,
            uniqueness: Vec::new(),
            optimum: Vec::new(),
            at,
            up,
            down,
        })
    }
}
