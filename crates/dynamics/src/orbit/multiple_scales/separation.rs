//! Fourier coefficients of the separation function (theory 02 §10.2).
//!
//! Along `d = Δ cos ϑ` about a static deflection `δ_s` the element is off its linear piece where `δ_s + d < 0`, that is
//! for `|ϑ − π| < θ_0` with `cos θ_0 = γ = δ_s/Δ`. There the separation function `s` is one, elsewhere zero, and the force
//! that is missing is `N = κ (δ_s + d) s`, where `κ` is the difference of the stiffnesses of the two pieces.

use std::f64::consts::PI;

/// The separation function at one ratio `γ` of static deflection to amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separation {
    /// `γ = δ_s/Δ`, positive; at or above one there is no separation.
    pub gamma: f64,
    /// Half of the angle of separation, `θ_0 = arccos γ`, zero without separation.
    pub angle: f64,
    /// `S = sin θ_0`.
    pub sine: f64,
}

/// Coefficients of one order, relative to the amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Coefficients {
    /// `s_k`: of the separation function, `s = s_0 + Σ s_k cos kϑ`.
    pub separation: f64,
    /// `N_k / (κ Δ)`: of the missing force, `N = N_0 + Σ N_k cos kϑ`.
    pub force: f64,
    /// `e_k = (1/π) ∫ s cos kϑ cos ϑ dϑ`. It is also `∂N_k/∂Δ` over `κ` for `k ≥ 1`, and twice that for `k = 0`.
    pub projection: f64,
    /// `∂e_k/∂θ_0`.
    pub projection_rate: f64,
}

impl Separation {
    /// At the ratio `γ = δ_s/Δ` (positive; infinite for an amplitude of zero).
    pub fn new(gamma: f64) -> Self {
        if gamma >= 1.0 {
            return Self {
                gamma,
                angle: 0.0,
                sine: 0.0,
            };
        }
        // arccos loses half of the digits near γ = 1, the arctangent of the exact sine does not.
        let sine = ((1.0 - gamma) * (1.0 + gamma)).sqrt();
        Self {
            gamma,
            angle: sine.atan2(gamma),
            sine,
        }
    }

    /// Whether the element separates.
    pub fn is_separating(&self) -> bool {
        self.angle > 0.0
    }

    /// `Q = N_1/(κΔ) = (θ_0 − sin θ_0 cos θ_0)/π`, falling from 1/2 at `γ = 0` to 0 at `γ = 1`.
    pub fn first_force(&self) -> f64 {
        (self.angle - self.sine * self.gamma.min(1.0)) / PI
    }

    /// `a ∂Q/∂a = (2/π) S γ`, with `Δ` proportional to `a`.
    pub fn first_force_rate(&self) -> f64 {
        2.0 / PI * self.sine * self.gamma.min(1.0)
    }

    /// `a ∂θ_0/∂a = γ/S`; zero without separation, unbounded at its onset.
    pub fn angle_rate(&self) -> f64 {
        if self.is_separating() {
            self.gamma / self.sine
        } else {
            0.0
        }
    }

    /// The coefficients of order `k`, in closed form.
    pub fn coefficients(&self, k: usize) -> Coefficients {
        let (sine, cosine) = (k as f64 * self.angle).sin_cos();
        self.of_order(k, sine, cosine)
    }

    /// The coefficients of orders `0 … highest`, told to `visit` in turn; sines and cosines by recurrence.
    pub fn each(&self, highest: usize, mut visit: impl FnMut(usize, Coefficients)) {
        let (step_sine, step_cosine) = self.angle.sin_cos();
        let (mut sine, mut cosine) = (0.0, 1.0);
        for k in 0..=highest {
            visit(k, self.of_order(k, sine, cosine));
            (sine, cosine) = (
                sine * step_cosine + cosine * step_sine,
                cosine * step_cosine - sine * step_sine,
            );
        }
    }

    /// From `sin kθ_0` and `cos kθ_0`.
    fn of_order(&self, k: usize, sine: f64, cosine: f64) -> Coefficients {
        if !self.is_separating() {
            return Coefficients::default();
        }
        let (s, c) = (self.sine, self.gamma);
        let order = k as f64;
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let projection_rate = -2.0 / PI * sign * cosine * c;
        match k {
            0 => Coefficients {
                separation: self.angle / PI,
                force: (c * self.angle - s) / PI,
                projection: -2.0 * s / PI,
                projection_rate,
            },
            1 => Coefficients {
                separation: -2.0 * sine / PI,
                force: self.first_force(),
                projection: (self.angle + s * c) / PI,
                projection_rate,
            },
            _ => {
                // sin (k∓1)θ_0 from those of k and 1.
                let below = (sine * c - cosine * s) / (order - 1.0);
                let above = (sine * c + cosine * s) / (order + 1.0);
                Coefficients {
                    separation: 2.0 * sign * sine / (order * PI),
                    force: 2.0 * sign / PI * (order * s * cosine - c * sine)
                        / (order * (order * order - 1.0)),
                    projection: -sign / PI * (below + above),
                    projection_rate,
                }
            }
        }
    }
}
