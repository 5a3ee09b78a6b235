//! Poincaré map: section points of motions in a plane of the state, or of settled motions over a parameter.

use super::{FigureOptions, PointSet};
use crate::plot::{Axis, Figure, Layer, LegendEntry, Marker, Panel, Shape, curve_color};

/// Input of [`poincare_map`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PoincareMap {
    /// First coordinate, or the parameter.
    pub x: Axis,
    /// Second coordinate.
    pub y: Axis,
    /// The points, in sets that differ in colour and symbol.
    pub sets: Vec<PointSet>,
}

/// Draws section points. The more there are, the smaller are their symbols.
pub fn poincare_map(input: &PoincareMap, options: &FigureOptions) -> Figure {
    const SHAPES: [Shape; 5] = [
        Shape::Circle,
        Shape::Square,
        Shape::TriangleUp,
        Shape::Diamond,
        Shape::TriangleDown,
    ];
    let mut panel = Panel {
        x: input.x.clone(),
        y: input.y.clone(),
        ..Panel::default()
    };
    for (index, set) in input.sets.iter().enumerate() {
        let shape = SHAPES[index % SHAPES.len()];
        let color = curve_color(index);
        let size = match set.points.len() {
            0..=40 => 2.6,
            41..=400 => 1.5,
            _ => 0.8,
        };
        let marker = Marker::filled(shape, size, color);
        panel.layers.push(Layer::Points {
            points: set.points.clone(),
            marker,
        });
        if !set.name.is_empty() {
            panel
                .legend
                .push(LegendEntry::marker(&set.name, Marker { size: 2.6, ..marker }));
        }
    }
    options.figure(vec![vec![panel]], 70.0, 90.0)
}
