//! The two-pulley drive with a wrap-spring one-way clutch (theory 02 §1).
//!
//! A crankshaft pulley with prescribed rotation `A cos Ωt` drives, over elastic belt spans, an accessory pulley; a wrap
//! spring carries torque from the pulley to the accessory shaft as long as the pulley leads.

use slackside_linalg::{LinalgError, Matrix};
use slackside_mechanics::laws::{Smoothed, Smoothing, wrap_spring};
use slackside_mechanics::{Element, Forcing, Harmonic, Output, Port, System, modes};

/// Parameters of the two-pulley system, in any consistent units.
///
/// The dimensionless system of theory 02 (2.3) has `pulley_inertia = 1`, `accessory_inertia = α`,
/// `belt_stiffness = K_b`, `clutch_stiffness = K_d`, `preload = M`, `excitation = f = β K_b A_m`. With units the belt
/// stiffness is rotational, `K̃_b r_p²` (N·m/rad), and the excitation is a torque, `K̃_b r_p r_cs A_m` (N·m).
#[derive(Debug, Clone, PartialEq)]
pub struct TwoPulley {
    /// Inertia of the accessory pulley, `J_p`.
    pub pulley_inertia: f64,
    /// Inertia of the accessory shaft, `J_a`.
    pub accessory_inertia: f64,
    /// Torque on the pulley per radian of its rotation against a fixed crankshaft.
    pub belt_stiffness: f64,
    /// Wrap-spring torque per radian of wind-up.
    pub clutch_stiffness: f64,
    /// Constant accessory torque.
    pub preload: f64,
    /// Amplitude of the torque that the crankshaft motion exerts over the belt.
    pub excitation: f64,
    /// Damping ratios of the two modes of the engaged system.
    pub damping_ratio: [f64; 2],
    /// Kind and width (rad) of a smoothed clutch law; `None` for the exact one.
    pub smoothing: Option<(Smoothing, f64)>,
}

impl TwoPulley {
    /// Wind-up of the clutch at rest under the preload, `δ_s = M / K_d` (rad).
    pub fn static_windup(&self) -> f64 {
        self.preload / self.clutch_stiffness
    }

    /// The system with coordinates `pulley` and `accessory`, element `clutch`, and the measures `pulley`, `accessory`,
    /// `windup`, `clutch_torque`, `belt_torque`, `pulley.rate`, `accessory.rate` and `windup.rate`.
    ///
    /// # Errors
    /// [`LinalgError`] if an inertia is not positive, so that there are no modes to damp.
    pub fn system(&self) -> Result<System, LinalgError> {
        let clutch = wrap_spring(self.clutch_stiffness);
        let port = Port::new([(0, 1.0), (1, -1.0)]);
        let element = match self.smoothing {
            None => Element::new("clutch", port, clutch),
            Some((smoothing, width)) => Element::new("clutch", port, Smoothed::new(clutch, smoothing, width)),
        };
        let mut forcing = Forcing {
            constant: vec![self.preload, -self.preload],
            harmonics: vec![],
        };
        forcing.add_harmonic(Harmonic {
            order: 1,
            cosine: vec![self.excitation, 0.0],
            sine: vec![0.0, 0.0],
        });
        let mut system = System {
            coordinates: vec!["pulley".into(), "accessory".into()],
            mass: Matrix::diagonal(&[self.pulley_inertia, self.accessory_inertia]),
            damping: Matrix::zeros(2, 2),
            stiffness: Matrix::diagonal(&[self.belt_stiffness, 0.0]),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing,
            elements: vec![element],
            outputs: self.outputs(),
        };
        system.damping = self.modal_damping(&system)?;
        Ok(system)
    }

    /// `C = M Φ diag(2 ζ_j ω_j) Φᵀ M` of the engaged modes (C5), the same in both regimes of the clutch.
    fn modal_damping(&self, undamped: &System) -> Result<Matrix, LinalgError> {
        let mut damping = Matrix::zeros(2, 2);
        for (mode, ratio) in modes(undamped, 1.0, true)?.iter().zip(self.damping_ratio) {
            let momentum = undamped.mass.times(&mode.shape);
            for i in 0..2 {
                for j in 0..2 {
                    damping[(i, j)] += 2.0 * ratio * mode.frequency * momentum[i] * momentum[j];
                }
            }
        }
        Ok(damping)
    }

    fn outputs(&self) -> Vec<Output> {
        let measure = |name: &str| Output {
            name: name.into(),
            ..Output::default()
        };
        let windup = vec![(0, 1.0), (1, -1.0)];
        vec![
            Output::coordinate("pulley", 0),
            Output::coordinate("accessory", 1),
            Output {
                displacement: windup.clone(),
                ..measure("windup")
            },
            Output::element_force("clutch_torque", 0),
            Output {
                displacement: vec![(0, -self.belt_stiffness)],
                harmonics: vec![(1, self.excitation, 0.0)],
                ..measure("belt_torque")
            },
            Output {
                velocity: vec![(0, 1.0)],
                ..measure("pulley.rate")
            },
            Output {
                velocity: vec![(1, 1.0)],
                ..measure("accessory.rate")
            },
            Output {
                velocity: windup,
                ..measure("windup.rate")
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nominal() -> TwoPulley {
        TwoPulley {
            pulley_inertia: 1.0,
            accessory_inertia: 1.6,
            belt_stiffness: 2.6,
            clutch_stiffness: 24.0,
            preload: 1.0,
            excitation: 0.26,
            damping_ratio: [0.03, 0.03],
            smoothing: None,
        }
    }

    #[test]
    fn damping_matrix_agrees_with_the_closed_form() {
        // (C5) with equal ratios: C = 2 ζ (K_e + ω₁ω₂ M) / (ω₁ + ω₂).
        let model = nominal();
        let system = model.system().unwrap();
        let found = modes(&system, 1.0, true).unwrap();
        let (w1, w2) = (found[0].frequency, found[1].frequency);
        let engaged = [[2.6 + 24.0, -24.0], [-24.0, 24.0]];
        let mass = [[1.0, 0.0], [0.0, 1.6]];
        for i in 0..2 {
            for j in 0..2 {
                let expected = 0.06 * (engaged[i][j] + w1 * w2 * mass[i][j]) / (w1 + w2);
                assert!((system.damping[(i, j)] - expected).abs() < 1e-14);
            }
        }
        assert!((found[0].damping_ratio - 0.03).abs() < 1e-14);
        assert!((found[1].damping_ratio - 0.03).abs() < 1e-14);
        assert!(system.check().is_ok());
    }

    #[test]
    fn unequal_ratios_damp_each_mode_by_its_own() {
        let system = TwoPulley {
            damping_ratio: [0.02, 0.07],
            ..nominal()
        }
        .system()
        .unwrap();
        let found = modes(&system, 1.0, true).unwrap();
        assert!((found[0].damping_ratio - 0.02).abs() < 1e-14);
        assert!((found[1].damping_ratio - 0.07).abs() < 1e-14);
    }
}
