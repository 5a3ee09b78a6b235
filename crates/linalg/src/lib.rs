//! Dense linear algebra behind plain functions on [`Matrix`] and [`ComplexMatrix`].
//!
//! This is the only crate that knows the linear-algebra library. Its functions are not generic, so
//! the library is compiled once, here, at full optimisation, and an edit elsewhere rebuilds in seconds.
//! All functions check that their input is finite: the library's iterations may not end otherwise.

mod balance;
mod complex;
mod eigen;
mod error;
mod exponential;
mod factor;
mod gyroscopic_eigen;
mod matrix;

pub use complex::{ComplexLu, ComplexMatrix};
pub use eigen::{Eigen, UndampedModes, eigen, eigenvalues, symmetric_eigenvalues, undamped_modes};
pub use error::LinalgError;
pub use exponential::exponential;
pub use factor::{Lu, determinant, is_positive_definite, orthonormalize};
pub use gyroscopic_eigen::{GyroscopicModes, gyroscopic_modes};
pub use matrix::{Matrix, dot, norm};

/// Complex number in double precision.
pub type Complex = num_complex::Complex<f64>;
