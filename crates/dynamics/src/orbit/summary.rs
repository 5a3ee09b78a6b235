//! What is reported of a periodic motion, by whichever method it was found.

use slackside_linalg::Complex;

/// Summary of one measure over one period of the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasureSummary {
    /// Mean.
    pub mean: f64,
    /// Root mean square about the mean.
    pub rms: f64,
    /// Largest value.
    pub max: f64,
    /// Smallest value.
    pub min: f64,
    /// Complex amplitudes `h_k` in `y = h_0 + Re Σ_{k≥1} h_k e^{ikΩt/n}`, where the motion repeats after `n` periods of
    /// the load.
    pub harmonics: Vec<Complex>,
}

/// One event of a motion: an element passes from one regime to another.
#[derive(Debug, Clone, PartialEq)]
pub struct EventRecord {
    /// Phase `Ω t` at the event, radians, counted from the start of the motion.
    pub phase: f64,
    /// Index of the element.
    pub element: usize,
    /// Index of the regime before.
    pub from: usize,
    /// Index of the regime after.
    pub to: usize,
}
