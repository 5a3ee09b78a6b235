//! The quantities that keys of model files hold: name for messages, permitted dimensions, example.
//!
//! Keys of a mechanical system may belong to a translation or to a rotation, so its quantities permit both.

use super::{Dimension, Quantity};

const fn quantity(name: &'static str, example: &'static str, dimensions: &'static [Dimension]) -> Quantity {
    Quantity {
        name,
        example,
        dimensions,
    }
}

/// A ratio or another pure number.
pub const NUMBER: Quantity = quantity("a plain number", "2.0", &[Dimension::NONE]);
/// A length.
pub const LENGTH: Quantity = quantity("a length", "120 mm", &[Dimension::new(1, 0, 0, 0)]);
/// An angle.
pub const ANGLE: Quantity = quantity("an angle", "0.57 deg", &[Dimension::new(0, 0, 0, 1)]);
/// An angular frequency; cycles and revolutions are converted to radians.
pub const ANGULAR_FREQUENCY: Quantity =
    quantity("an angular frequency", "41.9 Hz", &[Dimension::new(0, 0, -1, 1)]);
/// A moment of inertia.
pub const INERTIA: Quantity = quantity(
    "an inertia",
    "2e-4 kg m^2",
    &[Dimension::new(2, 1, 0, 0), Dimension::new(2, 1, 0, -2)],
);
/// A torque.
pub const TORQUE: Quantity = quantity("a torque", "4.5 N m", &[Dimension::new(2, 1, -2, 0)]);
/// A translational stiffness.
pub const STIFFNESS: Quantity = quantity("a stiffness", "4e4 N/m", &[Dimension::new(0, 1, -2, 0)]);
/// A torsional stiffness.
pub const TORSIONAL_STIFFNESS: Quantity = quantity(
    "a torsional stiffness",
    "332 N m/rad",
    &[Dimension::new(2, 1, -2, -1)],
);

/// A displacement of a coordinate or port: length or angle.
pub const DISPLACEMENT: Quantity = quantity(
    "a length or an angle",
    "0.5 mm",
    &[Dimension::new(1, 0, 0, 0), Dimension::new(0, 0, 0, 1)],
);
/// The rate of a displacement: velocity or angular velocity.
pub const RATE: Quantity = quantity(
    "a velocity or an angular velocity",
    "0.1 rad/s",
    &[Dimension::new(1, 0, -1, 0), Dimension::new(0, 0, -1, 1)],
);
/// A generalised force: force or torque.
pub const GENERALISED_FORCE: Quantity = quantity(
    "a force or a torque",
    "4.5 N m",
    &[Dimension::new(1, 1, -2, 0), Dimension::new(2, 1, -2, 0)],
);
/// An entry of a mass matrix: mass, inertia, or their coupling.
pub const GENERALISED_MASS: Quantity = quantity(
    "a mass or an inertia",
    "2e-4 kg m^2",
    &[
        Dimension::new(0, 1, 0, 0),
        Dimension::new(1, 1, 0, 0),
        Dimension::new(2, 1, 0, 0),
        Dimension::new(2, 1, 0, -2),
    ],
);
/// An entry of a damping matrix: force or torque per velocity.
pub const GENERALISED_DAMPING: Quantity = quantity(
    "a damping coefficient",
    "0.05 N m s/rad",
    &[
        Dimension::new(0, 1, -1, 0),
        Dimension::new(1, 1, -1, 0),
        Dimension::new(1, 1, -1, -1),
        Dimension::new(2, 1, -1, -1),
    ],
);
/// An entry of a stiffness matrix: force or torque per displacement.
pub const GENERALISED_STIFFNESS: Quantity = quantity(
    "a stiffness",
    "332 N m/rad",
    &[
        Dimension::new(0, 1, -2, 0),
        Dimension::new(1, 1, -2, 0),
        Dimension::new(1, 1, -2, -1),
        Dimension::new(2, 1, -2, -1),
    ],
);
/// Force or torque per cube of the displacement.
pub const GENERALISED_CUBIC_STIFFNESS: Quantity = quantity(
    "a cubic stiffness",
    "5 N/m^3",
    &[Dimension::new(-2, 1, -2, 0), Dimension::new(2, 1, -2, -3)],
);
/// Damping per angular frequency.
pub const DAMPING_PER_FREQUENCY: Quantity = quantity(
    "a damping coefficient per angular frequency",
    "0.05 N m s^2/rad^2",
    &[
        Dimension::new(0, 1, 0, -1),
        Dimension::new(1, 1, 0, -1),
        Dimension::new(1, 1, 0, -2),
        Dimension::new(2, 1, 0, -2),
    ],
);
/// Stiffness per square of the angular frequency.
pub const STIFFNESS_PER_SQUARE_OF_FREQUENCY: Quantity = quantity(
    "a stiffness per square of the angular frequency",
    "1e-4 N m s^2/rad^3",
    &[
        Dimension::new(0, 1, 0, -2),
        Dimension::new(1, 1, 0, -2),
        Dimension::new(1, 1, 0, -3),
        Dimension::new(2, 1, 0, -3),
    ],
);

/// A mass.
pub const MASS: Quantity = quantity("a mass", "0.35 kg", &[Dimension::new(0, 1, 0, 0)]);
/// A force.
pub const FORCE: Quantity = quantity("a force", "300 N", &[Dimension::new(1, 1, -2, 0)]);
/// The axial stiffness `EA` of a belt: force per strain.
pub const AXIAL_STIFFNESS: Quantity =
    quantity("an axial stiffness EA", "170 kN", &[Dimension::new(1, 1, -2, 0)]);
/// The bending stiffness `EI` of a belt.
pub const BENDING_STIFFNESS: Quantity = quantity(
    "a bending stiffness EI",
    "0.015 N m^2",
    &[Dimension::new(3, 1, -2, 0)],
);
/// Mass per length of a belt.
pub const MASS_PER_LENGTH: Quantity =
    quantity("a mass per length", "0.1029 kg/m", &[Dimension::new(-1, 1, 0, 0)]);
/// A torque or a power: the unit decides.
pub const TORQUE_OR_POWER: Quantity = quantity(
    "a torque or a power",
    "4.5 N m",
    &[Dimension::new(2, 1, -2, 0), Dimension::new(2, 1, -3, 0)],
);
/// A power.
pub const POWER: Quantity = quantity("a power", "1.2 kW", &[Dimension::new(2, 1, -3, 0)]);
/// Translational viscous damping.
pub const DAMPING: Quantity = quantity(
    "a damping coefficient",
    "15 N s/m",
    &[Dimension::new(0, 1, -1, 0)],
);
/// Torsional viscous damping.
pub const TORSIONAL_DAMPING: Quantity = quantity(
    "a torsional damping coefficient",
    "0.05 N m s/rad",
    &[Dimension::new(2, 1, -1, -1)],
);
/// Viscous damping per length of a belt.
pub const DAMPING_PER_LENGTH: Quantity = quantity(
    "a damping coefficient per length",
    "0.5 N s/m^2",
    &[Dimension::new(-1, 1, -1, 0)],
);
/// Internal damping of bending: bending moment per rate of curvature.
pub const BENDING_DAMPING: Quantity = quantity(
    "a damping of bending",
    "1e-5 N m^2 s",
    &[Dimension::new(3, 1, -1, 0)],
);
/// A reciprocal time.
pub const PER_TIME: Quantity = quantity("a reciprocal time", "2 1/s", &[Dimension::new(0, 0, -1, 0)]);
/// A time.
pub const TIME: Quantity = quantity("a time", "1e-5 s", &[Dimension::new(0, 0, 1, 0)]);
/// A change of temperature.
pub const TEMPERATURE_CHANGE: Quantity =
    quantity("a change of temperature", "80 K", &[Dimension::temperature(1)]);
/// A coefficient of thermal expansion.
pub const THERMAL_EXPANSION: Quantity =
    quantity("a thermal expansion", "12e-6 1/K", &[Dimension::temperature(-1)]);
/// The speed of a rotation.
pub const ROTATIONAL_SPEED: Quantity =
    quantity("a rotational speed", "2000 rpm", &[Dimension::new(0, 0, -1, 1)]);
