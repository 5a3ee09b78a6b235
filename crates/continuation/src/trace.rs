//! Following a family around folds (theory 02 §6).

use crate::Family;
use crate::corrector::{Scales, align, correct};
use crate::locate::locate_between;
use crate::options::{Options, StopReason};
use crate::point::{Point, Special, Trace};
use slackside_linalg::{dot, norm};

/// Told of each point while a branch is followed.
pub trait Watch {
    /// A solution on the branch, in order. Returns false to stop the run.
    fn point(&mut self, point: &Point) -> bool;

    /// A special point between the last point told and the next. Returns false if on closer look it is not one, so that it
    /// is not listed.
    fn special(&mut self, special: &Special) -> bool {
        let _ = special;
        true
    }
}

/// Watches nothing.
pub struct Unwatched;

impl Watch for Unwatched {
    fn point(&mut self, _: &Point) -> bool {
        true
    }
}

/// Follows the family from a solution near `(z, p)` in the direction in which `p` rises (`direction > 0`) or falls.
pub fn trace(
    family: &mut dyn Family,
    z: &[f64],
    p: f64,
    direction: f64,
    options: &Options,
    watch: &mut dyn Watch,
) -> Trace {
    let n = family.dimension();
    let mut tangent = vec![0.0; n + 1];
    tangent[n] = direction.signum();
    trace_from(family, z, p, &tangent, options, watch)
}

/// Follows the family from a solution near `(z, p)` along a given scaled tangent (length `n + 1`), as after branch
/// switching. The start is corrected in the hyperplane normal to the tangent.
pub fn trace_from(
    family: &mut dyn Family,
    z: &[f64],
    p: f64,
    tangent: &[f64],
    options: &Options,
    watch: &mut dyn Watch,
) -> Trace {
    let mut trace = Trace {
        points: Vec::new(),
        special: Vec::new(),
        stop: StopReason::NoStart(String::new()),
    };
    let anchor = Point {
        z: z.to_vec(),
        p,
        tangent: tangent.to_vec(),
        ..Point::default()
    };
    let mut scales = Scales::of(family);
    let start = match correct(family, &scales, &anchor, tangent, 0.0, options) {
        Ok(start) => start,
        Err(error) => {
            trace.stop = StopReason::NoStart(error.0);
            return trace;
        }
    };
    let mut current = start;
    align(&mut current.tangent, tangent);
    if !accept(&mut trace, &current, watch) {
        trace.stop = StopReason::Interrupted;
        return trace;
    }
    let mut step = options.first_step;
    loop {
        if trace.points.len() >= options.max_points {
            trace.stop = StopReason::PointLimit;
            return trace;
        }
        let direction = current.tangent.clone();
        let attempt = correct(family, &scales, &current, &direction, step, options);
        let next = match attempt {
            Ok(next) if is_smooth(&scales, &current, &next, &direction, step) => Some(next),
            _ => None,
        };
        let Some(mut next) = next else {
            step *= 0.5;
            if step < options.min_step {
                trace.stop = StopReason::StepTooSmall { p: current.p };
                return trace;
            }
            continue;
        };
        align(&mut next.tangent, &direction);
        next.arclength = current.arclength + step;
        let outside = next.p < options.range.0 || next.p > options.range.1;
        if outside && ends_at_limit(family, &scales, &current, &mut next, options) {
            // The last point lies on the limit itself.
        }
        locate_between(family, &scales, &current, &next, options, watch, &mut trace);
        let iterations = next.iterations;
        current = next;
        if !accept(&mut trace, &current, watch) {
            trace.stop = StopReason::Interrupted;
            return trace;
        }
        if outside {
            trace.stop = StopReason::RangeLimit;
            return trace;
        }
        if closes(&scales, &trace, step) {
            trace.stop = StopReason::Closed;
            return trace;
        }
        if family.adapt(&mut current.z, &mut current.tangent) {
            scales = Scales::of(family);
            let tangent = current.tangent.clone();
            let anchor = current.clone();
            match correct(family, &scales, &anchor, &tangent, 0.0, options) {
                Ok(mut adapted) => {
                    align(&mut adapted.tangent, &tangent);
                    adapted.arclength = anchor.arclength;
                    current = adapted;
                }
                Err(_) => {
                    trace.stop = StopReason::StepTooSmall { p: anchor.p };
                    return trace;
                }
            }
        }
        if iterations <= 3 {
            step = (1.4 * step).min(options.max_step);
        } else if iterations > 5 {
            step = (0.7 * step).max(options.min_step);
        }
    }
}

fn accept(trace: &mut Trace, point: &Point, watch: &mut dyn Watch) -> bool {
    trace.points.push(point.clone());
    watch.point(point)
}

/// Whether the corrected step stayed close to the predicted one: not longer than 1.5 times, tangent turned by at most 25°.
fn is_smooth(scales: &Scales, from: &Point, to: &Point, tangent: &[f64], step: f64) -> bool {
    let length = norm(&scales.difference(from, &to.z, to.p));
    length <= 1.5 * step && dot(&to.tangent, tangent).abs() >= 0.906
}

/// Shortens the last step so that it ends on the limit of the range, if a solution is found there.
fn ends_at_limit(
    family: &mut dyn Family,
    scales: &Scales,
    from: &Point,
    to: &mut Point,
    options: &Options,
) -> bool {
    let limit = if to.p < options.range.0 {
        options.range.0
    } else {
        options.range.1
    };
    let share = (limit - from.p) / (to.p - from.p);
    let n = from.z.len();
    let mut normal = vec![0.0; n + 1];
    normal[n] = 1.0;
    let guess = Point {
        z: (0..n)
            .map(|i| from.z[i] + share * (to.z[i] - from.z[i]))
            .collect(),
        p: limit,
        ..Point::default()
    };
    let Ok(mut end) = correct(family, scales, &guess, &normal, 0.0, options) else {
        return false;
    };
    if dot(&end.tangent, &to.tangent) < 0.0 {
        // The hyperplane's normal points to rising parameters, whatever the direction of the run.
        end.determinant_sign = -end.determinant_sign;
    }
    align(&mut end.tangent, &to.tangent);
    end.arclength = from.arclength + share * (to.arclength - from.arclength);
    end.p = limit;
    *to = end;
    true
}

/// Whether the last point lies on an earlier part of the branch, passed in the same direction.
fn closes(scales: &Scales, trace: &Trace, step: f64) -> bool {
    let Some((last, earlier)) = trace.points.split_last() else {
        return false;
    };
    let Some(first) = earlier.first() else {
        return false;
    };
    // The whole loop is known as soon as it comes back to its start.
    if earlier.len() < 8 || first.z.len() != last.z.len() {
        return false;
    }
    let difference = scales.difference(first, &last.z, last.p);
    let along = dot(&difference, &first.tangent);
    let across = (dot(&difference, &difference) - along * along).max(0.0).sqrt();
    dot(&last.tangent, &first.tangent) > 0.9 && along.abs() <= step && across <= 0.1 * step
}
