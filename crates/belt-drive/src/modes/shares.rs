//! What moves in a mode: shares of the kinetic energy (theory 04 §4.2).

use crate::drive::Drive;
use crate::model::{Coordinate, LinearModel};
use slackside_linalg::Complex;

/// Shares of the kinetic energy; they are not negative and add up to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Shares {
    /// Pulleys and accessories, by pulley.
    pub rotation: Vec<f64>,
    /// Arms.
    pub arms: Vec<f64>,
    /// Spans.
    pub spans: Vec<f64>,
}

/// What a mode is, by the largest share, if that is more than a half.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Rotation of pulleys and accessories.
    Rotation,
    /// Motion of arms.
    Arm,
    /// Transverse motion of one span.
    Span(usize),
    /// None of them alone.
    Mixed,
}

impl Shares {
    pub(super) fn new(drive: &Drive, model: &LinearModel, shape: &[Complex]) -> Self {
        let mut rotation = vec![0.0; drive.pulleys.len()];
        let mut arms = vec![0.0; drive.tensioners.len()];
        for (index, coordinate) in model.coordinates.iter().enumerate() {
            let energy = model.lumped_inertia[index] * shape[index].norm_sqr();
            match coordinate {
                Coordinate::Pulley(j) | Coordinate::Accessory(j) => rotation[j] += energy,
                Coordinate::Arm(arm) => arms[arm] += energy,
                Coordinate::Sine { .. } => {}
            }
        }
        let spans: Vec<f64> = (0..drive.pulleys.len())
            .map(|i| span_energy(model, i, shape))
            .collect();
        let total: f64 = rotation.iter().chain(&arms).chain(&spans).sum();
        let share = |parts: Vec<f64>| parts.into_iter().map(|part| part / total).collect();
        Self {
            rotation: share(rotation),
            arms: share(arms),
            spans: share(spans),
        }
    }

    /// What a mode with these shares is.
    pub fn kind(&self) -> Kind {
        let rotation: f64 = self.rotation.iter().sum();
        let arms: f64 = self.arms.iter().sum();
        if rotation > 0.5 {
            Kind::Rotation
        } else if arms > 0.5 {
            Kind::Arm
        } else {
            self.spans
                .iter()
                .position(|share| *share > 0.5)
                .map_or(Kind::Mixed, Kind::Span)
        }
    }
}

/// `(R_iφ)ᴴ M_i (R_iφ)`.
fn span_energy(model: &LinearModel, span: usize, shape: &[Complex]) -> f64 {
    let local: Vec<Complex> = model.local[span]
        .iter()
        .map(|terms| terms.iter().map(|(index, factor)| shape[*index] * *factor).sum())
        .collect();
    let mass = &model.spans[span].mass;
    let mut energy = 0.0;
    for (a, left) in local.iter().enumerate() {
        for (b, right) in local.iter().enumerate() {
            energy += mass[(a, b)] * (left.conj() * right).re;
        }
    }
    energy.max(0.0)
}
