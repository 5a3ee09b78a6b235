//! Load torque of an accessory, constant or tabulated over speed.

/// Load torque on a pulley, positive against the belt's travel.
#[derive(Debug, Clone, PartialEq)]
pub enum Load {
    /// Constant torque, N·m.
    Torque(f64),
    /// Constant power, W; the torque follows from the pulley's speed and is zero at rest.
    Power(f64),
    /// A table over speed.
    Table(LoadTable),
}

/// Torque or power over speed, linear in between and constant beyond its ends.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadTable {
    /// Speeds, rad/s, ascending.
    pub speed: Vec<f64>,
    /// Torques (N·m) or powers (W).
    pub value: Vec<f64>,
    /// Whether the values are powers.
    pub is_power: bool,
    /// Whether the speeds are the driver's, rather than the pulley's own.
    pub over_driver: bool,
}

/// The speeds at which a load is wanted, rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speeds {
    /// Of the driver.
    pub driver: f64,
    /// Of the pulley.
    pub pulley: f64,
}

impl Load {
    /// No load.
    pub const NONE: Self = Self::Torque(0.0);

    /// The torque, N·m.
    pub fn torque(&self, at: &Speeds) -> f64 {
        match self {
            Self::Torque(torque) => *torque,
            Self::Power(power) => torque_of_power(*power, at.pulley),
            Self::Table(table) => {
                let speed = if table.over_driver { at.driver } else { at.pulley };
                let value = interpolate(&table.speed, &table.value, speed);
                if table.is_power {
                    torque_of_power(value, at.pulley)
                } else {
                    value
                }
            }
        }
    }
}

fn torque_of_power(power: f64, speed: f64) -> f64 {
    if speed == 0.0 { 0.0 } else { power / speed }
}

/// Linear interpolation in a table with ascending abscissae, constant beyond its ends.
pub(super) fn interpolate(x: &[f64], y: &[f64], at: f64) -> f64 {
    let above = x.partition_point(|value| *value <= at);
    match (above.checked_sub(1), x.get(above)) {
        (None, _) => y.first().copied().unwrap_or_default(),
        (Some(below), None) => y.get(below).copied().unwrap_or_default(),
        (Some(below), Some(right)) => {
            let share = (at - x[below]) / (right - x[below]);
            y[below] + share * (y[above] - y[below])
        }
    }
}
