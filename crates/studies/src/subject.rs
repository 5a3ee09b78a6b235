//! What is studied: a model, where it comes from, and the quantity that a study varies.

mod drive;

use crate::document::Input;
use crate::drive::RPM;
use crate::{Header, Method, StudyError, UnitLabels};
use slackside_mechanics::{FrequencyFamily, OperatingPoint, Output, OutsideDomain, System, SystemFamily};
use slackside_model_file::{Document, Model, Scope, Units};
use std::sync::Arc;

/// A model and where it comes from.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The model.
    pub model: Model,
    /// File, overrides and check sum.
    pub input: Input,
    /// Units of results.
    pub units: Units,
    /// Remarks on the model.
    pub warnings: Vec<String>,
    /// Remarks on what the linear model of a drive leaves out or holds fixed.
    pub linear_warnings: Vec<String>,
    /// Remarks on what motions of a drive leave out.
    pub motion_warnings: Vec<String>,
    /// Speed of a drive's driver (rad/s) in place of the file's; it leaves the installation as the file has it.
    pub driver_speed: Option<f64>,
}

impl Subject {
    /// The model of a file with its overrides.
    ///
    /// # Errors
    /// [`StudyError::Model`] for the first mistake in the file.
    pub fn new(document: &Document) -> Result<Self, StudyError> {
        let (model, warnings) = document.model()?;
        let of = |scope: Scope| {
            let said = warnings.iter().filter(|warning| warning.scope == scope);
            said.map(ToString::to_string).collect()
        };
        Ok(Self {
            input: Input {
                file: document.source_name().to_owned(),
                sha256: model.sha256(),
                name: model.name().map(str::to_owned),
                settings: document.settings().to_vec(),
            },
            units: model.units(),
            warnings: of(Scope::Model),
            linear_warnings: of(Scope::LinearModel),
            motion_warnings: of(Scope::Motions),
            driver_speed: None,
            model,
        })
    }

    /// The same subject with another value of one of its numbers (in SI units).
    ///
    /// # Errors
    /// [`StudyError::Model`] if there is no such number or the value is not sound.
    pub fn with_number(&self, key: &str, value: f64) -> Result<Self, StudyError> {
        Ok(Self {
            model: self.model.with_number(key, value)?,
            ..self.clone()
        })
    }

    /// The same subject with the driver of a drive at another speed, in rpm.
    ///
    /// # Errors
    /// [`StudyError::Question`] if the model is no drive or the speed is not positive.
    pub fn at_speed(&self, speed: f64) -> Result<Self, StudyError> {
        if self.model.drive().is_none() {
            return Err(StudyError::question(
                "--speed",
                "only a model of kind \"drive\" has this option",
            ));
        }
        if !(speed > 0.0 && speed.is_finite()) {
            return Err(StudyError::question(
                "--speed",
                format!("the driver's speed must be positive, but is {speed}"),
            ));
        }
        Ok(Self {
            driver_speed: Some(speed * RPM),
            ..self.clone()
        })
    }

    /// The head of a result document about motions.
    pub fn header(&self, command: &str, method: Method) -> Header {
        let remarks = self.warnings.iter().chain(&self.motion_warnings);
        self.header_with(
            remarks,
            UnitLabels::new(self.units, self.measure_units()),
            (command, method),
        )
    }

    /// The head of a result document about the steady state or the linear model of a drive, whose measures the study
    /// knows.
    pub fn linear_header(&self, command: &str, method: Method) -> Header {
        let remarks = self.warnings.iter().chain(&self.linear_warnings);
        self.header_with(
            remarks,
            UnitLabels::new(self.units, Vec::new()),
            (command, method),
        )
    }

    fn header_with<'a>(
        &self,
        warnings: impl Iterator<Item = &'a String>,
        units: UnitLabels,
        (command, method): (&str, Method),
    ) -> Header {
        Header {
            slackside: env!("CARGO_PKG_VERSION").to_owned(),
            command: command.to_owned(),
            input: self.input.clone(),
            method,
            units,
            warnings: warnings.cloned().collect(),
        }
    }

    /// The unit of each measure.
    fn measure_units(&self) -> Vec<(String, String)> {
        if self.model.drive().is_some() {
            return drive::measure_units(self);
        }
        let Ok(system) = self.model.system() else {
            return Vec::new();
        };
        let outputs = system.outputs.iter();
        outputs
            .map(|output| (output.name.clone(), self.measure_unit(output)))
            .collect()
    }

    /// The unit of a measure: of a coordinate, a rate or a force; none for a mixture with factors of the file.
    fn measure_unit(&self, output: &Output) -> String {
        let is_torque = match &self.model {
            Model::TwoPulleyClutch(_) => output.name.ends_with("torque"),
            Model::Drive(_) | Model::MechanicalSystem(_) => {
                output.displacement.is_empty() && output.velocity.is_empty()
            }
        };
        if is_torque {
            return self.units.torque.to_owned();
        }
        match (output.velocity.is_empty(), output.displacement.is_empty()) {
            (true, _) => self.units.angle.to_owned(),
            (false, true) if self.units == Units::PHYSICAL => "rad/s".to_owned(),
            (false, true) => self.units.angle.to_owned(),
            (false, false) => String::new(),
        }
    }

    /// The equations of motion; of a drive those at its speed.
    ///
    /// # Errors
    /// [`StudyError::Model`]; of a drive also [`StudyError::NoAnswer`] if it has no steady state.
    pub fn system(&self) -> Result<Arc<System>, StudyError> {
        if self.model.drive().is_some() {
            return Ok(drive::operating_point(self, None)?.system);
        }
        Ok(Arc::new(self.model.system()?))
    }

    /// The excitation's angular frequency: the one given in the user's unit, otherwise that of the file.
    ///
    /// # Errors
    /// [`StudyError::Question`] if there is neither, or it is not positive.
    pub fn angular_frequency(&self, frequency: Option<f64>) -> Result<f64, StudyError> {
        match frequency {
            Some(value) if value.is_finite() && value > 0.0 => Ok(self.units.angular_frequency(value)),
            Some(value) => Err(StudyError::question(
                "--frequency",
                format!("the frequency must be positive, but is {value}"),
            )),
            None => self.model.frequency().ok_or_else(|| {
                StudyError::question(
                    "--frequency",
                    "the excitation's frequency is not known; give --frequency",
                )
            }),
        }
    }

    /// The system and its frequency.
    ///
    /// # Errors
    /// As [`Self::angular_frequency`] and [`Self::system`].
    pub fn operating_point(&self, frequency: Option<f64>) -> Result<OperatingPoint, StudyError> {
        if self.model.drive().is_some() {
            let point = drive::operating_point(self, frequency)?;
            crate::check_period(&point.system, point.frequency, "--speed")?;
            return Ok(point);
        }
        let point = OperatingPoint {
            frequency: self.angular_frequency(frequency)?,
            system: self.system()?,
        };
        crate::check_period(&point.system, point.frequency, "--frequency")?;
        Ok(point)
    }

    /// The quantity that a study varies: `frequency`, or a key that holds a number, at the given frequency (user's unit;
    /// the file's if there is none). Of a drive also `speed` (rpm of the driver), which everything follows; its
    /// `frequency` (Hz) is that of the lowest order of the excitation, at the steady state of one speed.
    ///
    /// # Errors
    /// [`StudyError`] if there is no such number or, for a key, no frequency.
    pub fn quantity(&self, key: &str, frequency: Option<f64>) -> Result<Quantity, StudyError> {
        if self.model.drive().is_some() {
            return drive::quantity(self, key, frequency);
        }
        if key == "frequency" || key == "excitation.frequency" {
            if frequency.is_some() {
                return Err(StudyError::question(
                    "--frequency",
                    "the frequency is varied by --over; leave --frequency out",
                ));
            }
            return Ok(Quantity {
                key: "frequency".to_owned(),
                unit: self.units.frequency.to_owned(),
                factor: self.units.radians_per_frequency,
                family: Arc::new(FrequencyFamily::new(self.system()?)),
            });
        }
        self.model.number(key)?;
        Ok(Quantity {
            key: key.to_owned(),
            unit: match self.units {
                Units::DIMENSIONLESS => "–",
                Units::PHYSICAL => "SI",
                _ => "",
            }
            .to_owned(),
            factor: 1.0,
            family: Arc::new(KeyFamily {
                model: self.model.clone(),
                key: key.to_owned(),
                frequency: self.angular_frequency(frequency)?,
            }),
        })
    }
}

/// A quantity that a study varies.
#[derive(Clone)]
pub struct Quantity {
    /// `frequency`, or a key of the model.
    pub key: String,
    /// Unit in which users give and read values.
    pub unit: String,
    /// The family's parameter per user's unit.
    factor: f64,
    /// The systems over the quantity.
    pub family: Arc<dyn SystemFamily>,
}

impl Quantity {
    /// The family's parameter, from the user's unit.
    pub fn parameter(&self, value: f64) -> f64 {
        value * self.factor
    }

    /// The value in the user's unit, from the family's parameter.
    pub fn value(&self, parameter: f64) -> f64 {
        parameter / self.factor
    }

    /// Whether it is the frequency of the load.
    pub fn is_frequency(&self) -> bool {
        self.family.is_frequency()
    }
}

/// A model whose number under `key` varies at a fixed frequency of the load.
#[derive(Debug, Clone)]
pub struct KeyFamily {
    model: Model,
    key: String,
    frequency: f64,
}

impl SystemFamily for KeyFamily {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        let system = self
            .model
            .with_number(&self.key, parameter)
            .and_then(|model| model.system())
            .map_err(|error| OutsideDomain(error.to_string()))?;
        Ok(OperatingPoint {
            system: Arc::new(system),
            frequency: self.frequency,
        })
    }

    fn is_frequency(&self) -> bool {
        false
    }
}
