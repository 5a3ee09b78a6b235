//! The periodic motion at each value of a range, from the one before: the method for set-valued laws, whose response is
//! mostly unique and needs no continuation (theory 05 §2.1, §7).
//!
//! The certificate of uniqueness is evaluated at every value. Where it holds, a motion found from any start is the response,
//! and chunks of values are computed side by side. Where it does not, the range is gone through upwards, downwards and from
//! rest, and motions that differ make branches of their own.

mod branches;
pub(crate) mod line;
mod optimum;
mod search;
mod verdict;

pub use crate::drive::trust::Remark;
pub use optimum::{Objective, OptimumRow};
pub use verdict::UniquenessRow;

use super::{History, OrbitRow, ParameterRow, PointRow, ResponseDocument};
use crate::{
    Header, Label, LabelValue, Method, Range, Ratios, Signal, Study, StudyError, Subject, check_period,
};
use line::Line;
use rayon::prelude::*;
use search::{Outcome, Start, Wanted, pass, solve};
use serde::Serialize;
use slackside_dynamics::orbit::periodic::PeriodicSettings;
use slackside_dynamics::receptance::uniqueness;
use slackside_mechanics::{Piece, System};

/// Values of a range without a step.
const USUAL_VALUES: usize = 201;
/// Values that follow from each other in one job.
const CHUNK: usize = 16;
/// Samples of a period of the load in histories.
const HISTORY: usize = 512;
/// Values at which the certificate decides whether all passes are needed.
const PROBES: usize = 9;

/// The question.
#[derive(Debug, Clone)]
pub struct PeriodicResponse {
    /// The model.
    pub subject: Subject,
    /// What varies and its values in the user's unit; 201 of them without a step.
    pub over: Range,
    /// Frequency of the load in the user's unit, when another key is varied.
    pub frequency: Option<f64>,
    /// Periods of the load after which motions repeat.
    pub periods: usize,
    /// Values at which motions are reported besides.
    pub at: Vec<f64>,
    /// Another key with the models of its values.
    pub family: Option<Family>,
    /// Harmonics reported of each measure.
    pub harmonics: usize,
    /// What the best value along the range is sought for.
    pub optimum: Option<Objective>,
}

/// Models that differ in one key.
#[derive(Debug, Clone)]
pub struct Family {
    /// The key.
    pub key: String,
    /// Its values with their models.
    pub members: Vec<(LabelValue, Subject)>,
}

/// How far the motion of a point can be trusted, and what else only this method knows of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trust {
    /// Elements of dry friction that stick for all time: the middle of the places where they may do so is reported.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stuck: Vec<String>,
    /// Where the motion leaves what the model holds for.
    #[serde(rename = "warnings", skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<Remark>,
    /// Steady values that the measures of a drive contain.
    #[serde(skip_serializing_if = "Ratios::is_empty")]
    pub steady: Ratios,
}

/// Values that follow from each other, of one member of the family.
pub struct Job {
    member: usize,
    pass: Pass,
    values: Vec<f64>,
}

/// Why a job goes through its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pass {
    /// The response is unique: any order will do.
    Only,
    /// Upwards, each motion from the one before.
    Up,
    /// Downwards.
    Down,
    /// Each motion from rest.
    Rest,
}

/// What a job gives.
pub struct Found {
    member: usize,
    pass: Pass,
    outcomes: Vec<Outcome>,
}

/// Whether motions of a system are better found one by one than followed: laws that stick, hit or remember.
pub fn is_set_valued(system: &System) -> bool {
    system.elements.iter().any(|element| {
        element.law.has_internal_state()
            || element.law.regimes().is_some_and(|table| {
                let mut regimes = table.regimes.iter();
                regimes.any(|regime| matches!(regime.piece, Piece::Stick { .. }))
            })
    })
}

impl PeriodicResponse {
    /// The members of the family, or the model alone.
    fn members(&self) -> Vec<(Option<Label>, &Subject)> {
        match &self.family {
            None => vec![(None, &self.subject)],
            Some(family) => {
                let members = family.members.iter();
                let labelled = members.map(|(value, subject)| {
                    let label = Label {
                        key: family.key.clone(),
                        value: value.clone(),
                    };
                    (Some(label), subject)
                });
                labelled.collect()
            }
        }
    }

    fn line(&self, subject: &Subject) -> Result<Line, StudyError> {
        Line::new(subject, &self.over.key, self.frequency)
    }

    fn values(&self) -> Vec<f64> {
        self.over.values(USUAL_VALUES)
    }

    fn wanted(&self) -> Wanted {
        Wanted {
            periods: self.periods,
            harmonics: self.harmonics,
            samples: 0,
        }
    }

    /// Whether the certificate holds at all probed values of a member.
    fn is_unique(&self, subject: &Subject) -> Result<bool, StudyError> {
        let line = self.line(subject)?;
        let (low, high) = self.over.bounds();
        let (mut known, mut reason) = (false, None);
        let mut unique = true;
        for k in 0..PROBES {
            let value = low + (high - low) * k as f64 / (PROBES - 1) as f64;
            let station = match line.at(value) {
                Ok(station) => station,
                // Somewhere in the range there may still be motions.
                Err(error) => {
                    reason.get_or_insert(error);
                    continue;
                }
            };
            known = true;
            let option = match line.quantity.key.as_str() {
                "frequency" | "speed" => "--over",
                _ => "--frequency",
            };
            check_period(&station.point.system, station.point.frequency, option)?;
            let certificate = uniqueness(&station.point);
            unique &= certificate.is_ok_and(|certificate| certificate.excludes_jumps());
        }
        match reason {
            Some(error) if !known => Err(StudyError::question("--over", error.to_string())),
            _ => Ok(unique),
        }
    }

    fn header(&self) -> Header {
        let settings = PeriodicSettings::default();
        let method = Method::new("periodic")
            .with("tolerance", settings.tolerance)
            .with("march", settings.march)
            .with("periods", self.periods)
            .with("reported_harmonics", self.harmonics);
        self.subject.header("response", method)
    }

    /// The motions at the values asked for, each from the nearest motion of every branch that holds the value.
    fn orbits(&self, document: &ResponseDocument, lines: &[Line]) -> Vec<Result<OrbitRow, String>> {
        let members = self.members();
        let wanted: Vec<(f64, usize)> = self
            .at
            .iter()
            .flat_map(|at| (0..document.branches.len()).map(move |branch| (*at, branch)))
            .collect();
        let with_history = Wanted {
            samples: HISTORY,
            ..self.wanted()
        };
        let found = wanted.par_iter().filter_map(|&(at, index)| {
            let branch = &document.branches[index];
            let member = members.iter().position(|(label, _)| *label == branch.label)?;
            let start = nearest(&branch.points, at)?;
            let line = &lines[member];
            let solved = line
                .at(at)
                .map_err(|error| error.to_string())
                .and_then(|station| solve(&station, &line.quantity.key, at, Some(start), with_history));
            Some(match solved {
                Ok(solved) => Ok(orbit(solved, branch.label.clone(), index, self.periods)),
                Err(reason) => Err(format!("no motion at {} = {at}: {reason}", self.over.key)),
            })
        });
        found.collect()
    }
}

/// State of the motion of a branch that is nearest to a value within its range.
fn nearest(points: &[PointRow], value: f64) -> Option<&[f64]> {
    let values = || points.iter().map(|point| point.at.value);
    let (low, high) = (
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
    );
    if !(low..=high).contains(&value) {
        return None;
    }
    let distance = |point: &&PointRow| (point.at.value - value).abs();
    let nearest = points.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map(|point| point.start.as_slice())
}

fn orbit(
    (point, history): (PointRow, Option<History>),
    label: Option<Label>,
    branch: usize,
    periods: usize,
) -> OrbitRow {
    OrbitRow {
        at: point.at,
        label,
        branch,
        periods,
        stable: point.stable,
        multipliers: point.multipliers,
        residual: point.residual,
        start: point.start,
        multiple_scales: None,
        trust: point.trust,
        motion: point.motion,
        history,
    }
}

impl Study for PeriodicResponse {
    type Job = Job;
    type Rows = Found;
    type Document = ResponseDocument;

    fn plan(&self) -> Result<Vec<Job>, StudyError> {
        if self.periods == 0 {
            return Err(StudyError::question("--periods", "at least one period is needed"));
        }
        let (low, high) = self.over.bounds();
        if let Some(outside) = self.at.iter().find(|value| !(low..=high).contains(*value)) {
            return Err(StudyError::question(
                "--at",
                format!("{outside} is outside the range {low} to {high} of --over"),
            ));
        }
        if let Some(family) = &self.family
            && family.key == self.over.key
        {
            return Err(StudyError::question(
                "--for",
                "the key is already varied by --over; choose another",
            ));
        }
        let values = self.values();
        if let Some(objective) = &self.optimum {
            objective.check(&self.subject, values.len())?;
        }
        let mut jobs = Vec::new();
        for (member, (_, subject)) in self.members().into_iter().enumerate() {
            let chunks = |pass: Pass| {
                let chunks = values.chunks(CHUNK).map(<[f64]>::to_vec);
                chunks.map(move |values| Job { member, pass, values })
            };
            if self.is_unique(subject)? {
                jobs.extend(chunks(Pass::Only));
            } else {
                let mut falling = values.clone();
                falling.reverse();
                for (pass, values) in [(Pass::Up, values.clone()), (Pass::Down, falling)] {
                    jobs.push(Job { member, pass, values });
                }
                jobs.extend(chunks(Pass::Rest));
            }
        }
        Ok(jobs)
    }

    fn run(&self, job: &Job, signal: &Signal) -> Result<Found, StudyError> {
        let members = self.members();
        let line = self.line(members[job.member].1)?;
        let start = match job.pass {
            Pass::Rest => Start::Rest,
            Pass::Only | Pass::Up | Pass::Down => Start::Neighbour,
        };
        Ok(Found {
            member: job.member,
            pass: job.pass,
            outcomes: pass(&line, &job.values, start, self.wanted(), signal),
        })
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Found, StudyError>>>,
        interrupted: bool,
    ) -> Result<ResponseDocument, StudyError> {
        let members = self.members();
        let lines: Vec<Line> = members
            .iter()
            .map(|(_, subject)| self.line(subject))
            .collect::<Result<_, StudyError>>()?;
        let Some(first) = lines.first() else {
            return Err(StudyError::question("--for", "give at least one value"));
        };
        let mut document = ResponseDocument {
            header: self.header(),
            parameter: ParameterRow {
                key: first.quantity.key.clone(),
                unit: first.quantity.unit.clone(),
                from: self.over.from,
                to: self.over.to,
            },
            branches: Vec::new(),
            uniqueness: Vec::new(),
            optimum: Vec::new(),
            at: Vec::new(),
            up: Vec::new(),
            down: Vec::new(),
        };
        let mut passes: Vec<Vec<(Pass, Vec<Outcome>)>> = members.iter().map(|_| Vec::new()).collect();
        for found in rows.into_iter().flatten() {
            let found = found?;
            let of_member = &mut passes[found.member];
            match of_member.iter_mut().find(|(pass, _)| *pass == found.pass) {
                Some((_, outcomes)) => outcomes.extend(found.outcomes),
                None => of_member.push((found.pass, found.outcomes)),
            }
        }
        for ((label, _), passes) in members.iter().zip(passes) {
            branches::add(&mut document, label, passes, self.periods, interrupted);
        }
        if document.branches.is_empty() {
            return Err(if interrupted {
                StudyError::Interrupted
            } else {
                StudyError::NoAnswer(document.header.warnings.join("; "))
            });
        }
        if let Some(objective) = &self.optimum {
            optimum::add(&mut document, objective, &members, &lines, self.wanted());
        }
        for orbit in self.orbits(&document, &lines) {
            match orbit {
                Ok(orbit) => document.at.push(orbit),
                Err(reason) => document.header.warnings.push(reason),
            }
        }
        if interrupted {
            document
                .header
                .warnings
                .push("interrupted: branches hold what was finished".to_owned());
        }
        Ok(document)
    }
}
