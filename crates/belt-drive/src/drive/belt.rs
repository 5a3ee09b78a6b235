//! The belt: stiffness, mass, damping, and how its spans are modelled.

/// Which motions of the spans the model has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BeltModel {
    /// Rotations and arms only; spans are springs.
    Spring,
    /// Moving strings: transverse motion, no bending stiffness.
    String,
    /// Moving beams: transverse motion with bending stiffness.
    Beam,
}

impl BeltModel {
    /// Its word in model files and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spring => "spring",
            Self::String => "string",
            Self::Beam => "beam",
        }
    }
}

/// Where a span with bending stiffness ends (theory 04 §8.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpanEnds {
    /// At the tangent points of a string, as in the dissertation; overstates the coupling of belt and pulleys.
    Tangent,
    /// At the free contact points, to leading order in the thickness of the boundary layer.
    Contact,
}

impl SpanEnds {
    /// Its word in model files and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tangent => "tangent",
            Self::Contact => "contact",
        }
    }
}

/// How the belt stretches on the arcs (theory 04 §2.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArcStretch {
    /// Not at all.
    None,
    /// By the mean tension of the adjacent spans.
    Mean,
    /// By the tension at the entry, as in creep with small slip arcs.
    Entry,
}

impl ArcStretch {
    /// Its word in model files and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Mean => "mean",
            Self::Entry => "entry",
        }
    }
}

/// The belt.
#[derive(Debug, Clone, PartialEq)]
pub struct Belt {
    /// Which motions the spans have.
    pub model: BeltModel,
    /// Axial stiffness `EA`, N.
    pub axial_stiffness: f64,
    /// Bending stiffness `EI`, N·m²; used by [`BeltModel::Beam`] only.
    pub bending_stiffness: f64,
    /// Mass per length `m`, kg/m.
    pub mass_per_length: f64,
    /// Where spans end.
    pub span_ends: SpanEnds,
    /// Stretch on the arcs.
    pub arc_stretch: ArcStretch,
    /// Sine terms of every span, `N_i`; one entry per span.
    pub terms: Vec<usize>,
    /// Whether the terms that are left out act on the span stiffness (theory 04 (3.11)).
    pub static_correction: bool,
    /// Share `β` of the adjacent arcs that stretches dynamically with a span, 0 to 1 (theory 04 §3.4).
    pub arc_participation: f64,
    /// Whether the belt on the arcs adds to the inertia of pulleys and arms (theory 04 §3.4).
    pub wrapped_inertia: bool,
    /// Damping.
    pub damping: BeltDamping,
    /// Thermal expansion along the belt, 1/K.
    pub thermal_expansion: f64,
}

impl Belt {
    /// Bending stiffness that acts in the model: zero unless the spans are beams.
    pub fn acting_bending_stiffness(&self) -> f64 {
        match self.model {
            BeltModel::Beam => self.bending_stiffness,
            BeltModel::Spring | BeltModel::String => 0.0,
        }
    }
}

/// Damping of the belt (theory 04 §3.6); every part is optional and they add.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BeltDamping {
    /// Dashpot parallel to the spring of every span, N·s/m.
    pub span_dashpot: f64,
    /// Longitudinal damping by a loss factor.
    pub loss_factor: Option<LossFactor>,
    /// External transverse damping per length on the transverse velocity, N·s/m².
    pub external: f64,
    /// Transverse drag per length on the material velocity, N·s/m².
    pub drag: f64,
    /// Internal bending damping `η_b I`, N·m²·s.
    pub internal_bending: f64,
    /// Part proportional to mass, 1/s.
    pub rayleigh_mass: f64,
    /// Part proportional to stiffness, s.
    pub rayleigh_stiffness: f64,
    /// Damping ratios of the modes without gyroscopic terms.
    pub modal: Option<ModalDamping>,
}

/// A dashpot `c_i = tan δ · k_i / ω_ref` in every span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LossFactor {
    /// `tan δ`.
    pub value: f64,
    /// Angular frequency `ω_ref` at which the dashpots have this loss factor, rad/s.
    pub reference_frequency: f64,
}

/// Damping ratios of the modes of the free coordinates without gyroscopic terms.
#[derive(Debug, Clone, PartialEq)]
pub enum ModalDamping {
    /// The same for all.
    Common(f64),
    /// From the lowest mode upwards; the last one holds for all further modes.
    Each(Vec<f64>),
}

impl ModalDamping {
    /// Damping ratio of a mode, counted from zero.
    pub fn ratio(&self, mode: usize) -> f64 {
        match self {
            Self::Common(ratio) => *ratio,
            Self::Each(ratios) => ratios.get(mode).or(ratios.last()).copied().unwrap_or_default(),
        }
    }
}
