//! The answers of each verb as summary, tables and figures.

mod basin;
mod check;
mod engagement;
mod modes;
pub mod response;
mod simulate;
pub mod sweep;
