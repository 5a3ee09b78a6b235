//! One conformance test for every law: tangents against differences, table against response, continuity at guards.

use slackside_mechanics::laws::{
    Cubic, Decoupler, HysteresisLoop, HysteresisLoopError, Isolator, PiecewiseLinear, Ray, Smoothed,
    Smoothing, Variable, asymmetric_coulomb, backlash, coulomb, dry_friction, one_way, one_way_damper, stop,
    wrap_spring,
};
use slackside_mechanics::{Law, Piece, Transition};

fn laws() -> Vec<Box<dyn Law>> {
    let mut laws: Vec<Box<dyn Law>> = vec![
        Box::new(wrap_spring(24.0)),
        Box::new(backlash(3.0, 0.2)),
        Box::new(stop(5.0, 0.3)),
        Box::new(one_way_damper(0.7)),
        Box::new(Isolator {
            stiffness: 2.0,
            damping: 0.1,
        }),
        Box::new(Cubic {
            linear: 1.0,
            cubic: 0.5,
        }),
        Box::new(
            PiecewiseLinear::new(
                Variable::Displacement,
                vec![-0.5, 0.1, 0.4],
                vec![4.0, 1.0, 2.0, -1.0],
            )
            .unwrap(),
        ),
    ];
    for smoothing in Smoothing::ALL {
        laws.push(Box::new(Smoothed::new(wrap_spring(24.0), smoothing, 0.05)));
        laws.push(Box::new(Smoothed::new(backlash(3.0, 0.2), smoothing, 0.05)));
        laws.push(Box::new(Smoothed::new(one_way_damper(3.0), smoothing, 0.05)));
    }
    laws
}

/// Arguments that avoid every breakpoint.
fn samples() -> impl Iterator<Item = (f64, f64)> {
    (0..60).flat_map(|i| (0..20).map(move |j| (-1.0 + i as f64 / 29.7, -1.013 + j as f64 / 9.3)))
}

#[test]
fn tangents_agree_with_differences() {
    let h = 1e-6;
    for law in laws() {
        for (u, v) in samples() {
            let r = law.response(u, v);
            let by_u = (law.response(u + h, v).force - law.response(u - h, v).force) / (2.0 * h);
            let by_v = (law.response(u, v + h).force - law.response(u, v - h).force) / (2.0 * h);
            // Second derivatives of the smoothed laws reach 24/0.05; quadratic ones have a kink in the tangent.
            assert!((r.by_displacement - by_u).abs() < 2e-3, "{law:?} at {u}, {v}");
            assert!((r.by_velocity - by_v).abs() < 2e-3, "{law:?} at {u}, {v}");
        }
    }
}

#[test]
fn every_law_vanishes_at_the_origin_or_smoothly_near_it() {
    for law in laws() {
        assert!(law.response(0.0, 0.0).force.abs() <= 24.0 * 0.05, "{law:?}");
    }
}

#[test]
fn regime_tables_reproduce_the_response_and_are_continuous_across_guards() {
    let force = |piece: Piece, u: f64, v: f64| match piece {
        Piece::Affine {
            constant,
            displacement,
            velocity,
            internal: 0.0,
        } => constant + displacement * u + velocity * v,
        _ => unreachable!("only affine pieces exist"),
    };
    for law in laws() {
        let Some(table) = law.regimes() else { continue };
        for (u, v) in samples() {
            let inside: Vec<_> = table
                .regimes
                .iter()
                .filter(|r| {
                    r.guards
                        .iter()
                        .all(|g| g.displacement * u + g.velocity * v + g.constant > 0.0)
                })
                .collect();
            assert_eq!(inside.len(), 1, "{law:?}: one regime holds at {u}, {v}");
            assert!((force(inside[0].piece, u, v) - law.response(u, v).force).abs() < 1e-14);
        }
        for regime in &table.regimes {
            for guard in &regime.guards {
                let Transition::To(next) = guard.transition else {
                    unreachable!()
                };
                let (u, v) = if guard.displacement != 0.0 {
                    (-guard.constant / guard.displacement, 0.3)
                } else {
                    (0.3, -guard.constant / guard.velocity)
                };
                let (before, after) = (force(regime.piece, u, v), force(table.regimes[next].piece, u, v));
                assert!((before - after).abs() < 1e-14, "{law:?} jumps at {u}, {v}");
            }
        }
    }
}

#[test]
fn smoothed_hinges_tend_to_the_hinge_with_their_error_constant() {
    // The impulse of theory 02 §4: ∫ (hinge_ε − max(x,0)) dx = κ ε² for a unit-speed crossing.
    for smoothing in Smoothing::ALL {
        let Some(kappa) = smoothing.error_constant() else {
            continue;
        };
        let (width, n) = (0.01, 400_000);
        let reach = 60.0 * width;
        let step = 2.0 * reach / n as f64;
        let impulse: f64 = (0..n)
            .map(|i| {
                let x = -reach + (i as f64 + 0.5) * step;
                (smoothing.hinge(x, width).0 - x.max(0.0)) * step
            })
            .sum();
        let error = impulse / (width * width) - kappa;
        assert!(
            error.abs() < 1e-5,
            "{smoothing:?}: {} against {kappa}",
            impulse / (width * width)
        );
    }
}

#[test]
fn unsound_graphs_are_refused() {
    let d = Variable::Displacement;
    assert!(PiecewiseLinear::new(d, vec![0.0], vec![1.0]).is_err());
    assert!(PiecewiseLinear::new(d, vec![0.0, 0.0], vec![1.0, 2.0, 3.0]).is_err());
    assert!(PiecewiseLinear::new(d, vec![0.0], vec![1.0, f64::NAN]).is_err());
}

/// Set-valued laws of the velocity, monotone ones.
fn graphs() -> Vec<Box<dyn Law>> {
    let ray = |constant: f64, damping: f64| Ray { constant, damping };
    vec![
        Box::new(one_way()),
        Box::new(coulomb(1.5, 1.0)),
        Box::new(asymmetric_coulomb(0.5, 2.0, 1.0)),
        Box::new(dry_friction(ray(-1.0, 0.3), ray(0.4, 0.0), 1.0)),
        Box::new(one_way_damper(0.7)),
        Box::new(PiecewiseLinear::new(Variable::Velocity, vec![-0.5, 0.1], vec![4.0, 1.0, 2.0]).unwrap()),
    ]
}

#[test]
fn resolvents_solve_their_inclusion_and_contract() {
    for law in graphs() {
        assert!(law.is_monotone(), "{law:?}");
        for r in [0.1, 1.0, 7.0] {
            let mut last: Option<(f64, f64)> = None;
            for i in 0..200 {
                let w = -4.0 + i as f64 * 0.0403;
                let (v, f) = law.resolvent(w, r).unwrap();
                assert!((v + r * f - w).abs() < 1e-13, "{law:?}: {w} = {v} + r {f}");
                if v != 0.0 {
                    assert!((f - law.response(0.0, v).force).abs() < 1e-13, "{law:?} at {v}");
                }
                if let Some((before, force)) = last {
                    let (dv, df) = (v - before, f - force);
                    assert!(dv >= -1e-14 && df >= -1e-14 && dv <= 0.0403 + 1e-13, "{law:?}");
                }
                last = Some((v, f));
            }
        }
    }
}

#[test]
fn friction_holds_within_its_static_limits_and_slides_with_the_kinetic_ones() {
    let law = asymmetric_coulomb(1.0, 2.0, 1.3);
    assert!(!law.is_monotone() && law.resolvent(1.0, 1.0).is_none());
    assert_eq!(law.limits(), (-1.3, 2.6));
    assert_eq!(law.response(0.0, 0.1).force, 2.0);
    assert_eq!(law.response(0.0, -0.1).force, -1.0);
    let table = law.regimes().unwrap();
    let rest = table.rests[0];
    let stick = &table.regimes[rest.stick.unwrap()];
    assert!(stick.sticks() && stick.transmitting);
    assert_eq!(rest.candidates().next(), rest.stick);
}

#[test]
fn a_measured_loop_bounds_the_force_between_its_curves() {
    let law = HysteresisLoop::new(vec![-0.1, 0.0, 0.2], vec![1.0, 3.0, 4.0], vec![-1.0, 0.0, 2.0]).unwrap();
    assert!((law.response(0.1, 1.0).force - 3.5).abs() < 1e-15);
    assert!((law.response(0.1, -1.0).force - 1.0).abs() < 1e-15);
    assert!((law.response(-0.05, 0.0).force - 0.75).abs() < 1e-15);
    assert_eq!(law.response(0.7, 1.0).force, 4.0);
    assert_eq!(law.response(-0.7, -1.0).force, -1.0);
    let table = law.regimes().unwrap();
    assert_eq!((table.regimes.len(), table.rests.len()), (12, 4));
    for rest in &table.rests {
        assert!(table.regimes[rest.stick.unwrap()].sticks());
    }
    let crossed = HysteresisLoop::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![0.0, 2.0]);
    assert!(matches!(
        crossed,
        Err(HysteresisLoopError::Crossed {
            displacement: 1.0,
            ..
        })
    ));
    assert!(HysteresisLoop::new(vec![0.0], vec![0.0], vec![0.0]).is_err());
    assert!(HysteresisLoop::new(vec![0.0, 0.0], vec![0.0; 2], vec![0.0; 2]).is_err());
}

#[test]
fn a_decoupler_has_damping_or_preload_but_not_both() {
    assert!(Decoupler::new(10.0, 0.1, 1.0).is_err());
    for (damping, preload, regimes) in [(0.0, 0.0, 2), (0.1, 0.0, 2), (0.0, 1.0, 3)] {
        let table = Decoupler::new(10.0, damping, preload).unwrap().regimes().unwrap();
        assert!(table.internal && table.regimes.len() == regimes);
        assert_eq!(table.rests.is_empty(), damping > 0.0);
    }
}
