use super::tableau::{DENSE, END, ERROR_5, NODES, SOLUTION_3, STAGES, WEIGHTS};
use super::{DormandPrince, Limits, OdeError, Tolerance};

fn integrator(n: usize, relative: f64, limits: Limits) -> DormandPrince {
    let tolerance = Tolerance {
        relative: vec![relative; n],
        floor: vec![1e-3; n],
        block: n,
    };
    DormandPrince::new(tolerance, limits)
}

const FREE: Limits = Limits {
    max_step: f64::INFINITY,
    max_steps: 10_000,
};

fn oscillator(_: f64, y: &[f64], slope: &mut [f64]) {
    slope[0] = y[1];
    slope[1] = -y[0];
}

#[test]
fn coefficients_meet_order_conditions() {
    for stage in 1..STAGES {
        let sum: f64 = WEIGHTS[stage].iter().map(|&(_, w)| w).sum();
        assert!((sum - NODES[stage]).abs() < 1e-14, "row {stage}");
    }
    let moment = |row: &[(usize, f64)], k: i32| row.iter().map(|&(i, w)| w * NODES[i].powi(k)).sum::<f64>();
    for k in 0..8 {
        let exact = 1.0 / f64::from(k + 1);
        assert!((moment(WEIGHTS[END], k) - exact).abs() < 1e-14, "order {k}");
        if k < 3 {
            assert!((moment(SOLUTION_3, k) - exact).abs() < 1e-14);
        }
        if k < 5 {
            assert!(moment(ERROR_5, k).abs() < 1e-14);
        }
    }
    // Quadrature by the interpolant: its coefficients vanish for polynomials that the Hermite part already holds.
    for row in DENSE {
        for k in 0..3 {
            assert!(moment(row, k).abs() < 1e-12, "dense {k}: {}", moment(row, k));
        }
    }
}

#[test]
fn solution_and_interpolant_of_an_oscillator() {
    for (tolerance, at_ends, between) in [(1e-8, 2e-7, 2e-7), (1e-12, 2e-11, 1e-10)] {
        let mut integrator = integrator(2, tolerance, FREE);
        let mut y = [0.0, 1.0];
        let mut worst = (0.0_f64, 0.0_f64);
        integrator
            .integrate(
                &mut oscillator,
                0.0,
                20.0,
                &mut y,
                Some(&mut |step| {
                    let mut value = [0.0];
                    for i in 0..=20 {
                        let s = f64::from(i) / 20.0;
                        step.at(s, &mut value);
                        let error = (value[0] - (step.start + s * step.length).sin()).abs();
                        worst.1 = worst.1.max(error);
                        if i == 20 {
                            worst.0 = worst.0.max(error);
                        }
                    }
                }),
            )
            .unwrap();
        println!(
            "tolerance {tolerance:e}: {worst:?}, {:?}",
            integrator.statistics()
        );
        assert!(worst.0 < at_ends, "{worst:?}");
        assert!(worst.1 < between, "{worst:?}");
        assert!((y[0] - 20.0_f64.sin()).abs() <= worst.0);
    }
}

#[test]
fn steps_of_fixed_length_converge_with_order_eight() {
    let error = |steps: u32| {
        let limits = Limits {
            max_step: 4.0 / f64::from(steps),
            max_steps: 1000,
        };
        let mut y = [0.0, 1.0];
        let mut integrator = integrator(2, 1e3, limits);
        integrator.step = Some(limits.max_step);
        integrator
            .integrate(&mut oscillator, 0.0, 4.0, &mut y, None)
            .unwrap();
        assert_eq!(integrator.statistics().steps, steps as usize);
        (y[0] - 4.0_f64.sin()).abs()
    };
    let order = (error(6) / error(12)).log2();
    assert!((7.5..9.5).contains(&order), "{order}");
}

#[test]
fn a_kink_is_resolved_by_the_error_control() {
    // y' = max(t − t₀, 0) with t₀ irrational to the steps.
    let at = std::f64::consts::FRAC_1_SQRT_2;
    let mut integrator = integrator(1, 1e-12, FREE);
    let mut y = [0.0];
    integrator
        .integrate(
            &mut |t, _, slope| slope[0] = (t - at).max(0.0),
            0.0,
            2.0,
            &mut y,
            None,
        )
        .unwrap();
    assert!((y[0] - 0.5 * (2.0 - at).powi(2)).abs() < 1e-12, "{}", y[0]);
}

#[test]
fn reasons_to_stop() {
    // y = 1/(1 − t) is infinite at t = 1.
    let mut blow_up = |_: f64, y: &[f64], slope: &mut [f64]| slope[0] = y[0] * y[0];
    let outcome = integrator(1, 1e-10, FREE).integrate(&mut blow_up, 0.0, 2.0, &mut [1.0], None);
    match outcome {
        Err(
            OdeError::StepTooSmall { time, .. }
            | OdeError::NotFinite { time }
            | OdeError::TooManySteps { time, .. },
        ) => {
            assert!((time - 1.0).abs() < 1e-6);
        }
        Ok(()) => panic!("passed through a pole"),
    }
    let mut undefined = |t: f64, _: &[f64], slope: &mut [f64]| slope[0] = (0.5 - t).sqrt();
    let outcome = integrator(1, 1e-8, FREE).integrate(&mut undefined, 0.0, 1.0, &mut [1.0], None);
    assert!(matches!(outcome, Err(OdeError::NotFinite { time }) if time < 0.5));
    let few = Limits { max_steps: 3, ..FREE };
    let outcome = integrator(2, 1e-12, few).integrate(&mut oscillator, 0.0, 20.0, &mut [0.0, 1.0], None);
    assert!(matches!(outcome, Err(OdeError::TooManySteps { steps: 3, .. })));
}
