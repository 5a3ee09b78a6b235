//! A model file: its text, the overrides applied to it, and the model it describes.

use std::path::Path;

use crate::error::{Issue, ModelFileError, Problem, Scope, Warning, shown};
use crate::model::Model;
use crate::nearest::{enumerate, nearest};
use crate::node::{DEEPEST, Entry, Node, Value, item_index, too_deep};
use crate::reader::Read;
use crate::source::{Origin, Source};

/// A parsed model file with its overrides.
///
/// ```
/// use slackside_model_file::Document;
/// let text = r#"
/// kind = "two-pulley-clutch"
/// [physical]
/// pulley_inertia    = "2e-4 kg m^2"
/// accessory_inertia = "3.2e-4 kg m^2"
/// pulley_radius     = "30 mm"
/// crank_radius      = "60 mm"
/// belt_stiffness    = "4e4 N/m"
/// clutch_stiffness  = "332 N m/rad"
/// preload           = "13.8 N m"
/// crank_amplitude   = 0.05
/// damping_ratio     = 0.03
/// "#;
/// let mut document = Document::parse("drive.toml", text)?;
/// document.set("physical.preload", "4.5 N m")?;
/// let (model, warnings) = document.model()?;
/// assert_eq!(model.number("physical.preload")?, 4.5);
/// assert!(warnings.is_empty());
///
/// document.set("physical.preload", "0 N m")?;
/// assert_eq!(
///     document.model().unwrap_err().to_string(),
///     "--set physical.preload=0 N m: no preload: the clutch has no engaged equilibrium; give a value greater than zero"
/// );
/// # Ok::<(), slackside_model_file::ModelFileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Document {
    source: Source,
    root: Node,
}

impl Document {
    /// Reads and parses a file.
    ///
    /// # Errors
    /// [`Problem::Unreadable`] or [`Problem::Syntax`].
    pub fn read(path: &Path) -> Result<Self, ModelFileError> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|error| {
            Issue::new(Problem::Unreadable, "", format!("cannot read the file: {error}"))
                .in_source(&Source::new(&name, ""))
        })?;
        Self::parse(&name, &text)
    }

    /// Parses a text; `source_name` is the name that messages give it.
    ///
    /// # Errors
    /// [`Problem::Syntax`].
    pub fn parse(source_name: &str, text: &str) -> Result<Self, ModelFileError> {
        let source = Source::new(source_name, text);
        match Node::parse(&source) {
            Ok(root) => Ok(Self { source, root }),
            Err(issue) => Err(issue.in_source(&source)),
        }
    }

    /// Name of the file, as it was given.
    pub fn source_name(&self) -> &str {
        self.source.name()
    }

    /// Whole text of the file.
    pub fn text(&self) -> &str {
        self.source.text()
    }

    /// The overrides so far, as `KEY=VALUE`.
    pub fn settings(&self) -> &[String] {
        self.source.settings()
    }

    /// Replaces or adds the value of a key.
    ///
    /// `key` is a path with dots; items of lists go by their name or by their position from zero
    /// (`element.clutch.law.stiffness`, `mass.0.1`). `value` is a TOML value, or a text without quotes (`6 N m`).
    /// Whether the value is sound is decided by [`Document::model`], because several overrides may belong together.
    ///
    /// # Errors
    /// [`Problem::UnknownKey`] if the model cannot have the key, [`Problem::WrongType`] if the path leads through a
    /// value that is not a table or list. The document is then unchanged.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), ModelFileError> {
        let mut source = self.source.clone();
        let origin = source.add_setting(format!("{}={}", key.trim(), value.trim()));
        let changed = self
            .root_with(key.trim(), value, &origin)
            .map_err(|issue| issue.at(&origin).in_source(&source))?;
        if let Err(issue) = Model::read(&changed)
            && issue.problem == Problem::UnknownKey
            && issue.origin.as_ref() == Some(&origin)
        {
            return Err(issue.in_source(&source));
        }
        self.root = changed;
        self.source = source;
        Ok(())
    }

    /// The model that the file and its overrides describe, and what may surprise about it.
    ///
    /// # Errors
    /// [`ModelFileError`] for the first mistake that is found.
    pub fn model(&self) -> Result<(Model, Vec<Warning>), ModelFileError> {
        let model = Model::read(&self.root)
            .and_then(|model| {
                model.check().map_err(|issue| self.located(issue))?;
                model.check_layout().map_err(|issue| self.located(issue))?;
                Ok(model)
            })
            .map_err(|issue| issue.in_source(&self.source))?;
        let of = |scope: Scope, cautions: Vec<(String, String)>| {
            cautions
                .into_iter()
                .map(move |(key, message)| self.warning(scope, key, message))
        };
        let warnings = of(Scope::Model, model.cautions())
            .chain(of(Scope::LinearModel, model.cautions_of_linear_model()))
            .chain(of(Scope::Motions, model.cautions_of_motions()))
            .collect();
        Ok((model, warnings))
    }

    /// A complaint about a finished model, with the place and the text of the value.
    fn located(&self, mut issue: Box<Issue>) -> Box<Issue> {
        if let Some(node) = self.root.find(&issue.key) {
            issue.value = issue.value.map(|_| node.shown());
        }
        let origin = self.root.origin_of(&issue.key);
        issue.at(origin)
    }

    fn warning(&self, scope: Scope, key: String, message: String) -> Warning {
        let line = match self.root.origin_of(&key) {
            Origin::Text(span) => Some(self.source.place(span).line),
            Origin::Setting(_) => None,
        };
        Warning {
            scope,
            key,
            source_name: self.source.name().to_owned(),
            line,
            message,
        }
    }

    fn root_with(&self, key: &str, value: &str, origin: &Origin) -> Read<Node> {
        if key.split('.').any(|part| part.trim().is_empty()) {
            return Err(
                Issue::new(Problem::UnknownKey, key, "a key is missing before or after a dot")
                    .with_help("write KEY=VALUE, for example dimensionless.preload=0.5"),
            );
        }
        if key.split('.').count() > DEEPEST {
            return Err(too_deep());
        }
        let value = Node::parse_setting(value, origin)?;
        let mut root = self.root.clone();
        insert(&mut root, key, value, origin)?;
        Ok(root)
    }
}

/// Puts a value at a path; tables that are missing on the way are created.
fn insert(root: &mut Node, path: &str, value: Node, origin: &Origin) -> Read<()> {
    let mut node = root;
    let mut done = String::new();
    for key in path.split('.') {
        let described = node.type_name();
        let parent = if done.is_empty() { "the file" } else { &*done };
        node = match &mut node.value {
            Value::Table(entries) => table_slot(entries, key, origin),
            Value::Array(items) => match item_index(items, key) {
                Some(index) => &mut items[index],
                None => return Err(no_item(path, parent, key, items)),
            },
            _ => {
                return Err(Issue::new(
                    Problem::WrongType,
                    path,
                    format!("{parent} is {described}, which has no key \"{key}\""),
                )
                .with_help(format!("set {parent} itself")));
            }
        };
        if !done.is_empty() {
            done.push('.');
        }
        done.push_str(key);
    }
    *node = value;
    Ok(())
}

/// The value of a key, created as an empty table if the key is new.
fn table_slot<'a>(entries: &'a mut Vec<Entry>, key: &str, origin: &Origin) -> &'a mut Node {
    let index = match entries.iter().position(|entry| entry.key == key) {
        Some(index) => index,
        None => {
            entries.push(Entry {
                key: key.to_owned(),
                key_origin: origin.clone(),
                node: Node {
                    value: Value::Table(Vec::new()),
                    origin: origin.clone(),
                },
            });
            entries.len() - 1
        }
    };
    &mut entries[index].node
}

fn no_item(path: &str, list: &str, key: &str, items: &[Node]) -> Box<Issue> {
    let names: Vec<&str> = items
        .iter()
        .filter_map(|item| match item.child("name").map(|name| &name.value) {
            Some(Value::Text(name)) => Some(&**name),
            _ => None,
        })
        .collect();
    let help = match (nearest(key, names.iter().copied()), items.len()) {
        (Some(meant), _) => format!("did you mean \"{meant}\"?"),
        (None, 0) => format!("{list} is empty"),
        (None, count) if names.is_empty() => format!("its items are 0 to {}", count - 1),
        (None, _) => format!("its items are {}", enumerate(names)),
    };
    Issue::new(
        Problem::UnknownKey,
        path,
        format!("{list} has no item \"{}\"", shown(key)),
    )
    .with_help(help)
}
