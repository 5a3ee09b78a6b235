//! The same measures for several designs on the same axes, for example a rigid pulley, a one-way clutch, a decoupler
//! and an isolator.

use super::curve_family::curves_panel;
use super::{Curve, FigureOptions, shared_legend};
use crate::plot::{Axis, Figure, Panel, Width};

/// Input of [`comparison`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Comparison {
    /// The parameter, for example the engine speed.
    pub x: Axis,
    /// The measures, a panel each.
    pub measures: Vec<ComparedMeasure>,
}

/// A measure of all designs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ComparedMeasure {
    /// What stands over the panel; may be empty.
    pub heading: String,
    /// The measure.
    pub y: Axis,
    /// A curve for each design, named after it. Designs look alike in all panels if they come in the same order.
    pub curves: Vec<Curve>,
}

/// Draws a panel for each measure with one legend for all: below each other in one column, two abreast in two.
pub fn comparison(input: &Comparison, options: &FigureOptions) -> Figure {
    let columns = match (options.width, input.measures.len()) {
        (Width::Double, 2..) => 2,
        _ => 1,
    };
    let mut panels: Vec<Panel> = input
        .measures
        .iter()
        .map(|measure| Panel {
            heading: (!measure.heading.is_empty()).then(|| measure.heading.clone()),
            ..curves_panel(input.x.clone(), measure.y.clone(), &measure.curves)
        })
        .collect();
    let legend = shared_legend(panels.iter_mut());
    let rows: Vec<Vec<Panel>> = panels.chunks(columns).map(<[Panel]>::to_vec).collect();
    let count = rows.len().max(1) as f64;
    let mut figure = options.figure(rows, 24.0 + 40.0 * count, 24.0 + 52.0 * count);
    figure.share_x = true;
    figure.legend = legend;
    figure
}
