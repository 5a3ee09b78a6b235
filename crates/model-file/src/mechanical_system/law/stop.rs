//! One-sided stops: compliant with a stiffness, or rigid with a coefficient of restitution.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;
use slackside_mechanics::laws;

use super::keys::{LawKeys, SharedLaw, scalar_numbers, smoothed, smoothing_field};
use crate::error::{Issue, Problem};
use crate::reader::Read;
use crate::scalar::{Absent, Bound, Scalars, join, scalars};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::smoothing::Smoothing;
use crate::units::quantities;

/// Keys of a one-sided stop.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Deflection at which contact begins.
    #[schemars(with = "QuantitySchema")]
    pub gap: f64,
    /// Coefficient of restitution of a rigid stop, from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<RatioSchema>")]
    pub restitution: Option<f64>,
    /// Stiffness in contact of a compliant stop.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub stiffness: Option<f64>,
    /// Damping coefficient in contact of a compliant stop, which pushes but does not pull.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub damping: Option<f64>,
    /// Smooth law of a compliant stop without damping; without it the law is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

scalars!(Stop {
    gap: quantities::DISPLACEMENT, Bound::NotNegative;
    restitution: quantities::NUMBER, Bound::Share => Absent::Nothing;
    stiffness: quantities::GENERALISED_STIFFNESS, Bound::Positive => Absent::Nothing;
    damping: quantities::GENERALISED_DAMPING, Bound::NotNegative => Absent::Nothing;
});

impl Stop {
    /// Whether the contact is damped.
    fn damped(&self) -> Option<f64> {
        self.damping.filter(|damping| *damping > 0.0)
    }
}

impl LawKeys for Stop {
    fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        match (self.restitution, self.stiffness) {
            (None, None) => {
                return Err(Issue::new(
                    Problem::MissingKey,
                    join(path, "stiffness"),
                    "nothing says whether the stop is compliant or rigid",
                )
                .with_help("add `stiffness`, or for a rigid stop `restitution`"));
            }
            (Some(_), None) if self.damping.is_none() && self.smoothing.is_none() => {}
            (Some(_), _) => {
                let numbers = [("stiffness", self.stiffness), ("damping", self.damping)];
                let given = numbers.into_iter().find(|(_, value)| value.is_some());
                let (key, value) = given.unwrap_or(("smoothing", None));
                let issue = Issue::wrong_value(
                    join(path, key),
                    format!("a stop with `restitution` is rigid and has no {key}"),
                )
                .with_help("leave out `restitution` for a compliant stop");
                return Err(match value {
                    Some(value) => issue.with_number(value),
                    None => issue,
                });
            }
            (None, Some(_)) => {}
        }
        if self.smoothing.is_some() && self.damped().is_some() {
            return Err(Issue::wrong_value(
                join(path, "smoothing"),
                "only a stop without damping can be smoothed",
            )
            .with_help("leave out `smoothing` or `damping`"));
        }
        Ok(())
    }

    scalar_numbers!();
    smoothing_field!();

    fn law(&self, path: &str) -> Read<SharedLaw> {
        self.check(path)?;
        Ok(
            match (
                self.restitution,
                self.stiffness.unwrap_or_default(),
                self.damped(),
            ) {
                (Some(restitution), _, _) => Arc::new(laws::rigid_stop(self.gap, restitution)),
                (None, stiffness, Some(damping)) => Arc::new(laws::damped_stop(self.gap, stiffness, damping)),
                (None, stiffness, None) => smoothed(laws::stop(stiffness, self.gap), self.smoothing.as_ref()),
            },
        )
    }
}
