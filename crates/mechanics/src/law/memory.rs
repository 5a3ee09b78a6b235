//! Laws whose internal state obeys a smooth equation of its own, as hysteresis models of Duhem's type do (theory 05 §6.3).

use std::fmt::Debug;

/// Partial derivatives with respect to displacement `u`, velocity `v` and internal state `ζ`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gradient {
    /// `∂/∂u`.
    pub displacement: f64,
    /// `∂/∂v`.
    pub velocity: f64,
    /// `∂/∂ζ`.
    pub internal: f64,
}

/// Force of the element and rate of its internal state at one `(u, v, ζ)`, with their derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MemoryResponse {
    /// Force `f`.
    pub force: f64,
    /// Derivatives of `f`.
    pub force_by: Gradient,
    /// Rate `ζ'`.
    pub rate: f64,
    /// Derivatives of `ζ'`; at `v = 0`, where a rate that contains `|v|` has a kink, the mean of the two sides.
    pub rate_by: Gradient,
}

/// The equations `f = f(u, v, ζ)`, `ζ' = g(u, v, ζ)` of an element with one internal state, which starts at zero unless told
/// otherwise.
pub trait Memory: Debug {
    /// Force and rate.
    fn evaluate(&self, displacement: f64, velocity: f64, internal: f64) -> MemoryResponse;

    /// Typical size of the internal state, by which integrators measure its error.
    fn scale(&self) -> f64;
}

/// `sgn v`, zero at rest.
pub(crate) fn sign(velocity: f64) -> f64 {
    if velocity == 0.0 { 0.0 } else { velocity.signum() }
}
