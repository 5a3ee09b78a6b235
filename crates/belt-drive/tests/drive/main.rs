//! Properties of the drive model on random drives: derivatives against differences, balances, closed forms, invariances,
//! and what is said about drives that cannot run.

mod damping;
mod drives;
mod geometry;
mod matrices;
mod span;
mod steady;
