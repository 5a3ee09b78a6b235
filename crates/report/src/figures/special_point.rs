//! Special points of branches and their symbols.

use crate::plot::{Color, Marker, Shape};

/// A located special point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpecialPoint {
    /// Parameter.
    pub x: f64,
    /// Measure.
    pub y: f64,
    /// What happens there.
    pub kind: SpecialKind,
    /// Number of the branch point that it follows: the curve is drawn through it, and changes between solid
    /// and dashed there. `None` draws the symbol only.
    pub after: Option<usize>,
}

/// Kinds of special points, each with a symbol of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpecialKind {
    /// Fold (limit point of cycles).
    Fold,
    /// Period doubling (flip).
    PeriodDoubling,
    /// Neimark–Sacker (torus) point.
    NeimarkSacker,
    /// Grazing of a switching surface.
    Grazing,
    /// Crossing of two branches.
    BranchPoint,
    /// Neutral saddle: multipliers of product one without loss of stability.
    NeutralSaddle,
}

impl SpecialKind {
    /// All kinds in the order of the legend.
    pub(super) const ALL: [SpecialKind; 6] = [
        SpecialKind::Fold,
        SpecialKind::PeriodDoubling,
        SpecialKind::NeimarkSacker,
        SpecialKind::BranchPoint,
        SpecialKind::NeutralSaddle,
        SpecialKind::Grazing,
    ];

    /// Name in the legend.
    pub(super) fn name(self) -> &'static str {
        match self {
            SpecialKind::Fold => "fold",
            SpecialKind::PeriodDoubling => "period doubling",
            SpecialKind::NeimarkSacker => "Neimark–Sacker",
            SpecialKind::Grazing => "grazing",
            SpecialKind::BranchPoint => "branch point",
            SpecialKind::NeutralSaddle => "neutral saddle",
        }
    }

    /// Symbol.
    pub(super) fn marker(self) -> Marker {
        match self {
            SpecialKind::Fold => Marker::filled(Shape::Circle, 3.6, Color::BLACK),
            SpecialKind::PeriodDoubling => Marker::filled(Shape::Square, 3.8, Color::BLACK),
            SpecialKind::NeimarkSacker => Marker::filled(Shape::Diamond, 3.6, Color::BLACK),
            SpecialKind::Grazing => Marker::open(Shape::Circle, 2.0, Color::BLACK),
            SpecialKind::BranchPoint => Marker::open(Shape::Asterisk, 5.2, Color::BLACK),
            SpecialKind::NeutralSaddle => Marker::open(Shape::Diamond, 3.6, Color::BLACK),
        }
    }

    /// Whether stability can change there.
    pub(super) fn changes_stability(self) -> bool {
        !matches!(self, SpecialKind::Grazing | SpecialKind::NeutralSaddle)
    }
}
