//! The questions a user asks, one file for each: plan, run, collect.
//!
//! A study knows a [`Subject`] (a model and where it comes from) and the options of its question. It plans self-contained
//! jobs, runs each of them ([`Study::run`]) and collects their rows into a document that serialises as users read it.
//! [`execute`] does all three, with the jobs in parallel, progress and interruption through a [`Signal`]. A study neither
//! draws nor prints.

mod document;
mod error;
mod label;
mod range;
mod separation;
mod signal;
mod statics;
mod study;
mod subject;

pub mod basin;
pub mod check;
pub mod compare;
pub mod drive;
pub mod limit;
pub mod modes;
pub mod response;
pub mod simulate;
pub mod sweep;

pub use document::{
    ElementRow, Energy, Event, Header, Input, Measure, Measures, Method, Motion, Named, Parameter, Ratios,
    Texts, UnitLabels, motion, pair,
};
pub use error::StudyError;
pub use label::{Label, LabelValue};
pub use range::{Range, RangeError};
pub use signal::{Progress, Signal};
pub use statics::{LinearResponse, check_period, linear_response, rest_state, static_equilibrium};
pub use study::{Study, execute};
pub use subject::{KeyFamily, Quantity, Subject};
