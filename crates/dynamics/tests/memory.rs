//! Laws with an internal state: closed loops (theory 05 §6.3), the integrator and harmonic balance against each other.

use slackside_continuation::{Evaluation, Family};
use slackside_dynamics::flow::{self, ExactFlow, Flow, FlowError, Record, Request, SmoothFlow};
use slackside_dynamics::orbit::harmonic_balance::{
    HarmonicBalance, HarmonicBalanceError, Settings, SolveStop, Start, solve,
};
use slackside_dynamics::orbit::periodic::{PeriodicSearch, PeriodicSettings};
use slackside_linalg::Matrix;
use slackside_mechanics::laws::{LuGre, Stribeck, Valanis, coulomb, dahl, one_way, spring_slider};
use slackside_mechanics::{
    Element, Forcing, FrequencyFamily, Harmonic, Law, OperatingPoint, Output, Port, System,
};
use slackside_testkit::assert_close;
use std::sync::Arc;

const ACTING: usize = 3;

/// Two masses, the first of which carries the element; the load has frequency `frequency`. Outputs: displacement and
/// velocity of the first mass, displacement of the second, force of the element.
fn point(law: impl Law + 'static, frequency: f64) -> OperatingPoint {
    let rows = |rows: [[f64; 2]; 2]| Matrix::from_rows(&rows.map(|row| row.to_vec())).unwrap();
    let mut forcing = Forcing::none(2);
    forcing.add_harmonic(Harmonic {
        order: 1,
        cosine: vec![1.0, 0.3],
        sine: vec![0.2, 0.0],
    });
    let system = System {
        coordinates: vec!["first".into(), "second".into()],
        mass: Matrix::diagonal(&[1.0, 0.5]),
        damping: rows([[0.1, 0.02], [-0.01, 0.08]]),
        stiffness: rows([[3.0, -1.0], [-1.0, 2.0]]),
        damping_linear_in_frequency: Some(rows([[0.0, 0.03], [-0.03, 0.0]])),
        stiffness_quadratic_in_frequency: None,
        forcing,
        elements: vec![Element::new("acting", Port::new([(0, 1.0)]), law)],
        outputs: vec![
            Output::coordinate("displacement", 0),
            Output {
                name: "velocity".into(),
                velocity: vec![(0, 1.0)],
                ..Output::default()
            },
            Output::coordinate("second", 1),
            Output::element_force("force", 0),
        ],
    };
    system.check().unwrap();
    OperatingPoint {
        system: Arc::new(system),
        frequency,
    }
}

fn lugre(stiffness: f64) -> LuGre {
    LuGre {
        stiffness,
        damping: 0.05,
        viscous: 0.02,
        stribeck: Stribeck {
            torque: 0.4,
            static_ratio: 1.3,
            velocity: 0.5,
        },
    }
}

fn valanis() -> Valanis {
    Valanis::new(6.0, 0.5, 0.4, 0.3).unwrap()
}

/// The motion that repeats after one period: state at phase zero and record of one period.
fn periodic(point: &OperatingPoint) -> (Vec<f64>, Record) {
    let mut flow = flow::open(point).unwrap();
    let start = vec![0.0; flow.dimension()];
    let mut search = PeriodicSearch::new(flow.as_mut(), &point.system, PeriodicSettings::default());
    let motion = search.from_state(&start).unwrap();
    let request = Request {
        harmonics: 200,
        extremes: true,
        account: true,
        ..Request::default()
    };
    let record = search.record(&motion, &point.system.outputs, &request).unwrap();
    (motion.start, record)
}

/// `∮ f du` from the harmonics of force and displacement.
fn area(record: &Record) -> f64 {
    let (u, f) = (&record.measures[0].harmonics, &record.measures[ACTING].harmonics);
    let terms = u.iter().zip(f).enumerate();
    std::f64::consts::PI
        * terms
            .map(|(k, (u, f))| k as f64 * (f * u.conj()).im)
            .sum::<f64>()
            .abs()
}

#[test]
fn loop_of_dahl() {
    let (stiffness, torque) = (1.5, 0.6);
    let point = point(dahl(stiffness, torque), 1.1);
    assert_eq!(point.system.internal_states(), 1);
    let (start, record) = periodic(&point);
    assert_eq!(start.len(), 5);
    let amplitude = record.measures[0].max;
    assert_close(record.measures[0].min, -amplitude, 1e-10, "the loop is symmetric");
    let end = (stiffness * amplitude / torque).tanh();
    assert!(end < 0.99, "the loop is no rectangle");
    assert_close(
        record.measures[ACTING].max,
        torque * end,
        1e-10,
        "force at the end",
    );
    let expected = 4.0 * torque * amplitude - 4.0 * torque * torque / stiffness * end;
    assert_close(area(&record), expected, 1e-10, "area");
}

#[test]
fn loop_of_the_spring_slider() {
    let (stiffness, torque) = (5.0, 0.6);
    let point = point(spring_slider(stiffness, torque), 1.1);
    let (start, record) = periodic(&point);
    assert_eq!(start.len(), 5);
    let amplitude = 0.5 * (record.measures[0].max - record.measures[0].min);
    assert!(amplitude > torque / stiffness);
    let expected = 4.0 * torque * (amplitude - torque / stiffness);
    assert_close(record.account.unwrap().elements[0].work, expected, 1e-10, "area");
}

#[test]
fn lugre_tends_to_coulomb() {
    // Without Stribeck's fall and bristle damping, stiff bristles are dry friction.
    let friction = |stiffness: f64| LuGre {
        damping: 0.0,
        viscous: 0.0,
        stribeck: Stribeck {
            torque: 0.4,
            static_ratio: 1.0,
            velocity: 1.0,
        },
        ..lugre(stiffness)
    };
    let exact = periodic(&point(coulomb(0.4, 1.0), 1.1)).1.measures[0].rms;
    let errors: Vec<f64> = [1e2, 1e3, 1e4]
        .map(|stiffness| (periodic(&point(friction(stiffness), 1.1)).1.measures[0].rms / exact - 1.0).abs())
        .to_vec();
    assert!(errors[0] < 5e-2);
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!(
            (2.9..3.4).contains(&ratio),
            "of first order in the compliance: {errors:?}"
        );
    }
}

/// End of one period from a state, with its derivatives with respect to the state.
fn period(point: &OperatingPoint, start: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = start.len();
    let mut state = start.to_vec();
    let mut variations = vec![0.0; n * n];
    (0..n).for_each(|i| variations[i * n + i] = 1.0);
    SmoothFlow::new(point)
        .unwrap()
        .advance(&mut state, 1, &mut variations)
        .unwrap();
    (state, variations)
}

#[test]
fn variations_agree_with_differences() {
    let points = [
        point(dahl(5.0, 0.6), 1.1),
        point(lugre(30.0), 1.1),
        point(valanis(), 1.1),
    ];
    for point in &points {
        let start = [0.3, -0.2, 0.4, 0.1, 0.01];
        let (_, variations) = period(point, &start);
        for j in 0..5 {
            let h = 1e-6;
            let moved = |step: f64| {
                let mut from = start;
                from[j] += step;
                period(point, &from).0
            };
            let (plus, minus) = (moved(h), moved(-h));
            for i in 0..5 {
                let difference = (plus[i] - minus[i]) / (2.0 * h);
                assert_close(variations[j * 5 + i], difference, 2e-7, "variation");
            }
        }
    }
}

fn evaluation(family: &mut HarmonicBalance, z: &[f64], p: f64) -> Evaluation {
    let mut evaluation = Evaluation::new(family.dimension());
    family.evaluate(z, p, &mut evaluation).unwrap();
    evaluation
}

#[test]
fn derivatives_of_harmonic_balance() {
    let settings = Settings {
        samples: 512,
        refine_samples: false,
        ..Settings::fixed(5)
    };
    let points = [
        point(dahl(5.0, 0.6), 1.1),
        point(lugre(30.0), 1.1),
        point(valanis(), 1.1),
    ];
    for point in &points {
        let family = Arc::new(FrequencyFamily::new(point.system.clone()));
        let mut family = HarmonicBalance::new(family, 1.1, settings.clone()).unwrap();
        let z: Vec<f64> = (0..family.dimension())
            .map(|i| 0.4 * (1.7 * i as f64 + 0.6).sin() / (1.0 + i as f64))
            .collect();
        let at = evaluation(&mut family, &z, 1.1);
        let h = 1e-6;
        for j in 0..z.len() {
            let mut moved = |step: f64| {
                let mut z = z.clone();
                z[j] += step;
                evaluation(&mut family, &z, 1.1).residual
            };
            let (plus, minus) = (moved(h), moved(-h));
            for i in 0..z.len() {
                let difference = (plus[i] - minus[i]) / (2.0 * h);
                assert_close(at.jacobian[(i, j)], difference, 1e-6, "Jacobian");
            }
        }
        let (plus, minus) = (
            evaluation(&mut family, &z, 1.1 + h).residual,
            evaluation(&mut family, &z, 1.1 - h).residual,
        );
        for i in 0..z.len() {
            assert_close(at.by_parameter[i], (plus[i] - minus[i]) / (2.0 * h), 1e-6, "d/dΩ");
        }
    }
}

#[test]
fn harmonic_balance_and_integration_find_the_same_motion() {
    let laws: [OperatingPoint; 3] = [
        point(dahl(5.0, 0.6), 1.1),
        point(lugre(30.0), 1.1),
        point(valanis(), 1.1),
    ];
    for point in &laws {
        let settings = Settings {
            samples: 4096,
            refine_samples: false,
            ..Settings::fixed(60)
        };
        let solution = solve(point, Start::Linear, &settings).unwrap();
        assert_eq!(solution.stop, SolveStop::Converged);
        let orbit = &solution.orbit;
        let (start, record) = periodic(point);
        let found = orbit.initial_state();
        assert_eq!(found.len(), start.len());
        for (found, expected) in found.iter().zip(&start) {
            assert_close(*found, *expected, 1e-6, "state at phase zero");
        }
        for (found, expected) in orbit.measures().iter().zip(&record.measures) {
            assert_close(found.rms / expected.rms, 1.0, 4e-7, "rms");
        }
        assert!(matches!(
            orbit.stability(),
            Err(HarmonicBalanceError::NoTangent { .. })
        ));
    }
}

#[test]
fn a_clutch_beside_a_smooth_memory_is_refused_by_name() {
    let mut system = (*point(dahl(5.0, 0.6), 1.1).system).clone();
    let port = Port::new([(0, 1.0), (1, -1.0)]);
    system.elements.push(Element::new("overrunning", port, one_way()));
    let point = OperatingPoint {
        system: Arc::new(system),
        frequency: 1.1,
    };
    let Err(error) = flow::open(&point) else {
        panic!("neither flow covers the pair")
    };
    assert_eq!(
        error,
        FlowError::Mixed {
            smooth: "acting".into(),
            switching: "overrunning".into()
        }
    );
    assert!(ExactFlow::new(&point).is_err());
}
