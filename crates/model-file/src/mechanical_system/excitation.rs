//! Constant and periodic forces.

use schemars::JsonSchema;
use serde::Serialize;

use super::{NumberMap, collect_map_keys};
use crate::scalar::{Numbers, join, split_first};
use crate::schema::{QuantityMapSchema, QuantitySchema};

/// Constant and periodic forces or torques on the coordinates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// Angular frequency `Ω` of the first order, in radians per unit of time.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub frequency: Option<f64>,
    /// Constant part by coordinate.
    #[serde(default)]
    #[schemars(with = "QuantityMapSchema")]
    pub constant: NumberMap,
    /// Periodic parts.
    #[serde(default)]
    pub harmonics: Vec<Harmonic>,
}

/// One harmonic of the excitation: `cos · cos(order Ω t) + sin · sin(order Ω t)`.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Multiple of the excitation's frequency, at least 1.
    #[schemars(range(min = 1))]
    pub order: u32,
    /// Amplitudes of the cosine by coordinate.
    #[serde(default)]
    #[schemars(with = "QuantityMapSchema")]
    pub cos: NumberMap,
    /// Amplitudes of the sine by coordinate.
    #[serde(default)]
    #[schemars(with = "QuantityMapSchema")]
    pub sin: NumberMap,
}

impl Numbers for Excitation {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("frequency", "") => self.frequency.as_mut(),
            ("constant", coordinate) => self.constant.get_mut(coordinate),
            ("harmonics", rest) => {
                let (index, rest) = split_first(rest);
                let harmonic = self.harmonics.get_mut(index.parse::<usize>().ok()?)?;
                match split_first(rest) {
                    ("cos", coordinate) => harmonic.cos.get_mut(coordinate),
                    ("sin", coordinate) => harmonic.sin.get_mut(coordinate),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        if self.frequency.is_some() {
            keys.push(join(prefix, "frequency"));
        }
        collect_map_keys(&self.constant, &join(prefix, "constant"), keys);
        for (index, harmonic) in self.harmonics.iter().enumerate() {
            collect_map_keys(&harmonic.cos, &format!("{prefix}.harmonics.{index}.cos"), keys);
            collect_map_keys(&harmonic.sin, &format!("{prefix}.harmonics.{index}.sin"), keys);
        }
    }
}
