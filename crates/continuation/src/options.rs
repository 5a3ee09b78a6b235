//! How a branch is followed, and how following ends.

/// Options of [`crate::trace`]. Distances are arclength in scaled variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// First step.
    pub first_step: f64,
    /// Smallest step; a shorter one ends the run.
    pub min_step: f64,
    /// Largest step.
    pub max_step: f64,
    /// Largest number of points.
    pub max_points: usize,
    /// Newton's method ends when its step is shorter than this.
    pub tolerance: f64,
    /// It also ends when it stagnates below this: rounding does not allow more.
    pub loose_tolerance: f64,
    /// Newton's method is given up when a step is longer than this factor times the one before.
    pub divergence: f64,
    /// Largest number of Newton iterations.
    pub max_iterations: usize,
    /// Range of the parameter, both ends included.
    pub range: (f64, f64),
    /// Whether special points are located.
    pub locate: bool,
}

impl Options {
    /// Defaults for a parameter range.
    pub fn over(low: f64, high: f64) -> Self {
        Self {
            first_step: 0.01,
            min_step: 1e-7,
            max_step: 0.025,
            max_points: 20_000,
            tolerance: 1e-12,
            loose_tolerance: 1e-9,
            divergence: 2.0,
            max_iterations: 10,
            range: (low, high),
            locate: true,
        }
    }
}

/// How following a branch ended.
#[derive(Debug, Clone, PartialEq)]
pub enum StopReason {
    /// No solution was found near the start; why.
    NoStart(String),
    /// The parameter reached the end of its range.
    RangeLimit,
    /// The branch returned to its start.
    Closed,
    /// The step fell below its minimum near this parameter value.
    StepTooSmall {
        /// Parameter of the last point.
        p: f64,
    },
    /// The largest number of points was reached.
    PointLimit,
    /// The watch asked to stop.
    Interrupted,
}
