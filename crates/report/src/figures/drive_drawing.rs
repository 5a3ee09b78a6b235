//! What the drawings of a drive have in common: discs, belt path, which side is outside.

use super::drive_layout::{DriveLayout, LayoutPulley, LayoutSpan, LayoutTensioner, TensionerMount};
use crate::plot::{Color, Layer, Stroke, arc, circle, direction};

/// Millimetres in a metre.
pub(super) const MILLIMETRES: f64 = 1000.0;
/// Fill of the driver.
pub(super) const DRIVER: Color = Color(176, 208, 235);
/// Fill of a pulley on a tensioner.
pub(super) const CARRIED: Color = Color(250, 222, 160);
/// Fill of the other pulleys.
pub(super) const PLAIN: Color = Color(236, 236, 236);

/// The fill of a pulley by its role.
fn fill(pulley: &LayoutPulley) -> Color {
    if pulley.carried {
        CARRIED
    } else if pulley.driver {
        DRIVER
    } else {
        PLAIN
    }
}

/// The discs of pulleys with their rims.
pub(super) fn discs(pulleys: &[LayoutPulley]) -> Vec<Layer> {
    pulleys
        .iter()
        .flat_map(|pulley| {
            let rim = circle(pulley.center, pulley.radius);
            [
                Layer::Area {
                    points: rim.clone(),
                    color: fill(pulley),
                },
                Layer::Line {
                    points: rim,
                    stroke: Stroke::solid(Color::GREY).with_width(0.6),
                },
            ]
        })
        .collect()
}

/// The belt: its spans and its arcs around the pulleys.
pub(super) fn belt(input: &DriveLayout, stroke: Stroke) -> Vec<Layer> {
    let spans = input.spans.iter().map(|span| vec![span.start, span.end]);
    spans
        .chain(input.pulleys.iter().map(wrapped))
        .map(|points| Layer::Line { points, stroke })
        .collect()
}

/// The arc of the belt on a pulley.
pub(super) fn wrapped(pulley: &LayoutPulley) -> Vec<[f64; 2]> {
    let mut points = arc(
        pulley.center,
        pulley.radius,
        direction(pulley.center, pulley.tangent_in),
        pulley.sense.signum() * pulley.wrap,
    );
    // The arc ends where the span begins, also when the wrap is given with few digits.
    points.push(pulley.tangent_out);
    points
}

/// +1 if the belt runs around the drive counter-clockwise, −1 clockwise: the sign of its total turning.
fn circulation(pulleys: &[LayoutPulley]) -> f64 {
    let turning: f64 = pulleys.iter().map(|pulley| pulley.sense * pulley.wrap).sum();
    if turning < 0.0 { -1.0 } else { 1.0 }
}

/// The direction from a pulley away from the inside of the belt loop.
pub(super) fn outside(pulley: &LayoutPulley, pulleys: &[LayoutPulley]) -> [f64; 2] {
    let middle = direction(pulley.center, pulley.tangent_in) + pulley.sense.signum() * pulley.wrap / 2.0;
    // A pulley on the back of the belt stands outside the loop, its arc toward the inside.
    let side = pulley.sense.signum() * circulation(pulleys);
    [side * middle.cos(), side * middle.sin()]
}

/// The direction from a span away from the inside of the belt loop.
pub(super) fn span_outside(span: &LayoutSpan, pulleys: &[LayoutPulley]) -> [f64; 2] {
    let (dx, dy) = (span.end[0] - span.start[0], span.end[1] - span.start[1]);
    let side = circulation(pulleys);
    [side * dy, -side * dx]
}

/// The input with all lengths in millimetres.
pub(super) fn to_millimetres(input: &DriveLayout) -> DriveLayout {
    DriveLayout {
        pulleys: input
            .pulleys
            .iter()
            .map(|pulley| LayoutPulley {
                center: in_millimetres(pulley.center),
                radius: MILLIMETRES * pulley.radius,
                tangent_in: in_millimetres(pulley.tangent_in),
                tangent_out: in_millimetres(pulley.tangent_out),
                ..pulley.clone()
            })
            .collect(),
        spans: input
            .spans
            .iter()
            .map(|span| LayoutSpan {
                start: in_millimetres(span.start),
                end: in_millimetres(span.end),
                ..span.clone()
            })
            .collect(),
        tensioners: input
            .tensioners
            .iter()
            .map(|tensioner| LayoutTensioner {
                mount: match tensioner.mount {
                    TensionerMount::Rotary { pivot, stops } => TensionerMount::Rotary {
                        pivot: in_millimetres(pivot),
                        stops,
                    },
                    TensionerMount::Linear { direction, stops } => TensionerMount::Linear {
                        direction,
                        stops: stops.map(in_millimetres),
                    },
                },
                centers: tensioner.centers.iter().copied().map(in_millimetres).collect(),
                ..tensioner.clone()
            })
            .collect(),
    }
}

/// Two lengths from metres to millimetres.
pub(super) fn in_millimetres(lengths: [f64; 2]) -> [f64; 2] {
    lengths.map(|length| MILLIMETRES * length)
}

/// The intervals of x and y that pulleys, spans and pivots take; a unit square around nothing.
pub(super) fn box_of(input: &DriveLayout) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    let mut visit = |point: [f64; 2], radius: f64| {
        if point.iter().all(|c| c.is_finite()) && radius.is_finite() {
            for (interval, c) in bounds.iter_mut().zip(point) {
                *interval = [
                    interval[0].min(c - radius.abs()),
                    interval[1].max(c + radius.abs()),
                ];
            }
        }
    };
    for pulley in &input.pulleys {
        visit(pulley.center, pulley.radius);
    }
    for span in &input.spans {
        visit(span.start, 0.0);
        visit(span.end, 0.0);
    }
    for tensioner in &input.tensioners {
        if let TensionerMount::Rotary { pivot, .. } = tensioner.mount {
            visit(pivot, 0.0);
        }
    }
    bounds.map(|[low, high]| {
        let span = high - low;
        if span.is_finite() && span > 0.0 {
            [low, high]
        } else if low.is_finite() && low == high {
            [low - 0.5, high + 0.5]
        } else {
            [0.0, 1.0]
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Two equal pulleys with an open belt, counter-clockwise; the belt leaves the left one at its bottom.
    fn pair() -> DriveLayout {
        let pulley = |x: f64, tangent_in: f64| LayoutPulley {
            center: [x, 0.0],
            radius: 0.1,
            sense: 1.0,
            tangent_in: [x, tangent_in],
            tangent_out: [x, -tangent_in],
            wrap: PI,
            ..LayoutPulley::default()
        };
        DriveLayout {
            pulleys: vec![pulley(0.0, 0.1), pulley(0.5, -0.1)],
            spans: vec![LayoutSpan {
                start: [0.0, -0.1],
                end: [0.5, -0.1],
                ..LayoutSpan::default()
            }],
            ..DriveLayout::default()
        }
    }

    #[test]
    fn the_belt_runs_around_the_far_sides() {
        let input = pair();
        let left = wrapped(&input.pulleys[0]);
        assert!(left.iter().all(|point| point[0] < 1e-9), "{left:?}");
        let right = wrapped(&input.pulleys[1]);
        assert!(right.iter().all(|point| point[0] > 0.5 - 1e-9), "{right:?}");
    }

    #[test]
    fn outside_is_away_from_the_loop() {
        let input = pair();
        assert!(outside(&input.pulleys[0], &input.pulleys)[0] < -0.99);
        assert!(outside(&input.pulleys[1], &input.pulleys)[0] > 0.99);
        assert!(span_outside(&input.spans[0], &input.pulleys)[1] < 0.0);
    }

    #[test]
    fn lengths_become_millimetres() {
        let bounds = box_of(&to_millimetres(&pair()));
        assert_eq!(bounds, [[-100.0, 600.0], [-100.0, 100.0]]);
        assert_eq!(box_of(&DriveLayout::default()), [[0.0, 1.0], [0.0, 1.0]]);
    }
}
