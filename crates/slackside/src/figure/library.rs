//! What the program carries: the recipes of `figures/` and all models that they name.

use super::recipe::Recipe;
use crate::failure::Failure;
use slackside_model_file::{Document, ModelFileError};
use std::path::Path;

/// Files by their path from the root of the repository.
const EMBEDDED: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/embedded.rs"));

/// A recipe with its text.
pub struct Entry {
    /// Where it comes from.
    pub source_name: String,
    /// Its text.
    pub text: String,
    /// The same, read.
    pub recipe: Recipe,
    /// Whether it is one of the program's own.
    pub is_embedded: bool,
}

/// All recipes of the program in the order of their numbers.
///
/// # Errors
/// [`Failure::Recipe`].
pub fn recipes() -> Result<Vec<Entry>, Failure> {
    let of_folder = |name: &str| {
        let rest = name.strip_prefix("figures/")?;
        (!rest.contains('/')).then_some(())
    };
    let files = EMBEDDED.iter().filter(|(name, _)| of_folder(name).is_some());
    let mut entries = files
        .map(|(name, text)| entry(name, text, true))
        .collect::<Result<Vec<Entry>, Failure>>()?;
    entries.sort_by_key(|entry| order(&entry.recipe.id));
    Ok(entries)
}

/// A recipe of a user's.
///
/// # Errors
/// [`Failure::Recipe`] if it cannot be read.
pub fn own_recipe(path: &Path) -> Result<Entry, Failure> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| Failure::Recipe {
        source_name: name.clone(),
        message: format!("cannot read the file: {error}"),
    })?;
    entry(&name, &text, false)
}

fn entry(name: &str, text: &str, is_embedded: bool) -> Result<Entry, Failure> {
    Ok(Entry {
        source_name: name.to_owned(),
        text: text.to_owned(),
        recipe: Recipe::parse(name, text)?,
        is_embedded,
    })
}

/// Numbers in an id count as numbers: 2.5 stands before 2.10.
fn order(id: &str) -> Vec<(u32, String)> {
    let parts = id.split(['.', '-']);
    parts
        .map(|part| match part.parse() {
            Ok(number) => (number, String::new()),
            Err(_) => (0, part.to_owned()),
        })
        .collect()
}

/// A model of the program's own recipes.
///
/// # Errors
/// As [`Document::read`] for a name that is not embedded.
pub fn embedded_model(path: &Path) -> Result<Document, ModelFileError> {
    let name = path.to_string_lossy();
    match EMBEDDED.iter().find(|(known, _)| *known == name) {
        Some((known, text)) => Document::parse(known, text),
        None => Document::read(path),
    }
}

/// A model of a user's recipe: the file if it is there, otherwise one of the program's own.
///
/// # Errors
/// As [`Document::read`].
pub fn own_model(path: &Path) -> Result<Document, ModelFileError> {
    if path.exists() {
        Document::read(path)
    } else {
        embedded_model(path)
    }
}
