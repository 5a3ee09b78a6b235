//! Rotation number of a quasi-periodic motion by weighted Birkhoff averages (theory 02 §9.2).
//!
//! The stroboscopic points of a quasi-periodic motion fill a closed curve and turn about its centre by the mean angle
//! `2πρ` per period. With the weights `w(s) = exp(−1/(s(1−s)))`, `0 < s < 1`, the mean over `N` periods converges faster
//! than any power of `1/N`.

use super::poincare::PoincareMap;
use std::f64::consts::TAU;

/// Rotation number with the numbers that vouch for it.
#[derive(Debug, Clone, PartialEq)]
pub struct RotationNumber {
    /// Turns per `curves` periods of the load, folded to `[0, 1/2]`.
    pub value: f64,
    /// Difference to the value from the first half of the points.
    pub change: f64,
    /// Number of closed curves that the points visit in turn; 1 for a torus born from a motion of period one.
    pub curves: usize,
    /// Indices of the two state entries that span the plane in which turns were measured.
    pub plane: (usize, usize),
    /// Largest distance between points that are neighbours by phase `k ρ mod 1`, relative to the size of the curve: small
    /// if the points do fill a closed curve with this rotation number.
    pub gap: f64,
    /// Largest relative change of the curve's extent, per state entry, between the first and the second half of the
    /// points: zero but for rounding on a settled motion, finite on one that still spirals.
    pub drift: f64,
}

/// Why there is no rotation number.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RotationError {
    /// Too few points.
    #[error("a rotation number needs at least {needed} stroboscopic points, but there are {found}")]
    TooFewPoints {
        /// Least number of points.
        needed: usize,
        /// Number given.
        found: usize,
    },
    /// In no plane do the points turn about a centre like those of a closed curve.
    #[error(
        "the stroboscopic points do not lie on closed curves: neighbours by phase are {gap:.2} of the size apart"
    )]
    NoClosedCurve {
        /// Smallest value of [`RotationNumber::gap`] met.
        gap: f64,
    },
}

/// Least number of points per curve.
const LEAST: usize = 64;
/// Largest number of curves tried.
const MOST_CURVES: usize = 8;
/// Planes tried per number of curves: coordinate against own rate first, then other pairs.
const MOST_PLANES: usize = 200;
/// Largest gap, relative to the size, at which points count as a closed curve.
const LARGEST_GAP: f64 = 0.2;

/// Rotation number of the points of a settled motion. About 2000 points give six digits, 5000 nine or more.
///
/// # Errors
/// [`RotationError`] if there are too few points or they fill no closed curve.
pub fn rotation_number(map: &PoincareMap) -> Result<RotationNumber, RotationError> {
    if map.len() < LEAST {
        return Err(RotationError::TooFewPoints {
            needed: LEAST,
            found: map.len(),
        });
    }
    let mut smallest = f64::INFINITY;
    for curves in 1..=MOST_CURVES {
        let count = map.len() / curves;
        if count < LEAST {
            break;
        }
        let points = map.every(curves, count);
        let center = weighted_mean(&points);
        let scales = half_widths(&points, &center);
        for plane in planes(points.dimension()).take(MOST_PLANES) {
            let Some(value) = mean_turn(&points, &center, &scales, plane) else {
                continue;
            };
            let gap = largest_gap(&points, &scales, value);
            smallest = smallest.min(gap);
            if gap > LARGEST_GAP {
                continue;
            }
            let half = points.every(1, count.div_ceil(2));
            let center = weighted_mean(&half);
            let Some(before) = mean_turn(&half, &center, &scales, plane) else {
                continue;
            };
            let later = points.tail(count / 2);
            let drift = drift(
                &half_widths(&half, &center),
                &half_widths(&later, &center),
                &scales,
            );
            return Ok(RotationNumber {
                value: fold(value),
                change: (fold(value) - fold(before)).abs(),
                curves,
                plane,
                gap,
                drift,
            });
        }
    }
    Err(RotationError::NoClosedCurve { gap: smallest })
}

/// Pairs of state entries: each coordinate with its own rate, then all others.
fn planes(dimension: usize) -> impl Iterator<Item = (usize, usize)> {
    let n = dimension / 2;
    let own = (0..n).map(move |i| (i, i + n));
    let others = (0..dimension)
        .flat_map(move |i| (i + 1..dimension).map(move |j| (i, j)))
        .filter(move |&(i, j)| j != i + n);
    own.chain(others)
}

/// Weights `exp(−1/(s(1−s)))` at `count` interior points of the unit interval.
fn weights(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| {
        let s = (k as f64 + 0.5) / count as f64;
        (-1.0 / (s * (1.0 - s))).exp()
    })
}

fn weighted_mean(points: &PoincareMap) -> Vec<f64> {
    let mut sums = vec![0.0; points.dimension()];
    let mut total = 0.0;
    for (point, weight) in points.points().zip(weights(points.len())) {
        total += weight;
        for (sum, value) in sums.iter_mut().zip(point) {
            *sum += weight * value;
        }
    }
    sums.iter_mut().for_each(|sum| *sum /= total);
    sums
}

/// Largest distance from the centre per entry; one where the entry does not vary.
fn half_widths(points: &PoincareMap, center: &[f64]) -> Vec<f64> {
    let mut widths = vec![0.0_f64; center.len()];
    for point in points.points() {
        for i in 0..center.len() {
            widths[i] = widths[i].max((point[i] - center[i]).abs());
        }
    }
    widths
        .iter()
        .map(|&width| if width > 0.0 { width } else { 1.0 })
        .collect()
}

/// Mean turn per step in `[0, 1)`; `None` if the turns are spread over the whole circle, so that a turn forwards cannot be
/// told from one backwards.
fn mean_turn(points: &PoincareMap, center: &[f64], scales: &[f64], (i, j): (usize, usize)) -> Option<f64> {
    let angles: Vec<f64> = points
        .points()
        .map(|point| {
            let (x, y) = (
                (point[i] - center[i]) / scales[i],
                (point[j] - center[j]) / scales[j],
            );
            y.atan2(x) / TAU
        })
        .collect();
    let turns: Vec<f64> = angles
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).rem_euclid(1.0))
        .collect();
    // Turns are known up to whole ones. All lie within one turn that starts behind the widest gap between them.
    let mut sorted = turns.clone();
    sorted.sort_by(f64::total_cmp);
    let (&first, &last) = (sorted.first()?, sorted.last()?);
    let mut cut = (first + 1.0 - last, first);
    for pair in sorted.windows(2) {
        if pair[1] - pair[0] > cut.0 {
            cut = (pair[1] - pair[0], pair[1]);
        }
    }
    let (gap, start) = cut;
    if gap < 0.05 {
        return None;
    }
    // Half a gap of margin keeps rounding from wrapping the first turn.
    let origin = start - 0.5 * gap;
    let (mut sum, mut total) = (0.0, 0.0);
    for (turn, weight) in turns.iter().zip(weights(turns.len())) {
        total += weight;
        sum += weight * (turn - origin).rem_euclid(1.0);
    }
    Some((origin + sum / total).rem_euclid(1.0))
}

/// Largest distance between points that follow each other in the order of the phase `k ρ mod 1`, over all state entries
/// relative to their half-widths.
fn largest_gap(points: &PoincareMap, scales: &[f64], rotation: f64) -> f64 {
    let mut order: Vec<(f64, usize)> = (0..points.len())
        .map(|k| ((k as f64 * rotation).rem_euclid(1.0), k))
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let distance = |a: usize, b: usize| {
        points
            .point(a)
            .iter()
            .zip(points.point(b))
            .zip(scales)
            .fold(0.0_f64, |largest, ((x, y), scale)| {
                largest.max((x - y).abs() / scale)
            })
    };
    let closing = order
        .first()
        .zip(order.last())
        .map_or(0.0, |(first, last)| distance(first.1, last.1));
    order.windows(2).fold(closing, |largest, pair| {
        largest.max(distance(pair[0].1, pair[1].1))
    })
}

/// Largest relative difference of extents, over the entries that contribute to the curve.
fn drift(before: &[f64], after: &[f64], scales: &[f64]) -> f64 {
    before
        .iter()
        .zip(after)
        .zip(scales)
        .fold(0.0, |largest, ((a, b), scale)| largest.max((a - b).abs() / scale))
}

/// A rotation number and its negative are the same turn seen from two sides.
fn fold(turn: f64) -> f64 {
    turn.min(1.0 - turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on `curves` distorted circles in four dimensions that turn by `rotation` per visit.
    fn circle(rotation: f64, curves: usize, count: usize) -> PoincareMap {
        let mut map = PoincareMap::new(4);
        for k in 0..count {
            let curve = (k % curves) as f64;
            let angle = TAU * rotation * (k / curves) as f64;
            let radius = 1.0 + 0.2 * (2.0 * angle).cos();
            map.push(&[
                0.3 + 4.0 * curve + radius * angle.cos(),
                -0.1 + 0.1 * (2.0 * angle).sin(),
                0.5 + 2.0 * radius * angle.sin() - curve,
                0.2 * (angle + 1.0).sin(),
            ]);
        }
        map
    }

    #[test]
    fn a_distorted_circle_keeps_the_rotation_number_of_the_rigid_one() {
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let found = rotation_number(&circle(golden, 1, 4000)).unwrap();
        assert!((found.value - (1.0 - golden)).abs() < 1e-11, "{found:?}");
        assert!(found.change < 1e-8, "{found:?}");
        assert_eq!(found.curves, 1);
    }

    #[test]
    fn two_curves_visited_in_turn_are_told_apart() {
        let rotation = 0.1 * 2.0_f64.sqrt();
        let found = rotation_number(&circle(rotation, 2, 6000)).unwrap();
        assert_eq!(found.curves, 2);
        assert!((found.value - rotation).abs() < 1e-10, "{found:?}");
    }

    #[test]
    fn scattered_points_have_none() {
        // The logistic map at full chaos in each entry.
        let mut map = PoincareMap::new(4);
        let mut state = [0.1234, 0.3456, 0.5678, 0.789];
        for _ in 0..2000 {
            map.push(&state);
            state.iter_mut().for_each(|x| *x = 3.999 * *x * (1.0 - *x));
        }
        assert!(matches!(
            rotation_number(&map),
            Err(RotationError::NoClosedCurve { .. })
        ));
        assert!(matches!(
            rotation_number(&circle(0.3, 1, 10)),
            Err(RotationError::TooFewPoints { found: 10, .. })
        ));
    }
}
