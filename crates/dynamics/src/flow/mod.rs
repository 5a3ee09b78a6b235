//! Motion over whole periods of the load: the exact flow of piecewise-linear systems behind one trait with the
//! integrators of smooth ones.

mod account;
mod column_tables;
mod error;
mod event;
mod exact;
mod generator;
mod impact;
mod kernels;
mod long_run;
mod measure;
mod rate;
mod regime_factory;
mod rest;
mod saltation;
mod scan;
mod settled;
mod smooth;
mod spectral_radius;
mod starting_regime;
mod step_map;
mod term_tables;
mod visitor;

pub use account::{Account, ElementAccount};
pub use error::FlowError;
pub use exact::{EVENT_BUDGET, ExactFlow};
pub use measure::{Record, Request};
pub(crate) use rate::Rate;
pub use smooth::{DEFAULT_TOLERANCE, SmoothFlow};

use slackside_mechanics::{OperatingPoint, Output, SystemFamily};

/// The motion of a system at one frequency of the load, over whole periods and from phase zero. The state is
/// `(q, q', ζ)` with the internal states of the elements that have one, in their order.
pub trait Flow: Send {
    /// Length of the state.
    fn dimension(&self) -> usize;

    /// Frequency of the load, radians per unit of time.
    fn frequency(&self) -> f64;

    /// Adopts another frequency of the load if nothing but the load's harmonics depends on it; tells whether it did.
    fn set_frequency(&mut self, frequency: f64) -> bool;

    /// Moves the state through `periods` periods and returns the number of events. `variations`, if not empty, holds
    /// columns of the state's length that are carried along by the linearised flow; if the flow was made with a rate, the
    /// last column is the derivative with respect to the family's parameter at fixed phases (start it with zero).
    ///
    /// # Errors
    /// [`FlowError`]; the state is then unchanged.
    fn advance(
        &mut self,
        state: &mut [f64],
        periods: usize,
        variations: &mut [f64],
    ) -> Result<usize, FlowError>;

    /// Moves the state through `periods` periods and records measures on the way.
    ///
    /// # Errors
    /// [`FlowError`]; the state is then unchanged.
    fn record(
        &mut self,
        state: &mut [f64],
        periods: usize,
        outputs: &[Output],
        request: &Request,
    ) -> Result<Record, FlowError>;
}

/// The flow that suits a system: exact if every law is piecewise linear, integrated otherwise.
///
/// # Errors
/// [`FlowError`] if the system is unsound.
pub fn open(point: &OperatingPoint) -> Result<Box<dyn Flow>, FlowError> {
    if point.system.is_piecewise_linear() {
        return Ok(Box::new(ExactFlow::new(point)?));
    }
    Ok(Box::new(SmoothFlow::new(point)?))
}

/// The flow that suits the systems of a family, with derivatives with respect to the family's parameter.
///
/// # Errors
/// [`FlowError`] if there is no system at the parameter or it is unsound.
pub fn open_with_rate(family: &dyn SystemFamily, parameter: f64) -> Result<Box<dyn Flow>, FlowError> {
    if family.at(parameter)?.system.is_piecewise_linear() {
        return Ok(Box::new(ExactFlow::with_rate(family, parameter)?));
    }
    Ok(Box::new(SmoothFlow::with_rate(family, parameter)?))
}
