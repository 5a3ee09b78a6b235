//! The piecewise-linear spring: breakpoints and slopes.

use schemars::JsonSchema;
use serde::Serialize;
use slackside_mechanics::laws;

use super::keys::{LawKeys, SharedLaw, read_smoothing, smoothed, smoothing_field};
use crate::error::Issue;
use crate::node::Node;
use crate::reader::{Read, TableReader, read_quantities};
use crate::scalar::{collect_items, item_mut, join, split_first};
use crate::schema::QuantitySchema;
use crate::smoothing::Smoothing;
use crate::units::quantities;

/// Keys of a piecewise-linear spring.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PiecewiseLinear {
    /// Deflections at which the slope changes, in increasing order.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub breakpoints: Vec<f64>,
    /// Slopes below, between and above the breakpoints: one more than there are breakpoints.
    #[schemars(with = "Vec<QuantitySchema>")]
    pub slopes: Vec<f64>,
    /// Smooth law; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

impl PiecewiseLinear {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &["kind", "breakpoints", "slopes", "smoothing"])?;
        Ok(Self {
            breakpoints: read_quantities(
                table.require("breakpoints", "[-0.1, 0.1]")?,
                &table.path_of("breakpoints"),
                &quantities::DISPLACEMENT,
            )?,
            slopes: read_quantities(
                table.require("slopes", "[10.0, 0.0, 10.0]")?,
                &table.path_of("slopes"),
                &quantities::GENERALISED_STIFFNESS,
            )?,
            smoothing: read_smoothing(&table, &quantities::DISPLACEMENT)?,
        })
    }
}

impl LawKeys for PiecewiseLinear {
    fn check(&self, path: &str) -> Read<()> {
        let all_finite = |key: &str, values: &[f64]| match values.iter().position(|value| !value.is_finite())
        {
            Some(index) => Err(
                Issue::wrong_value(format!("{path}.{key}.{index}"), "is not a finite number")
                    .with_number(values[index])
                    .with_help("give a finite number"),
            ),
            None => Ok(()),
        };
        all_finite("breakpoints", &self.breakpoints)?;
        all_finite("slopes", &self.slopes)?;
        if self.breakpoints.is_empty() {
            return Err(
                Issue::wrong_value(join(path, "breakpoints"), "there is no breakpoint")
                    .with_value("[]")
                    .with_help("give at least one, or use a law of kind \"isolator\" for a linear spring"),
            );
        }
        if let Some(index) = self.breakpoints.windows(2).position(|pair| pair[0] >= pair[1]) {
            return Err(Issue::wrong_value(
                format!("{path}.breakpoints.{}", index + 1),
                "breakpoints must increase",
            )
            .with_number(self.breakpoints[index + 1])
            .with_help(format!("give a value above {:?}", self.breakpoints[index])));
        }
        if self.slopes.len() != self.breakpoints.len() + 1 {
            return Err(Issue::wrong_value(
                join(path, "slopes"),
                format!(
                    "{} slopes for {} breakpoints",
                    self.slopes.len(),
                    self.breakpoints.len()
                ),
            )
            .with_help("give one more slope than breakpoints: below, between and above them"));
        }
        Ok(())
    }

    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        let (key, index) = split_first(path);
        match key {
            "breakpoints" => item_mut(&mut self.breakpoints, index),
            "slopes" => item_mut(&mut self.slopes, index),
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        collect_items(&self.breakpoints, &join(prefix, "breakpoints"), keys);
        collect_items(&self.slopes, &join(prefix, "slopes"), keys);
    }

    smoothing_field!();

    fn law(&self, path: &str) -> Read<SharedLaw> {
        let exact = laws::PiecewiseLinear::new(
            laws::Variable::Displacement,
            self.breakpoints.clone(),
            self.slopes.clone(),
        )
        .map_err(|error| Issue::wrong_value(path, error.to_string()))?;
        Ok(smoothed(exact, self.smoothing.as_ref()))
    }
}
