//! `belt.damping`: the forms of damping of theory 04 §3.6.

use schemars::JsonSchema;
use serde::Serialize;

use crate::scalar::{Absent, Bound, Numbers, Scalars, collect_items, item_mut, join, scalars, split_first};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// Damping of the belt (theory 04 §3.6); every part is optional and they add.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BeltDamping {
    /// Loss factor of the spans' longitudinal stiffness, `tan delta`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<RatioSchema>")]
    pub loss_factor: Option<f64>,
    /// Angular frequency at which the dashpots have the loss factor, rad/s; without it, that of the lowest order of the
    /// excitation at the operating speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub reference_frequency: Option<f64>,
    /// Dashpot parallel to the longitudinal stiffness of every span, N s/m.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub span_dashpot: f64,
    /// Damping per length on the transverse velocity, N s/m².
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub external: f64,
    /// Drag per length on the transverse velocity of the moving material, N s/m².
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub drag: f64,
    /// Internal damping of bending, N m² s.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub internal_bending: f64,
    /// Damping proportional to mass and stiffness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rayleigh: Option<Rayleigh>,
    /// Damping ratios of the modes without gyroscopic terms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modal: Option<ModalDamping>,
}

scalars!(BeltDamping {
    loss_factor: quantities::NUMBER, Bound::NotNegative => Absent::Nothing;
    reference_frequency: quantities::ANGULAR_FREQUENCY, Bound::Positive => Absent::Nothing;
    span_dashpot: quantities::DAMPING, Bound::NotNegative => Absent::Value(0.0);
    external: quantities::DAMPING_PER_LENGTH, Bound::NotNegative => Absent::Value(0.0);
    drag: quantities::DAMPING_PER_LENGTH, Bound::NotNegative => Absent::Value(0.0);
    internal_bending: quantities::BENDING_DAMPING, Bound::NotNegative => Absent::Value(0.0);
});

/// Damping proportional to mass and stiffness.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// Factor of the mass matrix, 1/s.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub mass: f64,
    /// Factor of the stiffness matrix, s.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub stiffness: f64,
}

scalars!(Rayleigh {
    mass: quantities::PER_TIME, Bound::NotNegative => Absent::Value(0.0);
    stiffness: quantities::TIME, Bound::NotNegative => Absent::Value(0.0);
});

/// Damping ratios of the modes without gyroscopic terms.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ModalDamping {
    /// The same for all modes.
    Common(#[schemars(with = "RatioSchema")] f64),
    /// From the lowest mode upwards; the last one holds for all further modes.
    Each(#[schemars(with = "Vec<RatioSchema>", length(min = 1))] Vec<f64>),
}

impl Numbers for BeltDamping {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("rayleigh", rest) => self.rayleigh.as_mut()?.scalar_mut(rest),
            ("modal", rest) => match self.modal.as_mut()? {
                ModalDamping::Common(ratio) => rest.is_empty().then_some(ratio),
                ModalDamping::Each(ratios) => item_mut(ratios, rest),
            },
            _ => self.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        self.collect_scalar_keys(prefix, keys);
        if let Some(rayleigh) = &self.rayleigh {
            rayleigh.collect_scalar_keys(&join(prefix, "rayleigh"), keys);
        }
        let modal = join(prefix, "modal");
        match &self.modal {
            Some(ModalDamping::Common(_)) => keys.push(modal),
            Some(ModalDamping::Each(ratios)) => collect_items(ratios, &modal, keys),
            None => {}
        }
    }
}
