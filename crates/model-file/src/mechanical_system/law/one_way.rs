//! Laws that transmit in one direction only: clutch, damper, decoupler.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;
use slackside_mechanics::laws;

use super::keys::{LawKeys, SharedLaw, scalar_keys, scalar_numbers, smoothed, smoothing_field};
use crate::error::Issue;
use crate::reader::Read;
use crate::scalar::{Absent, Bound, Scalars, join, scalars};
use crate::schema::QuantitySchema;
use crate::smoothing::Smoothing;
use crate::units::quantities;

/// The relative-velocity one-way clutch has no keys.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OneWay {}

impl LawKeys for OneWay {
    fn check(&self, _: &str) -> Read<()> {
        Ok(())
    }

    fn number_mut(&mut self, _: &str) -> Option<&mut f64> {
        None
    }

    fn collect_keys(&self, _: &str, _: &mut Vec<String>) {}

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(Arc::new(laws::one_way()))
    }
}

/// Keys of a damper that acts in one direction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OneWayDamper {
    /// Damping coefficient for positive rate.
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
    /// Smooth law, whose width is a rate; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(OneWayDamper {
    damping: quantities::GENERALISED_DAMPING, Bound::Positive;
});

impl LawKeys for OneWayDamper {
    scalar_keys!();
    smoothing_field!();

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(smoothed(
            laws::one_way_damper(self.damping),
            self.smoothing.as_ref(),
        ))
    }
}

/// Keys of an overrunning decoupler.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Decoupler {
    /// Stiffness of the spring.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Force or torque of the spring at zero wind-up; zero if it is not written.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub preload: Option<f64>,
    /// Damping coefficient of the spring; zero if it is not written. A decoupler has either preload or damping.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub damping: Option<f64>,
}

scalars!(Decoupler {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
    preload: quantities::GENERALISED_FORCE, Bound::NotNegative => Absent::Nothing;
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Nothing;
});

impl LawKeys for Decoupler {
    fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        self.law(path).map(|_| ())
    }

    scalar_numbers!();

    fn law(&self, path: &str) -> Read<SharedLaw> {
        let (damping, preload) = (self.damping.unwrap_or_default(), self.preload.unwrap_or_default());
        let law = laws::Decoupler::new(self.stiffness, damping, preload).map_err(|_| {
            Issue::wrong_value(
                join(path, "damping"),
                "a decoupler with a preload has no damping: the spring rests against a stop inside it",
            )
            .with_number(damping)
            .with_help("leave out `damping` or `preload`")
        })?;
        Ok(Arc::new(law))
    }
}
