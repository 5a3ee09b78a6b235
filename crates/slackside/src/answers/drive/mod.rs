//! The answers about a drive, in the units of engineers: mm, degrees, rpm.

mod layout;
mod modes;
mod response;
mod sheet;
mod sheet_figures;
mod sheet_tables;

pub use response::DriveResponseAnswer;

/// Millimetres.
fn millimetres(metres: f64) -> String {
    format!("{:.1}", 1e3 * metres)
}

/// Degrees.
fn degrees(radians: f64) -> String {
    format!("{:.1}", radians.to_degrees())
}

/// With a fixed number of decimals.
fn fixed(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}")
}
