//! Tables and figures.
//!
//! This crate turns plain data into files that people and programs read: tables as CSV and Parquet
//! ([`table`]), figures as SVG and PNG ([`figures`]). It computes nothing about the system and knows none of
//! the other crates, so that a figure can be drawn from a study that has just run as well as from numbers
//! read from a file.
//!
//! * [`table`]: columns with names and units, and their writers.
//! * [`figures`]: one function per kind of figure, from a plain input struct to a [`Figure`].
//! * [`plot`]: the description of a chart (axes, panels, series) on which the figures are built, and its
//!   drawing.
//! * [`write_atomically`]: a file is written whole or not at all.
//!
//! Every output is deterministic: equal input gives equal bytes.

mod atomic_file;
mod error;
pub mod figures;
pub mod plot;
pub mod table;

pub use atomic_file::write_atomically;
pub use error::ReportError;
pub use plot::Figure;
pub use table::{Column, Table, Values};
