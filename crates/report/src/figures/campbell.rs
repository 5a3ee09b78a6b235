//! Campbell diagram: natural frequencies over speed with the orders of the excitation.

use super::FigureOptions;
use super::number::short;
use crate::plot::{
    Axis, Color, Dash, Figure, Layer, LegendEntry, Marker, Note, NotePlace, Panel, Shape, Stroke,
};

/// Input of [`campbell`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Campbell {
    /// Speed, for example in rpm.
    pub speed: Axis,
    /// Frequency, for example in Hz.
    pub frequency: Axis,
    /// The tracked modes.
    pub modes: Vec<CampbellMode>,
    /// Orders of the excitation, each a line through the origin.
    pub orders: Vec<f64>,
    /// Frequency of order 1 at unit speed, in the units of the axes: 1/60 for rpm and Hz.
    pub order_slope: f64,
    /// Resonances, where an order meets a mode, `[speed, frequency]`.
    pub crossings: Vec<[f64; 2]>,
    /// Speed at which the drive loses its stability.
    pub critical_speed: Option<f64>,
}

/// A mode tracked over speed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CampbellMode {
    /// Name or number written beside the curve; may be empty.
    pub name: String,
    /// Speeds, ascending.
    pub speed: Vec<f64>,
    /// Frequencies, as many.
    pub frequency: Vec<f64>,
    /// What moves most at each point; the last one holds for points beyond its end.
    pub kinds: Vec<ModeKind>,
}

/// What moves most in a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModeKind {
    /// Pulleys turn.
    #[default]
    Rotation,
    /// A tensioner moves.
    Arm,
    /// The span of this number vibrates across its chord.
    Span(usize),
    /// Several of these.
    Mixed,
}

impl ModeKind {
    /// Kinds in the order of the legend; spans stand for all spans.
    const ALL: [ModeKind; 4] = [
        ModeKind::Rotation,
        ModeKind::Arm,
        ModeKind::Span(0),
        ModeKind::Mixed,
    ];

    fn name(self) -> &'static str {
        match self {
            ModeKind::Rotation => "rotation",
            ModeKind::Arm => "arm",
            ModeKind::Span(_) => "span",
            ModeKind::Mixed => "mixed",
        }
    }

    fn stroke(self) -> Stroke {
        match self {
            ModeKind::Rotation => Stroke::solid(Color::BLACK).with_width(1.2),
            ModeKind::Arm => Stroke::solid(Color::VERMILLION).with_width(1.2),
            ModeKind::Span(_) => Stroke::solid(Color::BLUE),
            ModeKind::Mixed => Stroke::solid(Color::ORANGE),
        }
    }
}

/// A stretch of a mode of one kind; neighbours share a point.
struct Run {
    kind: ModeKind,
    points: Vec<[f64; 2]>,
}

const ORDER: Stroke = Stroke {
    color: Color::GREY,
    width: 0.5,
    dash: Dash::Dashed,
};
const CRITICAL: Stroke = Stroke {
    color: Color::VERMILLION,
    width: 0.8,
    dash: Dash::LongDash,
};
const CROSSING: Marker = Marker {
    shape: Shape::Circle,
    size: 3.4,
    filled: false,
    color: Color::BLACK,
};

/// Draws a Campbell diagram. Curves change colour with the kind of motion; names, spans and orders are written
/// beside them where there is room.
pub fn campbell(input: &Campbell, options: &FigureOptions) -> Figure {
    let speeds = interval(
        &input.speed,
        input.modes.iter().flat_map(|mode| &mode.speed),
        false,
    );
    let frequencies = interval(
        &input.frequency,
        input.modes.iter().flat_map(|mode| &mode.frequency),
        true,
    );
    let runs: Vec<(&CampbellMode, Vec<Run>)> = input.modes.iter().map(|mode| (mode, runs(mode))).collect();
    let mut layers: Vec<Layer> = input
        .orders
        .iter()
        .map(|order| Layer::Line {
            points: speeds
                .map(|speed| [speed, order * input.order_slope * speed])
                .to_vec(),
            stroke: ORDER,
        })
        .collect();
    for run in runs.iter().flat_map(|(_, runs)| runs) {
        layers.push(Layer::Line {
            points: run.points.clone(),
            stroke: run.kind.stroke(),
        });
    }
    if let Some(speed) = input.critical_speed {
        layers.push(Layer::Line {
            points: frequencies.map(|frequency| [speed, frequency]).to_vec(),
            stroke: CRITICAL,
        });
    }
    layers.push(Layer::Points {
        points: input.crossings.clone(),
        marker: CROSSING,
    });
    let mut notes = Vec::new();
    for order in &input.orders {
        notes.push(order_note(*order, order * input.order_slope, speeds, frequencies));
    }
    for (mode, runs) in &runs {
        notes.extend(mode_notes(mode, runs));
    }
    let panel = Panel {
        x: input.speed.clone().with_limits(speeds[0], speeds[1]),
        y: input
            .frequency
            .clone()
            .with_limits(frequencies[0], frequencies[1]),
        layers,
        legend: legend(input, runs.iter().flat_map(|(_, runs)| runs)),
        legend_place: crate::plot::LegendPlace::Above,
        notes,
        ..Panel::default()
    };
    options.figure(vec![vec![panel]], 90.0, 110.0)
}

/// Limits of an axis: its own, or the extent of the data, frequencies from 0.
fn interval<'a>(axis: &Axis, values: impl Iterator<Item = &'a f64>, from_zero: bool) -> [f64; 2] {
    let (low, high) = axis.limits.unwrap_or_else(|| {
        values
            .copied()
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
    });
    let low = if from_zero && axis.limits.is_none() {
        low.min(0.0)
    } else {
        low
    };
    if low.is_finite() && high.is_finite() && low < high {
        // Frequencies leave room for the names of the highest curve.
        let top = if from_zero && axis.limits.is_none() {
            high + 0.05 * (high - low)
        } else {
            high
        };
        [low, top]
    } else {
        [0.0, 1.0]
    }
}

/// Divides a mode where its kind changes.
fn runs(mode: &CampbellMode) -> Vec<Run> {
    let kinds = mode
        .kinds
        .iter()
        .copied()
        .chain(std::iter::repeat(mode.kinds.last().copied().unwrap_or_default()));
    let mut runs: Vec<Run> = Vec::new();
    for ((speed, frequency), kind) in mode.speed.iter().zip(&mode.frequency).zip(kinds) {
        let point = [*speed, *frequency];
        match runs.last_mut() {
            Some(run) if run.kind == kind => run.points.push(point),
            Some(run) => {
                run.points.push(point);
                runs.push(Run {
                    kind,
                    points: vec![point],
                });
            }
            None => runs.push(Run {
                kind,
                points: vec![point],
            }),
        }
    }
    runs
}

fn legend<'a>(input: &Campbell, runs: impl Iterator<Item = &'a Run>) -> Vec<LegendEntry> {
    let names: Vec<&str> = runs.map(|run| run.kind.name()).collect();
    let mut entries: Vec<LegendEntry> = ModeKind::ALL
        .into_iter()
        .filter(|kind| names.contains(&kind.name()))
        .map(|kind| LegendEntry::line(kind.name(), kind.stroke()))
        .collect();
    if !input.orders.is_empty() {
        entries.push(LegendEntry::line("order of excitation", ORDER));
    }
    if !input.crossings.is_empty() {
        entries.push(LegendEntry::marker("resonance", CROSSING));
    }
    if input.critical_speed.is_some() {
        entries.push(LegendEntry::line("critical speed", CRITICAL));
    }
    entries
}

/// The name of an order near the end of its line.
fn order_note(order: f64, slope: f64, speeds: [f64; 2], frequencies: [f64; 2]) -> Note {
    let end = if slope > 0.0 {
        speeds[1].min(frequencies[1] / slope)
    } else {
        speeds[1]
    };
    let anchors = (0..=20)
        .map(|step| end - (0.02 + 0.03 * f64::from(step)) * (end - speeds[0]))
        .map(|speed| [speed, slope * speed])
        .collect();
    Note {
        text: format!("order {}", short(order)),
        anchors,
        place: NotePlace::Beside {
            radius: 0.0,
            // Above its line.
            toward: [-0.3, 1.0],
            reach: 5.5,
        },
    }
}

/// The name of a mode at its start, and the number of the span on every stretch where one vibrates.
fn mode_notes(mode: &CampbellMode, runs: &[Run]) -> Vec<Note> {
    let mut notes = Vec::new();
    for (index, run) in runs.iter().enumerate() {
        let mut words = Vec::new();
        if index == 0 && !mode.name.is_empty() {
            words.push(mode.name.clone());
        }
        if let ModeKind::Span(number) = run.kind {
            words.push(format!("span {number}"));
        }
        if words.is_empty() {
            continue;
        }
        // Points along the stretch from its start, few enough to be searched quickly.
        let stride = run.points.len().div_ceil(40).max(1);
        notes.push(Note {
            text: words.join(": "),
            anchors: run.points.iter().step_by(stride).copied().collect(),
            place: NotePlace::Beside {
                radius: 0.0,
                toward: [0.0, 1.0],
                reach: 3.5,
            },
        });
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_is_divided_where_its_kind_changes() {
        let mode = CampbellMode {
            speed: vec![0.0, 1.0, 2.0, 3.0, 4.0],
            frequency: vec![10.0, 11.0, 12.0, 13.0, 14.0],
            kinds: vec![ModeKind::Rotation, ModeKind::Rotation, ModeKind::Span(2)],
            ..CampbellMode::default()
        };
        let runs = runs(&mode);
        assert_eq!(runs.len(), 2);
        assert_eq!(runs[0].points, [[0.0, 10.0], [1.0, 11.0], [2.0, 12.0]]);
        assert_eq!(runs[1].points, [[2.0, 12.0], [3.0, 13.0], [4.0, 14.0]]);
        assert_eq!(runs[1].kind, ModeKind::Span(2));
    }

    #[test]
    fn an_order_is_named_inside_the_panel() {
        let note = order_note(4.0, 4.0 / 60.0, [600.0, 6000.0], [0.0, 200.0]);
        assert_eq!(note.text, "order 4");
        assert!(note.anchors.iter().all(|at| at[1] <= 200.0 && at[0] <= 3000.0));
    }
}
