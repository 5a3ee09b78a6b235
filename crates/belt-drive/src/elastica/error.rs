//! Why there is no geometrically exact steady state.

use crate::steady::SteadyError;

/// Failure of the geometrically exact steady state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ElasticaError {
    /// The steady state with the ends of the spans at the tangent points, from which the exact one is sought, does not exist.
    #[error(transparent)]
    Start(#[from] SteadyError),
    /// A belt without bending stiffness, whose free contact points are the tangent points.
    #[error(
        "without bending stiffness the exact steady state is the ordinary one; give the belt a bending stiffness"
    )]
    NoBendingStiffness,
    /// Several arms that are all to stand at given positions.
    #[error(
        "an installation by operating position fixes one tension, which {arms} free arms cannot all balance exactly; give the natural belt length"
    )]
    SeveralArms {
        /// Number of free arms.
        arms: usize,
    },
    /// A span whose elastica was not found.
    #[error("no elastica was found for span {span} under a force of {force:.1} N")]
    Span {
        /// The span, `from-to`.
        span: String,
        /// Force in the span without momentum flux, N.
        force: f64,
    },
    /// A span whose boundary layers are thinner than the method resolves.
    #[error(
        "span {span} is {slenderness:.0} times as long as its boundary layers, more than {largest:.0}; bending hardly matters there, use the ordinary steady state"
    )]
    Slender {
        /// The span, `from-to`.
        span: String,
        /// `z = λL`.
        slenderness: f64,
        /// Largest slenderness.
        largest: f64,
    },
    /// A pulley from which bending lifts the belt.
    #[error(
        "bending lifts the belt off pulley \"{pulley}\"; the model needs contact, so raise the wrap or the tension"
    )]
    Lifted {
        /// The pulley.
        pulley: String,
    },
    /// Newton's method for tensions and arms did not converge.
    #[error(
        "the exact steady state was not found; the balances are still open by {residual:.1e} of their terms"
    )]
    NoConvergence {
        /// Largest residual, in units of the installation's forces and lengths.
        residual: f64,
    },
}
