//! Motion: the exact flow of piecewise-linear systems.

mod error;
mod exact;
mod generator;
mod measure;
mod rate;
mod saltation;
mod step_map;
mod visitor;

pub use error::FlowError;
pub(crate) use exact::FlowState;
pub use exact::{EVENT_BUDGET, ExactFlow};
pub use measure::Request;
pub(crate) use measure::SummaryVisitor;
pub(crate) use rate::Rate;
pub(crate) use visitor::{Event, EventList, Piece, Unwatched, Visitor};
