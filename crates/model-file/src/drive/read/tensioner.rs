//! Reading `[[tensioner]]`. Rotary and linear tensioners have different keys and units.

use super::{known_keys, read_name};
use crate::drive::{
    BearingDrag, Direction, DryFriction, Guide, Linear, PulleyContact, Rotary, Spring, StopContact, Tensioner,
};
use crate::names::named_path;
use crate::node::{Node, Value};
use crate::reader::{Read, TableReader, read_choice, read_pair, read_quantity};
use crate::units::{Quantity, quantities};

/// How a tensioner moves decides the units of its keys.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Rotary,
    Linear,
}

const KINDS: [(&str, Kind); 2] = [("rotary", Kind::Rotary), ("linear", Kind::Linear)];
const DRAGS: [(&str, BearingDrag); 2] = [("arm", BearingDrag::Arm), ("ground", BearingDrag::Ground)];

impl Kind {
    fn choose(self, rotary: Quantity, linear: Quantity) -> Quantity {
        match self {
            Self::Rotary => rotary,
            Self::Linear => linear,
        }
    }

    pub fn position(self) -> Quantity {
        self.choose(quantities::ANGLE, quantities::LENGTH)
    }

    pub fn force(self) -> Quantity {
        self.choose(quantities::TORQUE, quantities::FORCE)
    }

    pub fn stiffness(self) -> Quantity {
        self.choose(quantities::TORSIONAL_STIFFNESS, quantities::STIFFNESS)
    }

    pub fn damping(self) -> Quantity {
        self.choose(quantities::TORSIONAL_DAMPING, quantities::DAMPING)
    }
}

impl Tensioner {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        let path = named_path(node, path);
        let mut known = vec![
            "name",
            "kind",
            "spring",
            "friction",
            "stops",
            "stop_contact",
            "pulley_contact",
            "bearing_drag",
            "locked",
        ];
        let kind = match node.child("kind") {
            // Without a kind the file is wrong anyway; the keys of the frequent kind make the better message.
            None => Kind::Rotary,
            Some(kind) => read_choice(kind, &format!("{path}.kind"), "kind of tensioner", &KINDS)?,
        };
        known.extend(match kind {
            Kind::Rotary => known_keys::<Rotary>(&["pivot"]),
            Kind::Linear => known_keys::<Linear>(&["point", "direction"]),
        });
        let table = TableReader::open(node, &path, &known_keys::<Self>(&known))?;
        let name = read_name(&table, "\"tensioner\"")?;
        table.require("kind", "\"rotary\"")?;
        let guide = match kind {
            Kind::Rotary => Guide::Rotary(Rotary::read(&table)?),
            Kind::Linear => Guide::Linear(Linear::read(&table)?),
        };
        let mut tensioner = Self {
            name,
            guide,
            spring: table.optional("spring", |node, path| Spring::read(node, path, kind))?,
            damping: 0.0,
            one_way_damping: 0.0,
            friction: table.optional("friction", |node, path| DryFriction::read(node, path, kind))?,
            stops: table.optional("stops", |node, path| read_pair(node, path, &kind.position()))?,
            stop_contact: table.optional("stop_contact", |node, path| StopContact::read(node, path, kind))?,
            pulley_contacts: table.list("pulley_contact", PulleyContact::read)?,
            bearing_drag: table
                .choice("bearing_drag", "place of reaction", &DRAGS)?
                .unwrap_or_default(),
            locked: table.boolean("locked")?.unwrap_or(false),
        };
        table.fill(&mut tensioner, |_| kind.damping())?;
        Ok(tensioner)
    }
}

impl Rotary {
    fn read(table: &TableReader<'_>) -> Read<Self> {
        let pivot = table.require("pivot", "[\"250 mm\", \"60 mm\"]")?;
        let mut rotary: Self = table.scalars()?;
        rotary.pivot = read_pair(pivot, &table.path_of("pivot"), &quantities::LENGTH)?;
        Ok(rotary)
    }
}

impl Linear {
    fn read(table: &TableReader<'_>) -> Read<Self> {
        let point = table.require("point", "[\"250 mm\", \"60 mm\"]")?;
        let direction = table.require("direction", "\"90 deg\"")?;
        let mut linear = Self {
            point: read_pair(point, &table.path_of("point"), &quantities::LENGTH)?,
            direction: Direction::read(direction, &table.path_of("direction"))?,
            position: 0.0,
            mass: 0.0,
        };
        table.fill(&mut linear, |scalar| scalar.quantity)?;
        Ok(linear)
    }
}

impl Direction {
    fn read(node: &Node, path: &str) -> Read<Self> {
        match node.value {
            Value::Array(_) => read_pair(node, path, &quantities::NUMBER).map(Self::Vector),
            _ => read_quantity(node, path, &quantities::ANGLE).map(Self::Angle),
        }
    }
}

impl Spring {
    fn read(node: &Node, path: &str, kind: Kind) -> Read<Self> {
        let table = TableReader::open(node, path, &known_keys::<Self>(&[]))?;
        let mut spring = Self::default();
        table.fill(&mut spring, |scalar| match scalar.key {
            "rate" => kind.stiffness(),
            _ => kind.force(),
        })?;
        Ok(spring)
    }
}
