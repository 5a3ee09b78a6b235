//! Figures and panels as data.

use std::path::Path;

use super::axis::Axis;
use super::color::Color;
use super::note::Note;
use super::series::Layer;
use super::style::{Marker, Stroke};
use super::svg::{Svg, TextBox};
use super::{draw, raster};
use crate::{ReportError, write_bytes};

/// Width of a figure on paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Width {
    /// One column of a journal, 85 mm.
    #[default]
    Single,
    /// Both columns, 175 mm.
    Double,
}

impl Width {
    /// The width in millimetres.
    pub fn millimetres(self) -> f64 {
        match self {
            Width::Single => 85.0,
            Width::Double => 175.0,
        }
    }
}

/// A figure: panels in rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Width on paper.
    pub width: Width,
    /// Height on paper, millimetres; at least 25. Warnings at the foot of the page come on top of it.
    pub height: f64,
    /// Heading; papers have captions instead, so it is absent by default.
    pub title: Option<String>,
    /// What the symbols mean where that is the same in all panels; it stands above them.
    pub legend: Vec<LegendEntry>,
    /// Rows from top to bottom, each with panels from left to right.
    pub rows: Vec<Vec<Panel>>,
    /// Panels of one column share the x axis: only the lowest carries its labels.
    pub share_x: bool,
}

/// One pair of axes with data.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Data, drawn in this order.
    pub layers: Vec<Layer>,
    /// What the symbols mean.
    pub legend: Vec<LegendEntry>,
    /// Where the legend may stand.
    pub legend_place: LegendPlace,
    /// Names written beside curves where there is room.
    pub labels: Vec<CurveLabel>,
    /// Text at places of the data.
    pub notes: Vec<Note>,
    /// A line over the panel that says what it shows.
    pub heading: Option<String>,
    /// A unit is as long in y as in x; the limits of one axis are widened for it. Linear axes only.
    pub equal_aspect: bool,
    /// The data alone, without frame, ticks and axis labels.
    pub bare: bool,
    /// Scale of colours at the right.
    pub color_bar: Option<ColorBar>,
    /// Length that stands for an amplitude, at the right.
    pub scale_bar: Option<ScaleBar>,
    /// Letter that a caption refers to, for example `(a)`.
    pub letter: Option<String>,
    /// Height of the frame, points; panels without share what the others leave of the page. A row has a given
    /// height when all of its panels have one, and is as high as the highest.
    pub frame_height: Option<f64>,
    /// What must be known before the data is trusted. The warnings of all panels stand at the foot of the
    /// page, each once.
    pub warnings: Vec<String>,
}

/// Where a legend may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LegendPlace {
    /// Inside the panel where no data lies, otherwise above it.
    #[default]
    Free,
    /// Above the panel.
    Above,
}

/// A line of a legend.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LegendEntry {
    /// The text; `_{…}` and `^{…}` as in axis labels.
    pub text: String,
    /// Sample of a line.
    pub stroke: Option<Stroke>,
    /// Sample of a symbol.
    pub marker: Option<Marker>,
    /// Sample of an area.
    pub fill: Option<Color>,
}

impl LegendEntry {
    /// An entry for a line.
    pub fn line(text: impl Into<String>, stroke: Stroke) -> Self {
        LegendEntry {
            text: text.into(),
            stroke: Some(stroke),
            ..LegendEntry::default()
        }
    }

    /// An entry for points.
    pub fn marker(text: impl Into<String>, marker: Marker) -> Self {
        LegendEntry {
            text: text.into(),
            marker: Some(marker),
            ..LegendEntry::default()
        }
    }

    /// An entry for an area.
    pub fn fill(text: impl Into<String>, color: Color) -> Self {
        LegendEntry {
            text: text.into(),
            fill: Some(color),
            ..LegendEntry::default()
        }
    }
}

/// A name to be written beside a curve if a place without data and other text is found.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveLabel {
    /// The name.
    pub text: String,
    /// The curve, `[x, y]`.
    pub points: Vec<[f64; 2]>,
    /// The curve's colour: the name keeps away from lines of other colours, so that it is clear whose it is.
    pub color: Color,
}

/// The scale of a heat map.
#[derive(Debug, Clone, PartialEq)]
pub struct ColorBar {
    /// Quantity, unit and scale; limits must be given.
    pub axis: Axis,
}

/// A length in y that stands for an amplitude.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaleBar {
    /// Its length in units of the y axis.
    pub length: f64,
    /// What it stands for, for example `0.1 rad`.
    pub text: String,
}

impl Figure {
    /// The figure as SVG, with its size on paper. Equal figures give equal text.
    pub fn svg(&self) -> String {
        self.draw().finish()
    }

    /// The figure as PNG, drawn from the SVG with the bundled font. At `scale` 1 a pixel is 1/96 inch;
    /// 3.125 gives the 300 pixels per inch of print.
    ///
    /// # Errors
    /// [`ReportError::RasterSize`] for a scale that is not positive or gives too many pixels,
    /// [`ReportError::Raster`] if the renderer fails.
    pub fn png(&self, scale: f64) -> Result<Vec<u8>, ReportError> {
        raster::svg_to_png(&self.svg(), scale)
    }

    /// Writes the SVG file `path`, whole or not at all.
    ///
    /// # Errors
    /// As [`write_bytes`].
    pub fn save_svg(&self, path: &Path) -> Result<(), ReportError> {
        write_bytes(path, self.svg().as_bytes())
    }

    /// Writes the PNG file `path`, whole or not at all.
    ///
    /// # Errors
    /// As [`Figure::png`] and [`write_bytes`].
    pub fn save_png(&self, path: &Path, scale: f64) -> Result<(), ReportError> {
        write_bytes(path, &self.png(scale)?)
    }

    /// Where text stands, points from the upper left corner of the figure.
    pub fn text_boxes(&self) -> Vec<TextBox> {
        self.draw().into_texts()
    }

    fn draw(&self) -> Svg {
        draw::figure(self)
    }
}
