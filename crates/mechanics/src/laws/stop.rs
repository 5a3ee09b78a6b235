//! A compliant one-sided stop.

use super::{PiecewiseLinear, Variable};

/// `f = stiffness · (u − gap)` for `u > gap` (contact), zero otherwise (free), for a gap of zero or more. Linearised as
/// free.
///
/// A graph passes through the origin, so a negative gap (a stop that is preloaded at rest) gives the same forces less
/// the preload, as measured from a state in which the preload is balanced.
pub fn stop(stiffness: f64, gap: f64) -> PiecewiseLinear {
    PiecewiseLinear::named(
        "stop",
        Variable::Displacement,
        vec![gap],
        vec![0.0, stiffness],
        vec!["free", "contact"],
        0,
    )
}
