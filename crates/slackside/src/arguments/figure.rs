//! Options of `figure`.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Clone, Args)]
pub struct FigureArguments {
    /// Numbers of figures (`2.5`), `all`, or recipe files (TOML); nothing lists the figures
    #[arg(value_name = "FIGURE")]
    pub which: Vec<String>,
    /// Folder in which every figure gets a folder of its own, replaced only as a whole
    #[arg(long, value_name = "DIR", default_value = "out", conflicts_with_all = ["json", "recipe"])]
    pub out: PathBuf,
    /// Prints one JSON document with what was measured, and draws nothing
    #[arg(long)]
    pub json: bool,
    /// Prints the recipe, to be changed for a drive of one's own
    #[arg(long, conflicts_with = "json")]
    pub recipe: bool,
    /// Number of threads; all cores by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Shows neither progress nor warnings
    #[arg(long)]
    pub quiet: bool,
}
