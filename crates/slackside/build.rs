//! Embeds the recipes of `figures/` and the models that they name, so that `slackside figure` works from anywhere.

use std::fmt::Write;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let manifest = std::env::var("CARGO_MANIFEST_DIR")?;
    let root = Path::new(&manifest).join("../..").canonicalize()?;
    let mut files = Vec::new();
    for folder in ["figures", "examples"] {
        println!("cargo::rerun-if-changed={}", root.join(folder).display());
        collect(&root.join(folder), &mut files)?;
    }
    files.sort();
    let mut code = String::from("&[\n");
    for file in &files {
        let name = file.strip_prefix(&root)?.components();
        let name: Vec<String> = name
            .map(|part| part.as_os_str().to_string_lossy().into_owned())
            .collect();
        writeln!(
            code,
            "    ({:?}, include_str!({:?})),",
            name.join("/"),
            file.display().to_string()
        )?;
    }
    code += "]\n";
    let out = std::env::var("OUT_DIR")?;
    std::fs::write(Path::new(&out).join("embedded.rs"), code)?;
    Ok(())
}

/// All TOML files below a folder.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            // A folder says itself when a file is added to it.
            println!("cargo::rerun-if-changed={}", path.display());
            collect(&path, files)?;
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            files.push(path);
        }
    }
    Ok(())
}
