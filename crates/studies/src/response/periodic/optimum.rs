//! The best value along a range: a grid fine enough for several local optima, then a golden section (theory 05 §5.6).

use super::line::Line;
use super::search::{Wanted, solve};
use crate::response::{PointRow, ResponseDocument};
use crate::{Label, Measure, Motion, Parameter, StudyError, Subject};
use serde::Serialize;
use std::str::FromStr;

/// Fewest values among which an optimum is sought.
const LEAST_VALUES: usize = 60;
/// Steps of the golden section: beyond them the differences drown in rounding.
const STEPS: usize = 40;

/// What is best where it is largest or smallest.
#[derive(Debug, Clone, PartialEq)]
pub enum Objective {
    /// The largest dissipation in a period, of one element (by its name or that behind `friction.`) or of all together.
    Dissipation(Option<String>),
    /// The smallest RMS or maximum of a measure, or its largest minimum.
    Measure {
        /// Name of the measure.
        name: String,
        /// `rms`, `max` or `min`.
        statistic: Statistic,
    },
}

/// Statistic of a measure that an optimum is sought for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Statistic {
    /// Root mean square about the mean: the smallest.
    Rms,
    /// Maximum: the smallest.
    Max,
    /// Minimum: the largest.
    Min,
}

impl FromStr for Objective {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        if text == "dissipation" {
            return Ok(Self::Dissipation(None));
        }
        if let Some(element) = text.strip_prefix("dissipation.") {
            return Ok(Self::Dissipation(Some(element.to_owned())));
        }
        let (name, statistic) = match text.rsplit_once('.') {
            Some((name, "rms")) => (name, Statistic::Rms),
            Some((name, "max")) => (name, Statistic::Max),
            Some((name, "min")) => (name, Statistic::Min),
            _ => {
                return Err(format!(
                    "`{text}` is neither dissipation nor dissipation.ELEMENT nor MEASURE.rms, MEASURE.max or MEASURE.min"
                ));
            }
        };
        Ok(Self::Measure {
            name: name.to_owned(),
            statistic,
        })
    }
}

/// The best value along a range.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OptimumRow {
    /// Value of the family key, if there are several.
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub label: Option<Label>,
    /// What is best: `dissipation`, or a measure and its statistic.
    pub of: String,
    /// `largest` or `smallest`.
    pub sense: &'static str,
    /// Where.
    #[serde(flatten)]
    pub at: Parameter,
    /// How large it is there.
    pub value: f64,
    /// Whether it lies at an end of the range, beyond which there may be better.
    pub at_end: bool,
    /// Other local optima among the values computed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub others: Vec<LocalOptimum>,
}

/// A local optimum among the values computed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LocalOptimum {
    /// Where.
    #[serde(flatten)]
    pub at: Parameter,
    /// How large.
    pub value: f64,
}

impl Objective {
    /// Refuses what no motion of the subject has, and too coarse a grid.
    ///
    /// # Errors
    /// [`StudyError::Question`].
    pub(super) fn check(&self, subject: &Subject, values: usize) -> Result<(), StudyError> {
        if values < LEAST_VALUES {
            return Err(StudyError::question(
                "--optimum",
                format!(
                    "there may be several optima: give --over at least {LEAST_VALUES} values, not {values}, or no step"
                ),
            ));
        }
        let system = subject.system()?;
        match self {
            Self::Dissipation(Some(name)) => {
                let elements = system.elements.iter().map(|element| element.name.as_str());
                let known: Vec<&str> = elements.collect();
                if !known.iter().any(|element| is_called(element, name)) {
                    return Err(StudyError::question(
                        "--optimum",
                        format!("there is no element \"{name}\"; known are {}", known.join(", ")),
                    ));
                }
            }
            Self::Dissipation(None) if system.elements.is_empty() => {
                return Err(StudyError::question(
                    "--optimum",
                    "the system has no nonlinear element that dissipates",
                ));
            }
            Self::Measure { name, .. } if system.output_index(name).is_none() => {
                let outputs = system.outputs.iter().map(|output| output.name.as_str());
                let known: Vec<&str> = outputs.collect();
                return Err(StudyError::question(
                    "--optimum",
                    format!("there is no measure \"{name}\"; known are {}", known.join(", ")),
                ));
            }
            Self::Dissipation(None) | Self::Measure { .. } => {}
        }
        Ok(())
    }

    /// The name in documents.
    fn name(&self) -> String {
        match self {
            Self::Dissipation(None) => "dissipation".to_owned(),
            Self::Dissipation(Some(element)) => format!("dissipation.{element}"),
            Self::Measure { name, statistic } => {
                let statistic = match statistic {
                    Statistic::Rms => "rms",
                    Statistic::Max => "max",
                    Statistic::Min => "min",
                };
                format!("{name}.{statistic}")
            }
        }
    }

    fn is_largest(&self) -> bool {
        !matches!(
            self,
            Self::Measure {
                statistic: Statistic::Rms | Statistic::Max,
                ..
            }
        )
    }

    /// The quantity of a motion.
    pub fn of(&self, motion: &Motion) -> f64 {
        match self {
            Self::Dissipation(name) => {
                let elements = motion.elements.0.iter();
                let counted =
                    elements.filter(|(element, _)| name.as_ref().is_none_or(|name| is_called(element, name)));
                counted.map(|(_, row)| row.dissipation + row.impact_loss).sum()
            }
            Self::Measure { name, statistic } => {
                let value = |measure: &Measure| match statistic {
                    Statistic::Rms => measure.rms,
                    Statistic::Max => measure.max,
                    Statistic::Min => measure.min,
                };
                motion.measures.get(name).map_or(f64::NAN, value)
            }
        }
    }

    /// The same, so that larger is better.
    fn gain(&self, motion: &Motion) -> f64 {
        if self.is_largest() {
            self.of(motion)
        } else {
            -self.of(motion)
        }
    }
}

fn is_called(element: &str, name: &str) -> bool {
    element == name || element.strip_prefix("friction.") == Some(name)
}

/// Adds the optimum of every member to the document.
pub(super) fn add(
    document: &mut ResponseDocument,
    objective: &Objective,
    members: &[(Option<Label>, &Subject)],
    lines: &[Line],
    wanted: Wanted,
) {
    for ((label, _), line) in members.iter().zip(lines) {
        let of_member = document.branches.iter().filter(|branch| branch.label == *label);
        // Further branches are other motions at the same values: the first is the response from below.
        let Some(branch) = of_member.max_by_key(|branch| branch.points.len()) else {
            continue;
        };
        if let Some(row) = best(&branch.points, objective, label, line, wanted) {
            if row.at_end {
                document.header.warnings.push(format!(
                    "the {} {} lies at the end {} = {} of the range",
                    row.sense, row.of, row.at.key, row.at.value
                ));
            }
            document.optimum.push(row);
        }
    }
}

fn best(
    points: &[PointRow],
    objective: &Objective,
    label: &Option<Label>,
    line: &Line,
    wanted: Wanted,
) -> Option<OptimumRow> {
    let gains: Vec<f64> = points.iter().map(|point| objective.gain(&point.motion)).collect();
    let top = (0..gains.len()).filter(|i| gains[*i].is_finite());
    let top = top.max_by(|a, b| gains[*a].total_cmp(&gains[*b]))?;
    let at = |value: f64| Parameter {
        key: line.quantity.key.clone(),
        value,
    };
    let local = |i: &usize| *i != top && gains[*i] > gains[*i - 1] && gains[*i] >= gains[*i + 1];
    let others = (1..gains.len().saturating_sub(1)).filter(local);
    let others = others.map(|i| LocalOptimum {
        at: at(points[i].at.value),
        value: objective.of(&points[i].motion),
    });
    let others = others.collect();
    let at_end = top == 0 || top + 1 == gains.len();
    let mut found = (points[top].at.value, objective.of(&points[top].motion));
    if !at_end {
        let start = &points[top].start;
        let value = |x: f64| -> Option<f64> {
            let station = line.at(x).ok()?;
            let (point, _) = solve(&station, &line.quantity.key, x, Some(start), wanted).ok()?;
            Some(objective.of(&point.motion))
        };
        let sign = if objective.is_largest() { 1.0 } else { -1.0 };
        if let Some(refined) =
            golden_section(points[top - 1].at.value, points[top + 1].at.value, &value, sign)
            && sign * refined.1 >= sign * found.1
        {
            found = refined;
        }
    }
    Some(OptimumRow {
        label: label.clone(),
        of: objective.name(),
        sense: if objective.is_largest() {
            "largest"
        } else {
            "smallest"
        },
        at: at(found.0),
        value: found.1,
        at_end,
        others,
    })
}

/// Argument and value of the extremum of a function with one extremum between `low` and `high`; `None` where it cannot be
/// evaluated.
fn golden_section(
    mut low: f64,
    mut high: f64,
    value: &dyn Fn(f64) -> Option<f64>,
    sign: f64,
) -> Option<(f64, f64)> {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut left, mut right) = (high - share * (high - low), low + share * (high - low));
    let (mut at_left, mut at_right) = (value(left)?, value(right)?);
    for _ in 0..STEPS {
        if sign * at_left > sign * at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - share * (high - low);
            at_left = value(left)?;
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + share * (high - low);
            at_right = value(right)?;
        }
    }
    Some(if sign * at_left > sign * at_right {
        (left, at_left)
    } else {
        (right, at_right)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden_section_finds_largest_and_smallest() {
        let hill = |x: f64| Some(3.0 - (x - 0.3_f64).powi(2));
        let (at, value) = golden_section(0.0, 1.0, &hill, 1.0).unwrap();
        assert!((at - 0.3).abs() < 1e-7 && (value - 3.0).abs() < 1e-14);
        let valley = |x: f64| Some((x - 0.7_f64).abs());
        let (at, value) = golden_section(0.0, 1.0, &valley, -1.0).unwrap();
        assert!((at - 0.7).abs() < 1e-8 && value < 1e-8);
        assert_eq!(golden_section(0.0, 1.0, &|_| None, 1.0), None);
    }

    #[test]
    fn objectives_are_read_and_told() {
        for (text, name, largest) in [
            ("dissipation", "dissipation", true),
            ("dissipation.arm", "dissipation.arm", true),
            ("arm.tensioner.rms", "arm.tensioner.rms", false),
            ("tension.a-b.min", "tension.a-b.min", true),
        ] {
            let objective: Objective = text.parse().unwrap();
            assert_eq!(
                (objective.name().as_str(), objective.is_largest()),
                (name, largest)
            );
        }
        assert!("arm.mean".parse::<Objective>().is_err());
    }
}
