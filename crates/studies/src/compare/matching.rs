//! Motions of equal RMS on two curves: at folds a difference at equal frequency means nothing, one of the frequency at
//! equal RMS does (theory 02 §11).

/// A curve as parameter and RMS, from the side of low parameters to that of high ones.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    points: Vec<[f64; 2]>,
    /// Distance along the curve, in the units of its extent.
    along: Vec<f64>,
    /// Number of the point of the largest RMS, which divides the two sides of the resonance.
    top: usize,
}

impl Curve {
    /// A curve from its points.
    pub fn new(mut points: Vec<[f64; 2]>) -> Self {
        points.retain(|point| point.iter().all(|value| value.is_finite()));
        if points
            .first()
            .zip(points.last())
            .is_some_and(|(first, last)| is_backward(*first, *last, &points))
        {
            points.reverse();
        }
        let extent = |i: usize| {
            let values = || points.iter().map(|point| point[i]);
            let size = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
            if size > 0.0 { size } else { 1.0 }
        };
        let scales = [extent(0), extent(1)];
        let mut along = Vec::with_capacity(points.len());
        let mut distance = 0.0;
        for i in 0..points.len() {
            if i > 0 {
                let step = |k: usize| (points[i][k] - points[i - 1][k]) / scales[k];
                distance += step(0).hypot(step(1));
            }
            along.push(distance);
        }
        let top = (0..points.len())
            .max_by(|&a, &b| points[a][1].total_cmp(&points[b][1]))
            .unwrap_or(0);
        Self { points, along, top }
    }

    /// The points.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Whether a point lies on the side of low parameters.
    pub fn is_low(&self, index: usize) -> bool {
        index <= self.top
    }

    /// Parameters on one side at which the RMS is met.
    pub fn parameters_at(&self, rms: f64, low: bool) -> Vec<f64> {
        let side = if low {
            0..self.top
        } else {
            self.top..self.points.len().saturating_sub(1)
        };
        side.filter(|&i| {
            let (a, b) = (self.points[i][1] - rms, self.points[i + 1][1] - rms);
            a == 0.0 || a * b < 0.0
        })
        .map(|i| self.parameter_between(i, rms))
        .collect()
    }

    /// The parameter where the cubic through the four points about segment `i` has the RMS.
    fn parameter_between(&self, i: usize, rms: f64) -> f64 {
        let first = i.saturating_sub(1).min(self.points.len().saturating_sub(4));
        let last = (first + 4).min(self.points.len());
        let value = |s: f64, k: usize| -> f64 {
            (first..last)
                .map(|j| {
                    let others = (first..last).filter(|&l| l != j);
                    let weight: f64 = others
                        .map(|l| (s - self.along[l]) / (self.along[j] - self.along[l]))
                        .product();
                    weight * self.points[j][k]
                })
                .sum()
        };
        let (mut left, mut right) = (self.along[i], self.along[i + 1]);
        let rises = self.points[i + 1][1] > self.points[i][1];
        for _ in 0..50 {
            let middle = 0.5 * (left + right);
            if (value(middle, 1) > rms) == rises {
                right = middle;
            } else {
                left = middle;
            }
        }
        value(0.5 * (left + right), 0)
    }
}

/// Whether a curve runs against the order low side, top, high side. One that leaves the range where it entered it has its
/// small motions outside: before the top at the lower end of the range, behind it at the upper end.
pub fn is_backward(first: [f64; 2], last: [f64; 2], points: &[[f64; 2]]) -> bool {
    if first[0] != last[0] {
        return first[0] > last[0];
    }
    let at_low_end = points.iter().all(|point| point[0] >= first[0]);
    (first[1] > last[1]) == at_low_end
}

/// The relative error of `approximate` at point `index` of `exact`: from the nearest parameter at which it has the same RMS
/// on the same side; `None` if there is none. An RMS above the largest of the approximation by no more than the share
/// `slack` is compared with that largest.
pub fn error(exact: &Curve, index: usize, approximate: &[Curve], slack: f64) -> Option<f64> {
    let [parameter, rms] = *exact.points.get(index)?;
    let low = exact.is_low(index);
    let tops = approximate.iter().filter_map(|curve| curve.points.get(curve.top));
    let near = tops.filter(|top| rms > top[1] && rms <= (1.0 + slack) * top[1]);
    approximate
        .iter()
        .flat_map(|curve| curve.parameters_at(rms, low))
        .chain(near.map(|top| top[0]))
        .map(|found| (found / parameter - 1.0).abs())
        .min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bent resonance: the parameter over the phase, with RMS `sin`.
    fn resonance(shift: f64, points: usize) -> Curve {
        let at = |i: usize| {
            let phase = 0.05 + 3.04 * i as f64 / (points - 1) as f64;
            let rms = phase.sin();
            [5.0 - 0.2 / phase.tan() - 1.5 * rms * rms + shift, rms]
        };
        Curve::new((0..points).map(at).collect())
    }

    #[test]
    fn a_shifted_curve_has_the_shift_as_error_on_both_sides_of_a_fold() {
        let exact = resonance(0.0, 200);
        let shifted = [resonance(0.01, 317)];
        for index in (2..198).filter(|&i| exact.points()[i][1] < 0.999) {
            let found = error(&exact, index, &shifted, 0.0).unwrap();
            // Far from the resonance the sampled points lie far apart.
            let allowed = if (20..180).contains(&index) { 1e-2 } else { 0.02 };
            let expected = 0.01 / exact.points()[index][0];
            assert!(
                (found / expected - 1.0).abs() < allowed,
                "{index}: {found} {expected}"
            );
        }
    }

    #[test]
    fn where_the_other_curve_does_not_reach_there_is_no_error_but_none() {
        let exact = Curve::new(vec![[1.0, 0.1], [2.0, 2.0], [3.0, 0.1]]);
        let low = [Curve::new(vec![[1.0, 0.1], [2.0, 1.0], [3.0, 0.1]])];
        assert_eq!(error(&exact, 1, &low, 0.5), None);
        assert_eq!(error(&exact, 1, &low, 1.0), Some(0.0));
        assert!(error(&exact, 0, &low, 0.0).is_some());
    }

    #[test]
    fn the_direction_in_which_a_curve_was_followed_does_not_matter() {
        let forward = resonance(0.0, 100);
        let mut points = forward.points().to_vec();
        points.reverse();
        assert_eq!(Curve::new(points).points(), forward.points());
    }

    #[test]
    fn a_curve_that_leaves_where_it_entered_keeps_its_side() {
        let lower = vec![[4.0, 0.01], [5.9, 0.03], [4.0, 0.1]];
        let mut turned = lower.clone();
        turned.reverse();
        assert!((0..3).all(|i| Curve::new(lower.clone()).is_low(i)));
        assert!((0..3).all(|i| Curve::new(turned.clone()).is_low(i)));
        let stiffening = Curve::new(vec![[8.0, 0.01], [6.0, 0.03], [8.0, 0.1]]);
        assert!((1..3).all(|i| !stiffening.is_low(i)));
    }
}
