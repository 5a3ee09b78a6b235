//! What is wrong with a model file, where, and what to do about it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::source::{Origin, Source};

/// The sort of mistake, for programs that treat mistakes differently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Problem {
    /// The file cannot be read.
    Unreadable,
    /// The text is not TOML.
    Syntax,
    /// A key that this kind of model does not have.
    UnknownKey,
    /// A key without which the model is not complete.
    MissingKey,
    /// A value of the wrong type: a table where a number belongs, and so on.
    WrongType,
    /// A quantity with the wrong or an unreadable unit.
    WrongUnit,
    /// A value that no such model can have.
    WrongValue,
    /// Something that is described but not part of this version.
    NotAvailable,
}

/// A place in the text of a model file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Bytes of the text.
    pub span: Range<usize>,
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
}

/// A mistake in a model file or in an override of one of its keys.
///
/// `Display` gives one line, for example
/// `drive.toml:12: dimensionless.preload = 0: no preload: the clutch has no engaged equilibrium; give a value greater
/// than zero`. The accessors carry what is needed to draw the mistake in its text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", self.one_line())]
pub struct ModelFileError(Box<Details>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Details {
    problem: Problem,
    source_name: String,
    text: Arc<str>,
    place: Option<Place>,
    setting: Option<String>,
    key: String,
    value: Option<String>,
    message: String,
    help: Option<String>,
}

impl ModelFileError {
    /// The sort of mistake.
    pub fn problem(&self) -> Problem {
        self.0.problem
    }

    /// Name of the file, as it was given; empty for a model that does not come from a file.
    pub fn source_name(&self) -> &str {
        &self.0.source_name
    }

    /// Whole text of the file.
    pub fn text(&self) -> &str {
        &self.0.text
    }

    /// Where in the text; none if the mistake is in an override or in a value set by a program.
    pub fn place(&self) -> Option<&Place> {
        self.0.place.as_ref()
    }

    /// The override that is wrong, as `KEY=VALUE`.
    pub fn setting(&self) -> Option<&str> {
        self.0.setting.as_deref()
    }

    /// Path of the key, for example `element.clutch.law.stiffness`; empty for the file as a whole.
    pub fn key(&self) -> &str {
        &self.0.key
    }

    /// The value as it was written, shortened if it is long.
    pub fn value(&self) -> Option<&str> {
        self.0.value.as_deref()
    }

    /// What is wrong.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// What to do.
    pub fn help(&self) -> Option<&str> {
        self.0.help.as_deref()
    }

    fn one_line(&self) -> String {
        let details = &*self.0;
        let mut line = String::new();
        match (&details.setting, &details.place) {
            (Some(setting), _) => {
                line += &format!("--set {}: ", shown(setting));
                // The override may break another key than its own, for example the size of a matrix.
                if setting.split('=').next().map(str::trim) != Some(details.key.as_str())
                    && !details.key.is_empty()
                {
                    line += &format!("{}: ", details.key);
                }
            }
            (None, Some(place)) => {
                line += &format!("{}:{}: ", details.source_name, place.line);
                line += &key_and_value(&details.key, details.value.as_deref());
            }
            (None, None) => {
                if !details.source_name.is_empty() {
                    line += &format!("{}: ", details.source_name);
                }
                line += &key_and_value(&details.key, details.value.as_deref());
            }
        }
        line += &details.message;
        if let Some(help) = &details.help {
            line += &format!("; {help}");
        }
        line
    }
}

fn key_and_value(key: &str, value: Option<&str>) -> String {
    match (key, value) {
        ("", _) => String::new(),
        (key, None) => format!("{key}: "),
        (key, Some(value)) => format!("{key} = {value}: "),
    }
}

/// A remark about a model that can be computed but may surprise.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// Which analyses it concerns.
    pub scope: Scope,
    /// Path of the key.
    pub key: String,
    /// Name of the file.
    pub source_name: String,
    /// Line of the key in the file, counted from 1; none if the value was set by an override or a program.
    pub line: Option<usize>,
    /// What may surprise and what to do.
    pub message: String,
}

/// Which analyses a [`Warning`] concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// All of them.
    Model,
    /// The steady state and the linear model, which leave something out.
    LinearModel,
    /// Motions with all elements, which leave something out.
    Motions,
}

impl fmt::Display for Warning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.source_name.is_empty() {
            write!(formatter, "{}:", self.source_name)?;
            if let Some(line) = self.line {
                write!(formatter, "{line}:")?;
            }
            write!(formatter, " ")?;
        }
        write!(formatter, "{}: {}", self.key, self.message)
    }
}

/// A mistake before it is known in which text it sits: the readers and checks report these.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Issue {
    pub problem: Problem,
    pub key: String,
    /// Where, if the reader knows; checks of finished models know the key only.
    pub origin: Option<Origin>,
    /// The offending value, if the message shows it.
    pub value: Option<String>,
    pub message: String,
    pub help: Option<String>,
}

impl Issue {
    pub fn new(problem: Problem, key: impl Into<String>, message: impl Into<String>) -> Box<Self> {
        Box::new(Self {
            problem,
            key: key.into(),
            origin: None,
            value: None,
            message: message.into(),
            help: None,
        })
    }

    pub fn wrong_value(key: impl Into<String>, message: impl Into<String>) -> Box<Self> {
        Self::new(Problem::WrongValue, key, message)
    }

    pub fn at(mut self: Box<Self>, origin: &Origin) -> Box<Self> {
        self.origin = Some(origin.clone());
        self
    }

    pub fn with_value(mut self: Box<Self>, value: impl fmt::Display) -> Box<Self> {
        self.value = Some(shown(&value.to_string()));
        self
    }

    pub fn with_number(mut self: Box<Self>, value: f64) -> Box<Self> {
        self.value = Some(number_text(value));
        self
    }

    pub fn with_help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }

    /// The error a user sees: with the file's name, line and text, or the override.
    pub fn in_source(self, source: &Source) -> ModelFileError {
        let place = match &self.origin {
            Some(Origin::Text(span)) => Some(source.place(span)),
            _ => None,
        };
        let setting = match &self.origin {
            Some(Origin::Setting(index)) => source.setting(*index).map(str::to_owned),
            _ => None,
        };
        ModelFileError(Box::new(Details {
            problem: self.problem,
            source_name: source.name().to_owned(),
            text: source.text_arc(),
            place,
            setting,
            // Quoted keys and names may hold line breaks; messages may not.
            key: printable(&self.key),
            value: self.value,
            message: printable(&self.message),
            help: self.help.as_deref().map(printable),
        }))
    }

    /// The error for a model that was changed by a program: without text and place.
    pub fn without_source(self) -> ModelFileError {
        self.in_source(&Source::none())
    }
}

/// A number as TOML writes it.
pub(crate) fn number_text(value: f64) -> String {
    if value.is_nan() {
        "nan".to_owned()
    } else {
        format!("{value:?}")
    }
}

/// The text with control characters replaced by blanks.
fn printable(text: &str) -> String {
    text.chars()
        .map(|character| if character.is_control() { ' ' } else { character })
        .collect()
}

/// A value for a message: on one line and not too long.
pub(crate) fn shown(value: &str) -> String {
    const LONGEST: usize = 60;
    let one_line = printable(&value.split_whitespace().collect::<Vec<_>>().join(" "));
    if one_line.chars().count() <= LONGEST {
        one_line
    } else {
        one_line.chars().take(LONGEST).chain(['…']).collect()
    }
}
