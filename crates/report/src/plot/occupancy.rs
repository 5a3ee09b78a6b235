//! Which parts of a panel carry data: a coarse grid that answers whether a box is free.

use super::svg::Rect;

/// Side of a grid cell, points.
const CELL: f64 = 1.5;

/// Grid over a rectangle of the page.
pub(super) struct Occupancy {
    rect: Rect,
    columns: usize,
    rows: usize,
    taken: Vec<bool>,
}

impl Occupancy {
    /// A free grid over `rect`.
    pub fn new(rect: Rect) -> Self {
        let columns = (rect.width / CELL).ceil().max(1.0) as usize;
        let rows = (rect.height / CELL).ceil().max(1.0) as usize;
        Occupancy {
            rect,
            columns,
            rows,
            taken: vec![false; columns * rows],
        }
    }

    /// Marks the surroundings of a point, a square of half side `reach`.
    pub fn mark_point(&mut self, point: [f64; 2], reach: f64) {
        self.mark_rect(Rect {
            x: point[0] - reach,
            y: point[1] - reach,
            width: 2.0 * reach,
            height: 2.0 * reach,
        });
    }

    /// Marks a straight line.
    pub fn mark_line(&mut self, from: [f64; 2], to: [f64; 2]) {
        for at in self.along(from, to) {
            self.mark_point(at, 0.0);
        }
    }

    /// Marks a straight line of a width; what a thin one covers is within the accuracy of the grid.
    pub fn mark_stroke(&mut self, from: [f64; 2], to: [f64; 2], width: f64) {
        let reach = if width > 1.0 { width / 2.0 } else { 0.0 };
        for at in self.along(from, to) {
            self.mark_point(at, reach);
        }
    }

    /// Whether a straight line touches no marked cell.
    pub fn is_line_clear(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        !self.along(from, to).any(|at| self.is_taken(at))
    }

    /// Whether a point lies in a marked cell.
    fn is_taken(&self, point: [f64; 2]) -> bool {
        let (x, y) = (point[0] - self.rect.x, point[1] - self.rect.y);
        let cell = |value: f64, count: usize| ((value / CELL).max(0.0) as usize).min(count - 1);
        self.taken[cell(y, self.rows) * self.columns + cell(x, self.columns)]
    }

    /// Length of the part of a straight line that lies in marked cells, points.
    pub fn length_taken(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let (mut taken, mut all) = (0.0, 0.0);
        for at in self.along(from, to) {
            all += 1.0;
            taken += f64::from(u8::from(self.is_taken(at)));
        }
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        if all > 0.0 { length * taken / all } else { 0.0 }
    }

    /// Points of the part of a line inside the grid, closer than a cell.
    fn along(&self, from: [f64; 2], to: [f64; 2]) -> impl Iterator<Item = [f64; 2]> + use<> {
        let inside = clip(from, to, &self.rect);
        inside.into_iter().flat_map(|(from, to)| {
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let steps = (dx.hypot(dy) / (0.7 * CELL)).ceil().max(1.0) as usize;
            (0..=steps)
                .map(move |step| step as f64 / steps as f64)
                .map(move |t| [from[0] + t * dx, from[1] + t * dy])
        })
    }

    /// Marks the outline of a polygon and what it encloses.
    pub fn mark_area(&mut self, outline: &[[f64; 2]]) {
        let edges = || {
            outline
                .iter()
                .zip(outline.iter().skip(1).chain(outline.first()))
                .map(|(from, to)| (*from, *to))
        };
        for (from, to) in edges() {
            self.mark_line(from, to);
        }
        for row in 0..self.rows {
            let y = self.rect.y + (row as f64 + 0.5) * CELL;
            let mut crossings: Vec<f64> = edges()
                .filter(|(from, to)| (from[1] <= y) != (to[1] <= y))
                .map(|(from, to)| from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]))
                .collect();
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                self.mark_rect(Rect {
                    x: pair[0],
                    y,
                    width: pair[1] - pair[0],
                    height: 0.0,
                });
            }
        }
    }

    /// Marks all cells a rectangle touches.
    pub fn mark_rect(&mut self, rect: Rect) {
        let Some((columns, rows)) = self.cells(&rect) else {
            return;
        };
        for row in rows {
            for column in columns.clone() {
                self.taken[row * self.columns + column] = true;
            }
        }
    }

    /// Whether a rectangle lies inside the grid and touches no marked cell.
    pub fn is_free(&self, rect: &Rect) -> bool {
        rect.x >= self.rect.x
            && rect.y >= self.rect.y
            && rect.right() <= self.rect.right()
            && rect.bottom() <= self.rect.bottom()
            && self.is_clear(rect)
    }

    /// Whether a rectangle touches no marked cell; it may reach out of the grid.
    pub fn is_clear(&self, rect: &Rect) -> bool {
        self.cells(rect).is_none_or(|(columns, mut rows)| {
            rows.all(|row| {
                columns
                    .clone()
                    .all(|column| !self.taken[row * self.columns + column])
            })
        })
    }

    /// Columns and rows of the cells that a rectangle touches; `None` if it lies outside.
    fn cells(
        &self,
        rect: &Rect,
    ) -> Option<(std::ops::RangeInclusive<usize>, std::ops::RangeInclusive<usize>)> {
        let index = |value: f64, count: usize| ((value / CELL).floor().max(0.0) as usize).min(count - 1);
        let (left, right) = (rect.x - self.rect.x, rect.right() - self.rect.x);
        let (top, bottom) = (rect.y - self.rect.y, rect.bottom() - self.rect.y);
        let outside = right < 0.0 || bottom < 0.0 || left > self.rect.width || top > self.rect.height;
        if outside || !(left + right + top + bottom).is_finite() {
            return None;
        }
        Some((
            index(left, self.columns)..=index(right, self.columns),
            index(top, self.rows)..=index(bottom, self.rows),
        ))
    }
}

/// The part of a line inside a rectangle (Liang and Barsky).
pub(super) fn clip(from: [f64; 2], to: [f64; 2], rect: &Rect) -> Option<([f64; 2], [f64; 2])> {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let edges = [
        (-dx, from[0] - rect.x),
        (dx, rect.right() - from[0]),
        (-dy, from[1] - rect.y),
        (dy, rect.bottom() - from[1]),
    ];
    for (rate, distance) in edges {
        if rate == 0.0 {
            if distance < 0.0 {
                return None;
            }
        } else if rate < 0.0 {
            enter = enter.max(distance / rate);
        } else {
            leave = leave.min(distance / rate);
        }
    }
    let at = |t: f64| [from[0] + t * dx, from[1] + t * dy];
    (enter <= leave).then(|| (at(enter), at(leave)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: Rect = Rect {
        x: 10.0,
        y: 20.0,
        width: 100.0,
        height: 60.0,
    };

    #[test]
    fn a_line_blocks_boxes_on_it_and_no_others() {
        let mut grid = Occupancy::new(PAGE);
        grid.mark_line([-1e5, -1e5], [1e5, 1e5]);
        assert!(!grid.is_free(&Rect {
            x: 28.0,
            y: 28.0,
            width: 4.0,
            height: 4.0
        }));
        assert!(grid.is_free(&Rect {
            x: 80.0,
            y: 25.0,
            width: 25.0,
            height: 10.0
        }));
        assert!(
            !grid.is_free(&Rect {
                x: 90.0,
                y: 25.0,
                width: 25.0,
                height: 10.0
            }),
            "leaves the panel"
        );
    }

    #[test]
    fn an_area_blocks_its_inside_and_not_its_surroundings() {
        let mut grid = Occupancy::new(PAGE);
        grid.mark_area(&[[30.0, 30.0], [80.0, 30.0], [80.0, 70.0], [30.0, 70.0]]);
        let square = |x, y| Rect {
            x,
            y,
            width: 5.0,
            height: 5.0,
        };
        assert!(!grid.is_free(&square(50.0, 50.0)));
        assert!(grid.is_free(&square(20.0, 50.0)) && grid.is_free(&square(85.0, 50.0)));
        assert!(!grid.is_line_clear([15.0, 50.0], [100.0, 50.0]));
        assert!(grid.is_line_clear([15.0, 25.0], [100.0, 25.0]));
    }

    #[test]
    fn lines_are_clipped() {
        let (a, b) = clip([0.0, 50.0], [160.0, 50.0], &PAGE).unwrap();
        assert_eq!(
            (a[0].round(), b[0].round(), a[1], b[1]),
            (10.0, 110.0, 50.0, 50.0)
        );
        assert!(clip([0.0, 0.0], [200.0, 0.0], &PAGE).is_none());
        assert!(clip([0.0, 0.0], [0.0, 0.0], &PAGE).is_none());
    }
}
