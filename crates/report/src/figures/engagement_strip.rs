//! Engagement strips: for each value of a parameter, when within a period the clutch is engaged.

use super::FigureOptions;
use crate::plot::{Axis, Color, Figure, Layer, LegendEntry, LegendPlace, Panel, Strip};

/// Input of [`engagement_strip`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EngagementStrip {
    /// The phase within the period, from 0 to 1.
    pub phase: Axis,
    /// The quantity that the rows differ in, for example the excitation frequency.
    pub row: Axis,
    /// The rows, in any order.
    pub rows: Vec<EngagementRow>,
}

/// The engagement within one period.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EngagementRow {
    /// Value of the row's quantity.
    pub value: f64,
    /// Intervals of the phase in which the clutch is engaged, fractions of the period; an interval may run
    /// past 1, or backwards, into the next period.
    pub engaged: Vec<[f64; 2]>,
}

/// A clutch that transmits torque.
pub(super) const ENGAGED: Color = Color::BLUE;
/// A clutch that does not.
pub(super) const DISENGAGED: Color = Color::LIGHT_GREY;

/// Up to this number, rows are drawn with gaps between them.
const FEW: usize = 15;

/// Draws a strip for each row. Rows are as high as their distance allows, with gaps when they are few.
pub fn engagement_strip(input: &EngagementStrip, options: &FigureOptions) -> Figure {
    let mut rows: Vec<&EngagementRow> = input.rows.iter().filter(|row| row.value.is_finite()).collect();
    rows.sort_by(|a, b| a.value.total_cmp(&b.value));
    let edges = edges(&rows.iter().map(|row| row.value).collect::<Vec<_>>());
    let mut strips = Vec::new();
    for (row, y) in rows.iter().zip(&edges) {
        strips.push(Strip {
            x: [0.0, 1.0],
            y: *y,
            color: DISENGAGED,
        });
        let engaged = row.engaged.iter().flat_map(|interval| within_period(*interval));
        strips.extend(engaged.map(|x| Strip {
            x,
            y: *y,
            color: ENGAGED,
        }));
    }
    let mut phase = input.phase.clone();
    phase.limits = phase.limits.or(Some((0.0, 1.0)));
    // The gap between rows also separates the outer ones from the frame.
    let mut value = input.row.clone();
    if let (None, [first, ..], [.., last]) = (value.limits, edges.as_slice(), edges.as_slice()) {
        let gap = 0.125 * (first[1] - first[0]).max(last[1] - last[0]);
        value.limits = Some(if rows.len() <= FEW {
            (first[0] - gap, last[1] + gap)
        } else {
            (first[0], last[1])
        });
    }
    let panel = Panel {
        x: phase,
        y: value,
        layers: vec![Layer::Strips(strips)],
        legend: vec![
            LegendEntry::fill("engaged", ENGAGED),
            LegendEntry::fill("disengaged", DISENGAGED),
        ],
        legend_place: LegendPlace::Above,
        ..Panel::default()
    };
    let height = (25.0 + 3.5 * rows.len() as f64).clamp(40.0, 75.0);
    options.figure(vec![vec![panel]], height, height)
}

/// Lower and upper edge of each row: half the distance to the nearer neighbour, at most half the usual one.
fn edges(values: &[f64]) -> Vec<[f64; 2]> {
    let mut steps: Vec<f64> = values
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .filter(|step| *step > 0.0)
        .collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps.get(steps.len() / 2).copied();
    let usual = usual.unwrap_or_else(|| {
        values
            .first()
            .map_or(1.0, |value| (0.2 * value.abs()).max(f64::MIN_POSITIVE))
    });
    // Few rows stand apart; many touch, so that the pattern over the parameter shows.
    let fill = if values.len() <= FEW { 0.8 } else { 1.0 };
    values
        .iter()
        .enumerate()
        .map(|(index, value)| {
            let below = if index > 0 {
                value - values[index - 1]
            } else {
                usual
            };
            let above = values.get(index + 1).map_or(usual, |next| next - value);
            [
                value - 0.5 * fill * below.min(usual),
                value + 0.5 * fill * above.min(usual),
            ]
        })
        .collect()
}

/// The parts of an interval of phase within the period from 0 to 1.
pub(super) fn within_period([from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    if !(from.is_finite() && to.is_finite()) {
        return Vec::new();
    }
    if to - from >= 1.0 {
        return vec![[0.0, 1.0]];
    }
    // An interval that runs backwards crosses the end of the period.
    let to = if to < from { to + (from - to).ceil() } else { to };
    let start = from.rem_euclid(1.0);
    let end = start + (to - from);
    if end <= 1.0 {
        vec![[start, end]]
    } else {
        vec![[start, 1.0], [0.0, end - 1.0]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_wrap_around_the_period() {
        assert_eq!(within_period([0.25, 0.75]), [[0.25, 0.75]]);
        assert_eq!(within_period([0.75, 1.25]), [[0.75, 1.0], [0.0, 0.25]]);
        assert_eq!(within_period([0.75, 0.25]), [[0.75, 1.0], [0.0, 0.25]]);
        assert_eq!(within_period([-0.25, 0.25]), [[0.75, 1.0], [0.0, 0.25]]);
        assert_eq!(within_period([0.0, 1.0]), [[0.0, 1.0]]);
        assert!(within_period([f64::NAN, 1.0]).is_empty());
    }

    #[test]
    fn rows_do_not_overlap() {
        let values = [1.0, 1.5, 2.0, 7.0, 7.1];
        let edges = edges(&values);
        assert!(edges.windows(2).all(|pair| pair[0][1] <= pair[1][0] + 1e-12));
        assert!(edges[2][1] < 2.5, "a gap in the data stays a gap");
    }
}
