//! The reference's drive with clutch and dry friction as model files: what the files say is the reference's system.

use serde_json::Value;
use slackside_linalg::Matrix;
use slackside_mechanics::{Forcing, OperatingPoint, System, laws};
use slackside_model_file::Document;
use slackside_studies::Subject;
use slackside_testkit::nonsmooth_file::model_file;
use slackside_testkit::nonsmooth_reference::{Machine, nonsmooth_reference, operating_point};
use std::sync::Arc;

/// The model of an entry's `input`, read from the text of its file.
pub fn subject(file: &Value, input: &Value) -> Subject {
    let text = model_file(file, input);
    Subject::new(&Document::parse("case.toml", &text).unwrap()).unwrap()
}

/// The same matrices as somebody else assembled them.
fn assembled(file: &Value, input: &Value) -> OperatingPoint {
    operating_point(file, Machine::of(input), input, &|_, _| Arc::new(laws::one_way()))
}

fn difference(a: &Matrix, b: &Matrix) -> f64 {
    let size = b.as_slice().iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    let pairs = a.as_slice().iter().zip(b.as_slice());
    let largest = pairs.fold(0.0_f64, |largest, (a, b)| largest.max((a - b).abs()));
    largest / size.max(f64::MIN_POSITIVE)
}

fn load_difference(a: &Forcing, b: &Forcing) -> f64 {
    assert_eq!(a.harmonics.len(), b.harmonics.len());
    let lists = |forcing: &Forcing| {
        let mut all = forcing.constant.clone();
        for harmonic in &forcing.harmonics {
            all.extend(&harmonic.cosine);
            all.extend(&harmonic.sine);
        }
        all
    };
    let (a, b) = (lists(a), lists(b));
    let size = b.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    a.iter().zip(&b).fold(0.0_f64, |l, (a, b)| l.max((a - b).abs())) / size
}

#[test]
fn files_hold_the_matrices_loads_and_tensions_of_the_reference() {
    let file = nonsmooth_reference();
    let cases = file["periodic"].as_array().unwrap();
    assert_eq!(cases.len(), 26);
    let mut largest = 0.0_f64;
    for entry in cases {
        let input = &entry["input"];
        let found = subject(&file, input).operating_point(None).unwrap();
        let expected = assembled(&file, input);
        assert_eq!(found.frequency, expected.frequency);
        let (a, b): (&System, &System) = (&found.system, &expected.system);
        assert_eq!(a.coordinates, b.coordinates);
        let w = found.frequency;
        for (a, b) in [
            (&a.mass, &b.mass),
            (&a.damping_at(w), &b.damping_at(w)),
            (&a.stiffness_at(w), &b.stiffness_at(w)),
            (&a.damping_at(0.0), &b.damping_at(0.0)),
            (&a.stiffness_at(0.0), &b.stiffness_at(0.0)),
        ] {
            largest = largest.max(difference(a, b));
        }
        largest = largest.max(load_difference(&a.forcing, &b.forcing));
        assert_eq!(a.elements.len(), b.elements.len());
        for (a, b) in a.elements.iter().zip(&b.elements) {
            assert_eq!(a.port, b.port);
        }
        for span in 1..=3 {
            let output = |system: &System| {
                let name = format!("tension_{span}");
                system.outputs[system.output_index(&name).unwrap()].clone()
            };
            assert_eq!(output(a), output(b));
        }
    }
    println!("matrices and loads: {largest:.1e}");
    assert!(largest <= 1e-15, "{largest:e}");
}
