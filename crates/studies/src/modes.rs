//! `modes`: natural frequencies, damping, shapes and what moves, engaged and disengaged; over any key.

use crate::{Header, Method, Parameter, Range, Ratios, Signal, Study, StudyError, Subject};
use serde::Serialize;
use slackside_mechanics::{System, modes as linear_modes};

/// Values of a key without a step.
const USUAL_VALUES: usize = 101;

/// The question: the modes of a model, or over values of one of its keys.
#[derive(Debug, Clone)]
pub struct Modes {
    /// The model.
    pub subject: Subject,
    /// The key to vary, in SI units; none for the model as it is.
    pub over: Option<Range>,
    /// Frequency of the load in the user's unit, for matrices that depend on it.
    pub frequency: Option<f64>,
}

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct ModesDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// Modes of the model as it is, engaged ones first.
    pub modes: Vec<ModeRow>,
    /// Modes over the key.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub over: Vec<ModesAt>,
}

/// Modes at one value of the key.
#[derive(Debug, Clone, Serialize)]
pub struct ModesAt {
    /// The value.
    #[serde(flatten)]
    pub at: Parameter,
    /// The modes, engaged ones first.
    pub modes: Vec<ModeRow>,
}

/// One mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeRow {
    /// Undamped natural frequency in the user's unit; zero for a rigid-body mode.
    pub frequency: f64,
    /// The same in hertz, where the file has units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency_hz: Option<f64>,
    /// Modal damping ratio.
    pub damping_ratio: f64,
    /// `engaged` with every element linear, `disengaged` without the elements.
    pub kind: &'static str,
    /// Shape by coordinate, scaled to a modal mass of one.
    pub shape: Ratios,
    /// Share of each coordinate in the kinetic energy: `φ_i (M φ)_i`.
    pub shares: Ratios,
}

/// Modes engaged and, if the system has elements, disengaged.
///
/// # Errors
/// [`StudyError::Linalg`].
pub(crate) fn mode_rows(
    subject: &Subject,
    system: &System,
    frequency: f64,
) -> Result<Vec<ModeRow>, StudyError> {
    let mut rows = Vec::new();
    let kinds: &[(bool, &'static str)] = if system.elements.is_empty() {
        &[(true, "linear")]
    } else {
        &[(true, "engaged"), (false, "disengaged")]
    };
    for &(engaged, kind) in kinds {
        for mode in linear_modes(system, frequency, engaged)? {
            let momentum = system.mass.times(&mode.shape);
            let by_coordinate = |value: &dyn Fn(usize) -> f64| {
                Ratios(
                    system
                        .coordinates
                        .iter()
                        .enumerate()
                        .map(|(i, name)| (name.clone(), value(i)))
                        .collect(),
                )
            };
            let natural = subject.units.user_frequency(mode.frequency);
            rows.push(ModeRow {
                frequency: natural,
                frequency_hz: (subject.units.frequency == "Hz").then_some(natural),
                damping_ratio: mode.damping_ratio,
                kind,
                shape: by_coordinate(&|i| mode.shape[i]),
                shares: by_coordinate(&|i| mode.shape[i] * momentum[i]),
            });
        }
    }
    Ok(rows)
}

impl Modes {
    /// The frequency at which matrices are taken; it matters only to those that depend on it.
    fn angular_frequency(&self, subject: &Subject, system: &System) -> Result<f64, StudyError> {
        match subject.angular_frequency(self.frequency) {
            Ok(frequency) => Ok(frequency),
            Err(_) if self.frequency.is_none() && !system.is_frequency_dependent() => Ok(1.0),
            Err(error) => Err(error),
        }
    }

    fn rows_of(&self, subject: &Subject) -> Result<Vec<ModeRow>, StudyError> {
        let system = subject.system()?;
        let frequency = self.angular_frequency(subject, &system)?;
        mode_rows(subject, &system, frequency)
    }
}

impl Study for Modes {
    /// A value of the key; `None` for the model as it is.
    type Job = Option<f64>;
    type Rows = (Option<f64>, Vec<ModeRow>);
    type Document = ModesDocument;

    fn plan(&self) -> Result<Vec<Self::Job>, StudyError> {
        let mut jobs = vec![None];
        if let Some(range) = &self.over {
            if range.key == "frequency" {
                let system = self.subject.system()?;
                if !system.is_frequency_dependent() {
                    return Err(StudyError::question(
                        "--over",
                        "the natural frequencies do not depend on the frequency of the load; vary another key",
                    ));
                }
            } else {
                self.subject.model.number(&range.key)?;
            }
            jobs.extend(range.values(USUAL_VALUES).into_iter().map(Some));
        }
        Ok(jobs)
    }

    fn run(&self, job: &Self::Job, _: &Signal) -> Result<Self::Rows, StudyError> {
        let rows = match (job, &self.over) {
            (Some(value), Some(range)) if range.key == "frequency" => {
                let at = Self {
                    frequency: Some(*value),
                    ..self.clone()
                };
                at.rows_of(&self.subject)?
            }
            (Some(value), Some(range)) => self.rows_of(&self.subject.with_number(&range.key, *value)?)?,
            _ => self.rows_of(&self.subject)?,
        };
        Ok((*job, rows))
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Self::Rows, StudyError>>>,
        interrupted: bool,
    ) -> Result<Self::Document, StudyError> {
        let mut header = self.subject.header(
            "modes",
            Method::new("eigenvalues").with("scaling", "modal mass 1"),
        );
        let mut modes = Vec::new();
        let mut over = Vec::new();
        let key = self.over.as_ref().map_or("", |range| &range.key);
        for row in rows.into_iter().flatten() {
            match row? {
                (None, found) => modes = found,
                (Some(value), modes) => over.push(ModesAt {
                    at: Parameter {
                        key: key.to_owned(),
                        value,
                    },
                    modes,
                }),
            }
        }
        if modes.is_empty() {
            return Err(StudyError::Interrupted);
        }
        if interrupted {
            header.warnings.push("interrupted".to_owned());
        }
        Ok(ModesDocument { header, modes, over })
    }
}
