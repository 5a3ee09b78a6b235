//! Figures, one file for each kind: a function from a plain struct to a [`Figure`].
//!
//! Motions and branches: [`response`], [`time_history`], [`phase_portrait`], [`poincare_map`], [`spectrum`],
//! [`waterfall_lines`], [`waterfall_map`], [`engagement_strip`], [`basin`], [`curve_family`]. Belt drives:
//! [`drive_layout`], [`mode_shapes`] (one figure for each page), [`campbell`], [`tension_fan`],
//! [`hub_load_polar`], [`order_response`].
//!
//! All of them take [`FigureOptions`] for the size on paper. Values that are not finite are left out; empty
//! input gives empty axes. Lengths that should agree and do not are cut to the shortest.

mod basin;
mod branch;
mod campbell;
mod curve_family;
mod drive_drawing;
mod drive_layout;
mod engagement_strip;
mod hub_load_polar;
mod layout_text;
mod mode_shapes;
mod number;
mod order_response;
mod phase_portrait;
mod poincare_map;
mod response;
mod special_point;
mod spectrum;
mod tension_fan;
mod tensioner_drawing;
mod time_history;
mod waterfall;

pub use basin::{Basin, basin};
pub use branch::Branch;
pub use campbell::{Campbell, CampbellMode, ModeKind, campbell};
pub use curve_family::{CurveFamily, curve_family};
pub use drive_layout::{
    DriveLayout, LayoutPulley, LayoutSpan, LayoutTensioner, TensionerMount, drive_layout,
};
pub use engagement_strip::{EngagementRow, EngagementStrip, engagement_strip};
pub use hub_load_polar::{HubLoadPath, HubLoadPolar, hub_load_polar};
pub use mode_shapes::{ModeShape, ModeShapes, mode_shapes};
pub use order_response::{OrderCurve, OrderMeasure, OrderResponse, order_response};
pub use phase_portrait::{PhasePortrait, phase_portrait};
pub use poincare_map::{PoincareMap, poincare_map};
pub use response::{Response, Zoom, response};
pub use special_point::{SpecialKind, SpecialPoint};
pub use spectrum::{Spectrum, SpectrumStyle, spectrum};
pub use tension_fan::{TensionFan, TensionPanel, tension_fan};
pub use time_history::{TimeHistory, TimePanel, time_history};
pub use waterfall::{ResponseSpectrum, Waterfall, waterfall_lines, waterfall_map};

use crate::plot::{Figure, Panel, Width};

/// Size and heading of a figure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FigureOptions {
    /// Width on paper.
    pub width: Width,
    /// Height on paper, millimetres; a usual one for the kind of figure when absent.
    pub height: Option<f64>,
    /// Heading, absent by default: papers have captions.
    pub title: Option<String>,
}

impl FigureOptions {
    /// The figure with these options: `single` and `double` are the usual heights, millimetres.
    fn figure(&self, rows: Vec<Vec<Panel>>, single: f64, double: f64) -> Figure {
        let usual = match self.width {
            Width::Single => single,
            Width::Double => double,
        };
        Figure {
            width: self.width,
            height: self.height.unwrap_or(usual),
            title: self.title.clone(),
            legend: Vec::new(),
            rows,
            share_x: false,
        }
    }
}

/// A named curve y(x).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// Name for the legend; none is written when it is empty.
    pub name: String,
    /// Abscissae.
    pub x: Vec<f64>,
    /// Ordinates, as many.
    pub y: Vec<f64>,
}

impl Curve {
    /// The vertices `[x, y]`.
    fn points(&self) -> Vec<[f64; 2]> {
        self.x.iter().zip(&self.y).map(|(x, y)| [*x, *y]).collect()
    }
}

/// A named set of points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PointSet {
    /// Name for the legend; none is written when it is empty.
    pub name: String,
    /// Positions `[x, y]`.
    pub points: Vec<[f64; 2]>,
}
