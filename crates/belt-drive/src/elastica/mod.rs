//! The geometrically exact steady state: every span an elastica that leaves the pulleys where position, slope and curvature
//! fit (theory 04 §2.8).
//!
//! The ordinary steady state ([`crate::steady`]) linearises the spans about the line between the tangent points. This one
//! does not, and serves to check it: it shares the layout of centres with it, and nothing of the spans.

mod balance;
mod error;
mod span;

pub use error::ElasticaError;

use crate::drive::{Drive, Installation};
use crate::steady::{Installed, SteadyState};
use balance::{Balance, Place};
use glam::DVec2;

/// The drive running steadily, with exact bending and free contact points.
#[derive(Debug, Clone, PartialEq)]
pub struct ElasticaState {
    /// Speed of the driver, rad/s.
    pub driver_speed: f64,
    /// Belt speed `c`, m/s.
    pub belt_speed: f64,
    /// Positions of the arms, rad or m.
    pub positions: Vec<f64>,
    /// The spans.
    pub spans: Vec<ElasticaSpan>,
    /// Wraps between the contact points, rad.
    pub wraps: Vec<f64>,
    /// Force of the belt on every pulley, momentum flux included, N.
    pub belt_forces: Vec<DVec2>,
    /// Load torques, N·m; zero at the driver.
    pub loads: Vec<f64>,
    /// Natural belt length, m.
    pub natural_length: f64,
    /// Torque of every spring along its coordinate at the reference position, N·m or N.
    pub spring_torques: Vec<f64>,
}

/// One span between its contact points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticaSpan {
    /// Size `H` of the constant vector of force without momentum flux, N.
    pub force: f64,
    /// Direction `χ` of that vector, rad.
    pub direction: f64,
    /// Length along the belt, m.
    pub length: f64,
    /// Natural length of the belt in the span, m.
    pub natural_length: f64,
    /// Directions `ψ` of the belt where it leaves one pulley and meets the next, rad.
    pub end_directions: [f64; 2],
    /// Total tensions `N` there, N.
    pub end_tensions: [f64; 2],
    /// Contact points, m.
    pub contact_points: [DVec2; 2],
}

impl ElasticaState {
    /// The exact steady state at a driver speed (rad/s), next to the ordinary one. An installation by uniform tension means
    /// the force `H` of every span at rest.
    ///
    /// # Errors
    /// [`ElasticaError`].
    pub fn solve(drive: &Drive, driver_speed: f64) -> Result<Self, ElasticaError> {
        if drive.belt.acting_bending_stiffness() <= 0.0 {
            return Err(ElasticaError::NoBendingStiffness);
        }
        let installed = Installed::new(drive)?;
        let start = SteadyState::solve(drive, &installed, driver_speed)?;
        let mut balance = Balance::new(drive, driver_speed);
        balance.spring_torques = installed.spring_torques;
        balance.natural_length = Some(installed.natural_length);
        match drive.installation {
            Installation::Tension(tension) => {
                let (length, torques) = Balance::at_rest(drive).installed(tension)?;
                (balance.natural_length, balance.spring_torques) = (Some(length), torques);
            }
            Installation::NaturalLength(_) => {}
            Installation::OperatingPosition { driver_speed } => {
                let mut there = Balance::new(drive, driver_speed);
                there.spring_torques.clone_from(&balance.spring_torques);
                there.natural_length = None;
                let reference = SteadyState::solve(drive, &Installed::new(drive)?, driver_speed)?;
                let place = there.solve(&reference.effective_tensions, &drive.reference_positions())?;
                balance.natural_length = Some(there.natural_length(&place));
            }
        }
        let place = balance.solve(&start.effective_tensions, &start.positions)?;
        Self::accept(&balance, driver_speed, &place)
    }

    fn accept(balance: &Balance<'_>, driver_speed: f64, place: &Place) -> Result<Self, ElasticaError> {
        let drive = balance.drive;
        let wraps = balance.wraps(place);
        if let Some(j) = wraps.iter().position(|wrap| *wrap < 0.0) {
            return Err(ElasticaError::Lifted {
                pulley: drive.pulleys[j].name.clone(),
            });
        }
        let spans = place
            .spans
            .iter()
            .enumerate()
            .map(|(i, span)| {
                let end_directions = span.end_angles.map(|angle| span.direction + angle);
                let contact = |j: usize, direction: f64| {
                    let pulley = &drive.pulleys[j];
                    place.layout.centres[j]
                        - pulley.sense.sign() * pulley.radius * DVec2::from_angle(direction).perp()
                };
                ElasticaSpan {
                    force: span.force,
                    direction: span.direction,
                    length: span.length,
                    natural_length: span.natural_length,
                    end_directions,
                    end_tensions: [0, 1].map(|end| balance.tension(span, end)),
                    contact_points: [
                        contact(i, end_directions[0]),
                        contact(drive.next(i), end_directions[1]),
                    ],
                }
            })
            .collect();
        Ok(Self {
            driver_speed,
            belt_speed: drive.belt_speed(driver_speed),
            positions: place.positions.clone(),
            spans,
            wraps,
            belt_forces: balance.belt_forces(place),
            loads: balance.loads.clone(),
            natural_length: balance.natural_length(place),
            spring_torques: balance.spring_torques.clone(),
        })
    }
}
