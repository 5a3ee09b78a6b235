//! The modes of a drive as users read them.

use crate::drive::matrices::Matrices;
use crate::drive::steady::{SteadyDocument, VariedRow};
use crate::{Header, Ratios};
use serde::Serialize;

/// The answer; numbers in SI units, frequencies in Hz, speeds in rpm.
#[derive(Debug, Clone, Serialize)]
pub struct DriveModesDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// Speed of the driver at the operating point, rpm.
    pub speed: f64,
    /// `prescribed` or `free`.
    pub driver: &'static str,
    /// Modes at the operating point.
    pub modes: Vec<DriveModeRow>,
    /// Largest relative change of the frequencies of these modes when the number of sine terms of every span is doubled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convergence: Option<f64>,
    /// What varies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameter: Option<VariedRow>,
    /// Modes over the varied quantity, in the order of the curves.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub over: Vec<CampbellRow>,
    /// Where the lines of the excitation's orders meet natural frequencies; over speed only.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub resonances: Vec<ResonanceRow>,
    /// The speed beyond which there is no stable steady state, if it lies in the range that was looked at.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit_speed: Option<LimitRow>,
    /// The linear model at the operating point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matrices: Option<Matrices>,
    /// The steady sheet at the operating point, for drawings.
    #[serde(skip)]
    pub sheet: Box<SteadyDocument>,
}

/// A mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriveModeRow {
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// The same frequency from the strong form of the equations, without sine series.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strong_form_hz: Option<f64>,
    /// Damping ratio of the damped mode that goes with it.
    pub damping_ratio: f64,
    /// `rotation`, `arm`, `span <name>` or `mixed`.
    pub kind: String,
    /// Shares of the kinetic energy: `rotation.<pulley>`, `arm.<tensioner>`, `span.<span>`.
    pub shares: Ratios,
    /// Rotations of the pulleys, relative to the largest motion of the mode; complex.
    pub rotations: Vec<[f64; 2]>,
    /// Motions of the arms.
    pub arms: Vec<[f64; 2]>,
    /// Displacements across every span at equal distances, its ends included, along the left normal.
    pub spans: Vec<Vec<[f64; 2]>>,
}

/// The modes at one value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CampbellRow {
    /// The value.
    pub value: f64,
    /// Natural frequencies in the order of the curves, Hz.
    pub frequencies_hz: Vec<f64>,
    /// What they are.
    pub kinds: Vec<String>,
}

/// An order of the excitation meets a natural frequency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResonanceRow {
    /// The order.
    pub order: f64,
    /// Number of the curve, from 1.
    pub mode: usize,
    /// Speed of the driver, rpm.
    pub speed: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// What the mode is there.
    pub kind: String,
}

/// The end of the range of speeds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitRow {
    /// Largest driver speed with a stable steady state, rpm.
    pub speed: f64,
    /// What ends it.
    pub reason: String,
}
