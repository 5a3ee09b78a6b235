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
//! * [`write_atomically`] and [`write_bytes`]: a file is written whole or not at all.
//!
//! ```
//! use slackside_report::figures::{Branch, FigureOptions, Response, response};
//! use slackside_report::plot::Axis;
//! use slackside_report::{Column, Table};
//!
//! let frequency = vec![0.5, 1.0, 1.5];
//! let rms = vec![0.13, 2.0, 0.08];
//! let figure = response(
//!     &Response {
//!         x: Axis::linear("Excitation frequency Ω", "–"),
//!         y: Axis::linear("RMS of wind-up", "rad"),
//!         branches: vec![Branch {
//!             x: frequency.clone(),
//!             y: rms.clone(),
//!             stable: vec![true, false, true],
//!             ..Branch::default()
//!         }],
//!         ..Response::default()
//!     },
//!     &FigureOptions::default(),
//! );
//! assert!(figure.svg().contains("Excitation frequency Ω (–)"));
//!
//! let mut table = Table::new("response");
//! table.columns.push(Column::number("frequency", "", frequency));
//! table.columns.push(Column::number("rms", "rad", rms));
//! assert_eq!(table.csv()?, b"frequency,rms [rad]\r\n0.5,0.13\r\n1,2\r\n1.5,0.08\r\n");
//! # Ok::<(), slackside_report::ReportError>(())
//! ```
//!
//! Every output is deterministic: equal input gives equal bytes.

mod atomic_file;
mod error;
pub mod figures;
pub mod plot;
pub mod table;

pub use atomic_file::{write_atomically, write_bytes};
pub use error::ReportError;
pub use plot::Figure;
pub use table::{Column, Table, Values};
