//! Whether a belt can follow a layout (theory 04 §1.5).

use super::{Layout, LayoutError, SpanGeometry};
use crate::drive::{Drive, Sense};
use glam::DVec2;
use std::f64::consts::TAU;

/// A wrap above this is a slightly negative one, taken modulo a full turn: the belt misses the pulley.
const LARGEST_WRAP: f64 = 330.0 / 360.0 * TAU;

impl Layout {
    /// Whether a belt can follow this path.
    ///
    /// # Errors
    /// The first of: pulleys that overlap, a pulley that is not touched, a path that is not a simple loop, a span that
    /// runs through a pulley, spans that cross.
    pub fn check(&self, drive: &Drive) -> Result<(), LayoutError> {
        self.check_overlap(drive)?;
        let turning = self.turning(drive);
        let is_simple = (turning.abs() - TAU).abs() < 1e-6;
        if is_simple || self.would_be_simple_without_misses(drive, turning) {
            self.check_touched(drive)?;
        }
        if !is_simple {
            return Err(self.not_simple(drive, turning));
        }
        self.check_clearance(drive)?;
        self.check_crossing(drive)
    }

    /// Total turning `Σ σ_j φ_j`, rad.
    pub fn turning(&self, drive: &Drive) -> f64 {
        drive
            .pulleys
            .iter()
            .zip(&self.wraps)
            .map(|(pulley, wrap)| pulley.sense.sign() * wrap)
            .sum()
    }

    fn check_overlap(&self, drive: &Drive) -> Result<(), LayoutError> {
        for (j, first) in drive.pulleys.iter().enumerate() {
            for (k, second) in drive.pulleys.iter().enumerate().skip(j + 1) {
                let distance = self.centres[j].distance(self.centres[k]);
                let radii = first.radius + second.radius;
                if distance <= radii {
                    return Err(LayoutError::Overlap {
                        first: first.name.clone(),
                        second: second.name.clone(),
                        distance,
                        radii,
                    });
                }
            }
        }
        Ok(())
    }

    /// Whether the loop would be simple if every nearly full wrap were the slightly negative one that it stands for.
    fn would_be_simple_without_misses(&self, drive: &Drive, turning: f64) -> bool {
        let missed: f64 = drive
            .pulleys
            .iter()
            .zip(&self.wraps)
            .filter(|(_, wrap)| **wrap > LARGEST_WRAP)
            .map(|(pulley, _)| pulley.sense.sign() * TAU)
            .sum();
        ((turning - missed).abs() - TAU).abs() < 1e-6
    }

    fn check_touched(&self, drive: &Drive) -> Result<(), LayoutError> {
        match self.wraps.iter().position(|wrap| *wrap > LARGEST_WRAP) {
            None => Ok(()),
            Some(j) => Err(LayoutError::NotTouched {
                pulley: drive.pulleys[j].name.clone(),
                before: drive.pulleys[drive.span_before(j)].name.clone(),
                after: drive.pulleys[drive.next(j)].name.clone(),
            }),
        }
    }

    fn not_simple(&self, drive: &Drive, turning: f64) -> LayoutError {
        let mut by_wrap: Vec<usize> = (0..self.wraps.len()).collect();
        by_wrap.sort_by(|a, b| self.wraps[*b].total_cmp(&self.wraps[*a]));
        LayoutError::Turning {
            turning,
            expected: TAU * self.orientation(),
            suspects: by_wrap
                .into_iter()
                .take(3)
                .map(|j| format!("\"{}\"", drive.pulleys[j].name))
                .collect(),
        }
    }

    /// Sign of the area that the polygon of the centres encloses: +1 for a path that runs counter-clockwise.
    fn orientation(&self) -> f64 {
        let count = self.centres.len();
        let area: f64 = (0..count)
            .map(|j| self.centres[j].perp_dot(self.centres[(j + 1) % count]))
            .sum();
        if area < 0.0 { -1.0 } else { 1.0 }
    }

    fn check_clearance(&self, drive: &Drive) -> Result<(), LayoutError> {
        for (i, span) in self.spans.iter().enumerate() {
            for (k, pulley) in drive.pulleys.iter().enumerate() {
                if k == i || k == drive.next(i) {
                    continue;
                }
                let distance = distance_to_span(span, self.centres[k]);
                if distance < pulley.radius {
                    return Err(LayoutError::SpanHitsPulley {
                        span: drive.span_name(i),
                        pulley: pulley.name.clone(),
                        distance,
                        radius: pulley.radius,
                    });
                }
            }
        }
        Ok(())
    }

    fn check_crossing(&self, drive: &Drive) -> Result<(), LayoutError> {
        for (i, first) in self.spans.iter().enumerate() {
            for (k, second) in self.spans.iter().enumerate().skip(i + 1) {
                if cross(first, second) {
                    return Err(LayoutError::SpansCross {
                        first: drive.span_name(i),
                        second: drive.span_name(k),
                    });
                }
            }
        }
        Ok(())
    }
}

fn distance_to_span(span: &SpanGeometry, point: DVec2) -> f64 {
    let along = span.direction.dot(point - span.start).clamp(0.0, span.length);
    point.distance(span.start + along * span.direction)
}

fn cross(first: &SpanGeometry, second: &SpanGeometry) -> bool {
    let sides = |span: &SpanGeometry, other: &SpanGeometry| {
        span.normal.dot(other.start - span.start) * span.normal.dot(other.end - span.start) < 0.0
    };
    sides(first, second) && sides(second, first)
}

/// The sense of the driver with which the belt runs in a simple loop when the pulleys are met in the order in which they
/// are listed, either as the drive has it or with all senses reversed.
///
/// # Errors
/// [`LayoutError`] if neither is possible: what is wrong in the sense in which the centres follow one another.
pub fn infer_rotation(drive: &Drive) -> Result<Sense, LayoutError> {
    let reversed = drive.reversed();
    let positions = drive.reference_positions();
    let examine = |drive: &Drive| Layout::new(drive, &positions).and_then(|layout| layout.check(drive));
    let sense = drive.pulleys[drive.driver].sense;
    let as_given = examine(drive);
    if as_given.is_ok() {
        return Ok(sense);
    }
    let other = examine(&reversed);
    if other.is_ok() {
        return Ok(sense.reversed());
    }
    let centres = super::centres(drive, &positions);
    let area: f64 = (0..centres.len())
        .map(|j| centres[j].perp_dot(centres[drive.next(j)]))
        .sum();
    let inside: f64 = drive.pulleys.iter().map(|pulley| pulley.sense.sign()).sum();
    if area * inside < 0.0 { other } else { as_given }?;
    Ok(sense)
}
