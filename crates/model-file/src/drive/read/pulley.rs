//! Reading `[[pulley]]`.

use super::{known_keys, read_name};
use crate::drive::{
    Carried, Contact, Coupling, CouplingKind, Fixed, Load, LoadTable, Mount, Power, Pulley, Size, SpeedOf,
};
use crate::error::{Issue, Problem};
use crate::names::named_path;
use crate::node::{Node, Value};
use crate::reader::{Read, TableReader, read_choice, read_pair, read_quantities, read_quantity, read_text};
use crate::units::{self, quantities};

const CONTACTS: [(&str, Contact); 2] = [("ribs", Contact::Ribs), ("back", Contact::Back)];
const SPEEDS: [(&str, SpeedOf); 2] = [("pulley", SpeedOf::Pulley), ("driver", SpeedOf::Driver)];

impl Pulley {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        let path = named_path(node, path);
        let mut known = vec![
            "name",
            "center",
            "arm",
            "offset",
            "radius",
            "outside_diameter",
            "effective_diameter",
            "contact",
            "driver",
            "load",
            "coupling",
        ];
        known.extend(known_keys::<Carried>(&[]));
        let table = TableReader::open(node, &path, &known_keys::<Self>(&known))?;
        let mut pulley = Self {
            name: read_name(&table, "\"alternator\"")?,
            mount: Mount::read(&table)?,
            size: Size::read(&table)?,
            contact: table
                .choice("contact", "side of the belt", &CONTACTS)?
                .unwrap_or_default(),
            inertia: 0.0,
            driver: table.boolean("driver")?.unwrap_or(false),
            load: table.optional("load", Load::read)?.unwrap_or_default(),
            bearing_damping: 0.0,
            cord_offset: None,
            friction: None,
            minimum_wrap: None,
            coupling: table.optional("coupling", Coupling::read)?,
        };
        table.fill(&mut pulley, |scalar| scalar.quantity)?;
        Ok(pulley)
    }
}

impl Mount {
    fn read(table: &TableReader<'_>) -> Read<Self> {
        match (table.get("center"), table.get("arm")) {
            (Some(center), None) => {
                for key in ["arm_length", "arm_angle_offset", "offset", "mass"] {
                    if let Some(node) = table.get(key) {
                        return Err(Issue::wrong_value(
                            table.path_of(key),
                            "belongs to a pulley on a tensioner, and this one has a fixed centre",
                        )
                        .at(&node.origin)
                        .with_value(node.shown())
                        .with_help("remove the key, or give `arm` in place of `center`"));
                    }
                }
                let center = read_pair(center, &table.path_of("center"), &quantities::LENGTH)?;
                Ok(Self::Fixed(Fixed { center }))
            }
            (None, Some(arm)) => {
                let mut carried = Carried {
                    arm: read_text(arm, &table.path_of("arm"))?.to_owned(),
                    offset: table.optional("offset", |node, path| {
                        read_pair(node, path, &quantities::LENGTH)
                    })?,
                    ..Carried::default()
                };
                table.fill(&mut carried, |scalar| scalar.quantity)?;
                Ok(Self::Carried(carried))
            }
            (Some(_), Some(arm)) => Err(Issue::wrong_value(
                table.path_of("arm"),
                "the pulley has both a fixed centre and a tensioner that carries it",
            )
            .at(&arm.origin)
            .with_value(arm.shown())
            .with_help("keep `center` or `arm`")),
            (None, None) => Err(Issue::new(
                Problem::MissingKey,
                table.path_of("center"),
                "nothing says where the pulley is",
            )
            .at(table.origin())
            .with_help(
                "add `center = [\"120 mm\", \"80 mm\"]`, or `arm = \"…\"` with the name of the tensioner that \
                 carries it",
            )),
        }
    }
}

impl Size {
    fn read(table: &TableReader<'_>) -> Read<Self> {
        let mut found: Option<(&str, Self)> = None;
        for key in ["radius", "outside_diameter", "effective_diameter"] {
            let Some(node) = table.get(key) else { continue };
            if let Some((first, _)) = found {
                return Err(Issue::wrong_value(
                    table.path_of(key),
                    format!("the size of the pulley is already given by {first}"),
                )
                .at(&node.origin)
                .with_value(node.shown())
                .with_help(format!("keep one of {first} and {key}")));
            }
            let value = table.quantity(key, &quantities::LENGTH)?;
            let size = match key {
                "radius" => Self::Radius(value),
                "outside_diameter" => Self::OutsideDiameter(value),
                _ => Self::EffectiveDiameter(value),
            };
            found = Some((key, size));
        }
        found.map(|(_, size)| size).ok_or_else(|| {
            Issue::new(
                Problem::MissingKey,
                table.path_of("radius"),
                "nothing says how large the pulley is",
            )
            .at(table.origin())
            .with_help(
                "add `radius = \"30 mm\"` (of the cord line), `outside_diameter` or `effective_diameter`",
            )
        })
    }
}

impl Load {
    fn read(node: &Node, path: &str) -> Read<Self> {
        match &node.value {
            Value::Table(_) => Self::read_table(node, path),
            Value::Text(text) if units::read(text, &quantities::POWER).is_ok() => {
                let power = read_quantity(node, path, &quantities::POWER)?;
                Ok(Self::Power(Power { power }))
            }
            _ => read_quantity(node, path, &quantities::TORQUE_OR_POWER).map(Self::Torque),
        }
    }

    fn read_table(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &["speed", "torque", "power", "over"])?;
        if let (Some(power), None, None) = (table.get("power"), table.get("speed"), table.get("torque"))
            && !matches!(power.value, Value::Array(_))
        {
            let power = table.quantity("power", &quantities::POWER)?;
            return Ok(Self::Power(Power { power }));
        }
        let speed = table.require("speed", "[\"1000 rpm\", \"6000 rpm\"]")?;
        let torque = table.optional("torque", |node, path| {
            read_quantities(node, path, &quantities::TORQUE)
        })?;
        let power = table.optional("power", |node, path| {
            read_quantities(node, path, &quantities::POWER)
        })?;
        match (&torque, table.get("power")) {
            (Some(_), Some(power)) => {
                return Err(Issue::wrong_value(
                    table.path_of("power"),
                    "the load is given both as torque and as power",
                )
                .at(&power.origin)
                .with_value(power.shown())
                .with_help("keep one of the two"));
            }
            (None, None) => {
                table.require("torque", "[\"2 N m\", \"4 N m\"]")?;
            }
            _ => {}
        }
        Ok(Self::Table(LoadTable {
            speed: read_quantities(speed, &table.path_of("speed"), &quantities::ROTATIONAL_SPEED)?,
            torque,
            power,
            over: table.choice("over", "speed", &SPEEDS)?.unwrap_or_default(),
        }))
    }
}

impl Coupling {
    fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &known_keys::<Self>(&["kind"]))?;
        let kind = table.require("kind", "\"isolator\"")?;
        let mut coupling = Self {
            kind: read_choice(
                kind,
                &table.path_of("kind"),
                "kind of coupling",
                &CouplingKind::WORDS,
            )?,
            accessory_inertia: 0.0,
            accessory_damping: 0.0,
            stiffness: None,
            damping: None,
            preload: None,
        };
        table.fill(&mut coupling, |scalar| scalar.quantity)?;
        Ok(coupling)
    }
}
