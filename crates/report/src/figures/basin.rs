//! Basins of attraction: the attractor that each cell of a grid of initial states leads to.

use super::FigureOptions;
use crate::plot::{
    Axis, Color, Figure, HeatMap, Layer, LegendEntry, LegendPlace, Marker, Panel, Shape, category_color,
};

/// Input of [`basin`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Basin {
    /// First initial coordinate.
    pub x: Axis,
    /// Second initial coordinate.
    pub y: Axis,
    /// First and last grid value in x, the centres of the outer cells.
    pub x_centres: [f64; 2],
    /// First and last grid value in y, the centres of the outer cells.
    pub y_centres: [f64; 2],
    /// Number of cells in x.
    pub columns: usize,
    /// Attractor of each cell by rows, from the lowest y, each row from the lowest x; `None` for a cell that
    /// led to no known attractor, drawn white.
    pub cells: Vec<Option<usize>>,
    /// Names of the attractors.
    pub attractors: Vec<String>,
    /// Section points of the attractors, drawn on the map.
    pub points: Vec<[f64; 2]>,
}

/// Draws a map of basins with its legend.
pub fn basin(input: &Basin, options: &FigureOptions) -> Figure {
    let rows = input.cells.len().checked_div(input.columns).unwrap_or(0);
    let mut panel = Panel {
        x: input.x.clone(),
        y: input.y.clone(),
        legend: input
            .attractors
            .iter()
            .enumerate()
            .map(|(index, name)| LegendEntry::fill(name, category_color(index)))
            .collect(),
        legend_place: LegendPlace::Above,
        ..Panel::default()
    };
    if rows > 0 {
        let cells = input.cells[..rows * input.columns].iter();
        panel.layers.push(Layer::HeatMap(HeatMap {
            x: outer_edges(input.x_centres, input.columns),
            y: outer_edges(input.y_centres, rows),
            columns: input.columns,
            cells: cells
                .map(|cell| cell.map_or(Color::WHITE, category_color))
                .collect(),
        }));
    }
    if input.cells.contains(&None) {
        panel
            .legend
            .push(LegendEntry::fill("not classified", Color::WHITE));
    }
    if !input.points.is_empty() {
        let marker = Marker::open(Shape::Circle, 3.6, Color::BLACK);
        panel.layers.push(Layer::Points {
            points: input.points.clone(),
            marker,
        });
        panel.legend.push(LegendEntry::marker("attractor", marker));
    }
    options.figure(vec![vec![panel]], 75.0, 100.0)
}

/// Edges half a cell outside the centres of the outer cells.
fn outer_edges([first, last]: [f64; 2], count: usize) -> [f64; 2] {
    let cell = if count > 1 {
        (last - first) / (count - 1) as f64
    } else {
        1.0
    };
    [first - cell / 2.0, last + cell / 2.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_lie_around_their_centres() {
        assert_eq!(outer_edges([0.0, 1.0], 11), [-0.05, 1.05]);
        assert_eq!(outer_edges([2.0, 2.0], 1), [1.5, 2.5]);
    }
}
