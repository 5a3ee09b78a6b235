//! Steady creep: an extensible belt is faster where it is tighter, so on every loaded pulley a part of the contact slips
//! (theory 04 §6).
//!
//! Each pulley has an adhesion arc at the entry, where the belt moves with the rim, and a slip arc at the exit, where
//! Coulomb friction carries the whole change of tension. [`steady_creep`] applies this to a drive whose tensions are
//! known; [`TwoPulleyBelt`] is the closed theory of two pulleys, in which creep itself decides the tensions.

mod error;
mod root;
mod steady;
mod two_pulley;

pub use error::CreepError;
pub use steady::{Contact, Creep, PulleyCreep, SlipDirection, contact_of, steady_creep};
pub use two_pulley::{LargestTorque, TwoPulleyBelt, TwoPulleyCreep};
