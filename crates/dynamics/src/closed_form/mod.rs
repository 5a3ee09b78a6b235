//! Closed forms: limits of locked motions, orbits of pure slip, and the classical oscillators (theory 05 §4.4, §5, §8).
//!
//! They answer in microseconds what the exact flow answers by events, and are what it is tested against.

mod critical_load;
mod critical_torque;
mod critical_values;
mod den_hartog;
mod error;
mod extremes;
mod impact_oscillator;
mod locked_element;
mod optimum_torque;
mod slip_orbit;

pub use critical_load::{CriticalLoad, critical_load};
pub use critical_torque::{CriticalTorque, critical_torque};
pub use critical_values::{CriticalValue, critical_values, locking_margin, zeros_of_margin};
pub use den_hartog::DenHartog;
pub use error::ClosedFormError;
pub use extremes::{Extremes, extremes};
pub use impact_oscillator::{ImpactMotion, ImpactOscillator};
pub use locked_element::{HeldElement, LockedElement, LockedForce, holding_limits};
pub use optimum_torque::{OptimumTorque, optimum_torque};
pub use slip_orbit::{SlipOrbit, slip_orbit};
