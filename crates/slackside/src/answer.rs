//! What is done with an answer: a summary, one JSON document, or a directory of tables and figures.

use crate::arguments::Common;
use crate::directory;
use crate::failure::Failure;
use slackside_report::{Figure, Table};
use slackside_studies::Header;
use std::io::{ErrorKind, Write};

/// An answer that can be shown and saved.
pub trait Answer {
    /// The head of the document.
    fn header(&self) -> &Header;

    /// The document as JSON text.
    ///
    /// # Errors
    /// The serialiser's error.
    fn json(&self) -> Result<String, serde_json::Error>;

    /// The summary for the terminal.
    fn summary(&self) -> String;

    /// Tables, each with its name.
    fn tables(&self) -> Vec<Table>;

    /// Figures by name.
    fn figures(&self) -> Vec<(String, Figure)>;
}

/// Pixels per CSS pixel of PNG files: 288 per inch.
pub const PNG_SCALE: f64 = 3.0;

/// Gives the answer as the options ask.
///
/// # Errors
/// [`Failure`]; [`Failure::Partial`] after an answer that was interrupted.
pub fn give(answer: &dyn Answer, common: &Common) -> Result<(), Failure> {
    if !common.quiet {
        let mut stderr = std::io::stderr().lock();
        for warning in &answer.header().warnings {
            // Warnings are also part of the document.
            let _ = writeln!(stderr, "warning: {warning}");
        }
    }
    if common.json {
        print(&(answer.json()? + "\n"))?;
    } else if let Some(out) = &common.out {
        directory::replace(out, &|folder| {
            let path = |name: &str, ending: &str| folder.join(format!("{name}.{ending}"));
            for table in answer.tables() {
                table.save_csv(&path(&table.name, "csv"))?;
                table.save_parquet(&path(&table.name, "parquet"))?;
            }
            for (name, figure) in answer.figures() {
                figure.save_svg(&path(&name, "svg"))?;
                figure.save_png(&path(&name, "png"), PNG_SCALE)?;
            }
            let json = answer.json()? + "\n";
            slackside_report::write_bytes(&folder.join(directory::RESULT), json.as_bytes())?;
            Ok(())
        })?;
        print(&format!("{}\nSaved in {}.\n", answer.summary(), out.display()))?;
    } else {
        print(&format!(
            "{}\nSave tables, figures and JSON with --out DIR; print JSON with --json.\n",
            answer.summary()
        ))?;
    }
    let interrupted = answer
        .header()
        .warnings
        .iter()
        .any(|w| w.starts_with("interrupted"));
    if interrupted {
        return Err(Failure::Partial);
    }
    Ok(())
}

/// Writes to standard output; a reader that has gone is no mistake.
///
/// # Errors
/// [`Failure::Write`].
pub fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::Write {
            path: "standard output".into(),
            source: error,
        }),
        _ => Ok(()),
    }
}
