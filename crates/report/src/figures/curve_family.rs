//! Curves y(x) over one parameter, for example natural frequencies against a stiffness.

use super::{Curve, FigureOptions};
use crate::plot::{Axis, Dash, Figure, Layer, LegendEntry, Panel, Stroke, curve_color};

/// Input of [`curve_family`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CurveFamily {
    /// The parameter.
    pub x: Axis,
    /// The quantity.
    pub y: Axis,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Draws curves that differ in colour and in dash pattern.
pub fn curve_family(input: &CurveFamily, options: &FigureOptions) -> Figure {
    let panel = curves_panel(input.x.clone(), input.y.clone(), &input.curves);
    options.figure(vec![vec![panel]], 60.0, 80.0)
}

/// A panel of curves with their legend.
pub(super) fn curves_panel(x: Axis, y: Axis, curves: &[Curve]) -> Panel {
    let strokes: Vec<Stroke> = (0..curves.len())
        .map(|index| Stroke::solid(curve_color(index)).with_dash(Dash::of_curve(index)))
        .collect();
    Panel {
        x,
        y,
        layers: curves
            .iter()
            .zip(&strokes)
            .map(|(curve, stroke)| Layer::Line {
                points: curve.points(),
                stroke: *stroke,
            })
            .collect(),
        legend: curves
            .iter()
            .zip(&strokes)
            .filter(|(curve, _)| !curve.name.is_empty())
            .map(|(curve, stroke)| LegendEntry::line(&curve.name, *stroke))
            .collect(),
        ..Panel::default()
    }
}
