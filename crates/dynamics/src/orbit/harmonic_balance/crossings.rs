//! All crossings of a trigonometric polynomial with given levels, with none missed.
//!
//! On an interval of length `h` the function departs from its chord by at most `B h²/8` and its rate changes by at most
//! `B h`, where `B = Σ k² |h_k|` bounds the second derivative. These two bounds decide, for each interval of a grid and
//! level, between no crossing and exactly one; undecided intervals are halved (theory 02 §3.1, §5.3).

use num_complex::Complex;
use slackside_numerics::fourier::{FourierPlanner, FourierTransform, differentiate, value, value_and_rate};
use std::f64::consts::TAU;

/// One crossing of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The angle, in `[0, 2π)` up to rounding.
    pub angle: f64,
    /// Index of the level.
    pub level: usize,
    /// Whether the function rises through the level.
    pub rising: bool,
}

/// Depth of a dip, relative to the size of the function, below which it counts as grazing and not as two crossings.
const GRAZING: f64 = 1e-15;

/// Search for crossings; it owns its space.
#[derive(Debug, Clone)]
pub struct CrossingSearch {
    transform: FourierTransform,
    values: Vec<f64>,
    rates: Vec<f64>,
    derivative: Vec<Complex<f64>>,
}

/// Value and rate at one end of an interval.
#[derive(Debug, Clone, Copy)]
struct End {
    angle: f64,
    value: f64,
    rate: f64,
}

impl CrossingSearch {
    /// A search for polynomials with `harmonics` orders, on a grid of at least eight points per shortest wave.
    pub fn new(harmonics: usize, planner: &mut FourierPlanner) -> Self {
        let length = (8 * harmonics).next_power_of_two().max(32);
        Self {
            transform: planner.transform(length),
            values: vec![0.0; length],
            rates: vec![0.0; length],
            derivative: vec![Complex::ZERO; harmonics + 1],
        }
    }

    /// Writes all crossings of `y(θ) = h_0 + Re Σ h_k e^{ikθ}` with `levels` (rising numbers) into `crossings`, by rising
    /// angle. A value equal to a level counts as below it.
    pub fn find(&mut self, harmonics: &[Complex<f64>], levels: &[f64], crossings: &mut Vec<Crossing>) {
        crossings.clear();
        let oscillation: f64 = harmonics.iter().skip(1).map(|h| h.norm()).sum();
        let mean = harmonics.first().map_or(0.0, |h| h.re);
        if levels.is_empty() || !(oscillation + mean).is_finite() {
            return;
        }
        let within = |level: f64| (mean - level).abs() <= oscillation;
        if !levels.iter().any(|&level| within(level)) {
            return;
        }
        self.derivative.resize(harmonics.len(), Complex::ZERO);
        differentiate(harmonics, 1.0, &mut self.derivative);
        self.transform.synthesize(harmonics, &mut self.values);
        self.transform.synthesize(&self.derivative, &mut self.rates);
        let n = self.values.len();
        for (index, &level) in levels.iter().enumerate().filter(|&(_, &level)| within(level)) {
            let mut interval = Intervals {
                harmonics,
                level,
                index,
                curvature: harmonics
                    .iter()
                    .enumerate()
                    .map(|(k, h)| (k * k) as f64 * h.norm())
                    .sum(),
                grazing: GRAZING * (oscillation + mean.abs() + level.abs()),
                crossings,
            };
            for i in 0..n {
                let end = |j: usize, angle: f64| End {
                    angle,
                    value: self.values[j] - level,
                    rate: self.rates[j],
                };
                let left = end(i, TAU * i as f64 / n as f64);
                let right = end((i + 1) % n, TAU * (i + 1) as f64 / n as f64);
                interval.search(left, right);
            }
        }
        crossings.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    }

    /// Largest and smallest value of the polynomial, by the zeros of its rate: `(max, min)`.
    pub fn extrema(&mut self, harmonics: &[Complex<f64>]) -> (f64, f64) {
        let mut rate = vec![Complex::ZERO; harmonics.len()];
        differentiate(harmonics, 1.0, &mut rate);
        let mut zeros = Vec::new();
        self.find(&rate, &[0.0], &mut zeros);
        let start = value(harmonics, 0.0);
        zeros.iter().fold((start, start), |(max, min), zero| {
            let y = value(harmonics, zero.angle);
            (max.max(y), min.min(y))
        })
    }
}

/// The search in the intervals of the grid for one level.
struct Intervals<'a> {
    harmonics: &'a [Complex<f64>],
    level: f64,
    index: usize,
    curvature: f64,
    grazing: f64,
    crossings: &'a mut Vec<Crossing>,
}

impl Intervals<'_> {
    fn at(&self, angle: f64) -> End {
        let (value, rate) = value_and_rate(self.harmonics, angle);
        End {
            angle,
            value: value - self.level,
            rate,
        }
    }

    fn search(&mut self, left: End, right: End) {
        let length = right.angle - left.angle;
        let departure = self.curvature * length * length / 8.0;
        let monotone = left.rate.abs() > self.curvature * length;
        let (above, above_after) = (left.value > 0.0, right.value > 0.0);
        if above == above_after {
            let nearest = left.value.abs().min(right.value.abs());
            if monotone || nearest > departure || departure <= self.grazing {
                return;
            }
        } else if monotone || departure <= self.grazing {
            let angle = self.zero(left, right);
            self.crossings.push(Crossing {
                angle,
                level: self.index,
                rising: above_after,
            });
            return;
        }
        let middle = self.at(0.5 * (left.angle + right.angle));
        self.search(left, middle);
        self.search(middle, right);
    }

    /// The zero between ends of different sign, by Newton's method kept inside the bracket.
    fn zero(&self, left: End, right: End) -> f64 {
        let (mut low, mut high) = (left.angle, right.angle);
        let above_at_high = right.value > 0.0;
        // The secant of the ends is a better start than either.
        let mut angle = low - left.value * (high - low) / (right.value - left.value);
        for _ in 0..60 {
            if !(angle > low && angle < high) {
                angle = 0.5 * (low + high);
            }
            let at = self.at(angle);
            if (at.value > 0.0) == above_at_high {
                high = angle;
            } else {
                low = angle;
            }
            let step = at.value / at.rate;
            if step.abs() <= 2.0 * f64::EPSILON || high - low <= 4.0 * f64::EPSILON {
                return if step.is_finite() && step.abs() <= high - low {
                    angle - step
                } else {
                    angle
                };
            }
            angle -= step;
        }
        angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(harmonics: &[Complex<f64>], levels: &[f64]) -> Vec<Crossing> {
        let mut search = CrossingSearch::new(harmonics.len() - 1, &mut FourierPlanner::default());
        let mut crossings = Vec::new();
        search.find(harmonics, levels, &mut crossings);
        crossings
    }

    #[test]
    fn crossings_of_a_cosine_are_known() {
        let found = find(
            &[Complex::new(0.5, 0.0), Complex::new(1.0, 0.0)],
            &[0.0, 1.0, 2.0],
        );
        // 1/2 + cos θ meets 0 at 2π/3 and 4π/3, and 1 at ±π/3.
        let expected = [
            (TAU / 6.0, 1, false),
            (TAU / 3.0, 0, false),
            (2.0 * TAU / 3.0, 0, true),
            (5.0 * TAU / 6.0, 1, true),
        ];
        assert_eq!(found.len(), 4);
        for (c, (angle, level, rising)) in found.iter().zip(expected) {
            assert!((c.angle - angle).abs() < 1e-15 * 8.0);
            assert_eq!((c.level, c.rising), (level, rising));
        }
    }

    #[test]
    fn a_dip_far_below_the_grid_is_found_and_a_near_miss_is_not() {
        // 1 + depth-shifted cosine whose minimum lies off the grid.
        let turn = Complex::cis(-(3.0 + 0.017));
        for depth in [1e-4, 1e-8, 1e-12] {
            let through = find(&[Complex::new(1.0 - depth, 0.0), -turn], &[0.0]);
            assert_eq!(through.len(), 2, "depth {depth}");
            let width = through[1].angle - through[0].angle;
            let expected = 2.0 * (1.0 - depth).acos();
            // cos is evaluated to 1e-16, so the width is known to 1e-16 / depth.
            assert!((width / expected - 1.0).abs() < 1e-15 / depth);
            assert!(find(&[Complex::new(1.0 + depth, 0.0), -turn], &[0.0]).is_empty());
        }
    }

    #[test]
    fn many_waves_give_as_many_crossings_as_they_must() {
        let mut h = vec![Complex::ZERO; 41];
        h[40] = Complex::new(0.6, 0.8);
        h[1] = Complex::new(0.01, 0.0);
        let found = find(&h, &[0.0]);
        assert_eq!(found.len(), 80);
        assert!(found.windows(2).all(|pair| pair[0].rising != pair[1].rising));
        assert!(found.iter().all(|c| value(&h, c.angle).abs() < 1e-13));
    }

    #[test]
    fn a_constant_on_the_level_does_not_cross_it() {
        assert!(find(&[Complex::ZERO, Complex::ZERO], &[0.0]).is_empty());
    }

    #[test]
    fn extrema_come_from_the_zeros_of_the_rate() {
        let h = [Complex::new(0.2, 0.0), Complex::new(3.0, -4.0)];
        let mut search = CrossingSearch::new(1, &mut FourierPlanner::default());
        let (max, min) = search.extrema(&h);
        assert!((max - 5.2).abs() < 1e-14 && (min + 4.8).abs() < 1e-14);
        assert_eq!(
            search.extrema(&[Complex::new(0.7, 0.0), Complex::ZERO]),
            (0.7, 0.7)
        );
    }
}
