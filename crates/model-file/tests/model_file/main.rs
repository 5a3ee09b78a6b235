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
    assert!(files.len() >= 3);
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

/// Drives that between them use every form of every key.
fn drives_with_every_form() -> Vec<String> {
    let damping = "damping = { span_dashpot = 1, external = 2, drag = 3, internal_bending = 4, rayleigh = { mass = 5, \
                   stiffness = 6 }, modal = [0.01, \"2 %\"] }";
    let grooved = "friction = { coefficient = 0.35, groove_angle = \"40 deg\" }\nback_friction = 0.3";
    let section = DRIVE
        .replace("axial_stiffness = \"170 kN\"\n", "ribs = 6\n")
        .replace(
            "bending_stiffness = \"0.015 N m^2\"\n",
            "per_rib = { axial_stiffness = \"30 kN\", bending_stiffness = 0.0025, mass_per_length = \"17 g/m\" }\n",
        )
        .replace("mass_per_length = \"0.1029 kg/m\"\n", "");
    let slide = {
        let (start, end) = (DRIVE.find("[[tensioner]]"), DRIVE.find("[operating]"));
        format!(
            "{}[[tensioner]]\nname = \"tensioner\"\nkind = \"linear\"\npoint = [\"347.7 mm\", \"57 mm\"]\n\
             direction = [0, 1]\nposition = \"1 mm\"\nmass = \"0.3 kg\"\n\
             spring = {{ rate = \"5 N/mm\", preload = \"200 N\" }}\ndamping = \"5 N s/m\"\n\
             friction = {{ loading = \"10 N\", unloading = \"20 N\", static_ratio = 1.1 }}\n{}",
            &DRIVE[..start.unwrap()],
            &DRIVE[end.unwrap()..]
        )
    };
    let couplings = [
        r#"{ kind = "rigid", accessory_inertia = 0.001 }"#,
        r#"{ kind = "wrap-spring", accessory_inertia = 0.001, stiffness = 20 }"#,
        r#"{ kind = "isolator", accessory_inertia = 0.001, stiffness = "20 N m/rad", damping = 0.1 }"#,
        r#"{ kind = "decoupler", accessory_inertia = 0.001, stiffness = 20, damping = 0.1, preload = "1 N m" }"#,
    ];
    let without_coupling = DRIVE
        .replace("[pulley.coupling]\nkind = \"one-way\"\n", "")
        .replace("accessory_inertia = \"2.9e-3 kg m^2\"\n", "");
    let mut texts = vec![
        with_line(DRIVE, "damping = { loss", damping),
        with_line(DRIVE, "damping = { loss", "damping = { modal = 0.01 }"),
        with_line(DRIVE, "friction = 1.0", grooved),
        with_line(
            DRIVE,
            "friction = { torque",
            "friction = { law = \"spring-slider\", torque = \"2 N m\", stiffness = \"5 N m/deg\" }\none_way_damping = 0.1\n\
             stop_contact = { restitution = 0.3 }",
        ),
        with_line(
            DRIVE,
            "friction = { torque",
            "friction = { law = \"dahl\", torque = 2, stiffness = 300 }",
        ),
        with_line(
            DRIVE,
            "friction = { torque",
            "friction = { law = \"lugre\", torque = 2, static_ratio = 1.2, stribeck_velocity = 0.1, stiffness = 300, damping = 0.1, \
             viscous = 0.1 }",
        ),
        with_line(
            DRIVE,
            "friction = { torque",
            "friction = { law = \"measured-loop\", loop = { position = [\"-20 deg\", \"20 deg\"], loading = [\"22 N m\", 19], \
             unloading = [18, 15] } }\nstop_contact = { stiffness = \"1 kN m/rad\", damping = 0.5 }\n\
             pulley_contact = [{ pulley = \"crank\", carried = \"tensioner pulley\", belt_thickness = \"4 mm\", \
             stiffness = \"1 kN/mm\", damping = 20 }]",
        ),
        with_line(
            DRIVE,
            "modes_per_span",
            "modes_per_span = [5, 6, 7]\nwrapped_inertia = true",
        ),
        with_line(DRIVE, "natural_length", "installation = { tension = \"300 N\" }"),
        with_line(
            DRIVE,
            "natural_length",
            "installation = { operating_position = true }",
        ),
        with_line(
            DRIVE,
            "natural_length",
            "effective_length = \"1505 mm\"\nmeasuring_tension = \"300 N\"",
        ),
        with_line(
            DRIVE,
            "radius = \"88.9 mm\"",
            "outside_diameter = \"175 mm\"\nfriction = 1.1",
        ),
        with_line(
            DRIVE,
            "radius = \"88.9 mm\"",
            "effective_diameter = \"175 mm\"\nminimum_wrap = \"90 deg\"",
        ),
        with_line(
            DRIVE,
            "arm = ",
            "arm = \"tensioner\"\narm_length = 0.09\narm_angle_offset = 0.1\nmass = 0.2",
        ),
        with_line(DRIVE, "load", "load = \"1 kW\""),
        with_line(DRIVE, "load", "load = { power = 1000 }"),
        with_line(
            DRIVE,
            "load",
            "load = { speed = [100, 200], power = [100, 300], over = \"driver\" }",
        ),
        with_line(
            DRIVE,
            "load",
            "load = { speed = [100, 200], torque = [\"1 N m\", 3] }",
        ),
        with_line(
            DRIVE,
            "motion",
            "torque = [{ order = 2, speed = [1, 2], amplitude = [\"1 N m\", 2], phase = [0, 1] }]",
        ),
        with_line(DRIVE, "stops", "locked = true"),
        with_line(DRIVE, "speed", "speed = 100\nrotation = \"counter-clockwise\""),
        with_line(&slide, "direction", "direction = \"90 deg\""),
        with_line(&slide, "arm = ", "arm = \"tensioner\"\noffset = [0.01, 0.02]"),
        section,
        slide,
    ];
    texts.extend(couplings.map(|coupling| {
        with_line(
            &without_coupling,
            "load",
            &format!("load = 4.5\ncoupling = {coupling}"),
        )
    }));
    texts
}

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
