//! Square matrices as lists of rows.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Serialize, Serializer};
use slackside_linalg::Matrix;

use crate::error::Issue;
use crate::node::{Node, Value};
use crate::reader::{Read, read_quantities, wrong_type};
use crate::scalar::{Numbers, join, split_first};
use crate::schema::QuantitySchema;
use crate::units::Quantity;

/// A square matrix, written as a list of rows.
#[derive(Clone, Debug, PartialEq)]
pub struct SquareMatrix(Matrix);

impl SquareMatrix {
    /// The matrix for computations.
    pub fn as_matrix(&self) -> &Matrix {
        &self.0
    }

    /// Reads a matrix with one row and one column for each of `order` coordinates.
    pub(super) fn read(node: &Node, path: &str, order: usize, quantity: &Quantity) -> Read<Self> {
        let Value::Array(rows) = &node.value else {
            return Err(wrong_type(node, path, "a matrix, written as a list of rows"));
        };
        if rows.len() != order {
            return Err(Issue::wrong_value(path, wrong_size(rows.len(), "row", order))
                .at(&node.origin)
                .with_help(HELP_SIZE));
        }
        let mut matrix = Matrix::zeros(order, order);
        for (index, row) in rows.iter().enumerate() {
            let row_path = join(path, &index.to_string());
            let entries = read_quantities(row, &row_path, quantity)?;
            if entries.len() != order {
                return Err(
                    Issue::wrong_value(row_path, wrong_size(entries.len(), "column", order))
                        .at(&row.origin)
                        .with_value(row.shown())
                        .with_help(HELP_SIZE),
                );
            }
            matrix.row_mut(index).copy_from_slice(&entries);
        }
        Ok(Self(matrix))
    }

    /// Checks that all entries are finite.
    pub(super) fn check_finite(&self, path: &str) -> Read<()> {
        for row in 0..self.0.rows() {
            for (column, entry) in self.0.row(row).iter().enumerate() {
                if !entry.is_finite() {
                    return Err(Issue::wrong_value(
                        format!("{path}.{row}.{column}"),
                        "is not a finite number",
                    )
                    .with_number(*entry)
                    .with_help("give a finite number"));
                }
            }
        }
        Ok(())
    }

    /// Makes entries equal to their mirror images where they differ by rounding only, relative to the largest entry.
    pub(super) fn with_rounding_removed(mut self) -> Self {
        let tolerance = 1e-9 * self.0.max_abs();
        for row in 0..self.0.rows() {
            for column in 0..row {
                if (self.0[(row, column)] - self.0[(column, row)]).abs() <= tolerance {
                    self.0[(row, column)] = self.0[(column, row)];
                }
            }
        }
        self
    }

    /// Sets the mirror image of an entry to the same value.
    pub(super) fn mirror(&mut self, path: &str) {
        if let Some((row, column)) = self.position(path) {
            self.0[(column, row)] = self.0[(row, column)];
        }
    }

    /// Row and column of an entry's path, for example `0.1`.
    fn position(&self, path: &str) -> Option<(usize, usize)> {
        let (row, column) = split_first(path);
        let in_range = |index: &str| index.parse().ok().filter(|index| *index < self.0.rows());
        Some((in_range(row)?, in_range(column)?))
    }
}

const HELP_SIZE: &str = "give one row and one column for each coordinate";

fn wrong_size(found: usize, what: &str, order: usize) -> String {
    let plural = if found == 1 { "" } else { "s" };
    let coordinates = if order == 1 { "coordinate" } else { "coordinates" };
    format!("{found} {what}{plural} for {order} {coordinates}")
}

impl Numbers for SquareMatrix {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        let position = self.position(path)?;
        Some(&mut self.0[position])
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        for row in 0..self.0.rows() {
            for column in 0..self.0.columns() {
                keys.push(format!("{prefix}.{row}.{column}"));
            }
        }
    }
}

impl Serialize for SquareMatrix {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.0.rows()).map(|row| self.0.row(row)))
    }
}

impl JsonSchema for SquareMatrix {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "SquareMatrix".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = Vec::<Vec<QuantitySchema>>::json_schema(generator);
        schema.insert(
            "description".to_owned(),
            "A square matrix as a list of rows, one row and column for each coordinate.".into(),
        );
        schema
    }
}
