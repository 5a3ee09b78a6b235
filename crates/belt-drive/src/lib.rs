//! Belt and pulley models that become mechanical systems.
//!
//! A model knows belts and pulleys and nothing of solvers: it turns a description and an operating point into a
//! [`slackside_mechanics::System`] or into linear matrices with the rows that results are read from.

pub mod creep;
pub mod dimensionless;
pub mod drive;
pub mod elastica;
pub mod forced_response;
pub mod layout;
pub mod model;
pub mod modes;
pub mod prototypes;
pub mod span;
pub mod steady;
pub mod strong_form;
pub mod system;
