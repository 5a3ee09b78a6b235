//! Backlash: a spring with a dead zone (gear play, a loose coupling).

use super::{PiecewiseLinear, Variable};

/// `f = stiffness · (|u| − clearance) · sgn u` outside the dead zone `|u| < clearance`, zero inside. `clearance` is half the
/// total play. Linearised about contact.
pub fn backlash(stiffness: f64, clearance: f64) -> PiecewiseLinear {
    PiecewiseLinear::named(
        "backlash",
        Variable::Displacement,
        vec![-clearance, clearance],
        vec![stiffness, 0.0, stiffness],
        vec![
            "contact on the negative side",
            "clearance",
            "contact on the positive side",
        ],
        2,
    )
}
