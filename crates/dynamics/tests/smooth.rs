//! The flow of smooth and smoothed systems against references, differences and the exact flow.

use serde_json::json;
use slackside_dynamics::flow::{ExactFlow, Flow, FlowError, Request, SmoothFlow};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_linalg::Matrix;
use slackside_mechanics::laws::{Cubic, Isolator, Smoothing};
use slackside_mechanics::{
    Element, Forcing, FrequencyFamily, Harmonic, OperatingPoint, Output, OutsideDomain, Port, System,
    SystemFamily,
};
use slackside_testkit::{assert_close, nominal, number, numbers, reference};
use std::f64::consts::TAU;
use std::sync::Arc;

fn smoothed(smoothing: Smoothing, width: f64) -> System {
    let mut model = nominal(&json!({}));
    model.smoothing = Some((smoothing, width));
    model.system().unwrap()
}

fn shooting(system: &System, frequency: f64) -> Shooting {
    let family = Arc::new(FrequencyFamily::new(Arc::new(system.clone())));
    Shooting::new(family, frequency, 1).unwrap()
}

fn summary_request() -> Request {
    Request {
        harmonics: 5,
        extremes: true,
        samples: 512,
        ..Request::default()
    }
}

#[test]
fn tanh_reference_orbit() {
    let file = reference("clutch_nominal.json");
    let expected = &file["tanh_smoothing"];
    let frequency = number(&expected["Omega"]);
    let system = smoothed(Smoothing::Tanh, number(&expected["eps"]));
    let mut shooting = shooting(&system, frequency);
    let start = numbers(&expected["x0"]);
    let guess: Vec<f64> = start.iter().map(|x| x + 1e-5).collect();
    let orbit = shooting.solve(&guess, frequency).unwrap();
    for (found, expected) in orbit.start.iter().zip(&start) {
        assert_close(*found, *expected, 1e-12, "state at phase zero");
    }
    let record = shooting
        .summarize(&orbit.start, frequency, &system.outputs, &summary_request())
        .unwrap();
    let windup = &record.measures[2];
    assert_close(windup.rms, number(&expected["delta"]["rms_ac"]), 1e-13, "rms");
    assert_close(windup.mean, number(&expected["delta"]["mean"]), 1e-13, "mean");
    // Independent of the quadrature: the trapezoidal rule over the samples, and their range.
    let samples = &record.samples[2];
    let mean = samples.iter().sum::<f64>() / 512.0;
    let square = samples.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / 512.0;
    assert_close(mean, windup.mean, 1e-11, "mean of the samples");
    assert_close(square.sqrt(), windup.rms, 1e-11, "rms of the samples");
    let (low, high) = samples
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &y| {
            (low.min(y), high.max(y))
        });
    assert!(
        windup.max >= high && windup.max - high < 1e-4,
        "{} {high}",
        windup.max
    );
    assert!(
        windup.min <= low && low - windup.min < 1e-4,
        "{} {low}",
        windup.min
    );
    assert!(record.events.is_empty() && record.fractions.is_empty());
    // The damping is the same on both sides, so the volume shrinks as in the engaged linear system.
    let product: f64 = orbit.multipliers.iter().map(|m| m.norm()).product();
    let decay = -0.06 * (0.9796106880251735 + 6.374979443096805) * TAU / frequency;
    assert_close(product, decay.exp(), 1e-11, "product of multipliers");
}

#[test]
fn convergence_of_all_smoothed_laws() {
    let file = reference("clutch_nominal.json");
    let table = &file["smoothing_convergence"];
    let frequency = number(&table["Omega"]);
    let start = numbers(&file["tanh_smoothing"]["x0"]);
    for row in table["rows"].as_array().unwrap() {
        let width = number(&row["eps"]);
        let smoothing = match row["law"].as_str().unwrap() {
            "poly2" => Smoothing::Quadratic,
            "poly4" => Smoothing::Quartic,
            name => Smoothing::ALL.into_iter().find(|s| s.name() == name).unwrap(),
        };
        let system = smoothed(smoothing, width);
        let mut shooting = shooting(&system, frequency);
        let orbit = shooting.solve(&start, frequency).unwrap();
        let record = shooting
            .summarize(
                &orbit.start,
                frequency,
                &system.outputs[2..3],
                &Request::default(),
            )
            .unwrap();
        // A step may cross the joint of a polynomial hinge with an error estimate that is near zero by chance.
        let tolerance = match smoothing {
            Smoothing::Quadratic | Smoothing::Quartic => 2e-11,
            _ => 1e-12,
        };
        assert_close(
            record.measures[0].rms,
            number(&row["delta_rms_ac"]),
            tolerance,
            &format!("{smoothing:?} of width {width}"),
        );
    }
}

/// A bolted joint of two inertias under two harmonics: everything a system can have, with matrices that depend on `Ω`.
fn rich(element: Element) -> System {
    let mut forcing = Forcing::none(2);
    forcing.constant = vec![0.3, -0.2];
    for order in [1, 3] {
        forcing.add_harmonic(Harmonic {
            order,
            cosine: vec![0.4 / order as f64, 0.1],
            sine: vec![-0.2, 0.3],
        });
    }
    System {
        coordinates: vec!["a".into(), "b".into()],
        mass: Matrix::from_rows(&[vec![1.2, 0.1], vec![0.1, 0.8]]).unwrap(),
        damping: Matrix::from_rows(&[vec![0.2, 0.05], vec![-0.05, 0.3]]).unwrap(),
        stiffness: Matrix::from_rows(&[vec![3.0, -1.0], vec![-1.0, 2.0]]).unwrap(),
        damping_linear_in_frequency: Some(Matrix::from_rows(&[vec![0.0, 0.1], vec![-0.1, 0.0]]).unwrap()),
        stiffness_quadratic_in_frequency: Some(Matrix::diagonal(&[0.05, -0.02])),
        forcing,
        elements: vec![element],
        outputs: vec![
            Output::coordinate("a", 0),
            Output::element_force("joint", 0),
            Output {
                name: "mixed".into(),
                constant: 0.5,
                displacement: vec![(0, 1.0), (1, -2.0)],
                velocity: vec![(1, 0.3)],
                force: vec![(0, 0.1)],
                harmonics: vec![(2, 0.2, -0.1)],
            },
        ],
    }
}

fn joint(law: impl slackside_mechanics::Law + 'static) -> Element {
    Element::new("joint", Port::new([(0, 1.0), (1, -1.0)]), law)
}

#[test]
fn a_linear_system_moves_as_in_the_exact_flow() {
    let law = Isolator {
        stiffness: 1.5,
        damping: 0.1,
    };
    let family = FrequencyFamily::new(Arc::new(rich(joint(law))));
    let outputs = family.at(1.3).unwrap().system.outputs.clone();
    let mut exact = ExactFlow::with_rate(&family, 1.3).unwrap();
    let mut smooth = SmoothFlow::with_rate(&family, 1.3).unwrap();
    let start = [0.1, -0.2, 0.3, 0.05];
    let mut columns = vec![0.0; 20];
    (0..4).for_each(|i| columns[5 * i] = 1.0);
    let (mut x, mut y) = (start, start);
    let (mut exact_columns, mut smooth_columns) = (columns.clone(), columns);
    exact.advance(&mut x, 3, &mut exact_columns).unwrap();
    smooth.advance(&mut y, 3, &mut smooth_columns).unwrap();
    for (found, expected) in y.iter().zip(&x) {
        assert_close(*found, *expected, 1e-12, "state");
    }
    for (found, expected) in smooth_columns.iter().zip(&exact_columns) {
        assert_close(*found, *expected, 1e-11, "variation");
    }
    let request = Request {
        harmonics: 6,
        extremes: true,
        samples: 16,
        ..Request::default()
    };
    let (mut x, mut y) = (start, start);
    let expected = exact.record(&mut x, 3, &outputs, &request).unwrap();
    let found = smooth.record(&mut y, 3, &outputs, &request).unwrap();
    for (found, expected) in found.measures.iter().zip(&expected.measures) {
        assert_close(found.mean, expected.mean, 1e-12, "mean");
        assert_close(found.rms, expected.rms, 1e-12, "rms");
        assert_close(found.max, expected.max, 1e-12, "max");
        assert_close(found.min, expected.min, 1e-12, "min");
        assert_eq!(found.harmonics.len(), 7);
        for (a, b) in found.harmonics.iter().zip(&expected.harmonics) {
            assert_close((a - b).norm(), 0.0, 1e-12, "harmonic");
        }
    }
    for (found, expected) in found.samples.iter().zip(&expected.samples) {
        assert_eq!(found.len(), 48);
        for (a, b) in found.iter().zip(expected) {
            assert_close(*a, *b, 1e-12, "sample");
        }
    }
}

/// Differences of fourth order of the end state with respect to whatever `end` varies.
fn difference(step: f64, end: &mut dyn FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let mut sum = vec![0.0; 4];
    for (offset, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
        for (sum, value) in sum.iter_mut().zip(end(offset * step)) {
            *sum += weight * value / (12.0 * step);
        }
    }
    sum
}

/// End state after two periods, and derivatives with respect to start and parameter.
fn map(family: &dyn SystemFamily, parameter: f64, start: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut flow = SmoothFlow::with_rate(family, parameter).unwrap();
    let mut columns = vec![0.0; 20];
    (0..4).for_each(|i| columns[5 * i] = 1.0);
    let mut x = start.to_vec();
    flow.advance(&mut x, 2, &mut columns).unwrap();
    (x, columns)
}

fn check_derivatives(family: &dyn SystemFamily, parameter: f64, step: f64, label: &str) {
    let start = [0.1, -0.2, 0.3, 0.05];
    let (_, columns) = map(family, parameter, &start);
    for j in 0..4 {
        let expected = difference(2e-4, &mut |h| {
            let mut moved = start;
            moved[j] += h;
            map(family, parameter, &moved).0
        });
        for i in 0..4 {
            assert_close(columns[4 * j + i], expected[i], 1e-8, &format!("{label}: ∂x/∂x"));
        }
    }
    let expected = difference(step, &mut |h| map(family, parameter + h, &start).0);
    for i in 0..4 {
        assert_close(columns[16 + i], expected[i], 1e-8, &format!("{label}: ∂x/∂p"));
    }
}

/// The cubic stiffness as parameter, and a frequency that follows it.
struct Stiffening;

impl SystemFamily for Stiffening {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        let law = Cubic {
            linear: 0.4,
            cubic: parameter,
        };
        Ok(OperatingPoint {
            system: Arc::new(rich(joint(law))),
            frequency: 1.0 + 0.3 * parameter,
        })
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

#[test]
fn derivatives_agree_with_differences() {
    let cubic = Cubic {
        linear: 0.4,
        cubic: 1.1,
    };
    let mut constant = rich(joint(cubic));
    let varying = FrequencyFamily::new(Arc::new(constant.clone()));
    constant.damping_linear_in_frequency = None;
    constant.stiffness_quadratic_in_frequency = None;
    let constant = FrequencyFamily::new(Arc::new(constant));
    check_derivatives(&constant, 1.3, 1e-3, "frequency");
    check_derivatives(&varying, 1.3, 1e-3, "frequency that changes matrices");
    check_derivatives(&Stiffening, 1.1, 1e-3, "other parameter");
    let clutch = FrequencyFamily::new(Arc::new(smoothed(Smoothing::Tanh, 0.2)));
    check_derivatives(&clutch, 5.5, 1e-3, "smoothed clutch");
}

#[test]
fn the_load_on_a_duffing_oscillator_supplies_what_the_damper_takes() {
    let (damping, load, frequency) = (0.1, 0.5, 1.4);
    let mut forcing = Forcing::none(1);
    forcing.add_harmonic(Harmonic {
        order: 1,
        cosine: vec![load],
        sine: vec![0.0],
    });
    let law = Cubic {
        linear: 1.0,
        cubic: 1.0,
    };
    let system = System {
        coordinates: vec!["x".into()],
        mass: Matrix::identity(1),
        damping: Matrix::diagonal(&[damping]),
        stiffness: Matrix::zeros(1, 1),
        damping_linear_in_frequency: None,
        stiffness_quadratic_in_frequency: None,
        forcing,
        elements: vec![Element::new("spring", Port::new([(0, 1.0)]), law)],
        outputs: vec![Output {
            velocity: vec![(0, 1.0)],
            ..Output::default()
        }],
    };
    let mut shooting = shooting(&system, frequency);
    let orbit = shooting.solve(&[1.0, 0.1], frequency).unwrap();
    let request = Request {
        harmonics: 1,
        ..Request::default()
    };
    let record = shooting
        .summarize(&orbit.start, frequency, &system.outputs, &request)
        .unwrap();
    let velocity = &record.measures[0];
    let supplied = 0.5 * load * velocity.harmonics[1].re;
    let dissipated = damping * velocity.rms.powi(2);
    assert!(dissipated > 1e-3, "the oscillator moves");
    assert_close(velocity.mean, 0.0, 1e-12, "mean velocity");
    assert_close(supplied, dissipated, 1e-12, "power");
    let product: f64 = orbit.multipliers.iter().map(|m| m.norm()).product();
    assert_close(
        product,
        (-damping * TAU / frequency).exp(),
        1e-11,
        "product of multipliers",
    );
}

#[test]
fn what_cannot_be_integrated_is_told_and_leaves_the_state_alone() {
    // A spring that pushes away with the cube of the displacement: infinite after a finite time.
    let law = Cubic {
        linear: 0.0,
        cubic: -5.0,
    };
    let system = Arc::new(rich(joint(law)));
    let point = OperatingPoint {
        system,
        frequency: 1.0,
    };
    let mut flow = SmoothFlow::new(&point).unwrap();
    let start = [5.0, -5.0, 0.0, 0.0];
    let mut state = start;
    let error = flow.advance(&mut state, 1, &mut []).unwrap_err();
    assert!(
        matches!(error, FlowError::Integrator(_) | FlowError::Unbounded { .. }),
        "{error}"
    );
    assert_eq!(state, start);
    let short = flow.advance(&mut [0.0; 3], 1, &mut []);
    assert_eq!(
        short,
        Err(FlowError::StateLength {
            expected: 4,
            found: 3
        })
    );
    let undefined = flow.advance(&mut [f64::NAN; 4], 1, &mut []);
    assert_eq!(undefined, Err(FlowError::Unbounded { periods: 0 }));
}

#[test]
fn a_looser_tolerance_costs_less_and_errs_more() {
    let point = OperatingPoint {
        system: Arc::new(smoothed(Smoothing::Tanh, 0.01)),
        frequency: 5.5,
    };
    let start = [-0.04, 0.0, 0.18, -0.1];
    let end = |tolerance: f64| {
        let mut flow = SmoothFlow::new(&point).unwrap().with_tolerance(tolerance);
        let mut state = start;
        flow.advance(&mut state, 4, &mut []).unwrap();
        (state, flow.statistics().evaluations)
    };
    let (fine, _) = end(1e-13);
    let distance = |state: [f64; 4]| (0..4).fold(0.0_f64, |worst, i| worst.max((state[i] - fine[i]).abs()));
    let (usual, usual_cost) = end(1e-12);
    let (loose, loose_cost) = end(1e-7);
    assert!(distance(usual) < 1e-11, "{:e}", distance(usual));
    assert!((1e-12..1e-5).contains(&distance(loose)), "{:e}", distance(loose));
    assert!(2 * loose_cost < usual_cost, "{loose_cost} {usual_cost}");
}
