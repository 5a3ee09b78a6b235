//! A pulley, what holds it, and what hangs on its shaft.

use super::Load;
use glam::DVec2;

/// The sense in which the belt turns a pulley.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sense {
    /// `σ = +1`.
    CounterClockwise,
    /// `σ = −1`.
    Clockwise,
}

impl Sense {
    /// `σ`.
    pub fn sign(self) -> f64 {
        match self {
            Self::CounterClockwise => 1.0,
            Self::Clockwise => -1.0,
        }
    }

    /// The other sense.
    pub fn reversed(self) -> Self {
        match self {
            Self::CounterClockwise => Self::Clockwise,
            Self::Clockwise => Self::CounterClockwise,
        }
    }
}

/// A pulley.
#[derive(Debug, Clone, PartialEq)]
pub struct Pulley {
    /// Name, for messages, tables and figures.
    pub name: String,
    /// Pitch radius: of the belt's cord line, m.
    pub radius: f64,
    /// Sense in which the belt turns it.
    pub sense: Sense,
    /// What holds its centre.
    pub mount: Mount,
    /// Inertia of the pulley itself, kg·m².
    pub inertia: f64,
    /// Mass that moves with an arm, kg; zero if the arm's inertia contains it.
    pub mass: f64,
    /// Load on the pulley or on the accessory behind it.
    pub load: Load,
    /// Viscous friction of the bearing, N·m·s/rad.
    pub bearing_damping: f64,
    /// Whether the drag torque of a carried pulley reacts on its arm instead of on the ground.
    pub drag_reacts_on_arm: bool,
    /// Effective friction coefficient of the contact, groove angle included (theory 04 §2.7).
    pub friction: f64,
    /// What connects the pulley with the accessory.
    pub coupling: Coupling,
    /// Viscous friction of the accessory's own bearing, N·m·s/rad.
    pub accessory_damping: f64,
}

/// What holds the centre of a pulley.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mount {
    /// A fixed centre, m.
    Fixed(DVec2),
    /// A tensioner.
    Carried {
        /// Its index.
        tensioner: usize,
        /// The centre in the frame of the arm, m: on a rotary arm relative to the pivot, with the first axis along the arm;
        /// on a slide the centre where the coordinate is zero.
        place: DVec2,
    },
}

/// What connects a pulley with the accessory behind it. In the linear model the one-way kinds transmit; in the
/// [`crate::system`] they open and lock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coupling {
    /// A rigid shaft.
    Rigid {
        /// Inertia of the accessory, kg·m²; zero if the pulley's contains it.
        accessory_inertia: f64,
    },
    /// A clutch that transmits torque in one direction of relative velocity; rigid while locked.
    OneWay {
        /// Inertia of the accessory, kg·m².
        accessory_inertia: f64,
    },
    /// A spring and a dashpot.
    Isolator(Flexible),
    /// A clutch that engages on relative displacement; a spring while engaged.
    WrapSpring(Flexible),
    /// A spring and a clutch in series; a spring while engaged.
    Decoupler {
        /// Inertia, spring and dashpot.
        spring: Flexible,
        /// Torque with which the spring rests against its stop, N·m; up to it the decoupler transmits rigidly.
        preload: f64,
    },
}

/// Stiffness and damping between a pulley and an accessory with its own rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flexible {
    /// Inertia of the accessory, kg·m².
    pub accessory_inertia: f64,
    /// Torsional stiffness, N·m/rad.
    pub stiffness: f64,
    /// Torsional damping, N·m·s/rad.
    pub damping: f64,
}

impl Coupling {
    /// A pulley whose inertia contains everything that turns with it.
    pub const NONE: Self = Self::Rigid {
        accessory_inertia: 0.0,
    };

    /// Inertia of the accessory, kg·m².
    pub fn accessory_inertia(&self) -> f64 {
        match self {
            Self::Rigid { accessory_inertia } | Self::OneWay { accessory_inertia } => *accessory_inertia,
            Self::Isolator(spring) | Self::WrapSpring(spring) | Self::Decoupler { spring, .. } => {
                spring.accessory_inertia
            }
        }
    }

    /// Whether it can let the accessory run ahead of the pulley.
    pub fn is_one_way(&self) -> bool {
        matches!(
            self,
            Self::OneWay { .. } | Self::WrapSpring(_) | Self::Decoupler { .. }
        )
    }

    /// Spring and dashpot between pulley and accessory, if the coupling gives while it transmits.
    pub fn flexible(&self) -> Option<Flexible> {
        match self {
            Self::Rigid { .. } | Self::OneWay { .. } => None,
            Self::Isolator(spring) | Self::WrapSpring(spring) | Self::Decoupler { spring, .. } => {
                Some(*spring)
            }
        }
    }
}
