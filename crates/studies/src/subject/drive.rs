//! Drives as subjects of studies of motions: at one operating point, over speed, over frequency, over any key.

use super::{Quantity, Subject};
use crate::StudyError;
use crate::drive::running::{RunningDrive, radians_per_hertz};
use crate::drive::{InstalledDrive, RPM};
use slackside_belt_drive::system::{
    CommonOrder, DriveSpeedFamily, DriveSystemError, ExcitationFrequencyFamily,
};
use slackside_mechanics::{OperatingPoint, OutsideDomain, SystemFamily};
use std::sync::Arc;

impl From<DriveSystemError> for StudyError {
    fn from(error: DriveSystemError) -> Self {
        match error {
            DriveSystemError::Linalg(error) => Self::Linalg(error),
            input => Self::question("FILE", input.to_string()),
        }
    }
}

/// The drive at the subject's speed.
fn installed(subject: &Subject) -> Result<InstalledDrive, StudyError> {
    let mut drive = InstalledDrive::new(subject)?;
    drive.driver_speed = subject.driver_speed.unwrap_or(drive.driver_speed);
    Ok(drive)
}

/// System and frequency, with the lowest order of the excitation at this frequency (Hz) if one is given. Measures are totals,
/// as those of the steady sheet and of the linear response.
pub(super) fn operating_point(
    subject: &Subject,
    frequency: Option<f64>,
) -> Result<OperatingPoint, StudyError> {
    Ok(RunningDrive::new(subject, frequency)?
        .system
        .into_operating_point())
}

pub(super) fn measure_units(subject: &Subject) -> Vec<(String, String)> {
    let Ok(found) = RunningDrive::new(subject, None).map(|running| running.system) else {
        return Vec::new();
    };
    let outputs = found.system.outputs.iter().zip(&found.measures);
    outputs
        .map(|(output, measure)| (output.name.clone(), measure.unit.to_owned()))
        .collect()
}

pub(super) fn quantity(subject: &Subject, key: &str, frequency: Option<f64>) -> Result<Quantity, StudyError> {
    let varied = |option: &str, what: &str| {
        Err(StudyError::question(
            option,
            format!("the {what} is varied by --over; leave {option} out"),
        ))
    };
    match key {
        "speed" if frequency.is_some() => varied("--frequency", "frequency with the speed"),
        "speed" | "operating.speed" if subject.driver_speed.is_some() => varied("--speed", "speed"),
        "frequency" if frequency.is_some() => varied("--frequency", "frequency"),
        "speed" => {
            let drive = installed(subject)?;
            CommonOrder::of(&drive.excitation)?;
            Ok(Quantity {
                key: "speed".to_owned(),
                unit: "rpm".to_owned(),
                factor: RPM,
                family: Arc::new(DriveSpeedFamily {
                    drive: drive.drive,
                    installed: drive.installed,
                    excitation: drive.excitation,
                }),
            })
        }
        "frequency" => {
            let drive = installed(subject)?;
            Ok(Quantity {
                key: "frequency".to_owned(),
                unit: "Hz".to_owned(),
                factor: radians_per_hertz(&drive.excitation)?,
                family: Arc::new(ExcitationFrequencyFamily {
                    steady: drive.steady(drive.driver_speed)?,
                    drive: drive.drive,
                    excitation: drive.excitation,
                }),
            })
        }
        key => {
            subject.model.number(key)?;
            Ok(Quantity {
                key: key.to_owned(),
                unit: "SI".to_owned(),
                factor: 1.0,
                family: Arc::new(DriveKeyFamily {
                    subject: subject.clone(),
                    key: key.to_owned(),
                    frequency,
                }),
            })
        }
    }
}

/// A drive of which one number varies, at its speed.
#[derive(Debug, Clone)]
struct DriveKeyFamily {
    subject: Subject,
    key: String,
    /// Frequency of the lowest order, Hz, if the speed does not give it.
    frequency: Option<f64>,
}

impl SystemFamily for DriveKeyFamily {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        self.subject
            .with_number(&self.key, parameter)
            .and_then(|subject| operating_point(&subject, self.frequency))
            .map_err(|error| OutsideDomain(error.to_string()))
    }

    fn is_frequency(&self) -> bool {
        false
    }
}
