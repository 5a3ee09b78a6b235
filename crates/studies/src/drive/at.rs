//! Where a drive is examined: at its operating point, or over speed, frequency or any key.

use super::{InstalledDrive, RPM};
use crate::{Range, StudyError, Subject};
use std::f64::consts::TAU;

/// Values of a range without a step.
const USUAL_VALUES: usize = 101;

/// One place at which a drive is examined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Value of the varied quantity in the user's unit; `None` at the operating point.
    pub value: Option<f64>,
}

/// The varied quantity of a drive: `speed` (rpm of the driver), `frequency` (Hz, of the lowest order of the excitation) or
/// any key of the file (SI units).
#[derive(Debug, Clone)]
pub struct Places {
    subject: Subject,
    /// Driver speed in rpm in place of the file's.
    speed: Option<f64>,
    /// What varies.
    pub over: Option<Range>,
}

impl Places {
    /// The operating point, at another driver speed (rpm) if one is given, and the values of a range.
    ///
    /// # Errors
    /// [`StudyError`] for a speed that is negative, or a range of an unknown key.
    pub fn new(subject: Subject, speed: Option<f64>, over: Option<Range>) -> Result<Self, StudyError> {
        if let Some(speed) = speed
            && !(speed >= 0.0 && speed.is_finite())
        {
            return Err(StudyError::question(
                "--speed",
                format!("the driver's speed must not be negative, but is {speed}"),
            ));
        }
        if let Some(range) = &over {
            match &*range.key {
                "speed" if speed.is_some() => {
                    return Err(StudyError::question(
                        "--speed",
                        "the speed is varied by --over; leave --speed out",
                    ));
                }
                "speed" | "frequency" if range.from < 0.0 => {
                    return Err(StudyError::question(
                        "--over",
                        format!("the {} must not be negative", range.key),
                    ));
                }
                "speed" | "frequency" => {}
                key => {
                    subject.model.number(key)?;
                }
            }
        }
        Ok(Self { subject, speed, over })
    }

    /// The model and where it comes from.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Name of the varied quantity; empty at the operating point.
    pub fn key(&self) -> &str {
        self.over.as_ref().map_or("", |range| &range.key)
    }

    /// Unit of the varied quantity.
    pub fn unit(&self) -> &'static str {
        match self.key() {
            "speed" => "rpm",
            "frequency" => "Hz",
            "" => "",
            _ => "SI",
        }
    }

    /// The operating point.
    pub fn operating_point(&self) -> Place {
        Place { value: None }
    }

    /// The values of the range.
    pub fn values(&self) -> Vec<Place> {
        let values = self
            .over
            .as_ref()
            .map_or(Vec::new(), |range| range.values(USUAL_VALUES));
        values
            .into_iter()
            .map(|value| Place { value: Some(value) })
            .collect()
    }

    /// The drive at a place, running at its speed.
    ///
    /// # Errors
    /// [`StudyError`] if the value makes no sound drive or its installation is impossible.
    pub fn drive(&self, place: Place) -> Result<InstalledDrive, StudyError> {
        let mut drive = match (place.value, self.key()) {
            (Some(value), key) if key != "speed" && key != "frequency" => {
                InstalledDrive::new(&self.subject.with_number(key, value)?)?
            }
            _ => InstalledDrive::new(&self.subject)?,
        };
        if let Some(speed) = self.speed {
            drive.driver_speed = speed * RPM;
        }
        if let (Some(value), "speed") = (place.value, self.key()) {
            drive.driver_speed = value * RPM;
        }
        Ok(drive)
    }

    /// Angular frequency of order 1 at a place, rad/s: the driver's speed, or what makes the lowest order of the excitation
    /// have the frequency that is varied.
    pub fn order_frequency(&self, place: Place, drive: &InstalledDrive) -> f64 {
        match (place.value, self.key()) {
            (Some(value), "frequency") => {
                let lowest = drive
                    .excitation
                    .orders()
                    .iter()
                    .map(|order| order.order)
                    .fold(f64::INFINITY, f64::min);
                TAU * value / lowest
            }
            _ => drive.driver_speed,
        }
    }
}
