//! The answers of each verb as summary, tables and figures.

mod basin;
mod check;
pub mod compare;
pub mod drive;
mod engagement;
mod family;
mod limit;
mod modes;
mod regimes;
pub mod response;
mod simulate;
pub mod sweep;
