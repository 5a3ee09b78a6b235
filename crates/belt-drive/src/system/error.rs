//! Why a running drive has no equations of motion.

use slackside_linalg::LinalgError;
use slackside_mechanics::laws::HysteresisLoopError;

/// Why a running drive has no equations of motion.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DriveSystemError {
    /// The orders of the excitation have no common period of a reasonable number of revolutions.
    #[error(
        "the orders {orders:?} of the excitation repeat together only after more than {revolutions} revolutions of the driver; \
         round them to common fractions"
    )]
    NoCommonOrder {
        /// The orders.
        orders: Vec<f64>,
        /// Most revolutions that are tried.
        revolutions: usize,
    },
    /// The excitation has no frequency.
    #[error("the excitation has the angular frequency {frequency} rad/s: the driver must turn")]
    NoFrequency {
        /// The frequency.
        frequency: f64,
    },
    /// A coordinate has no inertia.
    #[error("\"{coordinate}\" has no inertia; motions need one")]
    NoInertia {
        /// Name of the coordinate.
        coordinate: String,
    },
    /// The driver has a one-way coupling.
    #[error(
        "pulley \"{pulley}\" drives the belt: a one-way coupling is between a driven pulley and its accessory"
    )]
    CouplingOfDriver {
        /// Name of the pulley.
        pulley: String,
    },
    /// The load of a one-way coupling does not keep it engaged.
    #[error(
        "the load {load} N m of pulley \"{pulley}\" does not keep its one-way coupling engaged: it must be positive, or zero \
         with damping of the accessory"
    )]
    LoadOpensCoupling {
        /// Name of the pulley.
        pulley: String,
        /// Load torque, N·m.
        load: f64,
    },
    /// A decoupler has both damping and preload.
    #[error("the decoupler of pulley \"{pulley}\" has damping and preload; leave one of them out")]
    DampingAndPreload {
        /// Name of the pulley.
        pulley: String,
    },
    /// A measured loop of a tensioner is no loop.
    #[error("the measured loop of tensioner \"{tensioner}\": {reason}")]
    Loop {
        /// Name of the tensioner.
        tensioner: String,
        /// What is wrong.
        reason: HysteresisLoopError,
    },
    /// Two pulleys touch already in the steady state.
    #[error("pulleys \"{carried}\" and \"{other}\" touch in the steady state: their gap is {gap} m")]
    Touching {
        /// The pulley on the tensioner.
        carried: String,
        /// The other one.
        other: String,
        /// Their gap, m.
        gap: f64,
    },
    /// A linear-algebra call failed.
    #[error("linear algebra: {0}")]
    Linalg(#[from] LinalgError),
}
