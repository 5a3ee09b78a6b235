//! Tables: named columns with units, written as CSV or Parquet.
//!
//! A number that is NaN, and a text that is empty, is *missing*: an empty cell in CSV, a null in Parquet.

mod csv_format;
mod parquet_format;

use std::collections::HashSet;
use std::io::Write;
use std::path::Path;

use crate::{ReportError, write_atomically, write_bytes};

/// A rectangular table. All columns have the same number of rows and different names.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Name of the table: the file name without its ending, by custom.
    pub name: String,
    /// The columns from left to right.
    pub columns: Vec<Column>,
}

/// One column of a [`Table`].
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the quantity.
    pub name: String,
    /// Unit, for example `rad/s`; empty when the column has none.
    pub unit: String,
    /// The rows.
    pub values: Values,
}

/// The rows of a [`Column`], all of one type.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Floating-point numbers; NaN is missing.
    Number(Vec<f64>),
    /// Texts; the empty text is missing.
    Text(Vec<String>),
    /// Whole numbers.
    Integer(Vec<i64>),
    /// Truth values, `true` or `false`.
    Boolean(Vec<bool>),
}

impl Values {
    /// Number of rows.
    pub fn len(&self) -> usize {
        match self {
            Values::Number(values) => values.len(),
            Values::Text(values) => values.len(),
            Values::Integer(values) => values.len(),
            Values::Boolean(values) => values.len(),
        }
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Column {
    /// A column of floating-point numbers.
    pub fn number(name: impl Into<String>, unit: impl Into<String>, values: Vec<f64>) -> Self {
        Column {
            name: name.into(),
            unit: unit.into(),
            values: Values::Number(values),
        }
    }

    /// A column of texts, without unit.
    pub fn text(name: impl Into<String>, values: Vec<String>) -> Self {
        Column {
            name: name.into(),
            unit: String::new(),
            values: Values::Text(values),
        }
    }

    /// A column of whole numbers, without unit.
    pub fn integer(name: impl Into<String>, values: Vec<i64>) -> Self {
        Column {
            name: name.into(),
            unit: String::new(),
            values: Values::Integer(values),
        }
    }

    /// A column of truth values.
    pub fn boolean(name: impl Into<String>, values: Vec<bool>) -> Self {
        Column {
            name: name.into(),
            unit: String::new(),
            values: Values::Boolean(values),
        }
    }
}

impl Table {
    /// An empty table with a name; push [`Column`]s to it.
    pub fn new(name: impl Into<String>) -> Self {
        Table {
            name: name.into(),
            columns: Vec::new(),
        }
    }

    /// Number of rows: that of the first column.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// Writes the table as CSV by RFC 4180: one header row `name [unit]` (only `name` without unit), fields
    /// quoted where needed, lines ended by CR LF, numbers in the shortest form that reads back to the same
    /// bits, missing values empty.
    ///
    /// # Errors
    /// A table that is not rectangular, has no columns or repeats a name; a writer that refuses.
    pub fn write_csv(&self, out: impl Write) -> Result<(), ReportError> {
        self.check()?;
        csv_format::write(self, out)
    }

    /// Writes the table as Parquet, one row group, Snappy compression. The unit of column `c` is the value of
    /// the file's metadata key `unit.c`, the table's name that of `table`. Numbers are `DOUBLE`, texts
    /// `BYTE_ARRAY (STRING)`, both nullable; whole numbers `INT64`; truth values `BOOLEAN`.
    ///
    /// # Errors
    /// As [`Table::write_csv`].
    pub fn write_parquet(&self, out: impl Write + Send) -> Result<(), ReportError> {
        self.check()?;
        parquet_format::write(self, out)
    }

    /// The CSV file as bytes; see [`Table::write_csv`].
    ///
    /// # Errors
    /// As [`Table::write_csv`].
    pub fn csv(&self) -> Result<Vec<u8>, ReportError> {
        let mut bytes = Vec::new();
        self.write_csv(&mut bytes)?;
        Ok(bytes)
    }

    /// The Parquet file as bytes; see [`Table::write_parquet`].
    ///
    /// # Errors
    /// As [`Table::write_csv`].
    pub fn parquet(&self) -> Result<Vec<u8>, ReportError> {
        let mut bytes = Vec::new();
        self.write_parquet(&mut bytes)?;
        Ok(bytes)
    }

    /// Writes the CSV file `path`, whole or not at all.
    ///
    /// # Errors
    /// As [`Table::write_csv`] and [`write_atomically`].
    pub fn save_csv(&self, path: &Path) -> Result<(), ReportError> {
        write_atomically(path, |out| self.write_csv(out))
    }

    /// Writes the Parquet file `path`, whole or not at all.
    ///
    /// # Errors
    /// As [`Table::write_csv`] and [`write_atomically`].
    pub fn save_parquet(&self, path: &Path) -> Result<(), ReportError> {
        write_bytes(path, &self.parquet()?)
    }

    /// Rectangular, at least one column, names different.
    fn check(&self) -> Result<(), ReportError> {
        let Some(first) = self.columns.first() else {
            return Err(ReportError::NoColumns {
                table: self.name.clone(),
            });
        };
        let expected = first.values.len();
        let mut names = HashSet::new();
        for column in &self.columns {
            if column.values.len() != expected {
                return Err(ReportError::ColumnLength {
                    table: self.name.clone(),
                    column: column.name.clone(),
                    length: column.values.len(),
                    expected,
                });
            }
            if !names.insert(column.name.as_str()) {
                return Err(ReportError::DuplicateColumn {
                    table: self.name.clone(),
                    column: column.name.clone(),
                });
            }
        }
        Ok(())
    }
}
