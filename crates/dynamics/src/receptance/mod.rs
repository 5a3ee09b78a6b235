//! The linear part of a system seen from the ports of its elements: receptances, the force in a locked port, poles, and what
//! follows from them for the nonlinear motion (theory 05 §2.1, §5.3).
//!
//! [`LinearSystem`] has its ports open: the elements there are taken away. [`LockedSystem`] has them held at rest, and tells
//! the constraint forces that it takes: the force that a clutch that never opens, or a friction arm that never slips,
//! transmits. [`uniqueness`] certifies that the response is unique, or says why that is not known.

mod error;
mod linear_system;
mod locked_system;
mod pole_residue;
mod positive_real;
mod uniqueness;

pub use error::ReceptanceError;
pub use linear_system::LinearSystem;
pub(crate) use linear_system::{nonlinear_elements, project};
pub use locked_system::LockedSystem;
pub use pole_residue::Mobility;
pub use positive_real::RealPart;
pub use uniqueness::{Doubt, Uniqueness, uniqueness};
