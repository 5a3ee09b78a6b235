//! Branches of periodic motions: stability along them, special points by name, branches that start at period doublings.

mod follow;
mod record;
mod switching;

pub use follow::{BranchFamily, BranchOptions, follow, follow_from};
pub use record::{Branch, BranchPoint, SpecialKind, SpecialPoint};
pub use switching::{DoublingStart, doubling_start};
