//! Points of a branch.

use crate::StopReason;

/// A solution on a branch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Point {
    /// Unknowns.
    pub z: Vec<f64>,
    /// Parameter.
    pub p: f64,
    /// Unit tangent in scaled variables, in the direction of the run; the last entry belongs to the parameter.
    pub tangent: Vec<f64>,
    /// Distance along the branch from its first point, in scaled variables.
    pub arclength: f64,
    /// Newton iterations spent.
    pub iterations: usize,
    /// Largest scaled residual at the last evaluation.
    pub residual: f64,
    /// Values of the family's test functions.
    pub tests: Vec<f64>,
    /// The family's discrete pattern.
    pub pattern: i64,
    /// What the family observed.
    pub observed: Vec<f64>,
    /// Sign of the bordered determinant, whose change without a fold marks a branch point.
    pub determinant_sign: f64,
}

/// What makes a point special.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The parameter turns.
    Fold,
    /// Another branch crosses.
    BranchPoint,
    /// The family's test function with this index is zero.
    Test(usize),
    /// The family's discrete pattern changes.
    Change {
        /// Pattern before.
        from: i64,
        /// Pattern after.
        to: i64,
    },
}

/// A special point, located on the branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Special {
    /// Its kind.
    pub kind: Kind,
    /// The solution there.
    pub point: Point,
}

/// A branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Its points in order.
    pub points: Vec<Point>,
    /// Its special points in order.
    pub special: Vec<Special>,
    /// How it ended.
    pub stop: StopReason,
}
