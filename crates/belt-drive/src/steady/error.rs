//! Why there is no steady state, or none that the drive could run in.

use crate::layout::LayoutError;

/// A drive without a usable steady state. SI units; messages in mm, degrees and rpm.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SteadyError {
    /// The belt's path is impossible.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// A span carries no effective tension.
    #[error(
        "span {span} has no effective tension at {:.0} rpm of the driver: its belt tension is {tension:.1} N, the centrifugal tension mc² {centrifugal:.1} N{}; install with more tension, lower the loads, or use a tensioner that follows",
        rpm(*driver_speed), if *tension < 0.0 { " (a belt cannot push)" } else { "" }
    )]
    NoEffectiveTension {
        /// The span, `from-to`.
        span: String,
        /// Its total tension `P`, N.
        tension: f64,
        /// `mc²`, N.
        centrifugal: f64,
        /// Speed of the driver, rad/s.
        driver_speed: f64,
    },
    /// The belt would be stretched beyond what any belt bears.
    #[error(
        "the belt is too short: span {span} would be stretched by {:.1} % ({tension:.0} N); take a longer belt, or check the positions and the axial stiffness",
        100.0 * strain
    )]
    Overstretched {
        /// The span, `from-to`.
        span: String,
        /// Its strain `P/EA`.
        strain: f64,
        /// Its total tension, N.
        tension: f64,
    },
    /// The belt is too long for every position of the arms.
    #[error(
        "the belt is too long: at every position of the tensioner that the layout allows it is slack by at least {:.2} mm; take a belt of less than {:.1} mm natural length, or give the tensioner more travel",
        1e3 * excess, 1e3 * (natural_length - excess)
    )]
    BeltTooLong {
        /// Least excess of the natural length, m.
        excess: f64,
        /// The natural length, m.
        natural_length: f64,
    },
    /// The belt is too short for every position of the arms.
    #[error(
        "the belt is too short: at every position of the tensioner that the layout allows at least {:.2} mm are missing; take a belt of more than {:.1} mm natural length, or give the tensioner more travel",
        1e3 * missing, 1e3 * (natural_length + missing)
    )]
    BeltTooShort {
        /// Least missing length, m.
        missing: f64,
        /// The natural length, m.
        natural_length: f64,
    },
    /// An arm would stand beyond one of its stops.
    #[error(
        "tensioner \"{tensioner}\" would stand at {}, beyond its stop at {}; take a {} belt, or move the stop",
        position_text(*position, *is_rotary), position_text(*stop, *is_rotary),
        if *belt_is_long { "shorter" } else { "longer" }
    )]
    ArmBeyondStop {
        /// The tensioner.
        tensioner: String,
        /// Where it would stand, rad or m.
        position: f64,
        /// The stop, rad or m.
        stop: f64,
        /// Whether positions are angles.
        is_rotary: bool,
        /// Whether a shorter belt would bring it back.
        belt_is_long: bool,
    },
    /// An arm at its dead centre takes up no belt.
    #[error(
        "tensioner \"{tensioner}\" stands at or beyond its dead centre, where it takes up no belt; turn its arm away from the bisector of its spans, or change the belt length"
    )]
    DeadCentre {
        /// The tensioner.
        tensioner: String,
    },
    /// The springs of several tensioners would need different tensions.
    #[error(
        "the preloads of the tensioners do not balance at their reference positions: each would need another belt tension; give the installation tension or the natural length of the belt instead"
    )]
    ArmsDisagree,
    /// A spring that loosens the belt.
    #[error(
        "the spring of tensioner \"{tensioner}\" balances at a belt tension of {tension:.1} N; raise its preload"
    )]
    SpringPushesAway {
        /// The tensioner.
        tensioner: String,
        /// The tension, N.
        tension: f64,
    },
    /// A tensioner whose preload is not known.
    #[error(
        "the preload of tensioner \"{tensioner}\" is not known; give `spring.preload`, or the installation tension instead of the belt length"
    )]
    NoPreload {
        /// The tensioner.
        tensioner: String,
    },
    /// No free tensioner, and neither length nor tension.
    #[error(
        "nothing fixes the belt tension: no tensioner is free to move; give the natural length of the belt or its installation tension"
    )]
    NothingFixesTheTension,
    /// The iteration did not converge.
    #[error(
        "no steady state was found at {:.0} rpm of the driver: the balance of belt length and arms has no solution near the reference positions",
        rpm(*driver_speed)
    )]
    NoEquilibrium {
        /// Speed of the driver, rad/s.
        driver_speed: f64,
    },
}

fn rpm(speed: f64) -> f64 {
    speed * 30.0 / std::f64::consts::PI
}

fn position_text(position: f64, is_rotary: bool) -> String {
    if is_rotary {
        format!("{:.2}°", position.to_degrees())
    } else {
        format!("{:.2} mm", 1e3 * position)
    }
}
