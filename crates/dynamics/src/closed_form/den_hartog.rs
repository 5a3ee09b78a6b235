//! Den Hartog's solution of the oscillator with dry friction (theory 05 §8.1).

use std::f64::consts::PI;

/// `m x″ + k x + F sgn x′ = P cos(Wt + φ)` without viscous damping, at the frequency ratio `r = W/√(k/m)`. Poles of `U` are at
/// `r = 1, 1/3, 1/5, …`; at `r = 1/(2m)` the solution is one member of a family (theory 05 §2.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DenHartog {
    /// Frequency ratio `r`.
    pub ratio: f64,
    /// Damping function `U = tan(π/(2r))/r`.
    pub damping: f64,
    /// Response function `V = 1/(1 − r²)`.
    pub response: f64,
    /// `S = max_{0<τ<π} [sin(τ/r) + U r (cos τ − cos(τ/r))]/(r sin τ)`, from the condition that the velocity keeps its sign.
    pub stop: f64,
}

impl DenHartog {
    /// The functions of the ratio `r > 0`.
    pub fn new(ratio: f64) -> Self {
        let damping = (PI / (2.0 * ratio)).tan() / ratio;
        Self {
            ratio,
            damping,
            response: 1.0 / (1.0 - ratio * ratio),
            stop: stop_function(ratio, damping),
        }
    }

    /// Largest `F/P` for a motion without stops, `√(V²/(U² + S²))`.
    pub fn limit(&self) -> f64 {
        (self.response * self.response / (self.damping * self.damping + self.stop * self.stop)).sqrt()
    }

    /// Amplitude `x₀/(P/k)` for a friction `F/P`; `None` if the motion has stops (or there is none).
    pub fn amplitude(&self, friction: f64) -> Option<f64> {
        let square = self.response * self.response - (friction * self.damping).powi(2);
        (friction <= self.limit() && square >= 0.0).then(|| square.sqrt())
    }

    /// Phase `φ` by which the load leads the displacement's maximum, `sin φ = −(F/P) U/V`; `None` as for the amplitude.
    pub fn phase(&self, friction: f64) -> Option<f64> {
        let amplitude = self.amplitude(friction)?;
        Some((-friction * self.damping / self.response).atan2(amplitude / self.response))
    }
}

/// Maximum over `τ` by samples and golden-section refinement around the largest; the end `τ → 0` has the limit `1/r²`.
fn stop_function(ratio: f64, damping: f64) -> f64 {
    let value = |tau: f64| {
        let fast = tau / ratio;
        (fast.sin() + damping * ratio * (tau.cos() - fast.cos())) / (ratio * tau.sin())
    };
    let count = 400 + (200.0 / ratio).min(4000.0) as usize;
    let step = PI / count as f64;
    let at = |i: usize| i as f64 * step;
    let Some(best) = (1..count).max_by(|&i, &j| value(at(i)).total_cmp(&value(at(j)))) else {
        return 1.0 / (ratio * ratio);
    };
    let (mut low, mut high) = (at(best - 1).max(1e-3 * step), at(best + 1).min(PI - 1e-3 * step));
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..80 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if value(a) > value(b) {
            high = b;
        } else {
            low = a;
        }
    }
    let inside = value(0.5 * (low + high));
    // Next to the end the quotient of two small numbers is less accurate than its limit.
    if best == 1 {
        1.0 / (ratio * ratio)
    } else {
        inside.max(1.0 / (ratio * ratio))
    }
}
