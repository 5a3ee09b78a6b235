//! Why a strong form cannot be set up or solved.

use slackside_linalg::LinalgError;

/// Failure of the strong form.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StrongFormError {
    /// A feature of the model that exists for the sine series only.
    #[error("the strong form knows no {what}; compare with a model without it")]
    NotInStrongForm {
        /// The feature.
        what: &'static str,
    },
    /// A span without effective tension.
    #[error("span {span} has no effective tension")]
    Slack {
        /// The span, `from-to`.
        span: String,
    },
    /// A frequency that is not positive.
    #[error("the frequency must be positive and finite, found {found} rad/s")]
    Frequency {
        /// Frequency asked for, rad/s.
        found: f64,
    },
    /// A list that does not fit the drive.
    #[error("{what} needs {expected} entries, one per {per}, found {found}")]
    Count {
        /// What the list is.
        what: &'static str,
        /// What it has entries for.
        per: &'static str,
        /// Entries needed.
        expected: usize,
        /// Entries found.
        found: usize,
    },
    /// Newton's method for a natural frequency did not converge.
    #[error("no natural frequency was found from the estimate {:.6} Hz; try one closer by", estimate / std::f64::consts::TAU)]
    NoConvergence {
        /// Estimate it started from, rad/s.
        estimate: f64,
    },
    /// A linear system of the strong form has no solution.
    #[error("the strong form at {:.6} Hz: {source}", frequency / std::f64::consts::TAU)]
    Linalg {
        /// Frequency, rad/s.
        frequency: f64,
        /// What went wrong.
        source: LinalgError,
    },
}
