//! Draws every kind of figure with synthetic data, for looking at them:
//! `cargo run -p slackside-report --example gallery -- DIRECTORY`.

#[path = "../tests/samples/mod.rs"]
mod samples;

use std::path::Path;

use slackside_report::ReportError;
use slackside_report::plot::Width;

fn main() -> Result<(), ReportError> {
    let directory = std::env::args().nth(1).unwrap_or_else(|| "gallery".to_string());
    let directory = Path::new(&directory);
    std::fs::create_dir_all(directory).map_err(|source| ReportError::Write {
        path: directory.to_path_buf(),
        source,
    })?;
    for (width, suffix) in [(Width::Single, "single"), (Width::Double, "double")] {
        for (name, figure) in samples::all(width) {
            figure.save_svg(&directory.join(format!("{name}-{suffix}.svg")))?;
            figure.save_png(&directory.join(format!("{name}-{suffix}.png")), 2.5)?;
        }
    }
    Ok(())
}
