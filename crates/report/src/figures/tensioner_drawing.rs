//! Tensioners in the drawing of a drive: arms with pivots, slides, and their stops. Lengths are in millimetres.

use super::drive_layout::{LayoutTensioner, TensionerMount};
use crate::plot::{Color, Dash, Layer, Marker, Shape, Stroke, arc};

/// Half the drawn length of a slide without stops, about the radius of a usual pulley.
pub(super) const SLIDE: f64 = 40.0;
const ARM: Color = Color(150, 150, 150);
const STOP: Stroke = Stroke {
    color: Color::GREY,
    width: 0.6,
    dash: Dash::Dashed,
};
const SLIDE_STOP: Stroke = Stroke {
    color: Color::GREY,
    width: 0.9,
    dash: Dash::Solid,
};
/// The stroke of the stops of a tensioner that has them.
pub(super) fn stop_stroke(tensioner: &LayoutTensioner) -> Option<Stroke> {
    match tensioner.mount {
        TensionerMount::Rotary { stops, .. } => stops.map(|_| STOP),
        TensionerMount::Linear { stops, .. } => stops.map(|_| SLIDE_STOP),
    }
}

/// Arm or slide with its stops.
pub(super) fn mount(tensioner: &LayoutTensioner) -> Vec<Layer> {
    let mut layers = Vec::new();
    let rail = Stroke::solid(ARM).with_width(3.2);
    match tensioner.mount {
        TensionerMount::Rotary { pivot, stops } => {
            for center in &tensioner.centers {
                layers.push(Layer::Line {
                    points: vec![pivot, *center],
                    stroke: rail,
                });
            }
            if let (Some([from, to]), Some(center)) = (stops, tensioner.centers.first()) {
                let length = (center[0] - pivot[0]).hypot(center[1] - pivot[1]);
                let at = |angle: f64| [pivot[0] + length * angle.cos(), pivot[1] + length * angle.sin()];
                for points in [
                    vec![pivot, at(from)],
                    vec![pivot, at(to)],
                    arc(pivot, length, from, to - from),
                ] {
                    layers.push(Layer::Line { points, stroke: STOP });
                }
            }
        }
        TensionerMount::Linear { direction, stops } => {
            let length = direction[0].hypot(direction[1]);
            let unit = [direction[0] / length, direction[1] / length];
            for center in &tensioner.centers {
                let at = |s: f64, across: f64| {
                    [
                        center[0] + s * unit[0] - across * unit[1],
                        center[1] + s * unit[1] + across * unit[0],
                    ]
                };
                let [from, to] = stops.unwrap_or([-SLIDE, SLIDE]);
                layers.push(Layer::Line {
                    points: vec![at(from, 0.0), at(to, 0.0)],
                    stroke: rail,
                });
                let tick = 0.15 * (to - from).abs();
                for s in stops.into_iter().flatten() {
                    layers.push(Layer::Line {
                        points: vec![at(s, -tick), at(s, tick)],
                        stroke: SLIDE_STOP,
                    });
                }
            }
        }
    }
    layers
}

/// Symbols of the pivots.
pub(super) fn pivots(tensioners: &[LayoutTensioner]) -> Vec<Layer> {
    let points: Vec<[f64; 2]> = tensioners
        .iter()
        .filter_map(|tensioner| match tensioner.mount {
            TensionerMount::Rotary { pivot, .. } => Some(pivot),
            TensionerMount::Linear { .. } => None,
        })
        .collect();
    [(6.4, false), (2.0, true)]
        .into_iter()
        .map(|(size, filled)| Layer::Points {
            points: points.clone(),
            marker: Marker {
                shape: Shape::Circle,
                size,
                filled,
                color: Color::BLACK,
            },
        })
        .collect()
}
