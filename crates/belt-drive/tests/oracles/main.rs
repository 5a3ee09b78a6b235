//! Creep, the strong form of the linear model and the exact steady state: against integration, closed forms, the other
//! models, and what they refuse.

mod creep;
mod elastica;
mod six_pulleys;
mod strong_form;
