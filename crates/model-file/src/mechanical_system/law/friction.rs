//! Dry friction, alone and in series with a spring.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;
use slackside_mechanics::laws;

use super::keys::{LawKeys, SharedLaw, scalar_keys, scalar_numbers, smoothing_field};
use crate::error::{Issue, Problem};
use crate::reader::Read;
use crate::scalar::{Absent, Bound, Scalars, join, scalars};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::smoothing::Smoothing;
use crate::units::quantities;

/// Keys of dry friction: one value, or one for each direction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// Force or torque that resists motion in both directions.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub torque: Option<f64>,
    /// Force or torque that resists motion with negative rate, itself positive.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub negative_torque: Option<f64>,
    /// Force or torque that resists motion with positive rate.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub positive_torque: Option<f64>,
    /// Ratio of the friction at rest to that in motion, at least 1.
    #[serde(default = "one")]
    #[schemars(with = "RatioSchema")]
    pub static_ratio: f64,
    /// Coefficient of a viscous part in both directions; zero if it is not written.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub damping: f64,
    /// Smooth law, whose width is a rate; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(Coulomb {
    torque: quantities::GENERALISED_FORCE, Bound::NotNegative => Absent::Nothing;
    negative_torque: quantities::GENERALISED_FORCE, Bound::NotNegative => Absent::Nothing;
    positive_torque: quantities::GENERALISED_FORCE, Bound::NotNegative => Absent::Nothing;
    static_ratio: quantities::NUMBER, Bound::Positive => Absent::Value(1.0);
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Value(0.0);
});

fn one() -> f64 {
    1.0
}

impl Coulomb {
    /// Friction against negative and positive rates.
    fn torques(&self, path: &str) -> Read<(f64, f64)> {
        let missing = |key: &str, message: &str, help: &str| {
            Err(Issue::new(Problem::MissingKey, join(path, key), message).with_help(help))
        };
        match (self.torque, self.negative_torque, self.positive_torque) {
            (Some(torque), None, None) => Ok((torque, torque)),
            (None, Some(negative), Some(positive)) => Ok((negative, positive)),
            (None, None, None) => missing(
                "torque",
                "nothing says how large the friction is",
                "add `torque`, or `negative_torque` and `positive_torque`",
            ),
            (Some(_), Some(again), _) => Err(given_twice(path, "negative_torque", again)),
            (Some(_), None, Some(again)) => Err(given_twice(path, "positive_torque", again)),
            (None, negative, _) => missing(
                if negative.is_some() {
                    "positive_torque"
                } else {
                    "negative_torque"
                },
                "is missing",
                "friction that depends on the direction has `negative_torque` and `positive_torque`; for one value \
                 write `torque`",
            ),
        }
    }
}

fn given_twice(path: &str, key: &str, value: f64) -> Box<Issue> {
    Issue::wrong_value(join(path, key), "the friction is already given by `torque`")
        .with_number(value)
        .with_help("keep `torque`, or `negative_torque` and `positive_torque`")
}

impl LawKeys for Coulomb {
    fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        self.torques(path)?;
        if self.static_ratio < 1.0 {
            return Err(Issue::wrong_value(
                join(path, "static_ratio"),
                "friction at rest is not below that in motion",
            )
            .with_number(self.static_ratio)
            .with_help("give a ratio of at least 1"));
        }
        if self.smoothing.is_some() && self.static_ratio > 1.0 {
            return Err(Issue::wrong_value(
                join(path, "static_ratio"),
                "smoothed friction creeps at rest and has no limit of its own there",
            )
            .with_number(self.static_ratio)
            .with_help("leave out `smoothing` or `static_ratio`"));
        }
        Ok(())
    }

    scalar_numbers!();
    smoothing_field!();

    fn law(&self, path: &str) -> Read<SharedLaw> {
        let (negative, positive) = self.torques(path)?;
        if negative == 0.0 && positive == 0.0 {
            // Nothing sticks: what remains is the viscous part.
            return Ok(Arc::new(laws::Isolator {
                stiffness: 0.0,
                damping: self.damping,
            }));
        }
        let ray = |constant: f64| laws::Ray {
            constant,
            damping: self.damping,
        };
        let exact = laws::dry_friction(ray(-negative), ray(positive), self.static_ratio);
        let Some(Smoothing { kind, width }) = &self.smoothing else {
            return Ok(Arc::new(exact));
        };
        let smooth = laws::SmoothedGraph::new(exact, (*kind).into(), *width);
        let smooth =
            smooth.map_err(|fault| Issue::wrong_value(join(path, "smoothing"), fault.to_string()))?;
        Ok(Arc::new(smooth))
    }
}

/// Keys of a spring in series with dry friction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringSlider {
    /// Stiffness of the spring.
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
    /// Force or torque at which the slider yields.
    #[schemars(with = "QuantitySchema")]
    pub torque: f64,
}

scalars!(SpringSlider {
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive;
    torque: quantities::GENERALISED_FORCE, Bound::Positive;
});

impl LawKeys for SpringSlider {
    scalar_keys!();

    fn law(&self, _: &str) -> Read<SharedLaw> {
        Ok(Arc::new(laws::spring_slider(self.stiffness, self.torque)))
    }
}
