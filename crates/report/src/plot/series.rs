//! The data of a panel, in layers that are drawn in their order.

use super::color::Color;
use super::style::{Marker, Stroke};

/// One layer of data. Points with a coordinate that is not finite are skipped and interrupt lines.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A polyline.
    Line {
        /// Vertices `[x, y]`.
        points: Vec<[f64; 2]>,
        /// Its stroke.
        stroke: Stroke,
    },
    /// A polyline that hides what was drawn before between it and its base line, as in a waterfall diagram.
    CoveringLine {
        /// Vertices `[x, y]`.
        points: Vec<[f64; 2]>,
        /// The y down to which it covers.
        base: f64,
        /// Its stroke.
        stroke: Stroke,
    },
    /// A polyline with a head at its end.
    Arrow {
        /// Vertices `[x, y]`, the tip last.
        points: Vec<[f64; 2]>,
        /// The stroke of its shaft; the head has the same colour.
        stroke: Stroke,
        /// Length of the head, points; at most the length of the arrow.
        head: f64,
    },
    /// Filled areas.
    Area {
        /// Outline `[x, y]`, closed of itself; a vertex that is not finite separates two areas.
        points: Vec<[f64; 2]>,
        /// Their colour.
        color: Color,
    },
    /// Upright lines from a base to each point.
    Stems {
        /// Tips `[x, y]`.
        points: Vec<[f64; 2]>,
        /// The y they start from; the lower edge of the panel when the axis cannot show it.
        base: f64,
        /// Their stroke.
        stroke: Stroke,
    },
    /// Separate points.
    Points {
        /// Positions `[x, y]`.
        points: Vec<[f64; 2]>,
        /// Their symbol.
        marker: Marker,
    },
    /// Shaded intervals of x over the whole height.
    Bands {
        /// Intervals `[from, to]`.
        intervals: Vec<[f64; 2]>,
        /// Their colour.
        color: Color,
    },
    /// Upright lines over the whole height.
    Uprights {
        /// Their positions.
        x: Vec<f64>,
        /// Their stroke.
        stroke: Stroke,
    },
    /// Filled rectangles.
    Strips(Vec<Strip>),
    /// Coloured cells on a regular grid, stored as one image.
    HeatMap(HeatMap),
    /// The outline of a rectangle.
    Outline {
        /// Interval of x.
        x: [f64; 2],
        /// Interval of y.
        y: [f64; 2],
        /// Its stroke.
        stroke: Stroke,
    },
}

/// A filled rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strip {
    /// Interval of x.
    pub x: [f64; 2],
    /// Interval of y.
    pub y: [f64; 2],
    /// Its colour.
    pub color: Color,
}

/// A grid of coloured cells; both axes must be linear.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// Outer edges in x.
    pub x: [f64; 2],
    /// Outer edges in y.
    pub y: [f64; 2],
    /// Number of cells in x.
    pub columns: usize,
    /// Colours by row from the lower y edge, each row from the lower x edge; white where there is no value.
    pub cells: Vec<Color>,
}

impl Layer {
    /// Calls `visit` with every `[x, y]` that automatic limits must contain; NaN for no demand.
    pub(super) fn extent(&self, visit: &mut dyn FnMut(f64, f64)) {
        match self {
            Layer::Line { points, .. }
            | Layer::Arrow { points, .. }
            | Layer::Area { points, .. }
            | Layer::Points { points, .. } => {
                points
                    .iter()
                    .filter(|p| p[0].is_finite() && p[1].is_finite())
                    .for_each(|p| visit(p[0], p[1]));
            }
            Layer::CoveringLine { points, base, .. } | Layer::Stems { points, base, .. } => {
                points
                    .iter()
                    .filter(|p| p[0].is_finite() && p[1].is_finite())
                    .for_each(|p| visit(p[0], p[1]));
                visit(f64::NAN, *base);
            }
            // Marks that follow the data instead of setting the limits.
            Layer::Bands { .. } | Layer::Uprights { .. } | Layer::Outline { .. } => {}
            Layer::Strips(strips) => {
                for strip in strips {
                    visit(strip.x[0], strip.y[0]);
                    visit(strip.x[1], strip.y[1]);
                }
            }
            Layer::HeatMap(HeatMap { x, y, .. }) => {
                visit(x[0], y[0]);
                visit(x[1], y[1]);
            }
        }
    }

    /// Whether the layer consists of points alone, which need room on all sides.
    pub(super) fn is_points(&self) -> bool {
        matches!(self, Layer::Points { .. } | Layer::Stems { .. })
    }

    /// Whether the layer covers areas, which reach to the edges of the panel.
    pub(super) fn is_area(&self) -> bool {
        matches!(self, Layer::Strips(_) | Layer::HeatMap(_))
    }
}
