//! Reading `[belt]`.

use super::known_keys;
use crate::drive::{
    ArcStretch, Belt, BeltDamping, BeltModel, Friction, GroovedFriction, Installation, Length, ModalDamping,
    ModesPerSpan, OperatingPosition, PerRib, Rayleigh, RestTension, Section, SectionProperties, SpanEnds,
};
use crate::error::{Issue, Problem};
use crate::node::{Node, Value};
use crate::reader::{
    Read, TableReader, read_choice, read_count, read_list, read_quantities, read_quantity, wrong_type,
};
use crate::scalar::Scalars;
use crate::units::quantities;

const MODELS: [(&str, BeltModel); 3] = [
    ("spring", BeltModel::Spring),
    ("string", BeltModel::String),
    ("beam", BeltModel::Beam),
];
const SPAN_ENDS: [(&str, SpanEnds); 2] = [("tangent", SpanEnds::Tangent), ("contact", SpanEnds::Contact)];
const ARC_STRETCHES: [(&str, ArcStretch); 3] = [
    ("none", ArcStretch::None),
    ("mean", ArcStretch::Mean),
    ("entry", ArcStretch::Entry),
];

impl Belt {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        let mut known = vec![
            "model",
            "per_rib",
            "ribs",
            "natural_length",
            "effective_length",
            "installation",
            "friction",
            "modes_per_span",
            "static_correction",
            "span_ends",
            "arc_stretch",
            "damping",
            "wrapped_inertia",
        ];
        known.extend(known_keys::<SectionProperties>(&[]));
        let table = TableReader::open(node, path, &known_keys::<Self>(&known))?;
        let model = table.require("model", "\"beam\"")?;
        let mut belt = Self {
            model: read_choice(model, &table.path_of("model"), "belt model", &MODELS)?,
            section: Section::read(&table)?,
            ribs: table.optional("ribs", read_ribs)?,
            length: Length::read(&table)?,
            measuring_tension: None,
            friction: table.optional("friction", Friction::read)?,
            back_friction: None,
            cord_offset_ribs: None,
            cord_offset_back: None,
            modes_per_span: table
                .optional("modes_per_span", ModesPerSpan::read)?
                .unwrap_or_default(),
            static_correction: table.boolean("static_correction")?.unwrap_or(true),
            span_ends: table
                .choice("span_ends", "end of spans", &SPAN_ENDS)?
                .unwrap_or_default(),
            arc_stretch: table
                .choice("arc_stretch", "stretch on arcs", &ARC_STRETCHES)?
                .unwrap_or_default(),
            damping: table.optional("damping", BeltDamping::read)?.unwrap_or_default(),
            thermal_expansion: 0.0,
            arc_participation: 0.0,
            wrapped_inertia: table.boolean("wrapped_inertia")?.unwrap_or(false),
        };
        table.fill(&mut belt, |scalar| scalar.quantity)?;
        Ok(belt)
    }
}

fn read_ribs(node: &Node, path: &str) -> Read<u32> {
    let count = read_count(node, path)?;
    u32::try_from(count).map_err(|_| {
        Issue::wrong_value(path, "is not a number of ribs")
            .at(&node.origin)
            .with_value(count)
            .with_help("give the number of ribs, for example 6")
    })
}

impl Section {
    fn read(table: &TableReader<'_>) -> Read<Self> {
        let Some(node) = table.get("per_rib") else {
            return table.scalars().map(Self::Whole);
        };
        let path = table.path_of("per_rib");
        for key in known_keys::<SectionProperties>(&[]) {
            if let Some(whole) = table.get(key) {
                return Err(Issue::wrong_value(
                    table.path_of(key),
                    "the belt has both values of the whole belt and values per rib",
                )
                .at(&whole.origin)
                .with_help(format!(
                    "keep {key} of the whole belt or {path}, and give all values in the same form"
                )));
            }
        }
        let per_rib = TableReader::open(node, &path, &known_keys::<SectionProperties>(&[]))?.scalars()?;
        Ok(Self::PerRib(PerRib { per_rib }))
    }
}

impl Length {
    fn read(table: &TableReader<'_>) -> Read<Self> {
        let keys = ["natural_length", "effective_length", "installation"];
        let given: Vec<&str> = keys.into_iter().filter(|key| table.get(key).is_some()).collect();
        match given.as_slice() {
            ["natural_length"] => table
                .quantity("natural_length", &quantities::LENGTH)
                .map(Self::NaturalLength),
            ["effective_length"] => table
                .quantity("effective_length", &quantities::LENGTH)
                .map(Self::EffectiveLength),
            ["installation"] => {
                let node = table.require("installation", "{ tension = \"300 N\" }")?;
                Installation::read(node, &table.path_of("installation")).map(Self::Installation)
            }
            [] => Err(Issue::new(
                Problem::MissingKey,
                table.path_of("installation"),
                "nothing says how long the belt is",
            )
            .at(table.origin())
            .with_help(
                "add `installation = { tension = \"300 N\" }` (at rest, unloaded, arms at their reference), \
                 `installation = { operating_position = true }`, `natural_length` or `effective_length`",
            )),
            [first, second, ..] => {
                let second_node = table.require(second, "")?;
                Err(Issue::wrong_value(
                    table.path_of(second),
                    format!("the length of the belt already follows from {first}"),
                )
                .at(&second_node.origin)
                .with_value(second_node.shown())
                .with_help(format!("keep one of {first} and {second}")))
            }
            [other] => Err(Issue::new(
                Problem::UnknownKey,
                table.path_of(other),
                "is not a length",
            )),
        }
    }
}

impl Installation {
    fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &["tension", "operating_position"])?;
        match (
            table.optional("tension", |node, path| {
                read_quantity(node, path, &quantities::FORCE)
            })?,
            table.boolean("operating_position")?,
        ) {
            (Some(tension), None) => Ok(Self::Tension(RestTension { tension })),
            (None, Some(operating_position)) => {
                Ok(Self::OperatingPosition(OperatingPosition { operating_position }))
            }
            (Some(_), Some(_)) => Err(Issue::wrong_value(
                path,
                "gives both a tension at rest and the position at the operating point",
            )
            .at(&node.origin)
            .with_value(node.shown())
            .with_help("keep one of the two")),
            (None, None) => Err(
                Issue::new(Problem::MissingKey, path, "says nothing of the installation")
                    .at(&node.origin)
                    .with_help("write `{ tension = \"300 N\" }` or `{ operating_position = true }`"),
            ),
        }
    }
}

impl Friction {
    fn read(node: &Node, path: &str) -> Read<Self> {
        if !matches!(node.value, Value::Table(_)) {
            return read_quantity(node, path, &quantities::NUMBER).map(Self::Effective);
        }
        let table = TableReader::open(node, path, &known_keys::<GroovedFriction>(&[]))?;
        table.scalars().map(Self::Grooved)
    }
}

impl ModesPerSpan {
    fn read(node: &Node, path: &str) -> Read<Self> {
        match &node.value {
            Value::Integer(_) => read_count(node, path).map(Self::Common),
            Value::Array(_) => read_list(node, path, read_count).map(Self::Each),
            _ => Err(wrong_type(
                node,
                path,
                "a whole number, or a list with one for each span",
            )),
        }
    }
}

impl BeltDamping {
    fn read(node: &Node, path: &str) -> Read<Self> {
        let table = TableReader::open(node, path, &known_keys::<Self>(&["rayleigh", "modal"]))?;
        let mut damping: Self = table.scalars()?;
        damping.rayleigh = table.optional("rayleigh", |node, path| {
            let keys: Vec<&str> = Rayleigh::SCALARS.iter().map(|scalar| scalar.key).collect();
            TableReader::open(node, path, &keys)?.scalars()
        })?;
        damping.modal = table.optional("modal", |node, path| match &node.value {
            Value::Array(_) => read_quantities(node, path, &quantities::NUMBER).map(ModalDamping::Each),
            _ => read_quantity(node, path, &quantities::NUMBER).map(ModalDamping::Common),
        })?;
        Ok(damping)
    }
}
