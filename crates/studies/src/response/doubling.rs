//! Branches of twice the period, from the period doublings of known branches (theory 02 §6).

use super::curve::{Curve, End};
use super::start::distance;
use super::tracer::{KnownMotion, Setup};
use crate::{Signal, StudyError};
use slackside_continuation::Options;
use slackside_dynamics::branch::{
    Branch, BranchOptions, BranchPoint, SpecialKind, doubling_start, follow_from,
};
use slackside_dynamics::flow::{Flow, open};

/// Scaled distances from the period doubling at which the doubled branch is sought.
const DISTANCES: [f64; 5] = [0.02, 0.01, 0.005, 0.0025, 0.001];

/// Adds the branches that start at period doublings, `depth` generations of them.
///
/// # Errors
/// [`StudyError`] if a system on the way is not sound.
pub fn follow_all(
    setup: &Setup,
    curves: &mut Vec<Curve>,
    depth: usize,
    options: &Options,
    signal: &Signal,
) -> Result<(), StudyError> {
    let mut generation = 0..curves.len();
    for _ in 0..depth {
        let next = curves.len();
        for parent in generation {
            let doublings: Vec<BranchPoint> = curves[parent]
                .special
                .iter()
                .filter(|special| special.kind == SpecialKind::PeriodDoubling)
                .map(|special| special.point.clone())
                .collect();
            let single = setup.with_periods(curves[parent].periods);
            let by_shooting = single.by_shooting();
            let double = by_shooting.with_periods(2 * curves[parent].periods);
            for point in doublings {
                if signal.is_interrupted() {
                    return Ok(());
                }
                let single = if curves[parent].by_shooting {
                    &by_shooting
                } else {
                    &single
                };
                if let Some(curve) = follow_one(single, &double, &point, curves, options, signal)? {
                    curves.push(curve);
                }
            }
        }
        generation = next..curves.len();
    }
    Ok(())
}

/// The doubled branch of one period doubling; `None` if it is known already or not found. It is followed by shooting.
fn follow_one(
    single: &Setup,
    double: &Setup,
    point: &BranchPoint,
    known: &[Curve],
    options: &Options,
    signal: &Signal,
) -> Result<Option<Curve>, StudyError> {
    let state = single.state(point)?;
    let (_, monodromy, _) = single.shooting(point.parameter)?.map(&state, point.parameter)?;
    for step in DISTANCES {
        let start = doubling_start(&state, &monodromy, &double.scales, step)?;
        let branch_options = |max_points: usize| BranchOptions {
            continuation: Options {
                max_points,
                ..options.clone()
            },
            direction: 1.0,
        };
        let mut shooting = double.shooting(point.parameter)?;
        let mut follow = |max_points: usize| {
            follow_from(
                &mut shooting,
                &start.state,
                point.parameter,
                &start.tangent,
                &branch_options(max_points),
                &mut |_| !signal.is_interrupted(),
            )
        };
        let trial = follow(3);
        let Some(last) = trial.points.last() else { continue };
        // The corrector may have fallen back on the branch of the single period.
        let gap = asymmetry(single, last)?;
        if distance(&gap, &vec![0.0; gap.len()], &double.scales) < 0.5 * step {
            continue;
        }
        let motion = KnownMotion {
            parameter: last.parameter,
            state: last.unknowns.clone(),
        };
        if known.iter().any(|curve| curve.contains(double, &motion)) {
            return Ok(None);
        }
        let (branch, is_cut) = cut_at_single_period(single, follow(options.max_points))?;
        let mut curve = Curve::new(double, branch, None)?;
        curve.ends[0] = End::Doubling;
        if is_cut {
            curve.ends[1] = End::Doubling;
        }
        return Ok(Some(curve));
    }
    Ok(None)
}

/// How far the motion is from repeating after half its period.
fn asymmetry(single: &Setup, point: &BranchPoint) -> Result<Vec<f64>, StudyError> {
    let mut flow: Box<dyn Flow> = open(&single.point(point.parameter)?)?;
    let mut state = point.unknowns.clone();
    flow.advance(&mut state, single.periods, &mut [])?;
    Ok(state.iter().zip(&point.unknowns).map(|(a, b)| a - b).collect())
}

/// Ends the branch where it meets a branch of the single period: from there on it comes back, shifted by half its period.
fn cut_at_single_period(single: &Setup, mut branch: Branch) -> Result<(Branch, bool), StudyError> {
    let mut before: Option<Vec<f64>> = None;
    for i in 0..branch.points.len() {
        let gap = asymmetry(single, &branch.points[i])?;
        let turned = before.as_ref().is_some_and(|before| {
            let terms = before.iter().zip(&gap).zip(&single.scales);
            terms.map(|((a, b), scale)| a * b / (scale * scale)).sum::<f64>() < 0.0
        });
        if turned {
            branch.points.truncate(i);
            let end = branch.points.last().map_or(0.0, |point| point.arclength);
            branch.special.retain(|special| special.point.arclength <= end);
            return Ok((branch, true));
        }
        before = Some(gap);
    }
    Ok((branch, false))
}
