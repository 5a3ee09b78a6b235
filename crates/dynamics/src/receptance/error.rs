//! Why the linear part of a system has no answer.

use slackside_linalg::LinalgError;

/// Why the linear part of a system has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReceptanceError {
    /// An element outside the ports is not a linear spring and damper.
    #[error(
        "\"{element}\" ({kind}) switches or is nonlinear as well; the closed form holds for a system that is otherwise linear: make \"{element}\" rigid or an isolator"
    )]
    NonlinearElement {
        /// Its name.
        element: String,
        /// The kind of its law.
        kind: &'static str,
    },
    /// An element is asked for that does not exist.
    #[error("there is no element {index}: the system has {count}")]
    NoElement {
        /// Index asked for.
        index: usize,
        /// Number of elements.
        count: usize,
    },
    /// A port to be locked is held already by the others.
    #[error("the port of \"{element}\" is held already by the other ports")]
    DependentPort {
        /// The element.
        element: String,
    },
    /// The dynamic stiffness is singular: an undamped resonance.
    #[error("the linear system has an undamped resonance at {omega} rad/s; give it damping")]
    Resonance {
        /// Circular frequency of the harmonic.
        omega: f64,
    },
    /// The mean position or mean force is not determined.
    #[error(
        "the mean position is not determined: a coordinate has neither stiffness nor damping against its mean load"
    )]
    FreeMean,
    /// The eigenvectors do not form a basis, so that there is no sum over poles.
    #[error(
        "two modes coincide so closely that the sum over poles is inaccurate (relative error {error:.1e})"
    )]
    Defective {
        /// Relative difference between the sum over poles and a direct solution.
        error: f64,
    },
    /// A failure of the linear algebra.
    #[error(transparent)]
    Linalg(#[from] LinalgError),
}
