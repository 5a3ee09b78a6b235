//! Mode shapes on the layout of the drive, several to a page.

use super::FigureOptions;
use super::drive_drawing::{self, MILLIMETRES, box_of, in_millimetres, outside, to_millimetres};
use super::drive_layout::{DriveLayout, LayoutPulley, TensionerMount};
use crate::plot::{
    Axis, Color, Dash, Figure, Layer, LegendEntry, Note, NotePlace, Panel, Stroke, Width, arc, circle, sector,
};

/// Input of [`mode_shapes`], in SI units.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModeShapes {
    /// The drive at rest; loads and notes are not drawn.
    pub layout: DriveLayout,
    /// The modes.
    pub modes: Vec<ModeShape>,
}

/// A mode of [`ModeShapes`], exaggerated as it shall be drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModeShape {
    /// What stands over it, for example `3: 41.2 Hz, span 2`.
    pub heading: String,
    /// Points `[x, y]` along each deflected span, m; empty for a span at rest.
    pub spans: Vec<Vec<[f64; 2]>>,
    /// Rotation of each pulley, rad, counter-clockwise positive.
    pub rotations: Vec<f64>,
    /// Displaced centre of each pulley, m; those that are missing or equal to the centre at rest do not move.
    pub centers: Vec<[f64; 2]>,
}

const AT_REST: Stroke = Stroke {
    color: Color(150, 150, 150),
    width: 0.8,
    dash: Dash::Solid,
};
const DEFLECTED: Stroke = Stroke {
    color: Color::BLUE,
    width: 1.3,
    dash: Dash::Solid,
};
const MOVED: Stroke = Stroke {
    color: Color::BLACK,
    width: 0.9,
    dash: Dash::Solid,
};
const COUNTER_CLOCKWISE: Color = Color::SKY_BLUE;
const CLOCKWISE: Color = Color::ORANGE;

/// Draws each mode in a panel of its own, six to a page. One figure is one page.
///
/// The belt at rest is grey, deflected spans are blue, displaced pulleys and arms black. The sector on a pulley
/// is its rotation from the upright, its colour the sense.
pub fn mode_shapes(input: &ModeShapes, options: &FigureOptions) -> Vec<Figure> {
    const PANELS: usize = 6;
    let layout = to_millimetres(&input.layout);
    let columns = match options.width {
        Width::Single => 2,
        Width::Double => 3,
    };
    let bounds = limits(&layout, &input.modes);
    let cell = options.width.millimetres() / columns as f64;
    let shape = ((bounds[1][1] - bounds[1][0]) / (bounds[0][1] - bounds[0][0])).clamp(0.3, 1.6);
    input
        .modes
        .chunks(PANELS)
        .map(|page| {
            let panels: Vec<Panel> = page.iter().map(|mode| panel(&layout, mode, bounds)).collect();
            let rows: Vec<Vec<Panel>> = panels.chunks(columns).map(<[Panel]>::to_vec).collect();
            let height = rows.len() as f64 * (0.9 * cell * shape + 7.0) + 8.0;
            let mut figure = options.figure(rows, height, height);
            figure.legend = legend(page);
            figure
        })
        .collect()
}

/// Intervals that hold the drive and all its deflections.
fn limits(layout: &DriveLayout, modes: &[ModeShape]) -> [[f64; 2]; 2] {
    let [mut x, mut y] = box_of(layout);
    for mode in modes {
        let mut visit = |[a, b]: [f64; 2], radius: f64| {
            if (a + b + radius).is_finite() {
                x = [x[0].min(a - radius), x[1].max(a + radius)];
                y = [y[0].min(b - radius), y[1].max(b + radius)];
            }
        };
        for point in mode.spans.iter().flatten() {
            visit(in_millimetres(*point), 0.0);
        }
        for (center, pulley) in mode.centers.iter().zip(&layout.pulleys) {
            visit(in_millimetres(*center), pulley.radius);
        }
    }
    let margin = |[low, high]: [f64; 2]| [low - 0.06 * (high - low), high + 0.06 * (high - low)];
    [margin(x), margin(y)]
}

fn legend(modes: &[ModeShape]) -> Vec<LegendEntry> {
    let turns = |sign: f64| {
        modes
            .iter()
            .any(|mode| mode.rotations.iter().any(|turn| turn * sign > 0.0))
    };
    let mut entries = vec![
        LegendEntry::line("at rest", AT_REST),
        LegendEntry::line("deflected span", DEFLECTED),
    ];
    if turns(1.0) {
        entries.push(LegendEntry::fill("turns counter-clockwise", COUNTER_CLOCKWISE));
    }
    if turns(-1.0) {
        entries.push(LegendEntry::fill("turns clockwise", CLOCKWISE));
    }
    entries
}

fn panel(layout: &DriveLayout, mode: &ModeShape, bounds: [[f64; 2]; 2]) -> Panel {
    let mut layers = Vec::new();
    let rim = AT_REST.with_width(0.5);
    for pulley in &layout.pulleys {
        layers.push(Layer::Area {
            points: circle(pulley.center, pulley.radius),
            color: drive_drawing::PLAIN,
        });
        layers.push(Layer::Line {
            points: circle(pulley.center, pulley.radius),
            stroke: rim,
        });
    }
    layers.extend(arms(layout, |index| layout.pulleys[index].center, AT_REST));
    layers.extend(drive_drawing::belt(layout, AT_REST));
    let center_of = |index: usize| {
        mode.centers
            .get(index)
            .map_or(layout.pulleys[index].center, |center| in_millimetres(*center))
    };
    for (index, pulley) in layout.pulleys.iter().enumerate() {
        let center = center_of(index);
        if is_moved(center, pulley) {
            layers.push(Layer::Line {
                points: circle(center, pulley.radius),
                stroke: MOVED,
            });
        }
        if let Some(turn) = mode.rotations.get(index) {
            layers.extend(rotation(center, pulley.radius, *turn));
        }
    }
    if layout
        .pulleys
        .iter()
        .enumerate()
        .any(|(index, pulley)| is_moved(center_of(index), pulley))
    {
        layers.extend(arms(layout, center_of, MOVED));
    }
    for span in &mode.spans {
        layers.push(Layer::Line {
            points: span.iter().copied().map(in_millimetres).collect(),
            stroke: DEFLECTED,
        });
    }
    Panel {
        x: Axis::linear("x", "mm").with_limits(bounds[0][0], bounds[0][1]),
        y: Axis::linear("y", "mm").with_limits(bounds[1][0], bounds[1][1]),
        layers,
        notes: layout
            .pulleys
            .iter()
            .filter(|pulley| !pulley.label.is_empty())
            .map(|pulley| Note {
                text: pulley.label.clone(),
                anchors: vec![pulley.center],
                place: NotePlace::Beside {
                    radius: pulley.radius,
                    toward: outside(pulley, &layout.pulleys),
                    reach: 8.0,
                },
            })
            .collect(),
        heading: Some(mode.heading.clone()),
        equal_aspect: true,
        bare: true,
        ..Panel::default()
    }
}

/// Whether a pulley moves by what can be seen, more than a hundredth of its radius.
fn is_moved(center: [f64; 2], pulley: &LayoutPulley) -> bool {
    let distance = (center[0] - pulley.center[0]).hypot(center[1] - pulley.center[1]);
    distance > 0.01 * pulley.radius
}

/// The arms of rotary tensioners from the pivot to the centres of their pulleys.
fn arms(layout: &DriveLayout, center_of: impl Fn(usize) -> [f64; 2], stroke: Stroke) -> Vec<Layer> {
    let mut layers = Vec::new();
    for tensioner in &layout.tensioners {
        let TensionerMount::Rotary { pivot, .. } = tensioner.mount else {
            continue;
        };
        for center in &tensioner.centers {
            // A carried pulley is known by its centre at rest.
            let carried = layout.pulleys.iter().position(|pulley| {
                let distance = (pulley.center[0] - center[0]).hypot(pulley.center[1] - center[1]);
                distance < 1e-6 * MILLIMETRES
            });
            layers.push(Layer::Line {
                points: vec![pivot, carried.map_or(*center, &center_of)],
                stroke,
            });
        }
    }
    layers
}

/// The rotation of a pulley as a sector from the upright with an arrow along its edge.
fn rotation(center: [f64; 2], radius: f64, turn: f64) -> Vec<Layer> {
    /// Smaller ones could not be told from none.
    const VISIBLE: f64 = 0.02;
    const UPRIGHT: f64 = std::f64::consts::FRAC_PI_2;
    if turn.abs() < VISIBLE || !turn.is_finite() {
        return Vec::new();
    }
    let color = if turn > 0.0 { COUNTER_CLOCKWISE } else { CLOCKWISE };
    vec![
        Layer::Area {
            points: sector(center, 0.86 * radius, UPRIGHT, turn),
            color,
        },
        Layer::Arrow {
            points: arc(center, 0.86 * radius, UPRIGHT, turn),
            stroke: Stroke::solid(Color::BLACK).with_width(0.6),
            head: 3.2,
        },
    ]
}
