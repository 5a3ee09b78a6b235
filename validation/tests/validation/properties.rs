//! Exact properties of theory 02 §1.10 and agreement of methods on random parameter sets, none of which is in a file.

use crate::common::{PULLEY, TORQUE, WINDUP, bisect, distance, point, record, shooting};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use slackside_belt_drive::prototypes::TwoPulley;
use slackside_dynamics::flow::{Request, open};
use slackside_dynamics::orbit::harmonic_balance::{Adaptation, Settings, SolveStop, Start, solve};
use slackside_dynamics::orbit::shooting::{Orbit, Shooting};
use slackside_linalg::Matrix;
use slackside_mechanics::laws::wrap_spring;
use slackside_mechanics::{
    Element, Forcing, Harmonic, OperatingPoint, Output, OutsideDomain, Port, System, SystemFamily, modes,
};
use slackside_testkit::two_pulley;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A two-pulley system with the frequency of its load.
#[derive(Debug, Clone)]
struct Case {
    keys: [f64; 7],
    frequency: f64,
}

const BELT: usize = 1;
const CLUTCH: usize = 2;
const PRELOAD: usize = 3;
const AMPLITUDE: usize = 4;
const ZETA: usize = 5;

impl Case {
    fn model(&self) -> TwoPulley {
        model(&self.keys)
    }

    fn system(&self) -> Arc<System> {
        Arc::new(self.model().system().unwrap())
    }

    /// `2 (ζ₁ω₁ + ζ₂ω₂)`, the rate at which volume in state space shrinks.
    fn decay(&self) -> f64 {
        let modes = modes(&self.system(), 1.0, true).unwrap();
        2.0 * (self.keys[ZETA] * modes[0].frequency + self.keys[ZETA + 1] * modes[1].frequency)
    }

    fn rest(&self) -> [f64; 4] {
        [0.0, -self.model().static_windup(), 0.0, 0.0]
    }

    /// An orbit that the motion from rest has settled on, if it repeats with the load within 4000 periods.
    fn settled(&self) -> Option<(Shooting, Orbit)> {
        let system = self.system();
        let mut state = self.rest().to_vec();
        let mut flow = open(&point(&system, self.frequency)).unwrap();
        flow.advance(&mut state, 4000, &mut []).unwrap();
        let mut solver = shooting(&system, self.frequency, 1);
        let orbit = solver.solve(&state, self.frequency).ok()?;
        let size = 1.0 + orbit.start.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        (orbit.is_stable() && distance(&orbit.start, &state) < 1e-6 * size).then_some((solver, orbit))
    }
}

fn model(keys: &[f64; 7]) -> TwoPulley {
    let [alpha, belt, clutch, preload, amplitude, zeta, other] = *keys;
    two_pulley(alpha, 1.0, belt, clutch, preload, amplitude, [zeta, other])
}

/// Frequencies about either resonance and excitations that mostly separate the clutch.
fn cases() -> impl Strategy<Value = Case> {
    let keys = (
        0.3..5.0_f64,
        1.0..20.0_f64,
        5.0..100.0_f64,
        0.5..2.0_f64,
        0.1..1.5_f64,
        0.01..0.08_f64,
        0.01..0.08_f64,
    );
    (keys, any::<bool>(), 0.75..1.15_f64).prop_map(
        |((alpha, belt, clutch, preload, share, z1, z2), second, factor)| {
            // The excitation torque is a share of the preload.
            let keys = [alpha, belt, clutch, preload, share * preload / belt, z1, z2];
            let modes = modes(&model(&keys).system().unwrap(), 1.0, true).unwrap();
            let frequency = factor * modes[usize::from(second)].frequency;
            Case { keys, frequency }
        },
    )
}

/// Starts with a wind-up and rates of the size of those of the motion.
fn starts() -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(-0.4..0.4_f64)
}

fn seeded(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        // Chaotic and quasi-periodic cases are set aside, but not without limit.
        max_global_rejects: 2 * cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20),
        ..ProptestConfig::default()
    }
}

/// Systems over one key.
struct OverKey {
    case: Case,
    key: usize,
}

impl SystemFamily for OverKey {
    fn at(&self, parameter: f64) -> Result<OperatingPoint, OutsideDomain> {
        let mut keys = self.case.keys;
        keys[self.key] = parameter;
        let system = model(&keys).system().map_err(|e| OutsideDomain(e.to_string()))?;
        Ok(OperatingPoint {
            system: Arc::new(system),
            frequency: self.case.frequency,
        })
    }

    fn is_frequency(&self) -> bool {
        false
    }
}

/// The same system from formulas: (C2), modes by (C3), damping by §1.7.
fn by_matrices(keys: &[f64; 7], outputs: Vec<Output>) -> System {
    let [alpha, belt, clutch, preload, amplitude, z1, z2] = *keys;
    let sum = belt + clutch + clutch / alpha;
    let root = ((belt + clutch - clutch / alpha).powi(2) + 4.0 * clutch * clutch / alpha).sqrt();
    let upper = 0.5 * (sum + root);
    let lower = belt * clutch / alpha / upper;
    let mut damping = Matrix::zeros(2, 2);
    for (lambda, zeta) in [(lower, z1), (upper, z2)] {
        let shape = [clutch, belt + clutch - lambda];
        let norm = shape[0] * shape[0] + alpha * shape[1] * shape[1];
        let momentum = [shape[0], alpha * shape[1]];
        for i in 0..2 {
            for j in 0..2 {
                damping[(i, j)] += 2.0 * zeta * lambda.sqrt() * momentum[i] * momentum[j] / norm;
            }
        }
    }
    let mut forcing = Forcing::none(2);
    forcing.constant = vec![preload, -preload];
    forcing.add_harmonic(Harmonic {
        order: 1,
        cosine: vec![belt * amplitude, 0.0],
        sine: vec![0.0, 0.0],
    });
    System {
        coordinates: vec!["p".into(), "a".into()],
        mass: Matrix::diagonal(&[1.0, alpha]),
        damping,
        stiffness: Matrix::diagonal(&[belt, 0.0]),
        damping_linear_in_frequency: None,
        stiffness_quadratic_in_frequency: None,
        forcing,
        elements: vec![Element::new(
            "clutch",
            Port::new([(0, 1.0), (1, -1.0)]),
            wrap_spring(clutch),
        )],
        outputs,
    }
}

/// The cubic through values and slopes at the ends of `[0, h]`, at `x`.
fn hermite(y: [f64; 2], slope: [f64; 2], h: f64, x: f64) -> f64 {
    let s = x / h;
    let (a, b) = (1.0 - s, s);
    y[0] * a * a * (1.0 + 2.0 * s) + y[1] * b * b * (3.0 - 2.0 * s) + h * slope[0] * s * a * a
        - h * slope[1] * b * b * a
}

proptest! {
    #![proptest_config(seeded(48))]

    /// Property 1: `(θ, M, A_m) → s (θ, M, A_m)`.
    #[test]
    fn motions_scale_with_preload_and_amplitude(case in cases(), start in starts(), s in 0.05..20.0_f64) {
        let mut scaled = case.clone();
        scaled.keys[PRELOAD] *= s;
        scaled.keys[AMPLITUDE] *= s;
        let moved = start.map(|x| s * x);
        let a = record(&case.system(), case.frequency, &start, 4, 3, 8);
        let b = record(&scaled.system(), case.frequency, &moved, 4, 3, 8);
        prop_assert_eq!(a.events.len(), b.events.len());
        for (x, y) in a.events.iter().zip(&b.events) {
            prop_assert_eq!((x.from, x.to), (y.from, y.to));
            prop_assert!((x.phase - y.phase).abs() < 1e-9, "{:e}", (x.phase - y.phase).abs());
        }
        for (x, y) in a.measures.iter().zip(&b.measures) {
            let size = x.max.abs().max(x.min.abs());
            for (x, y) in [(x.rms, y.rms), (x.mean, y.mean), (x.max, y.max), (x.min, y.min)] {
                prop_assert!((s * x - y).abs() <= 1e-11 * s * size, "{:e}", (s * x - y).abs() / (s * size));
            }
        }
        for (x, y) in a.samples.iter().zip(&b.samples) {
            let size = x.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            let scaled: Vec<f64> = x.iter().map(|v| s * v).collect();
            prop_assert!(distance(&scaled, y) <= 1e-10 * s * size, "{:e}", distance(&scaled, y) / (s * size));
        }
    }

    /// The prototype against matrices from closed forms.
    #[test]
    fn the_prototype_is_the_system_of_the_formulas(case in cases(), start in starts()) {
        let system = case.system();
        let matrices = Arc::new(by_matrices(&case.keys, system.outputs.clone()));
        let a = record(&system, case.frequency, &start, 3, 0, 16);
        let b = record(&matrices, case.frequency, &start, 3, 0, 16);
        prop_assert_eq!(a.events.len(), b.events.len());
        for (x, y) in a.samples.iter().zip(&b.samples) {
            let size = x.iter().fold(1.0_f64, |a, v| a.max(v.abs()));
            prop_assert!(distance(x, y) < 1e-11 * size, "{:e}", distance(x, y) / size);
        }
    }

    /// The map's derivative with respect to each key against differences of fourth order.
    #[test]
    fn derivatives_with_respect_to_every_key(case in cases(), start in starts(), key in 0..7_usize) {
        let value = case.keys[key];
        let family = Arc::new(OverKey { case: case.clone(), key });
        let mut solver = Shooting::new(family, value, 1).unwrap();
        let (_, map, by_key) = solver.map(&start, value).unwrap();
        let step = 2e-4 * value;
        let mut sum = [0.0; 4];
        for (offset, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let end = solver.map(&start, value + offset * step).unwrap().0;
            (0..4).for_each(|i| sum[i] += weight * end[i] / (12.0 * step));
        }
        // At an event the map has a 3/2-power singularity, so that differences are not of full order across a grazing.
        let size = by_key.iter().fold(map.max_abs() / value.max(1.0), |a, v| a.max(v.abs()));
        let error = distance(&by_key, &sum) / size;
        prop_assert!(error < 1e-7, "key {key}: {error:e} of {size}");
    }

    /// Many periods at once against one by one.
    #[test]
    fn long_runs_are_periods_one_after_the_other(case in cases(), start in starts()) {
        let mut flow = open(&point(&case.system(), case.frequency)).unwrap();
        let (mut far, mut near) = (start, start);
        let events = flow.advance(&mut far, 25, &mut []).unwrap();
        let count: usize = (0..25).map(|_| flow.advance(&mut near, 1, &mut []).unwrap()).sum();
        let size = near.iter().fold(1.0_f64, |a, v| a.max(v.abs()));
        prop_assert_eq!(events, count);
        prop_assert!(distance(&far, &near) < 1e-10 * size, "{:e}", distance(&far, &near) / size);
    }

    /// Between samples, 5000 a period, the wind-up is the cubic of values and slopes to some 1e-12: where that cubic
    /// dips deeper than 1e-9 through zero there are two events, where it stays that far away there is none.
    #[test]
    fn no_event_is_missed_and_none_invented(case in cases(), start in starts()) {
        let (periods, samples) = (4, 5000);
        let system = case.system();
        let found = record(&system, case.frequency, &start, periods, 0, samples);
        let rate = system.output_index("windup.rate").unwrap();
        let (y, slope) = (&found.samples[WINDUP], &found.samples[rate]);
        let h = TAU / case.frequency / samples as f64;
        let mut phases = found.events.iter().map(|e| e.phase / case.frequency / h).peekable();
        for i in 0..y.len() - 1 {
            let inside = std::iter::from_fn(|| phases.next_if(|&phase| phase < (i + 1) as f64)).count();
            if y[i] * y[i + 1] < 0.0 {
                prop_assert!(inside % 2 == 1, "interval {i}: {inside} events where the sign changes");
                continue;
            }
            let side = y[i].signum();
            let turns = side * slope[i] < 0.0 && side * slope[i + 1] > 0.0;
            let depth = if turns {
                (0..=64)
                    .map(|k| side * hermite([y[i], y[i + 1]], [slope[i], slope[i + 1]], h, h * k as f64 / 64.0))
                    .fold(f64::INFINITY, f64::min)
            } else {
                y[i].abs().min(y[i + 1].abs())
            };
            if depth < -1e-9 {
                prop_assert_eq!(inside, 2, "interval {}: dip of {:e}", i, depth);
            }
            if depth > 1e-9 {
                prop_assert_eq!(inside, 0, "interval {}: distance of {:e}", i, depth);
            }
        }
    }
}

proptest! {
    #![proptest_config(seeded(64))]

    /// While the clutch is engaged, a lower preload and an accessory that starts as much closer move the wind-up down and
    /// leave all else alone. That places the lowest point of a motion at any depth below the surface, or above it: there
    /// are two events, or none.
    #[test]
    fn dips_of_every_depth_are_two_events(case in cases(), start in starts(), exponent in -13.0..-4.0_f64) {
        let mut engaged = case.clone();
        engaged.keys[PRELOAD] = 100.0 * case.keys[CLUTCH];
        engaged.keys[AMPLITUDE] = case.keys[AMPLITUDE];
        let shifted = [start[0], start[1] - 100.0, start[2], start[3]];
        let motion = record(&engaged.system(), case.frequency, &shifted, 1, 0, 2);
        prop_assert!(motion.events.is_empty());
        let windup = &motion.measures[WINDUP];
        let ends = {
            let mut end = shifted;
            let mut flow = open(&point(&engaged.system(), case.frequency)).unwrap();
            flow.advance(&mut end, 1, &mut []).unwrap();
            [shifted[0] - shifted[1], end[0] - end[1]]
        };
        let size = windup.max - windup.min;
        // The lowest point must lie inside the period.
        if ends.iter().any(|end| end - windup.min < 1e-3 * size) {
            return Err(TestCaseError::reject("lowest at an end"));
        }
        let depth = 10.0_f64.powf(exponent) * size;
        // A hundred static wind-ups cost two digits of the place of the lowest point.
        let depth = depth.max(3e-13);
        for (move_down, events) in [(windup.min + depth, 2), (windup.min - depth, 0)] {
            let mut lowered = engaged.clone();
            lowered.keys[PRELOAD] -= case.keys[CLUTCH] * move_down;
            let moved = [shifted[0], shifted[1] + move_down, shifted[2], shifted[3]];
            let found = record(&lowered.system(), case.frequency, &moved, 1, 0, 0);
            prop_assert_eq!(found.events.len(), events, "depth {:e}", depth);
        }
    }
}

proptest! {
    #![proptest_config(seeded(40))]

    /// Properties 2 to 4 on the orbits that motions from rest settle on, and harmonic balance there.
    #[test]
    fn settled_orbits_keep_the_balances_and_agree_with_harmonic_balance(case in cases()) {
        let Some((_, orbit)) = case.settled() else {
            return Err(TestCaseError::reject("does not repeat with the load"));
        };
        let mut system = (*case.system()).clone();
        // vᵀCv = Σ λ_i (e_i·v)² along the principal directions of the damping matrix.
        let (c, angle) = {
            let c = &system.damping;
            (c.clone(), 0.5 * (2.0 * c[(0, 1)]).atan2(c[(0, 0)] - c[(1, 1)]))
        };
        let directions = [[angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]];
        let first = system.outputs.len();
        for e in &directions {
            system.outputs.push(Output {
                velocity: vec![(0, e[0]), (1, e[1])],
                ..Output::default()
            });
        }
        let system = Arc::new(system);
        let found = record(&system, case.frequency, &orbit.start, 1, 60, 0);
        let size = found.measures[PULLEY].rms;
        let preload = case.keys[PRELOAD];
        prop_assert!(found.measures[PULLEY].mean.abs() < 1e-12 * (1.0 + size));
        prop_assert!((found.measures[TORQUE].mean / preload - 1.0).abs() < 1e-11);

        let product: f64 = orbit.multipliers.iter().map(|m| m.norm()).product();
        let expected = (-case.decay() * TAU / case.frequency).exp();
        prop_assert!((product - expected).abs() < 1e-12, "{product} {expected}");

        let dissipated: f64 = directions
            .iter()
            .enumerate()
            .map(|(i, e)| {
                let lambda = e[0] * (c[(0, 0)] * e[0] + c[(0, 1)] * e[1]) + e[1] * (c[(1, 0)] * e[0] + c[(1, 1)] * e[1]);
                let m = &found.measures[first + i];
                lambda * (m.rms.powi(2) + m.mean.powi(2))
            })
            .sum();
        let rate = system.output_index("pulley.rate").unwrap();
        let supplied = 0.5 * case.keys[BELT] * case.keys[AMPLITUDE] * found.measures[rate].harmonics[1].re;
        prop_assert!((supplied / dissipated - 1.0).abs() < 1e-10, "{supplied} {dissipated}");

        let settings = Settings {
            harmonics: 60,
            adaptation: Some(Adaptation {
                maximum: 960,
                ..Adaptation::default()
            }),
            ..Settings::default()
        };
        let start = [found.measures[WINDUP].harmonics.clone()];
        let balanced = solve(&point(&system, case.frequency), Start::Harmonics(&start), &settings).unwrap();
        prop_assert_eq!(balanced.stop, SolveStop::Converged);
        prop_assert_eq!(balanced.orbit.events.len(), found.events.len());
        let measures = balanced.orbit.measures();
        for i in [PULLEY, WINDUP, TORQUE] {
            let (a, b) = (&found.measures[i], &measures[i]);
            prop_assert!((a.rms / b.rms - 1.0).abs() < 1e-9, "rms of {i}: {} {}", a.rms, b.rms);
        }
        for (a, b) in found.events.iter().zip(&balanced.orbit.events) {
            prop_assert!((a.phase - b.phase).abs() < 5e-8, "event {} {}", a.phase, b.phase);
        }
        prop_assert!(distance(&balanced.orbit.initial_state(), &orbit.start) < 1e-7 * (1.0 + size));
    }

    /// Property 5: if `x(t)` is a solution, so is `x(t + 2π/Ω)`.
    #[test]
    fn a_motion_one_period_later_is_the_same_motion(case in cases(), start in starts()) {
        let system = case.system();
        let request = Request::default();
        let mut flow = open(&point(&system, case.frequency)).unwrap();
        let mut state = start;
        let whole = flow.record(&mut state.clone(), 4, &system.outputs, &request).unwrap();
        flow.advance(&mut state, 1, &mut []).unwrap();
        let rest = flow.record(&mut state, 3, &system.outputs, &request).unwrap();
        let later: Vec<f64> = whole.events.iter().map(|e| e.phase - TAU).filter(|&p| p > 0.0).collect();
        let phases: Vec<f64> = rest.events.iter().map(|e| e.phase).collect();
        prop_assert_eq!(phases.len(), later.len());
        prop_assert!(distance(&phases, &later) < 1e-12, "{:e}", distance(&phases, &later));
    }
}

/// The condition `|D| ≤ δ_s` for a motion without separation (§1.9), from the closed form (C7), decides whether the orbit
/// about the static state has events, on sets that are not in the file.
#[test]
fn separation_starts_where_the_closed_form_says() {
    for (alpha, belt, clutch, zeta) in [
        (0.3, 4.0, 60.0, 0.02),
        (2.0, 1.5, 8.0, 0.05),
        (4.5, 15.0, 90.0, 0.01),
    ] {
        let keys = [alpha, belt, clutch, 1.0, 0.2 / belt, zeta, zeta];
        let found = modes(&model(&keys).system().unwrap(), 1.0, true).unwrap();
        let amplitude = |w: f64| {
            let sum: slackside_linalg::Complex = found
                .iter()
                .map(|m| {
                    let lambda = m.frequency.powi(2);
                    let stiffness =
                        slackside_linalg::Complex::new(lambda - w * w, 2.0 * zeta * m.frequency * w);
                    m.shape[0] * (m.shape[0] - m.shape[1]) / stiffness
                })
                .sum();
            0.2 * sum.norm()
        };
        let second = found[1].frequency;
        let onset = bisect(second, 3.0 * second, &mut |w| amplitude(w) - 1.0 / clutch);
        let system = Arc::new(model(&keys).system().unwrap());
        for (factor, events) in [(1.0 + 1e-8, 0), (1.0 - 1e-8, 2)] {
            let w = onset * factor;
            let orbit = shooting(&system, w, 1)
                .solve(&[0.0, -1.0 / clutch, 0.0, 0.0], w)
                .unwrap();
            assert_eq!(
                record(&system, w, &orbit.start, 1, 0, 0).events.len(),
                events,
                "{keys:?}"
            );
        }
    }
}
