//! How a failure reaches the user: with the place in the file on a terminal, in one line otherwise.

use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};
use slackside_model_file::ModelFileError;
use slackside_report::ReportError;
use slackside_studies::StudyError;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;

/// Why the program ends without an answer, or with a part of it.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A study fails, or the model is wrong.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A table or figure cannot be made or written.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// The directory for results holds something else.
    #[error("--out {}: it exists and holds no results of slackside; choose another directory", .0.display())]
    ForeignDirectory(PathBuf),
    /// A file or directory cannot be written.
    #[error("`{}` could not be written: {source}", path.display())]
    Write {
        /// Which.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The answer cannot be turned into JSON.
    #[error("the answer could not be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The threads cannot be started.
    #[error("the threads could not be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A verb that reads no model was asked for tables and figures.
    #[error("this verb has no tables and figures")]
    NoAnswer,
    /// A recipe of a figure is wrong.
    #[error("{source_name}: {message}")]
    Recipe {
        /// The recipe's file.
        source_name: String,
        /// What is wrong, and what to do.
        message: String,
    },
    /// There is no such figure.
    #[error(
        "there is no figure {name}; `slackside figure` lists those there are (tables as table-4.1), and FILE.toml is a recipe of your own"
    )]
    UnknownFigure {
        /// What was asked for.
        name: String,
    },
    /// Figures were made, but do not show what their recipes say.
    #[error("not what the recipe expects: {}", .0.join("; "))]
    NotShown(Vec<String>),
    /// The answer was given, but it is not whole.
    #[error("interrupted: the answer holds what was finished")]
    Partial,
}

impl From<ModelFileError> for Failure {
    fn from(error: ModelFileError) -> Self {
        Self::Study(StudyError::Model(error))
    }
}

impl Failure {
    /// The program's exit status: 2 if the input is wrong, 1 otherwise.
    pub fn status(&self) -> u8 {
        match self {
            Self::Study(error) if error.is_input() => 2,
            Self::ForeignDirectory(_) | Self::Recipe { .. } | Self::UnknownFigure { .. } => 2,
            _ => 1,
        }
    }

    /// Prints the failure to standard error.
    pub fn print(&self) {
        let mut stderr = std::io::stderr().lock();
        let text = match self {
            Self::Study(StudyError::Model(error)) if stderr.is_terminal() => drawn(error),
            _ => None,
        };
        // There is nowhere left to tell that standard error is closed.
        let _ = match text {
            Some(text) => writeln!(stderr, "{text}"),
            None => writeln!(stderr, "error: {self}"),
        };
    }
}

/// The mistake drawn in the text of its file; `None` if its place is not in the text.
fn drawn(error: &ModelFileError) -> Option<String> {
    let place = error.place()?;
    let mut diagnostic = MietteDiagnostic::new(error.message())
        .with_label(LabeledSpan::at(place.span.clone(), error.key().to_owned()));
    if let Some(help) = error.help() {
        diagnostic = diagnostic.with_help(help);
    }
    let source = NamedSource::new(error.source_name(), error.text().to_owned());
    Some(format!("{:?}", Report::new(diagnostic).with_source_code(source)))
}
