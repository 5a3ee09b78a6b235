//! Reading `[excitation]`.

use crate::drive::{Amount, Excitation, Order};
use crate::node::{Node, Value};
use crate::reader::{Read, TableReader, read_quantities, read_quantity};
use crate::units::{Quantity, quantities};

impl Excitation {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &["motion", "torque"])?;
        Ok(Self {
            motion: table.list("motion", |node, path| Order::read(node, path, &quantities::ANGLE))?,
            torque: table.list("torque", |node, path| {
                Order::read(node, path, &quantities::TORQUE)
            })?,
        })
    }
}

impl Order {
    fn read(node: &Node, path: &str, amplitude: &Quantity) -> Read<Self> {
        let table = TableReader::open(node, path, &["order", "speed", "amplitude", "phase"])?;
        let amplitude_node = table.require("amplitude", &format!("\"{}\"", amplitude.example))?;
        Ok(Self {
            order: table.quantity("order", &quantities::NUMBER)?,
            speed: table
                .optional("speed", |node, path| {
                    read_quantities(node, path, &quantities::ROTATIONAL_SPEED)
                })?
                .unwrap_or_default(),
            amplitude: Amount::read(amplitude_node, &table.path_of("amplitude"), amplitude)?,
            phase: table
                .optional("phase", |node, path| Amount::read(node, path, &quantities::ANGLE))?
                .unwrap_or_default(),
        })
    }
}

impl Amount {
    fn read(node: &Node, path: &str, quantity: &Quantity) -> Read<Self> {
        match &node.value {
            Value::Array(_) => read_quantities(node, path, quantity).map(Self::Each),
            _ => read_quantity(node, path, quantity).map(Self::Constant),
        }
    }
}
