//! The steady sheet as users read it.

use crate::Header;
use serde::Serialize;

/// The answer; numbers in SI units, speeds in rpm.
#[derive(Debug, Clone, Serialize)]
pub struct SteadyDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// Kind of the model.
    pub kind: &'static str,
    /// Speed of the driver, rpm.
    pub speed: f64,
    /// The belt.
    pub belt: BeltRow,
    /// The spans in the order of travel.
    pub spans: Vec<SpanRow>,
    /// The pulleys in the order of travel.
    pub pulleys: Vec<PulleyRow>,
    /// The tensioners.
    pub tensioners: Vec<TensionerRow>,
    /// Torque that the driver's shaft supplies, N·m.
    pub driver_torque: f64,
    /// Share of the driver's power that reaches the accessories, by belt creep; absent where a pulley would slip.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub efficiency: Option<f64>,
    /// The operating point by the geometrically exact belt with free contact points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cross_check: Option<SteadyCrossCheck>,
    /// The steady sheet in every condition of service.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub conditions: Vec<ConditionRow>,
    /// What varies, and its unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameter: Option<VariedRow>,
    /// Tensions, arms and hub loads over the varied quantity, one list for each condition, the one as installed first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub over: Vec<FanRow>,
}

/// The operating point by the elastica: bending without approximation, contact points where the belt leaves the pulleys
/// (theory 04 §2.8). What differs is the model of the span ends, not the arithmetic (theory 04 §8.1).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SteadyCrossCheck {
    /// Its method.
    pub method: &'static str,
    /// Tensions of the spans, `H + mc²`, N.
    pub tensions: Vec<f64>,
    /// Positions of the arms, rad or m.
    pub positions: Vec<f64>,
    /// Wrap angles, rad.
    pub wraps: Vec<f64>,
    /// Largest relative difference of the effective tensions.
    pub largest_difference: f64,
}

/// The belt.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BeltRow {
    /// Length of its path along the pitch line, m.
    pub pitch_length: f64,
    /// Natural length, m.
    pub natural_length: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// Centrifugal tension `mc²`, N.
    pub centrifugal_tension: f64,
}

/// A span.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpanRow {
    /// The pulley it leaves.
    pub from: String,
    /// The pulley it meets.
    pub to: String,
    /// Length between the tangent points, m.
    pub length: f64,
    /// Total tension, N.
    pub tension: f64,
    /// Effective tension `P − mc²`, N.
    pub effective_tension: f64,
    /// First natural frequency between fixed ends, Hz.
    pub frequency_1: f64,
    /// Sag indicator `χ`.
    pub sag_indicator: f64,
    /// Ends in the plane, m: where it leaves, where it meets.
    pub ends: [[f64; 2]; 2],
}

/// A pulley.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PulleyRow {
    /// Name.
    pub name: String,
    /// Whether it drives the belt.
    pub driver: bool,
    /// The tensioner that carries it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tensioner: Option<String>,
    /// Centre, m.
    pub center: [f64; 2],
    /// Pitch radius, m.
    pub radius: f64,
    /// Sense of rotation: +1 counter-clockwise, −1 clockwise.
    pub sense: f64,
    /// Wrap angle, rad.
    pub wrap: f64,
    /// Speed relative to the driver's without creep.
    pub ratio: f64,
    /// Speed without creep, rpm.
    pub speed: f64,
    /// Speed with creep, rpm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_with_creep: Option<f64>,
    /// Speed lost by creep, as a share.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_loss: Option<f64>,
    /// Slip arc, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip_arc: Option<f64>,
    /// Load torque, N·m; of the driver what it supplies.
    pub torque: f64,
    /// Force of the belt on the pulley, N.
    pub hub_load: [f64; 2],
    /// Its magnitude, N.
    pub hub_load_magnitude: f64,
    /// Its direction from the first axis, rad.
    pub hub_load_direction: f64,
    /// Safety against gross slip; absent without a load.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip_safety: Option<f64>,
    /// Torque at which the belt would slip all round with the present tension on the pulley's slack side, N·m.
    pub slip_torque: f64,
}

/// A tensioner.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TensionerRow {
    /// Name.
    pub name: String,
    /// `rotary` or `linear`.
    pub kind: &'static str,
    /// Angle of a rotary arm, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Position of a slide, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<f64>,
    /// Way from the reference position, rad or m.
    pub travel: f64,
    /// Belt length that it takes up per unit of its motion, m/rad or 1.
    pub take_up: f64,
    /// Torque or force of its spring, positive where it tightens the belt.
    pub torque: f64,
    /// Pivot of a rotary arm, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pivot: Option<[f64; 2]>,
    /// Stops, rad or m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stops: Option<[f64; 2]>,
    /// Direction of a slide.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 2]>,
}

/// The drive in a condition of service.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConditionRow {
    /// Its name.
    pub name: String,
    /// What it gives, or why it is not possible.
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// What a condition gives.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Outcome {
    /// Tensions and arms.
    State(StateRow),
    /// Why there is no steady state.
    Impossible {
        /// The reason.
        impossible: String,
    },
}

/// Tensions, hub loads and arms of one steady state.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateRow {
    /// Total tensions by span, N.
    pub tensions: Vec<f64>,
    /// Effective tensions by span, N.
    pub effective_tensions: Vec<f64>,
    /// Hub loads by pulley, N.
    pub hub_loads: Vec<[f64; 2]>,
    /// Slip safeties by pulley; absent where there is no load.
    pub slip_safeties: Vec<Option<f64>>,
    /// Wrap angles by pulley, rad.
    pub wraps: Vec<f64>,
    /// Positions of the arms, rad or m.
    pub positions: Vec<f64>,
}

/// What varies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VariedRow {
    /// `speed`, or a key of the file.
    pub key: String,
    /// Unit of its values.
    pub unit: String,
}

/// One condition over the varied quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FanRow {
    /// Name of the condition.
    pub name: String,
    /// Values of the varied quantity.
    pub values: Vec<f64>,
    /// What each gives.
    pub outcomes: Vec<Outcome>,
}

impl SteadyDocument {
    /// A warning for every condition that is impossible somewhere, with the first reason.
    pub(super) fn warn_of_impossible(&mut self) {
        let key = self.parameter.as_ref().map_or("", |parameter| &parameter.key);
        for row in &self.over {
            let failures: Vec<(f64, &str)> = row
                .values
                .iter()
                .zip(&row.outcomes)
                .filter_map(|(value, outcome)| match outcome {
                    Outcome::Impossible { impossible } => Some((*value, &**impossible)),
                    Outcome::State(_) => None,
                })
                .collect();
            if let Some((value, reason)) = failures.first() {
                self.header.warnings.push(format!(
                    "{}: {} of {} values of {key} are impossible, the first at {value}: {reason}",
                    row.name,
                    failures.len(),
                    row.values.len()
                ));
            }
        }
    }
}
