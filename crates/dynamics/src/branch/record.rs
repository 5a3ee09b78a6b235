//! What is known of a branch of periodic motions.

use slackside_continuation::StopReason;
use slackside_linalg::Complex;

/// A periodic motion on a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchPoint {
    /// Value of the parameter that varies along the branch.
    pub parameter: f64,
    /// Unknowns of the method: for shooting the state `(q, q')` at phase zero.
    pub unknowns: Vec<f64>,
    /// Floquet multipliers over the motion's period, largest modulus first.
    pub multipliers: Vec<Complex>,
    /// Number of events in the motion's period.
    pub events: usize,
    /// Largest scaled residual.
    pub residual: f64,
    /// Distance along the branch.
    pub arclength: f64,
}

impl BranchPoint {
    /// Whether all multipliers lie inside the unit circle.
    pub fn is_stable(&self) -> bool {
        self.multipliers.iter().all(|multiplier| multiplier.norm() < 1.0)
    }

    /// Number of multipliers outside the unit circle.
    pub fn unstable_directions(&self) -> usize {
        self.multipliers
            .iter()
            .filter(|multiplier| multiplier.norm() > 1.0)
            .count()
    }
}

/// What happens at a special point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SpecialKind {
    /// The parameter turns: a multiplier is +1.
    Fold,
    /// A multiplier is −1: a branch of twice the period starts.
    PeriodDoubling,
    /// A complex pair of multipliers has modulus 1: a torus starts.
    NeimarkSacker,
    /// The number of events changes: the motion touches a switching surface. Stability need not change.
    Grazing,
    /// Two real multipliers have the product 1: no bifurcation.
    NeutralSaddle,
    /// Another branch of the same period crosses.
    BranchPoint,
}

impl SpecialKind {
    /// The name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::PeriodDoubling => "period-doubling",
            Self::NeimarkSacker => "neimark-sacker",
            Self::Grazing => "grazing",
            Self::NeutralSaddle => "neutral-saddle",
            Self::BranchPoint => "branch-point",
        }
    }
}

/// A special point of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecialPoint {
    /// What happens there.
    pub kind: SpecialKind,
    /// The motion there.
    pub point: BranchPoint,
}

/// A branch of periodic motions.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// Periods of the load after which the motions repeat.
    pub periods: usize,
    /// Its motions in order.
    pub points: Vec<BranchPoint>,
    /// Its special points in order.
    pub special: Vec<SpecialPoint>,
    /// How it ended.
    pub stop: StopReason,
}

impl Branch {
    /// Parameters of the special points of one kind, in order along the branch.
    pub fn special_parameters(&self, kind: SpecialKind) -> Vec<f64> {
        self.special
            .iter()
            .filter(|s| s.kind == kind)
            .map(|s| s.point.parameter)
            .collect()
    }
}
