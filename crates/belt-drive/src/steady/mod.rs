//! Steady state: tensions, arm positions, shapes of the spans, and the forces on the hubs (theory 04 §2).

mod balance;
mod diagnosis;
mod error;
mod installed;
mod solve;

pub use error::SteadyError;
pub use installed::Installed;

use crate::drive::{ArcStretch, Drive};
use crate::layout::{Kinematics, Layout};
use crate::span::SpanEquilibrium;
use balance::Running;
use glam::DVec2;

/// The drive running steadily at one speed.
///
/// Two ways to it: [`SteadyState::solve`] from the installation, and [`SteadyState::solve_from`] from a neighbouring state.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyState {
    /// Speed of the driver, rad/s.
    pub driver_speed: f64,
    /// Belt speed `c`, m/s.
    pub belt_speed: f64,
    /// Positions of the arms, rad or m.
    pub positions: Vec<f64>,
    /// The belt's path.
    pub layout: Layout,
    /// Its rates in the arm positions.
    pub kinematics: Kinematics,
    /// Total tension `P_i` of every span, N.
    pub tensions: Vec<f64>,
    /// Effective tension `T_i = P_i − mc²` of every span, N.
    pub effective_tensions: Vec<f64>,
    /// Equilibrium of every span.
    pub spans: Vec<SpanEquilibrium>,
    /// Force of the belt on every pulley, momentum flux included, N (theory 04 (2.7)).
    pub belt_forces: Vec<DVec2>,
    /// Load torque of every pulley, N·m; zero at the driver.
    pub loads: Vec<f64>,
    /// Torque that the driver's shaft supplies, N·m.
    pub driver_torque: f64,
    /// Torque of every tensioner's spring along its coordinate, N·m or N.
    pub spring_torques: Vec<f64>,
    /// What a locked tensioner is held with, along its coordinate, N·m or N; zero for free ones.
    pub holding_torques: Vec<f64>,
    /// Natural belt length, m.
    pub natural_length: f64,
}

impl SteadyState {
    /// The steady state at a driver speed (rad/s), from the state of the installation. Costs a few microseconds per span.
    ///
    /// # Errors
    /// [`SteadyError`]: there is none, or the drive could not run in it.
    pub fn solve(drive: &Drive, installed: &Installed, driver_speed: f64) -> Result<Self, SteadyError> {
        let running = Running::new(drive, installed, driver_speed);
        let start = solve::Unknowns {
            reference_tension: installed.reference_tension,
            positions: drive.reference_positions(),
        };
        Self::finish(&running, solve::newton(&running, start))
    }

    /// The same from a neighbouring state, for sweeps.
    ///
    /// # Errors
    /// As [`SteadyState::solve`].
    pub fn solve_from(
        &self,
        drive: &Drive,
        installed: &Installed,
        driver_speed: f64,
    ) -> Result<Self, SteadyError> {
        let running = Running::new(drive, installed, driver_speed);
        let start = solve::Unknowns {
            reference_tension: self.effective_tensions[drive.driver],
            positions: self.positions.clone(),
        };
        Self::finish(&running, solve::newton(&running, start))
    }

    fn finish(running: &Running<'_>, found: Option<solve::Unknowns>) -> Result<Self, SteadyError> {
        let Some(found) = found else {
            return diagnosis::explain(running).and_then(|second| Self::accept(running, &second));
        };
        Self::accept(running, &found)
    }

    /// The state, if the drive can run in it (theory 04 §2.4).
    fn accept(running: &Running<'_>, found: &solve::Unknowns) -> Result<Self, SteadyError> {
        let drive = running.drive;
        let balance = running.balance(found.reference_tension, &found.positions)?;
        if let Some(error) = diagnosis::fault(running, &balance, &found.positions) {
            return Err(error);
        }
        balance.layout.check(drive)?;
        let spring_torques: Vec<f64> = (0..drive.tensioners.len())
            .map(|arm| running.installed.spring_torque(drive, arm, found.positions[arm]))
            .collect();
        let holding_torques = (0..drive.tensioners.len())
            .map(|arm| {
                if drive.tensioners[arm].locked {
                    -balance.arm_residuals[arm]
                } else {
                    0.0
                }
            })
            .collect();
        Ok(Self {
            driver_speed: running.driver_speed,
            belt_speed: running.belt_speed,
            positions: found.positions.clone(),
            driver_torque: running.driver_torque(),
            loads: running.loads.clone(),
            layout: balance.layout,
            kinematics: balance.kinematics,
            tensions: balance.tensions,
            effective_tensions: balance.effective_tensions,
            spans: balance.spans,
            belt_forces: balance.forces,
            spring_torques,
            holding_torques,
            natural_length: running.installed.natural_length,
        })
    }

    /// Ratio of the larger to the smaller effective tension at a pulley, at least 1.
    pub fn tension_ratio(&self, drive: &Drive, pulley: usize) -> f64 {
        let (before, after) = (
            self.effective_tensions[drive.span_before(pulley)],
            self.effective_tensions[pulley],
        );
        before.max(after) / before.min(after)
    }

    /// Safety against gross slip at a pulley, `S_j = μ_e φ_j / ln(T_hi/T_lo)`; infinite without a load (theory 04 (2.12)).
    pub fn slip_safety(&self, drive: &Drive, pulley: usize) -> f64 {
        drive.pulleys[pulley].friction * self.layout.wraps[pulley] / self.tension_ratio(drive, pulley).ln()
    }

    /// Torque at which the belt would slip all round a pulley if the effective tension of its slacker span stayed as it is,
    /// `r T_lo (e^{μ_e φ} − 1)`, N·m (theory 04 (2.12)).
    pub fn slip_torque(&self, drive: &Drive, pulley: usize) -> f64 {
        let slack = self.effective_tensions[drive.span_before(pulley)].min(self.effective_tensions[pulley]);
        let grip = drive.pulleys[pulley].friction * self.layout.wraps[pulley];
        drive.pulleys[pulley].radius * slack * grip.exp_m1()
    }

    /// Coupling indicator `χ_i = S_i k_i` of a span: how much bending softens it against belt stretch (theory 04 §2.2).
    pub fn sag_indicator(&self, drive: &Drive, span: usize) -> f64 {
        self.spans[span].sag_compliance() * drive.belt.axial_stiffness / self.layout.spans[span].length
    }

    /// Coupling indicator `Γ_i = √(L_i ∫w''² dx)` of a span (theory 04 §2.2).
    pub fn bending_indicator(&self, span: usize) -> f64 {
        (self.layout.spans[span].length * self.spans[span].curvature_integral()).sqrt()
    }

    /// Lowest natural frequency of a span between fixed ends, moving at belt speed, rad/s. A string's is
    /// `π(c_0² − c²)/(c_0 L)` (theory 04 §4.5); bending stiffness enters through the tension `P + EIπ²/L²` of the first
    /// sine.
    pub fn span_frequency(&self, drive: &Drive, span: usize) -> f64 {
        let length = self.layout.spans[span].length;
        let stiffening = drive.belt.acting_bending_stiffness() * (std::f64::consts::PI / length).powi(2);
        let wave_speed_squared = (self.tensions[span] + stiffening) / drive.belt.mass_per_length;
        let wave_speed = wave_speed_squared.sqrt();
        std::f64::consts::PI * (wave_speed_squared - self.belt_speed.powi(2)) / (wave_speed * length)
    }

    /// Strain of the belt on the arc of a pulley (theory 04 §2.4).
    pub fn arc_strain(&self, drive: &Drive, pulley: usize) -> f64 {
        let (before, after) = (self.tensions[drive.span_before(pulley)], self.tensions[pulley]);
        match drive.belt.arc_stretch {
            ArcStretch::None => 0.0,
            ArcStretch::Mean => 0.5 * (before + after) / drive.belt.axial_stiffness,
            ArcStretch::Entry => before / drive.belt.axial_stiffness,
        }
    }
}
