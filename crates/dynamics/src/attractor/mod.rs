//! Settled motion: what kind it is, where it lies in state space, and from which starts it is reached (theory 02 §9).
//!
//! A motion that no longer depends on its start lies on an attractor, which shows in its stroboscopic points
//! ([`stroboscopic`]): finitely many for a periodic motion, a closed curve with a [`rotation_number`] for a quasi-periodic
//! one, a set with at least one positive [`lyapunov`] exponent for a chaotic one. [`classify`] tells which; [`sweep`] steps
//! a parameter and reports each settled motion; [`basin`] finds which attractor each of a grid of starts reaches.

pub mod basin;
mod classify;
mod lyapunov;
mod periodic;
mod poincare;
mod rotation_number;
mod spectrum;
mod sweep;

pub use classify::{Attractor, ClassifyOptions, classify, settle};
pub use lyapunov::{LyapunovOptions, LyapunovSpectrum, lyapunov};
pub use periodic::{PeriodicAttractor, Recognition, RecognitionOptions, Recognizer};
pub use poincare::{PoincareMap, stroboscopic};
pub use rotation_number::{RotationError, RotationNumber, rotation_number};
pub use spectrum::amplitude_spectrum;
pub use sweep::{SweepOptions, SweepStep, SweepStop, sweep, sweep_step};
