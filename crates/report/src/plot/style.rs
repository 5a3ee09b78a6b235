//! Strokes, markers and the sizes that all figures share.

use super::color::Color;

/// Type size of tick labels and legends, points.
pub(super) const SMALL_TYPE: f64 = 7.0;
/// Type size of axis labels, points.
pub(super) const LABEL_TYPE: f64 = 8.0;
/// Type size of the title and of panel letters, points.
pub(super) const TITLE_TYPE: f64 = 8.5;
/// Width of frames and ticks, points.
pub(super) const FRAME_WIDTH: f64 = 0.5;
/// Length of major ticks, points.
pub(super) const MAJOR_TICK: f64 = 3.0;
/// Length of minor ticks, points.
pub(super) const MINOR_TICK: f64 = 1.7;

/// How a line is broken. The pattern is measured along the line in points, so it does not depend on how
/// densely the line is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Unbroken.
    Solid,
    /// Dashes, the custom for unstable solutions.
    Dashed,
    /// Dots.
    Dotted,
    /// Dash and dot in turn.
    DashDot,
    /// Long dashes.
    LongDash,
}

impl Dash {
    /// The pattern of curve number `index` where dashes tell curves apart.
    pub fn of_curve(index: usize) -> Dash {
        [
            Dash::Solid,
            Dash::Dashed,
            Dash::DashDot,
            Dash::Dotted,
            Dash::LongDash,
        ][index % 5]
    }

    /// Lengths of dash and gap in turn, points; none for a solid line.
    pub(super) fn pattern(self) -> &'static [f64] {
        match self {
            Dash::Solid => &[],
            Dash::Dashed => &[3.2, 1.8],
            Dash::Dotted => &[0.9, 1.5],
            Dash::DashDot => &[4.0, 1.5, 0.9, 1.5],
            Dash::LongDash => &[7.0, 2.0],
        }
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub color: Color,
    /// Width, points.
    pub width: f64,
    /// Pattern.
    pub dash: Dash,
}

impl Stroke {
    /// A solid line of the usual width, 0.9 points.
    pub fn solid(color: Color) -> Self {
        Stroke {
            color,
            width: 0.9,
            dash: Dash::Solid,
        }
    }

    /// The same line with another pattern.
    pub fn with_dash(self, dash: Dash) -> Self {
        Stroke { dash, ..self }
    }

    /// The same line with another width, points.
    pub fn with_width(self, width: f64) -> Self {
        Stroke { width, ..self }
    }
}

/// Outline of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Circle.
    Circle,
    /// Square on its side.
    Square,
    /// Square on its corner.
    Diamond,
    /// Triangle, tip up.
    TriangleUp,
    /// Triangle, tip down.
    TriangleDown,
    /// Upright cross; has no inside.
    Plus,
    /// Slanting cross; has no inside.
    Cross,
    /// Star of three strokes; has no inside.
    Asterisk,
}

/// A point symbol.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marker {
    /// Outline.
    pub shape: Shape,
    /// Width and height, points.
    pub size: f64,
    /// Filled with the colour; open markers are white inside.
    pub filled: bool,
    /// Colour of the outline, and of the inside when filled.
    pub color: Color,
}

impl Marker {
    /// An open marker.
    pub fn open(shape: Shape, size: f64, color: Color) -> Self {
        Marker {
            shape,
            size,
            filled: false,
            color,
        }
    }

    /// A filled marker.
    pub fn filled(shape: Shape, size: f64, color: Color) -> Self {
        Marker {
            shape,
            size,
            filled: true,
            color,
        }
    }
}
