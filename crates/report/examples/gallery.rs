//! Draws every kind of figure with synthetic data, for looking at them:
//! `cargo run -p slackside-report --example gallery -- DIRECTORY`.

#[path = "../tests/samples/mod.rs"]
mod samples;

use std::path::Path;

use slackside_report::plot::Width;
use slackside_report::{ReportError, write_atomically};

fn main() -> Result<(), ReportError> {
    let directory = std::env::args().nth(1).unwrap_or_else(|| "gallery".to_string());
    let directory = Path::new(&directory);
    std::fs::create_dir_all(directory).map_err(|source| ReportError::Write {
        path: directory.to_path_buf(),
        source,
    })?;
    for (width, suffix) in [(Width::Single, "single"), (Width::Double, "double")] {
        for (name, figure) in samples::all(width) {
            for (ending, bytes) in [("svg", figure.svg().into_bytes()), ("png", figure.png(2.5)?)] {
                let path = directory.join(format!("{name}-{suffix}.{ending}"));
                write_atomically(&path, |out| {
                    out.write_all(&bytes).map_err(|source| ReportError::Write {
                        path: path.clone(),
                        source,
                    })
                })?;
            }
        }
    }
    Ok(())
}
