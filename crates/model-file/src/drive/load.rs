//! `pulley.load`: torque or power of an accessory, constant or over speed.

use schemars::JsonSchema;
use serde::Serialize;

use crate::scalar::{Numbers, collect_items, item_mut, join, split_first};
use crate::schema::QuantitySchema;

/// Load of an accessory, positive against the belt's travel. The unit says whether it is a torque or a power.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Load {
    /// Constant torque, N m.
    Torque(#[schemars(with = "QuantitySchema")] f64),
    /// Constant power.
    Power(Power),
    /// Torque or power over speed.
    Table(LoadTable),
}

impl Default for Load {
    fn default() -> Self {
        Self::Torque(0.0)
    }
}

/// Constant power, also written as a quantity with a unit of power.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Power {
    /// Constant power, W.
    #[schemars(with = "QuantitySchema")]
    pub power: f64,
}

/// Torque or power over speed, linear in between and constant beyond the ends.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadTable {
    /// Speeds, rad/s, ascending.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub speed: Vec<f64>,
    /// Torques at these speeds, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<Vec<QuantitySchema>>")]
    pub torque: Option<Vec<f64>>,
    /// Powers at these speeds, W.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<Vec<QuantitySchema>>")]
    pub power: Option<Vec<f64>>,
    /// Whose speeds these are.
    #[serde(default)]
    pub over: SpeedOf,
}

/// Whose speed a table is over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpeedOf {
    /// The pulley's own, as in data sheets of accessories.
    #[default]
    Pulley,
    /// The driver's.
    Driver,
}

impl Load {
    /// Whether there is a load at all.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Torque(value) | Self::Power(Power { power: value }) => *value == 0.0,
            Self::Table(table) => {
                let values = table.torque.iter().chain(&table.power).flatten();
                values.into_iter().all(|value| *value == 0.0)
            }
        }
    }
}

impl Numbers for Load {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match (self, split_first(path)) {
            (Self::Torque(torque), ("", "")) => Some(torque),
            (Self::Power(load), ("" | "power", "")) => Some(&mut load.power),
            (Self::Table(table), ("speed", rest)) => item_mut(&mut table.speed, rest),
            (Self::Table(table), ("torque", rest)) => item_mut(table.torque.as_mut()?, rest),
            (Self::Table(table), ("power", rest)) => item_mut(table.power.as_mut()?, rest),
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match self {
            Self::Torque(_) | Self::Power(_) => keys.push(prefix.to_owned()),
            Self::Table(table) => {
                collect_items(&table.speed, &join(prefix, "speed"), keys);
                for (key, values) in [("torque", &table.torque), ("power", &table.power)] {
                    if let Some(values) = values {
                        collect_items(values, &join(prefix, key), keys);
                    }
                }
            }
        }
    }
}
