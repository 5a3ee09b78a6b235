//! The description of a chart and its drawing.
//!
//! A [`Figure`] is a grid of [`Panel`]s; a panel has two [`Axis`] and [`Layer`]s of data, drawn in their
//! order. Coordinates are computed in points (1/72 inch) with two decimals. Text is measured with the bundled
//! font, so that margins fit their labels, legends avoid the data and labels never overlap. Warnings stand at the
//! foot of the page, which grows for them.
//!
//! Drawings to scale are panels with equal aspect, their circles and arcs polylines ([`arc`], [`circle`],
//! [`sector`]), their texts [`Note`]s that find free places.

mod arrow;
mod aspect;
mod axis;
mod chart;
mod color;
mod curve_label;
mod draw;
mod layout;
mod legend;
mod margins;
mod mark;
mod note;
mod note_place;
mod occupancy;
mod raster;
mod series;
mod shapes;
mod style;
mod svg;
mod text;
mod ticks;
mod warnings;

pub use axis::{Axis, Scale};
pub use chart::{ColorBar, CurveLabel, Figure, LegendEntry, LegendPlace, Panel, ScaleBar, Width};
pub use color::{Color, category_color, curve_color, sequential_color};
pub use note::{Note, NotePlace};
pub use series::{HeatMap, Layer, Strip};
pub use shapes::{arc, circle, direction, sector};
pub use style::{Dash, Marker, Shape, Stroke};
pub use svg::TextBox;
pub use ticks::{Tick, Ticks, linear as linear_ticks, logarithmic as logarithmic_ticks};
