//! Systems whose motion is known in closed form, and one system in two sets of units.

use crate::common::{bisect, characteristic_polynomial, distance, nominal_system, record, shooting};
use serde_json::json;
use slackside_belt_drive::prototypes::TwoPulley;
use slackside_continuation::Options;
use slackside_dynamics::branch::{BranchOptions, SpecialKind, follow};
use slackside_dynamics::orbit::floquet::multipliers;
use slackside_linalg::Matrix;
use slackside_mechanics::laws::{PiecewiseLinear, Variable};
use slackside_mechanics::{Element, Forcing, Output, Port, System, modes};
use slackside_testkit::{assert_close, nominal, reference};
use std::f64::consts::PI;
use std::sync::Arc;

#[test]
fn bilinear_oscillator_swings_half_a_period_of_either_spring() {
    for (soft, stiff, mass) in [(1.0_f64, 4.0_f64, 1.0_f64), (2.0, 150.0, 0.7), (3.0, 3.3, 2.0)] {
        let graph = PiecewiseLinear::new(Variable::Displacement, vec![0.0], vec![soft, stiff]).unwrap();
        let system = Arc::new(System {
            coordinates: vec!["x".into()],
            mass: Matrix::diagonal(&[mass]),
            damping: Matrix::zeros(1, 1),
            stiffness: Matrix::zeros(1, 1),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing: Forcing::none(1),
            elements: vec![Element::new("spring", Port::new([(0, 1.0)]), graph)],
            outputs: vec![Output::coordinate("x", 0)],
        });
        // The frequency of the absent load only sets how long the record is.
        let frequency = 0.5;
        let found = record(&system, frequency, &[0.3, 0.0], 2, 0, 0);
        let times: Vec<f64> = found.events.iter().map(|e| e.phase / frequency).collect();
        let (w1, w2) = ((soft / mass).sqrt(), (stiff / mass).sqrt());
        // theory 05 §8.3: π/ω₁ + π/ω₂; from the turning point a quarter of the stiff period comes first.
        assert_close(times[0], 0.5 * PI / w2, 1e-14, "first zero");
        for (k, pair) in times.windows(3).enumerate() {
            assert_close(
                pair[2] - pair[0],
                PI / w1 + PI / w2,
                1e-13,
                &format!("period {k}"),
            );
        }
        assert!(times.len() > 5);
        // No damping: the turning points stay where they are.
        assert_close(found.measures[0].max, 0.3, 1e-13, "turning point");
        assert_close(
            found.measures[0].min,
            -0.3 * w2 / w1,
            1e-13,
            "other turning point",
        );
    }
}

/// Without damping the open clutch leaves a free mass under a constant torque, whose matrix is defective: the accessory
/// follows a parabola, the pulley swings on the belt (theory 02 §1.8).
#[test]
fn open_clutch_without_damping() {
    let system = Arc::new(nominal(&json!({ "zeta1": 0.0, "zeta2": 0.0 })).system().unwrap());
    assert_eq!(system.damping.max_abs(), 0.0);
    let frequency = 0.35;
    let start = [0.0, 1.0, 0.1, 0.4];
    let (f, k, alpha) = (0.26, 2.6_f64, 1.6);
    let w = k.sqrt();
    let forced = f / (k - frequency * frequency);
    let pulley = |t: f64| {
        let (a, b) = (start[0] - forced - 1.0 / k, start[2] / w);
        1.0 / k + forced * (frequency * t).cos() + a * (w * t).cos() + b * (w * t).sin()
    };
    let accessory = |t: f64| start[1] + start[3] * t - 0.5 * t * t / alpha;
    let samples = 2000;
    let found = record(&system, frequency, &start, 1, 0, samples);
    let engages = found.events[0].phase / frequency;
    let expected = bisect(engages - 0.05, engages + 0.05, &mut |t| pulley(t) - accessory(t));
    assert_close(engages, expected, 1e-14, "engages");
    assert!(engages > 1.0);
    let step = 2.0 * PI / frequency / samples as f64;
    for (i, (p, a)) in found.samples[0].iter().zip(&found.samples[1]).enumerate() {
        let t = i as f64 * step;
        if t < engages {
            assert_close(*p, pulley(t), 1e-14, "pulley");
            assert_close(*a, accessory(t), 1e-14, "accessory");
        }
    }
    // Multipliers of a motion without damping multiply to one, whatever the events.
    let (_, map, _) = shooting(&system, frequency, 1).map(&start, frequency).unwrap();
    assert_close(slackside_linalg::determinant(&map).unwrap(), 1.0, 1e-11, "volume");
}

/// Critical damping of both modes: the engaged matrix is defective; each mode moves as `(a + b t) e^{−ωt}` plus the forced
/// motion.
#[test]
fn engaged_clutch_with_critical_damping() {
    let changed = json!({ "zeta1": 1.0, "zeta2": 1.0, "M": 8.0 });
    let system = Arc::new(nominal(&changed).system().unwrap());
    let frequency = 1.1;
    let start = [0.05, -0.25, 0.3, -0.1];
    let samples = 500;
    let found = record(&system, frequency, &start, 1, 0, samples);
    assert!(
        found.events.is_empty(),
        "the clutch stays engaged: {:?}",
        found.events
    );
    let modes = modes(&system, frequency, true).unwrap();
    let (load, static_windup) = (0.26, 8.0 / 24.0);
    let coordinate = |t: f64, i: usize| -> f64 {
        let of_mode = modes.iter().map(|mode| {
            let w = mode.frequency;
            let project = |x: [f64; 2]| mode.shape[0] * x[0] + 1.6 * mode.shape[1] * x[1];
            let z0 = project([start[0], start[1] + static_windup]);
            let v0 = project([start[2], start[3]]);
            // z'' + 2ωz' + ω²z = F cos Ωt has the response F (… ) / (ω² + Ω²)².
            let force = mode.shape[0] * load;
            let size = force / (w * w + frequency * frequency).powi(2);
            let (re, im) = (w * w - frequency * frequency, 2.0 * w * frequency);
            let particular = |t: f64| size * (re * (frequency * t).cos() + im * (frequency * t).sin());
            let a = z0 - particular(0.0);
            let b = v0 - size * im * frequency + w * a;
            mode.shape[i] * (particular(t) + (a + b * t) * (-w * t).exp())
        });
        of_mode.sum::<f64>() - if i == 1 { static_windup } else { 0.0 }
    };
    let step = 2.0 * PI / frequency / samples as f64;
    for i in 0..2 {
        for (k, found) in found.samples[i].iter().enumerate() {
            assert_close(
                *found,
                coordinate(k as f64 * step, i),
                1e-14,
                "critically damped motion",
            );
        }
    }
}

/// The example of theory 02 §1.3 in SI units, and its frequency scale `ω_0`.
fn physical_example() -> (Arc<System>, f64) {
    let (pulley, accessory, radius, crank, belt) = (2e-4, 3.2e-4, 0.03, 0.06, 4e4);
    let omega_0 = f64::sqrt(belt * radius * radius / (pulley + accessory));
    let torque = pulley * omega_0 * omega_0;
    assert_close(omega_0, 263.11740579, 5e-9, "frequency scale");
    assert_close(torque, 13.846153846, 5e-10, "torque scale");
    let physical = TwoPulley {
        pulley_inertia: pulley,
        accessory_inertia: accessory,
        belt_stiffness: belt * radius * radius,
        clutch_stiffness: 24.0 * torque,
        preload: torque,
        excitation: belt * radius * crank * 0.05,
        damping_ratio: [0.03, 0.03],
        smoothing: None,
    };
    (Arc::new(physical.system().unwrap()), omega_0)
}

/// The example of theory 02 §1.3 in SI units against the dimensionless nominal case, on the motions of the file.
#[test]
fn physical_example_is_the_nominal_case_in_other_units() {
    let (physical, omega_0) = physical_example();
    let torque = 2e-4 * omega_0 * omega_0;
    let nominal = nominal_system();
    for branch in ["first_resonance", "second_resonance"] {
        for orbit in reference("clutch_nominal.json")["branches"][branch]["orbits"]
            .as_array()
            .unwrap()
        {
            let frequency = slackside_testkit::number(&orbit["Omega"]);
            let start = slackside_testkit::numbers(&orbit["x0"]);
            let scaled = [start[0], start[1], start[2] * omega_0, start[3] * omega_0];
            let found = shooting(&physical, frequency * omega_0, 1)
                .solve(&scaled, frequency * omega_0)
                .unwrap();
            let expected = shooting(&nominal, frequency, 1).solve(&start, frequency).unwrap();
            let label = format!("{branch} at {frequency}");
            let back: Vec<f64> = (0..4)
                .map(|i| found.start[i] / if i < 2 { 1.0 } else { omega_0 })
                .collect();
            assert!(distance(&back, &expected.start) < 1e-13, "{label}");
            let a = record(&physical, found.frequency, &found.start, 1, 3, 0);
            let b = record(&nominal, frequency, &expected.start, 1, 3, 0);
            assert_eq!(a.events.len(), b.events.len(), "{label}");
            for (x, y) in a.events.iter().zip(&b.events) {
                assert_close(x.phase, y.phase, 3e-13, &label);
            }
            for (i, (x, y)) in a.measures.iter().zip(&b.measures).enumerate() {
                let unit = match nominal.outputs[i].name.as_str() {
                    "clutch_torque" | "belt_torque" => torque,
                    name if name.ends_with(".rate") => omega_0,
                    _ => 1.0,
                };
                assert_close(x.rms / unit, y.rms, 1e-13, &label);
                assert_close(x.max / unit, y.max, 3e-13, &label);
                assert_close(x.mean / unit, y.mean, 1e-13, &label);
            }
            for i in 0..4 {
                for j in 0..4 {
                    let unit = |i: usize| if i < 2 { 1.0 } else { omega_0 };
                    let entry = found.monodromy[(i, j)] * unit(j) / unit(i);
                    assert_close(entry, expected.monodromy[(i, j)], 5e-13, &label);
                }
            }
        }
    }
}

/// Multipliers do not depend on the units. The eigenvalues of the monodromy matrix in SI units, whose entries differ by the
/// square of the frequency scale, have to be as good as those in units of order one.
#[test]
fn multipliers_keep_their_digits_in_any_units() {
    let nominal = nominal_system();
    let orbits = reference("clutch_nominal.json");
    let mut worst = 0.0_f64;
    for orbit in orbits["branches"]["first_resonance"]["orbits"]
        .as_array()
        .unwrap()
    {
        let frequency = slackside_testkit::number(&orbit["Omega"]);
        let start = slackside_testkit::numbers(&orbit["x0"]);
        let expected = shooting(&nominal, frequency, 1).solve(&start, frequency).unwrap();
        for scale in [1e-3_f64, 263.11740579, 1e4] {
            let mut monodromy = expected.monodromy.clone();
            for i in 0..2 {
                for j in 0..2 {
                    monodromy[(i, 2 + j)] /= scale;
                    monodromy[(2 + i, j)] *= scale;
                }
            }
            let found = multipliers(&monodromy).unwrap();
            let error = distance(
                &characteristic_polynomial(&found),
                &characteristic_polynomial(&expected.multipliers),
            );
            worst = worst.max(error);
        }
    }
    assert!(worst < 1e-12, "characteristic polynomials differ by {worst:.1e}");
}

/// The branch through the first resonance in SI units has the special points of the file, at frequencies times `ω_0`.
#[test]
fn special_points_in_physical_units() {
    let (physical, omega_0) = physical_example();
    let (from, to) = (1.5 * omega_0, 0.55 * omega_0);
    let mut solver = shooting(&physical, from, 1);
    let start = solver.solve(&[0.0, -1.0 / 24.0, 0.0, 0.0], from).unwrap().start;
    let options = BranchOptions {
        continuation: Options::over(to, from),
        direction: -1.0,
    };
    let branch = follow(&mut solver, &start, from, &options, &mut |_| true);
    let file = reference("clutch_nominal.json");
    let listed = file["branches"]["first_resonance"]["special_points"]
        .as_array()
        .unwrap();
    for (kind, name) in [
        (SpecialKind::Fold, "fold"),
        (SpecialKind::PeriodDoubling, "period_doubling"),
        (SpecialKind::NeimarkSacker, "neimark_sacker"),
    ] {
        let mut found: Vec<f64> = branch
            .special_parameters(kind)
            .iter()
            .map(|w| w / omega_0)
            .collect();
        let of_kind = listed.iter().filter(|s| s["type"] == name);
        let mut expected: Vec<f64> = of_kind.map(|s| slackside_testkit::number(&s["Omega"])).collect();
        found.sort_by(f64::total_cmp);
        expected.sort_by(f64::total_cmp);
        assert_eq!(found.len(), expected.len(), "{name}: {found:?} {expected:?}");
        let error = distance(&found, &expected);
        assert!(error < 3e-13, "{name} is off by {error:.1e}");
    }
}
