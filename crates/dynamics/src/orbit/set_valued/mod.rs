//! Set-valued harmonic balance: one-way clutches and dry friction without smoothing, by a globally convergent iteration (theory
//! 05 §5.4).
//!
//! At `N` times in the period the port forces `f` and velocities `v = v_lin − Y f` must lie on the graphs of the laws. Both
//! relations are monotone, so that Douglas–Rachford splitting finds them from any start. With `r > 0` and
//! `(v, f)` on the graph where `f + r v = z`,
//!
//! ```text
//! w_k = (1 + r Y_k)⁻¹ ((2f − z)_k + r v_lin,k),      z ← z + w − f.
//! ```
//!
//! A port whose static mobility is infinite (a clutch to a free accessory) fixes the mean force instead. The error is of order
//! `1/N`: this is the robust start of shooting, and a second method beside it.

mod iteration;
mod motion;
mod port_map;

pub use motion::SetValuedMotion;

use crate::receptance::{LinearSystem, ReceptanceError, nonlinear_elements};
use iteration::Iteration;
use port_map::PortMap;
use slackside_mechanics::OperatingPoint;
use slackside_numerics::fourier::FourierPlanner;

/// How far to iterate.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Samples `N` per period; at least 16 are used.
    pub samples: usize,
    /// Largest difference between the two estimates of the force, relative to the largest force, at which to stop.
    pub tolerance: f64,
    /// Largest number of iterations.
    pub iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            samples: 256,
            tolerance: 1e-6,
            iterations: 5000,
        }
    }
}

/// Why there is nothing to balance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetValuedError {
    /// A law is no monotone graph of the velocity.
    #[error(
        "set-valued harmonic balance needs laws that are monotone graphs of the velocity, but \"{element}\" ({kind}) is not"
    )]
    Law {
        /// The element.
        element: String,
        /// The kind of its law.
        kind: &'static str,
    },
    /// All elements are linear.
    #[error("no element is nonlinear; the linear response is the answer")]
    NothingNonlinear,
    /// The linear part has no answer.
    #[error(transparent)]
    Receptance(#[from] ReceptanceError),
}

/// Iterations of the trials that choose between two values of `r`.
const TRIAL: usize = 60;

/// The periodic motion at an operating point, with the period of the load.
///
/// The factor `r` of each port is one or ten over the median of `|Y_1| … |Y_7|`, whichever makes more progress in a trial.
/// A motion that has not converged is returned with its residual.
///
/// # Errors
/// [`SetValuedError`].
pub fn solve(point: &OperatingPoint, settings: &Settings) -> Result<SetValuedMotion, SetValuedError> {
    let system = &point.system;
    let elements = nonlinear_elements(system);
    if elements.is_empty() {
        return Err(SetValuedError::NothingNonlinear);
    }
    let laws: Vec<_> = elements.iter().map(|&e| system.elements[e].law.clone()).collect();
    for (&e, law) in elements.iter().zip(&laws) {
        if law.resolvent(0.0, 1.0).is_none() {
            return Err(SetValuedError::Law {
                element: system.elements[e].name.clone(),
                kind: law.kind(),
            });
        }
    }
    let samples = settings.samples.max(16).next_multiple_of(2);
    let linear = LinearSystem::new(system, &elements)?;
    let map = PortMap::new(&linear, point.frequency, samples / 2)?;
    let mut planner = FourierPlanner::default();
    let mut trials = Vec::with_capacity(2);
    for factor in [1.0, 10.0] {
        let mut trial = Iteration::new(&map, &laws, factor, planner.transform(samples))?;
        trial.run(TRIAL.min(settings.iterations), settings.tolerance);
        trials.push(trial);
    }
    // Two trials were pushed, so that one is the better.
    let best = usize::from(trials[1].residual < trials[0].residual);
    let mut iteration = trials.swap_remove(best);
    iteration.run(settings.iterations, settings.tolerance);
    Ok(SetValuedMotion::new(
        &map,
        &iteration,
        elements,
        settings.tolerance,
    )?)
}
