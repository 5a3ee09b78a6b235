//! A branch followed in both directions, and questions about it: is a motion on it, what lies at a parameter value.

use super::start::distance;
use super::tracer::{KnownMotion, Setup};
use crate::{Quantity, Signal, StudyError};
use slackside_continuation::{Options, StopReason};
use slackside_dynamics::branch::{Branch, BranchOptions, BranchPoint, SpecialKind, SpecialPoint, follow};
use slackside_dynamics::flow::open;

/// Scaled distance below which a motion counts as lying on a branch: interpolation between points is better than this,
/// and motions of different branches are farther apart except next to bifurcations.
const ON_BRANCH: f64 = 1e-3;

/// Where a branch ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At an end of the range.
    Range,
    /// Where it began: it is a closed curve.
    Closed,
    /// At a branch of half the period.
    Doubling,
    /// Where no step was short enough to converge.
    Step,
    /// Where the largest number of points was reached.
    Points,
    /// Where the study was interrupted.
    Interrupted,
}

impl From<&StopReason> for End {
    fn from(stop: &StopReason) -> Self {
        match stop {
            StopReason::RangeLimit => Self::Range,
            StopReason::Closed => Self::Closed,
            StopReason::StepTooSmall { .. } | StopReason::NoStart(_) => Self::Step,
            StopReason::PointLimit => Self::Points,
            StopReason::Interrupted => Self::Interrupted,
        }
    }
}

/// A branch of motions.
pub struct Curve {
    /// Periods of the load after which its motions repeat.
    pub periods: usize,
    /// Whether it was followed by shooting, so that unknowns are states.
    pub by_shooting: bool,
    /// Motions in order; arclengths rise.
    pub points: Vec<BranchPoint>,
    /// States at phase zero of the points.
    pub states: Vec<Vec<f64>>,
    /// Special points in order.
    pub special: Vec<SpecialPoint>,
    /// How it ended at its first and last point.
    pub ends: [End; 2],
}

/// The two halves of a branch, followed from a point between its ends, as one.
pub struct Joined {
    /// Points in order; arclengths rise.
    pub points: Vec<BranchPoint>,
    /// Special points in order.
    pub special: Vec<SpecialPoint>,
    /// How it ended at its first and last point.
    pub ends: [End; 2],
}

impl Joined {
    /// Joins a branch and, if there is one, that in the other direction from the same motion.
    pub fn new(onward: Branch, back: Option<Branch>) -> Self {
        let mut points = Vec::new();
        let mut special = Vec::new();
        let mut first_end = match onward.stop {
            StopReason::Closed => End::Closed,
            _ => End::Range,
        };
        if let Some(back) = back {
            first_end = End::from(&back.stop);
            let turned = |mut point: BranchPoint| {
                point.arclength = -point.arclength;
                point
            };
            points.extend(back.points.into_iter().skip(1).rev().map(turned));
            special.extend(back.special.into_iter().rev().map(|special| SpecialPoint {
                point: turned(special.point),
                ..special
            }));
        }
        let last_end = End::from(&onward.stop);
        points.extend(onward.points);
        special.extend(onward.special);
        Self {
            points,
            special,
            ends: [first_end, last_end],
        }
    }
}

/// Follows the branch through a known motion in both directions.
///
/// # Errors
/// [`StudyError::NoAnswer`] if the method does not find the motion.
pub fn follow_both(
    setup: &Setup,
    start: &KnownMotion,
    options: &Options,
    signal: &Signal,
    told: &dyn Fn(f64),
) -> Result<Curve, StudyError> {
    let (low, high) = options.range;
    let mut progress = |point: &BranchPoint| {
        told(point.parameter);
        !signal.is_interrupted()
    };
    let mut one_way = |direction: f64| -> Result<Branch, StudyError> {
        let (mut family, unknowns) = setup.family(start)?;
        let options = BranchOptions {
            continuation: options.clone(),
            direction,
        };
        let branch = follow(
            family.as_mut(),
            &unknowns,
            start.parameter,
            &options,
            &mut progress,
        );
        match &branch.stop {
            StopReason::NoStart(reason) => Err(StudyError::NoAnswer(reason.clone())),
            _ if branch.points.is_empty() => Err(StudyError::Interrupted),
            _ => Ok(branch),
        }
    };
    if start.parameter <= low {
        return Curve::new(setup, one_way(1.0)?, None);
    }
    if start.parameter >= high {
        return Curve::new(setup, one_way(-1.0)?, None);
    }
    let onward = one_way(1.0)?;
    if onward.stop == StopReason::Closed {
        return Curve::new(setup, onward, None);
    }
    let back = one_way(-1.0)?;
    Curve::new(setup, onward, Some(back))
}

impl Curve {
    /// The curve from a branch and, if there is one, that in the other direction from the same motion.
    ///
    /// # Errors
    /// [`StudyError`] if a state is not recovered.
    pub fn new(setup: &Setup, onward: Branch, back: Option<Branch>) -> Result<Self, StudyError> {
        let periods = onward.periods;
        let Joined {
            points,
            special,
            ends,
        } = Joined::new(onward, back);
        let states = points
            .iter()
            .map(|point| setup.state(point))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            periods,
            by_shooting: setup.is_shooting(),
            points,
            states,
            special,
            ends,
        })
    }

    /// What a user should know of how the branch ended.
    pub fn remarks(&self, quantity: &Quantity) -> Vec<String> {
        let ends = [self.points.first(), self.points.last()];
        let named = self.ends.iter().zip(ends);
        named
            .filter_map(|(stop, point)| {
                let at = format!("{} = {}", quantity.key, quantity.value(point?.parameter));
                match stop {
                    End::Step => Some(format!(
                        "a branch was given up at {at}: no step was short enough to converge"
                    )),
                    End::Points => Some(format!(
                        "a branch was cut at {at} after the largest number of points; raise --max-points"
                    )),
                    _ => None,
                }
            })
            .collect()
    }

    /// Whether a motion of the same period, possibly shifted by periods of the load, lies on the branch.
    pub fn contains(&self, setup: &Setup, known: &KnownMotion) -> bool {
        if self.periods != setup.periods {
            return false;
        }
        let Ok(mut flow) = setup.point(known.parameter).and_then(|point| Ok(open(&point)?)) else {
            return false;
        };
        let here = self.states_at(known.parameter);
        let mut state = known.state.clone();
        for _ in 0..self.periods {
            if here
                .iter()
                .any(|on_branch| distance(on_branch, &state, &setup.scales) < ON_BRANCH)
            {
                return true;
            }
            if self.periods > 1 && flow.advance(&mut state, 1, &mut []).is_err() {
                return false;
            }
        }
        false
    }

    /// Interpolated states wherever the branch passes a parameter value.
    pub fn states_at(&self, parameter: f64) -> Vec<Vec<f64>> {
        let knots = self.knots();
        let mut found = Vec::new();
        for i in 0..knots.len().saturating_sub(1) {
            let (left, right) = (knots[i].0 - parameter, knots[i + 1].0 - parameter);
            if left == 0.0 {
                found.push(knots[i].2.to_vec());
            } else if left * right < 0.0 {
                let first = i.saturating_sub(1).min(knots.len().saturating_sub(4));
                let around = &knots[first..(first + 4).min(knots.len())];
                found.push(interpolate(around, (knots[i].1, knots[i + 1].1), parameter));
            }
        }
        if let Some(last) = knots.last().filter(|last| last.0 == parameter) {
            found.push(last.2.to_vec());
        }
        found
    }

    /// Parameter, arclength and state of the points; of folds too where states are the unknowns, since they bound the
    /// parameter.
    fn knots(&self) -> Vec<(f64, f64, &[f64])> {
        let mut knots: Vec<(f64, f64, &[f64])> = self
            .points
            .iter()
            .zip(&self.states)
            .map(|(point, state)| (point.parameter, point.arclength, state.as_slice()))
            .collect();
        for special in &self.special {
            let point = &special.point;
            if self.by_shooting && special.kind == SpecialKind::Fold {
                knots.push((point.parameter, point.arclength, &point.unknowns));
            }
        }
        knots.sort_by(|a, b| a.1.total_cmp(&b.1));
        knots.dedup_by(|a, b| a.1 == b.1);
        knots
    }
}

/// The state where the polynomial through the knots, as a function of arclength, has the parameter.
fn interpolate(knots: &[(f64, f64, &[f64])], bracket: (f64, f64), parameter: f64) -> Vec<f64> {
    let weights = |s: f64| -> Vec<f64> {
        (0..knots.len())
            .map(|i| {
                let others = (0..knots.len()).filter(|j| *j != i);
                others
                    .map(|j| (s - knots[j].1) / (knots[i].1 - knots[j].1))
                    .product()
            })
            .collect()
    };
    let at = |s: f64| -> f64 {
        let weights = weights(s);
        weights.iter().zip(knots).map(|(w, knot)| w * knot.0).sum::<f64>() - parameter
    };
    let (mut left, mut right) = bracket;
    let rises = at(right) > at(left);
    for _ in 0..60 {
        let middle = 0.5 * (left + right);
        if (at(middle) > 0.0) == rises {
            right = middle;
        } else {
            left = middle;
        }
    }
    let weights = weights(0.5 * (left + right));
    let length = knots.first().map_or(0, |knot| knot.2.len());
    (0..length)
        .map(|i| weights.iter().zip(knots).map(|(w, knot)| w * knot.2[i]).sum())
        .collect()
}
