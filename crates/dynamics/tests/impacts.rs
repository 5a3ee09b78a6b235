//! Rigid stops: impacts, chatter and contact (theory 05 §6.4, §8.2).

use slackside_dynamics::flow::{ExactFlow, Flow, Request};
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_linalg::Matrix;
use slackside_mechanics::laws::{coulomb, rigid_stop};
use slackside_mechanics::{
    Element, Forcing, FrequencyFamily, Harmonic, OperatingPoint, Output, Port, System,
};
use slackside_testkit::{number, reference};
use std::f64::consts::TAU;
use std::sync::Arc;

/// `x'' + 2ζx' + kx = F₀ + cos(Ωt + φ)` with a stop.
fn oscillator(
    zeta: f64,
    stiffness: f64,
    constant: f64,
    phase: Option<f64>,
    gap: f64,
    restitution: f64,
) -> System {
    let harmonics = phase.map(|phase| Harmonic {
        order: 1,
        cosine: vec![phase.cos()],
        sine: vec![-phase.sin()],
    });
    System {
        coordinates: vec!["x".into()],
        mass: Matrix::identity(1),
        damping: Matrix::diagonal(&[2.0 * zeta]),
        stiffness: Matrix::diagonal(&[stiffness]),
        damping_linear_in_frequency: None,
        stiffness_quadratic_in_frequency: None,
        forcing: Forcing {
            constant: vec![constant],
            harmonics: harmonics.into_iter().collect(),
        },
        elements: vec![Element::new(
            "stop",
            Port::new([(0, 1.0)]),
            rigid_stop(gap, restitution),
        )],
        outputs: vec![Output::coordinate("x", 0), Output::element_force("stop", 0)],
    }
}

fn point(system: System, frequency: f64) -> OperatingPoint {
    OperatingPoint {
        system: Arc::new(system),
        frequency,
    }
}

/// The impact oscillator of theory 05 §8.2 with one impact per period, started just after its impact: it returns there, and
/// the determinant of its period map is `e² exp(−2ζT)`.
#[test]
fn one_impact_per_period_is_the_closed_form() {
    for entry in reference("nonsmooth_three_pulley.json")["impact"]
        .as_array()
        .unwrap()
    {
        let value = |key: &str| number(&entry[key]);
        let (r, e, zeta) = (value("r"), value("e"), value("zeta"));
        let (gap, speed) = (value("gap"), value("impact_speed"));
        let system = oscillator(zeta, 1.0, 0.0, Some(value("phase")), gap, e);
        // Away from the impact at phase zero: the state a little later.
        let mut later = system.clone();
        let shift = 0.3;
        let phase = value("phase") + r * shift;
        later.forcing.harmonics[0].cosine[0] = phase.cos();
        later.forcing.harmonics[0].sine[0] = -phase.sin();
        let state = free_motion(&system, r, &[gap, -e * speed], shift);
        let family = Arc::new(FrequencyFamily::new(Arc::new(later.clone())));
        let mut shooting = Shooting::new(family, r, 1).unwrap();
        let (end, monodromy, _) = shooting.map(&state, r).unwrap();
        for (a, b) in end.iter().zip(&state) {
            assert!((a - b).abs() < 1e-12, "{entry}: {end:?} {state:?}");
        }
        let determinant = monodromy[(0, 0)] * monodromy[(1, 1)] - monodromy[(0, 1)] * monodromy[(1, 0)];
        let expected = e * e * (-2.0 * zeta * TAU / r).exp();
        assert!((determinant - expected).abs() < 1e-11, "{determinant} {expected}");
        // The map's derivative against differences.
        for j in 0..2 {
            let step = 1e-6;
            let moved = |sign: f64| {
                let mut x = state.clone();
                x[j] += sign * step;
                let mut flow = ExactFlow::new(&point(later.clone(), r)).unwrap();
                flow.advance(&mut x, 1, &mut []).unwrap();
                x
            };
            let (plus, minus) = (moved(1.0), moved(-1.0));
            for i in 0..2 {
                let difference = (plus[i] - minus[i]) / (2.0 * step);
                assert!((difference - monodromy[(i, j)]).abs() < 1e-7 * monodromy.max_abs().max(1.0));
            }
        }
        let mut flow = ExactFlow::new(&point(later, r)).unwrap();
        let request = Request {
            account: true,
            extremes: true,
            ..Request::default()
        };
        let record = flow
            .record(&mut state.clone(), 1, &system.outputs, &request)
            .unwrap();
        let account = record.account.unwrap();
        assert_eq!(account.elements[0].impacts, 1);
        let loss = 0.5 * (1.0 - e * e) * speed * speed;
        assert!((account.elements[0].impact_loss - loss).abs() < 1e-12 * loss.max(1.0));
        assert!(account.imbalance() < 1e-11, "{}", account.imbalance());
        assert!((record.measures[0].max - gap).abs() < 1e-12);
    }
}

/// Motion without the stop over a time, by the classical Runge–Kutta method.
fn free_motion(system: &System, r: f64, start: &[f64], time: f64) -> Vec<f64> {
    let (damping, stiffness) = (system.damping[(0, 0)], system.stiffness[(0, 0)]);
    let load = &system.forcing.harmonics[0];
    let slope = |t: f64, x: f64, v: f64| {
        let force = load.cosine[0] * (r * t).cos() + load.sine[0] * (r * t).sin();
        (v, force - damping * v - stiffness * x)
    };
    let (mut x, mut v) = (start[0], start[1]);
    let steps = 2000;
    let h = time / f64::from(steps);
    for k in 0..steps {
        let t = f64::from(k) * h;
        let a = slope(t, x, v);
        let b = slope(t + 0.5 * h, x + 0.5 * h * a.0, v + 0.5 * h * a.1);
        let c = slope(t + 0.5 * h, x + 0.5 * h * b.0, v + 0.5 * h * b.1);
        let d = slope(t + h, x + h * c.0, v + h * c.1);
        x += h / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + d.0);
        v += h / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + d.1);
    }
    vec![x, v]
}

/// A mass pressed against its stop by a constant force: impact `k` comes at `t₁ + (2 v₁ e/a)(1 − e^k)/(1 − e)`, and after
/// infinitely many it lies still.
#[test]
fn chatter_ends_in_contact() {
    let (a, e, gap) = (2.0, 0.6, 0.5);
    // Frequency so low that all of it happens in one period.
    let system = oscillator(0.0, 0.0, a, None, gap, e);
    let frequency = 0.5;
    let mut flow = ExactFlow::new(&point(system.clone(), frequency)).unwrap();
    let mut state = vec![0.0, 0.0];
    let request = Request {
        account: true,
        ..Request::default()
    };
    let record = flow.record(&mut state, 1, &system.outputs, &request).unwrap();
    let first = (2.0 * gap / a).sqrt();
    let speed = a * first;
    let hits: Vec<f64> = record
        .events
        .iter()
        .map(|event| event.phase / frequency)
        .collect();
    for (k, time) in hits.iter().enumerate().take(20) {
        let expected = first + 2.0 * speed * e / a * (1.0 - e.powi(k as i32)) / (1.0 - e);
        assert!((time - expected).abs() < 1e-12, "{k}: {time} {expected}");
    }
    let end = first + 2.0 * speed * e / a / (1.0 - e);
    assert!(
        (hits.last().unwrap() - end).abs() < 1e-8,
        "{} {end}",
        hits.last().unwrap()
    );
    assert_eq!(record.events.last().unwrap().to, 1, "it lies on the stop");
    assert_eq!(state, [gap, 0.0]);
    let account = record.account.unwrap();
    // All kinetic energy of the first hit is gone.
    assert!((account.elements[0].impact_loss - 0.5 * speed * speed).abs() < 1e-12);
    // The force of contact is the pressing one.
    let again = flow.record(&mut state, 1, &system.outputs, &request).unwrap();
    assert!(again.events.is_empty() && (again.measures[1].mean - a).abs() < 1e-13);
}

/// Dry friction transmits no impulse: a second mass that sticks and is hit through its spring-free neighbour begins to slide.
#[test]
fn a_sticking_mass_that_is_hit_slides() {
    let mass = Matrix::from_rows(&[vec![1.0, 0.3], vec![0.3, 1.0]]).unwrap();
    let system = System {
        coordinates: vec!["x".into(), "y".into()],
        mass,
        damping: Matrix::zeros(2, 2),
        stiffness: Matrix::zeros(2, 2),
        damping_linear_in_frequency: None,
        stiffness_quadratic_in_frequency: None,
        forcing: Forcing {
            constant: vec![1.0, 0.0],
            harmonics: vec![],
        },
        elements: vec![
            Element::new("stop", Port::new([(0, 1.0)]), rigid_stop(0.5, 0.5)),
            Element::new("friction", Port::new([(1, 1.0)]), coulomb(0.4, 1.0)),
        ],
        outputs: vec![],
    };
    let mut flow = ExactFlow::new(&point(system, 1.0)).unwrap();
    let mut state = vec![0.0; 4];
    let record = flow.record(&mut state, 1, &[], &Request::default()).unwrap();
    let hit = &record.events[0];
    assert_eq!((hit.element, hit.from, hit.to), (0, 0, 0));
    assert!(
        (hit.phase - 1.0).abs() < 1e-12,
        "the held mass leaves x'' = 1: hit at t = 1"
    );
    let slides = &record.events[1];
    assert_eq!(
        (slides.element, slides.from, slides.to),
        (1, 1, 2),
        "pushed forward through the mass matrix"
    );
    assert!(slides.phase == hit.phase);
}
