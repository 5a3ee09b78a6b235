//! The answer of `limit` as users read it.

use crate::{Header, Parameter};
use serde::Serialize;
use slackside_linalg::Complex;

/// Share of the largest harmonic below which one is not told among the resonances.
const RELEVANT: f64 = 0.05;

/// What is sought.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LimitKind {
    /// The mean torque above which a one-way clutch never opens.
    CriticalLoad,
    /// The friction torque above which a port never slips.
    CriticalTorque,
}

impl LimitKind {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::CriticalLoad => "critical load",
            Self::CriticalTorque => "critical torque",
        }
    }

    /// The kind of element that has such a limit.
    pub(super) fn wanted(self) -> &'static str {
        match self {
            Self::CriticalLoad => "one-way clutch",
            Self::CriticalTorque => "dry friction",
        }
    }

    /// Whether an element that holds its port between these forces has such a limit.
    pub(super) fn fits(self, (low, high): (f64, f64)) -> bool {
        match self {
            Self::CriticalLoad => low.is_finite() != high.is_finite(),
            Self::CriticalTorque => low.is_finite() && high.is_finite(),
        }
    }
}

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct LimitDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// What was sought.
    pub limit: LimitKind,
    /// The element.
    pub element: String,
    /// Other elements that are taken as held at rest.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub held: Vec<String>,
    /// Other elements that are taken as engaged for good.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub engaged: Vec<String>,
    /// Other elements that are taken as free, such as stops out of reach.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub free: Vec<String>,
    /// The limit over the values.
    pub points: Vec<LimitRow>,
    /// Values at which the limit passes what the model has: the element begins or ceases to move.
    pub transitions: Vec<Transition>,
    /// Values at which a harmonic of the load meets a mode of the locked system.
    pub resonances: Vec<Resonance>,
    /// Unit of the values.
    #[serde(skip)]
    pub unit: String,
}

/// The limit at one value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitRow {
    /// The value.
    #[serde(flatten)]
    pub at: Parameter,
    /// Critical load or torque.
    pub value: f64,
    /// The mean torque of the clutch, or the (static) friction torque, that the model has.
    pub present: Option<f64>,
    /// Whether the element is locked for all time.
    pub locked: bool,
    /// Smallest torque in the locked element: its varying part of a clutch, with the mean of friction.
    pub minimum: f64,
    /// Largest torque in the locked element.
    pub maximum: f64,
    /// Of a clutch: part of the load's period at which it opens first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opens_at: Option<f64>,
    /// Of friction: displacement in the middle of the locked motions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// Of friction: static stiffness of its port.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
}

/// A value at which the element begins or ceases to move.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Transition {
    /// The value.
    #[serde(flatten)]
    pub at: Parameter,
    /// Whether it is locked for all time just above the value, and moves just below.
    pub locked_above: bool,
}

/// A resonance of the locked system.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Resonance {
    /// The value.
    #[serde(flatten)]
    pub at: Parameter,
    /// Order of the load's harmonic.
    pub order: usize,
    /// Number of the oscillating mode, from 1.
    pub mode: usize,
}

/// Orders whose amplitude is a noticeable share of the largest.
pub(super) fn relevant_orders(harmonics: &[(usize, Complex)]) -> Vec<usize> {
    let largest = harmonics.iter().fold(0.0_f64, |a, (_, g)| a.max(g.norm()));
    let relevant = harmonics.iter().filter(|(_, g)| g.norm() >= RELEVANT * largest);
    relevant.map(|(order, _)| *order).collect()
}
