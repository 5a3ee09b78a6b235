//! The answers of each verb as summary, tables and figures.

mod basin;
mod check;
pub mod compare;
pub mod drive;
mod engagement;
mod limit;
mod modes;
pub mod response;
mod simulate;
pub mod sweep;
