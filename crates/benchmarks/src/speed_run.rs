//! Task (i): the eight-pulley accessory drive with beam spans, an overrunning decoupler at the alternator and dry friction at
//! the tensioner, from 600 to 7,000 rpm in 500 steps: steady state, equations and periodic motion with statistics at each.

use crate::timing::measure;
use serde_json::{Value, json};
use slackside_belt_drive::steady::Installed;
use slackside_belt_drive::system::DriveSpeedFamily;
use slackside_dynamics::flow::{ExactFlow, Request};
use slackside_dynamics::orbit::periodic::{PeriodicSearch, PeriodicSettings};
use slackside_mechanics::SystemFamily;
use slackside_model_file::Document;
use std::f64::consts::PI;
use std::path::Path;

const STEPS: usize = 500;

fn family() -> DriveSpeedFamily {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/drives/eight-pulley.toml");
    let mut document = Document::read(&path).expect("the example can be read");
    for (key, value) in [
        ("pulley.alternator.coupling.kind", "decoupler"),
        ("pulley.alternator.coupling.damping", "0"),
        ("tensioner.tensioner.friction", "{ torque = \"3 N m\" }"),
        ("belt.modes_per_span", "3"),
    ] {
        document.set(key, value).expect("the key exists");
    }
    let (model, _) = document.model().expect("the example is sound");
    let described = model.drive().expect("the example is a drive");
    let drive = described.belt_drive().expect("the example has a belt path");
    DriveSpeedFamily {
        installed: Installed::new(&drive).expect("the example can be installed"),
        excitation: described.excitation(),
        drive,
    }
}

pub(crate) fn run(repeats: usize) -> Value {
    let family = family();
    let timing = measure(repeats, || {
        let mut start: Option<Vec<f64>> = None;
        let (mut residual, mut switching, mut coordinates) = (0.0_f64, 0, 0);
        for k in 0..STEPS {
            let rpm = 600.0 + 6400.0 * k as f64 / (STEPS - 1) as f64;
            let point = family.at(rpm * PI / 30.0).expect("the drive runs at every speed");
            coordinates = point.system.order();
            let mut flow = ExactFlow::new(&point).expect("the laws are piecewise linear");
            let mut search = PeriodicSearch::new(&mut flow, &point.system, PeriodicSettings::default());
            let rest = || vec![0.0; 2 * point.system.order() + point.system.internal_states()];
            let motion = search
                .from_state(&start.take().unwrap_or_else(rest))
                .expect("the motion is unique and attracts");
            let request = Request {
                extremes: true,
                ..Request::default()
            };
            let record = search.record(&motion, &point.system.outputs, &request);
            residual = residual.max(motion.residual);
            switching += usize::from(!record.expect("the motion is known").events.is_empty());
            start = Some(motion.start);
        }
        (residual, switching, coordinates)
    });
    let (residual, switching, coordinates) = timing.result;
    let accuracy = json!({
        "points": STEPS,
        "coordinates": coordinates,
        "points_with_events": switching,
        "largest_residual": residual,
    });
    let note = "steady state, linearisation, periodic motion with RMS and extremes of all measures at 500 speeds; operations not counted";
    timing.line("i", "eight-pulley", accuracy, 0.0, note)
}
