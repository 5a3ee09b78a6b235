//! From the document to the system.

use super::{
    Element, Excitation, Harmonic, Law, MechanicalSystem, NumberMap, Output, OutputHarmonic, SquareMatrix,
};
use crate::error::{Issue, Problem};
use crate::names::named_path;
use crate::nearest::{enumerate, nearest};
use crate::node::{Node, Value};
use crate::reader::{Read, TableReader, read_list, read_quantity, read_text, table_entries, wrong_type};
use crate::scalar::join;
use crate::units::{Quantity, quantities};

impl MechanicalSystem {
    pub(crate) fn read(document: &Node) -> Read<Self> {
        let known = [
            "kind",
            "name",
            "description",
            "coordinates",
            "mass",
            "damping",
            "stiffness",
            "damping_linear_in_frequency",
            "stiffness_quadratic_in_frequency",
            "element",
            "excitation",
            "output",
        ];
        let table = TableReader::open(document, "", &known)?;
        let coordinates = read_list(
            table.require("coordinates", "[\"q\"]")?,
            "coordinates",
            |node, path| read_text(node, path).map(str::to_owned),
        )?;
        let order = coordinates.len();
        let required =
            |key, quantity| SquareMatrix::read(table.require(key, "[[1.0]]")?, key, order, quantity);
        let optional =
            |key, quantity| table.optional(key, |node, path| SquareMatrix::read(node, path, order, quantity));
        let elements = table.list("element", |node, path| Element::read(node, path, &coordinates))?;
        Ok(Self {
            name: table.text("name")?,
            description: table.text("description")?,
            mass: required("mass", &quantities::GENERALISED_MASS)?.with_rounding_removed(),
            damping: required("damping", &quantities::GENERALISED_DAMPING)?,
            stiffness: required("stiffness", &quantities::GENERALISED_STIFFNESS)?,
            damping_linear_in_frequency: optional(
                "damping_linear_in_frequency",
                &quantities::DAMPING_PER_FREQUENCY,
            )?,
            stiffness_quadratic_in_frequency: optional(
                "stiffness_quadratic_in_frequency",
                &quantities::STIFFNESS_PER_SQUARE_OF_FREQUENCY,
            )?,
            excitation: table
                .optional("excitation", |node, path| {
                    Excitation::read(node, path, &coordinates)
                })?
                .unwrap_or_default(),
            outputs: table.list("output", |node, path| {
                Output::read(node, path, &coordinates, &elements)
            })?,
            elements,
            coordinates,
        })
    }
}

impl Element {
    fn read(node: &Node, path: &str, coordinates: &[String]) -> Read<Self> {
        let path = named_path(node, path);
        let table = TableReader::open(node, &path, &["name", "port", "law"])?;
        let name = table.require("name", "\"clutch\"")?;
        let name = read_text(name, &table.path_of("name"))?.to_owned();
        let port = table.require("port", "{ pulley = 1.0, accessory = -1.0 }")?;
        let law = table.require("law", "{ kind = \"wrap-spring\", stiffness = 24.0 }")?;
        Ok(Self {
            name,
            port: read_coordinate_map(port, &table.path_of("port"), coordinates, &quantities::NUMBER)?,
            law: Law::read(law, &table.path_of("law"))?,
        })
    }
}

impl Excitation {
    fn read(node: &Node, path: &str, coordinates: &[String]) -> Read<Self> {
        let table = TableReader::open(node, path, &["frequency", "constant", "harmonics"])?;
        Ok(Self {
            frequency: table.optional("frequency", |node, path| {
                read_quantity(node, path, &quantities::ANGULAR_FREQUENCY)
            })?,
            constant: optional_coordinate_map(
                &table,
                "constant",
                coordinates,
                &quantities::GENERALISED_FORCE,
            )?,
            harmonics: table.list("harmonics", |node, path| Harmonic::read(node, path, coordinates))?,
        })
    }
}

impl Harmonic {
    fn read(node: &Node, path: &str, coordinates: &[String]) -> Read<Self> {
        let table = TableReader::open(node, path, &["order", "cos", "sin"])?;
        let order = read_order(&table, "excitation.constant")?;
        let force = &quantities::GENERALISED_FORCE;
        Ok(Self {
            order,
            cos: optional_coordinate_map(&table, "cos", coordinates, force)?,
            sin: optional_coordinate_map(&table, "sin", coordinates, force)?,
        })
    }
}

/// The order of a harmonic; `constant` is where a constant part belongs.
fn read_order(table: &TableReader<'_>, constant: &str) -> Read<u32> {
    let path = table.path_of("order");
    let node = table.require("order", "1")?;
    let Value::Integer(order) = node.value else {
        return Err(wrong_type(node, &path, "a whole number such as 1"));
    };
    u32::try_from(order)
        .ok()
        .filter(|order| *order >= 1)
        .ok_or_else(|| {
            Issue::wrong_value(path, "the order of a harmonic is a whole number from 1 up")
                .at(&node.origin)
                .with_value(order)
                .with_help(format!("put the constant part into {constant}"))
        })
}

impl OutputHarmonic {
    fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &["order", "cos", "sin"])?;
        let mut harmonic = Self {
            order: read_order(&table, "`constant`")?,
            cos: 0.0,
            sin: 0.0,
        };
        table.fill(&mut harmonic, |scalar| scalar.quantity)?;
        Ok(harmonic)
    }
}

impl Output {
    fn read(node: &Node, path: &str, coordinates: &[String], elements: &[Element]) -> Read<Self> {
        let path = named_path(node, path);
        let known = [
            "name",
            "displacement",
            "velocity",
            "force",
            "constant",
            "harmonics",
        ];
        let table = TableReader::open(node, &path, &known)?;
        let name = table.require("name", "\"tension\"")?;
        let element_names: Vec<&str> = elements.iter().map(|element| &*element.name).collect();
        Ok(Self {
            name: read_text(name, &table.path_of("name"))?.to_owned(),
            displacement: optional_factors(&table, "displacement", coordinates)?,
            velocity: optional_factors(&table, "velocity", coordinates)?,
            force: table
                .optional("force", |node, path| {
                    read_map(node, path, "element", &element_names, read_factor)
                })?
                .unwrap_or_default(),
            constant: table.optional("constant", read_factor)?,
            harmonics: table.list("harmonics", OutputHarmonic::read)?,
        })
    }
}

fn optional_coordinate_map(
    table: &TableReader<'_>,
    key: &str,
    coordinates: &[String],
    quantity: &Quantity,
) -> Read<NumberMap> {
    let map = table.optional(key, |node, path| {
        read_coordinate_map(node, path, coordinates, quantity)
    })?;
    Ok(map.unwrap_or_default())
}

fn optional_factors(table: &TableReader<'_>, key: &str, coordinates: &[String]) -> Read<NumberMap> {
    let names: Vec<&str> = coordinates.iter().map(|name| &**name).collect();
    let map = table.optional(key, |node, path| {
        read_map(node, path, "coordinate", &names, read_factor)
    })?;
    Ok(map.unwrap_or_default())
}

/// The factors of a measure have the units that the user gives the measure, so they are bare numbers.
fn read_factor(node: &Node, path: &str) -> Read<f64> {
    read_quantity(node, path, &quantities::NUMBER)
}

fn read_coordinate_map(
    node: &Node,
    path: &str,
    coordinates: &[String],
    quantity: &Quantity,
) -> Read<NumberMap> {
    let names: Vec<&str> = coordinates.iter().map(|name| &**name).collect();
    read_map(node, path, "coordinate", &names, |node, path| {
        read_quantity(node, path, quantity)
    })
}

/// A table from names to numbers, whose names must be among `names`.
fn read_map(
    node: &Node,
    path: &str,
    what: &str,
    names: &[&str],
    read: impl Fn(&Node, &str) -> Read<f64>,
) -> Read<NumberMap> {
    table_entries(node, path)?
        .iter()
        .map(|entry| {
            let key = join(path, &entry.key);
            if !names.contains(&entry.key.as_str()) {
                let help = match nearest(&entry.key, names.iter().copied()) {
                    Some(meant) => format!("did you mean \"{meant}\"?"),
                    None if names.is_empty() => format!("the file has no {what}"),
                    None => format!("the {what}s are {}", enumerate(names.iter().copied())),
                };
                return Err(Issue::new(
                    Problem::UnknownKey,
                    key,
                    format!("there is no {what} \"{}\"", entry.key),
                )
                .at(&entry.key_origin)
                .with_help(help));
            }
            Ok((entry.key.clone(), read(&entry.node, &key)?))
        })
        .collect()
}
