//! Rates of the geometry in the arm positions (theory 04 §1.3).

use super::Layout;
use crate::drive::{Drive, Mount};
use glam::DVec2;

/// How centres, spans and wraps move with the arms. Indices `[span or pulley][tensioner]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Kinematics {
    /// `C'_{jτ} = ∂C_j/∂q_τ`.
    pub centre_rates: Vec<Vec<DVec2>>,
    /// `C''_{jτ}`.
    pub centre_curvatures: Vec<Vec<DVec2>>,
    /// Motions of the ends of every span.
    pub spans: Vec<Vec<SpanRates>>,
    /// `∂φ_j/∂q_τ`.
    pub wrap_rates: Vec<Vec<f64>>,
    /// `∂L_b/∂q_τ`, the take-up of every tensioner (theory 04 (1.3)).
    pub take_up: Vec<f64>,
}

/// Rates of a span in one arm position (theory 04 (1.2)).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpanRates {
    /// Motion of the start along the span, `a⁰`.
    pub along_start: f64,
    /// Motion of the end along the span, `a^L`.
    pub along_end: f64,
    /// Motion of the start across the span, `b⁰`.
    pub across_start: f64,
    /// Motion of the end across the span, `b^L`.
    pub across_end: f64,
    /// Rate of the direction, `∂ψ_i/∂q`.
    pub angle: f64,
    /// Rate of the length, `∂L_i/∂q`.
    pub length: f64,
}

impl SpanRates {
    /// `Δa = a^L − a⁰`.
    pub fn along(&self) -> f64 {
        self.along_end - self.along_start
    }

    /// `Δb = b^L − b⁰`.
    pub fn across(&self) -> f64 {
        self.across_end - self.across_start
    }
}

impl Kinematics {
    /// Rates with the arms at `positions`.
    pub fn new(drive: &Drive, layout: &Layout, positions: &[f64]) -> Self {
        let arms = drive.tensioners.len();
        let rate = |j: usize, arm: usize, derivative: usize| match drive.pulleys[j].mount {
            Mount::Carried { tensioner, place } if tensioner == arm => {
                drive.tensioners[arm].guide.centre(place, positions[arm])[derivative]
            }
            _ => DVec2::ZERO,
        };
        let table = |derivative: usize| -> Vec<Vec<DVec2>> {
            (0..drive.pulleys.len())
                .map(|j| (0..arms).map(|arm| rate(j, arm, derivative)).collect())
                .collect()
        };
        let (centre_rates, centre_curvatures) = (table(1), table(2));
        let span_rates = |i: usize, arm: usize| {
            let span = &layout.spans[i];
            let (start, end) = (centre_rates[i][arm], centre_rates[drive.next(i)][arm]);
            let mut rates = SpanRates {
                along_start: span.direction.dot(start),
                along_end: span.direction.dot(end),
                across_start: span.normal.dot(start),
                across_end: span.normal.dot(end),
                ..SpanRates::default()
            };
            rates.angle = rates.across() / span.length;
            rates.length = rates.along() + span.offset * rates.angle;
            rates
        };
        let spans: Vec<Vec<SpanRates>> = (0..layout.spans.len())
            .map(|i| (0..arms).map(|arm| span_rates(i, arm)).collect())
            .collect();
        let wrap_rates = (0..drive.pulleys.len())
            .map(|j| {
                let before = drive.span_before(j);
                (0..arms)
                    .map(|arm| {
                        drive.pulleys[j].sense.sign() * (spans[j][arm].angle - spans[before][arm].angle)
                    })
                    .collect()
            })
            .collect();
        let take_up = (0..arms)
            .map(|arm| spans.iter().map(|span| span[arm].along()).sum())
            .collect();
        Self {
            centre_rates,
            centre_curvatures,
            spans,
            wrap_rates,
            take_up,
        }
    }
}
