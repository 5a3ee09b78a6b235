//! The one-way viscous damper or clutch.

use super::{PiecewiseLinear, Variable};

/// `f = damping · v` for `v > 0` (driving), zero otherwise (free-wheeling).
pub fn one_way_damper(damping: f64) -> PiecewiseLinear {
    PiecewiseLinear::named(
        "one-way-damper",
        Variable::Velocity,
        vec![0.0],
        vec![0.0, damping],
        vec!["free-wheeling", "driving"],
        1,
    )
}
