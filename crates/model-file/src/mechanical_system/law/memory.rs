//! Friction with a smooth memory: Dahl, LuGre, Valanis.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;
use slackside_mechanics::laws;

use super::keys::{LawKeys, SharedLaw, scalar_keys, scalar_numbers};
use crate::error::{Issue, Problem};
use crate::reader::Read;
use crate::scalar::{Absent, Bound, Scalars, join, scalars};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// Keys of Dahl's friction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dahl {
    /// Stiffness at a reversal of the motion.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Force or torque of steady sliding.
    #[schemars(with = "QuantitySchema")]
    pub torque: f64,
}

scalars!(Dahl {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
    torque: quantities::GENERALISED_FORCE, Bound::Positive;
});

impl LawKeys for Dahl {
    scalar_keys!();

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(Arc::new(laws::dahl(self.stiffness, self.torque)))
    }
}

/// Keys of the LuGre model.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lugre {
    /// Stiffness of the bristles.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Damping coefficient of the bristles; zero if it is not written.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
    /// Viscous coefficient of sliding; zero if it is not written.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub viscous_damping: f64,
    /// Force or torque of fast sliding.
    #[schemars(with = "QuantitySchema")]
    pub torque: f64,
    /// Ratio of the friction of very slow sliding to that of fast sliding, at least 1.
    #[serde(default = "one")]
    #[schemars(with = "RatioSchema")]
    pub static_ratio: f64,
    /// Rate over which the friction falls from slow to fast sliding (Stribeck); needed if the ratio is above 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub stribeck_rate: Option<f64>,
}

scalars!(Lugre {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Value(0.0);
    viscous_damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Value(0.0);
    torque: quantities::GENERALISED_FORCE, Bound::Positive;
    static_ratio: quantities::NUMBER, Bound::Positive => Absent::Value(1.0);
    stribeck_rate: quantities::RATE, Bound::Positive => Absent::Nothing;
});

fn one() -> f64 {
    1.0
}

impl LawKeys for Lugre {
    fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        if self.static_ratio < 1.0 {
            return Err(Issue::wrong_value(
                join(path, "static_ratio"),
                "friction of slow sliding is not below that of fast sliding",
            )
            .with_number(self.static_ratio)
            .with_help("give a ratio of at least 1"));
        }
        if self.static_ratio > 1.0 && self.stribeck_rate.is_none() {
            return Err(Issue::new(
                Problem::MissingKey,
                join(path, "stribeck_rate"),
                "nothing says at which rate the friction falls",
            )
            .with_help("add `stribeck_rate`, or leave out `static_ratio`"));
        }
        Ok(())
    }

    scalar_numbers!();

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(Arc::new(laws::LuGre {
            stiffness: self.stiffness,
            damping: self.damping,
            viscous: self.viscous_damping,
            stribeck: laws::Stribeck {
                torque: self.torque,
                static_ratio: self.static_ratio,
                // Without a fall any rate will do.
                velocity: self.stribeck_rate.unwrap_or(1.0),
            },
        }))
    }
}

/// Keys of Valanis' model.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Valanis {
    /// Stiffness at a reversal of the motion.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Stiffness in gross slip, below `stiffness`; zero if it is not written.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub slip_stiffness: f64,
    /// Force or torque of gross slip at zero deflection.
    #[schemars(with = "QuantitySchema")]
    pub torque: f64,
    /// Sharpness of the onset of slip, from 0 to below 1; zero if it is not written.
    #[serde(default)]
    #[schemars(with = "RatioSchema")]
    pub sharpness: f64,
}

scalars!(Valanis {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
    slip_stiffness: quantities::GENERALISED_STIFFNESS, Bound::NotNegative => Absent::Value(0.0);
    torque: quantities::GENERALISED_FORCE, Bound::Positive;
    sharpness: quantities::NUMBER, Bound::Share => Absent::Value(0.0);
});

impl LawKeys for Valanis {
    fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        self.law(path).map(|_| ())
    }

    scalar_numbers!();

    fn law(&self, path: &str) -> Read<SharedLaw> {
        // The bounds of single numbers have been checked; what is left are the two upper limits.
        let law = laws::Valanis::new(self.stiffness, self.slip_stiffness, self.torque, self.sharpness);
        let law = law.map_err(|_| {
            let (key, value, help) = if self.slip_stiffness >= self.stiffness {
                (
                    "slip_stiffness",
                    self.slip_stiffness,
                    "give a value below `stiffness`",
                )
            } else {
                ("sharpness", self.sharpness, "give a value below 1")
            };
            Issue::wrong_value(join(path, key), "is too large")
                .with_number(value)
                .with_help(help)
        })?;
        Ok(Arc::new(law))
    }
}
