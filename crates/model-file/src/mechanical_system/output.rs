//! Linear measures of the motion.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use super::{NumberMap, collect_map_keys};
use crate::scalar::{Absent, Bound, Numbers, Scalars, join, scalars, split_first};
use crate::schema::RatioMapSchema;
use crate::units::quantities;

/// A linear measure of the motion.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Name of the measure.
    pub name: String,
    /// Factors of the coordinates.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(with = "RatioMapSchema")]
    pub displacement: NumberMap,
    /// Factors of the rates of the coordinates.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(with = "RatioMapSchema")]
    pub velocity: NumberMap,
    /// Factors of the forces of the elements.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(with = "RatioMapSchema")]
    pub force: NumberMap,
    /// Constant part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub constant: Option<f64>,
    /// Prescribed periodic parts (what a prescribed rotation of the crank adds to a tension).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub harmonics: Vec<OutputHarmonic>,
}

/// One prescribed harmonic of a measure: `cos · cos(order Ω t) + sin · sin(order Ω t)`.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputHarmonic {
    /// Multiple of the excitation's frequency, at least 1.
    #[schemars(range(min = 1))]
    pub order: u32,
    /// Amplitude of the cosine.
    #[serde(default)]
    pub cos: f64,
    /// Amplitude of the sine.
    #[serde(default)]
    pub sin: f64,
}

scalars!(OutputHarmonic {
    cos: quantities::NUMBER, Bound::Any => Absent::Value(0.0);
    sin: quantities::NUMBER, Bound::Any => Absent::Value(0.0);
});

impl Numbers for Output {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("displacement", coordinate) => self.displacement.get_mut(coordinate),
            ("velocity", coordinate) => self.velocity.get_mut(coordinate),
            ("force", element) => self.force.get_mut(element),
            ("constant", "") => self.constant.as_mut(),
            ("harmonics", rest) => {
                let (index, rest) = split_first(rest);
                self.harmonics
                    .get_mut(index.parse::<usize>().ok()?)?
                    .scalar_mut(rest)
            }
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        collect_map_keys(&self.displacement, &join(prefix, "displacement"), keys);
        collect_map_keys(&self.velocity, &join(prefix, "velocity"), keys);
        collect_map_keys(&self.force, &join(prefix, "force"), keys);
        keys.extend(self.constant.map(|_| join(prefix, "constant")));
        for (index, harmonic) in self.harmonics.iter().enumerate() {
            harmonic.collect_scalar_keys(&format!("{prefix}.harmonics.{index}"), keys);
        }
    }
}
