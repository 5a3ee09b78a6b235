//! The answer of `response` as users read it.

use super::curve::{Curve, End};
use super::periodic::{OptimumRow, Trust, UniquenessRow};
use super::tracer::Setup;
use crate::{Header, Label, Measures, Motion, Named, Parameter, Quantity, StudyError, pair};
use rayon::prelude::*;
use serde::Serialize;
use slackside_dynamics::branch::BranchPoint;
use slackside_linalg::Complex;

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct ResponseDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// What varies along the branches.
    pub parameter: ParameterRow,
    /// The branches.
    pub branches: Vec<BranchRow>,
    /// What is known of the uniqueness of the response, where the method tells.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub uniqueness: Vec<UniquenessRow>,
    /// The best value of the parameter, if it was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub optimum: Vec<OptimumRow>,
    /// All motions at the values asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<OrbitRow>,
    /// Settled motions of a check by time integration with rising parameter.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub up: Vec<SweepPointRow>,
    /// The same with falling parameter.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub down: Vec<SweepPointRow>,
}

/// What varies along the branches.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterRow {
    /// `frequency`, or a key of the model.
    pub key: String,
    /// Unit of its values.
    pub unit: String,
    /// First value asked for.
    pub from: f64,
    /// Last value asked for.
    pub to: f64,
}

/// One branch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BranchRow {
    /// Value of the family key, if branches were followed for several.
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub label: Option<Label>,
    /// Periods of the load after which its motions repeat.
    pub periods: usize,
    /// How it ends at its first and at its last point: `range`, `closed`, `period-doubling`, `step` (no motion was found
    /// beyond), `points` or `interrupted`.
    pub ends: [&'static str; 2],
    /// Motions in order along the branch.
    pub points: Vec<PointRow>,
    /// Special points in order along the branch.
    pub special: Vec<SpecialRow>,
}

/// A motion on a branch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PointRow {
    /// Value of the parameter.
    #[serde(flatten)]
    pub at: Parameter,
    /// Whether all multipliers lie inside the unit circle.
    pub stable: bool,
    /// Floquet multipliers over the motion's period.
    pub multipliers: Vec<[f64; 2]>,
    /// Largest scaled residual.
    pub residual: f64,
    /// State at phase zero: coordinates, then rates.
    pub start: Vec<f64>,
    /// What only multiple scales knows of the motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub multiple_scales: Option<ScalesRow>,
    /// How far it can be trusted, where the method tells.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub trust: Option<Trust>,
    /// Measures and events.
    #[serde(flatten)]
    pub motion: Motion,
}

/// A steady state of the slow flow (theory 02 §10).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ScalesRow {
    /// Number of the resonant mode, from one.
    pub mode: usize,
    /// Its modal amplitude.
    pub amplitude: f64,
    /// Phase by which the motion lags behind the load, radians.
    pub phase: f64,
    /// Static deflection over the amplitude of the deflection; no separation at or above one.
    pub gamma: f64,
    /// Largest correction of second order relative to the amplitude of the deflection.
    pub correction: f64,
    /// Whether that is at most 0.1, the limit up to which the expansion is validated.
    pub validated: bool,
}

/// A special point of a branch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpecialRow {
    /// What happens there.
    pub kind: &'static str,
    /// Value of the parameter.
    #[serde(flatten)]
    pub at: Parameter,
    /// Number of the branch point that it follows.
    pub after: usize,
    /// Multipliers.
    pub multipliers: Vec<[f64; 2]>,
    /// Measures, without harmonics.
    pub measures: Measures,
}

/// A motion at an exact value of the parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OrbitRow {
    /// Value of the parameter.
    #[serde(flatten)]
    pub at: Parameter,
    /// Value of the family key.
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub label: Option<Label>,
    /// Number of the branch it lies on.
    pub branch: usize,
    /// Periods of the load after which it repeats.
    pub periods: usize,
    /// Whether all multipliers lie inside the unit circle.
    pub stable: bool,
    /// Floquet multipliers.
    pub multipliers: Vec<[f64; 2]>,
    /// Largest scaled residual.
    pub residual: f64,
    /// State at phase zero.
    pub start: Vec<f64>,
    /// What only multiple scales knows of the motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub multiple_scales: Option<ScalesRow>,
    /// How far it can be trusted, where the method tells.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub trust: Option<Trust>,
    /// Measures and events.
    #[serde(flatten)]
    pub motion: Motion,
    /// Histories over its period, where the method gives them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub history: Option<History>,
}

/// Measures over one period of a motion at equal intervals.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct History {
    /// Fractions of the motion's period.
    pub phase: Vec<f64>,
    /// Values of each measure.
    pub measures: Named<Vec<f64>>,
}

/// A settled motion of the check by time integration.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepPointRow {
    /// Value of the parameter.
    #[serde(flatten)]
    pub at: Parameter,
    /// Value of the family key.
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub label: Option<Label>,
    /// What it is: `periodic-1`, `quasi-periodic` and so on.
    pub kind: String,
    /// Measures, without harmonics.
    pub measures: Measures,
}

/// Multipliers as users read them.
pub fn multiplier_pairs(multipliers: &[Complex]) -> Vec<[f64; 2]> {
    multipliers.iter().map(pair).collect()
}

/// The name of an end in results.
pub fn end_name(end: End) -> &'static str {
    match end {
        End::Range => "range",
        End::Closed => "closed",
        End::Doubling => "period-doubling",
        End::Step => "step",
        End::Points => "points",
        End::Interrupted => "interrupted",
    }
}

/// Points between which one shooting object is used: few enough for all cores to have work.
const CHUNK: usize = 64;

/// A branch with everything that is reported of its motions.
///
/// # Errors
/// [`StudyError`] if a motion on the branch cannot be computed again.
pub fn branch_row(
    setup: &Setup,
    curve: &Curve,
    quantity: &Quantity,
    label: Option<Label>,
    harmonics: usize,
) -> Result<BranchRow, StudyError> {
    let setup = setup.of_curve(curve);
    let parameter = |point: &BranchPoint| Parameter {
        key: quantity.key.clone(),
        value: quantity.value(point.parameter),
    };
    let indexed: Vec<(&BranchPoint, &Vec<f64>)> = curve.points.iter().zip(&curve.states).collect();
    let chunks: Result<Vec<Vec<PointRow>>, StudyError> = indexed
        .par_chunks(CHUNK)
        .map(|chunk| {
            let Some((first, _)) = chunk.first() else {
                return Ok(Vec::new());
            };
            let mut shooting = setup.shooting(first.parameter)?;
            chunk
                .iter()
                .map(|(point, state)| {
                    Ok(PointRow {
                        at: parameter(point),
                        stable: point.is_stable(),
                        multipliers: multiplier_pairs(&point.multipliers),
                        residual: point.residual,
                        start: (*state).clone(),
                        multiple_scales: None,
                        trust: None,
                        motion: setup.motion(&mut shooting, point, harmonics)?,
                    })
                })
                .collect()
        })
        .collect();
    let mut special = Vec::with_capacity(curve.special.len());
    if let Some(first) = curve.special.first() {
        let mut shooting = setup.shooting(first.point.parameter)?;
        for found in &curve.special {
            let point = &found.point;
            special.push(SpecialRow {
                kind: found.kind.name(),
                at: parameter(point),
                after: curve
                    .points
                    .partition_point(|before| before.arclength <= point.arclength)
                    .saturating_sub(1),
                multipliers: multiplier_pairs(&point.multipliers),
                measures: setup.motion(&mut shooting, point, 0)?.measures,
            });
        }
    }
    Ok(BranchRow {
        label,
        periods: curve.periods,
        ends: curve.ends.map(end_name),
        points: chunks?.into_iter().flatten().collect(),
        special,
    })
}
