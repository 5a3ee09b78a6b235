//! The laws, one per file. All piecewise-linear ones are instances of one table, [`PiecewiseLinear`].

mod backlash;
mod cubic;
mod isolator;
mod one_way_damper;
mod piecewise_linear;
mod smoothed;
mod stop;
mod wrap_spring;

pub use backlash::backlash;
pub use cubic::Cubic;
pub use isolator::Isolator;
pub use one_way_damper::one_way_damper;
pub use piecewise_linear::{PiecewiseLinear, PiecewiseLinearError, Variable};
pub use smoothed::{Smoothed, Smoothing};
pub use stop::stop;
pub use wrap_spring::wrap_spring;
