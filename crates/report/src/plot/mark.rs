//! From data to the page: the transform of a panel, polylines and markers as path data, and the marking of the
//! places that data occupies.

use std::fmt::Write;

use super::arrow;
use super::axis::Range;
use super::occupancy::{Occupancy, clip};
use super::series::Layer;
use super::style::{Marker, Shape};
use super::svg::{Rect, number};

/// Coordinates beyond this distance, points, are drawn as if at it.
const FAR: f64 = 1e7;
/// Vertices closer than this to the one before, points, are left out.
const INVISIBLE: f64 = 0.05;

/// Maps data to the page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Transform {
    pub frame: Rect,
    pub x: Range,
    pub y: Range,
}

impl Transform {
    /// Horizontal position of `x` on the page.
    pub fn x(&self, x: f64) -> Option<f64> {
        self.x
            .fraction(x)
            .map(|f| (self.frame.x + f * self.frame.width).clamp(-FAR, FAR))
    }

    /// Vertical position of `y` on the page.
    pub fn y(&self, y: f64) -> Option<f64> {
        self.y
            .fraction(y)
            .map(|f| (self.frame.bottom() - f * self.frame.height).clamp(-FAR, FAR))
    }

    /// Position of a point on the page; `None` where it cannot be drawn.
    pub fn point(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x(point[0])?, self.y(point[1])?])
    }

    /// Whether a data point lies inside the panel.
    pub fn shows(&self, point: [f64; 2]) -> bool {
        self.x.contains(point[0]) && self.y.contains(point[1])
    }

    /// The rectangle of two data intervals, cut to the panel; `None` when nothing remains.
    pub fn rect(&self, x: [f64; 2], y: [f64; 2]) -> Option<Rect> {
        let (a, b) = (self.x(x[0])?, self.x(x[1])?);
        let (c, d) = (self.y(y[0])?, self.y(y[1])?);
        let left = a.min(b).max(self.frame.x);
        let right = a.max(b).min(self.frame.right());
        let top = c.min(d).max(self.frame.y);
        let bottom = c.max(d).min(self.frame.bottom());
        (right > left && bottom > top).then_some(Rect {
            x: left,
            y: top,
            width: right - left,
            height: bottom - top,
        })
    }

    /// The uninterrupted parts of a polyline on the page, without vertices too close to be seen.
    pub fn polylines(&self, points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut part: Vec<[f64; 2]> = Vec::new();
        let mut skipped: Option<[f64; 2]> = None;
        let mut close = |part: &mut Vec<[f64; 2]>, skipped: &mut Option<[f64; 2]>| {
            part.extend(skipped.take());
            if !part.is_empty() {
                parts.push(std::mem::take(part));
            }
        };
        for point in points {
            match self.point(*point) {
                None => close(&mut part, &mut skipped),
                Some(at) => {
                    let near = part
                        .last()
                        .is_some_and(|last| (at[0] - last[0]).hypot(at[1] - last[1]) < INVISIBLE);
                    if near {
                        skipped = Some(at);
                    } else {
                        skipped = None;
                        part.push(at);
                    }
                }
            }
        }
        close(&mut part, &mut skipped);
        parts
            .into_iter()
            .map(|part| without_hidden(part, &self.frame))
            .collect()
    }
}

/// Leaves out vertices of a dense oscillation that no reader could see: of a line that runs to the right with
/// very many vertices, each narrow column keeps its first, lowest, highest and last.
fn without_hidden(part: Vec<[f64; 2]>, frame: &Rect) -> Vec<[f64; 2]> {
    /// Width of a column, points: one pixel at 360 pixels per inch.
    const COLUMN: f64 = 0.2;
    let many = part.len() as f64 > 4.0 * frame.width / COLUMN;
    if !many || part.windows(2).any(|pair| pair[1][0] < pair[0][0]) {
        return part;
    }
    let mut kept = Vec::new();
    for column in part.chunk_by(|a, b| (a[0] / COLUMN).floor() == (b[0] / COLUMN).floor()) {
        let by_height = |a: &(usize, &[f64; 2]), b: &(usize, &[f64; 2])| a.1[1].total_cmp(&b.1[1]);
        let mut indices = [0, 0, 0, column.len() - 1];
        if let Some((lowest, _)) = column.iter().enumerate().min_by(by_height) {
            indices[1] = lowest;
        }
        if let Some((highest, _)) = column.iter().enumerate().max_by(by_height) {
            indices[2] = highest;
        }
        indices.sort_unstable();
        let mut before = None;
        for index in indices {
            if before != Some(index) {
                kept.push(column[index]);
            }
            before = Some(index);
        }
    }
    kept
}

/// Path data of polylines, one subpath for each part inside the frame, so that a dash pattern runs along the
/// whole curve. A lone vertex becomes a dot.
pub(super) fn line_path(parts: &[Vec<[f64; 2]>], frame: &Rect) -> String {
    let visible = frame.grown(10.0);
    let mut data = String::new();
    for part in parts {
        if let [lone] = part.as_slice() {
            if clip(*lone, *lone, &visible).is_some() {
                let _ = write!(data, "M{} {}h0.9", number(lone[0] - 0.45), number(lone[1]));
            }
            continue;
        }
        let mut pen: Option<[f64; 2]> = None;
        for pair in part.windows(2) {
            let Some((from, to)) = clip(pair[0], pair[1], &visible) else {
                pen = None;
                continue;
            };
            if pen != Some(from) {
                let _ = write!(data, "M{} {}", number(from[0]), number(from[1]));
            }
            let _ = write!(data, "L{} {}", number(to[0]), number(to[1]));
            pen = Some(to);
        }
    }
    data
}

/// Path data of one marker at a position on the page.
pub(super) fn marker_path(marker: &Marker, at: [f64; 2]) -> String {
    let (x, y, r) = (at[0], at[1], marker.size / 2.0);
    let polygon = |corners: &[(f64, f64)]| {
        let points: Vec<String> = corners
            .iter()
            .map(|(dx, dy)| format!("{} {}", number(x + dx * r), number(y + dy * r)))
            .collect();
        format!("M{}Z", points.join("L"))
    };
    let strokes = |strokes: &[(f64, f64)]| {
        strokes.iter().fold(String::new(), |mut data, (dx, dy)| {
            let _ = write!(
                data,
                "M{} {}L{} {}",
                number(x - dx * r),
                number(y - dy * r),
                number(x + dx * r),
                number(y + dy * r)
            );
            data
        })
    };
    match marker.shape {
        Shape::Circle => format!(
            "M{} {}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0Z",
            number(x - r),
            number(y),
            r = number(r),
            d = number(2.0 * r)
        ),
        Shape::Square => polygon(&[(-0.89, -0.89), (0.89, -0.89), (0.89, 0.89), (-0.89, 0.89)]),
        Shape::Diamond => polygon(&[(0.0, -1.2), (1.2, 0.0), (0.0, 1.2), (-1.2, 0.0)]),
        Shape::TriangleUp => polygon(&[(0.0, -1.2), (1.08, 0.8), (-1.08, 0.8)]),
        Shape::TriangleDown => polygon(&[(0.0, 1.2), (1.08, -0.8), (-1.08, -0.8)]),
        Shape::Plus => strokes(&[(1.1, 0.0), (0.0, 1.1)]),
        Shape::Cross => strokes(&[(0.85, 0.85), (0.85, -0.85)]),
        Shape::Asterisk => strokes(&[(0.0, 1.15), (1.0, 0.58), (1.0, -0.58)]),
    }
}

/// Marks what a layer covers.
pub(super) fn occupy(layer: &Layer, transform: &Transform, grid: &mut Occupancy) {
    match layer {
        Layer::Line { points, stroke }
        | Layer::CoveringLine { points, stroke, .. }
        | Layer::Arrow { points, stroke, .. } => {
            for part in transform.polylines(points) {
                part.iter().take(1).for_each(|at| grid.mark_point(*at, 0.5));
                part.windows(2)
                    .for_each(|pair| grid.mark_stroke(pair[0], pair[1], stroke.width));
                if let Layer::Arrow { head, .. } = layer
                    && let Some(arrow) = arrow::on_page(&part, *head)
                {
                    grid.mark_area(&arrow.head);
                }
            }
        }
        Layer::Area { points, .. } => {
            for part in transform.polylines(points) {
                grid.mark_area(&part);
            }
        }
        Layer::Stems { points, base, .. } => {
            let foot = transform.y(*base).unwrap_or(transform.frame.bottom());
            for at in points.iter().filter_map(|point| transform.point(*point)) {
                grid.mark_line([at[0], foot], at);
            }
        }
        Layer::Points { points, marker } => {
            for at in points.iter().filter_map(|point| transform.point(*point)) {
                grid.mark_point(at, marker.size / 2.0 + 0.5);
            }
        }
        // A legend may stand on a shaded interval, but not on areas that carry the result.
        Layer::Bands { .. } => {}
        Layer::Uprights { x, stroke } => {
            for x in x.iter().filter_map(|x| transform.x(*x)) {
                let (top, bottom) = (transform.frame.y, transform.frame.bottom());
                grid.mark_stroke([x, top], [x, bottom], stroke.width);
            }
        }
        Layer::Strips(_) | Layer::HeatMap(_) => grid.mark_rect(transform.frame),
        Layer::Outline { x, y, .. } => {
            let corners = [
                [x[0], y[0]],
                [x[1], y[0]],
                [x[1], y[1]],
                [x[0], y[1]],
                [x[0], y[0]],
            ];
            for part in transform.polylines(&corners) {
                part.windows(2).for_each(|pair| grid.mark_line(pair[0], pair[1]));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::axis::Scale;

    fn transform() -> Transform {
        let unit = Range {
            low: 0.0,
            high: 1.0,
            scale: Scale::Linear,
        };
        Transform {
            frame: Rect {
                x: 0.0,
                y: 0.0,
                width: 100.0,
                height: 100.0,
            },
            x: unit,
            y: unit,
        }
    }

    #[test]
    fn missing_values_interrupt_a_line() {
        let points = [
            [0.0, 0.0],
            [0.1, 0.1],
            [f64::NAN, 0.2],
            [0.3, 0.3],
            [0.4, f64::INFINITY],
            [0.5, 0.5],
        ];
        let parts = transform().polylines(&points);
        assert_eq!(parts.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1, 1]);
    }

    #[test]
    fn dense_points_are_thinned_and_the_last_is_kept() {
        let points: Vec<[f64; 2]> = (0..=100_000).map(|i| [f64::from(i) / 1e5, 0.5]).collect();
        let parts = transform().polylines(&points);
        assert!(parts[0].len() < 2100);
        assert_eq!(parts[0].last(), Some(&[100.0, 50.0]));
    }

    #[test]
    fn a_dense_oscillation_keeps_its_envelope() {
        let points: Vec<[f64; 2]> = (0..=200_000)
            .map(|i| f64::from(i) / 200_000.0)
            .map(|x| [x, 0.5 + 0.4 * (20_000.0 * x).sin()])
            .collect();
        let part = transform().polylines(&points).remove(0);
        assert!(part.len() <= 4 * 501, "{}", part.len());
        let highest = part.iter().map(|at| at[1]).fold(0.0, f64::max);
        let lowest = part.iter().map(|at| at[1]).fold(100.0, f64::min);
        assert!((highest - 90.0).abs() < 0.1 && (lowest - 10.0).abs() < 0.1);
    }

    #[test]
    fn a_connected_curve_is_one_subpath_and_far_points_keep_the_slope() {
        let parts = transform().polylines(&[[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]]);
        assert_eq!(line_path(&parts, &transform().frame).matches('M').count(), 1);
        let steep = transform().polylines(&[[0.0, 0.0], [1000.0, 1000.0]]);
        let path = line_path(&steep, &transform().frame);
        assert_eq!(path, "M0 100L110 -10");
    }
}
