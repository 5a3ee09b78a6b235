//! What can go wrong in a dense linear-algebra call.

/// Failure of a dense linear-algebra call.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LinalgError {
    /// An entry is NaN or infinite.
    #[error("the matrix has an entry that is not finite")]
    NotFinite,
    /// A matrix that must be square is not.
    #[error("the matrix must be square but is {rows} by {columns}")]
    NotSquare {
        /// Number of rows found.
        rows: usize,
        /// Number of columns found.
        columns: usize,
    },
    /// A symmetric matrix that must be positive definite is not.
    #[error("the matrix is not symmetric positive definite")]
    NotPositiveDefinite,
    /// A linear system with a singular matrix.
    #[error("the matrix is singular to working precision")]
    Singular,
    /// The eigenvalue iteration did not converge.
    #[error("the eigenvalue iteration did not converge")]
    NoConvergence,
}
