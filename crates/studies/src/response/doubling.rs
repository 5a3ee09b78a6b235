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
        let (mut branch, is_cut) = cut_at_single_period(single, follow(options.max_points))?;
        branch.points.insert(0, doubled(point, &state));
        if is_cut && let Some(end) = end_of(single, double, &branch, known)? {
            branch.points.push(end);
        }
        measure_arclength(double, &mut branch);
        let mut curve = Curve::new(double, branch, None)?;
        curve.ends = [End::Doubling, if is_cut { End::Doubling } else { curve.ends[1] }];
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

/// A motion at a period doubling as a motion of twice the period.
fn doubled(point: &BranchPoint, state: &[f64]) -> BranchPoint {
    BranchPoint {
        unknowns: state.to_vec(),
        multipliers: point
            .multipliers
            .iter()
            .map(|multiplier| multiplier * multiplier)
            .collect(),
        events: 2 * point.events,
        ..point.clone()
    }
}

/// How far from its last point, in scaled distance, a branch may meet the single period: a few steps.
const REACH: f64 = 0.2;

/// The period doubling at which a branch that was cut ends: the one nearest to its last point.
fn end_of(
    single: &Setup,
    double: &Setup,
    branch: &Branch,
    known: &[Curve],
) -> Result<Option<BranchPoint>, StudyError> {
    let Some(last) = branch.points.last() else {
        return Ok(None);
    };
    let mut nearest: Option<(f64, BranchPoint)> = None;
    for curve in known.iter().filter(|curve| curve.periods == single.periods) {
        let of_curve = single.of_curve(curve);
        for special in curve
            .special
            .iter()
            .filter(|s| s.kind == SpecialKind::PeriodDoubling)
        {
            let state = of_curve.state(&special.point)?;
            let along = (special.point.parameter - last.parameter).abs() / double.parameter_scale;
            let apart = distance(&state, &last.unknowns, &double.scales).max(along);
            if apart < nearest.as_ref().map_or(REACH, |(best, _)| *best) {
                nearest = Some((apart, doubled(&special.point, &state)));
            }
        }
    }
    Ok(nearest.map(|(_, point)| point))
}

/// Gives the points at both ends their distance along the branch.
fn measure_arclength(double: &Setup, branch: &mut Branch) {
    let between = |a: &BranchPoint, b: &BranchPoint| {
        let states = a.unknowns.iter().zip(&b.unknowns).zip(&double.scales);
        let squares: f64 = states.map(|((a, b), scale)| ((a - b) / scale).powi(2)).sum();
        let along = (a.parameter - b.parameter) / double.parameter_scale;
        (squares + along * along).sqrt()
    };
    if let [first, second, ..] = &mut branch.points[..] {
        first.arclength = second.arclength - between(first, second);
    }
    if let [.., before, last] = &mut branch.points[..]
        && last.arclength <= before.arclength
    {
        last.arclength = before.arclength + between(before, last);
    }
}
