//! The response curve of the first order in closed form (theory 02 (C17)).
//!
//! Along the curve the phase runs from 0 to π, and with it everything else is a function of one variable `u`:
//!
//! ```text
//! a = a_max / cosh u,    Ω = ω_n − S_1(a) + ζ_nω_n sinh u,    tan ψ = −1/sinh u.
//! ```
//!
//! Equal steps of `u` are fine at the resonance and coarse far from it. The curve has no gaps and folds pass unnoticed.

use super::{PrimaryResonance, SteadyState};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

/// A point of the first-order curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// The steady state.
    pub state: SteadyState,
    /// RMS of the deflection about its mean, `Δ/√2`.
    pub rms: f64,
    /// Whether it is stable: `ζ_n²ω_n² + x (x + aS_1') > 0` with `x = ζ_nω_n sinh u` (C18).
    pub stable: bool,
}

impl PrimaryResonance {
    /// The first-order curve in `points` (at least two) steps of `u`, written into `curve`, so that frequencies from `low` to
    /// `high` are covered; parts may lie outside. About 20 ns a point.
    pub fn first_order_curve(&self, low: f64, high: f64, points: usize, curve: &mut Vec<CurvePoint>) {
        curve.clear();
        let (w, zeta, d) = (self.frequency(), self.damping_ratio(), self.deflection());
        let largest = self.largest_amplitude();
        // S_1 = d_n² κ Q/(2 ω_n), where Q is at most 1/2.
        let softening = d * d * self.form.lost_stiffness / (2.0 * w);
        let bound = 0.5 * softening;
        let first = ((low - w + bound.min(0.0)) / (zeta * w)).asinh();
        let last = ((high - w + bound.max(0.0)) / (zeta * w)).asinh();
        // A negative load turns the phase by half a turn.
        let turn = if self.load() < 0.0 { -PI } else { 0.0 };
        let step = (last - first) / (points.max(2) - 1) as f64;
        curve.extend((0..points.max(2)).map(|i| {
            let growth = (first + step * i as f64).exp();
            let sinh = 0.5 * (growth - 1.0 / growth);
            let amplitude = 2.0 * largest / (growth + 1.0 / growth);
            let separation = self.separation(amplitude);
            let detuning = zeta * w * sinh;
            let bend = softening * separation.first_force_rate();
            CurvePoint {
                state: SteadyState {
                    frequency: w - softening * separation.first_force() + detuning,
                    amplitude,
                    phase: FRAC_PI_2 + sinh.atan() + turn,
                },
                rms: d * amplitude / SQRT_2,
                stable: (zeta * w).powi(2) + detuning * (detuning + bend) > 0.0,
            }
        }));
    }
}
