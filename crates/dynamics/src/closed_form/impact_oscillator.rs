//! The oscillator with a rigid stop: one impact per `n` periods of the load in closed form (theory 05 §8.2).

use super::ClosedFormError;
use slackside_linalg::{Complex, Lu, Matrix, exponential};
use std::f64::consts::{PI, TAU};

/// `x″ + 2ζx′ + x = cos(rt + φ)` with `x ≤ gap` and `v₊ = −e v₋`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactOscillator {
    /// Frequency ratio `r`.
    pub ratio: f64,
    /// Damping ratio `ζ`.
    pub damping_ratio: f64,
    /// Coefficient of restitution `e`.
    pub restitution: f64,
    /// Position of the stop.
    pub gap: f64,
}

/// A motion with one impact per `n` periods of the load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactMotion {
    /// Velocity at which the stop is hit, positive.
    pub impact_speed: f64,
    /// Phase `φ` of the load at the impact, in `[0, 2π)`.
    pub phase: f64,
    /// Whether the position stays below the stop between the impacts.
    pub admissible: bool,
    /// Determinant `e² e^{−2ζnT}` of the map over `n` periods.
    pub determinant: f64,
}

impl ImpactOscillator {
    /// The motions with one impact per `periods` periods, by falling impact speed: the positive roots of
    /// `(gap − p v)² + ((s + e) v/r)² = |X|²` with `[p, s] = (e^{AnT} − 1)⁻¹ [0, 1 + e]`.
    ///
    /// # Errors
    /// [`ClosedFormError::Linalg`] if `n` periods of the load are whole periods of the undamped oscillator.
    pub fn motions(&self, periods: usize) -> Result<Vec<ImpactMotion>, ClosedFormError> {
        let (r, zeta, e) = (self.ratio, self.damping_ratio, self.restitution);
        let duration = periods as f64 * TAU / r;
        let mut map = exponential(&self.matrix().scaled(duration))?;
        for i in 0..2 {
            map[(i, i)] -= 1.0;
        }
        let free = Lu::new(&map)?.solve(&[0.0, 1.0 + e]);
        let (p, s) = (free[0], (free[1] + e) / r);
        let (amplitude, lag) = Complex::new(1.0 - r * r, 2.0 * zeta * r).inv().to_polar();
        // (p² + s²) v² − 2 gap p v + gap² − |X|² = 0
        let (a, b, c) = (
            p * p + s * s,
            self.gap * p,
            self.gap * self.gap - amplitude * amplitude,
        );
        let discriminant = b * b - a * c;
        if discriminant < 0.0 {
            return Ok(Vec::new());
        }
        let mut motions = Vec::new();
        for speed in [(b + discriminant.sqrt()) / a, (b - discriminant.sqrt()) / a] {
            if speed > 0.0 {
                // Of the forced part at the impact, φ + arg X.
                let phase = (s * speed).atan2(self.gap - p * speed);
                let after = [p * speed, free[1] * speed];
                motions.push(ImpactMotion {
                    impact_speed: speed,
                    phase: (phase - lag).rem_euclid(TAU),
                    admissible: self.stays_below(phase, amplitude, after, duration)?,
                    determinant: e * e * (-2.0 * zeta * duration).exp(),
                });
            }
        }
        Ok(motions)
    }

    fn matrix(&self) -> Matrix {
        let mut matrix = Matrix::zeros(2, 2);
        matrix[(0, 1)] = 1.0;
        matrix[(1, 0)] = -1.0;
        matrix[(1, 1)] = -2.0 * self.damping_ratio;
        matrix
    }

    /// Whether `x(t) < gap` on `0 < t < duration`, for a free part that starts from `free`: the maxima between the zeros of the
    /// velocity on a fine grid are compared with the stop.
    fn stays_below(
        &self,
        phase: f64,
        amplitude: f64,
        free: [f64; 2],
        duration: f64,
    ) -> Result<bool, ClosedFormError> {
        let fastest = self.ratio.max(1.0);
        let count = (256.0 * duration * fastest / PI).ceil() as usize;
        let step = duration / count as f64;
        let map = exponential(&self.matrix().scaled(step))?;
        let mut state = free.to_vec();
        let mut before = f64::NEG_INFINITY;
        for i in 1..count {
            state = map.times(&state);
            let angle = self.ratio * step * i as f64 + phase;
            let x = amplitude * angle.cos() + state[0];
            let v = -amplitude * self.ratio * angle.sin() + state[1];
            // The largest position between two samples is reached by at most half a step's motion.
            let peak = if before > 0.0 && v <= 0.0 {
                x + 0.5 * step * before.max(-v)
            } else {
                x
            };
            if peak >= self.gap {
                return Ok(false);
            }
            before = v;
        }
        Ok(true)
    }
}
