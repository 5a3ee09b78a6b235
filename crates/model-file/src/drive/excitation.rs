//! `[excitation]`: what shakes the driver, by orders of its speed (theory 04 §3.7).

use schemars::JsonSchema;
use serde::Serialize;

use crate::scalar::{Numbers, collect_items, item_mut, join, split_first};
use crate::schema::{QuantitySchema, RatioSchema};

/// What shakes the driver: orders of its motion, or orders of a torque on it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// Orders of the driver's prescribed rotation; amplitudes in rad.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub motion: Vec<Order>,
    /// Orders of a torque on the free driver, positive with the belt's travel; amplitudes in N m.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub torque: Vec<Order>,
}

/// One order: `amplitude · cos(order Ω t + phase)`, constant or over the driver's speed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// Multiple of the driver's speed.
    #[schemars(with = "RatioSchema")]
    pub order: f64,
    /// Speeds of the driver, rad/s, ascending; without them amplitude and phase hold at every speed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<QuantitySchema>")]
    pub speed: Vec<f64>,
    /// Amplitude, or one for each speed.
    pub amplitude: Amount,
    /// Phase in rad, or one for each speed.
    #[serde(default)]
    pub phase: Amount,
}

/// One number, or one for each speed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Amount {
    /// The same at every speed.
    Constant(#[schemars(with = "QuantitySchema")] f64),
    /// One for each speed.
    Each(#[schemars(with = "Vec<QuantitySchema>")] Vec<f64>),
}

impl Default for Amount {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

impl Amount {
    /// All numbers.
    pub(super) fn values(&self) -> &[f64] {
        match self {
            Self::Constant(value) => std::slice::from_ref(value),
            Self::Each(values) => values,
        }
    }
}

impl Excitation {
    /// Orders of motion and torque.
    pub(super) fn orders(&self) -> impl Iterator<Item = &Order> {
        self.motion.iter().chain(&self.torque)
    }

    /// The lowest order that is excited.
    pub fn lowest_order(&self) -> Option<f64> {
        self.orders().map(|order| order.order).reduce(f64::min)
    }
}

impl Numbers for Excitation {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        let (list, rest) = split_first(path);
        let orders = match list {
            "motion" => &mut self.motion,
            "torque" => &mut self.torque,
            _ => return None,
        };
        let (index, rest) = split_first(rest);
        orders.get_mut(index.parse::<usize>().ok()?)?.number_mut(rest)
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        for (list, orders) in [("motion", &self.motion), ("torque", &self.torque)] {
            for (index, order) in orders.iter().enumerate() {
                order.collect_keys(&join(prefix, &format!("{list}.{index}")), keys);
            }
        }
    }
}

impl Numbers for Order {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("order", "") => Some(&mut self.order),
            ("speed", rest) => item_mut(&mut self.speed, rest),
            ("amplitude", rest) => self.amplitude.number_mut(rest),
            ("phase", rest) => self.phase.number_mut(rest),
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        keys.push(join(prefix, "order"));
        collect_items(&self.speed, &join(prefix, "speed"), keys);
        self.amplitude.collect_keys(&join(prefix, "amplitude"), keys);
        self.phase.collect_keys(&join(prefix, "phase"), keys);
    }
}

impl Numbers for Amount {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match self {
            Self::Constant(value) => path.is_empty().then_some(value),
            Self::Each(values) => item_mut(values, path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match self {
            Self::Constant(_) => keys.push(prefix.to_owned()),
            Self::Each(values) => collect_items(values, prefix, keys),
        }
    }
}
