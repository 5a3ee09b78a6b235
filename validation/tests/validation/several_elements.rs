//! Three coordinates with a backlash, a stop and a one-way damper at once, and matrices that depend on the frequency:
//! exact flow, smooth integrator, shooting and harmonic balance against each other.

use crate::common::{characteristic_polynomial, distance, point, record, shooting};
use slackside_continuation::{Evaluation, Family};
use slackside_dynamics::flow::{ExactFlow, Flow, SmoothFlow};
use slackside_dynamics::orbit::harmonic_balance::{
    HarmonicBalance, HarmonicOrbit, Settings, SolveStop, Start, solve,
};
use slackside_dynamics::orbit::shooting::Orbit;
use slackside_linalg::{Lu, Matrix};
use slackside_mechanics::laws::{PiecewiseLinear, Smoothed, Smoothing, backlash, one_way_damper, stop};
use slackside_mechanics::{Element, Forcing, FrequencyFamily, Harmonic, Output, Port, System};
use slackside_testkit::assert_close;
use std::sync::Arc;

const FREQUENCY: f64 = 1.15;

/// A chain of three inertias under two harmonics. `smoothing` is the width of quadratic hinges; `varying` adds gyroscopic
/// coupling in proportion to the frequency and a stiffness that grows with its square.
fn chain(smoothing: Option<f64>, varying: bool) -> Arc<System> {
    let element = |name: &str, port: [(usize, f64); 2], law: PiecewiseLinear| match smoothing {
        None => Element::new(name, Port::new(port), law),
        Some(width) => Element::new(
            name,
            Port::new(port),
            Smoothed::new(law, Smoothing::Quadratic, width),
        ),
    };
    let mut forcing = Forcing::none(3);
    forcing.constant = vec![0.1, 0.0, -0.1];
    forcing.add_harmonic(Harmonic {
        order: 1,
        cosine: vec![0.6, 0.0, 0.1],
        sine: vec![0.0, 0.3, 0.0],
    });
    forcing.add_harmonic(Harmonic {
        order: 2,
        cosine: vec![0.0, 0.15, 0.0],
        sine: vec![0.1, 0.0, 0.0],
    });
    let rows = |rows: [[f64; 3]; 3]| Matrix::from_rows(&rows.map(|row| row.to_vec())).unwrap();
    System {
        coordinates: vec!["a".into(), "b".into(), "c".into()],
        mass: rows([[1.0, 0.1, 0.0], [0.1, 0.8, 0.0], [0.0, 0.0, 1.3]]),
        damping: rows([[0.3, -0.1, 0.0], [-0.1, 0.35, -0.1], [0.0, -0.1, 0.3]]),
        stiffness: rows([[2.0, -0.8, 0.0], [-0.8, 2.2, -0.6], [0.0, -0.6, 1.5]]),
        damping_linear_in_frequency: varying
            .then(|| rows([[0.02, 0.1, 0.0], [-0.1, 0.0, 0.05], [0.0, -0.05, 0.01]])),
        stiffness_quadratic_in_frequency: varying
            .then(|| rows([[0.08, 0.0, 0.0], [0.0, -0.05, 0.02], [0.0, 0.02, 0.03]])),
        forcing,
        elements: vec![
            element("play", [(0, 1.0), (1, -1.0)], backlash(6.0, 0.15)),
            element("stop", [(1, 1.0), (1, 0.0)], stop(10.0, 0.2)),
            element("damper", [(2, 1.0), (0, -1.0)], one_way_damper(0.8)),
        ],
        outputs: vec![
            Output::coordinate("a", 0),
            Output::coordinate("b", 1),
            Output::coordinate("c", 2),
            Output::element_force("stop force", 1),
        ],
    }
    .into()
}

/// The orbit that motions from rest settle on.
fn settled(system: &Arc<System>, frequency: f64) -> Orbit {
    let mut state = [0.0; 6];
    let mut flow = ExactFlow::new(&point(system, frequency)).unwrap();
    flow.advance(&mut state, 300, &mut []).unwrap();
    let orbit = shooting(system, frequency, 1).solve(&state, frequency).unwrap();
    assert!(orbit.is_stable());
    assert!(distance(&orbit.start, &state) < 1e-10, "the transient has faded");
    orbit
}

/// The same orbit by harmonic balance, started from the samples of the motion at every port.
fn balanced(system: &Arc<System>, frequency: f64, orbit: &Orbit, harmonics: usize) -> HarmonicOrbit {
    let mut measured = (**system).clone();
    measured.outputs = system
        .elements
        .iter()
        .map(|element| Output {
            displacement: element.port.terms().to_vec(),
            ..Output::default()
        })
        .collect();
    let samples = record(&Arc::new(measured), frequency, &orbit.start, 1, 0, 512).samples;
    let solution = solve(
        &point(system, frequency),
        Start::Samples(&samples),
        &Settings::fixed(harmonics),
    )
    .unwrap();
    assert_eq!(solution.stop, SolveStop::Converged);
    solution.orbit
}

#[test]
fn smoothed_laws_tend_to_the_exact_ones_with_the_square_of_the_width() {
    let exact = chain(None, false);
    let start = [0.1, -0.1, 0.2, 0.3, 0.0, -0.4];
    let mut end = start;
    let events = ExactFlow::new(&point(&exact, FREQUENCY))
        .unwrap()
        .advance(&mut end, 3, &mut [])
        .unwrap();
    assert!(events >= 12, "{events}");
    let kinds = |element: usize| {
        let found = record(&exact, FREQUENCY, &start, 3, 0, 0);
        found.events.iter().filter(|e| e.element == element).count()
    };
    assert!((0..3).all(|element| kinds(element) > 0), "every element switches");
    let errors: Vec<f64> = [4e-3, 2e-3, 1e-3]
        .into_iter()
        .map(|width| {
            let mut state = start;
            let smooth = chain(Some(width), false);
            let mut flow = SmoothFlow::new(&point(&smooth, FREQUENCY)).unwrap();
            flow.advance(&mut state, 3, &mut []).unwrap();
            distance(&state, &end)
        })
        .collect();
    for pair in errors.windows(2) {
        assert!((3.5..4.6).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
    assert!(errors[2] < 1e-5, "{errors:?}");
}

fn check_methods(varying: bool) {
    let system = chain(None, varying);
    let orbit = settled(&system, FREQUENCY);
    let found = record(&system, FREQUENCY, &orbit.start, 1, 8, 0);
    assert!((0..3).all(|element| found.events.iter().any(|e| e.element == element)));
    let mut last = f64::INFINITY;
    for harmonics in [30, 60, 120] {
        let balanced = balanced(&system, FREQUENCY, &orbit, harmonics);
        let error = distance(&balanced.initial_state(), &orbit.start);
        assert!(error < 0.3 * last, "{harmonics}: {error:e} after {last:e}");
        last = error;
        if harmonics < 120 {
            continue;
        }
        assert!(error < 5e-7, "state {error:e}");
        assert_eq!(balanced.events.len(), found.events.len());
        for (a, b) in balanced.events.iter().zip(&found.events) {
            assert_eq!((a.element, a.from, a.to), (b.element, b.from, b.to));
            assert_close(a.phase, b.phase, 1e-6, "event");
        }
        for (a, b) in balanced.measures().iter().zip(&found.measures) {
            assert_close(a.rms, b.rms, 1e-7, "rms");
            assert_close(a.mean, b.mean, 1e-7, "mean");
            assert_close(a.max, b.max, 3e-7, "max");
        }
        let multipliers = balanced.stability().unwrap().multipliers;
        let (a, b) = (
            characteristic_polynomial(&multipliers),
            characteristic_polynomial(&orbit.multipliers),
        );
        assert!(distance(&a, &b) < 1e-6, "{a:?} {b:?}");
    }
}

#[test]
fn harmonic_balance_and_shooting_agree_on_three_elements() {
    check_methods(false);
}

#[test]
fn harmonic_balance_and_shooting_agree_on_matrices_that_depend_on_the_frequency() {
    check_methods(true);
}

#[test]
fn derivatives_with_respect_to_a_frequency_that_changes_the_matrices() {
    let system = chain(None, true);
    let orbit = settled(&system, FREQUENCY);
    let mut solver = shooting(&system, FREQUENCY, 1);
    let (_, map, by_frequency) = solver.map(&orbit.start, FREQUENCY).unwrap();
    let step = 1e-4;
    let difference = |end: &mut dyn FnMut(f64) -> Vec<f64>| {
        let mut sum = vec![0.0; 6];
        for (offset, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let values = end(FREQUENCY + offset * step);
            (0..6).for_each(|i| sum[i] += weight * values[i] / (12.0 * step));
        }
        sum
    };
    let expected = difference(&mut |w| solver.map(&orbit.start, w).unwrap().0);
    assert!(distance(&by_frequency, &expected) < 1e-10);

    // dx/dΩ of the orbit: (I − Mon)⁻¹ ∂P/∂Ω, against orbits at neighbouring frequencies by both methods.
    let mut matrix = map.scaled(-1.0);
    (0..6).for_each(|i| matrix[(i, i)] += 1.0);
    let slope = Lu::new(&matrix).unwrap().solve(&by_frequency);
    let expected = difference(&mut |w| solver.solve(&orbit.start, w).unwrap().start);
    assert!(distance(&slope, &expected) < 1e-10);

    let found = balanced(&system, FREQUENCY, &orbit, 60);
    let family = Arc::new(FrequencyFamily::new(system.clone()));
    let mut balance = HarmonicBalance::new(family, FREQUENCY, Settings::fixed(60)).unwrap();
    let z = balance.unknowns(&found);
    let mut evaluation = Evaluation::new(z.len());
    balance.evaluate(&z, FREQUENCY, &mut evaluation).unwrap();
    let by_frequency = evaluation.by_parameter.clone();
    let step = 1e-5;
    let mut at = |w: f64| {
        balance.evaluate(&z, w, &mut evaluation).unwrap();
        evaluation.residual.clone()
    };
    let (ahead, behind) = (at(FREQUENCY + step), at(FREQUENCY - step));
    let differences: Vec<f64> = ahead
        .iter()
        .zip(&behind)
        .map(|(a, b)| (a - b) / (2.0 * step))
        .collect();
    assert!(distance(&by_frequency, &differences) < 3e-8);
    let changes = (0..3).map(|i| (slope[i]).abs()).fold(0.0, f64::max);
    assert!(changes > 1e-2, "the orbit depends on the frequency");
}
