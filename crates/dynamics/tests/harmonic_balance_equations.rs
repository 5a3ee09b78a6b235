//! The equations of harmonic balance against differences and against the full, uncondensed equations, on arbitrary systems.

use slackside_continuation::{Evaluation, Family};
use slackside_dynamics::orbit::harmonic_balance::{
    HarmonicBalance, HarmonicBalanceError, Settings, SolveStop, StabilityMethod, Start, solve,
};
use slackside_linalg::{Complex, Lu, Matrix};
use slackside_mechanics::laws::{
    Cubic, Isolator, Smoothed, Smoothing, backlash, one_way_damper, stop, wrap_spring,
};
use slackside_mechanics::{
    Element, Forcing, FrequencyFamily, Harmonic, OperatingPoint, Output, OutsideDomain, Port, System,
    SystemFamily,
};
use std::f64::consts::TAU;
use std::sync::Arc;

/// A reproducible sequence in (−1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        // Multiplicative congruential generator of Lehmer with modulus 2³¹ − 1.
        self.0 = self.0 * 48271 % 2_147_483_647;
        2.0 * self.0 as f64 / 2_147_483_647.0 - 1.0
    }

    fn matrix(&mut self, n: usize, size: f64) -> Matrix {
        let mut matrix = Matrix::zeros(n, n);
        matrix
            .as_mut_slice()
            .iter_mut()
            .for_each(|v| *v = size * self.next());
        matrix
    }

    /// Symmetric with eigenvalues above `floor`.
    fn definite(&mut self, n: usize, size: f64, floor: f64) -> Matrix {
        let a = self.matrix(n, size.sqrt());
        let mut matrix = a.product(&a.transpose());
        (0..n).for_each(|i| matrix[(i, i)] += floor);
        matrix
    }
}

/// A system of `n` coordinates with gyroscopic, frequency-dependent and nonsymmetric terms and two loads.
fn arbitrary(n: usize, seed: u64, elements: Vec<Element>) -> System {
    let mut random = Random(seed);
    let mut damping = random.definite(n, 0.2, 0.1);
    let gyroscopic = random.matrix(n, 0.1);
    damping.add_scaled(1.0, &gyroscopic);
    damping.add_scaled(-1.0, &gyroscopic.transpose());
    let mut load = |size: f64| (0..n).map(|_| size * random.next()).collect::<Vec<_>>();
    let mut forcing = Forcing {
        constant: load(0.6),
        harmonics: vec![],
    };
    for order in [1, 2] {
        forcing.add_harmonic(Harmonic {
            order,
            cosine: load(2.0),
            sine: load(2.0),
        });
    }
    System {
        coordinates: (0..n).map(|i| format!("q{i}")).collect(),
        mass: random.definite(n, 0.3, 1.0),
        damping,
        stiffness: random.definite(n, 3.0, 1.0),
        damping_linear_in_frequency: Some(random.matrix(n, 0.05)),
        stiffness_quadratic_in_frequency: Some(random.matrix(n, 0.05)),
        forcing,
        elements,
        outputs: vec![],
    }
}

fn ports(n: usize) -> [Port; 2] {
    [
        Port::new([(0, 1.0), (1, -0.7)]),
        Port::new([(1, 0.4), (n - 1, 1.0)]),
    ]
}

/// Pairs of laws: exact with exact, exact with sampled, displacement with velocity.
fn cases() -> Vec<(usize, Vec<Element>)> {
    let mut result = Vec::new();
    for n in 3..=5 {
        let [a, b] = ports(n);
        result.push((
            n,
            vec![
                Element::new("clutch", a.clone(), wrap_spring(3.0)),
                Element::new("gear", b.clone(), backlash(2.0, 0.2)),
            ],
        ));
        result.push((
            n,
            vec![
                Element::new("damper", a.clone(), one_way_damper(0.8)),
                Element::new(
                    "isolator",
                    Port::new([(2, 1.0)]),
                    Isolator {
                        stiffness: 0.5,
                        damping: 0.1,
                    },
                ),
                Element::new(
                    "cubic",
                    b.clone(),
                    Cubic {
                        linear: 1.0,
                        cubic: 0.6,
                    },
                ),
            ],
        ));
        result.push((
            n,
            vec![
                Element::new(
                    "smooth",
                    a,
                    Smoothed::new(one_way_damper(0.8), Smoothing::Tanh, 0.3),
                ),
                Element::new("stop", b, stop(4.0, 0.3)),
            ],
        ));
    }
    result
}

fn evaluation(family: &mut HarmonicBalance, z: &[f64], p: f64) -> Evaluation {
    let mut evaluation = Evaluation::new(family.dimension());
    family.evaluate(z, p, &mut evaluation).unwrap();
    evaluation
}

/// A multiple of a unit vector or of a random direction added to `z`.
fn shifted(z: &[f64], direction: &[f64], step: f64) -> Vec<f64> {
    z.iter().zip(direction).map(|(a, b)| a + step * b).collect()
}

#[test]
fn jacobian_and_frequency_derivative_agree_with_differences() {
    for (index, (n, elements)) in cases().into_iter().enumerate() {
        let system = Arc::new(arbitrary(n, 17 + index as u64, elements));
        system.check().unwrap();
        for subharmonic in [1, 2] {
            let settings = Settings {
                subharmonic,
                ..Settings::fixed(7)
            };
            let family = Arc::new(FrequencyFamily::new(system.clone()));
            let mut family = HarmonicBalance::new(family, 1.3, settings).unwrap();
            let mut random = Random(99 + index as u64);
            let z: Vec<f64> = (0..family.dimension()).map(|_| 0.3 * random.next()).collect();
            let at = evaluation(&mut family, &z, 1.3);
            for _ in 0..6 {
                let direction: Vec<f64> = (0..z.len()).map(|_| random.next()).collect();
                let h = 1e-5;
                let plus = evaluation(&mut family, &shifted(&z, &direction, h), 1.3).residual;
                let minus = evaluation(&mut family, &shifted(&z, &direction, -h), 1.3).residual;
                for (i, exact) in at.jacobian.times(&direction).iter().enumerate() {
                    let difference = (plus[i] - minus[i]) / (2.0 * h);
                    assert!(
                        (difference - exact).abs() < 3e-7,
                        "case {index}, row {i}: {difference} {exact}"
                    );
                }
            }
            let h = 1e-4;
            let mut residual = |step: f64| evaluation(&mut family, &z, 1.3 + step).residual;
            let values = [residual(-2.0 * h), residual(-h), residual(h), residual(2.0 * h)];
            for i in 0..z.len() {
                let difference =
                    (values[0][i] - 8.0 * values[1][i] + 8.0 * values[2][i] - values[3][i]) / (12.0 * h);
                assert!(
                    (difference - at.by_parameter[i]).abs() < 1e-8,
                    "case {index}, row {i}: d/dΩ"
                );
            }
        }
    }
}

/// The same frequency family, but claiming to be about another parameter.
struct Disguised(FrequencyFamily);

impl SystemFamily for Disguised {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        self.0.at(parameter)
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

#[test]
fn differences_in_a_parameter_reproduce_the_exact_derivative() {
    let (n, elements) = cases().swap_remove(1);
    let frequency = FrequencyFamily::new(Arc::new(arbitrary(n, 5, elements)));
    let mut exact = HarmonicBalance::new(Arc::new(frequency.clone()), 1.1, Settings::fixed(9)).unwrap();
    let mut difference =
        HarmonicBalance::new(Arc::new(Disguised(frequency)), 1.1, Settings::fixed(9)).unwrap();
    let mut random = Random(3);
    let z: Vec<f64> = (0..exact.dimension()).map(|_| 0.3 * random.next()).collect();
    let (a, b) = (
        evaluation(&mut exact, &z, 1.1),
        evaluation(&mut difference, &z, 1.1),
    );
    assert_eq!(a.residual, b.residual);
    for (x, y) in a.by_parameter.iter().zip(&b.by_parameter) {
        assert!((x - y).abs() < 1e-9, "{x} {y}");
    }
}

/// Residual of the full equations in all coordinates, harmonic by harmonic, with the element forces by brute-force
/// quadrature of the laws.
fn full_residual(system: &System, frequency: f64, subharmonic: usize, q: &[Vec<Complex>]) -> f64 {
    let (n, harmonics) = (system.order(), q[0].len() - 1);
    let omega = frequency / subharmonic as f64;
    let samples = 40_000;
    let mut forces = vec![vec![Complex::new(0.0, 0.0); harmonics + 1]; n];
    for s in 0..samples {
        let angle = TAU * (s as f64 + 0.5) / samples as f64;
        let turn = |k: usize| Complex::cis(k as f64 * angle);
        let at: Vec<f64> = q
            .iter()
            .map(|q| (0..=harmonics).map(|k| (q[k] * turn(k)).re).sum())
            .collect();
        let rate = |q: &Vec<Complex>| {
            (0..=harmonics)
                .map(|k| (q[k] * turn(k) * Complex::new(0.0, k as f64 * omega)).re)
                .sum::<f64>()
        };
        let rates: Vec<f64> = q.iter().map(rate).collect();
        for element in &system.elements {
            let response = element
                .law
                .response(element.port.project(&at), element.port.project(&rates));
            for &(i, factor) in element.port.terms() {
                for (k, f) in forces[i].iter_mut().enumerate() {
                    let weight = if k == 0 { 1.0 } else { 2.0 };
                    *f += weight / samples as f64 * factor * response.force * turn(k).conj();
                }
            }
        }
    }
    let mut largest = 0.0_f64;
    for k in 0..=harmonics {
        let stiffness = system.dynamic_stiffness(k as f64 * omega, frequency);
        let column: Vec<_> = q.iter().map(|q| q[k]).collect();
        for (i, value) in stiffness.times(&column).iter().enumerate() {
            let mut r = value + forces[i][k];
            if k == 0 {
                r -= system.forcing.constant[i];
            }
            for load in &system.forcing.harmonics {
                if load.order * subharmonic == k {
                    r -= Complex::new(load.cosine[i], -load.sine[i]);
                }
            }
            largest = largest.max(r.norm());
        }
    }
    largest
}

#[test]
fn condensed_solutions_satisfy_the_full_equations() {
    for (index, (n, elements)) in cases().into_iter().enumerate().take(3) {
        let point = OperatingPoint {
            system: Arc::new(arbitrary(n, 40 + index as u64, elements)),
            frequency: 1.7,
        };
        let solution = solve(&point, Start::Linear, &Settings::fixed(6)).unwrap();
        assert_eq!(solution.stop, SolveStop::Converged, "case {index}");
        // The equations hold for the harmonics solved for.
        let solved: Vec<Vec<Complex>> = solution
            .orbit
            .coordinates
            .iter()
            .map(|q| q[..7].to_vec())
            .collect();
        let residual = full_residual(&point.system, 1.7, 1, &solved);
        // The midpoint rule of the check errs by its step squared at kinks; without kinks it is exact.
        let tolerance = if solution.orbit.events.is_empty() {
            1e-12
        } else {
            2e-8
        };
        assert!(residual < tolerance, "case {index}: {residual}");
    }
}

/// Unknowns of the full equations and of the condensed ones for a law without kinks agree to rounding.
#[test]
fn condensed_and_full_newton_agree_to_rounding() {
    let [a, b] = ports(3);
    let law = Cubic {
        linear: 1.0,
        cubic: 0.6,
    };
    let elements = vec![
        Element::new("a", a, law),
        Element::new(
            "b",
            b,
            Cubic {
                linear: 0.3,
                cubic: 0.2,
            },
        ),
    ];
    let point = OperatingPoint {
        system: Arc::new(arbitrary(3, 71, elements)),
        frequency: 0.9,
    };
    let harmonics = 5;
    let condensed = solve(&point, Start::Linear, &Settings::fixed(harmonics)).unwrap();
    assert_eq!(condensed.stop, SolveStop::Converged);
    // The full equations by Newton's method with a difference Jacobian, from a neighbouring point.
    let pack = |q: &[Vec<Complex>]| -> Vec<f64> {
        q.iter()
            .flat_map(|q| (0..=harmonics).flat_map(|k| [q[k].re, q[k].im]))
            .collect()
    };
    let residual = |x: &[f64]| full_equations(&point.system, point.frequency, harmonics, x);
    let mut x: Vec<f64> = pack(&condensed.orbit.coordinates);
    let exact = x.clone();
    x.iter_mut()
        .enumerate()
        .for_each(|(i, v)| *v += 1e-3 * (i as f64).sin());
    for _ in 0..8 {
        let r = residual(&x);
        let mut jacobian = Matrix::zeros(x.len(), x.len());
        for j in 0..x.len() {
            let mut plus = x.clone();
            plus[j] += 1e-6;
            let column = residual(&plus);
            for i in 0..x.len() {
                jacobian[(i, j)] = (column[i] - r[i]) / 1e-6;
            }
        }
        let step = Lu::new(&jacobian).unwrap().solve(&r);
        x.iter_mut().zip(&step).for_each(|(v, s)| *v -= s);
    }
    for (found, expected) in exact.iter().zip(&x) {
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
}

/// All equations in real form for polynomial laws: 32 samples integrate a cube of five harmonics exactly. The imaginary
/// part of the mean has the equation "zero".
fn full_equations(system: &System, frequency: f64, harmonics: usize, x: &[f64]) -> Vec<f64> {
    let n = system.order();
    let width = 2 * (harmonics + 1);
    let q: Vec<Vec<Complex>> = x
        .chunks(width)
        .map(|c| c.chunks(2).map(|pair| Complex::new(pair[0], pair[1])).collect())
        .collect();
    let mut result = vec![0.0; x.len()];
    let mut forces = vec![vec![Complex::new(0.0, 0.0); harmonics + 1]; n];
    let samples = 32;
    for s in 0..samples {
        let turn = |k: usize| Complex::cis(TAU * (k * s) as f64 / samples as f64);
        let at: Vec<f64> = q
            .iter()
            .map(|q| (0..=harmonics).map(|k| (q[k] * turn(k)).re).sum())
            .collect();
        for element in &system.elements {
            let force = element.law.response(element.port.project(&at), 0.0).force;
            for &(i, factor) in element.port.terms() {
                for (k, f) in forces[i].iter_mut().enumerate() {
                    let weight = if k == 0 { 1.0 } else { 2.0 };
                    *f += weight / samples as f64 * factor * force * turn(k).conj();
                }
            }
        }
    }
    for k in 0..=harmonics {
        let column: Vec<_> = q.iter().map(|q| q[k]).collect();
        let stiffness = system.dynamic_stiffness(k as f64 * frequency, frequency);
        for (i, value) in stiffness.times(&column).iter().enumerate() {
            let mut r = value + forces[i][k];
            if k == 0 {
                r = Complex::new(r.re - system.forcing.constant[i], q[i][0].im);
            }
            for load in system.forcing.harmonics.iter().filter(|load| load.order == k) {
                r -= Complex::new(load.cosine[i], -load.sine[i]);
            }
            (result[i * width + 2 * k], result[i * width + 2 * k + 1]) = (r.re, r.im);
        }
    }
    result
}

#[test]
fn measures_of_forces_follow_the_law_itself() {
    // A rigidly driven clutch spring: one coordinate, u = q, so that all is known in closed form from the orbit.
    let (_, elements) = cases().swap_remove(0);
    let mut system = arbitrary(3, 12, elements);
    system.outputs = vec![
        Output::element_force("clutch", 0),
        Output {
            name: "mixed".into(),
            constant: 0.3,
            displacement: vec![(0, 2.0)],
            velocity: vec![(1, 0.5)],
            force: vec![(0, 1.0), (1, -2.0)],
            harmonics: vec![(1, 0.2, 0.1), (3, 0.4, -0.3)],
        },
    ];
    let point = OperatingPoint {
        system: Arc::new(system),
        frequency: 1.2,
    };
    let solution = solve(&point, Start::Linear, &Settings::fixed(20)).unwrap();
    assert_eq!(solution.stop, SolveStop::Converged);
    let orbit = &solution.orbit;
    assert!(orbit.events.len() >= 2);
    let samples = 200_000;
    for (index, measure) in orbit.measures().iter().enumerate() {
        let output = &point.system.outputs[index];
        let (mut sum, mut squares, mut max, mut min) = (0.0, 0.0, f64::MIN, f64::MAX);
        let values: Vec<f64> = (0..samples / 10)
            .map(|s| {
                let phase = TAU * (s as f64 + 0.5) / (samples / 10) as f64;
                let state = orbit.state_at(phase);
                let mut y = output.constant;
                y += output
                    .displacement
                    .iter()
                    .map(|&(i, f)| f * state[i])
                    .sum::<f64>();
                y += output
                    .velocity
                    .iter()
                    .map(|&(i, f)| f * state[3 + i])
                    .sum::<f64>();
                for &(e, factor) in &output.force {
                    let element = &point.system.elements[e];
                    let (u, v) = (
                        element.port.project(&state[..3]),
                        element.port.project(&state[3..]),
                    );
                    y += factor * element.law.response(u, v).force;
                }
                for &(order, c, s) in &output.harmonics {
                    y += c * (order as f64 * phase).cos() + s * (order as f64 * phase).sin();
                }
                y
            })
            .collect();
        for &y in &values {
            sum += y;
            max = y.max(max);
            min = y.min(min);
        }
        let mean = sum / values.len() as f64;
        values.iter().for_each(|y| squares += (y - mean).powi(2));
        let rms = (squares / values.len() as f64).sqrt();
        // The mean is that of the forces in balance, along H harmonics.
        assert!((measure.mean - mean).abs() < 1e-6, "mean {} {mean}", measure.mean);
        assert!((measure.rms - rms).abs() < 1e-7, "rms {} {rms}", measure.rms);
        assert!(
            (0.0..1e-6).contains(&(measure.max - max)),
            "max {} {max}",
            measure.max
        );
        assert!(
            (-1e-6..1e-15).contains(&(measure.min - min)),
            "min {} {min}",
            measure.min
        );
    }
}

#[test]
fn a_free_mean_is_refused_with_the_element_to_change() {
    let mut system = arbitrary(3, 9, vec![]);
    system.stiffness_quadratic_in_frequency = None;
    for i in 0..3 {
        system.stiffness[(2, i)] = 0.0;
        system.stiffness[(i, 2)] = 0.0;
    }
    let port = Port::new([(0, 1.0), (2, -1.0)]);
    let hardening = Cubic {
        linear: 0.0,
        cubic: 1.0,
    };
    system.elements = vec![
        Element::new("spring", Port::new([(0, 1.0)]), wrap_spring(2.0)),
        Element::new("hardening", port.clone(), hardening),
    ];
    let settings = Settings::fixed(4);
    let point = |system: &System| OperatingPoint {
        system: Arc::new(system.clone()),
        frequency: 1.0,
    };
    match solve(&point(&system), Start::Linear, &settings) {
        Err(HarmonicBalanceError::FreeMean { candidates }) => assert_eq!(candidates, ["hardening"]),
        other => panic!("expected a free mean, found {other:?}"),
    }
    system.elements[1] = Element::new("engaged", port, wrap_spring(1.0));
    assert!(solve(&point(&system), Start::Linear, &settings).is_ok());
}

#[test]
fn unsound_settings_and_starts_are_named() {
    let (n, elements) = cases().swap_remove(0);
    let point = OperatingPoint {
        system: Arc::new(arbitrary(n, 1, elements)),
        frequency: 1.0,
    };
    let name = |settings: &Settings| match solve(&point, Start::Linear, settings) {
        Err(HarmonicBalanceError::Setting { name, .. }) => name,
        other => panic!("expected a refused setting, found {other:?}"),
    };
    // The load has order two.
    assert_eq!(name(&Settings::fixed(1)), "harmonics");
    assert_eq!(
        name(&Settings {
            subharmonic: 0,
            ..Settings::fixed(4)
        }),
        "subharmonic"
    );
    assert_eq!(
        name(&Settings {
            subharmonic: 3,
            ..Settings::fixed(4)
        }),
        "harmonics"
    );
    assert_eq!(
        name(&Settings {
            tolerance: 0.0,
            ..Settings::fixed(4)
        }),
        "tolerance"
    );
    let start = solve(&point, Start::Samples(&[vec![0.0; 8]]), &Settings::fixed(4));
    assert!(matches!(
        start,
        Err(HarmonicBalanceError::Start {
            expected: 2,
            found: 1,
            ..
        })
    ));
}

#[test]
fn samples_of_a_motion_are_a_start() {
    let (n, elements) = cases().swap_remove(0);
    let point = OperatingPoint {
        system: Arc::new(arbitrary(n, 40, elements)),
        frequency: 1.7,
    };
    let first = solve(&point, Start::Linear, &Settings::fixed(12)).unwrap();
    let samples: Vec<Vec<f64>> = first.orbit.displacements.iter().map(|h| sampled(h, 64)).collect();
    let again = solve(&point, Start::Samples(&samples), &Settings::fixed(12)).unwrap();
    assert!(again.iterations <= 2);
    for (a, b) in first
        .orbit
        .initial_state()
        .iter()
        .zip(again.orbit.initial_state())
    {
        assert!((a - b).abs() < 1e-12);
    }
}

fn sampled(h: &[Complex], count: usize) -> Vec<f64> {
    (0..count)
        .map(|s| {
            let angle = TAU * s as f64 / count as f64;
            h.iter()
                .enumerate()
                .map(|(k, h)| (h * Complex::cis(k as f64 * angle)).re)
                .sum()
        })
        .collect()
}

#[test]
fn multipliers_of_two_elements_agree_between_methods() {
    for (index, (n, elements)) in cases().into_iter().enumerate().take(2) {
        let point = OperatingPoint {
            system: Arc::new(arbitrary(n, 40 + index as u64, elements)),
            frequency: 1.7,
        };
        let orbit = solve(&point, Start::Linear, &Settings::fixed(30)).unwrap().orbit;
        let default = orbit.stability().unwrap();
        let hill = orbit.stability_by(StabilityMethod::Hill).unwrap();
        let magnus = orbit.stability_by(StabilityMethod::Magnus).unwrap();
        for i in 0..2 * n {
            assert!(
                (default.multipliers[i] - magnus.multipliers[i]).norm() < 1e-8,
                "case {index}"
            );
            assert!(
                (default.multipliers[i] - hill.multipliers[i]).norm() < 2e-4,
                "case {index}: {i}"
            );
        }
    }
}

#[test]
fn hard_stops_are_reached_by_raising_the_remainder_forces() {
    // Stiff stops at half the linear amplitude of a lightly damped mass on both sides: full steps alone do not settle.
    let mut converged = 0;
    for seed in 0..20 {
        let mut random = Random(1000 + seed);
        let stiffness = random.definite(2, 1.0, 0.5);
        let mut forcing = Forcing::none(2);
        forcing.constant = vec![random.next(), random.next()];
        forcing.add_harmonic(Harmonic {
            order: 1,
            cosine: vec![3.0 * random.next(), 3.0 * random.next()],
            sine: vec![0.0; 2],
        });
        let system = System {
            coordinates: vec!["a".into(), "b".into()],
            mass: Matrix::identity(2),
            damping: stiffness.scaled(0.05),
            stiffness,
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing,
            elements: vec![
                Element::new("gear", Port::new([(0, 1.0)]), backlash(5.0, 0.1)),
                Element::new("stop", Port::new([(1, 1.0)]), stop(20.0, 0.2)),
            ],
            outputs: vec![],
        };
        let point = OperatingPoint {
            system: Arc::new(system),
            frequency: 0.9 + 0.1 * random.next(),
        };
        let solution = solve(&point, Start::Linear, &Settings::fixed(10)).unwrap();
        if solution.stop == SolveStop::Converged {
            converged += 1;
            assert!(solution.residual < 1e-10);
        }
    }
    assert!(converged >= 18, "{converged} of 20");
}
