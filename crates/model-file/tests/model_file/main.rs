//! Model files as users write them: examples, messages, overrides, numbers, schema, arbitrary texts.

mod examples;
mod fuzz;
mod messages;
mod numbers;
mod overrides;
mod schema;
mod system;

use slackside_model_file::{Document, Model, Warning};

/// Name and text of every file in the examples directory.
fn example_files() -> Vec<(String, String)> {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let mut files: Vec<_> = std::fs::read_dir(directory)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| {
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            (name, std::fs::read_to_string(path).unwrap())
        })
        .collect();
    files.sort();
    assert!(files.len() >= 7);
    files
}

fn example(name: &str) -> String {
    let mut files = example_files().into_iter();
    files.find(|(file, _)| file == name).unwrap().1
}

fn read(text: &str) -> (Model, Vec<Warning>) {
    Document::parse("test.toml", text).unwrap().model().unwrap()
}

/// The one-line message for a text that is not a sound model.
fn message(text: &str) -> String {
    let result = Document::parse("test.toml", text).and_then(|document| document.model());
    result.unwrap_err().to_string()
}

const DIMENSIONLESS: &str = r#"kind = "two-pulley-clutch"
[dimensionless]
inertia_ratio = 1.6
radius_ratio = 2.0
belt_stiffness = 2.6
clutch_stiffness = 24.0
preload = 1.0
crank_amplitude = 0.05
damping_ratio = 0.03
"#;

const PHYSICAL: &str = r#"kind = "two-pulley-clutch"
[physical]
pulley_inertia = "2e-4 kg m^2"
accessory_inertia = "3.2e-4 kg m^2"
pulley_radius = "30 mm"
crank_radius = "60 mm"
belt_stiffness = "4e4 N/m"
clutch_stiffness = "332 N m/rad"
preload = "13.8 N m"
crank_amplitude = "0.05 rad"
damping_ratio = 0.03
"#;

const MATRICES: &str = r#"kind = "mechanical-system"
coordinates = ["pulley", "accessory"]
mass = [[1.0, 0.0], [0.0, 1.6]]
damping = [[0.1, 0.0], [0.0, 0.1]]
stiffness = [[2.6, 0.0], [0.0, 0.0]]
[[element]]
name = "clutch"
port = { pulley = 1.0, accessory = -1.0 }
law = { kind = "wrap-spring", stiffness = 24.0 }
[excitation]
frequency = 5.5
constant = { pulley = 1.0, accessory = -1.0 }
harmonics = [{ order = 1, cos = { pulley = 0.26 } }]
[[output]]
name = "tension"
displacement = { pulley = 1.0 }
"#;

/// `text` with one line replaced: the line that starts with `start`.
fn with_line(text: &str, start: &str, line: &str) -> String {
    let mut replaced = 0;
    let lines: Vec<&str> = text
        .lines()
        .map(|old| {
            if old.starts_with(start) {
                replaced += 1;
                line
            } else {
                old
            }
        })
        .collect();
    assert_eq!(replaced, 1, "{start} must start exactly one line");
    lines.join("\n") + "\n"
}
