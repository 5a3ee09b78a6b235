//! In which units results are given to the user.

use std::f64::consts::TAU;

/// Labels of the units of results, and the conversion of frequencies. Methods compute with radians per unit of time;
/// users give and read frequencies in the unit named here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Unit of frequencies.
    pub frequency: &'static str,
    /// Unit of rotations, or of the coordinates in general.
    pub angle: &'static str,
    /// Unit of torques, or of the generalised forces.
    pub torque: &'static str,
    /// Unit of time.
    pub time: &'static str,
    /// Radians per unit of time in one unit of frequency.
    pub radians_per_frequency: f64,
}

impl Units {
    /// Dimensionless parameters: time in units of `1/omega_0`, torque in units of `J_p omega_0²` (theory 02 §1.3).
    pub const DIMENSIONLESS: Self = Self {
        frequency: "–",
        angle: "rad",
        torque: "–",
        time: "–",
        radians_per_frequency: 1.0,
    };

    /// Physical parameters: hertz, newton metres, seconds.
    pub const PHYSICAL: Self = Self {
        frequency: "Hz",
        angle: "rad",
        torque: "N m",
        time: "s",
        radians_per_frequency: TAU,
    };

    /// A system of matrices in any consistent units.
    pub const UNSPECIFIED: Self = Self {
        frequency: "rad per unit of time",
        angle: "–",
        torque: "–",
        time: "unit of time",
        radians_per_frequency: 1.0,
    };

    /// Angular frequency in radians per unit of time, from the user's unit.
    pub fn angular_frequency(&self, frequency: f64) -> f64 {
        frequency * self.radians_per_frequency
    }

    /// Frequency in the user's unit, from radians per unit of time.
    pub fn user_frequency(&self, angular_frequency: f64) -> f64 {
        angular_frequency / self.radians_per_frequency
    }
}
