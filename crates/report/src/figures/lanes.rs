//! Lanes: named rows with coloured stretches, above or below curves over the same axis.

use super::extent;
use crate::plot::{Axis, Color, Layer, Panel, Strip};

/// Height of a lane, points.
const HEIGHT: f64 = 11.5;
/// Share of its height that a lane keeps free above and below.
const GAP: f64 = 0.16;
/// Shortest stretch, as a share of the axis, that can be seen.
const SHORTEST: f64 = 0.006;

/// A named row.
pub(super) struct Lane<'a> {
    pub name: &'a str,
    pub stretches: Vec<Stretch>,
}

/// A coloured stretch of a lane.
pub(super) struct Stretch {
    pub x: [f64; 2],
    /// The part of the lane's height it takes: 0 is the lower, 1 the upper edge.
    pub height: [f64; 2],
    pub color: Color,
}

/// The height at which the marks of lane `index` of `count` stand: on its upper edge.
pub(super) fn mark_height(index: usize, count: usize) -> f64 {
    (count - index) as f64 - GAP
}

/// A panel of lanes from top to bottom over an axis.
pub(super) fn lane_panel(x: Axis, lanes: &[Lane]) -> Panel {
    let count = lanes.len();
    let base = |index: usize| (count - 1 - index) as f64;
    let strips: Vec<Strip> = lanes
        .iter()
        .enumerate()
        .flat_map(|(index, lane)| {
            lane.stretches.iter().map(move |stretch| Strip {
                x: stretch.x,
                y: stretch
                    .height
                    .map(|share| base(index) + GAP + (1.0 - 2.0 * GAP) * share),
                color: stretch.color,
            })
        })
        .collect();
    let names = lanes
        .iter()
        .enumerate()
        .map(|(index, lane)| (base(index) + 0.5, lane.name.to_string()))
        .collect();
    let mut y = Axis::linear("", "").with_limits(0.0, count.max(1) as f64);
    y.names = names;
    Panel {
        x,
        y,
        layers: vec![Layer::Strips(strips)],
        frame_height: Some(HEIGHT * count.max(1) as f64),
        ..Panel::default()
    }
}

/// Stretches of a value in the interval `within`, the shortest ones widened until they can be seen.
pub(super) fn visible(intervals: &[[f64; 2]], within: [f64; 2]) -> Vec<[f64; 2]> {
    let least = SHORTEST * (within[1] - within[0]);
    intervals
        .iter()
        .filter_map(|interval| extent(interval.iter().copied()))
        .filter(|[from, to]| *to >= within[0] && *from <= within[1])
        .map(|[from, to]| {
            let lacking = (least - (to - from)).max(0.0) / 2.0;
            [(from - lacking).max(within[0]), (to + lacking).min(within[1])]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_point_becomes_a_stretch_inside_the_axis() {
        let shown = visible(&[[5.0, 5.0], [0.0, 0.0], [2.0, 1.0], [11.0, 12.0]], [0.0, 10.0]);
        assert_eq!(shown.len(), 3);
        assert!((shown[0][1] - shown[0][0] - 0.06).abs() < 1e-12);
        assert_eq!((shown[1][0], shown[2]), (0.0, [1.0, 2.0]));
    }

    #[test]
    fn the_first_lane_is_the_upper_one() {
        let lane = |name| Lane {
            name,
            stretches: vec![],
        };
        let panel = lane_panel(Axis::default(), &[lane("clutch"), lane("arm")]);
        assert_eq!(
            panel.y.names,
            [(1.5, "clutch".to_string()), (0.5, "arm".to_string())]
        );
        assert!(mark_height(0, 2) > mark_height(1, 2));
    }
}
