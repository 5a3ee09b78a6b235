//! A running drive as a mechanical system with its nonlinear elements: one-way couplings, friction of the tensioners, stops
//! (theory 04 §5, theory 05).
//!
//! Coordinates are deviations from the loaded steady state in which every coupling transmits: the linear model's, with the
//! accessory behind every one-way coupling as a coordinate of its own. A one-way coupling acts between pulley and accessory,
//! and the accessory's load, which the steady tensions balance as long as the coupling transmits, becomes a constant load
//! `+M_l` on the pulley and `−M_l` on the accessory.
//!
//! ```
//! use slackside_belt_drive::drive::{Coupling, Excitation, OrderAmplitude, OrderTable};
//! use slackside_belt_drive::prototypes::three_pulley;
//! use slackside_belt_drive::steady::{Installed, SteadyState};
//! use slackside_belt_drive::system::DriveSystem;
//! let mut drive = three_pulley(0.015);
//! drive.pulleys[2].coupling = Coupling::OneWay { accessory_inertia: 2e-3 };
//! let steady = SteadyState::solve(&drive, &Installed::new(&drive)?, 200.0)?;
//! let table = OrderTable::Constant { amplitude: 0.01, phase: 0.0 };
//! let excitation = Excitation::Motion(vec![OrderAmplitude { order: 2.0, table }]);
//! let found = DriveSystem::new(&drive, &steady, &excitation)?;
//! assert_eq!(found.frequency, 400.0);
//! assert_eq!(found.system.elements[0].name, "coupling.accessory");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod couplings;
mod error;
mod excitation;
mod family;
mod locked_modes;
mod measures;
mod reduction;
mod row;
mod tensioners;

pub use error::DriveSystemError;
pub use excitation::CommonOrder;
pub use family::{DriveSpeedFamily, ExcitationFrequencyFamily};
pub use measures::{Measure, SpanAverage};

use crate::drive::{Drive, Excitation};
use crate::model::LinearModel;
use crate::steady::SteadyState;
use reduction::Reduction;
use slackside_mechanics::{Element, Forcing, Harmonic, OperatingPoint, System};
use std::sync::Arc;

/// A drive at one operating point as a mechanical system.
#[derive(Debug, Clone)]
pub struct DriveSystem {
    /// The equations of motion and the measures.
    pub system: System,
    /// Fundamental angular frequency of the excitation, rad/s.
    pub frequency: f64,
    /// Unit and steady value of every measure, in the order of the system's outputs.
    pub measures: Vec<Measure>,
    /// Effective tension `T_i = P_i − mc²` of every span in the steady state, N: a span is slack where this and its dynamic
    /// tension sum to less than zero.
    pub effective_tensions: Vec<f64>,
    /// Displacement along every span with transverse motion, as rows whose mean squares add up.
    pub span_averages: Vec<SpanAverage>,
    /// Coordinates in the steady state; only accessories behind wrap springs stand elsewhere than at zero.
    pub rest: Vec<f64>,
}

impl DriveSystem {
    /// The drive in a steady state, shaken at the driver's speed. Costs about a matrix factorisation of its order.
    ///
    /// # Errors
    /// [`DriveSystemError`].
    pub fn new(
        drive: &Drive,
        steady: &SteadyState,
        excitation: &Excitation,
    ) -> Result<Self, DriveSystemError> {
        let common = CommonOrder::of(excitation)?;
        Self::at_frequency(drive, steady, excitation, common.order * steady.driver_speed)
    }

    /// The same with the excitation at another fundamental frequency (rad/s) than the driver's speed gives it; the steady
    /// state and the amplitudes stay those of the speed.
    ///
    /// # Errors
    /// [`DriveSystemError`].
    pub fn at_frequency(
        drive: &Drive,
        steady: &SteadyState,
        excitation: &Excitation,
        frequency: f64,
    ) -> Result<Self, DriveSystemError> {
        let common = CommonOrder::of(excitation)?;
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(DriveSystemError::NoFrequency { frequency });
        }
        let one_way: Vec<usize> = (0..drive.pulleys.len())
            .filter(|j| drive.pulleys[*j].coupling.is_one_way())
            .collect();
        let model = LinearModel::with_disengaged(drive, steady, &one_way);
        let couplings = couplings::elements(drive, steady, &model)?;
        let tensioners = tensioners::elements(drive, steady, &model)?;
        let loads = excitation::loads(excitation, &common, steady.driver_speed);
        let reduction = Reduction::new(drive, steady, &model, excitation, &loads, frequency)?;
        let mut forcing = Forcing::none(reduction.order());
        let mut rest = vec![0.0; reduction.order()];
        for load in &couplings.loads {
            // Pulley and accessory of a coupling are never the driver, so they have coordinates.
            if let (Some(pulley), Some(accessory)) = (
                reduction.position(load.pulley),
                reduction.position(load.accessory),
            ) {
                forcing.constant[pulley] += load.torque;
                forcing.constant[accessory] -= load.torque;
                rest[accessory] = -load.windup;
            }
        }
        for (order, force) in &reduction.forces {
            forcing.add_harmonic(Harmonic {
                order: *order,
                cosine: force.iter().map(|value| value.re).collect(),
                sine: force.iter().map(|value| -value.im).collect(),
            });
        }
        let elements: Vec<Element> = couplings
            .elements
            .into_iter()
            .chain(tensioners)
            .map(|element| Element {
                port: reduction.port(&element.port),
                ..element
            })
            .collect();
        let mut system = System {
            coordinates: reduction.names(drive, &model),
            mass: reduction.mass.clone(),
            damping: reduction.damping.clone(),
            stiffness: reduction.stiffness.clone(),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing,
            elements,
            outputs: Vec::new(),
        };
        let reader = measures::Reader::new(drive, steady, &model, &reduction, &system)?;
        let (outputs, measures) = reader.measures(frequency);
        let span_averages = reader.span_averages(frequency);
        system.outputs = outputs;
        Ok(Self {
            system,
            frequency,
            measures,
            effective_tensions: steady.effective_tensions.clone(),
            span_averages,
            rest,
        })
    }

    /// System and frequency, with measures that are totals: steady value and motion together.
    pub fn into_operating_point(mut self) -> OperatingPoint {
        for (output, measure) in self.system.outputs.iter_mut().zip(&self.measures) {
            output.constant += measure.steady;
        }
        OperatingPoint {
            system: Arc::new(self.system),
            frequency: self.frequency,
        }
    }
}
