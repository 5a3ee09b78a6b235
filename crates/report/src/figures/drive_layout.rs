//! The drive to scale: pulleys, belt path, rotation senses, wraps, tensions, tensioners and hub loads.

use super::drive_drawing::{self, box_of, to_millimetres};
use super::number::force;
use super::{FigureOptions, layout_text, tensioner_drawing};
use crate::plot::{
    Axis, Color, Dash, Figure, Layer, LegendEntry, LegendPlace, Marker, Panel, Shape, Stroke, Width, arc,
};

/// Input of [`drive_layout`]: the drive in the plane, in SI units; the figure is in millimetres.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DriveLayout {
    /// The pulleys in the order in which the belt meets them.
    pub pulleys: Vec<LayoutPulley>,
    /// The free spans; span i leads from pulley i to the next.
    pub spans: Vec<LayoutSpan>,
    /// The tensioners.
    pub tensioners: Vec<LayoutTensioner>,
}

/// A pulley of a [`DriveLayout`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayoutPulley {
    /// Number or short sign, written before the name; may be empty.
    pub label: String,
    /// Name.
    pub name: String,
    /// Centre, m.
    pub center: [f64; 2],
    /// Pitch radius, m.
    pub radius: f64,
    /// Rotation: +1 counter-clockwise, −1 clockwise.
    pub sense: f64,
    /// Where the belt meets the pulley, m.
    pub tangent_in: [f64; 2],
    /// Where the belt leaves the pulley, m.
    pub tangent_out: [f64; 2],
    /// Wrap angle, rad.
    pub wrap: f64,
    /// Whether it drives the belt.
    pub driver: bool,
    /// Whether a tensioner carries it.
    pub carried: bool,
    /// A further line of its text, for example `12 N m`; may be empty.
    pub note: String,
    /// Force of the belt on the pulley, N, drawn as an arrow with its magnitude.
    pub hub_load: Option<[f64; 2]>,
}

/// A free span of a [`DriveLayout`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayoutSpan {
    /// Number or short sign, for example `span 3`.
    pub label: String,
    /// Where the belt leaves the pulley before it, m.
    pub start: [f64; 2],
    /// Where the belt meets the pulley after it, m.
    pub end: [f64; 2],
    /// What is written behind the label, for example the tension `412 N`; may be empty.
    pub note: String,
}

/// A tensioner of a [`DriveLayout`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayoutTensioner {
    /// Name; none is written when it is empty.
    pub name: String,
    /// How it moves.
    pub mount: TensionerMount,
    /// Centres of the pulleys it carries, m.
    pub centers: Vec<[f64; 2]>,
}

/// How a tensioner moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TensionerMount {
    /// An arm that turns about a pivot.
    Rotary {
        /// Pivot, m.
        pivot: [f64; 2],
        /// Angles of the line from the pivot to the first centre at the stops, rad from the x axis.
        stops: Option<[f64; 2]>,
    },
    /// A slide.
    Linear {
        /// Direction of positive displacement, any length but zero.
        direction: [f64; 2],
        /// Displacements from the drawn position at which the slide meets its stops, m.
        stops: Option<[f64; 2]>,
    },
}

impl Default for TensionerMount {
    fn default() -> Self {
        TensionerMount::Linear {
            direction: [1.0, 0.0],
            stops: None,
        }
    }
}

/// Stroke of the belt.
const BELT: Stroke = Stroke {
    color: Color::BLACK,
    width: 1.5,
    dash: Dash::Solid,
};
const HUB_LOAD: Stroke = Stroke {
    color: Color::VERMILLION,
    width: 1.1,
    dash: Dash::Solid,
};
/// Length of the largest hub load relative to the greater side of the drive.
const HUB_LOAD_LENGTH: f64 = 0.15;
/// Draws the drive to scale, with axes in millimetres.
///
/// Beside each pulley stand its name, wrap angle and note, beside each span its label and note; a text that
/// finds no place near gets a line to it. In a single column the magnitudes of hub loads give way to the largest
/// of them in the legend; more than about five pulleys read better at the double width. The height follows from
/// the shape of the drive unless the options give one.
pub fn drive_layout(input: &DriveLayout, options: &FigureOptions) -> Figure {
    let input = &to_millimetres(input);
    let bounds = box_of(input);
    let load_scale = load_scale(input, bounds);
    let mut layers = drive_drawing::discs(&input.pulleys);
    layers.extend(input.tensioners.iter().flat_map(tensioner_drawing::mount));
    layers.extend(drive_drawing::belt(input, BELT));
    layers.extend(input.pulleys.iter().filter_map(rotation_arrow));
    layers.extend(input.spans.iter().filter_map(travel_arrow));
    layers.push(Layer::Points {
        points: input.pulleys.iter().map(|pulley| pulley.center).collect(),
        marker: Marker::filled(Shape::Circle, 2.4, Color::BLACK),
    });
    let tips: Vec<Option<[f64; 2]>> = input
        .pulleys
        .iter()
        .map(|pulley| {
            let load = pulley.hub_load?;
            Some([
                pulley.center[0] + load_scale * load[0],
                pulley.center[1] + load_scale * load[1],
            ])
        })
        .collect();
    for (pulley, tip) in input.pulleys.iter().zip(&tips) {
        if let Some(tip) = tip {
            layers.push(Layer::Arrow {
                points: vec![pulley.center, *tip],
                stroke: HUB_LOAD,
                head: 5.0,
            });
        }
    }
    layers.extend(tensioner_drawing::pivots(&input.tensioners));
    let sheet = Sheet::new(bounds, options);
    let panel = Panel {
        x: Axis::linear("x", "mm").with_limits(sheet.x[0], sheet.x[1]),
        y: Axis::linear("y", "mm").with_limits(sheet.y[0], sheet.y[1]),
        layers,
        legend: legend(input, options.width),
        legend_place: LegendPlace::Above,
        notes: layout_text::notes(input, &tips, options.width),
        equal_aspect: true,
        ..Panel::default()
    };
    options.figure(vec![vec![panel]], sheet.height, sheet.height)
}

/// Length of an arrow per newton, millimetres.
fn load_scale(input: &DriveLayout, [x, y]: [[f64; 2]; 2]) -> f64 {
    let largest = input
        .pulleys
        .iter()
        .filter_map(|pulley| pulley.hub_load)
        .map(|load| load[0].hypot(load[1]))
        .filter(|load| load.is_finite())
        .fold(0.0, f64::max);
    if largest > 0.0 {
        HUB_LOAD_LENGTH * (x[1] - x[0]).max(y[1] - y[0]) / largest
    } else {
        0.0
    }
}

/// Limits of the axes with room for text around the drive, and the height of the page that fits them.
struct Sheet {
    x: [f64; 2],
    y: [f64; 2],
    height: f64,
}

impl Sheet {
    fn new([x, y]: [[f64; 2]; 2], options: &FigureOptions) -> Self {
        /// Room of axes, legend and heading, points.
        const AXES: [f64; 2] = [40.0, 55.0];
        const POINTS: f64 = 72.0 / MILLIMETRES_PER_INCH;
        const MILLIMETRES_PER_INCH: f64 = 25.4;
        let (beside, over) = match options.width {
            Width::Single => (50.0, 38.0),
            Width::Double => (60.0, 34.0),
        };
        let frame = options.width.millimetres() * POINTS - AXES[0];
        // A drive that stands upright is drawn smaller, so that it fits on a page with its caption.
        let tallest = 200.0 * POINTS - AXES[1];
        let (width, height) = (x[1] - x[0], y[1] - y[0]);
        let unit = (width / (frame - 2.0 * beside)).max(height / (tallest - 2.0 * over));
        let needed = (height / unit + 2.0 * over + AXES[1]) / POINTS;
        Sheet {
            x: [x[0] - beside * unit, x[1] + beside * unit],
            y: [y[0] - over * unit, y[1] + over * unit],
            height: needed.clamp(50.0, 200.0),
        }
    }
}

/// The arrow inside a pulley that shows its sense of rotation.
fn rotation_arrow(pulley: &LayoutPulley) -> Option<Layer> {
    /// Below the hub, so that hub loads and arms, which mostly point elsewhere, leave it visible.
    const SWEEP: f64 = 2.4;
    let start = -std::f64::consts::FRAC_PI_2 - pulley.sense.signum() * SWEEP / 2.0;
    (pulley.sense != 0.0).then(|| Layer::Arrow {
        points: arc(
            pulley.center,
            0.62 * pulley.radius,
            start,
            pulley.sense.signum() * SWEEP,
        ),
        stroke: Stroke::solid(Color::BLACK).with_width(0.6),
        head: 3.6,
    })
}

/// The head in the middle of a span that shows where the belt runs.
fn travel_arrow(span: &LayoutSpan) -> Option<Layer> {
    let [start, end] = [span.start, span.end];
    let at = |t: f64| {
        [
            start[0] + t * (end[0] - start[0]),
            start[1] + t * (end[1] - start[1]),
        ]
    };
    (start != end).then(|| Layer::Arrow {
        points: vec![at(0.3), at(0.55)],
        stroke: BELT,
        head: 6.5,
    })
}

fn legend(input: &DriveLayout, width: Width) -> Vec<LegendEntry> {
    let mut entries = Vec::new();
    let pulleys = &input.pulleys;
    if pulleys.iter().any(|pulley| pulley.driver) {
        entries.push(LegendEntry::fill("driver", drive_drawing::DRIVER));
    }
    if pulleys.iter().any(|pulley| pulley.carried) {
        entries.push(LegendEntry::fill("on a tensioner", drive_drawing::CARRIED));
    }
    let loads = pulleys.iter().filter_map(|pulley| pulley.hub_load);
    let largest = loads.map(|load| load[0].hypot(load[1])).reduce(f64::max);
    if let Some(largest) = largest {
        let text = match width {
            Width::Single => format!("hub load, up to {}", force(largest)),
            Width::Double => "hub load".to_string(),
        };
        entries.push(LegendEntry::line(text, HUB_LOAD));
    }
    let stops = input.tensioners.iter().find_map(tensioner_drawing::stop_stroke);
    if let Some(stroke) = stops {
        entries.push(LegendEntry::line("stops of the tensioner", stroke));
    }
    entries
}
