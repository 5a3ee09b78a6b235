//! What a key expects, and why a text is not that.

use thiserror::Error;

use super::Dimension;

/// What a key expects: words and an example for messages, and the dimensions that are right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Name with its article, for example `a torque`.
    pub name: &'static str,
    /// A value as it is written in a file, without quotes, for example `4.5 N m`.
    pub example: &'static str,
    /// Permitted dimensions. A bare number is always permitted and means SI.
    pub dimensions: &'static [Dimension],
}

impl Quantity {
    /// True if the quantity has no unit.
    pub fn is_plain_number(&self) -> bool {
        self.dimensions == [Dimension::NONE]
    }

    /// For messages: `a torque such as "4.5 N m"`.
    pub fn description(&self) -> String {
        if self.is_plain_number() {
            format!("{} such as {}", self.name, self.example)
        } else {
            format!("{} such as \"{}\"", self.name, self.example)
        }
    }
}

/// Why a text is not the quantity that was expected.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum UnitError {
    /// The text does not start with a number.
    #[error("expected {expected}, found \"{text}\", which does not start with a number")]
    NoNumber {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
    },
    /// There is a number, but no unit.
    #[error("expected {expected}, found \"{text}\" without a unit")]
    NoUnit {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
    },
    /// A unit is not in the table.
    #[error("expected {expected}, found \"{text}\", whose unit \"{unit}\" is not known")]
    UnknownUnit {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
        /// The unit that is not known.
        unit: String,
        /// The known unit with the nearest spelling, if one is near.
        nearest: Option<&'static str>,
    },
    /// The units do not form a product that can be read in one way.
    #[error("expected {expected}, found \"{text}\", whose unit cannot be read: {reason}")]
    Malformed {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
        /// What is wrong and how to write it.
        reason: &'static str,
    },
    /// The unit measures something else.
    #[error("expected {expected}, found \"{text}\"")]
    WrongDimension {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
    },
    /// The value is too large for a double-precision number.
    #[error("expected {expected}, found \"{text}\", which is not a finite number")]
    NotFinite {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
    },
}
