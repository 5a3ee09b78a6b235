//! Smallest and largest value of a trigonometric polynomial.

use slackside_linalg::Complex;
use std::f64::consts::{PI, TAU};

/// Samples per order of the highest harmonic.
const SAMPLES_PER_ORDER: usize = 64;

/// Smallest and largest value of a periodic function and the angles at which it takes them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// Smallest value.
    pub minimum: f64,
    /// Angle `Ωt` of the smallest value, in `[0, 2π)`.
    pub minimum_at: f64,
    /// Largest value.
    pub maximum: f64,
    /// Angle of the largest value.
    pub maximum_at: f64,
}

/// Extremes of `Re Σ g_k e^{ikθ}` from pairs of order `k ≥ 1` and amplitude: closed form for one harmonic, else 64 samples per
/// order of the highest harmonic and Newton's method on the derivative at every sampled extreme that can be the global one.
pub fn extremes(harmonics: &[(usize, Complex)]) -> Extremes {
    let mut present = harmonics.iter().filter(|(_, g)| *g != Complex::ZERO);
    match (present.next(), present.next()) {
        (None, _) => Extremes {
            minimum: 0.0,
            minimum_at: 0.0,
            maximum: 0.0,
            maximum_at: 0.0,
        },
        (Some(&(order, g)), None) => {
            let (size, argument) = g.to_polar();
            let angle = |phase: f64| ((phase - argument) / order as f64).rem_euclid(TAU / order as f64);
            Extremes {
                minimum: -size,
                minimum_at: angle(PI),
                maximum: size,
                maximum_at: angle(0.0),
            }
        }
        _ => sampled(harmonics),
    }
}

fn sampled(harmonics: &[(usize, Complex)]) -> Extremes {
    let highest = harmonics.iter().map(|(order, _)| *order).max().unwrap_or(1);
    let count = SAMPLES_PER_ORDER * highest;
    let step = TAU / count as f64;
    let values: Vec<f64> = (0..count)
        .map(|i| derivatives(harmonics, i as f64 * step)[0])
        .collect();
    // Between samples the function leaves the sampled value at an extreme by at most the largest curvature times (step/2)²/2.
    let curvature: f64 = (harmonics.iter()).map(|(k, g)| (*k * *k) as f64 * g.norm()).sum();
    let reach = 0.125 * curvature * step * step;
    let polished = |sign: f64| {
        let best = values.iter().fold(f64::INFINITY, |a, v| a.min(sign * v));
        let mut found = (f64::INFINITY, 0.0);
        for i in 0..count {
            let at = sign * values[i];
            let beside = [(i + count - 1) % count, (i + 1) % count].map(|j| sign * values[j]);
            if at <= best + reach && at <= beside[0] && at <= beside[1] {
                let angle = stationary(harmonics, i as f64 * step, step);
                let value = sign * derivatives(harmonics, angle)[0];
                if value < found.0 {
                    found = (value, angle.rem_euclid(TAU));
                }
            }
        }
        (sign * found.0, found.1)
    };
    let (minimum, minimum_at) = polished(1.0);
    let (maximum, maximum_at) = polished(-1.0);
    Extremes {
        minimum,
        minimum_at,
        maximum,
        maximum_at,
    }
}

/// The zero of the derivative within one step of a sampled extreme; the sample itself if Newton's method leaves that range.
fn stationary(harmonics: &[(usize, Complex)], start: f64, step: f64) -> f64 {
    let mut angle = start;
    for _ in 0..20 {
        let [_, slope, curvature] = derivatives(harmonics, angle);
        let change = slope / curvature;
        if !change.is_finite() || (angle - change - start).abs() > step {
            return start;
        }
        angle -= change;
        if change.abs() <= 1e-15 * step {
            break;
        }
    }
    angle
}

/// Value, first and second derivative.
fn derivatives(harmonics: &[(usize, Complex)], angle: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for &(order, g) in harmonics {
        let k = order as f64;
        let term = g * Complex::cis(k * angle);
        sums[0] += term.re;
        sums[1] -= k * term.im;
        sums[2] -= k * k * term.re;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_harmonic_takes_its_amplitude_both_ways() {
        let g = Complex::new(3.0, -4.0);
        let found = extremes(&[(2, g)]);
        assert!((found.maximum - 5.0).abs() < 1e-15 && (found.minimum + 5.0).abs() < 1e-15);
        assert!((derivatives(&[(2, g)], found.minimum_at)[0] + 5.0).abs() < 1e-14);
        assert!((derivatives(&[(2, g)], found.maximum_at)[0] - 5.0).abs() < 1e-14);
    }

    #[test]
    fn several_harmonics_are_bounded_by_a_fine_grid() {
        let harmonics = [
            (1, Complex::new(1.0, 0.3)),
            (2, Complex::new(-0.7, 0.9)),
            (5, Complex::new(0.2, -0.4)),
        ];
        let found = extremes(&harmonics);
        let grid = (0..200_000).map(|i| derivatives(&harmonics, TAU * f64::from(i) / 2e5)[0]);
        let (low, high) = grid.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
        assert!(found.minimum <= low && low - found.minimum < 1e-8);
        assert!(found.maximum >= high && found.maximum - high < 1e-8);
        assert!(derivatives(&harmonics, found.minimum_at)[1].abs() < 1e-12);
    }
}
