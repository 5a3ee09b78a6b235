//! `kind = "mechanical-system"`: matrices, and elements with laws at ports,
//! `M q'' + C q' + K q + Σ b f(b·q, b·q') = F0 + Σ Re(F_k exp(i k Ω t))`.

mod check;
mod excitation;
mod law;
mod matrix;
mod output;
mod read;
mod system;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

pub use excitation::{Excitation, Harmonic};
pub use law::{
    Backlash, Coulomb, Cubic, Dahl, Decoupler, HysteresisLoop, Isolator, Law, Lugre, OneWay, OneWayDamper,
    PiecewiseLinear, SpringSlider, Stop, Valanis, WrapSpring,
};
pub use matrix::SquareMatrix;
pub use output::{Output, OutputHarmonic};

use crate::names::named_index;
use crate::scalar::{Numbers, join, split_first};
use crate::schema::RatioMapSchema;

/// Numbers by the name of a coordinate or element; names that are left out mean zero.
pub type NumberMap = BTreeMap<String, f64>;

/// A mechanical system given by its matrices and its elements.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MechanicalSystem {
    /// Short name, for titles and result files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Free text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Names of the coordinates `q`, in the order of rows and columns of the matrices.
    pub coordinates: Vec<String>,
    /// Mass matrix `M`, symmetric and positive definite.
    pub mass: SquareMatrix,
    /// Matrix `C` of damping and gyroscopic terms.
    pub damping: SquareMatrix,
    /// Stiffness matrix `K`.
    pub stiffness: SquareMatrix,
    /// Coefficient of the excitation's angular frequency `Ω` in the damping matrix.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_linear_in_frequency: Option<SquareMatrix>,
    /// Coefficient of the square of the excitation's angular frequency `Ω²` in the stiffness matrix.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_quadratic_in_frequency: Option<SquareMatrix>,
    /// Elements with laws, in parallel with the matrices.
    #[serde(rename = "element", default)]
    pub elements: Vec<Element>,
    /// Constant and periodic forces or torques.
    #[serde(default)]
    pub excitation: Excitation,
    /// Linear measures for results, beside the coordinates and the elements.
    #[serde(rename = "output", default)]
    pub outputs: Vec<Output>,
}

/// A law that acts at a port.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Element {
    /// Name, for results and for key paths.
    pub name: String,
    /// Port vector `b` by coordinate: the deflection is `u = b·q`, the force on the coordinates `-b f`.
    #[schemars(with = "RatioMapSchema")]
    pub port: NumberMap,
    /// Force or torque as a function of the deflection and its rate.
    pub law: Law,
}

impl Numbers for MechanicalSystem {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        let (key, rest) = split_first(path);
        match key {
            "mass" => self.mass.number_mut(rest),
            "damping" => self.damping.number_mut(rest),
            "stiffness" => self.stiffness.number_mut(rest),
            "damping_linear_in_frequency" => self.damping_linear_in_frequency.as_mut()?.number_mut(rest),
            "stiffness_quadratic_in_frequency" => {
                self.stiffness_quadratic_in_frequency.as_mut()?.number_mut(rest)
            }
            "element" => {
                let (item, rest) = split_first(rest);
                let index = named_index(self.elements.iter().map(|element| &*element.name), item)?;
                self.elements[index].number_mut(rest)
            }
            "excitation" => self.excitation.number_mut(rest),
            "output" => {
                let (item, rest) = split_first(rest);
                let index = named_index(self.outputs.iter().map(|output| &*output.name), item)?;
                self.outputs[index].number_mut(rest)
            }
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        self.mass.collect_keys(&join(prefix, "mass"), keys);
        self.damping.collect_keys(&join(prefix, "damping"), keys);
        self.stiffness.collect_keys(&join(prefix, "stiffness"), keys);
        if let Some(matrix) = &self.damping_linear_in_frequency {
            matrix.collect_keys(&join(prefix, "damping_linear_in_frequency"), keys);
        }
        if let Some(matrix) = &self.stiffness_quadratic_in_frequency {
            matrix.collect_keys(&join(prefix, "stiffness_quadratic_in_frequency"), keys);
        }
        for element in &self.elements {
            element.collect_keys(&join(prefix, &format!("element.{}", element.name)), keys);
        }
        self.excitation.collect_keys(&join(prefix, "excitation"), keys);
        for output in &self.outputs {
            output.collect_keys(&join(prefix, &format!("output.{}", output.name)), keys);
        }
    }
}

impl Numbers for Element {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("port", coordinate) => self.port.get_mut(coordinate),
            ("law", rest) => self.law.number_mut(rest),
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        collect_map_keys(&self.port, &join(prefix, "port"), keys);
        self.law.collect_keys(&join(prefix, "law"), keys);
    }
}

fn collect_map_keys(map: &NumberMap, prefix: &str, keys: &mut Vec<String>) {
    keys.extend(map.keys().map(|key| join(prefix, key)));
}
