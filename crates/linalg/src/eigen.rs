//! Eigenvalues: general real matrices, and undamped modes by the symmetric problem.

use crate::balance::balance;
use crate::{Complex, ComplexMatrix, LinalgError, Matrix};
use faer::Side;

/// Eigenvalues and right eigenvectors of a general real matrix.
#[derive(Debug, Clone)]
pub struct Eigen {
    /// Eigenvalues, complex pairs adjacent.
    pub values: Vec<Complex>,
    /// Eigenvectors as columns, in the order of `values`.
    pub vectors: ComplexMatrix,
}

/// Eigenvalues of a general real matrix, balanced first so that they do not depend on units, `O(n³)`.
///
/// # Errors
/// [`LinalgError::NotSquare`], [`LinalgError::NotFinite`] or [`LinalgError::NoConvergence`].
pub fn eigenvalues(matrix: &Matrix) -> Result<Vec<Complex>, LinalgError> {
    matrix.check_square()?;
    if matrix.rows() == 0 {
        return Ok(Vec::new());
    }
    let mut balanced = matrix.clone();
    balance(&mut balanced);
    balanced
        .as_faer()
        .eigenvalues()
        .map_err(|_| LinalgError::NoConvergence)
}

/// Eigenvalues and right eigenvectors of a general real matrix, balanced first so that they do not depend on units, `O(n³)`.
///
/// # Errors
/// [`LinalgError::NotSquare`], [`LinalgError::NotFinite`] or [`LinalgError::NoConvergence`].
pub fn eigen(matrix: &Matrix) -> Result<Eigen, LinalgError> {
    matrix.check_square()?;
    let n = matrix.rows();
    let mut balanced = matrix.clone();
    let scales = balance(&mut balanced);
    let decomposition = balanced
        .as_faer()
        .eigen()
        .map_err(|_| LinalgError::NoConvergence)?;
    let (diagonal, u) = (decomposition.S(), decomposition.U());
    let values = (0..n).map(|i| diagonal[i]).collect();
    let mut vectors = ComplexMatrix::zeros(n, n);
    for i in 0..n {
        for j in 0..n {
            vectors[(i, j)] = u[(i, j)] * scales[i];
        }
    }
    Ok(Eigen { values, vectors })
}

/// Eigenvalues of a symmetric matrix, ascending; the lower triangle is read.
///
/// # Errors
/// [`LinalgError::NotSquare`], [`LinalgError::NotFinite`] or [`LinalgError::NoConvergence`].
pub fn symmetric_eigenvalues(matrix: &Matrix) -> Result<Vec<f64>, LinalgError> {
    matrix.check_square()?;
    matrix
        .as_faer()
        .self_adjoint_eigenvalues(Side::Lower)
        .map_err(|_| LinalgError::NoConvergence)
}

/// Modes of `M q'' + K q = 0`.
#[derive(Debug, Clone)]
pub struct UndampedModes {
    /// `ω²`, ascending; negative for a statically unstable direction.
    pub squared_frequencies: Vec<f64>,
    /// Mode shapes as columns, scaled so that `Φᵀ M Φ = I`.
    pub shapes: Matrix,
}

/// Modes of `M q'' + K q = 0` with `M` symmetric positive definite and `K` symmetric: `M = L Lᵀ`, then the symmetric
/// eigenproblem of `L⁻¹ K L⁻ᵀ`.
///
/// # Errors
/// [`LinalgError::NotPositiveDefinite`] for the mass matrix, and the errors of a square eigenproblem.
pub fn undamped_modes(mass: &Matrix, stiffness: &Matrix) -> Result<UndampedModes, LinalgError> {
    mass.check_square()?;
    stiffness.check_square()?;
    let n = mass.rows();
    let cholesky = mass
        .as_faer()
        .llt(Side::Lower)
        .map_err(|_| LinalgError::NotPositiveDefinite)?;
    let lower = cholesky.L();
    let mut reduced = faer::Mat::from_fn(n, n, |i, j| 0.5 * (stiffness[(i, j)] + stiffness[(j, i)]));
    lower.solve_lower_triangular_in_place(reduced.as_mut());
    lower.solve_lower_triangular_in_place(reduced.as_mut().transpose_mut());
    let decomposition = reduced
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| LinalgError::NoConvergence)?;
    let mut vectors = decomposition.U().to_owned();
    lower
        .transpose()
        .solve_upper_triangular_in_place(vectors.as_mut());
    let mut shapes = Matrix::zeros(n, n);
    for i in 0..n {
        for j in 0..n {
            shapes[(i, j)] = vectors[(i, j)];
        }
    }
    let values = decomposition.S();
    Ok(UndampedModes {
        squared_frequencies: (0..n).map(|i| values[i]).collect(),
        shapes,
    })
}
