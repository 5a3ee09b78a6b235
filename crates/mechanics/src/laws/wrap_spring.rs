//! The wrap-spring one-way clutch: a spring that acts only when the pulley leads (theory 02 (2.1)).

use super::{PiecewiseLinear, Variable};

/// `f = stiffness · u` for `u > 0` (engaged), zero otherwise (disengaged); `u` is the wind-up of pulley against accessory,
/// `stiffness` in torque per radian.
pub fn wrap_spring(stiffness: f64) -> PiecewiseLinear {
    PiecewiseLinear::named(
        "wrap-spring",
        Variable::Displacement,
        vec![0.0],
        vec![0.0, stiffness],
        vec!["disengaged", "engaged"],
        1,
    )
}
