//! From the document to the drive.

mod belt;
mod excitation;
mod friction;
mod pulley;
mod tensioner;

use super::{Belt, Condition, Drive, Excitation, Operating, Pulley, Rotation, Tensioner};
use crate::names::named_path;
use crate::node::Node;
use crate::reader::{Read, TableReader, read_text};
use crate::scalar::{Scalars, join};

impl Drive {
    pub(crate) fn read(document: &Node) -> Read<Self> {
        let known = [
            "kind",
            "name",
            "description",
            "belt",
            "pulley",
            "tensioner",
            "operating",
            "excitation",
            "condition",
        ];
        let table = TableReader::open(document, "", &known)?;
        let belt = require_table(&table, "belt", "model, stiffness and mass of the belt")?;
        let operating = require_table(&table, "operating", "the speed of the driver")?;
        Ok(Self {
            name: table.text("name")?,
            description: table.text("description")?,
            belt: Belt::read(belt, "belt")?,
            pulleys: table.list("pulley", Pulley::read)?,
            tensioners: table.list("tensioner", Tensioner::read)?,
            operating: Operating::read(operating, "operating")?,
            excitation: table
                .optional("excitation", Excitation::read)?
                .unwrap_or_default(),
            conditions: table.list("condition", Condition::read)?,
        })
    }
}

/// A table of the file that must be there.
fn require_table<'d>(table: &TableReader<'d>, key: &str, holds: &str) -> Read<&'d Node> {
    table.get(key).ok_or_else(|| {
        crate::error::Issue::new(
            crate::error::Problem::MissingKey,
            join("", key),
            "the table is missing",
        )
        .at(table.origin())
        .with_help(format!("add a table [{key}] with {holds}"))
    })
}

impl Operating {
    fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &["speed", "rotation"])?;
        let words = [
            ("counter-clockwise", Rotation::CounterClockwise),
            ("clockwise", Rotation::Clockwise),
        ];
        let mut operating: Self = table.scalars()?;
        operating.rotation = table.choice("rotation", "sense of rotation", &words)?;
        Ok(operating)
    }
}

impl Condition {
    fn read(node: &Node, path: &str) -> Read<Self> {
        let path = named_path(node, path);
        let table = TableReader::open(node, &path, &known_keys::<Self>(&["name"]))?;
        let mut condition = Self {
            name: read_name(&table, "\"hot\"")?,
            temperature_change: 0.0,
            length_change: 0.0,
            elongation: 0.0,
            structure_expansion: 0.0,
            spring_factor: 1.0,
        };
        table.fill(&mut condition, |scalar| scalar.quantity)?;
        Ok(condition)
    }
}

/// The keys of named numbers, and more.
fn known_keys<T: Scalars>(more: &[&'static str]) -> Vec<&'static str> {
    let scalars = T::SCALARS.iter().map(|scalar| scalar.key);
    more.iter().copied().chain(scalars).collect()
}

fn read_name(table: &TableReader<'_>, example: &str) -> Read<String> {
    let name = table.require("name", example)?;
    read_text(name, &table.path_of("name")).map(str::to_owned)
}
