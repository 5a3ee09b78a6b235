//! Why a closed form has no answer.

use crate::receptance::ReceptanceError;
use slackside_linalg::LinalgError;
use slackside_mechanics::OutsideDomain;

/// Why a closed form has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ClosedFormError {
    /// The element cannot hold its port at rest.
    #[error(
        "\"{element}\" ({kind}) cannot hold its port at rest; a limit of locking needs a one-way clutch or dry friction"
    )]
    CannotLock {
        /// The element.
        element: String,
        /// The kind of its law.
        kind: &'static str,
    },
    /// The element holds in both directions, or in one only, and the other is asked for.
    #[error("\"{element}\" ({kind}) is no {wanted}")]
    OtherKind {
        /// The element.
        element: String,
        /// The kind of its law.
        kind: &'static str,
        /// What is asked for.
        wanted: &'static str,
    },
    /// The load does not vary.
    #[error("the load has no harmonic, so that nothing works against the locked element")]
    NoHarmonic,
    /// The load has several harmonics.
    #[error("the closed form needs a load of one harmonic, but it has the orders {orders:?}")]
    SeveralHarmonics {
        /// Orders of the load.
        orders: Vec<usize>,
    },
    /// The friction cannot be overcome, or the orbit of pure slip does not exist for another reason.
    #[error("there is no orbit without stops: a friction torque of {torque:e} is above {limit:e}")]
    NoSlipOrbit {
        /// Friction torque.
        torque: f64,
        /// Largest torque for which the phase condition has a solution.
        limit: f64,
    },
    /// The state that the friction would hold at rest is not determined.
    #[error("the port has no static stiffness, about which the motion could be antisymmetric")]
    NoStaticStiffness,
    /// The family has no system at a value.
    #[error(transparent)]
    OutsideDomain(#[from] OutsideDomain),
    /// The linear part has no answer.
    #[error(transparent)]
    Receptance(#[from] ReceptanceError),
    /// A failure of the linear algebra.
    #[error(transparent)]
    Linalg(#[from] LinalgError),
}
