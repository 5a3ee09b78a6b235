//! Rows of modes and resonances.

use super::document::{DriveModeRow, ResonanceRow};
use crate::drive::RPM;
use crate::{Ratios, pair};
use slackside_belt_drive::drive::Drive;
use slackside_belt_drive::model::{LinearModel, Motion};
use slackside_belt_drive::modes::{Campbell, Kind, Mode};
use slackside_belt_drive::steady::SteadyState;
use slackside_linalg::Complex;
use std::f64::consts::TAU;

/// Points along a span at which shapes are given.
const SHAPE_POINTS: usize = 33;

/// Where the lines of orders meet the curves of a Campbell diagram, ascending in speed.
pub(super) fn resonances(
    drive: &Drive,
    campbell: &Campbell,
    orders: impl Iterator<Item = f64>,
) -> Vec<ResonanceRow> {
    let curves = campbell
        .points
        .iter()
        .map(|point| point.modes.len())
        .min()
        .unwrap_or(0);
    let mut rows = Vec::new();
    for order in orders {
        for curve in 0..curves {
            for speed in campbell.crossings(curve, order) {
                let nearest = campbell.points.iter().min_by(|a, b| {
                    (a.driver_speed - speed)
                        .abs()
                        .total_cmp(&(b.driver_speed - speed).abs())
                });
                let kind = nearest.map_or(Kind::Mixed, |point| point.modes[curve].kind);
                rows.push(ResonanceRow {
                    order,
                    mode: curve + 1,
                    speed: speed / RPM,
                    frequency_hz: order * speed / TAU,
                    kind: kind_name(drive, kind),
                });
            }
        }
    }
    rows.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    rows
}

/// The damping ratio of the damped mode that resembles an undamped one most: the nearest in frequency.
pub(super) fn damping_ratio(damped: &[Mode], mode: &Mode) -> f64 {
    damped
        .iter()
        .filter(|candidate| candidate.damping_ratio < 1.0)
        .min_by(|a, b| {
            (a.frequency - mode.frequency)
                .abs()
                .total_cmp(&(b.frequency - mode.frequency).abs())
        })
        .map_or(0.0, |nearest| {
            // Without damping the general eigenvalue problem leaves rounding.
            if nearest.damping_ratio.abs() < 1e-11 {
                0.0
            } else {
                nearest.damping_ratio
            }
        })
}

/// `rotation`, `arm`, `span <name>` or `mixed`.
pub(super) fn kind_name(drive: &Drive, kind: Kind) -> String {
    match kind {
        Kind::Rotation => "rotation".to_owned(),
        Kind::Arm => "arm".to_owned(),
        Kind::Span(span) => format!("span {}", drive.span_name(span)),
        Kind::Mixed => "mixed".to_owned(),
    }
}

pub(super) fn mode_row(
    drive: &Drive,
    state: &SteadyState,
    model: &LinearModel,
    mode: &Mode,
    damping_ratio: f64,
) -> DriveModeRow {
    let motion = Motion {
        frequency: mode.frequency,
        amplitudes: mode.shape.clone(),
    };
    let points = |span: usize| {
        let length = state.layout.spans[span].length;
        let shape = model.span_motion(state, &motion, span);
        (0..SHAPE_POINTS)
            .map(|k| shape.at(length * k as f64 / (SHAPE_POINTS - 1) as f64))
            .collect::<Vec<_>>()
    };
    let spans: Vec<_> = (0..drive.pulleys.len()).map(points).collect();
    // Rotations count by the motion of the rim, arms by that of their pulley's centre.
    let rim = (0..drive.pulleys.len()).map(|j| mode.shape[j] * drive.pulleys[j].radius);
    let centre = (0..drive.tensioners.len()).map(|arm| {
        let reach = drive
            .carried_by(arm)
            .map(|j| state.kinematics.centre_rates[j][arm].length())
            .fold(0.0, f64::max);
        mode.shape[model.coordinates.arm(arm)] * reach
    });
    let largest = rim
        .chain(centre)
        .chain(spans.iter().flatten().copied())
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))
        .filter(|value| value.norm() > 0.0)
        .unwrap_or_else(|| Complex::new(1.0, 0.0));
    let relative = |value: &Complex| pair(&(value / largest));
    let mut shares: Vec<(String, f64)> = Vec::new();
    for (pulley, share) in drive.pulleys.iter().zip(&mode.shares.rotation) {
        shares.push((format!("rotation.{}", pulley.name), *share));
    }
    for (tensioner, share) in drive.tensioners.iter().zip(&mode.shares.arms) {
        shares.push((format!("arm.{}", tensioner.name), *share));
    }
    for (span, share) in mode.shares.spans.iter().enumerate() {
        shares.push((format!("span.{}", drive.span_name(span)), *share));
    }
    DriveModeRow {
        frequency_hz: mode.frequency / TAU,
        strong_form_hz: None,
        damping_ratio,
        kind: kind_name(drive, mode.kind),
        shares: Ratios(shares),
        rotations: (0..drive.pulleys.len())
            .map(|j| relative(&mode.shape[j]))
            .collect(),
        arms: (0..drive.tensioners.len())
            .map(|arm| relative(&mode.shape[model.coordinates.arm(arm)]))
            .collect(),
        spans: spans
            .iter()
            .map(|points| points.iter().map(relative).collect())
            .collect(),
    }
}
