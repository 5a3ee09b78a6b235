//! How a motion can fail to be computed.

use slackside_linalg::LinalgError;
use slackside_mechanics::OutsideDomain;

/// Why a motion could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FlowError {
    /// A linear-algebra call failed.
    #[error("linear algebra: {0}")]
    Linalg(#[from] LinalgError),
    /// The parameter describes no system.
    #[error("{0}")]
    OutsideDomain(#[from] OutsideDomain),
    /// A law without regimes: the motion is not linear between events.
    #[error("element \"{element}\" is smooth and nonlinear: the exact flow needs piecewise-linear laws")]
    NotPiecewiseLinear {
        /// Name of the element.
        element: String,
    },
    /// A smooth nonlinear law beside one whose regimes need events: neither the exact flow nor the integrator covers both.
    #[error(
        "element \"{smooth}\" needs an integrator and element \"{switching}\" sticks, hits or switches an internal state, which the integrator cannot follow; smooth the latter, or take a piecewise-linear law for the former"
    )]
    Mixed {
        /// The smooth element; empty if there is none and the integrator was asked for.
        smooth: String,
        /// The switching element.
        switching: String,
    },
    /// The regimes of all elements multiply to more than can be numbered.
    #[error("{elements} elements have too many joint regimes")]
    TooManyRegimes {
        /// Number of elements.
        elements: usize,
    },
    /// More events in one period of the load than the budget allows.
    #[error(
        "more than {budget} events in one period of the load (near phase {phase} rad); is a law stiffer than intended?"
    )]
    EventBudget {
        /// The budget per period.
        budget: usize,
        /// Phase at which it was used up.
        phase: f64,
    },
    /// At rest no combination of regimes is consistent.
    #[error(
        "no regime of the elements at rest is consistent (phase {phase} rad); is a friction torque negative?"
    )]
    NoRegime {
        /// Phase of the load.
        phase: f64,
    },
    /// The state has the wrong length.
    #[error(
        "the state must have {expected} entries (all coordinates, all rates, then internal states), but has {found}"
    )]
    StateLength {
        /// Coordinates, rates and internal states.
        expected: usize,
        /// Length given.
        found: usize,
    },
    /// The motion left the range of floating-point numbers.
    #[error("the motion grows beyond all bounds (after {periods} periods of the load)")]
    Unbounded {
        /// Periods completed.
        periods: usize,
    },
    /// An adaptive integrator failed.
    #[error("the integrator stopped: {0}")]
    Integrator(String),
}

impl FlowError {
    /// The same error, counting periods from an earlier start.
    pub(crate) fn after(self, periods: usize) -> Self {
        match self {
            Self::Unbounded { periods: more } => Self::Unbounded {
                periods: periods + more,
            },
            other => other,
        }
    }
}
