//! A dense real matrix, stored by rows.

use crate::LinalgError;
use faer::MatRef;
use std::ops::{Index, IndexMut};

/// A dense real matrix, stored by rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    data: Vec<f64>,
}

impl Matrix {
    /// The `rows × columns` matrix of zeros.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            data: vec![0.0; rows * columns],
        }
    }

    /// The identity of order `n`.
    pub fn identity(n: usize) -> Self {
        let mut matrix = Self::zeros(n, n);
        for i in 0..n {
            matrix[(i, i)] = 1.0;
        }
        matrix
    }

    /// The diagonal matrix with the given entries.
    pub fn diagonal(entries: &[f64]) -> Self {
        let mut matrix = Self::zeros(entries.len(), entries.len());
        for (i, &value) in entries.iter().enumerate() {
            matrix[(i, i)] = value;
        }
        matrix
    }

    /// A matrix from its rows; `None` if the rows differ in length.
    pub fn from_rows(rows: &[Vec<f64>]) -> Option<Self> {
        let columns = rows.first().map_or(0, Vec::len);
        if rows.iter().any(|row| row.len() != columns) {
            return None;
        }
        Some(Self {
            rows: rows.len(),
            columns,
            data: rows.concat(),
        })
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// One row.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.data[i * self.columns..(i + 1) * self.columns]
    }

    /// One row, to be written.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.data[i * self.columns..(i + 1) * self.columns]
    }

    /// One column, copied.
    pub fn column(&self, j: usize) -> Vec<f64> {
        (0..self.rows).map(|i| self[(i, j)]).collect()
    }

    /// All entries, row by row.
    pub fn as_slice(&self) -> &[f64] {
        &self.data
    }

    /// All entries, row by row, to be written.
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.data
    }

    /// Sets every entry.
    pub fn fill(&mut self, value: f64) {
        self.data.fill(value);
    }

    /// The transpose.
    pub fn transpose(&self) -> Self {
        let mut result = Self::zeros(self.columns, self.rows);
        for i in 0..self.rows {
            for j in 0..self.columns {
                result[(j, i)] = self[(i, j)];
            }
        }
        result
    }

    /// The rows and columns with these indices, in their order.
    pub fn selected(&self, indices: &[usize]) -> Self {
        let mut result = Self::zeros(indices.len(), indices.len());
        for (row, &i) in indices.iter().enumerate() {
            for (column, &j) in indices.iter().enumerate() {
                result[(row, column)] = self[(i, j)];
            }
        }
        result
    }

    /// `self · factor`, entry by entry.
    pub fn scaled(&self, factor: f64) -> Self {
        let mut result = self.clone();
        result.data.iter_mut().for_each(|value| *value *= factor);
        result
    }

    /// Adds `factor · other` in place. Both must have the same shape.
    pub fn add_scaled(&mut self, factor: f64, other: &Matrix) {
        debug_assert_eq!((self.rows, self.columns), (other.rows, other.columns));
        for (a, b) in self.data.iter_mut().zip(&other.data) {
            *a += factor * b;
        }
    }

    /// The product `self · other`, `O(rows · columns · other.columns)`.
    pub fn product(&self, other: &Matrix) -> Self {
        let mut result = Self::zeros(self.rows, other.columns);
        self.product_into(other, &mut result);
        result
    }

    /// Writes the product `self · other` into `result`, which must have its shape.
    pub fn product_into(&self, other: &Matrix, result: &mut Matrix) {
        debug_assert_eq!(self.columns, other.rows);
        debug_assert_eq!((result.rows, result.columns), (self.rows, other.columns));
        if self.rows * other.columns > 256 {
            faer::linalg::matmul::matmul(
                faer::MatMut::from_row_major_slice_mut(&mut result.data, self.rows, other.columns),
                faer::Accum::Replace,
                self.as_faer(),
                other.as_faer(),
                1.0,
                faer::Par::Seq,
            );
            return;
        }
        // Below a few hundred entries the library's set-up costs more than the product.
        result.data.fill(0.0);
        for i in 0..self.rows {
            let out = &mut result.data[i * other.columns..(i + 1) * other.columns];
            for k in 0..self.columns {
                let factor = self.data[i * self.columns + k];
                for (o, b) in out.iter_mut().zip(other.row(k)) {
                    *o += factor * b;
                }
            }
        }
    }

    /// The product with a column vector.
    pub fn times(&self, vector: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; self.rows];
        self.times_into(vector, &mut result);
        result
    }

    /// Writes the product with a column vector into `result` (length `rows`).
    pub fn times_into(&self, vector: &[f64], result: &mut [f64]) {
        for (i, out) in result.iter_mut().enumerate() {
            *out = dot(self.row(i), vector);
        }
    }

    /// Largest absolute entry; zero for an empty matrix.
    pub fn max_abs(&self) -> f64 {
        self.data
            .iter()
            .fold(0.0, |largest, value| largest.max(value.abs()))
    }

    /// The largest row sum of absolute values (the norm induced by the maximum norm).
    pub fn norm_infinity(&self) -> f64 {
        (0..self.rows)
            .map(|i| self.row(i).iter().map(|v| v.abs()).sum())
            .fold(0.0, f64::max)
    }

    /// Whether every entry is finite.
    pub fn is_finite(&self) -> bool {
        self.data.iter().all(|value| value.is_finite())
    }

    pub(crate) fn as_faer(&self) -> MatRef<'_, f64> {
        MatRef::from_row_major_slice(&self.data, self.rows, self.columns)
    }

    pub(crate) fn check_square(&self) -> Result<(), LinalgError> {
        if self.rows != self.columns {
            return Err(LinalgError::NotSquare {
                rows: self.rows,
                columns: self.columns,
            });
        }
        if !self.is_finite() {
            return Err(LinalgError::NotFinite);
        }
        Ok(())
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;
    #[inline]
    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.data[i * self.columns + j]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    #[inline]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.data[i * self.columns + j]
    }
}

/// Scalar product of two vectors of the same length.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Euclidean norm.
#[inline]
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
