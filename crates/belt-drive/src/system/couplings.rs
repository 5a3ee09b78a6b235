//! One-way couplings between pulleys and accessories (theory 04 §5.2, theory 05 §4.1, §6.3).

use super::DriveSystemError;
use crate::drive::{Coupling, Drive, Flexible};
use crate::model::LinearModel;
use crate::steady::SteadyState;
use slackside_mechanics::laws::{Decoupler, damped_stop, one_way, wrap_spring};
use slackside_mechanics::{Element, Port};

/// The load that a coupling carries in the steady state.
pub(super) struct CouplingLoad {
    /// Coordinate of the pulley in the linear model.
    pub pulley: usize,
    /// Coordinate of the accessory.
    pub accessory: usize,
    /// The load `M_l`, N·m.
    pub torque: f64,
    /// Steady wind-up that is part of the coordinates, rad.
    pub windup: f64,
}

/// One-way couplings, with ports in the coordinates of the linear model.
pub(super) struct Couplings {
    pub elements: Vec<Element>,
    pub loads: Vec<CouplingLoad>,
}

/// Name of the element of a pulley's coupling.
pub(super) fn name(drive: &Drive, pulley: usize) -> String {
    format!("coupling.{}", drive.pulleys[pulley].name)
}

pub(super) fn elements(
    drive: &Drive,
    steady: &SteadyState,
    model: &LinearModel,
) -> Result<Couplings, DriveSystemError> {
    let mut found = Couplings {
        elements: Vec::new(),
        loads: Vec::new(),
    };
    for (j, pulley) in drive.pulleys.iter().enumerate() {
        let (true, Some(accessory)) = (pulley.coupling.is_one_way(), model.coordinates.accessory(j)) else {
            continue;
        };
        if j == drive.driver {
            return Err(DriveSystemError::CouplingOfDriver {
                pulley: pulley.name.clone(),
            });
        }
        let load = steady.loads[j];
        // Without load and drag the accessory would run ahead for ever, at any speed (theory 05 §4.4).
        if load < 0.0 || (load == 0.0 && pulley.accessory_damping == 0.0) {
            return Err(DriveSystemError::LoadOpensCoupling {
                pulley: pulley.name.clone(),
                load,
            });
        }
        let at = model.coordinates.pulley(j);
        let port = Port::new([(at, 1.0), (accessory, -1.0)]);
        let name = name(drive, j);
        let mut windup = 0.0;
        found.elements.push(match pulley.coupling {
            Coupling::WrapSpring(spring) => {
                windup = load / spring.stiffness;
                let damping = damping(drive, &spring);
                if damping > 0.0 {
                    Element::new(name, port, damped_stop(0.0, spring.stiffness, damping))
                } else {
                    Element::new(name, port, wrap_spring(spring.stiffness))
                }
            }
            Coupling::Decoupler { spring, preload } => {
                let law = Decoupler::new(spring.stiffness, damping(drive, &spring), preload);
                let law = law.map_err(|_| DriveSystemError::DampingAndPreload {
                    pulley: pulley.name.clone(),
                })?;
                Element::new(name, port, law)
            }
            Coupling::OneWay { .. } | Coupling::Rigid { .. } | Coupling::Isolator(_) => {
                Element::new(name, port, one_way())
            }
        });
        found.loads.push(CouplingLoad {
            pulley: at,
            accessory,
            torque: load,
            windup,
        });
    }
    Ok(found)
}

/// Damping of the spring of a coupling, the part of the belt's that is proportional to stiffness included.
fn damping(drive: &Drive, spring: &Flexible) -> f64 {
    spring.damping + drive.belt.damping.rayleigh_stiffness * spring.stiffness
}
