//! Engaged-time ratio of a clutch over a parameter, with the critical value from which it never opens.

use super::number::with_unit;
use super::{Curve, FigureOptions};
use crate::plot::{
    Axis, Color, Dash, Figure, Layer, LegendEntry, Marker, Panel, Scale, Shape, Stroke, curve_color,
};

/// Input of [`engaged_ratio`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EngagedRatio {
    /// The parameter, for example the load or the inertia ratio.
    pub x: Axis,
    /// Share of the time in which the clutch is engaged, 0 to 1.
    pub ratio: Axis,
    /// The curves.
    pub curves: Vec<EngagedRatioCurve>,
}

/// The ratio at one operating point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EngagedRatioCurve {
    /// Parameters and ratios; the name may be empty.
    pub curve: Curve,
    /// Parameter at which the ratio reaches 1.
    pub critical: Option<f64>,
}

const CRITICAL: Marker = Marker {
    shape: Shape::Circle,
    size: 4.0,
    filled: true,
    color: Color::VERMILLION,
};

/// Draws the ratio with a mark, and an upright line, where it reaches 1. The legend tells the critical values.
pub fn engaged_ratio(input: &EngagedRatio, options: &FigureOptions) -> Figure {
    let mut ratio = input.ratio.clone();
    if ratio.limits.is_none() && ratio.scale == Scale::Linear {
        ratio.limits = Some((0.0, 1.05));
    }
    let mut panel = Panel {
        x: input.x.clone(),
        y: ratio,
        ..Panel::default()
    };
    let mut marks: Vec<[f64; 2]> = Vec::new();
    for (index, one) in input.curves.iter().enumerate() {
        let stroke = Stroke::solid(curve_color(index)).with_dash(Dash::of_curve(index));
        let critical = one.critical.filter(|value| value.is_finite());
        panel.layers.push(Layer::Uprights {
            x: critical.into_iter().collect(),
            stroke: Stroke::solid(curve_color(index))
                .with_width(0.4)
                .with_dash(Dash::Dotted),
        });
        panel.layers.push(Layer::Line {
            points: one.curve.points(),
            stroke,
        });
        let value = critical.map(|value| with_unit(value, &input.x.unit));
        match (one.curve.name.as_str(), value) {
            ("", _) => {}
            (name, Some(value)) => {
                let text = format!("{name}, critical {value}");
                panel.legend.push(LegendEntry::line(text, stroke));
            }
            (name, None) => panel.legend.push(LegendEntry::line(name, stroke)),
        }
        marks.extend(critical.map(|value| [value, 1.0]));
    }
    if let Some(first) = marks.first() {
        let text = match input.curves.as_slice() {
            [one] if one.curve.name.is_empty() => {
                format!("critical value {}", with_unit(first[0], &input.x.unit))
            }
            _ => "critical value".to_string(),
        };
        panel.legend.push(LegendEntry::marker(text, CRITICAL));
    }
    panel.layers.push(Layer::Points {
        points: marks,
        marker: CRITICAL,
    });
    options.figure(vec![vec![panel]], 66.0, 82.0)
}
