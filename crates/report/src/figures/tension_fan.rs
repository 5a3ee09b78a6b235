//! Tension fan: belt tension over speed for several conditions, from new to worn and from cold to hot.

use super::curve_family::curves_panel;
use super::{Curve, FigureOptions, extent, panel_grid};
use crate::plot::{Axis, Color, Dash, Figure, Layer, LegendEntry, Panel, Stroke};

/// Input of [`tension_fan`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TensionFan {
    /// Speed.
    pub speed: Axis,
    /// Tension; all panels share its limits.
    pub tension: Axis,
    /// One panel for each span shown.
    pub panels: Vec<TensionPanel>,
    /// Whether the band between the extremes of the conditions is shaded.
    pub band: bool,
    /// A tension that must be kept, with its name.
    pub threshold: Option<(f64, String)>,
}

/// The tension of one span.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TensionPanel {
    /// What stands over it, for example `span 3: alternator – crank`; may be empty.
    pub heading: String,
    /// Tension over speed in each condition, speeds ascending. Conditions of one name look alike in all panels
    /// if they come in the same order.
    pub conditions: Vec<Curve>,
}

const BAND: Color = Color(228, 235, 242);
const THRESHOLD: Stroke = Stroke {
    color: Color::BLACK,
    width: 0.6,
    dash: Dash::LongDash,
};

/// Draws tensions over speed, a panel for each span.
pub fn tension_fan(input: &TensionFan, options: &FigureOptions) -> Figure {
    let tension = shared(input);
    let panels = input.panels.iter().map(|panel| fan(input, panel, &tension));
    panel_grid(panels.collect(), options, (22.0, 24.0))
}

fn fan(input: &TensionFan, span: &TensionPanel, tension: &Axis) -> Panel {
    let mut panel = curves_panel(input.speed.clone(), tension.clone(), &span.conditions);
    panel.heading = (!span.heading.is_empty()).then(|| span.heading.clone());
    if let Some((level, name)) = &input.threshold {
        let speeds = span.conditions.iter().flat_map(|curve| curve.x.iter().copied());
        if let Some([from, to]) = extent(speeds) {
            panel.layers.push(Layer::Line {
                points: vec![[from, *level], [to, *level]],
                stroke: THRESHOLD,
            });
        }
        panel.legend.push(LegendEntry::line(name, THRESHOLD));
    }
    if input.band && span.conditions.len() > 1 {
        panel.layers.insert(
            0,
            Layer::Area {
                points: band(&span.conditions),
                color: BAND,
            },
        );
        panel.legend.push(LegendEntry::fill("between the extremes", BAND));
    }
    panel
}

/// The tension axis with limits that hold all panels.
fn shared(input: &TensionFan) -> Axis {
    if input.tension.limits.is_some() {
        return input.tension.clone();
    }
    let curves = input.panels.iter().flat_map(|panel| &panel.conditions);
    let threshold = input.threshold.as_ref().map(|(level, _)| *level);
    let values = curves.flat_map(|curve| curve.y.iter().copied()).chain(threshold);
    match extent(values) {
        Some([low, high]) if high > low => {
            let margin = 0.06 * (high - low);
            let low = if low >= 0.0 && low < 0.4 * high {
                0.0
            } else {
                low - margin
            };
            input.tension.clone().with_limits(low, high + margin)
        }
        _ => input.tension.clone(),
    }
}

/// The outline between the lowest and the highest curve, where at least one is defined.
fn band(curves: &[Curve]) -> Vec<[f64; 2]> {
    let mut speeds: Vec<f64> = curves
        .iter()
        .flat_map(|curve| curve.x.iter().copied())
        .filter(|speed| speed.is_finite())
        .collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let (mut lower, mut upper) = (Vec::new(), Vec::new());
    for speed in speeds {
        let values = curves.iter().filter_map(|curve| value_at(curve, speed));
        if let Some([low, high]) = extent(values) {
            lower.push([speed, low]);
            upper.push([speed, high]);
        }
    }
    lower.extend(upper.into_iter().rev());
    lower
}

/// The value of a curve with ascending abscissae by linear interpolation; `None` outside.
fn value_at(curve: &Curve, x: f64) -> Option<f64> {
    let count = curve.x.len().min(curve.y.len());
    let (xs, ys) = (&curve.x[..count], &curve.y[..count]);
    let after = xs.partition_point(|value| *value < x);
    let (b, y_b) = (*xs.get(after)?, *ys.get(after)?);
    if b == x {
        return Some(y_b);
    }
    let before = after.checked_sub(1)?;
    let (a, y_a) = (xs[before], ys[before]);
    Some(y_a + (x - a) / (b - a) * (y_b - y_a))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(x: &[f64], y: &[f64]) -> Curve {
        Curve {
            x: x.to_vec(),
            y: y.to_vec(),
            ..Curve::default()
        }
    }

    #[test]
    fn the_band_follows_the_extremes_of_crossing_curves() {
        let rising = curve(&[0.0, 2.0], &[0.0, 2.0]);
        let falling = curve(&[0.0, 1.0, 2.0], &[2.0, 1.0, 0.0]);
        let outline = band(&[rising, falling]);
        let expected = [
            [0.0, 0.0],
            [1.0, 1.0],
            [2.0, 0.0],
            [2.0, 2.0],
            [1.0, 1.0],
            [0.0, 2.0],
        ];
        assert_eq!(outline, expected);
    }

    #[test]
    fn curves_are_not_extrapolated() {
        let short = curve(&[1.0, 2.0], &[5.0, 7.0]);
        assert_eq!(value_at(&short, 1.5), Some(6.0));
        assert_eq!(value_at(&short, 0.5), None);
        assert_eq!(value_at(&short, 2.5), None);
    }
}
