//! Factorisations of real matrices: LU, Cholesky test, orthonormalisation.

use crate::{LinalgError, Matrix};
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{MatMut, Side};

/// Order up to which the small elimination below is used; beyond it the library's blocked code wins.
const SMALL: usize = 24;

/// LU factorisation with partial pivoting of a square matrix; solves `A x = b`.
#[derive(Debug, Clone)]
pub struct Lu {
    form: Form,
}

#[derive(Debug, Clone)]
enum Form {
    Small {
        factors: Matrix,
        pivots: Vec<usize>,
        sign: f64,
    },
    Blocked {
        factors: PartialPivLu<f64>,
        order: usize,
    },
}

impl Lu {
    /// Factors `matrix`, `2n³/3` operations.
    ///
    /// # Errors
    /// [`LinalgError::NotSquare`], [`LinalgError::NotFinite`], or [`LinalgError::Singular`] when a pivot is zero.
    pub fn new(matrix: &Matrix) -> Result<Self, LinalgError> {
        matrix.check_square()?;
        let order = matrix.rows();
        if order > SMALL {
            let factors = matrix.as_faer().partial_piv_lu();
            let upper = factors.U();
            if (0..order).any(|i| upper[(i, i)] == 0.0) {
                return Err(LinalgError::Singular);
            }
            return Ok(Self {
                form: Form::Blocked { factors, order },
            });
        }
        let mut factors = matrix.clone();
        let (pivots, sign) = eliminate(&mut factors);
        if (0..order).any(|i| factors[(i, i)] == 0.0) {
            return Err(LinalgError::Singular);
        }
        Ok(Self {
            form: Form::Small {
                factors,
                pivots,
                sign,
            },
        })
    }

    /// Solves `A x = b` in place.
    pub fn solve_in_place(&self, vector: &mut [f64]) {
        match &self.form {
            Form::Blocked { factors, order } => {
                factors.solve_in_place(MatMut::from_column_major_slice_mut(vector, *order, 1));
            }
            Form::Small { factors, pivots, .. } => {
                let n = pivots.len();
                for i in 0..n {
                    vector.swap(i, pivots[i]);
                }
                for i in 1..n {
                    let row = factors.row(i);
                    let sum: f64 = (0..i).map(|j| row[j] * vector[j]).sum();
                    vector[i] -= sum;
                }
                for i in (0..n).rev() {
                    let row = factors.row(i);
                    let sum: f64 = (i + 1..n).map(|j| row[j] * vector[j]).sum();
                    vector[i] = (vector[i] - sum) / row[i];
                }
            }
        }
    }

    /// The solution of `A x = b`.
    pub fn solve(&self, vector: &[f64]) -> Vec<f64> {
        let mut result = vector.to_vec();
        self.solve_in_place(&mut result);
        result
    }

    /// The solution of `A X = B` for a matrix of right-hand sides.
    pub fn solve_matrix(&self, right: &Matrix) -> Matrix {
        let mut result = Matrix::zeros(right.rows(), right.columns());
        for j in 0..right.columns() {
            let column = self.solve(&right.column(j));
            for i in 0..right.rows() {
                result[(i, j)] = column[i];
            }
        }
        result
    }

    /// The determinant of `A`.
    pub fn determinant(&self) -> f64 {
        match &self.form {
            Form::Blocked { factors, order } => {
                let upper = factors.U();
                let product: f64 = (0..*order).map(|i| upper[(i, i)]).product();
                let (forward, _) = factors.P().arrays();
                product * permutation_sign(forward)
            }
            Form::Small {
                factors,
                pivots,
                sign,
            } => (0..pivots.len()).map(|i| factors[(i, i)]).product::<f64>() * sign,
        }
    }
}

/// Gaussian elimination with row exchanges, in place. The library spends microseconds on setting up a system of
/// four unknowns; path following solves thousands of them.
fn eliminate(a: &mut Matrix) -> (Vec<usize>, f64) {
    let n = a.rows();
    let columns = a.columns();
    let mut sign = 1.0;
    let mut pivots = Vec::with_capacity(n);
    let data = a.as_mut_slice();
    for k in 0..n {
        let mut pivot = k;
        for i in k + 1..n {
            if data[i * columns + k].abs() > data[pivot * columns + k].abs() {
                pivot = i;
            }
        }
        pivots.push(pivot);
        if pivot != k {
            // Row exchange of finished factors too, so that the exchanges can be applied to a right side first.
            for j in 0..columns {
                data.swap(k * columns + j, pivot * columns + j);
            }
            sign = -sign;
        }
        let (head, tail) = data.split_at_mut((k + 1) * columns);
        let top = &head[k * columns..];
        if top[k] == 0.0 {
            continue;
        }
        let inverse = 1.0 / top[k];
        for row in tail.chunks_exact_mut(columns) {
            let factor = row[k] * inverse;
            row[k] = factor;
            for j in k + 1..columns {
                row[j] -= factor * top[j];
            }
        }
    }
    (pivots, sign)
}

fn permutation_sign(forward: &[usize]) -> f64 {
    let mut seen = vec![false; forward.len()];
    let mut sign = 1.0;
    for start in 0..forward.len() {
        let mut length = 0;
        let mut at = start;
        while !seen[at] {
            seen[at] = true;
            at = forward[at];
            length += 1;
        }
        if length > 0 && length % 2 == 0 {
            sign = -sign;
        }
    }
    sign
}

/// The determinant of a square matrix; zero when it is singular.
///
/// # Errors
/// [`LinalgError::NotSquare`] or [`LinalgError::NotFinite`].
pub fn determinant(matrix: &Matrix) -> Result<f64, LinalgError> {
    match Lu::new(matrix) {
        Ok(lu) => Ok(lu.determinant()),
        Err(LinalgError::Singular) => Ok(0.0),
        Err(error) => Err(error),
    }
}

/// Whether a matrix is finite, symmetric (to `1e-9` of its largest entry) and positive definite.
pub fn is_positive_definite(matrix: &Matrix) -> bool {
    if matrix.check_square().is_err() {
        return false;
    }
    let tolerance = 1e-9 * matrix.max_abs();
    let n = matrix.rows();
    let symmetric = (0..n).all(|i| (0..i).all(|j| (matrix[(i, j)] - matrix[(j, i)]).abs() <= tolerance));
    symmetric && matrix.as_faer().llt(Side::Lower).is_ok()
}

/// Replaces the columns of `matrix` by an orthonormal basis (Gram–Schmidt order, twice for orthogonality) and returns
/// the diagonal of the triangular factor, all entries non-negative. Used for Lyapunov exponents.
pub fn orthonormalize(matrix: &mut Matrix) -> Vec<f64> {
    let (rows, columns) = (matrix.rows(), matrix.columns());
    let mut diagonal = vec![0.0; columns];
    for j in 0..columns {
        for _ in 0..2 {
            for k in 0..j {
                let projection: f64 = (0..rows).map(|i| matrix[(i, k)] * matrix[(i, j)]).sum();
                for i in 0..rows {
                    let along = matrix[(i, k)];
                    matrix[(i, j)] -= projection * along;
                }
            }
        }
        let length = (0..rows).map(|i| matrix[(i, j)].powi(2)).sum::<f64>().sqrt();
        diagonal[j] = length;
        if length > 0.0 {
            for i in 0..rows {
                matrix[(i, j)] /= length;
            }
        }
    }
    diagonal
}
