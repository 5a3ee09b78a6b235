//! What the installation fixes: natural belt length and spring torques (theory 04 §2.5).

use super::SteadyError;
use super::balance::Running;
use crate::drive::{Condition, Drive, Installation};
use crate::layout::{Kinematics, Layout};

/// Take-up per length of the arm below which a tensioner stands at its dead centre.
const DEAD_CENTRE: f64 = 1e-6;

/// The belt as it lies in the drive and the springs as they are set.
#[derive(Debug, Clone, PartialEq)]
pub struct Installed {
    /// Natural belt length `L_0`, m.
    pub natural_length: f64,
    /// Torque `τ_0` of every spring along its coordinate at the reference position, N·m or N.
    pub spring_torques: Vec<f64>,
    /// Effective tension behind the driver from which the steady state is sought, N.
    pub(super) reference_tension: f64,
}

impl Installed {
    /// The installation of a drive.
    ///
    /// # Errors
    /// [`SteadyError`] for an impossible layout at the reference position, or for spring preloads that balance no belt.
    pub fn new(drive: &Drive) -> Result<Self, SteadyError> {
        let positions = drive.reference_positions();
        let layout = Layout::new(drive, &positions)?;
        layout.check(drive)?;
        let kinematics = Kinematics::new(drive, &layout, &positions);
        match &drive.installation {
            Installation::Tension(tension) => Self::from_tension(drive, *tension, &positions),
            Installation::NaturalLength(length) => Self::from_length(drive, *length, &layout, &kinematics),
            Installation::OperatingPosition { driver_speed } => {
                Self::from_position(drive, *driver_speed, &kinematics)
            }
        }
    }

    fn from_tension(drive: &Drive, tension: f64, positions: &[f64]) -> Result<Self, SteadyError> {
        let free = Self {
            natural_length: 0.0,
            spring_torques: vec![0.0; drive.tensioners.len()],
            reference_tension: tension,
        };
        let balance = Running::at_rest(drive, &free).balance(tension, positions)?;
        Ok(Self {
            natural_length: balance.natural_length,
            spring_torques: balance.arm_residuals.iter().map(|torque| -torque).collect(),
            reference_tension: tension,
        })
    }

    fn from_length(
        drive: &Drive,
        natural_length: f64,
        layout: &Layout,
        kinematics: &Kinematics,
    ) -> Result<Self, SteadyError> {
        let spring_torques = preloads(drive, kinematics)?;
        let by_spring = (0..drive.tensioners.len())
            .find(|arm| !drive.tensioners[*arm].locked)
            .map(|arm| spring_torques[arm] / kinematics.take_up[arm]);
        let by_stretch = drive.belt.axial_stiffness * (layout.pitch_length / natural_length - 1.0);
        Ok(Self {
            natural_length,
            spring_torques,
            reference_tension: by_spring.unwrap_or(by_stretch),
        })
    }

    fn from_position(drive: &Drive, driver_speed: f64, kinematics: &Kinematics) -> Result<Self, SteadyError> {
        let positions = drive.reference_positions();
        let without_length = Self {
            natural_length: 0.0,
            spring_torques: preloads(drive, kinematics)?,
            reference_tension: 0.0,
        };
        let running = Running::new(drive, &without_length, driver_speed);
        // The balance of an arm is linear in the tension: two values give its zero.
        let residuals = |tension: f64| -> Result<Vec<f64>, SteadyError> {
            Ok(running.balance(tension, &positions)?.arm_residuals)
        };
        let (low, high) = (residuals(1.0)?, residuals(2.0)?);
        let free: Vec<usize> = (0..drive.tensioners.len())
            .filter(|arm| !drive.tensioners[*arm].locked)
            .collect();
        let balanced = |arm: usize| 1.0 + low[arm] / (low[arm] - high[arm]);
        let Some(first) = free.first() else {
            return Err(SteadyError::NothingFixesTheTension);
        };
        let tension = balanced(*first);
        if free
            .iter()
            .any(|arm| (balanced(*arm) - tension).abs() > 1e-6 * tension.abs())
        {
            return Err(SteadyError::ArmsDisagree);
        }
        if tension <= 0.0 {
            return Err(SteadyError::SpringPushesAway {
                tensioner: drive.tensioners[*first].name.clone(),
                tension,
            });
        }
        Ok(Self {
            natural_length: running.balance(tension, &positions)?.natural_length,
            spring_torques: without_length.spring_torques,
            reference_tension: tension,
        })
    }

    /// Torque of a spring along its coordinate with the arm at `position`, `τ_s = τ_0 − k_t (q − q_0)`.
    pub fn spring_torque(&self, drive: &Drive, arm: usize, position: f64) -> f64 {
        let tensioner = &drive.tensioners[arm];
        self.spring_torques[arm] - tensioner.spring_rate * (position - tensioner.reference)
    }

    /// Drive and installation under a condition of service: the belt's natural length and the springs change as it says,
    /// and with the temperature the structure grows.
    pub fn in_condition(&self, drive: &Drive, condition: &Condition) -> (Drive, Self) {
        let temperature = condition.temperature_change;
        let belt = 1.0 + drive.belt.thermal_expansion * temperature + condition.elongation;
        let installed = Self {
            natural_length: self.natural_length * belt + condition.length_change,
            spring_torques: self
                .spring_torques
                .iter()
                .map(|torque| torque * condition.spring_factor)
                .collect(),
            reference_tension: self.reference_tension,
        };
        let structure = 1.0 + condition.structure_expansion * temperature;
        (drive.enlarged(structure), installed)
    }
}

/// Spring torques at the reference position along the coordinates: a preload tightens the belt.
fn preloads(drive: &Drive, kinematics: &Kinematics) -> Result<Vec<f64>, SteadyError> {
    let torque = |arm: usize| {
        let tensioner = &drive.tensioners[arm];
        if tensioner.locked {
            return Ok(0.0);
        }
        let take_up = kinematics.take_up[arm];
        let size = drive
            .carried_by(arm)
            .map(|j| kinematics.centre_rates[j][arm].length())
            .sum::<f64>();
        if take_up.abs() <= DEAD_CENTRE * size {
            return Err(SteadyError::DeadCentre {
                tensioner: tensioner.name.clone(),
            });
        }
        match tensioner.spring_preload {
            Some(preload) => Ok(preload * take_up.signum()),
            None => Err(SteadyError::NoPreload {
                tensioner: tensioner.name.clone(),
            }),
        }
    };
    (0..drive.tensioners.len()).map(torque).collect()
}
