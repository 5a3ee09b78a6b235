//! What an element's law tells: force with tangents, and its regimes as plain data.

mod memory;
mod regime_table;

pub(crate) use memory::sign;
pub use memory::{Gradient, Memory, MemoryResponse};
pub use regime_table::{Guard, InternalRate, Piece, Regime, RegimeTable, Rest, Transition};

use std::fmt::Debug;
use std::sync::Arc;

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

/// A law `f(u, v)` of a local element, possibly with an internal state `ζ`. Its force is on the left-hand side of the
/// equations of motion.
pub trait Law: Debug + Send + Sync {
    /// The kind as model files call it, for messages and results.
    fn kind(&self) -> &'static str;

    /// Force and tangents. At a kink the tangents are those of one of the two sides; at rest a set-valued law answers with
    /// one member of its set, and a law with an internal state with the force at the internal state zero.
    fn response(&self, displacement: f64, velocity: f64) -> Response;

    /// The regimes of a piecewise-linear law; `None` for a smooth nonlinear law, whose motion needs an integrator.
    fn regimes(&self) -> Option<RegimeTable>;

    /// How force and internal state move, for a law whose internal state obeys a smooth equation; `None` for all others.
    fn memory(&self) -> Option<&dyn Memory> {
        None
    }

    /// Whether the law has an internal state `ζ`, of either sort.
    fn has_internal_state(&self) -> bool {
        self.memory().is_some() || self.regimes().is_some_and(|table| table.internal)
    }

    /// Whether the force depends on the displacement. A port whose law does not may drift: its displacement then has a
    /// mean rate (an accessory that overruns) and no mean.
    fn depends_on_displacement(&self) -> bool {
        self.regimes().is_none_or(|table| table.depends_on_displacement())
    }

    /// The law with its transition at rest `width` wide, for a law with such a transition that is narrower; otherwise
    /// `None`. Solvers approach a narrow transition through wider ones (theory 05 §5.3).
    fn widened(&self, width: f64) -> Option<Arc<dyn Law>> {
        let _ = width;
        None
    }

    /// Whether the graph `v → f` is maximal monotone, which feeds the uniqueness certificate of theory 05 §2.1.
    fn is_monotone(&self) -> bool;

    /// The law as engaged for good, as a linear spring-damper: slopes of displacement and velocity about which modes are
    /// computed.
    fn linearized(&self) -> (f64, f64);

    /// Whether the law, engaged for good, holds its port at zero velocity (a one-way clutch that is locked); its
    /// linearisation is then that constraint.
    fn locks(&self) -> bool {
        false
    }

    /// The pair `(v, f)` with `f` in the graph of the law at `v` and `v + r f = w`, for `r > 0`: what implicit time steps
    /// and set-valued balances evaluate (theory 05 §6.2). `None` if the law is no monotone graph of the velocity.
    fn resolvent(&self, w: f64, r: f64) -> Option<(f64, f64)> {
        let _ = (w, r);
        None
    }
}
