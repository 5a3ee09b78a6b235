//! Residuals of the steady state and their rates (theory 04 §2.4).

use super::Installed;
use crate::drive::{ArcStretch, Drive, Guide};
use crate::layout::{Kinematics, Layout, LayoutError};
use crate::span::SpanEquilibrium;
use glam::DVec2;
use slackside_linalg::Matrix;

/// A drive at one speed.
pub(super) struct Running<'a> {
    pub drive: &'a Drive,
    pub installed: &'a Installed,
    pub driver_speed: f64,
    pub belt_speed: f64,
    /// Load torques, N·m.
    pub loads: Vec<f64>,
    /// `ΔP_i = P_i − P_ref`, N.
    tension_steps: Vec<f64>,
    /// `mc²`, N.
    pub centrifugal: f64,
}

/// Everything that follows from a reference tension and the arm positions.
pub(super) struct Balance {
    pub layout: Layout,
    pub kinematics: Kinematics,
    pub tensions: Vec<f64>,
    pub effective_tensions: Vec<f64>,
    pub spans: Vec<SpanEquilibrium>,
    pub forces: Vec<DVec2>,
    /// Natural length of a belt that would lie in this path with these tensions, m.
    pub natural_length: f64,
    /// `R_τ` of every tensioner, N·m or N (theory 04 (2.9)).
    pub arm_residuals: Vec<f64>,
}

impl<'a> Running<'a> {
    pub fn new(drive: &'a Drive, installed: &'a Installed, driver_speed: f64) -> Self {
        let loads = drive.load_torques(driver_speed);
        Self::with_loads(drive, installed, driver_speed, loads)
    }

    /// At rest and without loads.
    pub fn at_rest(drive: &'a Drive, installed: &'a Installed) -> Self {
        Self::with_loads(drive, installed, 0.0, vec![0.0; drive.pulleys.len()])
    }

    fn with_loads(drive: &'a Drive, installed: &'a Installed, driver_speed: f64, loads: Vec<f64>) -> Self {
        let count = drive.pulleys.len();
        let mut tension_steps = vec![0.0; count];
        let mut sum = 0.0;
        for step in 1..count {
            let j = (drive.driver + step) % count;
            sum += loads[j] / drive.pulleys[j].radius;
            tension_steps[j] = sum;
        }
        let belt_speed = drive.belt_speed(driver_speed);
        Self {
            drive,
            installed,
            driver_speed,
            belt_speed,
            loads,
            tension_steps,
            centrifugal: drive.belt.mass_per_length * belt_speed * belt_speed,
        }
    }

    /// `Σ M_j r_d/r_j`, N·m (theory 04 §2.1).
    pub fn driver_torque(&self) -> f64 {
        let last = self.drive.span_before(self.drive.driver);
        self.tension_steps[last] * self.drive.pulleys[self.drive.driver].radius
    }

    /// Effective tensions for a reference tension, N.
    pub fn effective_tensions(&self, reference: f64) -> Vec<f64> {
        self.tension_steps.iter().map(|step| reference + step).collect()
    }

    pub fn balance(&self, reference: f64, positions: &[f64]) -> Result<Balance, LayoutError> {
        let drive = self.drive;
        let layout = Layout::new(drive, positions)?;
        let kinematics = Kinematics::new(drive, &layout, positions);
        let effective_tensions = self.effective_tensions(reference);
        let tensions: Vec<f64> = effective_tensions
            .iter()
            .map(|tension| tension + self.centrifugal)
            .collect();
        let curvature = |j: usize| drive.pulleys[j].sense.sign() / drive.pulleys[j].radius;
        let spans: Vec<SpanEquilibrium> = (0..tensions.len())
            .map(|i| {
                SpanEquilibrium::new(
                    layout.spans[i].length,
                    effective_tensions[i],
                    drive.belt.acting_bending_stiffness(),
                    [curvature(i), curvature(drive.next(i))],
                    drive.belt.span_ends,
                )
            })
            .collect();
        let pull = |i: usize| {
            let span = &layout.spans[i];
            effective_tensions[i] * span.direction - spans[i].shear() * span.normal
        };
        let forces: Vec<DVec2> = (0..tensions.len())
            .map(|j| pull(j) - pull(drive.span_before(j)))
            .collect();
        let arm_residuals = (0..drive.tensioners.len())
            .map(|arm| {
                let pushed: f64 = drive
                    .carried_by(arm)
                    .map(|j| forces[j].dot(kinematics.centre_rates[j][arm]) + self.drag_reaction(j, arm))
                    .sum();
                pushed + self.installed.spring_torque(drive, arm, positions[arm])
            })
            .collect();
        let mut balance = Balance {
            layout,
            kinematics,
            tensions,
            effective_tensions,
            spans,
            forces,
            natural_length: 0.0,
            arm_residuals,
        };
        balance.natural_length = self.natural_length(&balance);
        Ok(balance)
    }

    /// `ς_j σ_j M_j`: the drag of a carried pulley turns its arm; a slide feels no torque.
    fn drag_reaction(&self, j: usize, arm: usize) -> f64 {
        let pulley = &self.drive.pulleys[j];
        match self.drive.tensioners[arm].guide {
            Guide::Rotary { .. } if pulley.drag_reacts_on_arm => pulley.sense.sign() * self.loads[j],
            _ => 0.0,
        }
    }

    /// `Σ (L_i + E_i)/(1 + P_i/EA) + Σ r_j φ_j/(1 + ε_j)`.
    fn natural_length(&self, balance: &Balance) -> f64 {
        let stiffness = self.drive.belt.axial_stiffness;
        let free: f64 = (0..balance.spans.len())
            .map(|i| {
                (balance.layout.spans[i].length + balance.spans[i].excess_length())
                    / (1.0 + balance.tensions[i] / stiffness)
            })
            .sum();
        let arcs: f64 = (0..balance.spans.len())
            .map(|j| {
                self.drive.pulleys[j].radius * balance.layout.wraps[j] / (1.0 + self.arc_strain(balance, j))
            })
            .sum();
        free + arcs
    }

    fn arc_strain(&self, balance: &Balance, j: usize) -> f64 {
        let (before, after) = (balance.tensions[self.drive.span_before(j)], balance.tensions[j]);
        match self.drive.belt.arc_stretch {
            ArcStretch::None => 0.0,
            ArcStretch::Mean => 0.5 * (before + after) / self.drive.belt.axial_stiffness,
            ArcStretch::Entry => before / self.drive.belt.axial_stiffness,
        }
    }

    /// Rates of `[R_0, R_τ…]` in `[T_ref, q_τ…]` for the arms in `free` (theory 04 (2.10)).
    pub fn jacobian(&self, balance: &Balance, free: &[usize]) -> Matrix {
        let stiffness = self.drive.belt.axial_stiffness;
        let stretch = |i: usize| 1.0 + balance.tensions[i] / stiffness;
        let count = balance.spans.len();
        let arc_rate = match self.drive.belt.arc_stretch {
            ArcStretch::None => 0.0,
            ArcStretch::Mean | ArcStretch::Entry => 1.0 / stiffness,
        };
        let mut jacobian = Matrix::zeros(1 + free.len(), 1 + free.len());
        jacobian[(0, 0)] = (0..count)
            .map(|i| {
                let length = balance.layout.spans[i].length + balance.spans[i].excess_length();
                let arc = self.drive.pulleys[i].radius * balance.layout.wraps[i];
                balance.spans[i].excess_length_rate() / stretch(i)
                    - length / (stiffness * stretch(i).powi(2))
                    - arc * arc_rate / (1.0 + self.arc_strain(balance, i)).powi(2)
            })
            .sum();
        for (column, &arm) in free.iter().enumerate() {
            jacobian[(0, 1 + column)] = (0..count)
                .map(|i| {
                    balance.kinematics.spans[i][arm].length / stretch(i)
                        + self.drive.pulleys[i].radius * balance.kinematics.wrap_rates[i][arm]
                            / (1.0 + self.arc_strain(balance, i))
                })
                .sum();
            jacobian[(1 + column, 0)] = -balance.kinematics.take_up[arm];
            for (other, &second) in free.iter().enumerate() {
                jacobian[(1 + column, 1 + other)] = -self.arm_stiffness(balance, arm, second);
            }
        }
        jacobian
    }

    /// `(K⁰ + K^Q)_ττ'` of theory 04 (3.10) and (2.10).
    fn arm_stiffness(&self, balance: &Balance, arm: usize, other: usize) -> f64 {
        let diagonal = if arm == other {
            let geometric: f64 = self
                .drive
                .carried_by(arm)
                .map(|j| balance.forces[j].dot(balance.kinematics.centre_curvatures[j][arm]))
                .sum();
            self.drive.tensioners[arm].spring_rate - geometric
        } else {
            0.0
        };
        let spans: f64 = (0..balance.spans.len())
            .map(|i| {
                let (first, second) = (
                    &balance.kinematics.spans[i][arm],
                    &balance.kinematics.spans[i][other],
                );
                let span = &balance.layout.spans[i];
                let shear = balance.spans[i].shear()
                    * (first.along() * second.across()
                        + first.across() * second.along()
                        + span.offset * first.across() * second.across() / span.length);
                (balance.effective_tensions[i] * first.across() * second.across() + shear) / span.length
            })
            .sum();
        diagonal + spans
    }
}
