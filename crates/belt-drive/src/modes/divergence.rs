//! The speed up to which a drive has a stable steady state (theory 04 §4.4).

use crate::drive::Drive;
use crate::model::LinearModel;
use crate::steady::{Installed, SteadyError, SteadyState};
use slackside_linalg::is_positive_definite;

/// What ends the range of speeds.
#[derive(Debug, Clone, PartialEq)]
pub enum SpeedLimit {
    /// The stiffness matrix loses its definiteness: divergence.
    Divergence,
    /// There is no steady state beyond.
    NoSteadyState(Box<SteadyError>),
}

/// The end of the range of speeds.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitSpeed {
    /// Largest driver speed with a stable steady state, rad/s.
    pub driver_speed: f64,
    /// What happens there.
    pub limit: SpeedLimit,
}

/// The lowest speed between zero and `highest` (rad/s) beyond which the drive has no stable steady state, to a relative
/// 1e-9 of it; `None` if it has one at all speeds that were looked at.
///
/// The range is looked through in `steps` equal steps (at least one) before the first failure is narrowed down by bisection.
pub fn limit_speed(drive: &Drive, installed: &Installed, highest: f64, steps: usize) -> Option<LimitSpeed> {
    let steps = steps.max(1);
    let mut good = 0.0;
    let mut failure = None;
    for k in 0..=steps {
        let speed = highest * k as f64 / steps as f64;
        match fails(drive, installed, speed) {
            None => good = speed,
            Some(limit) => {
                failure = Some((speed, limit));
                break;
            }
        }
    }
    let (mut bad, mut limit) = failure?;
    while bad - good > 1e-9 * bad {
        let middle = 0.5 * (good + bad);
        match fails(drive, installed, middle) {
            None => good = middle,
            Some(found) => {
                bad = middle;
                limit = found;
            }
        }
    }
    Some(LimitSpeed {
        driver_speed: good,
        limit,
    })
}

fn fails(drive: &Drive, installed: &Installed, speed: f64) -> Option<SpeedLimit> {
    match SteadyState::solve(drive, installed, speed) {
        Err(error) => Some(SpeedLimit::NoSteadyState(Box::new(error))),
        Ok(steady) => {
            let model = LinearModel::new(drive, &steady);
            let free = model.free_coordinates(drive, false);
            let stable = is_positive_definite(&model.stiffness.selected(&free));
            (!stable).then_some(SpeedLimit::Divergence)
        }
    }
}
