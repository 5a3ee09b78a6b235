//! Figures, one file for each kind: a function from a plain struct to a [`Figure`].
//!
//! Motions and branches: [`response`], [`time_history`], [`phase_portrait`], [`poincare_map`], [`spectrum`],
//! [`waterfall_lines`], [`waterfall_map`], [`engagement_strip`], [`basin`], [`curve_family`]. Belt drives:
//! [`drive_layout`], [`mode_shapes`] (one figure for each page), [`campbell`], [`tension_fan`],
//! [`hub_load_polar`], [`order_response`]. One-way clutches and dry friction: [`regime_timeline`],
//! [`torque_angle`], [`dissipation`], [`engaged_ratio`], [`tension_extremes`], [`comparison`],
//! [`critical_level`], [`waterfall_orders`], [`certified_response`].
//!
//! All of them take [`FigureOptions`] for the size on paper and for warnings that stand below the data. Values that are not finite are left out; empty
//! input gives empty axes. Lengths that should agree and do not are cut to the shortest.

mod basin;
mod branch;
mod campbell;
mod certified_response;
mod comparison;
mod critical_level;
mod curve_family;
mod dissipation;
mod drive_drawing;
mod drive_layout;
mod engaged_ratio;
mod engagement_strip;
mod hub_load_polar;
mod lanes;
mod layout_text;
mod mode_shapes;
mod number;
mod order_response;
mod phase_portrait;
mod poincare_map;
mod regime_timeline;
mod response;
mod special_point;
mod spectrum;
mod tension_extremes;
mod tension_fan;
mod tensioner_drawing;
mod time_history;
mod torque_angle;
mod waterfall;

pub use basin::{Basin, basin};
pub use branch::Branch;
pub use campbell::{Campbell, CampbellMode, ModeKind, campbell};
pub use certified_response::{
    CertifiedCurve, CertifiedMeasure, CertifiedResponse, RangeWarning, certified_response,
};
pub use comparison::{ComparedMeasure, Comparison, comparison};
pub use critical_level::{CriticalLevel, critical_level};
pub use curve_family::{CurveFamily, curve_family};
pub use dissipation::{
    Dissipation, DissipationCurve, FrictionRegion, FrictionRegionKind, ReversalCounters, dissipation,
};
pub use drive_layout::{
    DriveLayout, LayoutPulley, LayoutSpan, LayoutTensioner, TensionerMount, drive_layout,
};
pub use engaged_ratio::{EngagedRatio, EngagedRatioCurve, engaged_ratio};
pub use engagement_strip::{EngagementRow, EngagementStrip, engagement_strip};
pub use hub_load_polar::{HubLoadPath, HubLoadPolar, hub_load_polar};
pub use mode_shapes::{ModeShape, ModeShapes, mode_shapes};
pub use order_response::{OrderCurve, OrderMeasure, OrderResponse, order_response};
pub use phase_portrait::{PhasePortrait, phase_portrait};
pub use poincare_map::{PoincareMap, poincare_map};
pub use regime_timeline::{
    Regime, RegimeEvent, RegimeInterval, RegimeLane, RegimeTimeline, Repetition, TimelineEvent,
    regime_timeline,
};
pub use response::{Response, Zoom, response};
pub use special_point::{SpecialKind, SpecialPoint};
pub use spectrum::{Spectrum, SpectrumStyle, spectrum};
pub use tension_extremes::{TensionExtremes, TensionRange, TensionRangePanel, tension_extremes};
pub use tension_fan::{TensionFan, TensionPanel, tension_fan};
pub use time_history::{TimeHistory, TimePanel, time_history};
pub use torque_angle::{FrictionLoop, TorqueAngle, torque_angle};
pub use waterfall::{ResponseSpectrum, Waterfall, waterfall_lines, waterfall_map, waterfall_orders};

use crate::plot::{Figure, LegendEntry, Panel, Width};

/// Size and heading of a figure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FigureOptions {
    /// Width on paper.
    pub width: Width,
    /// Height on paper, millimetres; a usual one for the kind of figure when absent.
    pub height: Option<f64>,
    /// Heading, absent by default: papers have captions.
    pub title: Option<String>,
    /// What must be known before the data is trusted, for example that uniqueness is not guaranteed; written
    /// at the foot of the page, which grows for it. Warnings that a figure finds in its data come behind.
    pub warnings: Vec<String>,
}

impl FigureOptions {
    /// The figure with these options: `single` and `double` are the usual heights, millimetres.
    fn figure(&self, mut rows: Vec<Vec<Panel>>, single: f64, double: f64) -> Figure {
        // The warnings are kept even where there is nothing to draw.
        if rows.is_empty() && !self.warnings.is_empty() {
            rows.push(vec![Panel {
                bare: true,
                ..Panel::default()
            }]);
        }
        if let Some(panel) = rows.iter_mut().flatten().next() {
            panel.warnings.splice(..0, self.warnings.iter().cloned());
        }
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

/// Panels side by side under one legend, in as many columns as the page and their number ask for. `heads` are the heights without
/// panels of a single and a double column, millimetres.
fn panel_grid(mut panels: Vec<Panel>, options: &FigureOptions, heads: (f64, f64)) -> Figure {
    let columns = match (options.width, panels.len()) {
        (_, 0 | 1) | (Width::Single, _) => 1,
        (Width::Double, 2 | 4) => 2,
        (Width::Double, _) => 3,
    };
    let legend = shared_legend(panels.iter_mut());
    let rows: Vec<Vec<Panel>> = panels.chunks(columns).map(<[Panel]>::to_vec).collect();
    let count = rows.len().max(1) as f64;
    let mut figure = options.figure(rows, heads.0 + 42.0 * count, heads.1 + 52.0 * count);
    figure.share_x = columns == 1;
    figure.legend = legend;
    figure
}

/// Takes the legends of panels together to one in which each entry stands once, since it holds for all.
fn shared_legend<'a>(panels: impl Iterator<Item = &'a mut Panel>) -> Vec<LegendEntry> {
    let mut legend: Vec<LegendEntry> = Vec::new();
    for entry in panels.flat_map(|panel| panel.legend.drain(..)) {
        if !legend.contains(&entry) {
            legend.push(entry);
        }
    }
    legend
}

/// The least and the greatest finite value.
fn extent(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    values
        .filter(|value| value.is_finite())
        .fold(None, |extent, value| {
            Some(extent.map_or([value, value], |[low, high]: [f64; 2]| {
                [low.min(value), high.max(value)]
            }))
        })
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
