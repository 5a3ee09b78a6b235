//! Legends: their size, where they stand, and their drawing.

use super::chart::LegendEntry;
use super::mark::marker_path;
use super::occupancy::Occupancy;
use super::style::{Dash, SMALL_TYPE, Stroke};
use super::svg::{Anchor, Rect, Svg};
use super::text;
use super::{Color, draw};

/// Width of a line sample, points.
const SAMPLE: f64 = 17.0;
/// Distance between sample and text.
const GAP: f64 = 4.0;
/// Distance between columns.
const COLUMN_GAP: f64 = 9.0;
/// Distance of base lines.
const LINE: f64 = 9.4;
/// Distance of the entries from the edge of a legend inside the panel.
const INSET: f64 = 3.0;

/// A legend with a place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LegendLayout {
    rect: Rect,
    columns: Vec<f64>,
    rows: usize,
    size: f64,
    inside: bool,
}

impl LegendLayout {
    /// The area the legend covers.
    pub fn rect(&self) -> Rect {
        self.rect
    }
}

/// Widths of `count` columns filled from top to bottom.
fn column_widths(entries: &[LegendEntry], count: usize, size: f64) -> (Vec<f64>, usize) {
    let rows = entries.len().div_ceil(count.max(1)).max(1);
    let widths = entries
        .chunks(rows)
        .map(|column| {
            let widest = column
                .iter()
                .map(|entry| text::width(&entry.text, size))
                .fold(0.0, f64::max);
            SAMPLE + GAP + widest
        })
        .collect();
    (widths, rows)
}

fn total(columns: &[f64]) -> f64 {
    columns.iter().sum::<f64>() + COLUMN_GAP * columns.len().saturating_sub(1) as f64
}

/// The legend of a panel above its frame: as many columns as fit into `width`. The rectangle starts at the
/// origin.
pub(super) fn above(entries: &[LegendEntry], width: f64) -> LegendLayout {
    let limit = (width - SAMPLE - GAP).max(10.0);
    let size = text::fitting_size(entries.iter().map(|entry| entry.text.as_str()), SMALL_TYPE, limit);
    let (columns, rows) = (1..=entries.len())
        .rev()
        .map(|count| column_widths(entries, count, size))
        .find(|(columns, _)| total(columns) <= width)
        .unwrap_or_else(|| column_widths(entries, 1, size));
    let rect = Rect {
        x: 0.0,
        y: 0.0,
        width: total(&columns),
        height: rows as f64 * LINE,
    };
    LegendLayout {
        rect,
        columns,
        rows,
        size,
        inside: false,
    }
}

/// The same legend with its upper left corner at another place.
pub(super) fn moved(legend: LegendLayout, x: f64, y: f64) -> LegendLayout {
    LegendLayout {
        rect: Rect { x, y, ..legend.rect },
        ..legend
    }
}

/// A place for the legend inside the frame where nothing is drawn, or `None`. Corners come first.
pub(super) fn inside(entries: &[LegendEntry], frame: &Rect, taken: &Occupancy) -> Option<LegendLayout> {
    const MARGIN: f64 = 4.0;
    let counts: &[usize] = if entries.len() >= 4 { &[1, 2] } else { &[1] };
    for count in counts {
        let (columns, rows) = column_widths(entries, *count, SMALL_TYPE);
        let width = total(&columns) + 2.0 * INSET;
        let height = rows as f64 * LINE + 2.0 * INSET - 2.0;
        let (room_x, room_y) = (
            frame.width - width - 2.0 * MARGIN,
            frame.height - height - 2.0 * MARGIN,
        );
        // A legend that fills the panel squeezes the data; it stands better above.
        if room_x < 0.0 || room_y < 0.0 || width * height > 0.35 * frame.width * frame.height {
            continue;
        }
        // Right, left, then the middle; upper, lower, then the middle.
        let across = [1.0, 0.0, 0.5, 0.75, 0.25, 0.875, 0.125, 0.625, 0.375];
        let down = [0.0, 1.0, 0.5, 0.25, 0.75, 0.125];
        for y in down {
            for x in across {
                let rect = Rect {
                    x: frame.x + MARGIN + x * room_x,
                    y: frame.y + MARGIN + y * room_y,
                    width,
                    height,
                };
                if taken.is_free(&rect.grown(1.5)) {
                    return Some(LegendLayout {
                        rect,
                        columns,
                        rows,
                        size: SMALL_TYPE,
                        inside: true,
                    });
                }
            }
        }
    }
    None
}

/// Draws a legend.
pub(super) fn draw(svg: &mut Svg, layout: &LegendLayout, entries: &[LegendEntry]) {
    let inset = if layout.inside { INSET } else { 0.0 };
    if layout.inside {
        svg.fill_rect(layout.rect, Color::WHITE);
    }
    let mut left = layout.rect.x + inset;
    for (column, width) in entries.chunks(layout.rows).zip(&layout.columns) {
        for (row, entry) in column.iter().enumerate() {
            let middle =
                layout.rect.y + inset - if layout.inside { 1.0 } else { 0.0 } + (row as f64 + 0.5) * LINE;
            sample(svg, entry, left, middle);
            let base = middle + 0.36 * layout.size;
            svg.text(left + SAMPLE + GAP, base, layout.size, Anchor::Start, &entry.text);
        }
        left += width + COLUMN_GAP;
    }
}

fn sample(svg: &mut Svg, entry: &LegendEntry, left: f64, middle: f64) {
    if let Some(color) = entry.fill {
        let rect = Rect {
            x: left + 3.0,
            y: middle - 3.0,
            width: SAMPLE - 6.0,
            height: 6.0,
        };
        svg.fill_rect(rect, color);
        svg.stroke_rect(
            rect,
            Stroke {
                color: Color::GREY,
                width: 0.3,
                dash: Dash::Solid,
            },
        );
    }
    if let Some(stroke) = entry.stroke {
        let data = format!("M{:.2} {middle:.2}h{SAMPLE}", left);
        svg.path(&data, Some(stroke), None);
    }
    if let Some(marker) = entry.marker {
        draw::markers(svg, &marker, &marker_path(&marker, [left + SAMPLE / 2.0, middle]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(count: usize) -> Vec<LegendEntry> {
        (0..count)
            .map(|i| LegendEntry::line(format!("K_{{d}} = {i}"), Stroke::solid(Color::BLACK)))
            .collect()
    }

    const FRAME: Rect = Rect {
        x: 30.0,
        y: 10.0,
        width: 200.0,
        height: 120.0,
    };

    #[test]
    fn a_legend_takes_the_free_corner() {
        let mut grid = Occupancy::new(FRAME);
        grid.mark_rect(Rect {
            x: 130.0,
            y: 10.0,
            width: 100.0,
            height: 120.0,
        });
        let layout = inside(&entries(2), &FRAME, &grid).unwrap();
        assert!(layout.rect.right() < 130.0);
        grid.mark_rect(FRAME);
        assert!(inside(&entries(2), &FRAME, &grid).is_none());
    }

    #[test]
    fn a_legend_above_uses_the_width() {
        let legend = above(&entries(9), 200.0);
        assert!(legend.columns.len() > 1 && legend.rect.width <= 200.0);
        let long = vec![LegendEntry::line(
            "a very long name of a curve ".repeat(5),
            Stroke::solid(Color::BLACK),
        )];
        assert!(above(&long, 200.0).rect.width <= 200.0 + 1e-9);
    }
}
