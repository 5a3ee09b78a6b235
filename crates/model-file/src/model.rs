//! The model that a file describes, of one kind or another.

use schemars::JsonSchema;
use serde::Serialize;
use sha2::{Digest, Sha256};
use slackside_mechanics::System;

use crate::drive::Drive;
use crate::error::{Issue, ModelFileError, Problem};
use crate::mechanical_system::MechanicalSystem;
use crate::nearest::{enumerate, nearest};
use crate::node::Node;
use crate::reader::{Read, read_text, unknown_choice};
use crate::scalar::Numbers;
use crate::two_pulley_clutch::{Parameters, TwoPulleyClutch};
use crate::units_of_results::Units;

/// A model. One that comes from [`crate::Document::model`] or [`Model::with_number`] is sound: every value has passed the
/// checks of its kind.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Model {
    /// The two-pulley system with a wrap-spring one-way clutch.
    TwoPulleyClutch(TwoPulleyClutch),
    /// A serpentine belt drive.
    Drive(Box<Drive>),
    /// A system given by its matrices and elements.
    MechanicalSystem(Box<MechanicalSystem>),
}

/// Words of `kind`.
const KINDS: [&str; 3] = ["two-pulley-clutch", "drive", "mechanical-system"];

impl Model {
    pub(crate) fn read(document: &Node) -> Read<Self> {
        let Some(kind) = document.child("kind") else {
            return Err(Issue::new(
                Problem::MissingKey,
                "kind",
                "the file does not say what it describes",
            )
            .at(&document.origin)
            .with_help(format!(
                "add a line `kind = \"…\"`; known are {}",
                enumerate(KINDS)
            )));
        };
        match read_text(kind, "kind")? {
            "two-pulley-clutch" => TwoPulleyClutch::read(document).map(Self::TwoPulleyClutch),
            "drive" => Drive::read(document).map(|model| Self::Drive(Box::new(model))),
            "mechanical-system" => {
                MechanicalSystem::read(document).map(|model| Self::MechanicalSystem(Box::new(model)))
            }
            unknown => Err(unknown_choice(
                kind,
                "kind",
                "kind of model",
                unknown,
                KINDS.into_iter(),
            )),
        }
    }

    pub(crate) fn check(&self) -> Read<()> {
        match self {
            Self::TwoPulleyClutch(model) => model.check(),
            Self::Drive(model) => model.check(),
            Self::MechanicalSystem(model) => model.check(),
        }
    }

    /// Checks that a belt can follow the pulleys. Left out of [`Model::with_number`], where speed counts and the mechanics
    /// find the same.
    pub(crate) fn check_layout(&self) -> Read<()> {
        match self {
            Self::Drive(model) => model.convert().map(|_| ()),
            Self::TwoPulleyClutch(_) | Self::MechanicalSystem(_) => Ok(()),
        }
    }

    /// Key and message of everything that may surprise.
    pub(crate) fn cautions(&self) -> Vec<(String, String)> {
        match self {
            Self::TwoPulleyClutch(model) => model.cautions(),
            Self::Drive(model) => model.cautions(),
            Self::MechanicalSystem(model) => model.cautions(),
        }
    }

    /// Key and message of what the linear model leaves out or holds fixed.
    pub(crate) fn cautions_of_linear_model(&self) -> Vec<(String, String)> {
        self.drive().map_or(Vec::new(), Drive::cautions_of_linear_model)
    }

    /// Key and message of what motions leave out.
    pub(crate) fn cautions_of_motions(&self) -> Vec<(String, String)> {
        self.drive().map_or(Vec::new(), Drive::cautions_of_motions)
    }

    /// The word of `kind`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::TwoPulleyClutch(_) => KINDS[0],
            Self::Drive(_) => KINDS[1],
            Self::MechanicalSystem(_) => KINDS[2],
        }
    }

    /// The model's short name, if it has one.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::TwoPulleyClutch(model) => model.name.as_deref(),
            Self::Drive(model) => model.name.as_deref(),
            Self::MechanicalSystem(model) => model.name.as_deref(),
        }
    }

    /// The drive, if the file describes one.
    pub fn drive(&self) -> Option<&Drive> {
        match self {
            Self::Drive(drive) => Some(drive),
            Self::TwoPulleyClutch(_) | Self::MechanicalSystem(_) => None,
        }
    }

    /// Names of the coordinates, in the order of the state; of a drive, those of pulleys and tensioners.
    pub fn coordinates(&self) -> Vec<&str> {
        match self {
            Self::TwoPulleyClutch(_) => vec!["pulley", "accessory"],
            Self::Drive(model) => model.coordinates(),
            Self::MechanicalSystem(model) => model.coordinates.iter().map(String::as_str).collect(),
        }
    }

    /// The excitation's angular frequency that the file gives, in radians per unit of time; of a drive, the fundamental of its
    /// orders at the speed of the driver.
    pub fn frequency(&self) -> Option<f64> {
        match self {
            Self::TwoPulleyClutch(_) => None,
            Self::Drive(model) => model.fundamental_frequency(),
            Self::MechanicalSystem(model) => model.excitation.frequency,
        }
    }

    /// The units in which results are given to the user.
    pub fn units(&self) -> Units {
        match self {
            Self::TwoPulleyClutch(model) => match model.parameters {
                Parameters::Dimensionless(_) => Units::DIMENSIONLESS,
                Parameters::Physical(_) => Units::PHYSICAL,
            },
            Self::Drive(_) => Units::PHYSICAL,
            Self::MechanicalSystem(_) => Units::UNSPECIFIED,
        }
    }

    /// The equations of motion, with the measures that results report.
    ///
    /// # Errors
    /// [`Problem::WrongValue`] if values that are sound one by one overflow when they are combined, or if a drive cannot run
    /// at its operating speed ([`Drive::drive_system`]).
    pub fn system(&self) -> Result<System, ModelFileError> {
        match self {
            Self::TwoPulleyClutch(model) => model.system(),
            Self::Drive(model) => model.running().map(|running| running.system),
            Self::MechanicalSystem(model) => model.system(),
        }
        .map_err(|issue| issue.without_source())
    }

    /// The number of a key, in SI units.
    ///
    /// # Errors
    /// [`Problem::UnknownKey`] if the model has no such key or the key holds no number.
    pub fn number(&self, key: &str) -> Result<f64, ModelFileError> {
        // Looking a number up to change it is the one way to it; a copy of the model is cheap.
        let mut copy = self.clone();
        match copy.numbers().number_mut(key) {
            Some(number) => Ok(*number),
            None => Err(self.no_number(key)),
        }
    }

    /// The model with another number, in SI units. Costs a copy of the model and the checks of what changed, about a
    /// microsecond for two pulleys. An off-diagonal entry of `mass` changes its mirror image too.
    ///
    /// # Errors
    /// [`Problem::UnknownKey`] if the model has no such key or the key holds no number, [`Problem::WrongValue`] if no
    /// sound model has this value.
    pub fn with_number(&self, key: &str, value: f64) -> Result<Self, ModelFileError> {
        let mut changed = self.clone();
        match changed.numbers().number_mut(key) {
            Some(number) => *number = value,
            None => return Err(self.no_number(key)),
        }
        match &mut changed {
            Self::TwoPulleyClutch(model) => model.check(),
            Self::Drive(model) => model.check(),
            Self::MechanicalSystem(model) => model.check_after_change(key),
        }
        .map_err(|issue| issue.without_source())?;
        Ok(changed)
    }

    /// All keys that hold a number.
    pub fn numeric_keys(&self) -> Vec<String> {
        let mut keys = Vec::new();
        match self {
            Self::TwoPulleyClutch(model) => model.collect_keys("", &mut keys),
            Self::Drive(model) => model.collect_keys("", &mut keys),
            Self::MechanicalSystem(model) => model.collect_keys("", &mut keys),
        }
        keys
    }

    /// The model in SI units as JSON, with sorted keys.
    pub fn resolved(&self) -> serde_json::Value {
        // Serialising into a JSON value fails only for maps whose keys are not texts, and there are none.
        let value = serde_json::to_value(self).expect("all keys of a model are texts");
        sorted(value)
    }

    /// SHA-256 of the resolved model's compact JSON text, in hexadecimal: equal for files that describe the same model.
    pub fn sha256(&self) -> String {
        let digest = Sha256::digest(self.resolved().to_string());
        digest.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    fn numbers(&mut self) -> &mut dyn Numbers {
        match self {
            Self::TwoPulleyClutch(model) => model,
            Self::Drive(model) => &mut **model,
            Self::MechanicalSystem(model) => &mut **model,
        }
    }

    fn no_number(&self, key: &str) -> ModelFileError {
        let keys = self.numeric_keys();
        let issue = Issue::new(
            Problem::UnknownKey,
            key,
            format!("the model has no number \"{key}\""),
        );
        let last = key.rsplit('.').next().unwrap_or(key);
        // A user who leaves the table's name out means the key itself; one who writes a path has mistyped it.
        let same_last = keys
            .iter()
            .map(String::as_str)
            .find(|known| known.rsplit('.').next() == Some(last));
        let resembling = nearest(key, keys.iter().map(String::as_str));
        let meant = if key.contains('.') {
            resembling.or(same_last)
        } else {
            same_last.or(resembling)
        };
        match meant {
            Some(meant) => issue.with_help(format!("did you mean \"{meant}\"?")),
            None => issue.with_help(format!(
                "its numbers are {}",
                enumerate(keys.iter().map(String::as_str))
            )),
        }
        .without_source()
    }
}

/// The value with the keys of all tables in alphabetical order, whatever order the JSON library keeps.
fn sorted(value: serde_json::Value) -> serde_json::Value {
    use serde_json::Value;
    match value {
        Value::Object(map) => {
            let mut entries: Vec<_> = map.into_iter().collect();
            entries.sort_by(|left, right| left.0.cmp(&right.0));
            Value::Object(
                entries
                    .into_iter()
                    .map(|(key, value)| (key, sorted(value)))
                    .collect(),
            )
        }
        Value::Array(items) => Value::Array(items.into_iter().map(sorted).collect()),
        other => other,
    }
}
