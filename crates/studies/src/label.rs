//! What tells the members of a family of curves apart: a key of the model and its value, a number or a text.

use crate::Parameter;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::fmt;

/// The value of a family key.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum LabelValue {
    /// A number, in SI units or as dimensionless as the key.
    Number(f64),
    /// A text as a model file holds it, for example the kind of a coupling or a quantity with its unit.
    Text(String),
}

impl fmt::Display for LabelValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => value.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

/// A key and its value for one member of a family: `"dimensionless.preload": 0.5`.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The key of the model.
    pub key: String,
    /// Its value.
    pub value: LabelValue,
}

impl Label {
    /// The value if it is a number.
    pub fn number(&self) -> Option<f64> {
        match self.value {
            LabelValue::Number(value) => Some(value),
            LabelValue::Text(_) => None,
        }
    }
}

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.key, self.value)
    }
}

impl From<Parameter> for Label {
    fn from(parameter: Parameter) -> Self {
        Self {
            key: parameter.key,
            value: LabelValue::Number(parameter.value),
        }
    }
}

impl Serialize for Label {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1))?;
        map.serialize_entry(&self.key, &self.value)?;
        map.end()
    }
}
