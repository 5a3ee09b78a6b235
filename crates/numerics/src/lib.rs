//! Roots, Bernstein certificates, Fourier transforms, statistics and smooth integration.

pub mod fourier;
pub mod ode;
pub mod polynomial;
pub mod quadrature;

mod fused;

pub use fused::multiply_add;
