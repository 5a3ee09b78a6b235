//! Friction, one-way damper, stops and contacts of the tensioners (theory 05 §5, §6).

use super::DriveSystemError;
use crate::drive::{Drive, PulleyContact, StopContact, TensionerFriction};
use crate::model::LinearModel;
use crate::steady::SteadyState;
use slackside_mechanics::laws::{
    HysteresisLoop, HysteresisLoopError, LuGre, Stribeck, asymmetric_coulomb, dahl, damped_stop,
    one_way_damper, rigid_stop, spring_slider, stop,
};
use slackside_mechanics::{Element, Port};

/// What an element of a tensioner does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Friction,
    Damper,
    LowerStop,
    UpperStop,
}

impl Role {
    /// Name of the element.
    pub fn name(self, drive: &Drive, arm: usize) -> String {
        let role = match self {
            Self::Friction => "friction",
            Self::Damper => "damper",
            Self::LowerStop => "lower_stop",
            Self::UpperStop => "upper_stop",
        };
        format!("{role}.{}", drive.tensioners[arm].name)
    }
}

/// Name of the element of a contact between pulleys.
pub(super) fn contact_name(drive: &Drive, arm: usize, contact: &PulleyContact) -> String {
    format!(
        "contact.{}.{}",
        drive.tensioners[arm].name, drive.pulleys[contact.other].name
    )
}

/// `+1` if the position of a tensioner grows while the belt pushes it back against its spring, which shortens the belt's
/// path, otherwise `−1`.
pub(super) fn loading_sense(steady: &SteadyState, arm: usize) -> f64 {
    if steady.kinematics.take_up[arm] > 0.0 {
        -1.0
    } else {
        1.0
    }
}

/// The elements of all tensioners that move, with ports in the coordinates of the linear model. The ports of friction and
/// damper are positive in the direction of loading.
pub(super) fn elements(
    drive: &Drive,
    steady: &SteadyState,
    model: &LinearModel,
) -> Result<Vec<Element>, DriveSystemError> {
    let mut elements = Vec::new();
    for (arm, tensioner) in drive.tensioners.iter().enumerate() {
        if tensioner.locked {
            continue;
        }
        let at = model.coordinates.arm(arm);
        let port = |sign: f64| Port::new([(at, sign)]);
        let sense = loading_sense(steady, arm);
        if let Some(friction) = &tensioner.friction {
            elements.extend(friction_element(drive, steady, arm, friction, port(sense))?);
        }
        if tensioner.one_way_damping > 0.0 {
            let name = Role::Damper.name(drive, arm);
            elements.push(Element::new(
                name,
                port(sense),
                one_way_damper(tensioner.one_way_damping),
            ));
        }
        if let (Some([lower, upper]), Some(contact)) = (tensioner.stops, tensioner.stop_contact) {
            let position = steady.positions[arm];
            for (role, gap, sign) in [
                (Role::LowerStop, position - lower, -1.0),
                (Role::UpperStop, upper - position, 1.0),
            ] {
                // The steady state lies between the stops; rounding may leave it beyond.
                elements.push(contact_element(
                    role.name(drive, arm),
                    port(sign),
                    gap.max(0.0),
                    contact,
                ));
            }
        }
        for contact in &tensioner.pulley_contacts {
            elements.extend(pulley_contact(drive, steady, arm, at, contact)?);
        }
    }
    Ok(elements)
}

fn friction_element(
    drive: &Drive,
    steady: &SteadyState,
    arm: usize,
    friction: &TensionerFriction,
    port: Port,
) -> Result<Option<Element>, DriveSystemError> {
    let name = Role::Friction.name(drive, arm);
    Ok(match friction {
        // A graph without a vertical segment is no friction.
        TensionerFriction::Coulomb {
            loading, unloading, ..
        } if *loading == 0.0 && *unloading == 0.0 => None,
        TensionerFriction::Coulomb {
            loading,
            unloading,
            static_ratio,
        } => Some(Element::new(
            name,
            port,
            asymmetric_coulomb(*unloading, *loading, *static_ratio),
        )),
        TensionerFriction::SpringSlider { torque, .. } if *torque == 0.0 => None,
        TensionerFriction::SpringSlider { torque, stiffness } => {
            Some(Element::new(name, port, spring_slider(*stiffness, *torque)))
        }
        TensionerFriction::Dahl { torque, .. } | TensionerFriction::LuGre { torque, .. }
            if *torque == 0.0 =>
        {
            None
        }
        TensionerFriction::Dahl { torque, stiffness } => {
            Some(Element::new(name, port, dahl(*stiffness, *torque)))
        }
        TensionerFriction::LuGre {
            torque,
            static_ratio,
            stribeck_velocity,
            stiffness,
            damping,
            viscous,
        } => {
            let law = LuGre {
                stiffness: *stiffness,
                damping: *damping,
                viscous: *viscous,
                stribeck: Stribeck {
                    torque: *torque,
                    static_ratio: *static_ratio,
                    velocity: *stribeck_velocity,
                },
            };
            Some(Element::new(name, port, law))
        }
        TensionerFriction::MeasuredLoop {
            positions,
            loading,
            unloading,
        } => {
            let law = measured_loop(drive, steady, arm, positions, [loading, unloading]);
            let law = law.map_err(|reason| DriveSystemError::Loop {
                tensioner: drive.tensioners[arm].name.clone(),
                reason,
            })?;
            Some(Element::new(name, port, law))
        }
    })
}

/// The loop without the torque of the spring, over the deviation from the steady position in the direction of loading.
fn measured_loop(
    drive: &Drive,
    steady: &SteadyState,
    arm: usize,
    positions: &[f64],
    torques: [&Vec<f64>; 2],
) -> Result<HysteresisLoop, HysteresisLoopError> {
    let sense = loading_sense(steady, arm);
    let (rate, from) = (drive.tensioners[arm].spring_rate, steady.positions[arm]);
    let spring = |position: f64| -sense * (steady.spring_torques[arm] - rate * (position - from));
    let friction = |values: &Vec<f64>| -> Vec<f64> {
        let own = values
            .iter()
            .zip(positions)
            .map(|(torque, position)| torque - spring(*position));
        ordered(own.collect(), sense)
    };
    HysteresisLoop::new(
        ordered(
            positions
                .iter()
                .map(|position| sense * (position - from))
                .collect(),
            sense,
        ),
        friction(torques[0]),
        friction(torques[1]),
    )
}

/// Against the sense of the coordinate the points stand in the opposite order.
fn ordered(mut values: Vec<f64>, sense: f64) -> Vec<f64> {
    if sense < 0.0 {
        values.reverse();
    }
    values
}

fn contact_element(name: String, port: Port, gap: f64, contact: StopContact) -> Element {
    match contact {
        StopContact::Rigid { restitution } => Element::new(name, port, rigid_stop(gap, restitution)),
        StopContact::Compliant {
            stiffness,
            damping: 0.0,
        } => Element::new(name, port, stop(stiffness, gap)),
        StopContact::Compliant { stiffness, damping } => {
            Element::new(name, port, damped_stop(gap, stiffness, damping))
        }
    }
}

/// A carried pulley against another one: the gap between them, linear in the position of the tensioner; none if the pulley moves
/// past the other.
fn pulley_contact(
    drive: &Drive,
    steady: &SteadyState,
    arm: usize,
    at: usize,
    contact: &PulleyContact,
) -> Result<Option<Element>, DriveSystemError> {
    let centre = |j: usize| steady.layout.centres[j];
    let apart = centre(contact.carried) - centre(contact.other);
    let radii = drive.pulleys[contact.carried].radius + drive.pulleys[contact.other].radius;
    let gap = apart.length() - radii - contact.clearance;
    if gap < 0.0 {
        return Err(DriveSystemError::Touching {
            carried: drive.pulleys[contact.carried].name.clone(),
            other: drive.pulleys[contact.other].name.clone(),
            gap,
        });
    }
    let opening = apart
        .normalize_or_zero()
        .dot(steady.kinematics.centre_rates[contact.carried][arm]);
    Ok((opening != 0.0).then(|| {
        let port = Port::new([(at, -opening)]);
        contact_element(contact_name(drive, arm, contact), port, gap, contact.contact)
    }))
}
