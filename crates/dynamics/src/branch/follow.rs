//! Following a branch of periodic motions by any method whose family observes multipliers.

use super::record::{Branch, BranchPoint, SpecialKind, SpecialPoint};
use slackside_continuation::{Family, Kind, Options, Point, Special, Watch, trace_from};
use slackside_linalg::Complex;

/// A family of periodic motions. Its test functions are, in this order, those of period doubling and of Neimark–Sacker
/// points; it observes the multipliers (real and imaginary parts, largest modulus first); its pattern is the number of
/// events.
pub trait BranchFamily: Family {
    /// Periods of the load after which the motions repeat.
    fn periods(&self) -> usize;

    /// The family as the tracer knows it.
    fn as_family(&mut self) -> &mut dyn Family;
}

/// Options of [`follow`].
#[derive(Debug, Clone)]
pub struct BranchOptions {
    /// Options of the tracer.
    pub continuation: Options,
    /// Direction in which the parameter changes at first: positive or negative.
    pub direction: f64,
}

/// How far from ±1 or the unit circle a multiplier may be at a located point. Near a double multiplier a shift of the
/// parameter by rounding moves multipliers by its square root.
const CONFIRMATION: f64 = 1e-4;

/// Follows a branch from a motion near `unknowns` at `parameter`. `progress` is told of each point and returns false to
/// stop.
pub fn follow(
    family: &mut dyn BranchFamily,
    unknowns: &[f64],
    parameter: f64,
    options: &BranchOptions,
    progress: &mut dyn FnMut(&BranchPoint) -> bool,
) -> Branch {
    let mut tangent = vec![0.0; family.dimension() + 1];
    if let Some(along_parameter) = tangent.last_mut() {
        *along_parameter = options.direction.signum();
    }
    follow_from(family, unknowns, parameter, &tangent, options, progress)
}

/// Follows a branch from a motion near `unknowns` along a given scaled tangent, as after branch switching.
pub fn follow_from(
    family: &mut dyn BranchFamily,
    unknowns: &[f64],
    parameter: f64,
    tangent: &[f64],
    options: &BranchOptions,
    progress: &mut dyn FnMut(&BranchPoint) -> bool,
) -> Branch {
    let periods = family.periods();
    let mut recorder = Recorder {
        points: Vec::new(),
        special: Vec::new(),
        progress,
    };
    let trace = trace_from(
        family.as_family(),
        unknowns,
        parameter,
        tangent,
        &options.continuation,
        &mut recorder,
    );
    Branch {
        periods,
        points: recorder.points,
        special: recorder.special,
        stop: trace.stop,
    }
}

/// Turns the tracer's points into motions, and its zeros into named special points.
struct Recorder<'a> {
    points: Vec<BranchPoint>,
    special: Vec<SpecialPoint>,
    progress: &'a mut dyn FnMut(&BranchPoint) -> bool,
}

impl Watch for Recorder<'_> {
    fn point(&mut self, point: &Point) -> bool {
        let point = motion(point);
        let go_on = (self.progress)(&point);
        self.points.push(point);
        go_on
    }

    fn special(&mut self, special: &Special) -> bool {
        let point = motion(&special.point);
        let Some(kind) = kind_of(special.kind, &point.multipliers) else {
            return false;
        };
        self.special.push(SpecialPoint { kind, point });
        true
    }
}

fn motion(point: &Point) -> BranchPoint {
    BranchPoint {
        parameter: point.p,
        unknowns: point.z.clone(),
        multipliers: point
            .observed
            .chunks_exact(2)
            .map(|m| Complex::new(m[0], m[1]))
            .collect(),
        events: usize::try_from(point.pattern).unwrap_or(0),
        residual: point.residual,
        arclength: point.arclength,
    }
}

/// The name of a located point, confirmed by its multipliers; `None` if they do not confirm it.
fn kind_of(kind: Kind, multipliers: &[Complex]) -> Option<SpecialKind> {
    let near = |target: f64| multipliers.iter().any(|m| (m - target).norm() < CONFIRMATION);
    match kind {
        Kind::Fold => near(1.0).then_some(SpecialKind::Fold),
        Kind::BranchPoint => Some(SpecialKind::BranchPoint),
        Kind::Test(0) => near(-1.0).then_some(SpecialKind::PeriodDoubling),
        Kind::Test(_) => pair_of_product_one(multipliers),
        Kind::Change { .. } => Some(SpecialKind::Grazing),
    }
}

/// Which pair of multipliers has the product 1: a complex one (Neimark–Sacker) or two real ones (neutral saddle).
fn pair_of_product_one(multipliers: &[Complex]) -> Option<SpecialKind> {
    let mut best = (CONFIRMATION, None);
    for i in 0..multipliers.len() {
        for j in 0..i {
            let distance = (multipliers[i] * multipliers[j] - 1.0).norm();
            if distance < best.0 {
                let complex = multipliers[i].im != 0.0;
                best = (
                    distance,
                    Some(if complex {
                        SpecialKind::NeimarkSacker
                    } else {
                        SpecialKind::NeutralSaddle
                    }),
                );
            }
        }
    }
    best.1
}
