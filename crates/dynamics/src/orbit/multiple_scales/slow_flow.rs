//! The slow flow of amplitude and phase at both orders, with derivatives (theory 02 §10.3, §10.4).
//!
//! With `W` the natural frequency at first and the load's at second order, amplitude and phase obey
//! `2W a' = R_s`, `2W a ψ' = R_c`. First order, with `σ = Ω − ω_n` and `S_1 = d_n²κQ/(2ω_n)`:
//!
//! ```text
//! R_s = F_n sin ψ − 2ζ_nω_n² a,          R_c = F_n cos ψ + 2ω_n a (σ + S_1).
//! ```
//!
//! Second order, with the first correction of the deflection `d_1 = Σ p_k cos kϑ + q cos(ϑ+ψ)`:
//!
//! ```text
//! R_s = F_s sin ψ − 2ζ_nω_nΩ a,          R_c = F_c cos ψ − ω_n² a + G + Ω² a,
//! G = d_n N_1 + d_nκ Σ p_k e_k,   F_c = F_n + d_nκ q e_1,   F_s = F_n + d_nκ q Q.
//! ```

use super::PrimaryResonance;
use super::separation::Separation;
use slackside_linalg::Complex;
use std::f64::consts::TAU;

/// The order of the expansion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Order {
    /// Leading order: one mode, one harmonic, closed form.
    First,
    /// With the first correction: all modes and harmonics, one implicit relation.
    Second,
}

/// A steady state of the slow flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyState {
    /// Frequency `Ω` of the load.
    pub frequency: f64,
    /// Modal amplitude `a > 0`.
    pub amplitude: f64,
    /// Phase `ψ` by which the motion lags behind the load.
    pub phase: f64,
}

/// The right-hand sides of the slow flow with their derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowFlow {
    /// `R_c`.
    pub cosine: f64,
    /// `R_s`.
    pub sine: f64,
    /// `∂R_c/∂a`, `∂R_c/∂ψ`, `∂R_c/∂Ω`.
    pub cosine_rates: [f64; 3],
    /// `∂R_s/∂a`, `∂R_s/∂ψ`, `∂R_s/∂Ω`.
    pub sine_rates: [f64; 3],
}

/// What the slow flow needs of an amplitude; derivatives are with respect to `a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AtAmplitude {
    /// `G`, or `d_n N_1` at first order.
    pub shift: f64,
    pub shift_rate: f64,
    /// `F_c` and `F_s`; `F_n` at first order.
    pub cosine_load: f64,
    pub cosine_load_rate: f64,
    pub sine_load: f64,
    pub sine_load_rate: f64,
}

impl PrimaryResonance {
    /// The separation function at an amplitude.
    pub fn separation(&self, amplitude: f64) -> Separation {
        Separation::new(self.form.static_deflection / (self.deflection() * amplitude))
    }

    /// Coefficients of the slow flow at an amplitude; `O(400)` at second order.
    pub(super) fn at_amplitude(&self, order: Order, amplitude: f64) -> AtAmplitude {
        let separation = self.separation(amplitude);
        let (d, load, lost) = (self.deflection(), self.load(), self.form.lost_stiffness);
        let q_ratio = separation.first_force();
        // d_n N_1 = d_n² κ a Q, and its rate d_n² κ e_1 since ∂N_1/∂Δ = κ e_1.
        let mut at = AtAmplitude {
            shift: d * d * lost * amplitude * q_ratio,
            shift_rate: d * d * lost * separation.coefficients(1).projection,
            cosine_load: load,
            cosine_load_rate: 0.0,
            sine_load: load,
            sine_load_rate: 0.0,
        };
        if order == Order::First || !separation.is_separating() {
            return at;
        }
        let angle_rate = separation.angle_rate() / amplitude;
        let (mut sum, mut sum_rate) = (0.0, 0.0);
        separation.each(self.weights.len() - 1, |k, c| {
            // p_k = w_k N_k, and its rate w_k κ d_n e_k (half for the mean).
            let p = self.weights[k] * lost * d * amplitude * c.force;
            let half = if k == 0 { 0.5 } else { 1.0 };
            let p_rate = self.weights[k] * lost * d * half * c.projection;
            sum += p * c.projection;
            sum_rate += p_rate * c.projection + p * c.projection_rate * angle_rate;
        });
        at.shift += d * lost * sum;
        at.shift_rate += d * lost * sum_rate;
        let first = separation.coefficients(1);
        let coupling = d * lost * self.direct_response;
        at.cosine_load += coupling * first.projection;
        at.cosine_load_rate = coupling * first.projection_rate * angle_rate;
        at.sine_load += coupling * q_ratio;
        at.sine_load_rate = coupling * separation.first_force_rate() / amplitude;
        at
    }

    /// The slow flow at a state, which need not be steady.
    pub fn slow_flow(&self, order: Order, state: &SteadyState) -> SlowFlow {
        let at = self.at_amplitude(order, state.amplitude);
        let (w, zeta) = (self.frequency(), self.damping_ratio());
        let (omega, a) = (state.frequency, state.amplitude);
        let (sine, cosine) = state.phase.sin_cos();
        match order {
            Order::First => SlowFlow {
                cosine: at.cosine_load * cosine + 2.0 * w * a * (omega - w) + at.shift,
                sine: at.sine_load * sine - 2.0 * zeta * w * w * a,
                cosine_rates: [
                    2.0 * w * (omega - w) + at.shift_rate,
                    -at.cosine_load * sine,
                    2.0 * w * a,
                ],
                sine_rates: [-2.0 * zeta * w * w, at.sine_load * cosine, 0.0],
            },
            Order::Second => SlowFlow {
                cosine: at.cosine_load * cosine - (w * w - omega * omega) * a + at.shift,
                sine: at.sine_load * sine - 2.0 * zeta * w * omega * a,
                cosine_rates: [
                    at.cosine_load_rate * cosine - (w * w - omega * omega) + at.shift_rate,
                    -at.cosine_load * sine,
                    2.0 * a * omega,
                ],
                sine_rates: [
                    at.sine_load_rate * sine - 2.0 * zeta * w * omega,
                    at.sine_load * cosine,
                    -2.0 * zeta * w * a,
                ],
            },
        }
    }

    /// Trace and determinant of the slow flow's Jacobian. A steady state is stable if the determinant is positive (the trace
    /// is negative); it is zero at folds.
    pub fn trace_and_determinant(&self, order: Order, state: &SteadyState) -> (f64, f64) {
        let flow = self.slow_flow(order, state);
        let scale = 2.0
            * match order {
                Order::First => self.frequency(),
                Order::Second => state.frequency,
            };
        let [sa, sp, _] = flow.sine_rates.map(|rate| rate / scale);
        let [ca, cp, _] = flow.cosine_rates.map(|rate| rate / (scale * state.amplitude));
        (sa + cp, sa * cp - sp * ca)
    }

    /// Whether a steady state is stable.
    pub fn is_stable(&self, order: Order, state: &SteadyState) -> bool {
        let (trace, determinant) = self.trace_and_determinant(order, state);
        trace < 0.0 && determinant > 0.0
    }

    /// The multipliers `e^{λ 2π/Ω}` of the slow flow's two eigenvalues `λ` over a period of the load, largest modulus first.
    pub fn multipliers(&self, order: Order, state: &SteadyState) -> [Complex; 2] {
        let (trace, determinant) = self.trace_and_determinant(order, state);
        let period = TAU / state.frequency;
        let root = Complex::new(0.25 * trace * trace - determinant, 0.0).sqrt();
        // The larger eigenvalue as a quotient, which does not cancel near a fold.
        let values = if root.im == 0.0 && trace < 0.0 {
            let smaller = Complex::new(0.5 * trace - root.re, 0.0);
            [Complex::new(determinant, 0.0) / smaller, smaller]
        } else {
            [root + 0.5 * trace, -root + 0.5 * trace]
        };
        values.map(|value| (value * period).exp())
    }
}
