//! Exponents of the base dimensions of a quantity.

/// Exponents of length, mass, time, angle and temperature, for example torque: 2, 1, -2, 0, 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dimension {
    /// Exponent of the metre.
    pub length: i32,
    /// Exponent of the kilogram.
    pub mass: i32,
    /// Exponent of the second.
    pub time: i32,
    /// Exponent of the radian.
    pub angle: i32,
    /// Exponent of the kelvin.
    pub temperature: i32,
}

impl Dimension {
    /// A pure number.
    pub const NONE: Self = Self::new(0, 0, 0, 0);

    /// Dimension without temperature from its exponents of length, mass, time and angle.
    pub const fn new(length: i32, mass: i32, time: i32, angle: i32) -> Self {
        Self {
            length,
            mass,
            time,
            angle,
            temperature: 0,
        }
    }

    /// A power of temperature.
    pub const fn temperature(exponent: i32) -> Self {
        Self {
            temperature: exponent,
            ..Self::NONE
        }
    }

    /// Dimension of `a·bᵖ`, where `a` is a quantity of this dimension and `b` one of dimension `other`.
    /// Saturates, so that absurdly long products stay harmless.
    pub fn times_power(self, other: Self, power: i32) -> Self {
        let combine = |own: i32, other: i32| own.saturating_add(other.saturating_mul(power));
        Self {
            length: combine(self.length, other.length),
            mass: combine(self.mass, other.mass),
            time: combine(self.time, other.time),
            angle: combine(self.angle, other.angle),
            temperature: combine(self.temperature, other.temperature),
        }
    }
}
