//! Pseudo-arclength continuation of any residual `F(z, p) = 0`.
//!
//! The crate knows vectors only. A [`Family`] is a residual with its derivatives; [`trace`] follows its solutions around
//! folds, locates the zeros of its test functions on the curve, and says how it ended. Shooting, harmonic balance and
//! equilibria are all followed by this code.

mod corrector;
mod family;
mod locate;
mod options;
mod point;
mod trace;
mod zero;

pub use family::{Evaluation, Family, FamilyError};
pub use options::{Options, StopReason};
pub use point::{Kind, Point, Special, Trace};
pub use trace::{Unwatched, Watch, trace, trace_from};
