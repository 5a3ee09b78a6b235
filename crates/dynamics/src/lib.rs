//! Nonlinear dynamics of mechanical systems: exact flow with events, periodic orbits, branches, attractors.
//!
//! Every method starts from a [`slackside_mechanics::System`] and knows nothing of belts.

pub mod attractor;
pub mod branch;
pub mod closed_form;
pub mod flow;
pub mod orbit;
pub mod receptance;
