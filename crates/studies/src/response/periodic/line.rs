//! Operating points along the varied quantity.

use crate::drive::running::RunningDrive;
use crate::drive::trust::Belt;
use crate::{Quantity, StudyError, Subject};
use slackside_mechanics::{OperatingPoint, Output};

/// A subject along a quantity.
pub(crate) struct Line {
    subject: Subject,
    /// The quantity.
    pub quantity: Quantity,
    frequency: Option<f64>,
}

/// An operating point.
pub(crate) struct Station {
    /// System and frequency. Measures of a drive are totals, steady value and motion together.
    pub point: OperatingPoint,
    /// Steady values of the measures, by name; empty if the model is no drive.
    pub steady: Vec<(String, f64)>,
    /// What tells whether a drive's belt holds; `None` if the model is no drive.
    pub belt: Option<Belt>,
}

impl Line {
    /// The subject along a key, at a frequency (user's unit) if one is given.
    ///
    /// # Errors
    /// [`StudyError`] as [`Subject::quantity`].
    pub fn new(subject: &Subject, key: &str, frequency: Option<f64>) -> Result<Self, StudyError> {
        Ok(Self {
            quantity: subject.quantity(key, frequency)?,
            subject: subject.clone(),
            frequency,
        })
    }

    /// The operating point at a value (user's unit).
    ///
    /// # Errors
    /// [`StudyError`] if there is none.
    pub fn at(&self, value: f64) -> Result<Station, StudyError> {
        if self.subject.model.drive().is_none() {
            return Ok(Station {
                point: self.quantity.family.at(self.quantity.parameter(value))?,
                steady: Vec::new(),
                belt: None,
            });
        }
        let running = match self.quantity.key.as_str() {
            "speed" => RunningDrive::new(&self.subject.at_speed(value)?, None),
            "frequency" => RunningDrive::new(&self.subject, Some(value)),
            key => RunningDrive::new(&self.subject.with_number(key, value)?, self.frequency),
        }?;
        let belt = Belt::new(&running);
        let found = running.system;
        let names = found.system.outputs.iter().map(|output| output.name.clone());
        let steady = names.zip(found.measures.iter().map(|measure| measure.steady));
        Ok(Station {
            steady: steady.filter(|(_, value)| *value != 0.0).collect(),
            point: found.into_operating_point(),
            belt: Some(belt),
        })
    }
}

impl Station {
    /// The measures that are recorded.
    pub fn outputs(&self) -> &[Output] {
        &self.point.system.outputs
    }
}
