//! Model files as users write them: examples, messages, overrides, numbers, schema, arbitrary texts.

mod drive;
mod drive_messages;
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
    let files = files_in(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples"));
    assert!(files.len() >= 7);
    files
}

/// Name and text of every file in the directory of example drives.
fn example_drives() -> Vec<(String, String)> {
    let files = files_in(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/drives"));
    assert!(!files.is_empty());
    files
}

fn files_in(directory: &str) -> Vec<(String, String)> {
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

/// A drive with most keys, one to a line.
const DRIVE: &str = r#"kind = "drive"
[belt]
model = "beam"
axial_stiffness = "170 kN"
bending_stiffness = "0.015 N m^2"
mass_per_length = "0.1029 kg/m"
modes_per_span = 5
friction = 1.0
damping = { loss_factor = 0.05 }
natural_length = "1.5123 m"
span_ends = "tangent"
arc_stretch = "mean"
static_correction = true
cord_offset_ribs = "1.1 mm"
[[pulley]]
name = "crank"
center = ["552.5 mm", "55.6 mm"]
radius = "88.9 mm"
contact = "ribs"
inertia = "0.07248 kg m^2"
driver = true
[[pulley]]
name = "tensioner pulley"
arm = "tensioner"
radius = "45.2 mm"
contact = "back"
inertia = "2.93e-4 kg m^2"
[[pulley]]
name = "alternator"
center = ["0 mm", "0 mm"]
radius = "26.97 mm"
inertia = "2.93e-4 kg m^2"
load = "4.5 N m"
[pulley.coupling]
kind = "one-way"
accessory_inertia = "2.9e-3 kg m^2"
[[tensioner]]
name = "tensioner"
kind = "rotary"
pivot = ["250.8 mm", "63.5 mm"]
arm_length = "97.1 mm"
arm_angle = "-3.75 deg"
inertia = "1.165e-3 kg m^2"
spring = { rate = "54.37 N m/rad", preload = "19.9 N m" }
damping = "0.05 N m s/rad"
friction = { torque = "2 N m" }
stops = ["-40 deg", "25 deg"]
bearing_drag = "arm"
[operating]
speed = "2000 rpm"
[excitation]
motion = [ { order = 2, amplitude = "0.57 deg", phase = "0 deg" } ]
[[condition]]
name = "hot"
temperature_change = "80 K"
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
