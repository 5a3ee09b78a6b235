//! The laws, one per file. Functions that are piecewise linear are instances of one table,
//! [`PiecewiseLinear`]; laws that are set-valued at rest, of [`VelocityGraph`].

mod backlash;
mod cubic;
mod decoupler;
mod hysteresis_loop;
mod isolator;
mod one_way_damper;
mod piecewise_linear;
mod rigid_stop;
mod smoothed;
mod spring_slider;
mod stop;
mod velocity_graph;
mod wrap_spring;

pub use backlash::backlash;
pub use cubic::Cubic;
pub use decoupler::{DampingAndPreload, Decoupler};
pub use hysteresis_loop::{HysteresisLoop, HysteresisLoopError};
pub use isolator::Isolator;
pub use one_way_damper::one_way_damper;
pub use piecewise_linear::{PiecewiseLinear, PiecewiseLinearError, Variable};
pub use rigid_stop::{DampedStop, RigidStop, damped_stop, rigid_stop};
pub use smoothed::{Smoothed, Smoothing};
pub use spring_slider::{SpringSlider, spring_slider};
pub use stop::stop;
pub use velocity_graph::{Ray, VelocityGraph, asymmetric_coulomb, coulomb, dry_friction, one_way};
pub use wrap_spring::wrap_spring;
