//! What is wrong when there is no steady state, or with the one that was found.

use super::SteadyError;
use super::balance::{Balance, Running};
use super::solve::{Unknowns, newton};
use crate::drive::Guide;
use std::f64::consts::PI;

/// Positions of a single arm that are tried.
const POSITIONS: usize = 361;
/// Excess length of a span as a share of its length up to which its slopes count as small (0.3 rad in the mean).
const LARGEST_EXCESS: f64 = 0.05;
/// Strain that no belt bears; belts run at a few thousandths.
const LARGEST_STRAIN: f64 = 0.05;

/// What keeps the drive from running in a state that balances.
pub(super) fn fault(running: &Running<'_>, balance: &Balance, positions: &[f64]) -> Option<SteadyError> {
    let drive = running.drive;
    let is_finite = balance
        .tensions
        .iter()
        .chain(positions)
        .all(|value| value.is_finite());
    if !is_finite || !balance.natural_length.is_finite() {
        return Some(no_equilibrium(running));
    }
    let slackest = (0..balance.spans.len())
        .min_by(|i, k| balance.effective_tensions[*i].total_cmp(&balance.effective_tensions[*k]))?;
    if is_slack(balance, slackest) {
        return Some(SteadyError::NoEffectiveTension {
            span: drive.span_name(slackest),
            tension: balance.tensions[slackest],
            centrifugal: running.centrifugal,
            driver_speed: running.driver_speed,
        });
    }
    for (arm, tensioner) in drive.tensioners.iter().enumerate() {
        let position = positions[arm];
        let Some([low, high]) = tensioner.stops else {
            continue;
        };
        if tensioner.locked || (low..=high).contains(&position) {
            continue;
        }
        let stop = if position < low { low } else { high };
        return Some(SteadyError::ArmBeyondStop {
            tensioner: tensioner.name.clone(),
            position,
            stop,
            is_rotary: matches!(tensioner.guide, Guide::Rotary { .. }),
            belt_is_long: (position > stop) == (balance.kinematics.take_up[arm] > 0.0),
        });
    }
    let strain = |i: usize| balance.tensions[i] / drive.belt.axial_stiffness;
    if let Some(tightest) = (0..balance.spans.len()).find(|i| strain(*i) > LARGEST_STRAIN) {
        return Some(SteadyError::Overstretched {
            span: drive.span_name(tightest),
            strain: strain(tightest),
            tension: balance.tensions[tightest],
        });
    }
    let reference = running
        .balance(
            balance.effective_tensions[drive.driver],
            &drive.reference_positions(),
        )
        .ok()?;
    (0..drive.tensioners.len())
        .find(|arm| {
            !drive.tensioners[*arm].locked
                && reference.kinematics.take_up[*arm] * balance.kinematics.take_up[*arm] <= 0.0
        })
        .map(|arm| SteadyError::DeadCentre {
            tensioner: drive.tensioners[arm].name.clone(),
        })
}

/// Whether a span has no effective tension, or so little that its curvature spreads over all of it and its slopes are no
/// longer small: the closed form then takes up any length of belt.
fn is_slack(balance: &Balance, span: usize) -> bool {
    let equilibrium = &balance.spans[span];
    balance.effective_tensions[span] <= 0.0
        || equilibrium.excess_length() > LARGEST_EXCESS * balance.layout.spans[span].length
}

/// After a failed iteration: a start from which it converges, or why there is none.
///
/// With one free arm, the tension that balances it is known at every position, and only the belt length is left to be met:
/// all positions are looked through. A drive without a free arm, or with several, is solved as a string, whose tensions
/// may be negative, so that the slack span can be named.
pub(super) fn explain(running: &Running<'_>) -> Result<Unknowns, SteadyError> {
    let drive = running.drive;
    let free: Vec<usize> = (0..drive.tensioners.len())
        .filter(|arm| !drive.tensioners[*arm].locked)
        .collect();
    if let [arm] = free[..] {
        return look_through(running, arm);
    }
    let mut string = drive.clone();
    string.belt.bending_stiffness = 0.0;
    let as_string = Running::new(&string, running.installed, running.driver_speed);
    let start = Unknowns {
        reference_tension: running.installed.reference_tension,
        positions: drive.reference_positions(),
    };
    if let Some(found) = newton(&as_string, start) {
        let balance = as_string.balance(found.reference_tension, &found.positions)?;
        if let Some(error) = fault(&as_string, &balance, &found.positions) {
            return Err(error);
        }
    }
    Err(no_equilibrium(running))
}

fn no_equilibrium(running: &Running<'_>) -> SteadyError {
    SteadyError::NoEquilibrium {
        driver_speed: running.driver_speed,
    }
}

fn look_through(running: &Running<'_>, arm: usize) -> Result<Unknowns, SteadyError> {
    let drive = running.drive;
    let tensioner = &drive.tensioners[arm];
    let [low, high] = tensioner.stops.unwrap_or(match tensioner.guide {
        Guide::Rotary { .. } => [tensioner.reference - 0.5 * PI, tensioner.reference + 0.5 * PI],
        Guide::Linear { .. } => [tensioner.reference - 0.1, tensioner.reference + 0.1],
    });
    let mut positions = drive.reference_positions();
    let (mut longest, mut shortest) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut last: Option<f64> = None;
    for k in 0..POSITIONS {
        positions[arm] = low + (high - low) * k as f64 / (POSITIONS - 1) as f64;
        let Some((tension, gap)) = balanced(running, arm, &positions) else {
            last = None;
            continue;
        };
        longest = longest.max(gap);
        shortest = shortest.min(gap);
        let crosses = last.is_some_and(|last| last * gap <= 0.0);
        last = Some(gap);
        if !crosses {
            continue;
        }
        let start = Unknowns {
            reference_tension: tension,
            positions: positions.clone(),
        };
        if let Some(found) = newton(running, start) {
            return Ok(found);
        }
    }
    let natural_length = running.installed.natural_length;
    if longest < 0.0 && longest.is_finite() {
        return Err(SteadyError::BeltTooLong {
            excess: -longest,
            natural_length,
        });
    }
    if shortest > 0.0 && shortest.is_finite() {
        return Err(SteadyError::BeltTooShort {
            missing: shortest,
            natural_length,
        });
    }
    Err(no_equilibrium(running))
}

/// The reference tension that balances the arm, and by how much the belt of this path would be longer than the one there
/// is; `None` where the layout is impossible or a span would be slack.
fn balanced(running: &Running<'_>, arm: usize, positions: &[f64]) -> Option<(f64, f64)> {
    // The balance of an arm is linear in the tension.
    let residual = |tension: f64| Some(running.balance(tension, positions).ok()?.arm_residuals[arm]);
    let (low, high) = (residual(1.0)?, residual(2.0)?);
    let tension = 1.0 + low / (low - high);
    let balance = running.balance(tension, positions).ok()?;
    let is_possible = balance.layout.check(running.drive).is_ok()
        && balance.natural_length.is_finite()
        && (0..balance.spans.len()).all(|span| !is_slack(&balance, span));
    is_possible.then_some((tension, balance.natural_length - running.installed.natural_length))
}
