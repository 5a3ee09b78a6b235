//! Properties of the drive model on random drives: derivatives against differences, balances, closed forms, invariances,
//! and what is said about drives that cannot run.

mod closed_forms;
mod damping;
mod drives;
mod forced_response;
mod geometry;
mod impossible;
mod matrices;
mod modes;
mod span;
mod steady;
mod system;
