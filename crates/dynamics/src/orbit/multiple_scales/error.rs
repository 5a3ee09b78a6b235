//! Why the method of multiple scales has no answer.

use slackside_linalg::LinalgError;

/// Why the method of multiple scales has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MultipleScalesError {
    /// The number of elements that switch or are nonlinear is not one.
    #[error(
        "multiple scales needs exactly one element that switches, but the system has {}",
        counted(.elements)
    )]
    Elements {
        /// Their names.
        elements: Vec<String>,
    },
    /// The element's law is not two straight pieces of its displacement.
    #[error(
        "multiple scales needs a law of two straight pieces of the displacement, such as the exact wrap spring, but \"{element}\" has another ({kind}, smoothed or of more pieces)"
    )]
    Law {
        /// The element.
        element: String,
        /// The kind of its law.
        kind: &'static str,
    },
    /// The element does not rest inside its linear piece.
    #[error(
        "\"{element}\" carries no preload: at rest it is not engaged (deflection {deflection:e} beyond the switching point), so that there is no engaged motion to expand about"
    )]
    NoPreload {
        /// The element.
        element: String,
        /// Distance of the state of rest from the switching point; not positive.
        deflection: f64,
    },
    /// The engaged system has a rigid-body mode or is statically unstable.
    #[error(
        "the engaged system has a mode without stiffness, so that there is no state of rest to expand about"
    )]
    FreeMode,
    /// The damping matrix couples the engaged modes.
    #[error(
        "multiple scales needs modal damping of the engaged system, but the damping matrix couples its modes (by {share:.1e} of the largest modal damping)"
    )]
    CoupledDamping {
        /// Largest coupling term relative to the largest modal damping.
        share: f64,
    },
    /// The load is not one harmonic of order one.
    #[error("multiple scales needs a load of one harmonic of order 1 with one phase for all coordinates")]
    Load,
    /// The matrices depend on the frequency of the load.
    #[error("multiple scales needs matrices that do not depend on the frequency of the load")]
    FrequencyDependent,
    /// There is no such mode.
    #[error("there is no mode {mode}; the engaged system has {count}")]
    Mode {
        /// Number asked for, from one.
        mode: usize,
        /// Number of modes.
        count: usize,
    },
    /// The load does no work on the mode: no resonance.
    #[error("the load does not excite mode {mode}: it has no primary resonance")]
    NotExcited {
        /// Number of the mode, from one.
        mode: usize,
    },
    /// The mode does not deflect the element: it is linear.
    #[error("mode {mode} does not deflect the switching element: its resonance is linear")]
    NotDeflected {
        /// Number of the mode, from one.
        mode: usize,
    },
    /// Without damping the amplitude at resonance is not bounded.
    #[error("mode {mode} has no damping: its amplitude at resonance is not bounded")]
    Undamped {
        /// Number of the mode, from one.
        mode: usize,
    },
    /// Another mode is a multiple of the resonant one.
    #[error(
        "internal resonance: mode {other} has {multiple} times the natural frequency of mode {mode}, which the expansion excludes"
    )]
    InternalResonance {
        /// The resonant mode, from one.
        mode: usize,
        /// The other mode, from one.
        other: usize,
        /// The multiple.
        multiple: usize,
    },
    /// The modes could not be computed.
    #[error("linear algebra: {0}")]
    Linalg(#[from] LinalgError),
}

fn counted(names: &[String]) -> String {
    match names {
        [] => "none".to_owned(),
        names => format!("{} ({})", names.len(), names.join(", ")),
    }
}
