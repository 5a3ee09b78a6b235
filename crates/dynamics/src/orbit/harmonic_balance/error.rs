//! What can go wrong in harmonic balance.

use slackside_linalg::LinalgError;
use slackside_mechanics::SystemError;

/// Failure of harmonic balance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HarmonicBalanceError {
    /// The system itself is not sound.
    #[error(transparent)]
    System(#[from] SystemError),
    /// A setting is outside its range.
    #[error("{name} is {value}, but must be {range}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        range: &'static str,
    },
    /// The static stiffness with all elements linearised is singular: the mean position is not determined.
    #[error(
        "the static stiffness is singular even with all elements engaged, so that the mean position is not determined{}",
        advice(.candidates)
    )]
    FreeMean {
        /// Elements whose linearisation has no stiffness and with a stiffness would hold the system.
        candidates: Vec<String>,
    },
    /// A law has no form that can be balanced.
    #[error("harmonic balance does not cover element \"{element}\" of kind \"{kind}\": {reason}")]
    NotCovered {
        /// The element.
        element: String,
        /// Kind of its law.
        kind: &'static str,
        /// Why not, and what does.
        reason: &'static str,
    },
    /// The linearised system is undamped and excited exactly at a natural frequency.
    #[error("harmonic {harmonic} of frequency {frequency} meets an undamped natural frequency")]
    Resonance {
        /// The multiple `k` of `Ω/n`.
        harmonic: usize,
        /// `Ω`.
        frequency: f64,
    },
    /// The start has another shape than the problem.
    #[error("the start has {found} {what}, but {expected} are needed")]
    Start {
        /// What is counted.
        what: &'static str,
        /// Number needed.
        expected: usize,
        /// Number found.
        found: usize,
    },
    /// A stability method does not apply to the laws of the system.
    #[error(
        "the monodromy matrix from switching angles needs piecewise-linear laws with continuous force, but element \"{element}\" has another law"
    )]
    NotPiecewiseLinear {
        /// The element.
        element: String,
    },
    /// The forces along the motion have no tangent from which multipliers could be found.
    #[error(
        "multipliers need tangents of all laws, which that of element \"{element}\" does not have along a motion by harmonic balance; integrate the motion instead"
    )]
    NoTangent {
        /// The element.
        element: String,
    },
    /// A dense linear-algebra call failed.
    #[error(transparent)]
    Linalg(#[from] LinalgError),
}

fn advice(candidates: &[String]) -> String {
    if candidates.is_empty() {
        return String::new();
    }
    let names: Vec<_> = candidates.iter().map(|name| format!("\"{name}\"")).collect();
    format!("; give element {} a stiffness", names.join(" or "))
}
