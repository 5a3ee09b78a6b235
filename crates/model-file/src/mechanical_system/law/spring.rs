//! Laws of the deflection alone, or linear in deflection and rate.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;
use slackside_mechanics::laws;

use super::keys::{LawKeys, SharedLaw, scalar_keys, smoothed, smoothing_field};
use crate::reader::Read;
use crate::scalar::{Bound, scalars};
use crate::schema::QuantitySchema;
use crate::smoothing::Smoothing;
use crate::units::quantities;

/// Keys of a wrap-spring clutch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WrapSpring {
    /// Stiffness of the engaged spring.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Smooth law; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(WrapSpring {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
});

impl LawKeys for WrapSpring {
    scalar_keys!();
    smoothing_field!();

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(smoothed(
            laws::wrap_spring(self.stiffness),
            self.smoothing.as_ref(),
        ))
    }
}

/// Keys of a spring with free play.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Backlash {
    /// Stiffness in contact.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Half of the gap: free play from -clearance to clearance.
    #[schemars(with = "QuantitySchema")]
    pub clearance: f64,
    /// Smooth law; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(Backlash {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
    clearance: quantities::DISPLACEMENT, Bound::Positive;
});

impl LawKeys for Backlash {
    scalar_keys!();
    smoothing_field!();

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(smoothed(
            laws::backlash(self.stiffness, self.clearance),
            self.smoothing.as_ref(),
        ))
    }
}

/// Keys of a linear spring and damper.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Isolator {
    /// Stiffness.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Damping coefficient.
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
}

scalars!(Isolator {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::NotNegative;
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative;
});

impl LawKeys for Isolator {
    scalar_keys!();

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(Arc::new(laws::Isolator {
            stiffness: self.stiffness,
            damping: self.damping,
        }))
    }
}

/// Keys of a cubic spring.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cubic {
    /// Coefficient of the deflection.
    #[schemars(with = "QuantitySchema")]
    pub linear: f64,
    /// Coefficient of the cube of the deflection.
    #[schemars(with = "QuantitySchema")]
    pub cubic: f64,
}

scalars!(Cubic {
    linear: quantities::GENERALISED_STIFFNESS, Bound::Any;
    cubic: quantities::GENERALISED_CUBIC_STIFFNESS, Bound::Any;
});

impl LawKeys for Cubic {
    scalar_keys!();

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(Arc::new(laws::Cubic {
            linear: self.linear,
            cubic: self.cubic,
        }))
    }
}
