//! Reading tables of the document: unknown and missing keys, types, units.
//!
//! A reader refuses what is not a model of the right shape; which values are sound is checked on the finished model,
//! because values also change after reading.

use crate::error::{Issue, Problem};
use crate::nearest::{enumerate, nearest};
use crate::node::{Entry, Node, Value};
use crate::scalar::{Absent, Scalar, Scalars, join};
use crate::source::Origin;
use crate::units::{self, Quantity, UnitError};

/// Result of reading: boxed, because an issue is much larger than most values.
pub(crate) type Read<T> = Result<T, Box<Issue>>;

/// A table with known keys.
pub(crate) struct TableReader<'d> {
    node: &'d Node,
    entries: &'d [Entry],
    path: String,
}

impl<'d> TableReader<'d> {
    /// Opens a table and refuses keys that are not `known`.
    pub fn open(node: &'d Node, path: &str, known: &[&str]) -> Read<Self> {
        let entries = table_entries(node, path)?;
        if let Some(unknown) = entries.iter().find(|entry| !known.contains(&entry.key.as_str())) {
            return Err(unknown_key(unknown, path, known));
        }
        Ok(Self {
            node,
            entries,
            path: path.to_owned(),
        })
    }

    /// Path of a key of this table.
    pub fn path_of(&self, key: &str) -> String {
        join(&self.path, key)
    }

    /// The value of a key, if it is written.
    pub fn get(&self, key: &str) -> Option<&'d Node> {
        self.entries
            .iter()
            .find(|entry| entry.key == key)
            .map(|entry| &entry.node)
    }

    /// The value of a key that must be written; `example` shows how.
    pub fn require(&self, key: &str, example: &str) -> Read<&'d Node> {
        self.get(key).ok_or_else(|| {
            Issue::new(Problem::MissingKey, self.path_of(key), "is missing")
                .at(&self.node.origin)
                .with_help(format!("add a line such as `{key} = {example}`"))
        })
    }

    /// A text that may be left out.
    pub fn text(&self, key: &str) -> Read<Option<String>> {
        self.get(key)
            .map(|node| read_text(node, &self.path_of(key)).map(str::to_owned))
            .transpose()
    }

    /// A quantity that must be written.
    pub fn quantity(&self, key: &str, quantity: &Quantity) -> Read<f64> {
        let example = if quantity.is_plain_number() {
            quantity.example.to_owned()
        } else {
            format!("\"{}\"", quantity.example)
        };
        read_quantity(self.require(key, &example)?, &self.path_of(key), quantity)
    }

    /// All named numbers of a table.
    pub fn scalars<T: Scalars + Default>(&self) -> Read<T> {
        let mut table = T::default();
        self.fill(&mut table, |scalar| scalar.quantity)?;
        Ok(table)
    }

    /// Fills the named numbers of a table; `quantity_of` says what a key measures here.
    pub fn fill<T: Scalars>(&self, table: &mut T, quantity_of: impl Fn(&Scalar) -> Quantity) -> Read<()> {
        for scalar in T::SCALARS {
            let value = match (self.get(scalar.key), scalar.absent) {
                (None, Absent::Nothing) => continue,
                (None, Absent::Value(value)) => value,
                _ => self.quantity(scalar.key, &quantity_of(scalar))?,
            };
            table.fill_scalar(scalar.key, value);
        }
        Ok(())
    }

    /// Where the table is written.
    pub fn origin(&self) -> &'d Origin {
        &self.node.origin
    }

    /// A word from a list of choices, if it is written.
    pub fn choice<T: Copy>(&self, key: &str, what: &str, choices: &[(&'static str, T)]) -> Read<Option<T>> {
        self.optional(key, |node, path| read_choice(node, path, what, choices))
    }

    /// A boolean, if it is written.
    pub fn boolean(&self, key: &str) -> Read<Option<bool>> {
        self.optional(key, |node, path| match node.value {
            Value::Boolean(boolean) => Ok(boolean),
            _ => Err(wrong_type(node, path, "true or false")),
        })
    }

    /// An optional value read by `read`.
    pub fn optional<T>(&self, key: &str, read: impl FnOnce(&Node, &str) -> Read<T>) -> Read<Option<T>> {
        self.get(key)
            .map(|node| read(node, &self.path_of(key)))
            .transpose()
    }

    /// A list of which every item is read by `read`; empty if it is not written.
    pub fn list<T>(&self, key: &str, read: impl Fn(&Node, &str) -> Read<T>) -> Read<Vec<T>> {
        match self.get(key) {
            Some(node) => read_list(node, &self.path_of(key), read),
            None => Ok(Vec::new()),
        }
    }
}

/// The entries of a table.
pub(crate) fn table_entries<'d>(node: &'d Node, path: &str) -> Read<&'d [Entry]> {
    match &node.value {
        Value::Table(entries) => Ok(entries),
        _ => Err(wrong_type(node, path, "a table")),
    }
}

/// The error for a key that a table does not have.
pub(crate) fn unknown_key(entry: &Entry, path: &str, known: &[&str]) -> Box<Issue> {
    let issue = Issue::new(
        Problem::UnknownKey,
        join(path, &entry.key),
        format!("unknown key \"{}\"", entry.key),
    )
    .at(&entry.key_origin);
    match nearest(&entry.key, known.iter().copied()) {
        Some(meant) => issue.with_help(format!("did you mean \"{meant}\"?")),
        None => issue.with_help(format!(
            "known keys here are {}",
            enumerate(known.iter().copied())
        )),
    }
}

/// The error for a value of the wrong sort.
pub(crate) fn wrong_type(node: &Node, path: &str, expected: &str) -> Box<Issue> {
    Issue::new(
        Problem::WrongType,
        path,
        format!("expected {expected}, found {}", node.type_name()),
    )
    .at(&node.origin)
    .with_value(node.shown())
}

/// A text.
pub(crate) fn read_text<'d>(node: &'d Node, path: &str) -> Read<&'d str> {
    match &node.value {
        Value::Text(text) => Ok(text),
        _ => Err(wrong_type(node, path, "a text in quotes")),
    }
}

/// A quantity: a bare number in SI or a text with a unit.
pub(crate) fn read_quantity(node: &Node, path: &str, quantity: &Quantity) -> Read<f64> {
    match &node.value {
        // Integers beyond 2^53 are rounded to the nearest double, as in every numeric program.
        Value::Integer(integer) => Ok(*integer as f64),
        Value::Float(float) => Ok(*float),
        Value::Text(text) => units::read(text, quantity).map_err(|error| {
            let help = match &error {
                UnitError::UnknownUnit {
                    nearest: Some(unit), ..
                } => format!("did you mean \"{unit}\"?"),
                UnitError::WrongDimension { .. } | UnitError::NoUnit { .. }
                    if !quantity.is_plain_number() =>
                {
                    "correct the unit, or write a number without quotes in SI units".to_owned()
                }
                _ if quantity.is_plain_number() => "write a number without quotes".to_owned(),
                _ => "write a number and a unit in quotes, or a number without quotes in SI units".to_owned(),
            };
            Issue::new(Problem::WrongUnit, path, error.to_string())
                .at(&node.origin)
                .with_value(node.shown())
                .with_help(help)
        }),
        _ => Err(wrong_type(node, path, &quantity.description())),
    }
}

/// A list of which every item is read by `read`.
pub(crate) fn read_list<T>(node: &Node, path: &str, read: impl Fn(&Node, &str) -> Read<T>) -> Read<Vec<T>> {
    let Value::Array(items) = &node.value else {
        return Err(wrong_type(node, path, "a list"));
    };
    items
        .iter()
        .enumerate()
        .map(|(index, item)| read(item, &join(path, &index.to_string())))
        .collect()
}

/// A list of quantities.
pub(crate) fn read_quantities(node: &Node, path: &str, quantity: &Quantity) -> Read<Vec<f64>> {
    read_list(node, path, |item, path| read_quantity(item, path, quantity))
}

/// One of the words in `choices`.
pub(crate) fn read_choice<T: Copy>(
    node: &Node,
    path: &str,
    what: &str,
    choices: &[(&'static str, T)],
) -> Read<T> {
    let text = read_text(node, path)?;
    choices
        .iter()
        .find(|(word, _)| *word == text)
        .map(|(_, choice)| *choice)
        .ok_or_else(|| unknown_choice(node, path, what, text, choices.iter().map(|(word, _)| *word)))
}

/// The error for a word that is not among the choices.
pub(crate) fn unknown_choice(
    node: &Node,
    path: &str,
    what: &str,
    found: &str,
    choices: impl Iterator<Item = &'static str> + Clone,
) -> Box<Issue> {
    let known = enumerate(choices.clone());
    let help = match nearest(found, choices) {
        Some(meant) => format!("did you mean \"{meant}\"? Known are {known}"),
        None => format!("known are {known}"),
    };
    Issue::wrong_value(path, format!("unknown {what}"))
        .at(&node.origin)
        .with_value(node.shown())
        .with_help(help)
}

/// Whole number from zero up.
pub(crate) fn read_count(node: &Node, path: &str) -> Read<usize> {
    let Value::Integer(integer) = node.value else {
        return Err(wrong_type(node, path, "a whole number"));
    };
    usize::try_from(integer).map_err(|_| {
        Issue::wrong_value(path, "must not be negative")
            .at(&node.origin)
            .with_value(integer)
            .with_help("give zero or a positive whole number")
    })
}

/// A point or vector of two quantities.
pub(crate) fn read_pair(node: &Node, path: &str, quantity: &Quantity) -> Read<[f64; 2]> {
    let pair = read_quantities(node, path, quantity)?;
    <[f64; 2]>::try_from(pair).map_err(|list| {
        Issue::wrong_value(path, format!("expected two values, found {}", list.len()))
            .at(&node.origin)
            .with_value(node.shown())
            .with_help(format!("write two in brackets, each {}", quantity.description()))
    })
}
