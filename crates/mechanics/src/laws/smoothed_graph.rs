//! Smooth forms of a set-valued graph of the velocity (theory 05 §5.3).

use super::{Ray, Smoothing, VelocityGraph};
use crate::law::{Law, RegimeTable, Response};
use std::sync::Arc;

/// Why a graph cannot be smoothed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SmoothedGraphError {
    /// Only one side of the graph is finite.
    #[error(
        "a law of kind \"{kind}\" has no finite torque on one side of rest; use a one-way damper with a large damping, smoothed if need be"
    )]
    OneSided {
        /// Kind of the law.
        kind: &'static str,
    },
    /// The width is not a positive number.
    #[error("the width of a smoothing must be positive, but is {width}")]
    Width {
        /// Width given.
        width: f64,
    },
}

/// Dry friction with its jump at rest replaced by a smooth step of width `ε` (a velocity). With the rays
/// `f = a_∓ + c_∓ v` of the graph:
///
/// `f = (a₊ + a₋)/2 + (a₊ − a₋)/2 · h(v/ε) + c₋ v + (c₊ − c₋) ε H(v/ε)`,
///
/// where `h` is the smoothed sign ([`Smoothing::step`]) and `H` the smoothed hinge ([`Smoothing::hinge`]). Static limits
/// beyond the kinetic ones have no counterpart.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothedGraph {
    exact: VelocityGraph,
    backward: Ray,
    forward: Ray,
    smoothing: Smoothing,
    width: f64,
}

impl SmoothedGraph {
    /// The graph `exact` smoothed over `width > 0`.
    ///
    /// # Errors
    /// [`SmoothedGraphError`] for a graph with one ray only, such as a one-way clutch, and for a width that is not positive.
    pub fn new(exact: VelocityGraph, smoothing: Smoothing, width: f64) -> Result<Self, SmoothedGraphError> {
        if !(width.is_finite() && width > 0.0) {
            return Err(SmoothedGraphError::Width { width });
        }
        let (Some(backward), Some(forward)) = (exact.backward(), exact.forward()) else {
            return Err(SmoothedGraphError::OneSided { kind: exact.kind() });
        };
        Ok(Self {
            exact,
            backward,
            forward,
            smoothing,
            width,
        })
    }

    /// The graph that is smoothed.
    pub fn exact(&self) -> &VelocityGraph {
        &self.exact
    }

    /// Kind and width of the smoothing.
    pub fn smoothing(&self) -> (Smoothing, f64) {
        (self.smoothing, self.width)
    }
}

impl Law for SmoothedGraph {
    fn kind(&self) -> &'static str {
        self.exact.kind()
    }

    fn response(&self, _: f64, velocity: f64) -> Response {
        let (backward, forward) = (self.backward, self.forward);
        let (step, step_slope) = self.smoothing.step(velocity, self.width);
        let half = 0.5 * (forward.constant - backward.constant);
        let mut force =
            0.5 * (forward.constant + backward.constant) + half * step + backward.damping * velocity;
        let mut slope = half * step_slope + backward.damping;
        let change = forward.damping - backward.damping;
        if change != 0.0 {
            let (hinge, hinge_slope) = self.smoothing.hinge(velocity, self.width);
            force += change * hinge;
            slope += change * hinge_slope;
        }
        Response {
            force,
            by_displacement: 0.0,
            by_velocity: slope,
        }
    }

    fn regimes(&self) -> Option<RegimeTable> {
        None
    }

    fn is_monotone(&self) -> bool {
        // The hinge times tanh or atan is not monotone, which only the difference of the two dampings brings in.
        self.backward.constant <= self.forward.constant
            && self.backward.damping >= 0.0
            && self.backward.damping == self.forward.damping
    }

    fn linearized(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn depends_on_displacement(&self) -> bool {
        false
    }

    fn widened(&self, width: f64) -> Option<Arc<dyn Law>> {
        let wider = Self {
            width,
            ..self.clone()
        };
        (width > self.width && width.is_finite()).then(|| Arc::new(wider) as Arc<dyn Law>)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{asymmetric_coulomb, coulomb, dry_friction, one_way};

    fn ray(constant: f64, damping: f64) -> Ray {
        Ray { constant, damping }
    }

    #[test]
    fn slope_is_the_derivative_of_the_force() {
        let graph = dry_friction(ray(-1.3, 0.2), ray(0.7, 0.5), 1.0);
        for smoothing in Smoothing::ALL {
            let law = SmoothedGraph::new(graph.clone(), smoothing, 0.3).unwrap();
            for v in [-1.1, -0.2, -0.01, 0.05, 0.25, 0.9] {
                let h = 1e-5;
                let force = |v: f64| law.response(0.0, v).force;
                let difference = (force(v + h) - force(v - h)) / (2.0 * h);
                assert!(
                    (law.response(0.0, v).by_velocity - difference).abs() < 1e-8,
                    "{smoothing:?} {v}"
                );
            }
        }
    }

    #[test]
    fn far_from_rest_the_graph_itself_is_left() {
        let graph = asymmetric_coulomb(1.0, 2.0, 1.0);
        for smoothing in Smoothing::ALL {
            let law = SmoothedGraph::new(graph.clone(), smoothing, 1e-6).unwrap();
            // atan leaves ε/v of the torque.
            assert!((law.response(0.0, -3.0).force + 1.0).abs() < 1e-6);
            assert!((law.response(0.0, 3.0).force - 2.0).abs() < 1e-6);
            assert!((law.response(0.0, 0.0).force - 0.5).abs() < 1e-15);
        }
    }

    #[test]
    fn a_wider_transition_only_widens() {
        let law = SmoothedGraph::new(coulomb(2.0, 1.0), Smoothing::Tanh, 0.1).unwrap();
        assert!(law.widened(0.05).is_none());
        let wider = law.widened(1.0).unwrap();
        assert!((wider.response(0.0, 1.0).force - 2.0 * 1.0_f64.tanh()).abs() < 1e-15);
    }

    #[test]
    fn a_clutch_is_refused() {
        let error = SmoothedGraph::new(one_way(), Smoothing::Tanh, 0.1).unwrap_err();
        assert_eq!(error, SmoothedGraphError::OneSided { kind: "one-way" });
        let error = SmoothedGraph::new(coulomb(1.0, 1.0), Smoothing::Tanh, 0.0).unwrap_err();
        assert_eq!(error, SmoothedGraphError::Width { width: 0.0 });
    }
}
