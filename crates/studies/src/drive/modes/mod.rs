//! `modes` of a drive: natural frequencies, what moves, and the Campbell diagram over speed or any key.

mod document;
mod rows;

pub use document::{CampbellRow, DriveModeRow, DriveModesDocument, LimitRow, ResonanceRow};

use super::matrices::Matrices;
use super::steady::{SteadySheet, VariedRow};
use super::{Place, Places, RPM};
use crate::{Method, Signal, Study, StudyError};
use rows::{damping_ratio, kind_name, mode_row, resonances};
use slackside_belt_drive::drive::{BeltModel, Drive};
use slackside_belt_drive::model::LinearModel;
use slackside_belt_drive::modes::{
    CampbellPoint, LimitSpeed, Mode, SpeedLimit, campbell_point, damped_modes, limit_speed, track,
    undamped_modes,
};
use slackside_belt_drive::steady::SteadyState;
use slackside_belt_drive::strong_form::{Configuration, DriverMotion, StrongForm, StrongFormError};
use slackside_linalg::Complex;
use std::f64::consts::TAU;

/// Steps in which speeds are looked through for the end of stability.
const LIMIT_STEPS: usize = 60;

/// The question.
#[derive(Debug, Clone)]
pub struct DriveModes {
    /// Where.
    pub places: Places,
    /// How many of the lowest modes.
    pub count: usize,
    /// Whether the driver turns freely with its inertia instead of at a prescribed speed.
    pub driver_is_free: bool,
    /// Highest speed (rpm) up to which the end of stability is sought; none seeks it up to the end of the range.
    pub limit: Option<f64>,
    /// Whether the frequencies at the operating point are computed a second time, from the strong form.
    pub cross_check: bool,
    /// Whether the answer holds the matrices at the operating point.
    pub matrices: bool,
}

/// What one job gives.
pub enum Piece {
    /// The operating point.
    Here(Box<DriveModesDocument>),
    /// Another value, or why there are no modes.
    There(f64, Result<Box<CampbellPoint>, String>),
}

impl Study for DriveModes {
    type Job = Place;
    type Rows = Piece;
    type Document = DriveModesDocument;

    fn plan(&self) -> Result<Vec<Place>, StudyError> {
        if self.places.key() == "frequency" {
            return Err(StudyError::question(
                "--over",
                "natural frequencies do not depend on the frequency of the excitation; vary speed or a key of the file",
            ));
        }
        let mut jobs = vec![self.places.operating_point()];
        jobs.extend(self.places.values());
        Ok(jobs)
    }

    fn run(&self, job: &Place, _: &Signal) -> Result<Piece, StudyError> {
        let Some(value) = job.value else {
            return Ok(Piece::Here(Box::new(self.here(*job)?)));
        };
        let found = self.places.drive(*job).and_then(|at| {
            let point = campbell_point(
                &at.drive,
                &at.installed,
                at.driver_speed,
                self.driver_is_free,
                self.count,
            );
            point.map_err(|error| StudyError::NoAnswer(error.to_string()))
        });
        match found {
            Ok(point) => Ok(Piece::There(value, Ok(Box::new(point)))),
            Err(StudyError::NoAnswer(reason)) => Ok(Piece::There(value, Err(reason))),
            Err(other) => Err(other),
        }
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Piece, StudyError>>>,
        interrupted: bool,
    ) -> Result<DriveModesDocument, StudyError> {
        let mut here = None;
        let mut found = Vec::new();
        let mut failures = Vec::new();
        for row in rows.into_iter().flatten() {
            match row? {
                Piece::Here(document) => here = Some(*document),
                Piece::There(value, Ok(point)) => found.push((value, *point)),
                Piece::There(value, Err(reason)) => failures.push((value, reason)),
            }
        }
        let mut document = here.ok_or(StudyError::Interrupted)?;
        if let Some((value, reason)) = failures.first() {
            document.header.warnings.push(format!(
                "{} values of {} have no modes, the first is {value}: {reason}",
                failures.len(),
                self.places.key()
            ));
        }
        if self.places.over.is_some() {
            self.add_campbell(&mut document, found)?;
        }
        if interrupted {
            document.header.warnings.push("interrupted".to_owned());
        }
        Ok(document)
    }
}

impl DriveModes {
    fn here(&self, place: Place) -> Result<DriveModesDocument, StudyError> {
        let at = self.places.drive(place)?;
        let state = at.steady(at.driver_speed)?;
        let model = LinearModel::new(&at.drive, &state);
        let mut undamped = undamped_modes(&at.drive, &model, self.driver_is_free)?;
        let damped = damped_modes(&at.drive, &model, self.driver_is_free)?;
        undamped.truncate(self.count);
        let mut modes: Vec<DriveModeRow> = undamped
            .iter()
            .map(|mode| mode_row(&at.drive, &state, &model, mode, damping_ratio(&damped, mode)))
            .collect();
        let method = Method::new("eigenvalues of the linear model")
            .with("belt_model", at.drive.belt.model.name())
            .with("terms_per_span", at.drive.belt.terms.clone())
            .with("static_correction", at.drive.belt.static_correction);
        let mut header = self.places.subject().linear_header("modes", method);
        if let Some(mode) = damped.iter().find(|mode| mode.damping_ratio < -1e-9) {
            header.warnings.push(format!(
                "the damped mode at {:.4} Hz grows: its damping ratio is {:.2e}",
                mode.frequency / TAU,
                mode.damping_ratio
            ));
        }
        let sheet = SteadySheet {
            places: self.places.clone(),
            cross_check: false,
        };
        if self.cross_check
            && let Err(reason) = self.add_strong_form(&at.drive, &state, &mut modes)
        {
            header
                .warnings
                .push(format!("no cross-check by the strong form: {reason}"));
        }
        Ok(DriveModesDocument {
            matrices: self.matrices.then(|| Matrices::new(&at.drive, &state, &model)),
            sheet: Box::new(sheet.sheet(place)?),
            header,
            speed: at.driver_speed / RPM,
            driver: if self.driver_is_free { "free" } else { "prescribed" },
            convergence: self.convergence(&at.drive, &state, &undamped)?,
            modes,
            parameter: None,
            over: Vec::new(),
            resonances: Vec::new(),
            limit_speed: self.limit_row(&at.drive, &at.installed, at.driver_speed),
        })
    }

    /// Frequencies of the same modes from the transcendental eigenvalue problem (theory 04 §4.6).
    fn add_strong_form(
        &self,
        drive: &Drive,
        state: &SteadyState,
        modes: &mut [DriveModeRow],
    ) -> Result<(), StrongFormError> {
        let undamped = drive.undamped();
        let configuration = Configuration {
            driver: if self.driver_is_free {
                DriverMotion::Free
            } else {
                DriverMotion::Prescribed
            },
            ..Configuration::default()
        };
        let form = StrongForm::new(&undamped, state, configuration)?;
        for mode in modes.iter_mut().filter(|mode| mode.frequency_hz > 0.0) {
            let estimate = Complex::new(TAU * mode.frequency_hz, 0.0);
            mode.strong_form_hz = Some(form.natural_motion(estimate)?.frequency.re / TAU);
        }
        Ok(())
    }

    /// Largest relative change of the frequencies with twice the terms (theory 04 §7).
    fn convergence(
        &self,
        drive: &Drive,
        state: &SteadyState,
        modes: &[Mode],
    ) -> Result<Option<f64>, StudyError> {
        if drive.belt.model == BeltModel::Spring {
            return Ok(None);
        }
        let mut finer = drive.clone();
        for terms in &mut finer.belt.terms {
            *terms *= 2;
        }
        let fine = undamped_modes(&finer, &LinearModel::new(&finer, state), self.driver_is_free)?;
        let change = modes
            .iter()
            .zip(&fine)
            .filter(|(mode, _)| mode.frequency > 0.0)
            .map(|(mode, finer)| (mode.frequency / finer.frequency - 1.0).abs())
            .fold(0.0, f64::max);
        Ok(Some(change))
    }

    fn limit_row(
        &self,
        drive: &Drive,
        installed: &slackside_belt_drive::steady::Installed,
        driver_speed: f64,
    ) -> Option<LimitRow> {
        let in_range = match &self.places.over {
            Some(range) if range.key == "speed" => range.to * RPM,
            _ => driver_speed,
        };
        let highest = self.limit.map_or(in_range, |limit| limit * RPM);
        let LimitSpeed { driver_speed, limit } = limit_speed(drive, installed, highest, LIMIT_STEPS)?;
        Some(LimitRow {
            speed: driver_speed / RPM,
            reason: match limit {
                SpeedLimit::Divergence => {
                    "divergence: the stiffness matrix loses its definiteness".to_owned()
                }
                SpeedLimit::NoSteadyState(error) => error.to_string(),
            },
        })
    }

    fn add_campbell(
        &self,
        document: &mut DriveModesDocument,
        found: Vec<(f64, CampbellPoint)>,
    ) -> Result<(), StudyError> {
        let at = self.places.drive(self.places.operating_point())?;
        let (values, points): (Vec<f64>, Vec<CampbellPoint>) = found.into_iter().unzip();
        let campbell = track(points);
        document.over = values
            .iter()
            .zip(&campbell.points)
            .map(|(value, point)| CampbellRow {
                value: *value,
                frequencies_hz: point.modes.iter().map(|mode| mode.frequency / TAU).collect(),
                kinds: point
                    .modes
                    .iter()
                    .map(|mode| kind_name(&at.drive, mode.kind))
                    .collect(),
            })
            .collect();
        document.parameter = Some(VariedRow {
            key: self.places.key().to_owned(),
            unit: self.places.unit().to_owned(),
        });
        if self.places.key() == "speed" {
            let orders = at.excitation.orders();
            document.resonances = resonances(&at.drive, &campbell, orders.iter().map(|order| order.order));
        }
        Ok(())
    }
}
