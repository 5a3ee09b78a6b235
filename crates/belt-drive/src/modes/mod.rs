//! Natural modes of a drive: undamped, damped, over speed, and the speed at which it loses its stability
//! (theory 04 §4).

mod campbell;
mod divergence;
mod shares;
mod solve;

pub use campbell::{Campbell, CampbellError, CampbellPoint, campbell, campbell_point, track};
pub use divergence::{LimitSpeed, SpeedLimit, limit_speed};
pub use shares::{Kind, Shares};
pub use solve::{damped_modes, undamped_modes};

use slackside_linalg::{Complex, LinalgError};

/// One mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Natural frequency, rad/s: `ω` of an undamped mode, `|s|` of a damped one with eigenvalue `s`; zero for the free
    /// rotation of the whole drive.
    pub frequency: f64,
    /// Damping ratio `−Re s/|s|`; zero for an undamped mode.
    pub damping_ratio: f64,
    /// Shape over all coordinates, complex; zero where a coordinate is held.
    pub shape: Vec<Complex>,
    /// Where its kinetic energy is.
    pub shares: Shares,
    /// What it is, by the largest share.
    pub kind: Kind,
}

/// Why there are no modes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModesError {
    /// A coordinate without inertia.
    #[error(
        "\"{coordinate}\" has no inertia; give every pulley, accessory and arm an inertia greater than zero"
    )]
    NoInertia {
        /// Name of the coordinate.
        coordinate: String,
    },
    /// The steady state is not a stable equilibrium.
    #[error(
        "the steady state is statically unstable: the stiffness matrix is not positive definite; lower the speed, raise the tension, or turn the arm away from its dead centre"
    )]
    Unstable,
    /// The eigenvalue problem failed.
    #[error(transparent)]
    Linalg(LinalgError),
}
