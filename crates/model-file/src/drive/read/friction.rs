//! Reading `tensioner.friction` and contacts of a tensioner.

use super::known_keys;
use super::tensioner::Kind;
use crate::drive::{DryFriction, FrictionLaw, MeasuredLoop, PulleyContact, StopContact};
use crate::node::Node;
use crate::reader::{Read, TableReader, read_quantities, read_text};
use crate::units::Quantity;

impl DryFriction {
    pub(super) fn read(node: &Node, path: &str, kind: Kind) -> Read<Self> {
        let table = TableReader::open(node, path, &known_keys::<Self>(&["law", "loop"]))?;
        let mut friction = Self {
            law: table
                .choice("law", "law of friction", &FrictionLaw::WORDS)?
                .unwrap_or_default(),
            measured: table.optional("loop", |node, path| MeasuredLoop::read(node, path, kind))?,
            ..Self::default()
        };
        table.fill(&mut friction, |scalar| match scalar.key {
            "loading" | "unloading" => kind.force(),
            "stiffness" => kind.stiffness(),
            "damping" | "viscous" => kind.damping(),
            _ => scalar.quantity,
        })?;
        Ok(friction)
    }
}

impl MeasuredLoop {
    fn read(node: &Node, path: &str, kind: Kind) -> Read<Self> {
        let table = TableReader::open(node, path, &["position", "loading", "unloading"])?;
        let list = |key: &str, quantity: &Quantity, example: &str| {
            read_quantities(table.require(key, example)?, &table.path_of(key), quantity)
        };
        Ok(Self {
            position: list("position", &kind.position(), "[\"-20 deg\", \"20 deg\"]")?,
            loading: list("loading", &kind.force(), "[\"25 N m\", \"18 N m\"]")?,
            unloading: list("unloading", &kind.force(), "[\"19 N m\", \"12 N m\"]")?,
        })
    }
}

impl StopContact {
    pub(super) fn read(node: &Node, path: &str, kind: Kind) -> Read<Self> {
        let table = TableReader::open(node, path, &known_keys::<Self>(&[]))?;
        let mut contact = Self::default();
        table.fill(&mut contact, |scalar| match scalar.key {
            "stiffness" => kind.stiffness(),
            "damping" => kind.damping(),
            _ => scalar.quantity,
        })?;
        Ok(contact)
    }
}

impl PulleyContact {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &known_keys::<Self>(&["pulley", "carried"]))?;
        let pulley = table.require("pulley", "\"crank\"")?;
        let mut contact = Self {
            pulley: read_text(pulley, &table.path_of("pulley"))?.to_owned(),
            carried: table.text("carried")?,
            ..Self::default()
        };
        table.fill(&mut contact, |scalar| scalar.quantity)?;
        Ok(contact)
    }
}
