//! A tensioner: an arm on a pivot, or a slide.

use super::TensionerFriction;
use glam::DVec2;

/// A tensioner. Its coordinate is the angle of the arm from the first axis, counter-clockwise (rad), or the way along the
/// slide (m); "torque" stands for the generalised force along it, N·m or N.
#[derive(Debug, Clone, PartialEq)]
pub struct Tensioner {
    /// Name, for messages, tables and figures.
    pub name: String,
    /// How it moves.
    pub guide: Guide,
    /// Reference position: of the installation, and of the spring's preload.
    pub reference: f64,
    /// Rate of the spring, N·m/rad or N/m.
    pub spring_rate: f64,
    /// Torque of the spring at the reference position, positive where it tightens the belt; `None` if it follows from the
    /// installation.
    pub spring_preload: Option<f64>,
    /// Inertia about the pivot, or mass, without what the carried pulleys add by their own `mass`.
    pub inertia: f64,
    /// Viscous damping, N·m·s/rad or N·s/m.
    pub damping: f64,
    /// Smallest and largest position.
    pub stops: Option<[f64; 2]>,
    /// Whether it is held where it stands: its reference position.
    pub locked: bool,
    /// Friction that depends on the direction of motion; it acts in the [`crate::system`] only.
    pub friction: Option<TensionerFriction>,
    /// Damping that acts while the belt pushes the tensioner back, N·m·s/rad or N·s/m, in the [`crate::system`] only.
    pub one_way_damping: f64,
    /// What happens at the stops in the [`crate::system`]; without it they only bound the steady position.
    pub stop_contact: Option<StopContact>,
    /// Pulleys that a carried pulley may touch, in the [`crate::system`].
    pub pulley_contacts: Vec<PulleyContact>,
}

/// What happens when the tensioner meets a stop, or a carried pulley another pulley.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StopContact {
    /// An impact.
    Rigid {
        /// Coefficient of restitution, 0 to 1.
        restitution: f64,
    },
    /// A spring and a damper that push but do not pull.
    Compliant {
        /// Stiffness: N·m/rad or N/m at a stop, N/m between pulleys.
        stiffness: f64,
        /// Damping in the same units times seconds.
        damping: f64,
    },
}

/// A pulley that a pulley on the tensioner may touch (theory 05 §6.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PulleyContact {
    /// Index of the carried pulley.
    pub carried: usize,
    /// Index of the other pulley, which the tensioner does not carry.
    pub other: usize,
    /// Distance of the centres less the two pitch radii at which they touch, m: for the belt between them.
    pub clearance: f64,
    /// What happens when they do.
    pub contact: StopContact,
}

/// How a tensioner moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guide {
    /// About a pivot.
    Rotary {
        /// The pivot, m.
        pivot: DVec2,
    },
    /// Along a line.
    Linear {
        /// Direction of travel, a unit vector.
        direction: DVec2,
    },
}

impl Guide {
    /// Centre of a pulley at position `q`, with its first and second derivative in `q` (theory 04 §1.3). `place` is the
    /// centre in the frame of the arm, as in [`super::Mount::Carried`].
    pub fn centre(&self, place: DVec2, q: f64) -> [DVec2; 3] {
        match self {
            Self::Rotary { pivot } => {
                let arm = DVec2::from_angle(q).rotate(place);
                [*pivot + arm, arm.perp(), -arm]
            }
            Self::Linear { direction } => [place + q * *direction, *direction, DVec2::ZERO],
        }
    }

    /// Unit of the position, for messages: `rad` or `m`.
    pub fn position_unit(&self) -> &'static str {
        match self {
            Self::Rotary { .. } => "rad",
            Self::Linear { .. } => "m",
        }
    }
}
