//! `limit`: the load above which a clutch never opens, the friction torque above which an arm never slips (theory 05 §4.4,
//! §5.2), over frequency, speed or any key.

mod document;

pub use document::{LimitDocument, LimitKind, LimitRow, Resonance, Transition};

use crate::{Method, Parameter, Quantity, Range, Signal, Study, StudyError, Subject};
use document::relevant_orders;
use slackside_dynamics::closed_form::{
    ClosedFormError, LockedElement, LockedForce, holding_limits, zeros_of_margin,
};
use slackside_mechanics::{OperatingPoint, System};
use std::f64::consts::TAU;

/// Values of a range without a step.
const USUAL_VALUES: usize = 401;
/// Damping ratio of a locked mode up to which it counts as a resonance.
const DAMPING_OF_RESONANCE: f64 = 0.2;

/// The question.
#[derive(Debug, Clone)]
pub struct Limit {
    /// The model.
    pub subject: Subject,
    /// What is sought.
    pub kind: LimitKind,
    /// The quantity and its values in the user's unit; 401 of them without a step.
    pub over: Range,
    /// Frequency of the load in the user's unit when another key is varied.
    pub frequency: Option<f64>,
    /// Name of the element; the only one of its kind without it.
    pub element: Option<String>,
}

/// What one value gives.
#[derive(Debug, Clone)]
pub struct Found {
    value: f64,
    outcome: Result<Answered, String>,
}

/// The limit at one value, and what else is told of all values.
#[derive(Debug, Clone)]
struct Answered {
    row: LimitRow,
    /// Margin of the element itself.
    margin: f64,
    /// Other elements that would move.
    moving: Vec<String>,
    /// `Ω k` and the frequencies of the locked modes, for the orders that matter.
    frequency: f64,
    orders: Vec<usize>,
    modes: Vec<f64>,
}

impl Limit {
    fn quantity(&self) -> Result<Quantity, StudyError> {
        self.subject.quantity(&self.over.key, self.frequency)
    }

    fn point(&self, quantity: &Quantity, value: f64) -> Result<OperatingPoint, StudyError> {
        let point = quantity.family.at(quantity.parameter(value))?;
        crate::check_period(&point.system, point.frequency, "--over")?;
        Ok(point)
    }

    /// Index of the element that is asked about.
    fn element(&self, system: &System) -> Result<usize, StudyError> {
        let fits = |index: &usize| {
            holding_limits(system.elements[*index].law.as_ref()).is_some_and(|limits| self.kind.fits(limits))
        };
        let fitting: Vec<usize> = (0..system.elements.len()).filter(fits).collect();
        let names = |indices: &[usize]| -> String {
            let names = indices
                .iter()
                .map(|&e| format!("\"{}\"", system.elements[e].name));
            names.collect::<Vec<_>>().join(", ")
        };
        let wanted = self.kind.wanted();
        if let Some(name) = &self.element {
            let index = system.elements.iter().position(|element| &element.name == name);
            return match index {
                Some(index) if fitting.contains(&index) => Ok(index),
                Some(index) => Err(StudyError::question(
                    "--element",
                    format!(
                        "\"{name}\" ({}) is no {wanted}; {}",
                        system.elements[index].law.kind(),
                        if fitting.is_empty() {
                            "the model has none".to_owned()
                        } else {
                            format!("there is {}", names(&fitting))
                        }
                    ),
                )),
                None => {
                    let all: Vec<usize> = (0..system.elements.len()).collect();
                    Err(StudyError::question(
                        "--element",
                        format!("there is no element \"{name}\"; the model has {}", names(&all)),
                    ))
                }
            };
        }
        match fitting.as_slice() {
            [index] => Ok(*index),
            [] => Err(StudyError::question(
                "FILE",
                format!("the model has no {wanted}, whose limit could be told"),
            )),
            several => Err(StudyError::question(
                "--element",
                format!("which of {}? Name one", names(several)),
            )),
        }
    }

    fn locked(&self, point: &OperatingPoint) -> Result<LockedElement, StudyError> {
        let element = self.element(&point.system)?;
        LockedElement::among_engaged(&point.system, element).map_err(study_error)
    }

    fn answered(&self, quantity: &Quantity, value: f64) -> Result<Answered, StudyError> {
        let point = self.point(quantity, value)?;
        let mut locked = self.locked(&point)?;
        let frequency = point.frequency;
        let force = locked.force(frequency).map_err(study_error)?;
        let margin = locked.margin(&force, frequency).map_err(study_error)?;
        let margins = locked.holding_margins(&force, frequency).map_err(study_error)?;
        let moving = (locked.held.iter().zip(margins))
            .filter(|(_, margin)| *margin < 0.0)
            .map(|(other, _)| other.name.clone())
            .collect();
        let modes = locked.resonances(frequency).map_err(study_error)?;
        Ok(Answered {
            row: self.row(quantity, value, &mut locked, &force, frequency)?,
            margin,
            moving,
            frequency,
            orders: relevant_orders(&force.harmonics),
            modes: (modes.iter())
                .filter(|pole| -pole.re < DAMPING_OF_RESONANCE * pole.norm())
                .map(|pole| pole.im)
                .collect(),
        })
    }

    fn row(
        &self,
        quantity: &Quantity,
        value: f64,
        locked: &mut LockedElement,
        force: &LockedForce,
        frequency: f64,
    ) -> Result<LimitRow, StudyError> {
        let at = Parameter {
            key: quantity.key.clone(),
            value,
        };
        let margin = locked.margin(force, frequency).map_err(study_error)?;
        let (low, high) = locked.limits;
        Ok(match self.kind {
            LimitKind::CriticalLoad => {
                let load = locked.critical_load(frequency).map_err(study_error)?;
                LimitRow {
                    at,
                    value: load.critical,
                    present: load.mean,
                    locked: margin >= 0.0,
                    minimum: force.dynamic.minimum,
                    maximum: force.dynamic.maximum,
                    opens_at: Some(load.opens_at / TAU),
                    offset: None,
                    stiffness: None,
                }
            }
            LimitKind::CriticalTorque => {
                let torque = locked.critical_torque(frequency).map_err(study_error)?;
                LimitRow {
                    at,
                    value: torque.critical,
                    present: Some(0.5 * (high - low)),
                    locked: margin >= 0.0,
                    minimum: torque.minimum,
                    maximum: torque.maximum,
                    opens_at: None,
                    offset: torque.offset,
                    stiffness: Some(torque.stiffness),
                }
            }
        })
    }

    /// Values at which the element begins to move, or ceases to.
    fn transitions(&self, answered: &[Answered]) -> Result<Vec<Transition>, StudyError> {
        let quantity = self.quantity()?;
        let grid: Vec<f64> = answered.iter().map(|found| found.row.at.value).collect();
        let mut known = answered.iter().map(|found| found.margin);
        let mut margin = |value: f64| -> Result<f64, StudyError> {
            if let Some(margin) = known.next() {
                return Ok(margin);
            }
            let point = self.point(&quantity, value)?;
            let mut locked = self.locked(&point)?;
            let force = locked.force(point.frequency).map_err(study_error)?;
            locked.margin(&force, point.frequency).map_err(study_error)
        };
        let zeros = zeros_of_margin(&grid, &mut margin)?;
        Ok((zeros.into_iter())
            .map(|zero| Transition {
                at: Parameter {
                    key: quantity.key.clone(),
                    value: zero.value,
                },
                locked_above: zero.locked_above,
            })
            .collect())
    }

    /// Where a harmonic of the load meets a mode of the locked system, between neighbouring values.
    fn resonances(&self, answered: &[Answered]) -> Vec<Resonance> {
        let mut found = Vec::new();
        for pair in answered.windows(2) {
            let [a, b] = pair else { continue };
            for &order in a.orders.iter().filter(|order| b.orders.contains(order)) {
                for (mode, (p, q)) in a.modes.iter().zip(&b.modes).enumerate() {
                    let before = order as f64 * a.frequency - p;
                    let after = order as f64 * b.frequency - q;
                    if (before <= 0.0) != (after <= 0.0) {
                        let share = before / (before - after);
                        let (from, to) = (a.row.at.value, b.row.at.value);
                        found.push(Resonance {
                            at: Parameter {
                                key: a.row.at.key.clone(),
                                value: from + share * (to - from),
                            },
                            order,
                            mode: mode + 1,
                        });
                    }
                }
            }
        }
        found
    }
}

/// Elements that cannot be locked are a matter of the question, all else is a lack of an answer.
fn study_error(error: ClosedFormError) -> StudyError {
    match error {
        ClosedFormError::CannotLock { .. } | ClosedFormError::OtherKind { .. } => {
            StudyError::question("--element", error.to_string())
        }
        ClosedFormError::NoHarmonic => StudyError::question(
            "FILE",
            "nothing shakes the system: the load has no harmonics, so that there is no limit",
        ),
        other => StudyError::NoAnswer(other.to_string()),
    }
}

impl Study for Limit {
    type Job = f64;
    type Rows = Found;
    type Document = LimitDocument;

    fn plan(&self) -> Result<Vec<f64>, StudyError> {
        let quantity = self.quantity()?;
        let values = self.over.values(USUAL_VALUES);
        // A wrong question is told at once, a value without a system later, among the rows.
        if let Some(Ok(point)) = values
            .iter()
            .map(|&value| quantity.family.at(quantity.parameter(value)))
            .find(Result::is_ok)
        {
            self.element(&point.system)?;
        }
        Ok(values)
    }

    fn run(&self, value: &f64, _: &Signal) -> Result<Found, StudyError> {
        let outcome = match self
            .quantity()
            .and_then(|quantity| self.answered(&quantity, *value))
        {
            Ok(answered) => Ok(answered),
            Err(error @ (StudyError::NoAnswer(_) | StudyError::OutsideDomain(_))) => Err(error.to_string()),
            Err(StudyError::Linalg(error)) => Err(error.to_string()),
            Err(other) => return Err(other),
        };
        Ok(Found {
            value: *value,
            outcome,
        })
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Found, StudyError>>>,
        interrupted: bool,
    ) -> Result<LimitDocument, StudyError> {
        let key = &self.quantity()?.key;
        let (mut answered, mut failures) = (Vec::new(), Vec::new());
        for row in rows.into_iter().flatten() {
            let found = row?;
            match found.outcome {
                Ok(answer) => answered.push(answer),
                Err(reason) => failures.push((found.value, reason)),
            }
        }
        let Some(first) = answered.first() else {
            return Err(match failures.first() {
                Some((value, reason)) => StudyError::NoAnswer(format!("{key} = {value}: {reason}")),
                None => StudyError::Interrupted,
            });
        };
        let quantity = self.quantity()?;
        let point = self.point(&quantity, first.row.at.value)?;
        let locked = self.locked(&point)?;
        let mut header = self
            .subject
            .header("limit", Method::new("closed form of the locked element"));
        header.warnings.extend(self.remarks(&locked, &answered));
        if let Some((value, reason)) = failures.first() {
            header.warnings.push(format!(
                "{} values of {key} have no limit, the first is {value}: {reason}",
                failures.len()
            ));
        }
        if interrupted {
            header.warnings.push("interrupted".to_owned());
        }
        Ok(LimitDocument {
            header,
            limit: self.kind,
            element: locked.name,
            held: locked.held.into_iter().map(|other| other.name).collect(),
            engaged: locked.engaged,
            free: locked.free,
            transitions: self.transitions(&answered)?,
            resonances: self.resonances(&answered),
            points: answered.into_iter().map(|answer| answer.row).collect(),
            unit: quantity.unit,
        })
    }
}

impl Limit {
    /// What is assumed of other elements, and where it does not hold.
    fn remarks(&self, locked: &LockedElement, answered: &[Answered]) -> Vec<String> {
        let mut remarks = Vec::new();
        for other in &locked.held {
            let moving = answered
                .iter()
                .filter(|answer| answer.moving.contains(&other.name));
            let values: Vec<f64> = moving.map(|answer| answer.row.at.value).collect();
            remarks.push(match values.as_slice() {
                [] => format!("\"{}\" is held at rest, as it really is at all values", other.name),
                [first, .., last] => format!(
                    "\"{}\" is taken as held at rest, but really moves at {} of {} values between {first} and {last}: there the limit is an estimate",
                    other.name,
                    values.len(),
                    answered.len()
                ),
                [only] => format!(
                    "\"{}\" is taken as held at rest, but really moves at {only}: there the limit is an estimate",
                    other.name
                ),
            });
        }
        let listed = |names: &[String]| -> String {
            let quoted = names.iter().map(|name| format!("\"{name}\""));
            quoted.collect::<Vec<_>>().join(", ")
        };
        if !locked.engaged.is_empty() {
            let names = listed(&locked.engaged);
            remarks.push(format!(
                "taken as engaged for good, as linear springs and dampers: {names}"
            ));
        }
        if !locked.free.is_empty() {
            remarks.push(format!("taken as out of contact: {}", listed(&locked.free)));
        }
        remarks
    }
}
