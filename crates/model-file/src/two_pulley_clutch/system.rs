//! From the parameters to the equations of motion.

use slackside_belt_drive::prototypes::TwoPulley;
use slackside_mechanics::{System, modes};

use super::{Parameters, TwoPulleyClutch};
use crate::error::Issue;
use crate::reader::Read;

impl TwoPulleyClutch {
    pub(crate) fn system(&self) -> Read<System> {
        let system = self.two_pulley().system();
        let overflow = |message: String| {
            Issue::wrong_value(
                "",
                format!("the parameters cannot be combined to a system: {message}"),
            )
            .with_help("check the magnitudes of inertias and stiffnesses")
        };
        let system = system.map_err(|error| overflow(error.to_string()))?;
        system.check().map_err(|error| overflow(error.to_string()))?;
        Ok(system)
    }

    /// Ratio of the second to the first natural frequency of the engaged system.
    pub(super) fn frequency_ratio(&self) -> Option<f64> {
        let modes = modes(&self.system().ok()?, 1.0, true).ok()?;
        let [first, second] = modes.as_slice() else {
            return None;
        };
        Some(second.frequency / first.frequency).filter(|ratio| ratio.is_finite())
    }

    /// The dimensionless system of theory 02 (2.3), or the one in SI units of theory 02 (2.2).
    fn two_pulley(&self) -> TwoPulley {
        let smoothing = self
            .smoothing
            .as_ref()
            .map(|smoothing| (smoothing.kind.into(), smoothing.width));
        match &self.parameters {
            Parameters::Dimensionless(parameters) => TwoPulley {
                pulley_inertia: 1.0,
                accessory_inertia: parameters.inertia_ratio,
                belt_stiffness: parameters.belt_stiffness,
                clutch_stiffness: parameters.clutch_stiffness,
                preload: parameters.preload,
                excitation: parameters.radius_ratio * parameters.belt_stiffness * parameters.crank_amplitude,
                damping_ratio: parameters.damping_ratio.of_modes(),
                smoothing,
            },
            Parameters::Physical(parameters) => TwoPulley {
                pulley_inertia: parameters.pulley_inertia,
                accessory_inertia: parameters.accessory_inertia,
                belt_stiffness: parameters.belt_stiffness * parameters.pulley_radius.powi(2),
                clutch_stiffness: parameters.clutch_stiffness,
                preload: parameters.preload,
                excitation: parameters.belt_stiffness
                    * parameters.pulley_radius
                    * parameters.crank_radius
                    * parameters.crank_amplitude,
                damping_ratio: parameters.damping_ratio.of_modes(),
                smoothing,
            },
        }
    }
}
