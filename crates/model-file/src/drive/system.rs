//! The equations of motion of a drive.

use slackside_belt_drive::drive as mechanics;
use slackside_belt_drive::steady::{Installed, SteadyState};
use slackside_belt_drive::system::{CommonOrder, DriveSystem, DriveSystemError};

use super::Drive;
use crate::error::{Issue, ModelFileError};
use crate::reader::Read;

impl Drive {
    /// The drive at its operating speed as a mechanical system with its couplings, frictions and stops, and what its measures
    /// mean.
    ///
    /// # Errors
    /// [`crate::Problem::WrongValue`] if the drive has no steady state there, or no equations of motion
    /// ([`DriveSystemError`]).
    pub fn drive_system(&self) -> Result<DriveSystem, ModelFileError> {
        self.running().map_err(|issue| issue.without_source())
    }

    pub(crate) fn running(&self) -> Read<DriveSystem> {
        let drive = self.convert()?;
        let speed = self.operating_speed();
        let steady = Installed::new(&drive)
            .and_then(|installed| SteadyState::solve(&drive, &installed, speed))
            .map_err(|error| Issue::wrong_value("operating.speed", error.to_string()))?;
        DriveSystem::new(&drive, &steady, &self.excitation()).map_err(|error| issue(&error))
    }

    /// Fundamental angular frequency of the excitation at the operating speed, rad/s; `None` if its orders have none in common.
    pub fn fundamental_frequency(&self) -> Option<f64> {
        let common = CommonOrder::of(&self.excitation()).ok()?;
        Some(common.order * self.operating_speed())
    }
}

/// The key that is to blame.
fn issue(error: &DriveSystemError) -> Box<Issue> {
    let key = match error {
        DriveSystemError::NoCommonOrder { .. } => "excitation".to_owned(),
        DriveSystemError::NoFrequency { .. } => "operating.speed".to_owned(),
        DriveSystemError::LoadOpensCoupling { pulley, .. } => format!("pulley.{pulley}.load"),
        DriveSystemError::CouplingOfDriver { pulley } | DriveSystemError::DampingAndPreload { pulley } => {
            format!("pulley.{pulley}.coupling")
        }
        DriveSystemError::Loop { tensioner, .. } => format!("tensioner.{tensioner}.friction.loop"),
        DriveSystemError::Touching { carried, .. } => format!("pulley.{carried}"),
        DriveSystemError::NoInertia { .. } | DriveSystemError::Linalg(_) => String::new(),
    };
    Issue::wrong_value(key, error.to_string())
}

impl super::DryFriction {
    pub(super) fn convert(&self) -> mechanics::TensionerFriction {
        // Checks leave no law without its numbers.
        let both = self.torque.or(self.force).unwrap_or_default();
        match self.law {
            super::FrictionLaw::Coulomb => mechanics::TensionerFriction::Coulomb {
                loading: self.loading.unwrap_or(both),
                unloading: self.unloading.unwrap_or(both),
                static_ratio: self.static_ratio,
            },
            super::FrictionLaw::SpringSlider => mechanics::TensionerFriction::SpringSlider {
                torque: both,
                stiffness: self.stiffness.unwrap_or_default(),
            },
            super::FrictionLaw::Dahl => mechanics::TensionerFriction::Dahl {
                torque: both,
                stiffness: self.stiffness.unwrap_or_default(),
            },
            super::FrictionLaw::Lugre => mechanics::TensionerFriction::LuGre {
                torque: both,
                static_ratio: self.static_ratio,
                stribeck_velocity: self.stribeck_velocity.unwrap_or_default(),
                stiffness: self.stiffness.unwrap_or_default(),
                damping: self.damping.unwrap_or_default(),
                viscous: self.viscous.unwrap_or_default(),
            },
            super::FrictionLaw::MeasuredLoop => {
                let measured = self.measured.clone().unwrap_or_default();
                mechanics::TensionerFriction::MeasuredLoop {
                    positions: measured.position,
                    loading: measured.loading,
                    unloading: measured.unloading,
                }
            }
        }
    }
}

impl super::StopContact {
    pub(super) fn convert(&self) -> mechanics::StopContact {
        match self.restitution {
            Some(restitution) => mechanics::StopContact::Rigid { restitution },
            None => mechanics::StopContact::Compliant {
                stiffness: self.stiffness.unwrap_or_default(),
                damping: self.damping.unwrap_or_default(),
            },
        }
    }
}

impl Drive {
    /// What a tensioner may touch; checks leave no contact between unknown pulleys.
    pub(super) fn pulley_contacts(&self, tensioner: &super::Tensioner) -> Vec<mechanics::PulleyContact> {
        let index = |name: &str| self.pulleys.iter().position(|pulley| pulley.name == name);
        tensioner
            .pulley_contacts
            .iter()
            .filter_map(|contact| {
                let carried = match &contact.carried {
                    Some(name) => index(name),
                    None => self.carried_names(&tensioner.name).next().and_then(index),
                };
                Some(mechanics::PulleyContact {
                    carried: carried?,
                    other: index(&contact.pulley)?,
                    clearance: contact.belt_thickness,
                    contact: contact.contact().convert(),
                })
            })
            .collect()
    }
}
