//! The recipe of a figure: commands as a user types them, what of their answers is shown, and what it must show.

use crate::failure::Failure;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A recipe as it is read from TOML.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Number of the figure, or a name.
    pub id: String,
    /// What is shown, in a few words.
    pub title: String,
    /// The phenomenon that must be visible.
    pub phenomenon: String,
    /// What it means for somebody who designs a drive.
    pub meaning: String,
    /// One line with what was measured; `{EXPRESSION}` or `{EXPRESSION:DIGITS}` stands for a number.
    pub finding: String,
    /// What must hold: expressions in the measured quantities, joined by `<`.
    pub checks: Vec<String>,
    /// The commands.
    #[serde(rename = "command")]
    pub commands: Vec<CommandLine>,
    /// Figures and tables of the commands that are shown.
    #[serde(rename = "show", default)]
    pub shown: Vec<Show>,
    /// Figures drawn from columns of the commands' tables.
    #[serde(rename = "plot", default)]
    pub plots: Vec<Plot>,
    /// What is measured.
    #[serde(rename = "quantity", default)]
    pub quantities: Vec<Quantity>,
}

/// A command.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CommandLine {
    /// By which the rest of the recipe refers to it; may be left out where there is only one.
    #[serde(default)]
    pub name: String,
    /// The command as it is typed.
    pub run: String,
    /// Tables that are saved; all without it.
    pub tables: Option<Vec<String>>,
}

/// A figure of a command, by its name under `--out`, or a table to be printed.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Show {
    /// Name of the command.
    #[serde(default)]
    pub command: String,
    /// Name of the figure.
    pub figure: Option<String>,
    /// Name of the table.
    pub table: Option<String>,
    /// Columns of the table; all without it.
    pub columns: Option<Vec<String>>,
    /// Name of the file; otherwise that of command and figure.
    pub name: Option<String>,
    /// Part of the x axis to be shown.
    pub x: Option<[f64; 2]>,
    /// Part of the y axis to be shown.
    pub y: Option<[f64; 2]>,
}

/// Which rows of a table count: a text or number that a column must equal, or a text `> 5`, `>= 5`, `< 5`, `<= 5`.
pub type Filter = BTreeMap<String, toml::Value>;

/// A figure drawn from tables.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plot {
    /// Name of the file.
    pub name: String,
    /// How the rows are drawn.
    #[serde(default)]
    pub style: Style,
    /// Horizontal axis.
    pub x: PlotAxis,
    /// Vertical axis.
    pub y: PlotAxis,
    /// Where the rows come from.
    #[serde(rename = "curve")]
    pub curves: Vec<PlotCurve>,
}

/// How the rows of a plot are drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Style {
    /// Curves that differ in colour and dash pattern.
    #[default]
    Curves,
    /// Branches: unstable parts dashed where the table has a column `stable`.
    Branches,
    /// Points.
    Points,
    /// Upright lines.
    Stems,
    /// A curve for each row over the columns of the curve, which stand at the names of the x axis.
    Profiles,
}

/// An axis of a plot.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlotAxis {
    /// A column, or an expression in columns, in braces where their names have dots: `2*{windup.rms}`.
    #[serde(default)]
    pub value: String,
    /// What stands at the axis; the column's name in words without it.
    pub label: Option<String>,
    /// The unit; that of the column without it.
    pub unit: Option<String>,
    /// Part to be shown.
    pub limits: Option<[f64; 2]>,
    /// Names of the places of profiles.
    #[serde(default)]
    pub names: Vec<String>,
    /// Whether the axis is logarithmic.
    #[serde(default)]
    pub logarithmic: bool,
}

/// Rows of a plot.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlotCurve {
    /// Name of the command.
    #[serde(default)]
    pub command: String,
    /// Name of the table.
    pub table: String,
    /// Which rows.
    #[serde(default, rename = "where")]
    pub filter: Filter,
    /// A column that tells the members of a family: a curve for each of its values.
    pub split: Option<String>,
    /// Name in the legend; `{}` stands for the value that tells the member.
    #[serde(default)]
    pub name: String,
    /// What stands upwards, if not what the axis says.
    pub y: Option<String>,
    /// Whether rows are put in the order of x.
    #[serde(default)]
    pub sort: bool,
    /// Columns of a profile.
    #[serde(default)]
    pub columns: Vec<String>,
}

/// A measured quantity: numbers out of a table. Several are called `name_1`, `name_2`, …
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// Its name in expressions.
    pub name: String,
    /// Name of the command.
    #[serde(default)]
    pub command: String,
    /// Name of the table.
    pub table: String,
    /// Which rows.
    #[serde(default, rename = "where")]
    pub filter: Filter,
    /// A column, or an expression in columns.
    #[serde(default)]
    pub value: String,
    /// What is taken of its values.
    #[serde(default)]
    pub take: Take,
    /// Of `max`, `min` and `jump`: the column whose value there is called `NAME_at`. Of `crossing`: the column that passes
    /// the level.
    pub at: Option<String>,
    /// Of `crossing`: the level.
    pub level: Option<f64>,
}

/// What is taken of the values of a quantity.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Take {
    /// All of them, in rising order.
    #[default]
    All,
    /// The first row's.
    First,
    /// The last row's.
    Last,
    /// The largest.
    Max,
    /// The smallest.
    Min,
    /// The mean.
    Mean,
    /// The number of rows.
    Count,
    /// Largest step up between a row and the next: `NAME_from` and `NAME_to`.
    JumpUp,
    /// Largest step down between a row and the next.
    JumpDown,
    /// The values where the column `at` passes the level, by straight lines between rows.
    Crossing,
}

impl Recipe {
    /// Reads a recipe.
    ///
    /// # Errors
    /// [`Failure::Recipe`] with the place of the mistake.
    pub fn parse(source_name: &str, text: &str) -> Result<Self, Failure> {
        let recipe: Self = toml::from_str(text).map_err(|error| Failure::Recipe {
            source_name: source_name.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        let fault = |message: &str| Failure::Recipe {
            source_name: source_name.to_owned(),
            message: message.to_owned(),
        };
        let is_plain = |name: &str| name.chars().all(|c| c.is_alphanumeric() || "._-".contains(c));
        if recipe.id.is_empty() || !is_plain(&recipe.id) {
            return Err(fault(
                "`id` becomes a folder: letters, digits, `.`, `-` and `_` only",
            ));
        }
        let mut names = recipe
            .commands
            .iter()
            .map(|command| &command.name)
            .collect::<Vec<_>>();
        names.sort();
        if names.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(fault("two commands have the same name"));
        }
        let files = recipe.plots.iter().map(|plot| &plot.name);
        let files = files.chain(recipe.shown.iter().filter_map(|show| show.name.as_ref()));
        let tables = recipe.commands.iter().map(|command| &command.name);
        if !files.chain(tables).all(|name| is_plain(name)) {
            return Err(fault(
                "names become files: letters, digits, `.`, `-` and `_` only",
            ));
        }
        if recipe.shown.is_empty() && recipe.plots.is_empty() {
            return Err(fault("nothing is shown; add a [[show]] or a [[plot]]"));
        }
        if recipe.checks.is_empty() {
            return Err(fault(
                "`checks` is empty; say what must hold, for example `fold_low < fold_high`",
            ));
        }
        Ok(recipe)
    }
}
