//! What can go wrong between data and file.

use std::path::PathBuf;

/// A table or figure could not be produced.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The columns of a table have different lengths.
    #[error("table `{table}`: column `{column}` has {length} rows, the first column has {expected}")]
    ColumnLength {
        /// Name of the table.
        table: String,
        /// Name of the column that differs.
        column: String,
        /// Its number of rows.
        length: usize,
        /// Number of rows of the first column.
        expected: usize,
    },
    /// Two columns of a table have the same name.
    #[error("table `{table}`: two columns are named `{column}`")]
    DuplicateColumn {
        /// Name of the table.
        table: String,
        /// The repeated name.
        column: String,
    },
    /// A table without columns cannot be stored.
    #[error("table `{table}` has no columns")]
    NoColumns {
        /// Name of the table.
        table: String,
    },
    /// The CSV writer failed.
    #[error("table `{table}` could not be written as CSV")]
    Csv {
        /// Name of the table.
        table: String,
        /// The writer's reason.
        source: csv::Error,
    },
    /// The Parquet writer failed.
    #[error("table `{table}` could not be written as Parquet")]
    Parquet {
        /// Name of the table.
        table: String,
        /// The writer's reason.
        source: parquet::errors::ParquetError,
    },
    /// The drawing could not be turned into pixels.
    #[error("figure could not be drawn as PNG: {reason}")]
    Raster {
        /// What the renderer or encoder said.
        reason: String,
    },
    /// The requested size in pixels is not positive, or larger than the renderer can hold.
    #[error(
        "figure at scale {scale} would have {width} x {height} pixels; choose a scale that gives 1 to {limit} pixels a side"
    )]
    RasterSize {
        /// Requested scale, pixels per CSS pixel (1/96 inch).
        scale: f64,
        /// Width that follows, pixels.
        width: f64,
        /// Height that follows, pixels.
        height: f64,
        /// Largest permitted side, pixels.
        limit: u32,
    },
    /// A file could not be written; an earlier file of that name is unchanged.
    #[error("`{}` could not be written", path.display())]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// The reason given by the system.
        source: std::io::Error,
    },
}
