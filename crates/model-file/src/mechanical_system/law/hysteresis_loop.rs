//! A measured loop of force over deflection.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;
use slackside_mechanics::laws;

use super::keys::{LawKeys, SharedLaw};
use crate::error::Issue;
use crate::node::Node;
use crate::reader::{Read, TableReader, read_quantities};
use crate::scalar::{collect_items, item_mut, join, split_first};
use crate::schema::QuantitySchema;
use crate::units::quantities;

/// Keys of a measured loop: two curves over the same deflections, linear between the points and constant beyond them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HysteresisLoop {
    /// Deflections of the points, in increasing order; at least two.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub displacements: Vec<f64>,
    /// Force or torque while the deflection rises, at each of them.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub loading: Vec<f64>,
    /// Force or torque while the deflection falls, at each of them; nowhere above that of loading.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub unloading: Vec<f64>,
}

impl HysteresisLoop {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &["kind", "displacements", "loading", "unloading"])?;
        let list = |key, example, quantity| {
            read_quantities(table.require(key, example)?, &table.path_of(key), quantity)
        };
        Ok(Self {
            displacements: list("displacements", "[-0.1, 0.1]", &quantities::DISPLACEMENT)?,
            loading: list("loading", "[-4.0, 6.0]", &quantities::GENERALISED_FORCE)?,
            unloading: list("unloading", "[-6.0, 4.0]", &quantities::GENERALISED_FORCE)?,
        })
    }

    fn lists(&self) -> [(&'static str, &Vec<f64>); 3] {
        [
            ("displacements", &self.displacements),
            ("loading", &self.loading),
            ("unloading", &self.unloading),
        ]
    }
}

impl LawKeys for HysteresisLoop {
    fn check(&self, path: &str) -> Read<()> {
        let item = |key: &str, index: usize| format!("{path}.{key}.{index}");
        for (key, values) in self.lists() {
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                return Err(Issue::wrong_value(item(key, index), "is not a finite number")
                    .with_number(values[index])
                    .with_help("give a finite number"));
            }
        }
        let points = self.displacements.len();
        if points < 2 {
            return Err(
                Issue::wrong_value(join(path, "displacements"), "a loop has at least two points")
                    .with_help("give the ends of the stroke"),
            );
        }
        for (key, values) in self.lists() {
            if values.len() != points {
                return Err(Issue::wrong_value(
                    join(path, key),
                    format!(
                        "{} value{} for {points} displacements",
                        values.len(),
                        if values.len() == 1 { "" } else { "s" }
                    ),
                )
                .with_help("give one value for each displacement"));
            }
        }
        if let Some(index) = self.displacements.windows(2).position(|pair| pair[0] >= pair[1]) {
            return Err(
                Issue::wrong_value(item("displacements", index + 1), "displacements must increase")
                    .with_number(self.displacements[index + 1])
                    .with_help(format!("give a value above {:?}", self.displacements[index])),
            );
        }
        if let Some(index) = (0..points).find(|&index| self.loading[index] < self.unloading[index]) {
            return Err(Issue::wrong_value(
                item("loading", index),
                format!(
                    "the loop gives energy: unloading.{index} is {:?}",
                    self.unloading[index]
                ),
            )
            .with_number(self.loading[index])
            .with_help("loading is nowhere below unloading"));
        }
        Ok(())
    }

    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        let (key, index) = split_first(path);
        let values = match key {
            "displacements" => &mut self.displacements,
            "loading" => &mut self.loading,
            "unloading" => &mut self.unloading,
            _ => return None,
        };
        item_mut(values, index)
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        for (key, values) in self.lists() {
            collect_items(values, &join(prefix, key), keys);
        }
    }

    fn law(&self, path: &str) -> Read<SharedLaw> {
        let law = laws::HysteresisLoop::new(
            self.displacements.clone(),
            self.loading.clone(),
            self.unloading.clone(),
        );
        Ok(Arc::new(
            law.map_err(|error| Issue::wrong_value(path, error.to_string()))?,
        ))
    }
}
