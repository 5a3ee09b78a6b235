//! What an element's law tells: force with tangents, and its regimes as plain data.

mod regime_table;

pub use regime_table::{Guard, Piece, Regime, RegimeTable, Transition};

use std::fmt::Debug;

/// Force of a law and its tangents at a displacement `u` and velocity `v` of the port.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Response {
    /// Force `f`.
    pub force: f64,
    /// `∂f/∂u`.
    pub by_displacement: f64,
    /// `∂f/∂v`.
    pub by_velocity: f64,
}

/// A law `f(u, v)` of a local element. Its force is on the left-hand side of the equations of motion.
pub trait Law: Debug + Send + Sync {
    /// The kind as model files call it, for messages and results.
    fn kind(&self) -> &'static str;

    /// Force and tangents. At a kink the tangents are those of one of the two sides.
    fn response(&self, displacement: f64, velocity: f64) -> Response;

    /// The regimes of a piecewise-linear law; `None` for a smooth nonlinear law, whose motion needs an integrator.
    fn regimes(&self) -> Option<RegimeTable>;

    /// Whether the graph `v → f` is maximal monotone, which feeds the uniqueness certificate of theory 05 §2.1.
    fn is_monotone(&self) -> bool;

    /// The law as engaged for good, as a linear spring-damper: slopes of displacement and velocity about which modes are
    /// computed.
    fn linearized(&self) -> (f64, f64);
}
