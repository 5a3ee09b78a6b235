//! Where the parts of a figure stand: margins that fit their labels, equal frames, legends beside the data.
//!
//! Margins depend on tick labels, tick labels on the size of the frames, frames on the margins and on the
//! legends above them. The layout therefore starts from a guess and repeats; each round takes microseconds.

use super::aspect;
use super::axis::Range;
use super::chart::{Figure, LegendPlace, Panel};
use super::legend::{self, LegendLayout};
use super::margins;
use super::mark::{Transform, occupy};
use super::occupancy::Occupancy;
use super::style::{LABEL_TYPE, SMALL_TYPE};
use super::svg::Rect;
use super::text;
use super::ticks::{Tick, Ticks, stepped, ticks};
use super::warnings::{self, WarningLayout};

/// Distance between a tick and its label.
pub(super) const TICK_GAP: f64 = 2.0;
/// Distance between tick labels and axis label.
pub(super) const LABEL_GAP: f64 = 3.0;
/// Distance of the lines of a broken label.
pub(super) const LABEL_LINE: f64 = LABEL_TYPE * 1.12;
/// Distance of a colour bar or scale bar from the frame.
pub(super) const BAR_GAP: f64 = 6.0;
/// Width of a colour bar.
pub(super) const BAR_WIDTH: f64 = 6.0;

/// A panel with places for its parts.
pub(super) struct PanelLayout {
    pub transform: Transform,
    pub x_ticks: Ticks,
    pub y_ticks: Ticks,
    /// Lines of the axis labels, and their type size.
    pub x_label: (Vec<String>, f64),
    pub y_label: (Vec<String>, f64),
    /// Whether this panel carries the labels of its x axis.
    pub x_labelled: bool,
    /// Width of the widest y tick label.
    pub y_tick_width: f64,
    pub color_bar: Option<BarLayout>,
    pub legend: Option<LegendLayout>,
    /// Whether the legend stands above the frame.
    pub legend_above: bool,
}

/// Ticks and label of a colour bar.
pub(super) struct BarLayout {
    pub range: Range,
    pub ticks: Ticks,
    pub label: (Vec<String>, f64),
    pub tick_width: f64,
}

/// Places of all panels, by rows, and the height of the page in points.
pub(super) struct FigureLayout {
    pub width: f64,
    pub height: f64,
    /// The legend above all panels.
    pub legend: Option<LegendLayout>,
    pub panels: Vec<Vec<PanelLayout>>,
    /// The warnings below all panels.
    pub warnings: WarningLayout,
}

/// Lays out a figure.
pub(super) fn layout(figure: &Figure) -> FigureLayout {
    const POINTS_PER_MILLIMETRE: f64 = 72.0 / 25.4;
    let height_mm = if figure.height.is_finite() {
        figure.height.clamp(25.0, 1000.0)
    } else {
        60.0
    };
    let width = figure.width.millimetres() * POINTS_PER_MILLIMETRE;
    let height = height_mm * POINTS_PER_MILLIMETRE;
    let panels: Vec<&Panel> = figure.rows.iter().flatten().collect();
    let warnings = warnings::layout(panels.iter().flat_map(|panel| &panel.warnings), width);
    let ranges = ranges(figure);
    let columns = figure.rows.iter().map(Vec::len).max().unwrap_or(0).max(1);
    // A guess of the frames, improved below.
    let guess = Rect {
        x: 0.0,
        y: 0.0,
        width: (width / columns as f64 - 40.0).max(20.0),
        height: (height / figure.rows.len().max(1) as f64 - 30.0).max(20.0),
    };
    let mut frames = vec![guess; panels.len()];
    let mut above: Vec<bool> = panels
        .iter()
        .map(|panel| {
            panel.legend_place == LegendPlace::Above || panel.layers.iter().any(|layer| layer.is_area())
        })
        .collect();
    // Each repetition moves at least one legend above its panel, so there are at most as many as panels.
    loop {
        let mut parts = Vec::new();
        for _ in 0..3 {
            parts = panels
                .iter()
                .zip(&ranges)
                .zip(&frames)
                .enumerate()
                .map(|(index, ((panel, range), frame))| {
                    part(
                        panel,
                        *range,
                        *frame,
                        carries_x_labels(figure, index),
                        above[index],
                    )
                })
                .collect();
            align_labels(figure, &mut parts);
            frames = margins::frames(figure, width, height, &parts);
            for ((part, panel), frame) in parts.iter_mut().zip(&panels).zip(&frames) {
                let Transform { x, y, .. } = part.transform;
                part.transform = transform_of(panel, (x, y), *frame);
            }
        }
        let mut moved_above = false;
        for (index, (part, panel)) in parts.iter_mut().zip(&panels).enumerate() {
            let frame = part.transform.frame;
            if panel.legend.is_empty() {
                continue;
            }
            if above[index] {
                let block = legend::above(&panel.legend, margins::legend_width(panel, &frame));
                let (x, y) = (
                    frame.right() - block.rect().width,
                    frame.y - block.rect().height - 2.5,
                );
                part.legend = Some(legend::moved(block, x, y));
            } else {
                let mut taken = Occupancy::new(frame);
                panel
                    .layers
                    .iter()
                    .for_each(|layer| occupy(layer, &part.transform, &mut taken));
                part.legend = legend::inside(&panel.legend, &frame, &taken);
                if part.legend.is_none() {
                    above[index] = true;
                    moved_above = true;
                }
            }
        }
        if !moved_above {
            let mut parts = parts.into_iter();
            let panels = figure
                .rows
                .iter()
                .map(|row| parts.by_ref().take(row.len()).collect())
                .collect();
            return FigureLayout {
                width,
                height: height + warnings.height(),
                legend: margins::page_legend(figure, width),
                panels,
                warnings: warnings.moved(height),
            };
        }
    }
}

/// Gives the panels of a column the same room for tick labels, so that their axis labels stand in line. Axes with
/// names are apart, since names are wider than numbers.
fn align_labels(figure: &Figure, parts: &mut [PanelLayout]) {
    let panels = figure.rows.iter().flatten();
    let named: Vec<bool> = panels.map(|panel| !panel.y.names.is_empty()).collect();
    for index in 0..parts.len() {
        let column = position(figure, index).1;
        let widest = (0..parts.len())
            .filter(|other| position(figure, *other).1 == column && named[*other] == named[index])
            .map(|other| parts[other].y_tick_width)
            .fold(0.0, f64::max);
        parts[index].y_tick_width = widest;
    }
}

/// Row and column of panel number `index`.
pub(super) fn position(figure: &Figure, index: usize) -> (usize, usize) {
    let mut rest = index;
    for (row, panels) in figure.rows.iter().enumerate() {
        if rest < panels.len() {
            return (row, rest);
        }
        rest -= panels.len();
    }
    (figure.rows.len(), rest)
}

/// Whether no lower panel of a shared column does it instead.
fn carries_x_labels(figure: &Figure, index: usize) -> bool {
    let (row, column) = position(figure, index);
    !figure.share_x
        || figure
            .rows
            .iter()
            .skip(row + 1)
            .all(|panels| panels.len() <= column)
}

/// Intervals of x and y of all panels.
fn ranges(figure: &Figure) -> Vec<(Range, Range)> {
    let mut ranges = Vec::new();
    for (column, panel) in figure.rows.iter().flat_map(|row| row.iter().enumerate()) {
        let sharing: Vec<&Panel> = if figure.share_x {
            figure.rows.iter().filter_map(|row| row.get(column)).collect()
        } else {
            vec![panel]
        };
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for other in &sharing {
            other
                .layers
                .iter()
                .for_each(|layer| layer.extent(&mut |a, _| x.push(a)));
        }
        let is_shown = |value: f64| {
            value.is_nan()
                || panel
                    .x
                    .limits
                    .is_none_or(|(a, b)| value >= a.min(b) && value <= a.max(b))
        };
        panel.layers.iter().for_each(|layer| {
            layer.extent(&mut |a, b| {
                if is_shown(a) {
                    y.push(b);
                }
            });
        });
        let only_points = panel
            .layers
            .iter()
            .all(|layer| layer.is_points() || matches!(layer, super::Layer::Bands { .. }));
        let areas = panel.layers.iter().any(|layer| layer.is_area());
        let stems = panel
            .layers
            .iter()
            .any(|layer| matches!(layer, super::Layer::Stems { .. }));
        let x_margin = if only_points { 0.04 } else { 0.0 };
        let y_margin = if areas { 0.0 } else { 0.06 };
        ranges.push((
            Range::new(&panel.x, x.into_iter(), x_margin, false),
            Range::new(&panel.y, y.into_iter(), y_margin, stems || !only_points),
        ));
    }
    ranges
}

/// The transform of a panel for a frame, with equal scales if the panel wants them.
fn transform_of(panel: &Panel, (x, y): (Range, Range), frame: Rect) -> Transform {
    let (x, y) = if panel.equal_aspect {
        aspect::equal(x, y, &frame)
    } else {
        (x, y)
    };
    Transform { frame, x, y }
}

/// Ticks and labels of a panel for a frame.
fn part(panel: &Panel, ranges: (Range, Range), frame: Rect, x_labelled: bool, above: bool) -> PanelLayout {
    let transform = transform_of(panel, ranges, frame);
    let (mut x_ticks, mut y_ticks) = (
        panel
            .x
            .step
            .and_then(|step| stepped(&transform.x, step, (frame.width / 22.0) as usize))
            .unwrap_or_else(|| horizontal_ticks(&transform.x, frame.width)),
        panel
            .y
            .step
            .and_then(|step| stepped(&transform.y, step, (frame.height / 9.0) as usize))
            .unwrap_or_else(|| vertical_ticks(&transform.y, frame.height)),
    );
    if !panel.x.names.is_empty() {
        x_ticks = named(&panel.x.names, &transform.x);
    }
    if !panel.y.names.is_empty() {
        y_ticks = named(&panel.y.names, &transform.y);
    }
    let (mut x_text, mut y_text) = (panel.x.text(x_ticks.exponent), panel.y.text(y_ticks.exponent));
    if panel.bare {
        (x_ticks, y_ticks) = (Ticks::default(), Ticks::default());
        (x_text, y_text) = (String::new(), String::new());
    }
    let y_tick_width = widest(&y_ticks);
    let x_room = frame.width + 16.0;
    PanelLayout {
        x_label: fit(&x_text, x_room),
        y_label: fit(&y_text, frame.height + 4.0),
        x_labelled,
        y_tick_width,
        color_bar: panel.color_bar.as_ref().map(|bar| {
            let range = Range::new(&bar.axis, std::iter::empty(), 0.0, false);
            let ticks = vertical_ticks(&range, frame.height);
            let label = fit(&bar.axis.text(ticks.exponent), frame.height + 4.0);
            BarLayout {
                range,
                tick_width: widest(&ticks),
                ticks,
                label,
            }
        }),
        legend: None,
        legend_above: above,
        transform,
        x_ticks,
        y_ticks,
    }
}

/// Lines of a label and the type size at which they fit.
fn fit(label: &str, room: f64) -> (Vec<String>, f64) {
    let lines = if label.is_empty() {
        Vec::new()
    } else {
        text::lines(label, LABEL_TYPE, room)
    };
    let size = text::fitting_size(lines.iter().map(String::as_str), LABEL_TYPE, room);
    (lines, size)
}

fn widest(ticks: &Ticks) -> f64 {
    ticks
        .major
        .iter()
        .map(|tick| text::width(&tick.label, SMALL_TYPE))
        .fold(0.0, f64::max)
}

/// Ticks at values with names, in ascending order; a long name is cut.
fn named(names: &[(f64, String)], range: &Range) -> Ticks {
    /// Widest name, points: the data needs the rest.
    const WIDEST: f64 = 72.0;
    let mut major: Vec<Tick> = names
        .iter()
        .filter(|(value, _)| range.contains(*value))
        .map(|(value, name)| Tick {
            value: *value,
            label: text::shortened(name, SMALL_TYPE, WIDEST),
        })
        .collect();
    major.sort_by(|a, b| a.value.total_cmp(&b.value));
    Ticks {
        major,
        ..Ticks::default()
    }
}

/// As many ticks as leave room between their labels.
fn horizontal_ticks(range: &Range, width: f64) -> Ticks {
    const SPACE: f64 = 7.0;
    let largest = ((width / 26.0) as usize).clamp(2, 9);
    let fits = |candidate: &Ticks| {
        let mut end = f64::NEG_INFINITY;
        candidate.major.iter().all(|tick| {
            let half = text::width(&tick.label, SMALL_TYPE) / 2.0;
            let at = range.fraction(tick.value).unwrap_or(0.0) * width;
            let free = at - half >= end + SPACE;
            end = at + half;
            free
        })
    };
    let mut last = Ticks::default();
    for count in (2..=largest).rev() {
        last = ticks(range, count);
        if fits(&last) {
            return last;
        }
    }
    thin(&mut last, |tick| {
        let half = text::width(&tick.label, SMALL_TYPE) / 2.0 + SPACE / 2.0;
        let at = range.fraction(tick.value).unwrap_or(0.0) * width;
        (at - half, at + half)
    });
    last
}

/// As many ticks as leave room between their labels.
fn vertical_ticks(range: &Range, height: f64) -> Ticks {
    let mut ticks = ticks(range, ((height / 20.0) as usize).clamp(2, 8));
    thin(&mut ticks, |tick| {
        let at = range.fraction(tick.value).unwrap_or(0.0) * height;
        (at - 0.6 * SMALL_TYPE, at + 0.6 * SMALL_TYPE)
    });
    ticks
}

/// Turns ticks whose label would touch the label before into minor ones.
fn thin(ticks: &mut Ticks, interval: impl Fn(&super::Tick) -> (f64, f64)) {
    let mut end = f64::NEG_INFINITY;
    let mut dropped = Vec::new();
    ticks.major.retain(|tick| {
        let (from, to) = interval(tick);
        let kept = from >= end;
        if kept {
            end = to;
        } else {
            dropped.push(tick.value);
        }
        kept
    });
    ticks.minor.extend(dropped);
}
