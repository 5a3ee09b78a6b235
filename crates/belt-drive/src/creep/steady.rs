//! Creep on every pulley of a drive whose span tensions are known (theory 04 §6.2, last lines).

use super::CreepError;
use crate::drive::Drive;
use crate::steady::SteadyState;

/// What the belt does in the slip arc of a pulley.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlipDirection {
    /// No change of tension, no slip.
    None,
    /// The belt runs ahead of the rim: tension rises along the travel, the pulley is driven.
    BeltAhead,
    /// The belt lags behind the rim: tension falls along the travel, the pulley drives.
    BeltBehind,
}

/// Coulomb friction on one wrap (theory 04 (2.12)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Slip arc `φ_s = |ln(T_out/T_in)|/μ_e`, rad; infinite if there is load without friction.
    pub slip_arc: f64,
    /// Wrap that is left for adhesion, rad; negative if the belt slips all round.
    pub adhesion_arc: f64,
    /// Safety against gross slip, `μ_e φ / |ln(T_out/T_in)|`; infinite without load.
    pub safety: f64,
    /// What the belt does in the slip arc.
    pub direction: SlipDirection,
}

/// Slip and adhesion on a wrap (rad) from the effective tensions before and after it (positive, N) and the effective
/// friction coefficient.
pub fn contact_of(wrap: f64, friction: f64, before: f64, after: f64) -> Contact {
    let logarithm = (after / before).ln();
    let (slip_arc, safety) = if logarithm == 0.0 {
        (0.0, f64::INFINITY)
    } else {
        (logarithm.abs() / friction, friction * wrap / logarithm.abs())
    };
    let direction = if logarithm > 0.0 {
        SlipDirection::BeltAhead
    } else if logarithm < 0.0 {
        SlipDirection::BeltBehind
    } else {
        SlipDirection::None
    };
    Contact {
        slip_arc,
        adhesion_arc: wrap - slip_arc,
        safety,
        direction,
    }
}

/// Creep on one pulley.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PulleyCreep {
    /// Arcs, safety and direction.
    pub contact: Contact,
    /// Surface speed `ω_j r_j` over that of the driver.
    pub surface_speed_ratio: f64,
    /// `1 − surface_speed_ratio`.
    pub speed_loss: f64,
    /// Power that the pulley takes from the belt, `M_j ω_j`, W; negative at the driver.
    pub power: f64,
    /// Work of friction per time in the slip arc, W.
    pub power_lost: f64,
}

/// Creep of the whole drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Creep {
    /// The pulleys, in the order of belt travel.
    pub pulleys: Vec<PulleyCreep>,
    /// Power of the driver, W.
    pub power_in: f64,
    /// Power that the other pulleys take, W.
    pub power_out: f64,
    /// Work of friction per time on all pulleys, W; equals `power_in − power_out`.
    pub power_lost: f64,
    /// `Σ_{j≠d} M_j ω_j / (M_d ω_d)`, of torques and speed ratios, so that it has a value at rest; `None` without load.
    pub efficiency: Option<f64>,
}

/// Creep of a drive in its steady state, with the friction of its pulleys.
///
/// The effective tension is `T_i = P_i − m c²` with one `m c²` for all spans, as in the steady state (theory 04 §2.1), and
/// the speed of the belt in a span is proportional to `1 + P_i/EA`. In this model the work of friction on pulley `j` is
/// `v₀ (P_j − P_{j−1})²/(2 EA)`, `v₀` the speed of the unstretched belt, and the sum over the pulleys is exactly the power
/// that the driver puts in and the others do not take out.
///
/// # Errors
/// [`CreepError::Slack`] or [`CreepError::GrossSlip`] for the first span or pulley concerned.
pub fn steady_creep(drive: &Drive, steady: &SteadyState) -> Result<Creep, CreepError> {
    let (tensions, effective, wraps) = (&steady.tensions, &steady.effective_tensions, &steady.layout.wraps);
    if let Some(span) = effective
        .iter()
        .position(|tension| tension.is_nan() || *tension <= 0.0)
    {
        return Err(CreepError::Slack {
            span: drive.span_name(span),
            effective_tension: effective[span],
        });
    }
    let stiffness = drive.belt.axial_stiffness;
    let stretch = |span: usize| 1.0 + tensions[span] / stiffness;
    let last = drive.span_before(drive.driver);
    let entry_of_driver = stretch(last);
    let unstretched_speed = steady.belt_speed / entry_of_driver;
    let mut pulleys = Vec::with_capacity(drive.pulleys.len());
    for (j, pulley) in drive.pulleys.iter().enumerate() {
        let before = drive.span_before(j);
        let contact = contact_of(wraps[j], pulley.friction, effective[before], effective[j]);
        if contact.safety < 1.0 {
            return Err(CreepError::GrossSlip {
                pulley: pulley.name.clone(),
                slip_arc: contact.slip_arc,
                wrap: wraps[j],
            });
        }
        let rise = tensions[j] - tensions[before];
        // The difference of the stretches, so that a loss of 1e-3 keeps its digits.
        let speed_loss = (tensions[last] - tensions[before]) / stiffness / entry_of_driver;
        pulleys.push(PulleyCreep {
            contact,
            surface_speed_ratio: stretch(before) / entry_of_driver,
            speed_loss,
            power: rise * unstretched_speed * stretch(before),
            power_lost: unstretched_speed * rise * rise / (2.0 * stiffness),
        });
    }
    let force = |j: usize| tensions[j] - tensions[drive.span_before(j)];
    let others = || (0..pulleys.len()).filter(|&j| j != drive.driver);
    let driving = -force(drive.driver);
    let taken: f64 = others().map(|j| force(j) * pulleys[j].surface_speed_ratio).sum();
    Ok(Creep {
        power_in: -pulleys[drive.driver].power,
        power_out: others().map(|j| pulleys[j].power).sum(),
        power_lost: pulleys.iter().map(|pulley| pulley.power_lost).sum(),
        efficiency: (driving != 0.0).then(|| taken / driving),
        pulleys,
    })
}
