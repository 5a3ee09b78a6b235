//! The units that model files may use, with their size in SI.

use std::f64::consts::PI;

use super::Dimension;

/// A named unit: one `name` is `factor` times the SI unit of its dimension.
pub(super) struct Unit {
    pub name: &'static str,
    pub factor: f64,
    pub dimension: Dimension,
}

const fn unit(name: &'static str, factor: f64, dimension: Dimension) -> Unit {
    Unit {
        name,
        factor,
        dimension,
    }
}

const LENGTH: Dimension = Dimension::new(1, 0, 0, 0);
const MASS: Dimension = Dimension::new(0, 1, 0, 0);
const TIME: Dimension = Dimension::new(0, 0, 1, 0);
const ANGLE: Dimension = Dimension::new(0, 0, 0, 1);
const ANGULAR_FREQUENCY: Dimension = Dimension::new(0, 0, -1, 1);
const FORCE: Dimension = Dimension::new(1, 1, -2, 0);
const TORQUE: Dimension = Dimension::new(2, 1, -2, 0);
const POWER: Dimension = Dimension::new(2, 1, -3, 0);
const PRESSURE: Dimension = Dimension::new(-1, 1, -2, 0);

/// Standard gravity times the international pound, exact by definition.
const POUND_FORCE: f64 = 4.448_221_615_260_5;

/// All units, by name. Names are case-sensitive, as in SI.
pub(super) const UNITS: &[Unit] = &[
    unit("m", 1.0, LENGTH),
    unit("km", 1e3, LENGTH),
    unit("cm", 1e-2, LENGTH),
    unit("mm", 1e-3, LENGTH),
    unit("um", 1e-6, LENGTH),
    unit("µm", 1e-6, LENGTH),
    unit("in", 0.0254, LENGTH),
    unit("ft", 0.3048, LENGTH),
    unit("kg", 1.0, MASS),
    unit("g", 1e-3, MASS),
    unit("mg", 1e-6, MASS),
    unit("t", 1e3, MASS),
    unit("lb", 0.453_592_37, MASS),
    unit("s", 1.0, TIME),
    unit("ms", 1e-3, TIME),
    unit("us", 1e-6, TIME),
    unit("µs", 1e-6, TIME),
    unit("min", 60.0, TIME),
    unit("h", 3600.0, TIME),
    unit("rad", 1.0, ANGLE),
    unit("mrad", 1e-3, ANGLE),
    unit("deg", PI / 180.0, ANGLE),
    unit("°", PI / 180.0, ANGLE),
    unit("rev", 2.0 * PI, ANGLE),
    unit("Hz", 2.0 * PI, ANGULAR_FREQUENCY),
    unit("kHz", 2e3 * PI, ANGULAR_FREQUENCY),
    unit("rpm", PI / 30.0, ANGULAR_FREQUENCY),
    unit("N", 1.0, FORCE),
    unit("kN", 1e3, FORCE),
    unit("mN", 1e-3, FORCE),
    unit("lbf", POUND_FORCE, FORCE),
    unit("Nm", 1.0, TORQUE),
    unit("kNm", 1e3, TORQUE),
    unit("Nmm", 1e-3, TORQUE),
    unit("J", 1.0, TORQUE),
    unit("W", 1.0, POWER),
    unit("kW", 1e3, POWER),
    unit("Pa", 1.0, PRESSURE),
    unit("kPa", 1e3, PRESSURE),
    unit("MPa", 1e6, PRESSURE),
    unit("GPa", 1e9, PRESSURE),
    unit("K", 1.0, Dimension::temperature(1)),
    unit("%", 0.01, Dimension::NONE),
];

/// The unit of this name.
pub(super) fn find(name: &str) -> Option<&'static Unit> {
    UNITS.iter().find(|unit| unit.name == name)
}
