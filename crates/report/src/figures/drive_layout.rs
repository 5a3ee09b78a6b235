//! The drive to scale: pulleys, belt path, rotation senses, wraps, tensions, tensioners and hub loads.

use super::FigureOptions;
use super::drive_drawing::{self, box_of, outside, span_outside, to_millimetres};
use super::number::{degrees, force};
use crate::plot::{
    Axis, Color, Dash, Figure, Layer, LegendEntry, LegendPlace, Marker, Note, NotePlace, Panel, Shape,
    Stroke, Width, arc, direction,
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
const ARM: Color = Color(150, 150, 150);
const STOP: Stroke = Stroke {
    color: Color::GREY,
    width: 0.6,
    dash: Dash::Dashed,
};
const SLIDE_STOP: Stroke = Stroke {
    color: Color::GREY,
    width: 0.9,
    dash: Dash::Solid,
};
const HUB_LOAD: Stroke = Stroke {
    color: Color::VERMILLION,
    width: 1.1,
    dash: Dash::Solid,
};
/// Length of the largest hub load relative to the greater side of the drive.
const HUB_LOAD_LENGTH: f64 = 0.15;
/// Greatest distance of a text from its place, points.
const REACH: f64 = 90.0;

/// Draws the drive to scale, with axes in millimetres.
///
/// Beside each pulley stand its name, wrap angle and note, beside each span its label and note; a text that
/// finds no place near gets a line to it. In a single column the magnitudes of hub loads give way to the largest
/// of them in the legend: prefer the double width for more than about five pulleys. The height follows from the shape of the drive unless the options
/// give one.
pub fn drive_layout(input: &DriveLayout, options: &FigureOptions) -> Figure {
    let input = &to_millimetres(input);
    let bounds = box_of(input);
    let load_scale = load_scale(input, bounds);
    let mut layers = drive_drawing::discs(&input.pulleys);
    layers.extend(input.tensioners.iter().flat_map(tensioner));
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
    layers.extend(pivots(&input.tensioners));
    let sheet = Sheet::new(bounds, options);
    let panel = Panel {
        x: Axis::linear("x", "mm").with_limits(sheet.x[0], sheet.x[1]),
        y: Axis::linear("y", "mm").with_limits(sheet.y[0], sheet.y[1]),
        layers,
        legend: legend(input, options.width),
        legend_place: LegendPlace::Above,
        notes: notes(input, &tips, options.width),
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

/// Arm or slide with its stops.
fn tensioner(tensioner: &LayoutTensioner) -> Vec<Layer> {
    let mut layers = Vec::new();
    let rail = Stroke::solid(ARM).with_width(3.2);
    match tensioner.mount {
        TensionerMount::Rotary { pivot, stops } => {
            for center in &tensioner.centers {
                layers.push(Layer::Line {
                    points: vec![pivot, *center],
                    stroke: rail,
                });
            }
            if let (Some([from, to]), Some(center)) = (stops, tensioner.centers.first()) {
                let length = (center[0] - pivot[0]).hypot(center[1] - pivot[1]);
                let at = |angle: f64| [pivot[0] + length * angle.cos(), pivot[1] + length * angle.sin()];
                for points in [
                    vec![pivot, at(from)],
                    vec![pivot, at(to)],
                    arc(pivot, length, from, to - from),
                ] {
                    layers.push(Layer::Line { points, stroke: STOP });
                }
            }
        }
        TensionerMount::Linear { direction, stops } => {
            let length = direction[0].hypot(direction[1]);
            let unit = [direction[0] / length, direction[1] / length];
            for center in &tensioner.centers {
                let at = |s: f64, across: f64| {
                    [
                        center[0] + s * unit[0] - across * unit[1],
                        center[1] + s * unit[1] + across * unit[0],
                    ]
                };
                // Without stops the slide is as long as a usual pulley is wide.
                let [from, to] = stops.unwrap_or([-40.0, 40.0]);
                layers.push(Layer::Line {
                    points: vec![at(from, 0.0), at(to, 0.0)],
                    stroke: rail,
                });
                let tick = 0.15 * (to - from).abs();
                for s in stops.into_iter().flatten() {
                    layers.push(Layer::Line {
                        points: vec![at(s, -tick), at(s, tick)],
                        stroke: SLIDE_STOP,
                    });
                }
            }
        }
    }
    layers
}

/// Symbols of the pivots.
fn pivots(tensioners: &[LayoutTensioner]) -> Vec<Layer> {
    let points: Vec<[f64; 2]> = tensioners
        .iter()
        .filter_map(|tensioner| match tensioner.mount {
            TensionerMount::Rotary { pivot, .. } => Some(pivot),
            TensionerMount::Linear { .. } => None,
        })
        .collect();
    [(6.4, false), (2.0, true)]
        .into_iter()
        .map(|(size, filled)| Layer::Points {
            points: points.clone(),
            marker: Marker {
                shape: Shape::Circle,
                size,
                filled,
                color: Color::BLACK,
            },
        })
        .collect()
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
    let stops = input
        .tensioners
        .iter()
        .find_map(|tensioner| match tensioner.mount {
            TensionerMount::Rotary { stops, .. } => stops.map(|_| STOP),
            TensionerMount::Linear { stops, .. } => stops.map(|_| SLIDE_STOP),
        });
    if let Some(stroke) = stops {
        entries.push(LegendEntry::line("stops of the tensioner", stroke));
    }
    entries
}

fn notes(input: &DriveLayout, tips: &[Option<[f64; 2]>], width: Width) -> Vec<Note> {
    // A narrow page has little room beside the drive: names come first. On a wide one, spans have fewer places.
    let pulleys = input
        .pulleys
        .iter()
        .map(|pulley| pulley_note(pulley, &input.pulleys));
    // The shorter a span, the fewer places its text has.
    let mut spans: Vec<&LayoutSpan> = input.spans.iter().collect();
    spans.sort_by(|a, b| length(a).total_cmp(&length(b)));
    let spans = spans
        .into_iter()
        .map(|span| span_note(span, &input.pulleys, width));
    let mut notes: Vec<Note> = match width {
        Width::Single => pulleys.chain(spans).collect(),
        Width::Double => spans.chain(pulleys).collect(),
    };
    // In one column there is no room for them; the legend names the largest.
    let tips = match width {
        Width::Single => &[],
        Width::Double => tips,
    };
    for (pulley, tip) in input.pulleys.iter().zip(tips) {
        if let (Some(load), Some(tip)) = (pulley.hub_load, tip) {
            notes.push(Note {
                text: force(load[0].hypot(load[1])),
                anchors: vec![*tip],
                place: NotePlace::Beside {
                    radius: 0.0,
                    toward: load,
                    reach: REACH,
                },
            });
        }
    }
    for tensioner in &input.tensioners {
        let (anchor, toward) = match tensioner.mount {
            TensionerMount::Rotary { pivot, .. } => {
                let arm = tensioner
                    .centers
                    .first()
                    .map_or([0.0, 0.0], |center| [pivot[0] - center[0], pivot[1] - center[1]]);
                (Some(pivot), arm)
            }
            TensionerMount::Linear { direction: along, .. } => (
                tensioner
                    .centers
                    .first()
                    .map(|center| arc(*center, 40.0, direction([0.0, 0.0], along), 0.0)[0]),
                along,
            ),
        };
        notes.push(Note {
            text: tensioner.name.clone(),
            anchors: anchor.into_iter().collect(),
            place: NotePlace::Beside {
                radius: 0.0,
                toward,
                reach: REACH,
            },
        });
    }
    notes.retain(|note| !note.text.is_empty());
    notes
}

fn pulley_note(pulley: &LayoutPulley, pulleys: &[LayoutPulley]) -> Note {
    Note {
        text: pulley_text(pulley),
        anchors: vec![pulley.center],
        place: NotePlace::Beside {
            radius: pulley.radius,
            toward: outside(pulley, pulleys),
            reach: REACH,
        },
    }
}

fn span_note(span: &LayoutSpan, pulleys: &[LayoutPulley], width: Width) -> Note {
    let at = |t: f64| {
        [
            span.start[0] + t * (span.end[0] - span.start[0]),
            span.start[1] + t * (span.end[1] - span.start[1]),
        ]
    };
    let text = words([&span.label, &span.note]);
    Note {
        text: match width {
            Width::Single => text.replace(BETWEEN, "\n"),
            Width::Double => text,
        },
        anchors: [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8].map(at).to_vec(),
        place: NotePlace::Beside {
            radius: 0.0,
            toward: span_outside(span, pulleys),
            reach: REACH,
        },
    }
}

/// Name, wrap and note of a pulley in lines.
fn pulley_text(pulley: &LayoutPulley) -> String {
    let lines = [
        words([&pulley.label, &pulley.name]),
        format!("wrap {}", degrees(pulley.wrap)),
        pulley.note.clone(),
    ];
    let lines: Vec<String> = lines.into_iter().filter(|line| !line.is_empty()).collect();
    lines.join("\n")
}

fn length(span: &LayoutSpan) -> f64 {
    (span.end[0] - span.start[0]).hypot(span.end[1] - span.start[1])
}

/// What separates label and text.
const BETWEEN: &str = "  ";

/// The words that are not empty.
fn words(words: [&String; 2]) -> String {
    let words: Vec<&str> = words
        .into_iter()
        .map(String::as_str)
        .filter(|word| !word.is_empty())
        .collect();
    words.join(BETWEEN)
}
