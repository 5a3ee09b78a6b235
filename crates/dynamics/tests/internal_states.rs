//! Laws with an internal state: what is zero where a regime begins must not be taken for an event, or events would follow each
//! other without end.

use slackside_dynamics::flow::{ExactFlow, Flow};
use slackside_linalg::Matrix;
use slackside_mechanics::laws::{Decoupler, spring_slider};
use slackside_mechanics::{Element, Forcing, Harmonic, OperatingPoint, Port, System};
use std::sync::Arc;

/// A stiff decoupler engages at rest again and again, its wind-up zero to rounding, of either sign.
#[test]
fn a_loaded_decoupler_bounces_a_finite_number_of_times() {
    for k in [1e4, 1e5, 1e6] {
        let system = System {
            coordinates: vec!["a".into(), "b".into(), "c".into()],
            mass: Matrix::from_rows(&[
                vec![1.1112277112776032, -0.04634277709389655, 0.0],
                vec![-0.04634277709389655, 1.0301571963249734, 0.0],
                vec![0.0, 0.0, 1.6456401747634402],
            ])
            .unwrap(),
            damping: Matrix::from_rows(&[
                vec![0.05423013881974724, 0.034350403046540245, 0.0],
                vec![-0.043761378968607184, 0.055239664305204286, 0.0],
                vec![0.0, 0.0, 0.025648107936371456],
            ])
            .unwrap(),
            stiffness: Matrix::from_rows(&[
                vec![1.5694593928864178, 0.14191230281099676, 0.0],
                vec![0.14191230281099676, 1.35144137220008, 0.0],
                vec![0.0, 0.0, 0.0],
            ])
            .unwrap(),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing: Forcing {
                constant: vec![0.0, 0.11951847134965266, -0.11951847134965266],
                harmonics: vec![Harmonic {
                    order: 1,
                    cosine: vec![0.6, -0.3, 0.0],
                    sine: vec![0.2, 0.8, 0.0],
                }],
            },
            elements: vec![Element::new(
                "clutch",
                Port::new([(1, 1.0), (2, -1.0)]),
                Decoupler::new(k, 0.0, 0.0).unwrap(),
            )],
            outputs: vec![],
        };
        let point = OperatingPoint {
            system: Arc::new(system),
            frequency: 0.8551840499940866,
        };
        let mut x = vec![0.0; 7];
        ExactFlow::new(&point)
            .unwrap()
            .advance(&mut x, 30, &mut [])
            .unwrap();
    }
}

/// A slider yields by its force and sticks again by its velocity: the two must not be taken for one surface.
#[test]
fn a_slider_that_yields_goes_on_slipping() {
    let system = System {
        coordinates: vec!["x".into()],
        mass: Matrix::diagonal(&[1.0]),
        damping: Matrix::diagonal(&[0.1]),
        stiffness: Matrix::diagonal(&[1.0]),
        damping_linear_in_frequency: None,
        stiffness_quadratic_in_frequency: None,
        forcing: Forcing {
            constant: vec![0.0],
            harmonics: vec![Harmonic {
                order: 1,
                cosine: vec![0.5],
                sine: vec![0.0],
            }],
        },
        elements: vec![Element::new(
            "slider",
            Port::new([(0, 1.0)]),
            spring_slider(10.0, 0.2),
        )],
        outputs: vec![],
    };
    let point = OperatingPoint {
        system: Arc::new(system),
        frequency: 0.9,
    };
    for v in [0.3, 0.5, 1.0, -0.4] {
        let mut x = vec![-0.3, v, 0.0];
        ExactFlow::new(&point)
            .unwrap()
            .advance(&mut x, 5, &mut [])
            .unwrap();
    }
}
