//! The method of multiple scales at a primary resonance of a system with one two-piece spring (theory 02 §10, §11).
//!
//! A wrap-spring clutch is a linear spring as long as it is engaged. Damping, load and the torque that opening takes away
//! are treated as small, of order `ε`; the motion near a natural frequency `ω_n` of the engaged system is then a slowly
//! varying oscillation of that mode,
//!
//! ```text
//! z_n = a cos ϑ + ε …,    ϑ = Ωt − ψ,    z_j = 0 + ε …  (j ≠ n),
//! ```
//!
//! whose amplitude `a` and phase `ψ` obey two equations. Their steady states are known in closed form at first order and
//! from one implicit relation at second order.
//!
//! * [`ModalForm`]: the engaged modes of a system, and whether it is of the form at all.
//! * [`Separation`]: Fourier coefficients of the separation function and of the torque that opening takes away.
//! * [`PrimaryResonance`]: slow flow, steady states, response curve, folds, onset of separation, stability, motion.
//! * [`MultipleScales`]: the same steady states as a family to be followed in any parameter.
//!
//! Nothing here is specific to belts, nor to the wrap spring: any element whose force is two straight pieces of its
//! displacement, one of which holds the state of rest, is covered (a compliant stop with a gap, for example).

mod arcs;
mod curve;
mod error;
mod family;
mod modal_form;
mod motion;
mod resonance;
mod separation;
mod slow_flow;

pub use curve::CurvePoint;
pub use error::MultipleScalesError;
pub use family::MultipleScales;
pub use modal_form::{ModalForm, ModalMode};
pub use motion::WindupStatistics;
pub use resonance::{PrimaryResonance, Remark};
pub use separation::Separation;
pub use slow_flow::{Order, SlowFlow, SteadyState};
