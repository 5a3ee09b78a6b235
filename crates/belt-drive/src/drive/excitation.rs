//! Excitation of the driver by engine orders (theory 04 §3.7).

use super::load::interpolate;
use std::f64::consts::PI;

/// What shakes the driver.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Excitation {
    /// Nothing.
    #[default]
    None,
    /// Prescribed rotation, `θ_d = Σ A_o cos(o Ω t + φ_o)`; amplitudes in rad.
    Motion(Vec<OrderAmplitude>),
    /// Torque on a driver with its own inertia, positive with the belt's travel; amplitudes in N·m.
    Torque(Vec<OrderAmplitude>),
}

impl Excitation {
    /// The orders, whatever they excite.
    pub fn orders(&self) -> &[OrderAmplitude] {
        match self {
            Self::None => &[],
            Self::Motion(orders) | Self::Torque(orders) => orders,
        }
    }
}

/// One order of the excitation.
#[derive(Debug, Clone, PartialEq)]
pub struct OrderAmplitude {
    /// Multiple of the driver's speed.
    pub order: f64,
    /// Amplitude and phase over speed.
    pub table: OrderTable,
}

/// Amplitude and phase of an order.
#[derive(Debug, Clone, PartialEq)]
pub enum OrderTable {
    /// The same at every speed.
    Constant {
        /// Amplitude, rad or N·m.
        amplitude: f64,
        /// Phase `φ_o`, rad.
        phase: f64,
    },
    /// Over the driver's speed, linear in between and constant beyond its ends.
    OverSpeed {
        /// Driver speeds, rad/s, ascending.
        speed: Vec<f64>,
        /// Amplitudes, rad or N·m.
        amplitude: Vec<f64>,
        /// Phases, rad.
        phase: Vec<f64>,
    },
}

impl OrderAmplitude {
    /// Amplitude and phase (rad) at a driver speed (rad/s). Phases are interpolated along the shorter way round.
    pub fn at(&self, driver_speed: f64) -> (f64, f64) {
        match &self.table {
            OrderTable::Constant { amplitude, phase } => (*amplitude, *phase),
            OrderTable::OverSpeed {
                speed,
                amplitude,
                phase,
            } => {
                let mut unwrapped = phase.clone();
                for i in 1..unwrapped.len() {
                    let jump = unwrapped[i] - unwrapped[i - 1];
                    unwrapped[i] -= (jump / (2.0 * PI)).round() * 2.0 * PI;
                }
                (
                    interpolate(speed, amplitude, driver_speed),
                    interpolate(speed, &unwrapped, driver_speed),
                )
            }
        }
    }
}
