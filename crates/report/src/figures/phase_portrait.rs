//! Phase portrait: orbits in a plane of the state, with their Poincaré points.

use super::{Curve, FigureOptions, PointSet};
use crate::plot::{Axis, Color, Figure, Layer, LegendEntry, Marker, Shape, curve_color};

use super::curve_family::curves_panel;

/// Input of [`phase_portrait`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PhasePortrait {
    /// Displacement.
    pub x: Axis,
    /// Velocity.
    pub y: Axis,
    /// The orbits; one is black and solid, more differ in colour and dash pattern.
    pub orbits: Vec<Curve>,
    /// Points of stroboscopic sections; set number i has the colour of orbit number i.
    pub poincare: Vec<PointSet>,
}

/// Draws a phase portrait.
pub fn phase_portrait(input: &PhasePortrait, options: &FigureOptions) -> Figure {
    const SHAPES: [Shape; 4] = [Shape::Circle, Shape::Square, Shape::Diamond, Shape::TriangleUp];
    let mut panel = curves_panel(input.x.clone(), input.y.clone(), &input.orbits);
    // A closed orbit must not touch the frame, so the x axis takes the margin of point sets.
    panel.x.limits = panel.x.limits.or_else(|| {
        let xs = || {
            let orbits = input.orbits.iter().flat_map(|orbit| orbit.x.iter().copied());
            let points = input
                .poincare
                .iter()
                .flat_map(|set| set.points.iter().map(|point| point[0]));
            orbits.chain(points).filter(|x| x.is_finite())
        };
        let (low, high) = (
            xs().fold(f64::INFINITY, f64::min),
            xs().fold(f64::NEG_INFINITY, f64::max),
        );
        let margin = 0.06 * (high - low);
        (margin > 0.0).then_some((low - margin, high + margin))
    });
    for (index, set) in input.poincare.iter().enumerate() {
        let color = if index == 0 {
            Color::VERMILLION
        } else {
            curve_color(index)
        };
        let marker = Marker::filled(SHAPES[index % SHAPES.len()], 3.4, color);
        panel.layers.push(Layer::Points {
            points: set.points.clone(),
            marker,
        });
        if !set.name.is_empty() {
            panel.legend.push(LegendEntry::marker(&set.name, marker));
        }
    }
    options.figure(vec![vec![panel]], 70.0, 90.0)
}
