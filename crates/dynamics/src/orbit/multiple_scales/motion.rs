//! The motion at a steady state: all coordinates, and from them every measure (theory 02 §10.4).

use super::slow_flow::Order;
use super::{PrimaryResonance, SteadyState};
use crate::orbit::harmonic_balance::{HarmonicBalanceError, HarmonicOrbit};
use slackside_linalg::Complex;
use slackside_mechanics::System;
use std::sync::Arc;

/// The deflection of the switching element, measured from its switching point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindupStatistics {
    /// Mean.
    pub mean: f64,
    /// Root mean square about the mean.
    pub rms: f64,
    /// Amplitude of the load's frequency.
    pub fundamental: f64,
}

/// Orders of the motion's Fourier series that are kept for measures; the coefficients fall like the fourth power.
const ORDERS: usize = 96;

impl PrimaryResonance {
    /// Mean, RMS and fundamental of the deflection at a steady state.
    pub fn windup(&self, order: Order, state: &SteadyState) -> WindupStatistics {
        let swing = self.deflection() * state.amplitude;
        let at_rest = self.form.static_deflection;
        if order == Order::First {
            return WindupStatistics {
                mean: at_rest,
                rms: swing / std::f64::consts::SQRT_2,
                fundamental: swing,
            };
        }
        let (mut mean, mut first, mut squares) = (0.0, 0.0, 0.0);
        self.separation(state.amplitude)
            .each(self.weights.len() - 1, |k, c| {
                let p = self.weights[k] * self.form.lost_stiffness * swing * c.force;
                match k {
                    0 => mean = p,
                    1 => first = p,
                    _ => squares += p * p,
                }
            });
        let (sine, cosine) = state.phase.sin_cos();
        let direct = self.direct_response;
        let fundamental = (swing + first + direct * cosine).hypot(direct * sine);
        WindupStatistics {
            mean: at_rest + mean,
            rms: (0.5 * (fundamental * fundamental + squares)).sqrt(),
            fundamental,
        }
    }

    /// The motion at a steady state, with all measures of `system`, whose modal form this resonance is of. Events and forces
    /// are those of the element's law along the motion.
    ///
    /// # Errors
    /// [`HarmonicBalanceError`] if the system is not sound.
    pub fn motion(
        &self,
        system: &Arc<System>,
        order: Order,
        state: &SteadyState,
    ) -> Result<HarmonicOrbit, HarmonicBalanceError> {
        let chi = self.form.load_phase;
        let n = self.form.rest.len();
        let mut coordinates = vec![vec![Complex::ZERO; ORDERS + 1]; n];
        let mut add = |shape: &[f64], k: usize, value: Complex| {
            for (coordinate, factor) in coordinates.iter_mut().zip(shape) {
                coordinate[k] += value * factor;
            }
        };
        add(&self.form.rest, 0, Complex::new(1.0, 0.0));
        // cos k(Ωt − χ − ψ) has the amplitude e^{−ik(χ+ψ)}.
        let turned = |k: usize, value: f64| Complex::from_polar(value, -(k as f64) * (chi + state.phase));
        let resonant = &self.form.modes[self.mode];
        add(&resonant.shape, 1, turned(1, state.amplitude));
        if order == Order::Second {
            let w = resonant.frequency;
            let swing = resonant.deflection * state.amplitude;
            self.separation(state.amplitude).each(ORDERS, |k, c| {
                let missing = self.form.lost_stiffness * swing * c.force;
                let kw = k as f64 * w;
                for (j, mode) in self.form.modes.iter().enumerate() {
                    if j == self.mode && k == 1 {
                        continue;
                    }
                    let stiffness = (mode.frequency - kw) * (mode.frequency + kw);
                    add(&mode.shape, k, turned(k, mode.deflection * missing / stiffness));
                }
            });
            let others = self
                .form
                .modes
                .iter()
                .enumerate()
                .filter(|(j, _)| *j != self.mode);
            for (_, mode) in others {
                let stiffness = (mode.frequency - w) * (mode.frequency + w);
                add(
                    &mode.shape,
                    1,
                    Complex::from_polar(1.0, -chi) * (mode.load / stiffness),
                );
            }
        }
        HarmonicOrbit::of_coordinates(system, state.frequency, coordinates)
    }
}

impl super::ModalForm {
    /// The linear response as a motion. It is exact where it does not switch.
    ///
    /// # Errors
    /// [`HarmonicBalanceError`] if the system is not sound.
    pub fn linear_motion(
        &self,
        system: &Arc<System>,
        frequency: f64,
    ) -> Result<HarmonicOrbit, HarmonicBalanceError> {
        let turn = Complex::from_polar(1.0, -self.load_phase);
        let mut coordinates: Vec<Vec<Complex>> = self
            .rest
            .iter()
            .map(|rest| {
                let mut amplitudes = vec![Complex::ZERO; ORDERS + 1];
                amplitudes[0] = Complex::new(*rest, 0.0);
                amplitudes
            })
            .collect();
        for (mode, amplitude) in self.modes.iter().zip(self.linear_response(frequency)) {
            for (coordinate, factor) in coordinates.iter_mut().zip(&mode.shape) {
                coordinate[1] += turn * amplitude * *factor;
            }
        }
        HarmonicOrbit::of_coordinates(system, frequency, coordinates)
    }
}
