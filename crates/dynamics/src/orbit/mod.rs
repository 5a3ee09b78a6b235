//! Periodic motions and what is reported of them.

pub mod floquet;
pub mod harmonic_balance;
pub mod multiple_scales;
pub mod periodic;
pub mod set_valued;
pub mod shooting;
mod summary;

pub use summary::{EventRecord, MeasureSummary};
