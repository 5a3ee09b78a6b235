//! One recipe carried out.

use super::columns::{column, texts};
use super::library::{self, Entry};
use super::picture;
use super::quantity::{Quantities, holds, measure, sentence};
use super::recipe::{CommandLine, Show};
use crate::answer::Answer;
use crate::arguments::Arguments;
use crate::ask;
use crate::failure::Failure;
use crate::table_text::with_unit;
use clap::Parser;
use slackside_report::{Figure, Table};
use slackside_studies::Signal;

/// What a recipe gives.
pub struct Redrawn {
    /// Figures by file name; none if they were not wanted.
    pub figures: Vec<(String, Figure)>,
    /// Tables that are saved.
    pub tables: Vec<Table>,
    /// Tables that are printed: head and rows.
    pub printed: Vec<(Vec<String>, Vec<Vec<String>>)>,
    /// Quantities by name.
    pub quantities: Quantities,
    /// The conditions, and whether each holds.
    pub checks: Vec<(String, bool)>,
    /// The sentence.
    pub finding: String,
    /// Hashes of the resolved models, in the order of the commands.
    pub inputs: Vec<String>,
    /// Warnings of the commands.
    pub warnings: Vec<String>,
}

impl Redrawn {
    /// The conditions that do not hold.
    pub fn missing(&self) -> impl Iterator<Item = &String> {
        self.checks
            .iter()
            .filter(|(_, holds)| !holds)
            .map(|(check, _)| check)
    }
}

/// A command that has been carried out.
struct Done<'a> {
    line: &'a CommandLine,
    answer: Box<dyn Answer>,
    tables: Vec<Table>,
}

/// Carries out the commands of a recipe and measures.
///
/// # Errors
/// [`Failure`] of a command; [`Failure::Recipe`] if the recipe asks for what its commands do not give.
pub fn redraw(entry: &Entry, signal: &Signal, draw: bool) -> Result<Redrawn, Failure> {
    let recipe = &entry.recipe;
    let fault = |message: String| Failure::Recipe {
        source_name: entry.source_name.clone(),
        message,
    };
    let mut done = Vec::new();
    for line in &recipe.commands {
        let answer = carry_out(entry, line, signal)?;
        let tables = answer.tables();
        done.push(Done { line, answer, tables });
    }
    let table = |command: &str, name: &str| {
        let done = of(&done, command)?;
        let found = done.tables.iter().find(|table| table.name == name);
        found.ok_or_else(|| {
            let known: Vec<&str> = done.tables.iter().map(|table| table.name.as_str()).collect();
            format!(
                "the command \"{command}\" gives no table \"{name}\"; it gives {}",
                known.join(", ")
            )
        })
    };
    let mut quantities = Quantities::new();
    for quantity in &recipe.quantities {
        let source = table(&quantity.command, &quantity.table).map_err(fault)?;
        measure(quantity, source, &mut quantities)
            .map_err(|message| fault(format!("quantity \"{}\": {message}", quantity.name)))?;
    }
    let finding = sentence(&recipe.finding, &quantities).map_err(fault)?;
    let checks = recipe
        .checks
        .iter()
        .map(|check| Ok((check.clone(), holds(check, &quantities)?)));
    let checks = checks.collect::<Result<_, String>>().map_err(fault)?;
    let mut redrawn = Redrawn {
        figures: Vec::new(),
        tables: Vec::new(),
        printed: Vec::new(),
        quantities,
        checks,
        finding,
        inputs: done
            .iter()
            .map(|done| done.answer.header().input.sha256.clone())
            .collect(),
        warnings: done
            .iter()
            .flat_map(|done| done.answer.header().warnings.clone())
            .collect(),
    };
    if !draw {
        return Ok(redrawn);
    }
    for show in &recipe.shown {
        if let Some(name) = &show.table {
            let source = table(&show.command, name).map_err(fault)?;
            redrawn.printed.push(printed(show, source).map_err(fault)?);
        }
        if let Some(name) = &show.figure {
            let figures = of(&done, &show.command).map_err(fault)?.answer.figures();
            let known = figures
                .iter()
                .map(|(known, _)| known.clone())
                .collect::<Vec<_>>()
                .join(", ");
            let found = figures.into_iter().find(|(known, _)| known == name);
            let (_, figure) = found.ok_or_else(|| {
                fault(format!(
                    "the command \"{}\" gives no figure \"{name}\"; it gives {known}",
                    show.command
                ))
            })?;
            let file = show.name.clone().unwrap_or_else(|| joined(&show.command, name));
            redrawn.figures.push((file, picture::cut(figure, show)));
        }
    }
    for plot in &recipe.plots {
        let figure = picture::draw(plot, &table)
            .map_err(|message| fault(format!("plot \"{}\": {message}", plot.name)))?;
        redrawn.figures.push((plot.name.clone(), figure));
    }
    for done in done {
        let wanted = |table: &Table| {
            done.line
                .tables
                .as_ref()
                .is_none_or(|names| names.contains(&table.name))
        };
        let named = |table: Table| Table {
            name: joined(&done.line.name, &table.name),
            ..table
        };
        // A table without rows tells nothing.
        let tables = done
            .tables
            .into_iter()
            .filter(|table| wanted(table) && table.rows() > 0);
        redrawn.tables.extend(tables.map(named));
    }
    Ok(redrawn)
}

/// Reads the command as the command line does and runs it.
fn carry_out(entry: &Entry, line: &CommandLine, signal: &Signal) -> Result<Box<dyn Answer>, Failure> {
    let fault = |message: String| Failure::Recipe {
        source_name: entry.source_name.clone(),
        message: format!("command `{}`: {message}", line.run.trim()),
    };
    let words = shlex::split(&line.run).ok_or_else(|| fault("a quotation mark is not closed".to_owned()))?;
    if words.first().map(String::as_str) != Some("slackside") {
        return Err(fault("it must begin with `slackside`".to_owned()));
    }
    let arguments = Arguments::try_parse_from(words).map_err(|error| fault(error.to_string()))?;
    let common = arguments.verb.common();
    if common.is_some_and(|common| common.json || common.out.is_some() || common.threads.is_some()) {
        return Err(fault(
            "leave out --json, --out and --threads; `figure` has them itself".to_owned(),
        ));
    }
    let read = if entry.is_embedded {
        library::embedded_model
    } else {
        library::own_model
    };
    ask::answer(arguments.verb, &read, signal)
}

/// A command by name.
fn of<'a, 'b>(done: &'a [Done<'b>], name: &str) -> Result<&'a Done<'b>, String> {
    let found = done.iter().find(|done| done.line.name == name);
    found.ok_or_else(|| format!("there is no command \"{name}\""))
}

/// The columns of a table that are printed.
fn printed(show: &Show, source: &Table) -> Result<(Vec<String>, Vec<Vec<String>>), String> {
    let columns = match &show.columns {
        Some(names) => names
            .iter()
            .map(|name| column(source, name))
            .collect::<Result<Vec<_>, String>>()?,
        None => source.columns.iter().collect(),
    };
    let head = columns
        .iter()
        .map(|column| with_unit(&column.name, &column.unit))
        .collect();
    let cells: Vec<Vec<String>> = columns.into_iter().map(texts).collect();
    let rows = (0..source.rows()).map(|row| cells.iter().map(|cells| cells[row].clone()).collect());
    Ok((head, rows.collect()))
}

/// Command and name as one; the name alone where the command has none.
fn joined(command: &str, name: &str) -> String {
    if command.is_empty() {
        name.to_owned()
    } else {
        format!("{command}_{name}")
    }
}
