//! Linear response of a drive to the orders of its excitation, over speed, frequency or any key (theory 04 §3.7, §3.8).

mod document;
mod reader;

pub use document::{DriveResponseDocument, OrderMeasureRow, ResponseRow};

use super::steady::VariedRow;
use super::{InstalledDrive, Place, Places};
use crate::{Method, Signal, Study, StudyError, Texts};
use reader::{Reader, SAMPLES, Violation, times};
use slackside_belt_drive::drive::Excitation;
use slackside_belt_drive::forced_response::{HarmonicLoad, forced_response};
use slackside_belt_drive::model::LinearModel;
use slackside_linalg::Complex;

/// The question.
#[derive(Debug, Clone)]
pub struct DriveResponse {
    /// Where.
    pub places: Places,
}

/// What one job gives.
pub struct Found {
    value: f64,
    outcome: Result<ResponseRow, String>,
    violations: Vec<Violation>,
}

impl DriveResponse {
    /// The question, checked.
    ///
    /// # Errors
    /// [`StudyError::Question`] without a range or without an excitation.
    pub fn new(places: Places) -> Result<Self, StudyError> {
        if places.over.is_none() {
            return Err(StudyError::question(
                "--over",
                "give a range, for example --over speed=600:6000",
            ));
        }
        let drive = places.drive(places.operating_point())?;
        if drive.excitation.orders().is_empty() {
            return Err(StudyError::question(
                "FILE",
                "nothing shakes the drive; add `[excitation]` with `motion = [{ order = 2, amplitude = \"0.5 deg\" }]`",
            ));
        }
        Ok(Self { places })
    }
}

impl Study for DriveResponse {
    type Job = Place;
    type Rows = Found;
    type Document = DriveResponseDocument;

    fn plan(&self) -> Result<Vec<Place>, StudyError> {
        Ok(self.places.values())
    }

    fn run(&self, job: &Place, _: &Signal) -> Result<Found, StudyError> {
        let value = job.value.unwrap_or_default();
        let found = self.places.drive(*job).and_then(|at| self.row(*job, value, &at));
        match found {
            Ok((row, violations)) => Ok(Found {
                value,
                outcome: Ok(row),
                violations,
            }),
            Err(StudyError::NoAnswer(reason)) => Ok(Found {
                value,
                outcome: Err(reason),
                violations: Vec::new(),
            }),
            Err(StudyError::Linalg(error)) => Ok(Found {
                value,
                outcome: Err(format!("an undamped resonance ({error})")),
                violations: Vec::new(),
            }),
            Err(other) => Err(other),
        }
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Found, StudyError>>>,
        interrupted: bool,
    ) -> Result<DriveResponseDocument, StudyError> {
        let at = self.places.drive(self.places.operating_point())?;
        let belt = &at.drive.belt;
        let method = Method::new("linear response by orders")
            .with("belt_model", belt.model.name())
            .with("terms_per_span", belt.terms.clone())
            .with("static_correction", belt.static_correction)
            .with("samples_per_revolution", SAMPLES);
        let mut header = self.places.subject().linear_header("response", method);
        let (mut points, mut failures) = (Vec::new(), Vec::new());
        let mut violations: Vec<(f64, Violation)> = Vec::new();
        for row in rows.into_iter().flatten() {
            let found = row?;
            let here = found.violations.into_iter();
            violations.extend(here.map(|violation| (found.value, violation)));
            match found.outcome {
                Ok(row) => points.push(row),
                Err(reason) => failures.push((found.value, reason)),
            }
        }
        let key = self.places.key();
        let slack = told(
            &violations,
            key,
            "the belt goes slack, which the linear model does not see",
            &|violation| match violation {
                Violation::Slack(span) => Some(span),
                Violation::Slip(_) => None,
            },
        );
        let slip = told(
            &violations,
            key,
            "the belt would slip, where the linear model lets it stick",
            &|violation| match violation {
                Violation::Slip(pulley) => Some(pulley),
                Violation::Slack(_) => None,
            },
        );
        header.warnings.extend(slack.into_iter().chain(slip));
        if let Some((value, reason)) = failures.first() {
            if points.is_empty() {
                return Err(StudyError::NoAnswer(format!("{key} = {value}: {reason}")));
            }
            header.warnings.push(format!(
                "{} values of {key} have no response, the first is {value}: {reason}",
                failures.len()
            ));
        }
        if points.is_empty() {
            return Err(StudyError::Interrupted);
        }
        if interrupted {
            header.warnings.push("interrupted".to_owned());
        }
        header.units.measures = Texts(
            points[0]
                .measures
                .iter()
                .map(|measure| (measure.name.clone(), measure.unit.to_owned()))
                .collect(),
        );
        Ok(DriveResponseDocument {
            header,
            parameter: VariedRow {
                key: key.to_owned(),
                unit: self.places.unit().to_owned(),
            },
            orders: at.excitation.orders().iter().map(|order| order.order).collect(),
            points,
        })
    }
}

/// One warning for all violations of a kind: where each happens first, and at how many values.
fn told(
    violations: &[(f64, Violation)],
    key: &str,
    what: &str,
    name_of: &dyn Fn(&Violation) -> Option<&String>,
) -> Option<String> {
    let mut places: Vec<(&String, f64, usize)> = Vec::new();
    for (value, violation) in violations {
        let Some(name) = name_of(violation) else {
            continue;
        };
        match places.iter_mut().find(|(known, _, _)| *known == name) {
            Some((_, _, count)) => *count += 1,
            None => places.push((name, *value, 1)),
        }
    }
    let list: Vec<String> = places
        .iter()
        .map(|(name, first, count)| format!("{name} ({count} values of {key}, from {first})"))
        .collect();
    (!list.is_empty()).then(|| format!("{what}: {}", list.join(", ")))
}

impl DriveResponse {
    fn row(
        &self,
        place: Place,
        value: f64,
        at: &InstalledDrive,
    ) -> Result<(ResponseRow, Vec<Violation>), StudyError> {
        let state = at.steady(at.driver_speed)?;
        let model = LinearModel::new(&at.drive, &state);
        let base = self.places.order_frequency(place, at);
        if base <= 0.0 {
            return Err(StudyError::NoAnswer(
                "at rest the excitation has no frequency".to_owned(),
            ));
        }
        let by_torque = matches!(at.excitation, Excitation::Torque(_));
        let mut motions = Vec::new();
        for order in at.excitation.orders() {
            let (amplitude, phase) = order.at(at.driver_speed);
            let amplitude = Complex::from_polar(amplitude, phase);
            let load = if by_torque {
                HarmonicLoad::DriverTorque(amplitude)
            } else {
                HarmonicLoad::DriverRotation(amplitude)
            };
            motions.push(forced_response(&at.drive, &model, order.order * base, load)?);
        }
        let orders: Vec<f64> = at.excitation.orders().iter().map(|order| order.order).collect();
        let reader = Reader {
            at,
            state: &state,
            model: &model,
            motions: &motions,
            times: times(&orders),
            orders,
        };
        let (measures, violations) = reader.measures();
        Ok((
            ResponseRow {
                value,
                speed: at.driver_speed / super::RPM,
                measures,
            },
            violations,
        ))
    }
}
