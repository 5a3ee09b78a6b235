//! Special points between two neighbouring solutions (theory 02 §6).

use crate::Family;
use crate::corrector::{Scales, align, correct};
use crate::options::Options;
use crate::point::{Kind, Point, Special, Trace};
use crate::trace::Watch;
use slackside_linalg::dot;

/// A point at a distance along the tangent of the left end of the step.
type Sample = (f64, Point);

/// Finds all special points between two neighbouring solutions, in their order along the branch.
pub(crate) fn locate_between(
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
