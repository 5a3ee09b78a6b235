//! `smoothing = { kind, width }`: a smooth law in place of an exact piecewise one (theory 02 §4).

use schemars::JsonSchema;
use serde::Serialize;

use crate::node::Node;
use crate::reader::{Read, TableReader, read_choice};
use crate::scalar::{Bound, Scalars, scalars};
use crate::schema::QuantitySchema;
use crate::units::{Quantity, quantities};

/// A smooth law that stands for an exact piecewise-linear one. Without it the law is exact.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Smoothing {
    /// Shape of the transition.
    pub kind: SmoothingKind,
    /// Width of the transition, in the unit of the deflection; towards zero the law becomes exact.
    #[schemars(with = "QuantitySchema")]
    pub width: f64,
}

/// Shape of a smooth transition, with `u` the deflection divided by the width.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SmoothingKind {
    /// `(1 + tanh u)/2` in place of the step; second-order error.
    Tanh,
    /// `1/2 + atan(u)/pi` in place of the step; only first-order accurate.
    Arctan,
    /// `ln(2 cosh u)` in place of the absolute value; second-order error.
    Cosh,
    /// Quadratic between -width and width, once differentiable; second-order error.
    Quadratic,
    /// Quartic between -width and width, twice differentiable; second-order error.
    Quartic,
}

/// The words of the file for the shapes.
const KINDS: &[(&str, SmoothingKind)] = &[
    ("tanh", SmoothingKind::Tanh),
    ("arctan", SmoothingKind::Arctan),
    ("cosh", SmoothingKind::Cosh),
    ("quadratic", SmoothingKind::Quadratic),
    ("quartic", SmoothingKind::Quartic),
];

scalars!(Smoothing {
    width: quantities::DISPLACEMENT, Bound::Positive;
});

impl From<SmoothingKind> for slackside_mechanics::laws::Smoothing {
    fn from(kind: SmoothingKind) -> Self {
        match kind {
            SmoothingKind::Tanh => Self::Tanh,
            SmoothingKind::Arctan => Self::Arctan,
            SmoothingKind::Cosh => Self::Cosh,
            SmoothingKind::Quadratic => Self::Quadratic,
            SmoothingKind::Quartic => Self::Quartic,
        }
    }
}

impl Smoothing {
    /// Reads the table; `width` says what the width measures.
    pub(crate) fn read(node: &Node, path: &str, width: &Quantity) -> Read<Self> {
        let table = TableReader::open(node, path, &["kind", "width"])?;
        let kind = table.require("kind", "\"tanh\"")?;
        Ok(Self {
            kind: read_choice(kind, &table.path_of("kind"), "kind of smoothing", KINDS)?,
            width: table.quantity("width", width)?,
        })
    }

    pub(crate) fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)
    }

    /// The caution that belongs to the shape, if there is one.
    pub(crate) fn caution(&self) -> Option<&'static str> {
        (self.kind == SmoothingKind::Arctan).then_some(
            "arctan smoothing is only first-order accurate: it leaves a constant torque on both sides; tanh or cosh \
             of the same width is closer to the exact law",
        )
    }
}
