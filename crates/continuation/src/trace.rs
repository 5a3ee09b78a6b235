//! Following a family around folds (theory 02 §6).

use crate::options::{Options, StopReason};
use crate::point::{Kind, Point, Special, Trace};
use crate::{Evaluation, Family, FamilyError};
use slackside_linalg::{Lu, Matrix, dot, norm};

/// Told of each point while a branch is followed.
pub trait Watch {
    /// A solution on the branch, in order. Returns false to stop the run.
    fn point(&mut self, family: &mut dyn Family, point: &Point, evaluation: &Evaluation) -> bool;

    /// A special point between the previous point and the next, told after it has been located. Return false if on
    /// closer look it is not one, so that it is not listed.
    fn special(&mut self, family: &mut dyn Family, special: &Special, evaluation: &Evaluation) -> bool {
        let _ = (family, special, evaluation);
        true
    }

    /// Whether something happened between two neighbouring points that test functions of the family do not tell by a
    /// sign change; returns the kinds to look for by bisection on [`Self::state_of`].
    fn state_of(&mut self, family: &mut dyn Family, point: &Point, evaluation: &Evaluation) -> i64 {
        let _ = (family, point, evaluation);
        0
    }
}

/// Watches nothing.
pub struct Unwatched;

impl Watch for Unwatched {
    fn point(&mut self, _: &mut dyn Family, _: &Point, _: &Evaluation) -> bool {
        true
    }
}

/// A solution together with the tangent there.
struct Solution {
    point: Point,
    evaluation: Evaluation,
}

/// Scales of unknowns and parameter: arclength is measured in scaled variables.
struct Scales {
    unknowns: Vec<f64>,
    parameter: f64,
}

impl Scales {
    fn of(family: &dyn Family) -> Self {
        Self { unknowns: family.unknown_scales(), parameter: family.parameter_scale() }
    }

    /// The point at scaled distance `s` from `from` along `tangent`.
    fn predict(&self, from: &Point, tangent: &[f64], s: f64) -> (Vec<f64>, f64) {
        let n = self.unknowns.len();
        let z = (0..n).map(|i| from.z[i] + s * tangent[i] * self.unknowns[i]).collect();
        (z, from.p + s * tangent[n] * self.parameter)
    }

    /// The scaled difference `to − from`.
    fn difference(&self, from: &Point, z: &[f64], p: f64) -> Vec<f64> {
        let mut d: Vec<f64> = (0..z.len()).map(|i| (z[i] - from.z[i]) / self.unknowns[i]).collect();
        d.push((p - from.p) / self.parameter);
        d
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
    let mut trace = Trace { points: Vec::new(), special: Vec::new(), stop: StopReason::NoStart(String::new()) };
    let anchor = Point { z: z.to_vec(), p, tangent: tangent.to_vec(), ..Point::default() };
    let mut scales = Scales::of(family);
    let start = match correct(family, &scales, &anchor, tangent, 0.0, options) {
        Ok(start) => start,
        Err(error) => {
            trace.stop = StopReason::NoStart(error.0);
            return trace;
        }
    };
    let mut current = start;
    align(&mut current.point.tangent, tangent);
    if !accept(&mut trace, family, &current, watch) {
        trace.stop = StopReason::Interrupted;
        return trace;
    }
    let mut step = options.first_step;
    loop {
        if trace.points.len() >= options.max_points {
            trace.stop = StopReason::PointLimit;
            return trace;
        }
        let direction = current.point.tangent.clone();
        let attempt = correct(family, &scales, &current.point, &direction, step, options);
        let next = match attempt {
            Ok(next) if is_smooth(&scales, &current.point, &next.point, &direction, step) => Some(next),
            _ => None,
        };
        let Some(mut next) = next else {
            step *= 0.5;
            if step < options.min_step {
                trace.stop = StopReason::StepTooSmall { p: current.point.p };
                return trace;
            }
            continue;
        };
        align(&mut next.point.tangent, &direction);
        next.point.arclength = current.point.arclength + step;
        let outside = next.point.p < options.range.0 || next.point.p > options.range.1;
        if outside && ends_at_limit(family, &scales, &current, &mut next, options) {
            // The last point lies on the limit itself.
        }
        locate_between(family, &scales, &current, &next, options, watch, &mut trace);
        let iterations = next.point.iterations;
        current = next;
        if !accept(&mut trace, family, &current, watch) {
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
        if family.adapt(&mut current.point.z, &mut current.point.tangent) {
            scales = Scales::of(family);
            let tangent = current.point.tangent.clone();
            let anchor = current.point.clone();
            match correct(family, &scales, &anchor, &tangent, 0.0, options) {
                Ok(mut adapted) => {
                    align(&mut adapted.point.tangent, &tangent);
                    adapted.point.arclength = anchor.arclength;
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

fn accept(trace: &mut Trace, family: &mut dyn Family, solution: &Solution, watch: &mut dyn Watch) -> bool {
    let go_on = watch.point(family, &solution.point, &solution.evaluation);
    trace.points.push(solution.point.clone());
    go_on
}

/// Newton's method for `F = 0` in the hyperplane at scaled distance `s` from `from` along `tangent`.
fn correct(
    family: &mut dyn Family,
    scales: &Scales,
    from: &Point,
    tangent: &[f64],
    s: f64,
    options: &Options,
) -> Result<Solution, FamilyError> {
    let n = family.dimension();
    let (mut z, mut p) = scales.predict(from, tangent, s);
    let mut evaluation = Evaluation::new(n);
    let mut right = vec![0.0; n + 1];
    let mut previous = f64::INFINITY;
    for iteration in 0..=options.max_iterations {
        family.evaluate(&z, p, &mut evaluation)?;
        let bordered = bordered(&evaluation, scales, tangent);
        let lu = Lu::new(&bordered).map_err(|error| FamilyError(error.to_string()))?;
        for i in 0..n {
            right[i] = -evaluation.residual[i] / scales.unknowns[i];
        }
        right[n] = s - dot(&scales.difference(from, &z, p), tangent);
        lu.solve_in_place(&mut right);
        let size = norm(&right);
        let done = size <= options.tolerance || (size <= options.loose_tolerance && size > 0.5 * previous);
        if !size.is_finite() || (iteration > 0 && size > options.divergence * previous.max(options.tolerance)) {
            break;
        }
        for i in 0..n {
            z[i] += right[i] * scales.unknowns[i];
        }
        p += right[n] * scales.parameter;
        if done {
            let mut new_tangent = vec![0.0; n + 1];
            new_tangent[n] = 1.0;
            lu.solve_in_place(&mut new_tangent);
            let length = norm(&new_tangent);
            new_tangent.iter_mut().for_each(|value| *value /= length);
            let tests = family.test_functions(&z, p, &evaluation);
            let determinant_sign = lu.determinant().signum() * new_tangent_sign(&new_tangent, tangent);
            let residual = evaluation
                .residual
                .iter()
                .zip(&scales.unknowns)
                .fold(0.0_f64, |largest, (r, scale)| largest.max((r / scale).abs()));
            let point = Point {
                z,
                p,
                tangent: new_tangent,
                arclength: 0.0,
                iterations: iteration,
                residual,
                tests,
                determinant_sign,
            };
            return Ok(Solution { point, evaluation });
        }
        previous = size;
    }
    Err(FamilyError("Newton's method did not converge".into()))
}

fn new_tangent_sign(tangent: &[f64], reference: &[f64]) -> f64 {
    if dot(tangent, reference) < 0.0 { -1.0 } else { 1.0 }
}

/// The scaled bordered matrix `[F_z F_p; tᵀ]`.
fn bordered(evaluation: &Evaluation, scales: &Scales, tangent: &[f64]) -> Matrix {
    let n = evaluation.residual.len();
    let mut matrix = Matrix::zeros(n + 1, n + 1);
    for i in 0..n {
        let row = matrix.row_mut(i);
        for j in 0..n {
            row[j] = evaluation.jacobian[(i, j)] * scales.unknowns[j] / scales.unknowns[i];
        }
        row[n] = evaluation.by_parameter[i] * scales.parameter / scales.unknowns[i];
    }
    matrix.row_mut(n).copy_from_slice(tangent);
    matrix
}

fn align(tangent: &mut [f64], reference: &[f64]) {
    if dot(tangent, reference) < 0.0 {
        tangent.iter_mut().for_each(|value| *value = -*value);
    }
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
    from: &Solution,
    to: &mut Solution,
    options: &Options,
) -> bool {
    let limit = if to.point.p < options.range.0 { options.range.0 } else { options.range.1 };
    let share = (limit - from.point.p) / (to.point.p - from.point.p);
    let n = from.point.z.len();
    let mut normal = vec![0.0; n + 1];
    normal[n] = 1.0;
    let guess = Point {
        z: (0..n).map(|i| from.point.z[i] + share * (to.point.z[i] - from.point.z[i])).collect(),
        p: limit,
        ..Point::default()
    };
    let Ok(mut end) = correct(family, scales, &guess, &normal, 0.0, options) else { return false };
    align(&mut end.point.tangent, &to.point.tangent);
    end.point.arclength = from.point.arclength + share * (to.point.arclength - from.point.arclength);
    end.point.p = limit;
    *to = end;
    true
}

/// Whether the last point lies on an earlier part of the branch, passed in the same direction.
fn closes(scales: &Scales, trace: &Trace, step: f64) -> bool {
    let Some((last, earlier)) = trace.points.split_last() else { return false };
    let Some(first) = earlier.first() else { return false };
    // The whole loop is known as soon as it comes back to its start.
    if earlier.len() < 8 || first.z.len() != last.z.len() {
        return false;
    }
    let difference = scales.difference(first, &last.z, last.p);
    let along = dot(&difference, &first.tangent);
    let across = (dot(&difference, &difference) - along * along).max(0.0).sqrt();
    dot(&last.tangent, &first.tangent) > 0.9 && along.abs() <= step && across <= 0.1 * step
}

/// Finds all special points between two neighbouring solutions, in their order along the branch.
fn locate_between(
    family: &mut dyn Family,
    scales: &Scales,
    left: &Solution,
    right: &Solution,
    options: &Options,
    watch: &mut dyn Watch,
    trace: &mut Trace,
) {
    if !options.locate || left.point.z.len() != right.point.z.len() {
        return;
    }
    let n = left.point.z.len();
    let tangent = left.point.tangent.clone();
    let reach = dot(&scales.difference(&left.point, &right.point.z, right.point.p), &tangent);
    let mut found: Vec<(f64, Solution, Kind)> = Vec::new();
    let fold = |point: &Point| point.tangent[n];
    if fold(&left.point) * fold(&right.point) < 0.0 {
        if let Some((s, solution)) =
            zero_between(family, scales, left, (reach, right), &tangent, options, &fold, 1e-9)
        {
            found.push((s, solution, Kind::Fold));
        }
    } else if left.point.determinant_sign * right.point.determinant_sign < 0.0 {
        let s = 0.5 * reach;
        if let Ok(solution) = correct(family, scales, &left.point, &tangent, s, options) {
            found.push((s, solution, Kind::BranchPoint));
        }
    }
    for test in 0..left.point.tests.len().min(right.point.tests.len()) {
        if left.point.tests[test] * right.point.tests[test] < 0.0 {
            let value = |point: &Point| point.tests[test];
            if let Some((s, solution)) =
                zero_between(family, scales, left, (reach, right), &tangent, options, &value, 1e-7)
            {
                found.push((s, solution, Kind::Test(test)));
            }
        }
    }
    let (before, after) = (
        watch.state_of(family, &left.point, &left.evaluation),
        watch.state_of(family, &right.point, &right.evaluation),
    );
    if before != after {
        found.extend(changes_between(family, scales, left, (reach, after), before, &tangent, options, watch));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (s, solution, kind) in found {
        let arclength = left.point.arclength + s;
        let special = Special { kind, point: Point { arclength, ..solution.point } };
        if watch.special(family, &special, &solution.evaluation) {
            trace.special.push(special);
        }
    }
}

/// The zero of `value` along the branch between two solutions, by the method of Brent in the distance `s` along the
/// tangent of the left one; `None` if the sign change is not a zero.
fn zero_between(
    family: &mut dyn Family,
    scales: &Scales,
    left: &Solution,
    right: (f64, &Solution),
    tangent: &[f64],
    options: &Options,
    value: &dyn Fn(&Point) -> f64,
    small: f64,
) -> Option<(f64, Solution)> {
    let (f_left, f_right) = (value(&left.point), value(&right.1.point));
    let scale = f_left.abs().max(f_right.abs());
    let mut best: Option<(f64, f64, Solution)> = None;
    let mut evaluate = |s: f64| -> Option<f64> {
        let mut solution = correct(family, scales, &left.point, tangent, s, options).ok()?;
        align(&mut solution.point.tangent, tangent);
        let f = value(&solution.point);
        if best.as_ref().is_none_or(|(_, smallest, _)| f.abs() < *smallest) {
            best = Some((s, f.abs(), solution));
        }
        Some(f)
    };
    crate::zero::brent(0.0, right.0, f_left, f_right, 1e-14, &mut evaluate);
    let (s, smallest, solution) = best?;
    (smallest <= small.max(1e-4 * scale)).then_some((s, solution))
}

/// Places where the watched state changes, by bisection to a distance of `1e-10` along the branch.
fn changes_between(
    family: &mut dyn Family,
    scales: &Scales,
    left: &Solution,
    right: (f64, i64),
    before: i64,
    tangent: &[f64],
    options: &Options,
    watch: &mut dyn Watch,
) -> Vec<(f64, Solution, Kind)> {
    let mut found = Vec::new();
    let (mut low, mut state) = (0.0, before);
    // Several changes may lie in one step; each pass finds the first one left.
    for _ in 0..8 {
        if state == right.1 {
            break;
        }
        let (mut a, mut b) = (low, right.0);
        let mut last = None;
        let mut state_behind = right.1;
        while b - a > 1e-13 * right.0.max(1e-3) {
            let middle = 0.5 * (a + b);
            if middle <= a || middle >= b {
                break;
            }
            let Ok(mut solution) = correct(family, scales, &left.point, tangent, middle, options) else { break };
            align(&mut solution.point.tangent, tangent);
            let here = watch.state_of(family, &solution.point, &solution.evaluation);
            if here == state {
                a = middle;
            } else {
                b = middle;
                state_behind = here;
            }
            last = Some(solution);
        }
        if let Some(solution) = last {
            found.push((0.5 * (a + b), solution, Kind::Change { from: state, to: state_behind }));
        }
        low = b;
        state = state_behind;
    }
    found
}
