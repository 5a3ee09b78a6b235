//! Belt and pulley models that become mechanical systems.
//!
//! A model knows belts and pulleys and nothing of solvers: it turns physical parameters into a
//! [`slackside_mechanics::System`].

pub mod prototypes;
