//! `modes` of a drive: natural frequencies, what moves, and the Campbell diagram over speed or any key.

use super::matrices::Matrices;
use super::steady::{SteadyDocument, SteadySheet, VariedRow};
use super::{Place, Places, RPM};
use crate::{Header, Method, Ratios, Signal, Study, StudyError, pair};
use serde::Serialize;
use slackside_belt_drive::drive::{BeltModel, Drive};
use slackside_belt_drive::model::{LinearModel, Motion};
use slackside_belt_drive::modes::{
    Campbell, CampbellPoint, Kind, LimitSpeed, Mode, SpeedLimit, campbell_point, damped_modes, limit_speed,
    track, undamped_modes,
};
use slackside_belt_drive::steady::SteadyState;
use slackside_belt_drive::strong_form::{Configuration, DriverMotion, StrongForm, StrongFormError};
use slackside_linalg::Complex;
use std::f64::consts::TAU;

/// Points along a span at which shapes are given.
const SHAPE_POINTS: usize = 33;
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

/// The answer; numbers in SI units, frequencies in Hz, speeds in rpm.
#[derive(Debug, Clone, Serialize)]
pub struct DriveModesDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// Speed of the driver at the operating point, rpm.
    pub speed: f64,
    /// `prescribed` or `free`.
    pub driver: &'static str,
    /// Modes at the operating point.
    pub modes: Vec<DriveModeRow>,
    /// Largest relative change of the frequencies of these modes when the number of sine terms of every span is doubled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convergence: Option<f64>,
    /// What varies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameter: Option<VariedRow>,
    /// Modes over the varied quantity, in the order of the curves.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub over: Vec<CampbellRow>,
    /// Where the lines of the excitation's orders meet natural frequencies; over speed only.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub resonances: Vec<ResonanceRow>,
    /// The speed beyond which there is no stable steady state, if it lies in the range that was looked at.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit_speed: Option<LimitRow>,
    /// The linear model at the operating point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matrices: Option<Matrices>,
    /// The steady sheet at the operating point, for drawings.
    #[serde(skip)]
    pub sheet: Box<SteadyDocument>,
}

/// A mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriveModeRow {
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// The same frequency from the strong form of the equations, without sine series.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strong_form_hz: Option<f64>,
    /// Damping ratio of the damped mode that goes with it.
    pub damping_ratio: f64,
    /// `rotation`, `arm`, `span <name>` or `mixed`.
    pub kind: String,
    /// Shares of the kinetic energy: `rotation.<pulley>`, `arm.<tensioner>`, `span.<span>`.
    pub shares: Ratios,
    /// Rotations of the pulleys, relative to the largest motion of the mode; complex.
    pub rotations: Vec<[f64; 2]>,
    /// Motions of the arms.
    pub arms: Vec<[f64; 2]>,
    /// Displacements across every span at equal distances, its ends included, along the left normal.
    pub spans: Vec<Vec<[f64; 2]>>,
}

/// The modes at one value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CampbellRow {
    /// The value.
    pub value: f64,
    /// Natural frequencies in the order of the curves, Hz.
    pub frequencies_hz: Vec<f64>,
    /// What they are.
    pub kinds: Vec<String>,
}

/// An order of the excitation meets a natural frequency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResonanceRow {
    /// The order.
    pub order: f64,
    /// Number of the curve, from 1.
    pub mode: usize,
    /// Speed of the driver, rpm.
    pub speed: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// What the mode is there.
    pub kind: String,
}

/// The end of the range of speeds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitRow {
    /// Largest driver speed with a stable steady state, rpm.
    pub speed: f64,
    /// What ends it.
    pub reason: String,
}

/// What one job gives.
pub enum Piece {
    /// The operating point.
    Here(Box<DriveModesDocument>),
    /// Another value, or why there are no modes.
    There(f64, Result<Box<CampbellPoint>, String>, Vec<String>),
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
            match point {
                Ok(point) => {
                    let kinds = point
                        .modes
                        .iter()
                        .map(|mode| kind_name(&at.drive, mode.kind))
                        .collect();
                    Ok((point, kinds))
                }
                Err(error) => Err(StudyError::NoAnswer(error.to_string())),
            }
        });
        match found {
            Ok((point, kinds)) => Ok(Piece::There(value, Ok(Box::new(point)), kinds)),
            Err(StudyError::NoAnswer(reason)) => Ok(Piece::There(value, Err(reason), Vec::new())),
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
                Piece::There(value, Ok(point), _) => found.push((value, *point)),
                Piece::There(value, Err(reason), _) => failures.push((value, reason)),
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
        let mut header = self.places.subject().header("modes", method);
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

fn resonances(drive: &Drive, campbell: &Campbell, orders: impl Iterator<Item = f64>) -> Vec<ResonanceRow> {
    let curves = campbell
        .points
        .iter()
        .map(|point| point.modes.len())
        .min()
        .unwrap_or(0);
    let mut rows = Vec::new();
    for order in orders {
        for curve in 0..curves {
            for speed in campbell.crossings(curve, order) {
                let nearest = campbell.points.iter().min_by(|a, b| {
                    (a.driver_speed - speed)
                        .abs()
                        .total_cmp(&(b.driver_speed - speed).abs())
                });
                let kind = nearest.map_or(Kind::Mixed, |point| point.modes[curve].kind);
                rows.push(ResonanceRow {
                    order,
                    mode: curve + 1,
                    speed: speed / RPM,
                    frequency_hz: order * speed / TAU,
                    kind: kind_name(drive, kind),
                });
            }
        }
    }
    rows.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    rows
}

/// The damping ratio of the damped mode that resembles an undamped one most: the nearest in frequency.
fn damping_ratio(damped: &[Mode], mode: &Mode) -> f64 {
    damped
        .iter()
        .filter(|candidate| candidate.damping_ratio < 1.0)
        .min_by(|a, b| {
            (a.frequency - mode.frequency)
                .abs()
                .total_cmp(&(b.frequency - mode.frequency).abs())
        })
        .map_or(0.0, |nearest| {
            // Without damping the general eigenvalue problem leaves rounding.
            if nearest.damping_ratio.abs() < 1e-11 {
                0.0
            } else {
                nearest.damping_ratio
            }
        })
}

/// `rotation`, `arm`, `span <name>` or `mixed`.
fn kind_name(drive: &Drive, kind: Kind) -> String {
    match kind {
        Kind::Rotation => "rotation".to_owned(),
        Kind::Arm => "arm".to_owned(),
        Kind::Span(span) => format!("span {}", drive.span_name(span)),
        Kind::Mixed => "mixed".to_owned(),
    }
}

fn mode_row(
    drive: &Drive,
    state: &SteadyState,
    model: &LinearModel,
    mode: &Mode,
    damping_ratio: f64,
) -> DriveModeRow {
    let motion = Motion {
        frequency: mode.frequency,
        amplitudes: mode.shape.clone(),
    };
    let points = |span: usize| {
        let length = state.layout.spans[span].length;
        let shape = model.span_motion(state, &motion, span);
        (0..SHAPE_POINTS)
            .map(|k| shape.at(length * k as f64 / (SHAPE_POINTS - 1) as f64))
            .collect::<Vec<_>>()
    };
    let spans: Vec<_> = (0..drive.pulleys.len()).map(points).collect();
    // Rotations count by the motion of the rim, arms by that of their pulley's centre.
    let rim = (0..drive.pulleys.len()).map(|j| mode.shape[j] * drive.pulleys[j].radius);
    let centre = (0..drive.tensioners.len()).map(|arm| {
        let reach = drive
            .carried_by(arm)
            .map(|j| state.kinematics.centre_rates[j][arm].length())
            .fold(0.0, f64::max);
        mode.shape[model.coordinates.arm(arm)] * reach
    });
    let largest = rim
        .chain(centre)
        .chain(spans.iter().flatten().copied())
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))
        .filter(|value| value.norm() > 0.0)
        .unwrap_or_else(|| Complex::new(1.0, 0.0));
    let relative = |value: &Complex| pair(&(value / largest));
    let mut shares: Vec<(String, f64)> = Vec::new();
    for (pulley, share) in drive.pulleys.iter().zip(&mode.shares.rotation) {
        shares.push((format!("rotation.{}", pulley.name), *share));
    }
    for (tensioner, share) in drive.tensioners.iter().zip(&mode.shares.arms) {
        shares.push((format!("arm.{}", tensioner.name), *share));
    }
    for (span, share) in mode.shares.spans.iter().enumerate() {
        shares.push((format!("span.{}", drive.span_name(span)), *share));
    }
    DriveModeRow {
        frequency_hz: mode.frequency / TAU,
        strong_form_hz: None,
        damping_ratio,
        kind: kind_name(drive, mode.kind),
        shares: Ratios(shares),
        rotations: (0..drive.pulleys.len())
            .map(|j| relative(&mode.shape[j]))
            .collect(),
        arms: (0..drive.tensioners.len())
            .map(|arm| relative(&mode.shape[model.coordinates.arm(arm)]))
            .collect(),
        spans: spans
            .iter()
            .map(|points| points.iter().map(relative).collect())
            .collect(),
    }
}
