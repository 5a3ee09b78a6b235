//! The laws that an element of a mechanical system may have.

use schemars::JsonSchema;
use serde::Serialize;

use super::piecewise_linear::PiecewiseLinear;
use crate::error::{Issue, Problem};
use crate::nearest::enumerate;
use crate::node::Node;
use crate::reader::{Read, TableReader, read_text, table_entries, unknown_choice};
use crate::scalar::{Bound, Numbers, Scalars, join, scalars, split_first};
use crate::schema::QuantitySchema;
use crate::smoothing::Smoothing;
use crate::units::{Quantity, quantities};

/// A law: the force or torque of an element as a function of its deflection `u = b·q` and its rate `v`.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Law {
    /// Wrap-spring clutch: `stiffness · u` for positive deflection, otherwise zero (theory 02 §1.1).
    WrapSpring(WrapSpring),
    /// Spring with free play: zero between -clearance and clearance, slope `stiffness` outside.
    Backlash(Backlash),
    /// Compliant one-sided stop: `stiffness · (u - gap)` where the deflection exceeds the gap, otherwise zero.
    Stop(Stop),
    /// Continuous piecewise-linear spring with zero force at zero deflection.
    PiecewiseLinear(PiecewiseLinear),
    /// Damper that acts in one direction: `damping · v` for positive rate, otherwise zero.
    OneWayDamper(OneWayDamper),
    /// Linear spring and damper: `stiffness · u + damping · v`.
    Isolator(Isolator),
    /// Cubic spring: `linear · u + cubic · u³`.
    Cubic(Cubic),
}

/// Keys of a wrap-spring clutch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WrapSpring {
    /// Stiffness of the engaged spring.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Smooth law; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(WrapSpring {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
});

/// Keys of a spring with free play.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Backlash {
    /// Stiffness in contact.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Half of the gap: free play from -clearance to clearance.
    #[schemars(with = "QuantitySchema")]
    pub clearance: f64,
    /// Smooth law; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(Backlash {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
    clearance: quantities::DISPLACEMENT, Bound::Positive;
});

/// Keys of a compliant one-sided stop.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Deflection at which contact begins.
    #[schemars(with = "QuantitySchema")]
    pub gap: f64,
    /// Stiffness in contact.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Smooth law; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(Stop {
    gap: quantities::DISPLACEMENT, Bound::NotNegative;
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
});

/// Keys of a damper that acts in one direction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OneWayDamper {
    /// Damping coefficient for positive rate.
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
    /// Smooth law, whose width is a rate; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(OneWayDamper {
    damping: quantities::GENERALISED_DAMPING, Bound::Positive;
});

/// Keys of a linear spring and damper.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Isolator {
    /// Stiffness.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Damping coefficient.
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
}

scalars!(Isolator {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::NotNegative;
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative;
});

/// Keys of a cubic spring.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cubic {
    /// Coefficient of the deflection.
    #[schemars(with = "QuantitySchema")]
    pub linear: f64,
    /// Coefficient of the cube of the deflection.
    #[schemars(with = "QuantitySchema")]
    pub cubic: f64,
}

scalars!(Cubic {
    linear: quantities::GENERALISED_STIFFNESS, Bound::Any;
    cubic: quantities::GENERALISED_CUBIC_STIFFNESS, Bound::Any;
});

/// Kinds of law in this version.
const KINDS: [&str; 7] = [
    "wrap-spring",
    "backlash",
    "stop",
    "piecewise-linear",
    "one-way-damper",
    "isolator",
    "cubic",
];

/// Kinds of law that are described in the documentation but not part of this version.
const LATER_KINDS: [&str; 6] = [
    "one-way",
    "coulomb",
    "decoupler",
    "spring-slider",
    "dahl",
    "lugre",
];

impl Law {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        table_entries(node, path)?;
        let kind_path = join(path, "kind");
        let Some(kind_node) = node.child("kind") else {
            return Err(
                Issue::new(Problem::MissingKey, kind_path, "the kind of the law is missing")
                    .at(&node.origin)
                    .with_help(format!("add `kind = …`; known are {}", enumerate(KINDS))),
            );
        };
        match read_text(kind_node, &kind_path)? {
            "wrap-spring" => {
                let (mut law, smoothing) =
                    read_smoothable::<WrapSpring>(node, path, &quantities::DISPLACEMENT)?;
                law.smoothing = smoothing;
                Ok(Self::WrapSpring(law))
            }
            "backlash" => {
                let (mut law, smoothing) =
                    read_smoothable::<Backlash>(node, path, &quantities::DISPLACEMENT)?;
                law.smoothing = smoothing;
                Ok(Self::Backlash(law))
            }
            "stop" => {
                refuse_impact(node, path)?;
                let (mut law, smoothing) = read_smoothable::<Stop>(node, path, &quantities::DISPLACEMENT)?;
                law.smoothing = smoothing;
                Ok(Self::Stop(law))
            }
            "piecewise-linear" => PiecewiseLinear::read(node, path).map(Self::PiecewiseLinear),
            "one-way-damper" => {
                let (mut law, smoothing) = read_smoothable::<OneWayDamper>(node, path, &quantities::RATE)?;
                law.smoothing = smoothing;
                Ok(Self::OneWayDamper(law))
            }
            "isolator" => read_plain(node, path).map(Self::Isolator),
            "cubic" => read_plain(node, path).map(Self::Cubic),
            later if LATER_KINDS.contains(&later) => Err(not_available(
                kind_node,
                &kind_path,
                format!("this version has no \"{later}\" law"),
            )),
            unknown => Err(unknown_choice(
                kind_node,
                &kind_path,
                "kind of law",
                unknown,
                KINDS.into_iter(),
            )),
        }
    }

    pub(super) fn check(&self, path: &str) -> Read<()> {
        match self {
            Self::WrapSpring(law) => law.check_scalars(path)?,
            Self::Backlash(law) => law.check_scalars(path)?,
            Self::Stop(law) => law.check_scalars(path)?,
            Self::PiecewiseLinear(law) => law.check(path)?,
            Self::OneWayDamper(law) => law.check_scalars(path)?,
            Self::Isolator(law) => law.check_scalars(path)?,
            Self::Cubic(law) => law.check_scalars(path)?,
        }
        match self.smoothing() {
            Some(smoothing) => smoothing.check(&join(path, "smoothing")),
            None => Ok(()),
        }
    }

    /// The smoothing, if the law has one.
    pub fn smoothing(&self) -> Option<&Smoothing> {
        match self {
            Self::WrapSpring(law) => law.smoothing.as_ref(),
            Self::Backlash(law) => law.smoothing.as_ref(),
            Self::Stop(law) => law.smoothing.as_ref(),
            Self::PiecewiseLinear(law) => law.smoothing.as_ref(),
            Self::OneWayDamper(law) => law.smoothing.as_ref(),
            Self::Isolator(_) | Self::Cubic(_) => None,
        }
    }

    fn smoothing_mut(&mut self) -> Option<&mut Smoothing> {
        match self {
            Self::WrapSpring(law) => law.smoothing.as_mut(),
            Self::Backlash(law) => law.smoothing.as_mut(),
            Self::Stop(law) => law.smoothing.as_mut(),
            Self::PiecewiseLinear(law) => law.smoothing.as_mut(),
            Self::OneWayDamper(law) => law.smoothing.as_mut(),
            Self::Isolator(_) | Self::Cubic(_) => None,
        }
    }
}

impl Numbers for Law {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        if let ("smoothing", rest) = split_first(path) {
            return self.smoothing_mut()?.scalar_mut(rest);
        }
        match self {
            Self::WrapSpring(law) => law.scalar_mut(path),
            Self::Backlash(law) => law.scalar_mut(path),
            Self::Stop(law) => law.scalar_mut(path),
            Self::PiecewiseLinear(law) => law.number_mut(path),
            Self::OneWayDamper(law) => law.scalar_mut(path),
            Self::Isolator(law) => law.scalar_mut(path),
            Self::Cubic(law) => law.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match self {
            Self::WrapSpring(law) => law.collect_scalar_keys(prefix, keys),
            Self::Backlash(law) => law.collect_scalar_keys(prefix, keys),
            Self::Stop(law) => law.collect_scalar_keys(prefix, keys),
            Self::PiecewiseLinear(law) => law.collect_keys(prefix, keys),
            Self::OneWayDamper(law) => law.collect_scalar_keys(prefix, keys),
            Self::Isolator(law) => law.collect_scalar_keys(prefix, keys),
            Self::Cubic(law) => law.collect_scalar_keys(prefix, keys),
        }
        if let Some(smoothing) = self.smoothing() {
            smoothing.collect_scalar_keys(&join(prefix, "smoothing"), keys);
        }
    }
}

/// A law whose keys are named numbers.
fn read_plain<T: Scalars + Default>(node: &Node, path: &str) -> Read<T> {
    TableReader::open(node, path, &known_keys::<T>(&[]))?.scalars()
}

/// A law whose keys are named numbers, and which may be smoothed.
fn read_smoothable<T: Scalars + Default>(
    node: &Node,
    path: &str,
    width: &Quantity,
) -> Read<(T, Option<Smoothing>)> {
    let table = TableReader::open(node, path, &known_keys::<T>(&["smoothing"]))?;
    Ok((table.scalars()?, read_smoothing(&table, width)?))
}

pub(super) fn read_smoothing(table: &TableReader<'_>, width: &Quantity) -> Read<Option<Smoothing>> {
    table.optional("smoothing", |node, path| Smoothing::read(node, path, width))
}

fn known_keys<T: Scalars>(more: &[&'static str]) -> Vec<&'static str> {
    let scalars = T::SCALARS.iter().map(|scalar| scalar.key);
    ["kind"]
        .into_iter()
        .chain(scalars)
        .chain(more.iter().copied())
        .collect()
}

/// Refuses the keys of stops that this version does not have.
fn refuse_impact(node: &Node, path: &str) -> Read<()> {
    let features = [
        ("restitution", "rigid stops with restitution"),
        ("damping", "stops with contact damping"),
    ];
    for (key, what) in features {
        if let Some(value) = node.child(key) {
            return Err(not_available(
                value,
                &join(path, key),
                format!("this version does not have {what}; a stop has a gap and a stiffness"),
            ));
        }
    }
    Ok(())
}

fn not_available(node: &Node, path: &str, message: String) -> Box<Issue> {
    Issue::new(Problem::NotAvailable, path, message)
        .at(&node.origin)
        .with_value(node.shown())
        .with_help(format!("it has {}", enumerate(KINDS)))
}
