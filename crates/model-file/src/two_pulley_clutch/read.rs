//! From the document to the parameters.

use super::{DampingRatio, Dimensionless, Parameters, Physical, TwoPulleyClutch};
use crate::error::{Issue, Problem};
use crate::node::{Node, Value};
use crate::reader::{Read, TableReader, read_quantities, read_quantity, wrong_type};
use crate::scalar::Scalars;
use crate::smoothing::Smoothing;
use crate::units::quantities;

impl TwoPulleyClutch {
    pub(crate) fn read(document: &Node) -> Read<Self> {
        let known = [
            "kind",
            "name",
            "description",
            "dimensionless",
            "physical",
            "smoothing",
        ];
        let table = TableReader::open(document, "", &known)?;
        let parameters = match (table.get("dimensionless"), table.get("physical")) {
            (Some(node), None) => Parameters::Dimensionless(Dimensionless::read(node)?),
            (None, Some(node)) => Parameters::Physical(Physical::read(node)?),
            (Some(_), Some(physical)) => {
                return Err(Issue::new(
                    Problem::WrongValue,
                    "physical",
                    "the file has both [dimensionless] and [physical]",
                )
                .at(&physical.origin)
                .with_help("keep one of the two tables"));
            }
            (None, None) => {
                return Err(
                    Issue::new(Problem::MissingKey, "dimensionless", "the parameters are missing")
                        .at(&document.origin)
                        .with_help("add a table [dimensionless] or a table [physical]"),
                );
            }
        };
        Ok(Self {
            name: table.text("name")?,
            description: table.text("description")?,
            parameters,
            smoothing: table.optional("smoothing", |node, path| {
                Smoothing::read(node, path, &quantities::ANGLE)
            })?,
        })
    }
}

impl Dimensionless {
    fn read(node: &Node) -> Read<Self> {
        let (mut parameters, damping_ratio) = read_parameters::<Self>(node, "dimensionless")?;
        parameters.damping_ratio = damping_ratio;
        Ok(parameters)
    }
}

impl Physical {
    fn read(node: &Node) -> Read<Self> {
        let (mut parameters, damping_ratio) = read_parameters::<Self>(node, "physical")?;
        parameters.damping_ratio = damping_ratio;
        Ok(parameters)
    }
}

fn read_parameters<T: Scalars + Default>(node: &Node, path: &str) -> Read<(T, DampingRatio)> {
    let mut known: Vec<&str> = T::SCALARS.iter().map(|scalar| scalar.key).collect();
    known.push("damping_ratio");
    let table = TableReader::open(node, path, &known)?;
    let parameters = table.scalars()?;
    let damping_ratio = read_damping_ratio(
        table.require("damping_ratio", "0.03")?,
        &table.path_of("damping_ratio"),
    )?;
    Ok((parameters, damping_ratio))
}

fn read_damping_ratio(node: &Node, path: &str) -> Read<DampingRatio> {
    match &node.value {
        Value::Array(_) => {
            let ratios = read_quantities(node, path, &quantities::NUMBER)?;
            <[f64; 2]>::try_from(ratios)
                .map(DampingRatio::Each)
                .map_err(|ratios| {
                    Issue::wrong_value(
                        path,
                        format!(
                            "expected two damping ratios, one for each mode, found {}",
                            ratios.len()
                        ),
                    )
                    .at(&node.origin)
                    .with_value(node.shown())
                    .with_help("write one number for both modes, or two in brackets")
                })
        }
        Value::Integer(_) | Value::Float(_) | Value::Text(_) => Ok(DampingRatio::Common(read_quantity(
            node,
            path,
            &quantities::NUMBER,
        )?)),
        _ => Err(wrong_type(node, path, "one damping ratio or a list of two")),
    }
}
