//! A dense complex matrix and its LU factorisation (dynamic stiffness, harmonic balance).

use crate::{Complex, LinalgError, Matrix};
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{MatMut, MatRef};
use std::ops::{Index, IndexMut};

/// A dense complex matrix, stored by rows.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplexMatrix {
    rows: usize,
    columns: usize,
    data: Vec<Complex>,
}

impl ComplexMatrix {
    /// The `rows × columns` matrix of zeros.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            data: vec![Complex::ZERO; rows * columns],
        }
    }

    /// `Σ factor · matrix` over real matrices of one shape, as in `−ω²M + iωC + K`.
    pub fn combination(terms: &[(Complex, &Matrix)]) -> Self {
        let (rows, columns) = terms.first().map_or((0, 0), |(_, m)| (m.rows(), m.columns()));
        let mut result = Self::zeros(rows, columns);
        for (factor, matrix) in terms {
            for (a, b) in result.data.iter_mut().zip(matrix.as_slice()) {
                *a += factor * b;
            }
        }
        result
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The product with a column vector.
    pub fn times(&self, vector: &[Complex]) -> Vec<Complex> {
        self.data
            .chunks_exact(self.columns.max(1))
            .map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
            .collect()
    }

    /// The LU factorisation with partial pivoting.
    ///
    /// # Errors
    /// [`LinalgError::NotSquare`], [`LinalgError::NotFinite`] or [`LinalgError::Singular`].
    pub fn lu(&self) -> Result<ComplexLu, LinalgError> {
        if self.rows != self.columns {
            return Err(LinalgError::NotSquare {
                rows: self.rows,
                columns: self.columns,
            });
        }
        if self.data.iter().any(|v| !v.re.is_finite() || !v.im.is_finite()) {
            return Err(LinalgError::NotFinite);
        }
        let factors = MatRef::from_row_major_slice(&self.data, self.rows, self.columns).partial_piv_lu();
        let upper = factors.U();
        if (0..self.rows).any(|i| upper[(i, i)] == Complex::ZERO) {
            return Err(LinalgError::Singular);
        }
        Ok(ComplexLu {
            factors,
            order: self.rows,
        })
    }
}

impl Index<(usize, usize)> for ComplexMatrix {
    type Output = Complex;
    fn index(&self, (i, j): (usize, usize)) -> &Complex {
        &self.data[i * self.columns + j]
    }
}

impl IndexMut<(usize, usize)> for ComplexMatrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut Complex {
        &mut self.data[i * self.columns + j]
    }
}

/// LU factorisation of a complex matrix; solves `A x = b`.
#[derive(Debug, Clone)]
pub struct ComplexLu {
    factors: PartialPivLu<Complex>,
    order: usize,
}

impl ComplexLu {
    /// The solution of `A x = b`.
    pub fn solve(&self, vector: &[Complex]) -> Vec<Complex> {
        let mut result = vector.to_vec();
        self.factors
            .solve_in_place(MatMut::from_column_major_slice_mut(&mut result, self.order, 1));
        result
    }
}
