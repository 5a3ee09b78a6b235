//! Following a family around folds (theory 02 §6).

use crate::options::{Options, StopReason};
use crate::point::{Kind, Point, Special, Trace};
use crate::{Evaluation, Family, FamilyError};
use slackside_linalg::{Lu, Matrix, dot, norm};

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

/// Scales of unknowns and parameter: arclength is measured in scaled variables.
struct Scales {
    unknowns: Vec<f64>,
    parameter: f64,
}

impl Scales {
    fn of(family: &dyn Family) -> Self {
        Self {
            unknowns: family.unknown_scales(),
            parameter: family.parameter_scale(),
        }
    }

    /// The point at scaled distance `s` from `from` along `tangent`.
    fn predict(&self, from: &Point, tangent: &[f64], s: f64) -> (Vec<f64>, f64) {
        let n = self.unknowns.len();
        let z = (0..n)
            .map(|i| from.z[i] + s * tangent[i] * self.unknowns[i])
            .collect();
        (z, from.p + s * tangent[n] * self.parameter)
    }

    /// The scaled difference `to − from`.
    fn difference(&self, from: &Point, z: &[f64], p: f64) -> Vec<f64> {
        let mut d: Vec<f64> = (0..z.len())
            .map(|i| (z[i] - from.z[i]) / self.unknowns[i])
            .collect();
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

/// Newton's method for `F = 0` in the hyperplane at scaled distance `s` from `from` along `tangent`.
fn correct(
    family: &mut dyn Family,
    scales: &Scales,
    from: &Point,
    tangent: &[f64],
    s: f64,
    options: &Options,
) -> Result<Point, FamilyError> {
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
        if !size.is_finite() || (iteration > 0 && size > options.divergence * previous.max(options.tolerance))
        {
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
            let pattern = family.pattern(&z, p, &evaluation);
            let observed = family.observe(&z, p, &evaluation);
            return Ok(Point {
                z,
                p,
                tangent: new_tangent,
                arclength: 0.0,
                iterations: iteration,
                residual,
                tests,
                pattern,
                observed,
                determinant_sign,
            });
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

/// A point at a distance along the tangent of the left end of the step.
type Sample = (f64, Point);

/// Finds all special points between two neighbouring solutions, in their order along the branch.
fn locate_between(
    family: &mut dyn Family,
    scales: &Scales,
    left: &Point,
    right: &Point,
    options: &Options,
    watch: &mut dyn Watch,
    trace: &mut Trace,
) {
    if !options.locate || left.z.len() != right.z.len() {
        return;
    }
    let n = left.z.len();
    let reach = dot(&scales.difference(left, &right.z, right.p), &left.tangent);
    let mut samples: Vec<Sample> = Vec::new();
    if let Some(before) = trace
        .points
        .iter()
        .rev()
        .nth(1)
        .filter(|before| before.z.len() == n)
    {
        samples.push((before.arclength - left.arclength, before.clone()));
    }
    let first = samples.len();
    samples.push((0.0, left.clone()));
    refine(
        family,
        scales,
        left,
        (reach, right),
        options,
        REFINEMENTS,
        &mut samples,
    );
    let mut found: Vec<(f64, Point, Kind)> = Vec::new();
    let mut zeros_of = |family: &mut dyn Family, value: &dyn Fn(&Point) -> f64, kind: Kind, small: f64| {
        for bracket in brackets(family, scales, &samples, first, options, value) {
            if let Some((s, solution)) = zero_between(family, scales, left, bracket, options, value, small) {
                found.push((s, solution, kind));
            }
        }
    };
    zeros_of(family, &|point| point.tangent[n], Kind::Fold, 1e-9);
    for test in 0..left.tests.len() {
        zeros_of(family, &|point| point.tests[test], Kind::Test(test), 1e-7);
    }
    if found.iter().all(|(_, _, kind)| *kind != Kind::Fold)
        && left.determinant_sign * right.determinant_sign < 0.0
        && let Ok(solution) = correct(family, scales, left, &left.tangent, 0.5 * reach, options)
    {
        found.push((0.5 * reach, solution, Kind::BranchPoint));
    }
    if left.pattern != right.pattern {
        found.extend(changes_between(
            family,
            scales,
            left,
            (reach, right.pattern),
            options,
        ));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (s, point, kind) in found {
        let arclength = left.arclength + s;
        let special = Special {
            kind,
            point: Point { arclength, ..point },
        };
        if watch.special(&special) {
            trace.special.push(special);
        }
    }
}

/// Times that a suspicious step is halved before its test functions are compared.
const REFINEMENTS: usize = 3;

/// Appends samples up to `right`, with intermediate ones where the discrete pattern changes or a test function shrinks
/// fast: it may pass zero and come back within the step (its slope is infinite where the pattern changes).
fn refine(
    family: &mut dyn Family,
    scales: &Scales,
    left: &Point,
    (s_right, right): (f64, &Point),
    options: &Options,
    depth: usize,
    samples: &mut Vec<Sample>,
) {
    let n = left.z.len();
    if let Some((s_last, last)) = samples.last() {
        let shrinks = |a: f64, b: f64| a * b > 0.0 && a.abs().min(b.abs()) < 0.5 * a.abs().max(b.abs());
        let suspicious = last.pattern != right.pattern
            || shrinks(last.tangent[n], right.tangent[n])
            || last.tests.iter().zip(&right.tests).any(|(&a, &b)| shrinks(a, b));
        if depth > 0 && suspicious {
            let middle = 0.5 * (s_last + s_right);
            if let Ok(mut solution) = correct(family, scales, left, &left.tangent, middle, options) {
                align(&mut solution.tangent, &left.tangent);
                refine(
                    family,
                    scales,
                    left,
                    (middle, &solution),
                    options,
                    depth - 1,
                    samples,
                );
                refine(
                    family,
                    scales,
                    left,
                    (s_right, right),
                    options,
                    depth - 1,
                    samples,
                );
                return;
            }
        }
    }
    samples.push((s_right, right.clone()));
}

/// Distances and values `(a, f(a), b, f(b))` of neighbouring places at which `value` has opposite signs. The samples from
/// `first` on lie in the step; an earlier one helps to see a dip.
fn brackets(
    family: &mut dyn Family,
    scales: &Scales,
    samples: &[Sample],
    first: usize,
    options: &Options,
    value: &dyn Fn(&Point) -> f64,
) -> Vec<(f64, f64, f64, f64)> {
    let values: Vec<(f64, f64)> = samples.iter().map(|(s, point)| (*s, value(point))).collect();
    let mut found = Vec::new();
    for i in first..samples.len() - 1 {
        let ((a, fa), (b, fb)) = (values[i], values[i + 1]);
        if fa * fb < 0.0 {
            found.push((a, fa, b, fb));
            continue;
        }
        // The parabola through this interval and a neighbour of either side.
        let neighbours = [i.checked_sub(1), (i + 2 < values.len()).then_some(i + 2)];
        let hidden = neighbours.into_iter().flatten().find_map(|j| {
            hidden_change(
                family,
                scales,
                &samples[first].1,
                values[j],
                (a, fa),
                (b, fb),
                options,
                value,
            )
        });
        if let Some((s, f)) = hidden {
            found.push((a, fa, s, f));
            found.push((s, f, b, fb));
        }
    }
    found
}

/// The zero of `value` along the branch between two solutions, by the method of Brent in the distance `s` along the
/// tangent of the left one; `None` if the sign change is not a zero.
fn zero_between(
    family: &mut dyn Family,
    scales: &Scales,
    left: &Point,
    (from, f_left, to, f_right): (f64, f64, f64, f64),
    options: &Options,
    value: &dyn Fn(&Point) -> f64,
    small: f64,
) -> Option<(f64, Point)> {
    let scale = f_left.abs().max(f_right.abs());
    let mut best: Option<(f64, f64, Point)> = None;
    let mut evaluate = |s: f64| -> Option<f64> {
        let mut solution = correct(family, scales, left, &left.tangent, s, options).ok()?;
        align(&mut solution.tangent, &left.tangent);
        let f = value(&solution);
        if best.as_ref().is_none_or(|(_, smallest, _)| f.abs() < *smallest) {
            best = Some((s, f.abs(), solution));
        }
        Some(f)
    };
    crate::zero::brent(from, to, f_left, f_right, 1e-14, &mut evaluate);
    let (s, smallest, solution) = best?;
    (smallest <= small.max(1e-4 * scale)).then_some((s, solution))
}

/// A test function that has the same sign at both ends `a`, `b` of an interval may still pass zero twice within it. Where
/// the parabola through them and a third place dips towards zero inside, its vertex is looked at; returns the distance and
/// the value there if the sign is the other one.
fn hidden_change(
    family: &mut dyn Family,
    scales: &Scales,
    left: &Point,
    third: (f64, f64),
    a: (f64, f64),
    b: (f64, f64),
    options: &Options,
    value: &dyn Fn(&Point) -> f64,
) -> Option<(f64, f64)> {
    let mut third = third;
    let (mut a, mut b) = (a, b);
    for _ in 0..4 {
        let slope = (b.1 - a.1) / (b.0 - a.0);
        let curvature = ((third.1 - b.1) / (third.0 - b.0) - slope) / (third.0 - a.0);
        let vertex = 0.5 * (a.0 + b.0 - slope / curvature);
        let margin = 0.02 * (b.0 - a.0);
        // Of interest only if the parabola bends away from zero and its vertex lies inside.
        if !(curvature * a.1 > 0.0 && vertex > a.0 + margin && vertex < b.0 - margin) {
            return None;
        }
        let predicted = a.1 + (vertex - a.0) * (slope + curvature * (vertex - b.0));
        if predicted * a.1 > 0.0 && predicted.abs() > 0.7 * a.1.abs().min(b.1.abs()) {
            return None;
        }
        let mut solution = correct(family, scales, left, &left.tangent, vertex, options).ok()?;
        align(&mut solution.tangent, &left.tangent);
        let f = value(&solution);
        if f * a.1 < 0.0 {
            return Some((vertex, f));
        }
        // Next, the interval on the side of the lower end, with the other end as the third place.
        if a.1.abs() < b.1.abs() {
            (third, b) = (b, (vertex, f));
        } else {
            (third, a) = (a, (vertex, f));
        }
    }
    None
}

/// Places where the discrete pattern changes, by bisection to a distance of `1e-11` along the branch.
fn changes_between(
    family: &mut dyn Family,
    scales: &Scales,
    left: &Point,
    right: (f64, i64),
    options: &Options,
) -> Vec<(f64, Point, Kind)> {
    let mut found = Vec::new();
    let (mut low, mut state) = (0.0, left.pattern);
    // Several changes may lie in one step; each pass finds the first one left.
    for _ in 0..8 {
        if state == right.1 {
            break;
        }
        let (mut a, mut b) = (low, right.0);
        let mut last = None;
        let mut state_behind = right.1;
        while b - a > 1e-11 {
            let middle = 0.5 * (a + b);
            if middle <= a || middle >= b {
                break;
            }
            let Ok(mut solution) = correct(family, scales, left, &left.tangent, middle, options) else {
                break;
            };
            align(&mut solution.tangent, &left.tangent);
            let here = solution.pattern;
            if here == state {
                a = middle;
            } else {
                b = middle;
                state_behind = here;
            }
            last = Some(solution);
        }
        if let Some(solution) = last {
            found.push((
                0.5 * (a + b),
                solution,
                Kind::Change {
                    from: state,
                    to: state_behind,
                },
            ));
        }
        low = b;
        state = state_behind;
    }
    found
}
