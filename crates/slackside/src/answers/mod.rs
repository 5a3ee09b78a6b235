//! The answers of each verb as summary, tables and figures.

mod check;
mod modes;
pub mod response;
mod simulate;
