//! The laws, one per file. Functions that are piecewise linear are instances of one table,
//! [`PiecewiseLinear`]; laws that are set-valued at rest, of [`VelocityGraph`]. Smooth forms of both are [`Smoothed`] and
//! [`SmoothedGraph`]; [`Dahl`], [`LuGre`] and [`Valanis`] have a smooth memory.

mod backlash;
mod cubic;
mod dahl;
mod decoupler;
mod hysteresis_loop;
mod isolator;
mod lugre;
mod one_way_damper;
mod piecewise_linear;
mod rigid_stop;
mod smoothed;
mod smoothed_graph;
mod spring_slider;
mod stop;
mod valanis;
mod velocity_graph;
mod wrap_spring;

pub use backlash::backlash;
pub use cubic::Cubic;
pub use dahl::{Dahl, dahl};
pub use decoupler::{DampingAndPreload, Decoupler};
pub use hysteresis_loop::{HysteresisLoop, HysteresisLoopError};
pub use isolator::Isolator;
pub use lugre::{LuGre, Stribeck};
pub use one_way_damper::one_way_damper;
pub use piecewise_linear::{PiecewiseLinear, PiecewiseLinearError, Variable};
pub use rigid_stop::{DampedStop, RigidStop, damped_stop, rigid_stop};
pub use smoothed::{Smoothed, Smoothing};
pub use smoothed_graph::{SmoothedGraph, SmoothedGraphError};
pub use spring_slider::{SpringSlider, spring_slider};
pub use stop::stop;
pub use valanis::{Valanis, ValanisError};
pub use velocity_graph::{Ray, VelocityGraph, asymmetric_coulomb, coulomb, dry_friction, one_way};
pub use wrap_spring::wrap_spring;
