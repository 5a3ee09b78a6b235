//! The document as a tree of values that know where they were written.
//!
//! Readers need the place of every value for their messages, and overrides replace single values; neither is possible
//! with plain deserialisation, because the spans of `toml` do not pass through tagged or flattened types.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Issue, Problem, number_text, shown};
use crate::source::{Origin, Source};

/// Deepest nesting of tables and lists; no model file needs a third of it, and recursion stays harmless.
pub(crate) const DEEPEST: usize = 24;

/// The error for a document that nests more deeply.
pub(crate) fn too_deep() -> Box<Issue> {
    Issue::new(
        Problem::WrongType,
        "",
        format!("tables and lists are nested more than {DEEPEST} deep"),
    )
    .with_help("no key of a model file is nested so deeply")
}

/// A value with its origin.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub value: Value,
    pub origin: Origin,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    /// Dates and times; no key of a model file holds one.
    Date(String),
    Array(Vec<Node>),
    Table(Vec<Entry>),
}

/// A key of a table with its value.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub key: String,
    pub key_origin: Origin,
    pub node: Node,
}

impl Node {
    /// Tree of a whole document.
    pub fn parse(source: &Source) -> Result<Self, Box<Issue>> {
        let document = DeTable::parse(source.text()).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            // The parser's messages may span lines; the caller's may not.
            Issue::new(
                Problem::Syntax,
                "",
                format!("not valid TOML: {}", shown(error.message())),
            )
            .at(&Origin::Text(span))
        })?;
        Ok(Self {
            value: Value::Table(entries(document.get_ref(), &Origin::Text, 1)?),
            // Messages about the document as a whole point at its first line.
            origin: Origin::Text(0..0),
        })
    }

    /// Tree of the value of an override: a TOML value, or else a text.
    pub fn parse_setting(value: &str, origin: &Origin) -> Result<Self, Box<Issue>> {
        match DeValue::parse(value.trim()) {
            Ok(parsed) => Self::from_toml(&parsed, &|_| origin.clone(), 1),
            Err(_) => Ok(Self {
                value: Value::Text(value.trim().to_owned()),
                origin: origin.clone(),
            }),
        }
    }

    fn from_toml(
        value: &Spanned<DeValue<'_>>,
        origin: &dyn Fn(std::ops::Range<usize>) -> Origin,
        depth: usize,
    ) -> Result<Self, Box<Issue>> {
        let own_origin = origin(value.span());
        if depth > DEEPEST {
            return Err(too_deep().at(&own_origin));
        }
        let converted = match value.get_ref() {
            DeValue::String(text) => Value::Text(text.clone().into_owned()),
            DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(integer) => Value::Integer(integer),
                Err(_) => {
                    return Err(Issue::new(
                        Problem::WrongValue,
                        "",
                        format!("the integer {integer} is too large"),
                    )
                    .at(&own_origin)
                    .with_help("write it with a decimal point"));
                }
            },
            DeValue::Float(float) => match float.as_str().parse() {
                Ok(float) => Value::Float(float),
                Err(_) => {
                    return Err(
                        Issue::new(Problem::WrongValue, "", format!("{float} is not a number"))
                            .at(&own_origin),
                    );
                }
            },
            DeValue::Boolean(boolean) => Value::Boolean(*boolean),
            DeValue::Datetime(date) => Value::Date(date.to_string()),
            DeValue::Array(items) => Value::Array(
                items
                    .iter()
                    .map(|item| Self::from_toml(item, origin, depth + 1))
                    .collect::<Result<_, _>>()?,
            ),
            DeValue::Table(table) => Value::Table(entries(table, origin, depth + 1)?),
        };
        Ok(Self {
            value: converted,
            origin: own_origin,
        })
    }

    /// The value for a message, on one line.
    pub fn shown(&self) -> String {
        shown(&self.written())
    }

    fn written(&self) -> String {
        match &self.value {
            Value::Text(text) => format!("\"{text}\""),
            Value::Integer(integer) => integer.to_string(),
            Value::Float(float) => number_text(*float),
            Value::Boolean(boolean) => boolean.to_string(),
            Value::Date(date) => date.clone(),
            Value::Array(items) => {
                let items: Vec<_> = items.iter().map(Self::written).collect();
                format!("[{}]", items.join(", "))
            }
            Value::Table(entries) => {
                let entries: Vec<_> = entries
                    .iter()
                    .map(|entry| format!("{} = {}", entry.key, entry.node.written()))
                    .collect();
                format!("{{ {} }}", entries.join(", "))
            }
        }
    }

    /// The sort of value, with its article, for messages.
    pub fn type_name(&self) -> &'static str {
        match self.value {
            Value::Text(_) => "a text",
            Value::Integer(_) => "an integer",
            Value::Float(_) => "a number",
            Value::Boolean(_) => "a boolean",
            Value::Date(_) => "a date",
            Value::Array(_) => "a list",
            Value::Table(_) => "a table",
        }
    }

    /// The value below a key of a table, or an item of a list by index or by its `name`.
    pub fn child(&self, key: &str) -> Option<&Self> {
        match &self.value {
            Value::Table(entries) => entries
                .iter()
                .find(|entry| entry.key == key)
                .map(|entry| &entry.node),
            Value::Array(items) => items.get(item_index(items, key)?),
            _ => None,
        }
    }

    /// Origin of the value at `path`, or of the nearest table or list around it that is written.
    pub fn origin_of(&self, path: &str) -> &Origin {
        let mut node = self;
        if !path.is_empty() {
            for key in path.split('.') {
                match node.child(key) {
                    Some(child) => node = child,
                    None => break,
                }
            }
        }
        &node.origin
    }

    /// The value at `path`.
    pub fn find(&self, path: &str) -> Option<&Self> {
        path.split('.').try_fold(self, |node, key| node.child(key))
    }
}

fn entries(
    table: &DeTable<'_>,
    origin: &dyn Fn(std::ops::Range<usize>) -> Origin,
    depth: usize,
) -> Result<Vec<Entry>, Box<Issue>> {
    table
        .iter()
        .map(|(key, value)| {
            Ok(Entry {
                key: key.get_ref().clone().into_owned(),
                key_origin: origin(key.span()),
                node: Node::from_toml(value, origin, depth).map_err(|mut issue| {
                    issue.key = if issue.key.is_empty() {
                        key.get_ref().clone().into_owned()
                    } else {
                        format!("{}.{}", key.get_ref(), issue.key)
                    };
                    issue
                })?,
            })
        })
        .collect()
}

/// Index of the item that `key` means: a number counted from zero, or the `name` of an item that is a table.
pub(crate) fn item_index(items: &[Node], key: &str) -> Option<usize> {
    let named = items
        .iter()
        .position(|item| matches!(item.child_of_table("name"), Some(Value::Text(name)) if name == key));
    named.or_else(|| key.parse().ok().filter(|index| *index < items.len()))
}

impl Node {
    /// The value of a key, only if this is a table.
    fn child_of_table(&self, key: &str) -> Option<&Value> {
        match &self.value {
            Value::Table(entries) => entries
                .iter()
                .find(|entry| entry.key == key)
                .map(|entry| &entry.node.value),
            _ => None,
        }
    }
}
