//! The answer of `response --compare` as users read it.

use crate::response::{BranchRow, ParameterRow, SweepPointRow};
use crate::{Event, Header, Label, Parameter};
use serde::Serialize;

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct CompareDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// What varies along the branches.
    pub parameter: ParameterRow,
    /// The measure whose RMS is compared: the deflection of the switching element.
    pub measure: String,
    /// Tolerance of the statements in `within` and of the map.
    pub tolerance: f64,
    /// The branches of all methods.
    pub branches: Vec<MethodBranch>,
    /// Errors of all methods at the switching motions of the exact branch.
    pub errors: Vec<ErrorRow>,
    /// How far each method is within the tolerance.
    pub within: Vec<WithinRow>,
    /// One period of the stable motions at the values asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub histories: Vec<HistoryRow>,
    /// Settled motions of a check by time integration with rising parameter.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub up: Vec<SweepPointRow>,
    /// The same with falling parameter.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub down: Vec<SweepPointRow>,
    /// Where the approximations hold, over two keys.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<ValidityMap>,
}

/// A method of the comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Contestant {
    /// Shooting on the exact flow, with which the others are compared.
    Shooting,
    /// Harmonic balance.
    HarmonicBalance,
    /// Multiple scales of second order.
    SecondOrder,
    /// Multiple scales of first order.
    FirstOrder,
}

impl Contestant {
    /// All of them, the exact one first.
    pub const ALL: [Self; 4] = [
        Self::Shooting,
        Self::HarmonicBalance,
        Self::SecondOrder,
        Self::FirstOrder,
    ];

    /// The name in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Shooting => "shooting",
            Self::HarmonicBalance => "harmonic balance",
            Self::SecondOrder => "multiple scales, second order",
            Self::FirstOrder => "multiple scales, first order",
        }
    }
}

/// A branch and the method that found it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MethodBranch {
    /// The method.
    pub method: Contestant,
    /// The branch.
    #[serde(flatten)]
    pub branch: BranchRow,
}

/// Errors at one motion of the exact branch: relative differences of the parameter at equal RMS. An error is absent where
/// the method has no motion of that RMS on the same side of the resonance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorRow {
    /// Value of the parameter.
    #[serde(flatten)]
    pub at: Parameter,
    /// Value of the family key.
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub label: Option<Label>,
    /// Whether the exact motion is stable.
    pub stable: bool,
    /// RMS of the measure about its mean.
    pub rms: f64,
    /// Distance of rest from the switching point over the amplitude that a harmonic motion of this RMS has.
    pub gamma: f64,
    /// Error of multiple scales, first order.
    pub first_order: Option<f64>,
    /// Error of multiple scales, second order.
    pub second_order: Option<f64>,
    /// Error of harmonic balance.
    pub harmonic_balance: Option<f64>,
}

impl ErrorRow {
    /// The error of a method; zero for shooting, which is the measure of the others.
    pub fn of(&self, method: Contestant) -> Option<f64> {
        match method {
            Contestant::Shooting => Some(0.0),
            Contestant::HarmonicBalance => self.harmonic_balance,
            Contestant::SecondOrder => self.second_order,
            Contestant::FirstOrder => self.first_order,
        }
    }
}

/// How far a method is within the tolerance on the switching part of a branch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WithinRow {
    /// Value of the family key.
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub label: Option<Label>,
    /// The method.
    pub method: Contestant,
    /// Largest RMS up to which all motions are within the tolerance; absent if the first ones are not.
    pub rms: Option<f64>,
    /// `gamma` there.
    pub gamma: Option<f64>,
    /// Whether that is the whole branch.
    pub everywhere: bool,
    /// Largest error on the branch; absent where some motion is not found at all.
    pub worst: Option<f64>,
}

/// One period of a motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HistoryRow {
    /// Value of the parameter.
    #[serde(flatten)]
    pub at: Parameter,
    /// Value of the family key.
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub label: Option<Label>,
    /// The method.
    pub method: Contestant,
    /// Phases, as fractions of the period.
    pub phase: Vec<f64>,
    /// The measure.
    pub deflection: Vec<f64>,
    /// Force of the switching element.
    pub force: Vec<f64>,
    /// Events.
    pub events: Vec<Event>,
    /// Share of the period in which the element transmits.
    pub engaged_ratio: Option<f64>,
    /// Amplitudes of the measure's harmonics, the mean first.
    pub amplitudes: Vec<f64>,
}

/// What holds at a cell of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Validity {
    /// Nothing separates: the linear response is exact.
    Linear,
    /// Both orders are within the tolerance along the whole branch.
    FirstOrder,
    /// Only the second order is.
    SecondOrder,
    /// Neither is.
    Neither,
}

impl Validity {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Linear, Self::FirstOrder, Self::SecondOrder, Self::Neither];
}

/// Where the approximations hold along the whole branch, over two keys.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ValidityMap {
    /// First key and its values.
    pub across: MapAxis,
    /// Second key and its values.
    pub down: MapAxis,
    /// Cells by rows of the second key, each row over the first; `None` where there is no answer.
    pub cells: Vec<Vec<Option<MapCell>>>,
}

/// A key of the map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MapAxis {
    /// The key.
    pub key: String,
    /// Its values.
    pub values: Vec<f64>,
}

/// A cell of the map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MapCell {
    /// What holds.
    pub validity: Validity,
    /// Largest error of the first order; absent where it has no motion of some RMS, or nothing separates.
    pub first_order: Option<f64>,
    /// The same of the second order.
    pub second_order: Option<f64>,
    /// Smallest `gamma` on the exact branch: how deep the separation is.
    pub gamma: Option<f64>,
}
