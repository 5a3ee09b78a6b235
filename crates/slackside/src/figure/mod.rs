//! `figure`: runs the commands of a recipe, draws what it shows, measures what it must show and says it in one line.

mod columns;
mod library;
mod picture;
mod quantity;
mod recipe;
mod redraw;

use crate::answer::{PNG_SCALE, print};
use crate::arguments::FigureArguments;
use crate::directory;
use crate::failure::Failure;
use crate::session::Session;
use crate::table_text::table;
use library::Entry;
use redraw::{Redrawn, redraw};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Lists the figures, or makes those asked for.
///
/// # Errors
/// [`Failure`]; [`Failure::NotShown`] if all were made but one does not show what its recipe says.
pub fn run(options: &FigureArguments) -> Result<(), Failure> {
    let entries = chosen(&options.which)?;
    if options.which.is_empty() {
        return list(&entries, options.json);
    }
    if options.recipe {
        return entries.iter().try_for_each(|entry| print(&entry.text));
    }
    let session = Session::open(options.threads, options.quiet)?;
    let (mut documents, mut missed) = (Vec::new(), Vec::new());
    for entry in &entries {
        session.say(&format!("figure {}", entry.recipe.id));
        let redrawn = redraw(entry, &session.signal(), !options.json)?;
        if session.signal().is_interrupted() {
            return Err(Failure::Partial);
        }
        let missing = redrawn.missing();
        missed.extend(missing.map(|check| format!("figure {}: {check}", entry.recipe.id)));
        if options.json {
            documents.push(document(entry, &redrawn));
            continue;
        }
        let folder = options.out.join(format!("figure_{}", entry.recipe.id));
        save(&folder, entry, &redrawn)?;
        session.suspend(|| tell(entry, &redrawn, &folder))?;
    }
    session.close();
    if options.json {
        let all = json!({
            "slackside": env!("CARGO_PKG_VERSION"),
            "command": "figure",
            "figures": documents,
        });
        print(&format!("{all}\n"))?;
    }
    if missed.is_empty() {
        Ok(())
    } else {
        Err(Failure::NotShown(missed))
    }
}

/// The recipes asked for: by number, all, or files.
fn chosen(which: &[String]) -> Result<Vec<Entry>, Failure> {
    let mut known = library::recipes()?;
    if which.is_empty() || which.iter().any(|name| name == "all") {
        return Ok(known);
    }
    let mut chosen = Vec::new();
    for name in which {
        if name.ends_with(".toml") {
            chosen.push(library::own_recipe(Path::new(name))?);
            continue;
        }
        let place = known.iter().position(|entry| entry.recipe.id == *name);
        match place {
            Some(place) => chosen.push(known.remove(place)),
            None => return Err(Failure::UnknownFigure { name: name.clone() }),
        }
    }
    Ok(chosen)
}

/// All figures with their titles.
fn list(entries: &[Entry], as_json: bool) -> Result<(), Failure> {
    if as_json {
        let figures = entries.iter().map(|entry| {
            let recipe = &entry.recipe;
            json!({"id": recipe.id, "title": recipe.title, "phenomenon": recipe.phenomenon})
        });
        let all = json!({
            "slackside": env!("CARGO_PKG_VERSION"),
            "command": "figure",
            "known": figures.collect::<Vec<Value>>(),
        });
        return print(&format!("{all}\n"));
    }
    let width = entries
        .iter()
        .map(|entry| entry.recipe.id.chars().count())
        .max()
        .unwrap_or(0);
    let lines = entries.iter().map(|entry| {
        let recipe = &entry.recipe;
        format!("{:width$}  {}\n", recipe.id, recipe.title)
    });
    let lines: String = lines.collect();
    print(&format!(
        "{lines}\nMake one with `slackside figure {}`, all with `slackside figure all`; `--recipe` prints a recipe to be changed.\n",
        entries.first().map_or("ID", |entry| entry.recipe.id.as_str())
    ))
}

/// The result as JSON.
fn document(entry: &Entry, redrawn: &Redrawn) -> Value {
    let recipe = &entry.recipe;
    json!({
        "id": recipe.id,
        "title": recipe.title,
        "phenomenon": recipe.phenomenon,
        "meaning": recipe.meaning.trim(),
        "recipe": entry.source_name,
        "commands": recipe.commands.iter().map(|command| command.run.trim()).collect::<Vec<_>>(),
        "inputs": redrawn.inputs,
        "finding": redrawn.finding,
        "shown": redrawn.missing().next().is_none(),
        "checks": redrawn.checks.iter().map(|(check, holds)| json!({"check": check, "holds": holds})).collect::<Vec<_>>(),
        "quantities": redrawn.quantities,
        "warnings": redrawn.warnings,
    })
}

/// Writes figures, tables, recipe and result into a folder, as a whole.
fn save(folder: &Path, entry: &Entry, redrawn: &Redrawn) -> Result<(), Failure> {
    directory::replace(folder, &|folder| {
        let path = |name: &str, ending: &str| -> PathBuf { folder.join(format!("{name}.{ending}")) };
        for (name, figure) in &redrawn.figures {
            figure.save_svg(&path(name, "svg"))?;
            figure.save_png(&path(name, "png"), PNG_SCALE)?;
        }
        for table in &redrawn.tables {
            table.save_csv(&path(&table.name, "csv"))?;
            table.save_parquet(&path(&table.name, "parquet"))?;
        }
        slackside_report::write_bytes(&folder.join("recipe.toml"), entry.text.as_bytes())?;
        let text = format!("{:#}\n", document(entry, redrawn));
        slackside_report::write_bytes(&folder.join(directory::RESULT), text.as_bytes())?;
        Ok(())
    })
}

/// The line of the finding, printed tables and the place of the files.
fn tell(entry: &Entry, redrawn: &Redrawn, folder: &Path) -> Result<(), Failure> {
    let mut text = String::new();
    for (head, rows) in &redrawn.printed {
        let head: Vec<&str> = head.iter().map(String::as_str).collect();
        text += &table(&head, rows.clone());
        text += "\n";
    }
    text += &format!("Figure {}: {}\n", entry.recipe.id, redrawn.finding);
    text += &format!("  {}\n", folder.display());
    print(&text)
}
