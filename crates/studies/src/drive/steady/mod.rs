//! `check` of a drive: the steady sheet, and tensions over speed, load or any key in every condition of service.

mod document;
mod rows;

pub use document::{
    BeltRow, ConditionRow, FanRow, Outcome, PulleyRow, SpanRow, StateRow, SteadyCrossCheck, SteadyDocument,
    TensionerRow, VariedRow,
};

use super::{Place, Places, RPM};
use crate::{Header, Method, Signal, Study, StudyError};
use rows::{outcome, pulley_row, span_row, tensioner_row, units, warn};
use slackside_belt_drive::creep;
use slackside_belt_drive::drive::Condition;
use slackside_belt_drive::elastica::ElasticaState;

/// Wrap below which a warning is given if the file sets no limit, rad.
const SMALL_WRAP: f64 = 0.25;

/// The question.
#[derive(Debug, Clone)]
pub struct SteadySheet {
    /// Where.
    pub places: Places,
    /// Whether the operating point is computed a second time, by the geometrically exact belt.
    pub cross_check: bool,
}

/// What one job gives.
pub enum Piece {
    /// The sheet.
    Sheet(Box<SteadyDocument>),
    /// One value in all conditions.
    Value(f64, Vec<Outcome>),
}

impl Study for SteadySheet {
    type Job = Place;
    type Rows = Piece;
    type Document = SteadyDocument;

    fn plan(&self) -> Result<Vec<Place>, StudyError> {
        if self.places.key() == "frequency" {
            return Err(StudyError::question(
                "--over",
                "the steady state does not depend on a frequency; vary speed or a key of the file",
            ));
        }
        let mut jobs = vec![self.places.operating_point()];
        jobs.extend(self.places.values());
        Ok(jobs)
    }

    fn run(&self, job: &Place, _: &Signal) -> Result<Piece, StudyError> {
        match job.value {
            None => {
                let mut sheet = self.sheet(*job)?;
                if self.cross_check {
                    self.add_cross_check(*job, &mut sheet)?;
                }
                Ok(Piece::Sheet(Box::new(sheet)))
            }
            Some(value) => {
                let outcomes = match self.places.drive(*job) {
                    Ok(drive) => self
                        .conditions()
                        .iter()
                        .map(|condition| outcome(&drive, condition))
                        .collect(),
                    Err(error @ StudyError::NoAnswer(_)) => {
                        let impossible = Outcome::Impossible {
                            impossible: error.to_string(),
                        };
                        vec![impossible; self.conditions().len()]
                    }
                    Err(other) => return Err(other),
                };
                Ok(Piece::Value(value, outcomes))
            }
        }
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Piece, StudyError>>>,
        interrupted: bool,
    ) -> Result<SteadyDocument, StudyError> {
        let mut sheet = None;
        let mut fan: Vec<FanRow> = self
            .conditions()
            .into_iter()
            .map(|condition| FanRow {
                name: condition.name,
                values: Vec::new(),
                outcomes: Vec::new(),
            })
            .collect();
        for row in rows.into_iter().flatten() {
            match row? {
                Piece::Sheet(document) => sheet = Some(*document),
                Piece::Value(value, outcomes) => {
                    for (row, outcome) in fan.iter_mut().zip(outcomes) {
                        row.values.push(value);
                        row.outcomes.push(outcome);
                    }
                }
            }
        }
        let mut document = sheet.ok_or(StudyError::Interrupted)?;
        if self.places.over.is_some() {
            document.parameter = Some(VariedRow {
                key: self.places.key().to_owned(),
                unit: self.places.unit().to_owned(),
            });
            document.over = fan;
            document.warn_of_impossible();
        }
        if interrupted {
            document.header.warnings.push("interrupted".to_owned());
        }
        Ok(document)
    }
}

impl SteadySheet {
    /// The drive as installed, then the conditions of the file.
    fn conditions(&self) -> Vec<Condition> {
        let mut conditions = vec![Condition::nominal("as installed")];
        if let Some(file) = self.places.subject().model.drive() {
            conditions.extend(file.conditions());
        }
        conditions
    }

    /// Warns of wraps below the limit of the file.
    fn warn_of_wraps(&self, header: &mut Header, rows: &[PulleyRow]) {
        let Some(file) = self.places.subject().model.drive() else {
            return;
        };
        for (pulley, row) in file.pulleys.iter().zip(rows) {
            let limit = pulley.minimum_wrap.unwrap_or(SMALL_WRAP);
            if row.wrap < limit {
                header.warnings.push(format!(
                    "\"{}\": the belt wraps it by only {:.1}°, less than {:.1}°; move it or an idler beside it",
                    row.name,
                    row.wrap.to_degrees(),
                    limit.to_degrees()
                ));
            }
        }
    }

    fn add_cross_check(&self, place: Place, sheet: &mut SteadyDocument) -> Result<(), StudyError> {
        let at = self.places.drive(place)?;
        match ElasticaState::solve(&at.drive, at.driver_speed) {
            Ok(exact) => {
                let centrifugal = sheet.belt.centrifugal_tension;
                let differences = sheet
                    .spans
                    .iter()
                    .zip(&exact.spans)
                    .map(|(span, exact)| (span.effective_tension / exact.force - 1.0).abs());
                sheet.cross_check = Some(SteadyCrossCheck {
                    method: "geometrically exact belt with free contact points",
                    largest_difference: differences.fold(0.0, f64::max),
                    tensions: exact.spans.iter().map(|span| span.force + centrifugal).collect(),
                    positions: exact.positions,
                    wraps: exact.wraps,
                });
            }
            Err(error) => sheet
                .header
                .warnings
                .push(format!("no cross-check by the geometrically exact belt: {error}")),
        }
        Ok(())
    }

    /// The sheet at one place.
    ///
    /// # Errors
    /// [`StudyError`].
    pub(super) fn sheet(&self, place: Place) -> Result<SteadyDocument, StudyError> {
        let at = self.places.drive(place)?;
        let state = at.steady(at.driver_speed)?;
        let drive = &at.drive;
        let method = Method::new("steady state, Newton's iteration on the closed-form equilibrium")
            .with("belt_model", drive.belt.model.name())
            .with("span_ends", drive.belt.span_ends.name())
            .with("arc_stretch", drive.belt.arc_stretch.name());
        let mut header = self.places.subject().linear_header("check", method);
        header.units.measures = units();
        let creep = match creep::steady_creep(drive, &state) {
            Ok(creep) => Some(creep),
            Err(error) => {
                header.warnings.push(error.to_string());
                None
            }
        };
        let spans: Vec<SpanRow> = (0..drive.pulleys.len())
            .map(|i| span_row(&at, &state, i))
            .collect();
        let pulleys: Vec<PulleyRow> = (0..drive.pulleys.len())
            .map(|j| pulley_row(&at, &state, creep.as_ref(), j))
            .collect();
        warn(&mut header, &at, &spans, &pulleys);
        self.warn_of_wraps(&mut header, &pulleys);
        let conditions = self
            .conditions()
            .iter()
            .skip(1)
            .map(|condition| ConditionRow {
                name: condition.name.clone(),
                outcome: outcome(&at, condition),
            })
            .collect();
        Ok(SteadyDocument {
            header,
            kind: self.places.subject().model.kind(),
            speed: at.driver_speed / RPM,
            belt: BeltRow {
                pitch_length: state.layout.pitch_length,
                natural_length: state.natural_length,
                speed: state.belt_speed,
                centrifugal_tension: state.tensions[0] - state.effective_tensions[0],
            },
            spans,
            pulleys,
            tensioners: (0..drive.tensioners.len())
                .map(|arm| tensioner_row(&at, &state, arm))
                .collect(),
            driver_torque: state.driver_torque,
            efficiency: creep.and_then(|creep| creep.efficiency),
            cross_check: None,
            conditions,
            parameter: None,
            over: Vec::new(),
        })
    }
}
