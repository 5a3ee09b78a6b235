//! Geometry of the belt's path: tangents, spans, wraps, lengths, and their rates in the arm positions (theory 04 §1).

mod check;
mod error;
mod kinematics;

pub use check::infer_rotation;
pub use error::LayoutError;
pub use kinematics::{Kinematics, SpanRates};

use crate::drive::{Drive, Mount};
use glam::DVec2;
use std::f64::consts::TAU;

/// The belt's path with every arm at a given position.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Centres of the pulleys, m.
    pub centres: Vec<DVec2>,
    /// The spans; span `i` leaves pulley `i`.
    pub spans: Vec<SpanGeometry>,
    /// Wrap angle `φ_j` of every pulley, rad, in `[0, 2π)`.
    pub wraps: Vec<f64>,
    /// Belt length along the pitch line, `L_b = Σ L_i + Σ r_j φ_j`, m.
    pub pitch_length: f64,
}

/// One span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpanGeometry {
    /// Length `L_i` between the tangent points, m.
    pub length: f64,
    /// Unit vector `e_i` in the direction of travel.
    pub direction: DVec2,
    /// Left normal `n_i`.
    pub normal: DVec2,
    /// Angle of the direction, `ψ_i`, rad.
    pub angle: f64,
    /// `δ_i = σ_{i+1} r_{i+1} − σ_i r_i`, m.
    pub offset: f64,
    /// Where the belt leaves pulley `i`.
    pub start: DVec2,
    /// Where it meets pulley `i + 1`.
    pub end: DVec2,
}

impl Layout {
    /// The path with the arms at `positions` (theory 04 (1.1)). It need not be a possible one: see [`Layout::check`].
    ///
    /// # Errors
    /// [`LayoutError::NoTangent`].
    pub fn new(drive: &Drive, positions: &[f64]) -> Result<Self, LayoutError> {
        let centres = centres(drive, positions);
        let spans = (0..centres.len())
            .map(|i| span(drive, &centres, i))
            .collect::<Result<Vec<_>, _>>()?;
        let wraps: Vec<f64> = (0..centres.len())
            .map(|j| {
                let turn = spans[j].angle - spans[drive.span_before(j)].angle;
                let wrap = (drive.pulleys[j].sense.sign() * turn).rem_euclid(TAU);
                // The remainder of a tiny negative angle rounds to a full turn.
                if wrap >= TAU { 0.0 } else { wrap }
            })
            .collect();
        let free: f64 = spans.iter().map(|span| span.length).sum();
        let arcs: f64 = drive
            .pulleys
            .iter()
            .zip(&wraps)
            .map(|(pulley, wrap)| pulley.radius * wrap)
            .sum();
        Ok(Self {
            pitch_length: free + arcs,
            centres,
            spans,
            wraps,
        })
    }
}

fn centres(drive: &Drive, positions: &[f64]) -> Vec<DVec2> {
    drive
        .pulleys
        .iter()
        .map(|pulley| match pulley.mount {
            Mount::Fixed(centre) => centre,
            Mount::Carried { tensioner, place } => drive.tensioners[tensioner]
                .guide
                .centre(place, positions[tensioner])[0],
        })
        .collect()
}

fn span(drive: &Drive, centres: &[DVec2], i: usize) -> Result<SpanGeometry, LayoutError> {
    let j = drive.next(i);
    let signed_radius = |k: usize| drive.pulleys[k].sense.sign() * drive.pulleys[k].radius;
    let offset = signed_radius(j) - signed_radius(i);
    let distance = centres[j] - centres[i];
    let squared = distance.length_squared();
    let length_squared = squared - offset * offset;
    if length_squared.is_nan() || length_squared <= 0.0 {
        return Err(LayoutError::NoTangent {
            from: drive.pulleys[i].name.clone(),
            to: drive.pulleys[j].name.clone(),
            distance: squared.sqrt(),
            needed: offset.abs(),
        });
    }
    let length = length_squared.sqrt();
    let direction = (length * distance - offset * distance.perp()) / squared;
    let normal = direction.perp();
    Ok(SpanGeometry {
        length,
        direction,
        normal,
        angle: direction.to_angle(),
        offset,
        start: centres[i] - signed_radius(i) * normal,
        end: centres[j] - signed_radius(j) * normal,
    })
}
