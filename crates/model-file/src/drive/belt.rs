//! `[belt]`: section, length, friction, and how the spans are modelled.

use schemars::JsonSchema;
use serde::Serialize;

use super::{BeltDamping, yes};
use crate::scalar::{Absent, Bound, Numbers, Scalars, join, scalars, split_first};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// The belt.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Belt {
    /// Which motions of the spans the model has.
    pub model: BeltModel,
    /// Stiffness and mass, of the whole belt or of one rib.
    #[serde(flatten)]
    pub section: Section,
    /// Number of ribs.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub ribs: Option<u32>,
    /// What is known of the belt's length.
    #[serde(flatten)]
    pub length: Length,
    /// Strand tension under which the effective length was measured, N; zero if it is the length of the unstretched belt.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub measuring_tension: Option<f64>,
    /// Friction on the ribs; 1 if it is not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// Friction coefficient of the back; that of the ribs without their groove if it is not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<RatioSchema>")]
    pub back_friction: Option<f64>,
    /// Distance of the cord line from the surface that touches the ribs of a pulley, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub cord_offset_ribs: Option<f64>,
    /// Distance of the cord line from the back of the belt, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub cord_offset_back: Option<f64>,
    /// Sine terms of every span: one number, or one for each span.
    #[serde(default)]
    pub modes_per_span: ModesPerSpan,
    /// Whether the terms that are left out act on the stiffness of the span (theory 04 §3.5).
    #[serde(default = "yes")]
    pub static_correction: bool,
    /// Where spans with bending stiffness end (theory 04 §8).
    #[serde(default)]
    pub span_ends: SpanEnds,
    /// How the belt stretches on the arcs (theory 04 §2.4).
    #[serde(default)]
    pub arc_stretch: ArcStretch,
    /// Damping; the parts add.
    #[serde(default)]
    pub damping: BeltDamping,
    /// Thermal expansion along the belt, 1/K.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub thermal_expansion: f64,
    /// Share of the adjacent arcs that stretches with a vibrating span, 0 to 1 (theory 04 §3.4).
    #[serde(default)]
    #[schemars(with = "RatioSchema")]
    pub arc_participation: f64,
    /// Whether the belt on the arcs adds to the inertia of pulleys and arms (theory 04 §3.4).
    #[serde(default)]
    pub wrapped_inertia: bool,
}

scalars!(Belt {
    measuring_tension: quantities::FORCE, Bound::NotNegative => Absent::Nothing;
    back_friction: quantities::NUMBER, Bound::Positive => Absent::Nothing;
    cord_offset_ribs: quantities::LENGTH, Bound::NotNegative => Absent::Nothing;
    cord_offset_back: quantities::LENGTH, Bound::NotNegative => Absent::Nothing;
    thermal_expansion: quantities::THERMAL_EXPANSION, Bound::Any => Absent::Value(0.0);
    arc_participation: quantities::NUMBER, Bound::Share => Absent::Value(0.0);
});

/// Which motions of the spans the model has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BeltModel {
    /// Rotations and arms only; spans are springs.
    Spring,
    /// Moving strings: transverse motion without bending stiffness.
    String,
    /// Moving beams: transverse motion with bending stiffness.
    Beam,
}

/// Where spans with bending stiffness end (theory 04 §8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpanEnds {
    /// At the tangent points of a string, as in the dissertation.
    #[default]
    Tangent,
    /// At the free contact points; recommended for design work.
    Contact,
}

/// How the belt stretches on the arcs (theory 04 §2.4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ArcStretch {
    /// Not at all.
    None,
    /// By the mean tension of the adjacent spans.
    #[default]
    Mean,
    /// By the tension at the entry.
    Entry,
}

/// Stiffness and mass, of the whole belt or of one rib.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Section {
    /// Of one rib; the belt has `ribs` of them.
    PerRib(PerRib),
    /// Of the whole belt.
    Whole(SectionProperties),
}

/// Stiffness and mass of one rib.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PerRib {
    /// Stiffness and mass of one rib; the belt has `ribs` of them.
    pub per_rib: SectionProperties,
}

/// Stiffness and mass of a belt's section.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct SectionProperties {
    /// Axial stiffness `EA`, N.
    #[schemars(with = "QuantitySchema")]
    pub axial_stiffness: f64,
    /// Bending stiffness `EI`, N m².
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub bending_stiffness: f64,
    /// Mass per length, kg/m.
    #[schemars(with = "QuantitySchema")]
    pub mass_per_length: f64,
}

scalars!(SectionProperties {
    axial_stiffness: quantities::AXIAL_STIFFNESS, Bound::Positive;
    bending_stiffness: quantities::BENDING_STIFFNESS, Bound::NotNegative => Absent::Value(0.0);
    mass_per_length: quantities::MASS_PER_LENGTH, Bound::Positive;
});

/// What is known of the belt's length (theory 04 §2.5); exactly one of the forms.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Length {
    /// Length of the unstretched belt along the cord line, m.
    NaturalLength(#[schemars(with = "QuantitySchema")] f64),
    /// Effective length by the standard of the ribs, m: the length along the cord line is `2 pi cord_offset_ribs` more
    /// (theory 04 §1).
    EffectiveLength(#[schemars(with = "QuantitySchema")] f64),
    /// The length follows from how the drive was installed.
    Installation(Installation),
}

/// How the drive was installed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Installation {
    /// At rest and unloaded, with this tension everywhere and every arm at its reference.
    Tension(RestTension),
    /// Every arm stands at its reference at the operating point.
    OperatingPosition(OperatingPosition),
}

/// Tension at rest.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RestTension {
    /// Tension at rest, unloaded, every arm at its reference, N; the preload of the springs follows.
    #[schemars(with = "QuantitySchema")]
    pub tension: f64,
}

/// Arms at their reference at the operating point.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OperatingPosition {
    /// True: every arm stands at its reference at the operating point, where its spring has the preload.
    pub operating_position: bool,
}

/// Friction on the ribs.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Friction {
    /// Effective coefficient, the wedge action of the grooves included.
    Effective(#[schemars(with = "RatioSchema")] f64),
    /// Coefficient of the material, and the grooves.
    Grooved(GroovedFriction),
}

/// Coefficient of the material, and the grooves (theory 04 §2.7).
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroovedFriction {
    /// Friction coefficient of the material.
    #[schemars(with = "RatioSchema")]
    pub coefficient: f64,
    /// Full angle of the grooves, rad; 40 degrees for PK ribs.
    #[schemars(with = "QuantitySchema")]
    pub groove_angle: f64,
}

scalars!(GroovedFriction {
    coefficient: quantities::NUMBER, Bound::Positive;
    groove_angle: quantities::ANGLE, Bound::Positive;
});

/// Sine terms of the spans.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ModesPerSpan {
    /// The same for all.
    Common(usize),
    /// One number for each span, in the order of the pulleys at which the spans start.
    Each(Vec<usize>),
}

impl Default for ModesPerSpan {
    fn default() -> Self {
        Self::Common(10)
    }
}

impl Numbers for Belt {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        let (key, rest) = split_first(path);
        match key {
            "per_rib" => match &mut self.section {
                Section::PerRib(section) => section.per_rib.scalar_mut(rest),
                Section::Whole(_) => None,
            },
            "axial_stiffness" | "bending_stiffness" | "mass_per_length" => match &mut self.section {
                Section::Whole(section) => section.scalar_mut(path),
                Section::PerRib(_) => None,
            },
            "natural_length" | "effective_length" | "installation" => self.length.number_mut(path),
            "friction" => self.friction.as_mut()?.number_mut(rest),
            "damping" => self.damping.number_mut(rest),
            _ => self.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match &self.section {
            Section::PerRib(section) => section
                .per_rib
                .collect_scalar_keys(&join(prefix, "per_rib"), keys),
            Section::Whole(section) => section.collect_scalar_keys(prefix, keys),
        }
        self.length.collect_keys(prefix, keys);
        if let Some(friction) = &self.friction {
            friction.collect_keys(&join(prefix, "friction"), keys);
        }
        self.collect_scalar_keys(prefix, keys);
        self.damping.collect_keys(&join(prefix, "damping"), keys);
    }
}

impl Numbers for Length {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match (self, path) {
            (Self::NaturalLength(length), "natural_length")
            | (Self::EffectiveLength(length), "effective_length") => Some(length),
            (Self::Installation(Installation::Tension(state)), "installation.tension") => {
                Some(&mut state.tension)
            }
            _ => None,
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match self {
            Self::NaturalLength(_) => keys.push(join(prefix, "natural_length")),
            Self::EffectiveLength(_) => keys.push(join(prefix, "effective_length")),
            Self::Installation(Installation::Tension(_)) => keys.push(join(prefix, "installation.tension")),
            Self::Installation(Installation::OperatingPosition(_)) => {}
        }
    }
}

impl Numbers for Friction {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match self {
            Self::Effective(coefficient) => path.is_empty().then_some(coefficient),
            Self::Grooved(friction) => friction.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match self {
            Self::Effective(_) => keys.push(prefix.to_owned()),
            Self::Grooved(friction) => friction.collect_scalar_keys(prefix, keys),
        }
    }
}
