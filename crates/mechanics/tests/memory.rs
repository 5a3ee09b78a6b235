//! Laws with a smooth memory: their derivatives, and the forces of steady sliding.

use slackside_mechanics::laws::{LuGre, Stribeck, Valanis, dahl};
use slackside_mechanics::{Gradient, Law, Memory, MemoryResponse};

fn lugre() -> LuGre {
    LuGre {
        stiffness: 40.0,
        damping: 0.7,
        viscous: 0.2,
        stribeck: Stribeck {
            torque: 1.5,
            static_ratio: 1.4,
            velocity: 0.3,
        },
    }
}

fn valanis() -> Valanis {
    Valanis::new(30.0, 2.0, 1.2, 0.6).unwrap()
}

/// Derivatives of force and rate by central differences of fourth order.
fn differences(law: &dyn Memory, at: [f64; 3]) -> [Gradient; 2] {
    let h = 1e-4;
    let mut result = [[0.0; 3]; 2];
    for variable in 0..3 {
        for (multiple, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let mut x = at;
            x[variable] += multiple * h;
            let MemoryResponse { force, rate, .. } = law.evaluate(x[0], x[1], x[2]);
            result[0][variable] += weight * force / (12.0 * h);
            result[1][variable] += weight * rate / (12.0 * h);
        }
    }
    result.map(|[displacement, velocity, internal]| Gradient {
        displacement,
        velocity,
        internal,
    })
}

#[test]
fn derivatives_agree_with_differences() {
    let laws: [&dyn Memory; 3] = [&dahl(50.0, 1.3), &lugre(), &valanis()];
    for law in laws {
        for u in [-0.1, 0.02] {
            for v in [-0.8, -0.05, 0.1, 0.6] {
                for share in [-0.7, 0.3, 0.9] {
                    let at = [u, v, share * law.scale()];
                    let found = law.evaluate(at[0], at[1], at[2]);
                    let expected = differences(law, at);
                    for (a, b) in [(found.force_by, expected[0]), (found.rate_by, expected[1])] {
                        for (a, b) in [
                            (a.displacement, b.displacement),
                            (a.velocity, b.velocity),
                            (a.internal, b.internal),
                        ] {
                            assert!((a - b).abs() <= 1e-8 * (1.0 + b.abs()), "{law:?} {at:?}: {a} {b}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn steady_sliding_has_the_friction_torque() {
    for v in [-0.9_f64, -0.1, 0.2, 1.5] {
        let friction = dahl(50.0, 1.3);
        let state = friction.evaluate(0.0, v, v.signum() * 1.3 / 50.0);
        assert!(state.rate.abs() < 1e-14 && (state.force - 1.3 * v.signum()).abs() < 1e-14);
        // Coulomb friction with Stribeck's fall and a viscous part.
        let law = lugre();
        let sliding = 1.5 * (1.0 + 0.4 * (-(v / 0.3).powi(2)).exp());
        let state = law.evaluate(0.0, v, v.signum() * sliding / 40.0);
        assert!(state.rate.abs() < 1e-14);
        assert!((state.force - (sliding * v.signum() + 0.2 * v)).abs() < 1e-13);
        let law = valanis();
        let u = 0.4;
        let state = law.evaluate(u, v, 2.0 * u + 1.2 * v.signum());
        assert!((state.rate - 2.0 * v).abs() < 1e-13, "slope in gross slip");
        let reversal = law.evaluate(0.0, v, 0.0);
        assert!(
            (reversal.rate - 30.0 * v).abs() < 1e-13,
            "stiffness at a reversal"
        );
    }
}

#[test]
fn ranges_of_valanis_are_checked() {
    for (parameters, name) in [
        ([0.0, 0.0, 1.0, 0.5], "the stiffness"),
        ([3.0, 3.0, 1.0, 0.5], "the stiffness in slip"),
        ([3.0, 1.0, -1.0, 0.5], "the torque"),
        ([3.0, 1.0, 1.0, 1.0], "the sharpness"),
    ] {
        let [stiffness, slip, torque, sharpness] = parameters;
        assert_eq!(
            Valanis::new(stiffness, slip, torque, sharpness).unwrap_err().name,
            name
        );
    }
}

#[test]
fn a_memory_is_an_internal_state() {
    assert!(dahl(1.0, 1.0).has_internal_state() && lugre().has_internal_state());
    assert!(dahl(1.0, 1.0).regimes().is_none());
}
