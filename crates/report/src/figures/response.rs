//! Response diagram: branches of solutions over a parameter, with stability, special points and sweeps.
//!
//! Stable parts are solid, unstable parts dashed. A branch changes its style at the special point that lies
//! between two of its points, if one is given there, otherwise half-way between the two points.

use super::branch::parts;
use super::{Branch, FigureOptions, SpecialKind, SpecialPoint};
use crate::plot::{
    Axis, Color, CurveLabel, Dash, Figure, Layer, LegendEntry, Marker, Panel, Shape, Stroke, Width,
    curve_color,
};

/// Input of [`response`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Response {
    /// The parameter, for example the excitation frequency.
    pub x: Axis,
    /// The measure, for example the RMS of the wind-up.
    pub y: Axis,
    /// The branches.
    pub branches: Vec<Branch>,
    /// Settled responses of a sweep with rising parameter, `[x, y]`.
    pub sweep_up: Vec<[f64; 2]>,
    /// Settled responses of a sweep with falling parameter, `[x, y]`.
    pub sweep_down: Vec<[f64; 2]>,
    /// A second panel with an enlarged part.
    pub zoom: Option<Zoom>,
}

/// The enlarged part of a response diagram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zoom {
    /// Interval of the parameter.
    pub x: [f64; 2],
    /// Interval of the measure; from the data in the interval of the parameter when absent.
    pub y: Option<[f64; 2]>,
}

/// Draws a response diagram. With a zoom there are two panels, (a) and (b): one above the other in one column,
/// side by side in two.
pub fn response(input: &Response, options: &FigureOptions) -> Figure {
    let mut panel = Panel {
        x: input.x.clone(),
        y: input.y.clone(),
        layers: layers(input),
        legend: legend(input),
        labels: labels(input),
        ..Panel::default()
    };
    let Some(zoom) = input.zoom else {
        // A legend of many lines stands above the panel in a single column and needs room there.
        let single = if panel.legend.len() > 5 { 72.0 } else { 62.0 };
        return options.figure(vec![vec![panel]], single, 85.0);
    };
    let y = zoom.y.or_else(|| extent_of_y(&panel.layers, zoom.x));
    let mut enlarged = Panel {
        x: input.x.clone().with_limits(zoom.x[0], zoom.x[1]),
        letter: Some("(b)".to_string()),
        legend: Vec::new(),
        ..panel.clone()
    };
    if let Some([low, high]) = y {
        enlarged.y = input.y.clone().with_limits(low, high);
        let stroke = Stroke::solid(Color::GREY).with_width(0.5);
        panel.layers.push(Layer::Outline {
            x: zoom.x,
            y: [low, high],
            stroke,
        });
    }
    panel.letter = Some("(a)".to_string());
    match options.width {
        Width::Single => options.figure(vec![vec![panel], vec![enlarged]], 115.0, 115.0),
        Width::Double => options.figure(vec![vec![panel, enlarged]], 80.0, 80.0),
    }
}

/// The interval of y that the layers take within an interval of x, with a margin.
fn extent_of_y(layers: &[Layer], x: [f64; 2]) -> Option<[f64; 2]> {
    let mut extent: Option<[f64; 2]> = None;
    for layer in layers {
        if let Layer::Line { points, .. } | Layer::Points { points, .. } = layer {
            for [_, b] in points
                .iter()
                .filter(|[a, b]| *a >= x[0] && *a <= x[1] && b.is_finite())
            {
                extent = Some(extent.map_or([*b, *b], |[low, high]| [low.min(*b), high.max(*b)]));
            }
        }
    }
    extent.map(|[low, high]| {
        let margin = 0.06 * (high - low);
        // A measure that is nowhere negative gets no negative axis.
        let below = if low >= 0.0 { margin.min(low) } else { margin };
        [low - below, high + margin]
    })
}

/// The different names in their order.
fn names(input: &Response) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for name in input.branches.iter().filter_map(|branch| branch.name.as_deref()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn stroke_of(input: &Response, name: Option<&str>) -> Stroke {
    let index = name.and_then(|name| names(input).iter().position(|other| *other == name));
    Stroke::solid(index.map_or(Color::BLACK, curve_color))
}

const SWEEP_UP: Marker = Marker {
    shape: Shape::TriangleUp,
    size: 3.3,
    filled: false,
    color: Color::BLUE,
};
const SWEEP_DOWN: Marker = Marker {
    shape: Shape::TriangleDown,
    size: 3.3,
    filled: false,
    color: Color::VERMILLION,
};

fn layers(input: &Response) -> Vec<Layer> {
    let mut layers = vec![
        Layer::Points {
            points: input.sweep_up.clone(),
            marker: SWEEP_UP,
        },
        Layer::Points {
            points: input.sweep_down.clone(),
            marker: SWEEP_DOWN,
        },
    ];
    for branch in &input.branches {
        let stroke = stroke_of(input, branch.name.as_deref());
        for part in parts(branch) {
            let dash = if part.stable { Dash::Solid } else { Dash::Dashed };
            layers.push(Layer::Line {
                points: part.points,
                stroke: stroke.with_dash(dash),
            });
        }
    }
    // Grazing points are many: they come first and small, so that they hide nothing.
    for kind in SpecialKind::ALL.into_iter().rev() {
        let points: Vec<[f64; 2]> = special(input)
            .filter(|point| point.kind == kind)
            .map(|point| [point.x, point.y])
            .collect();
        if !points.is_empty() {
            layers.push(Layer::Points {
                points,
                marker: kind.marker(),
            });
        }
    }
    layers
}

fn special(input: &Response) -> impl Iterator<Item = &SpecialPoint> {
    input.branches.iter().flat_map(|branch| &branch.special)
}

fn legend(input: &Response) -> Vec<LegendEntry> {
    let names = names(input);
    let mut legend: Vec<LegendEntry> = names
        .iter()
        .map(|name| LegendEntry::line(*name, stroke_of(input, Some(name))))
        .collect();
    let any_unstable = input.branches.iter().any(|branch| branch.stable.contains(&false));
    if any_unstable {
        let stroke = Stroke::solid(Color::BLACK);
        // With names the solid line is explained already.
        if names.is_empty() {
            legend.push(LegendEntry::line("stable", stroke));
        }
        legend.push(LegendEntry::line("unstable", stroke.with_dash(Dash::Dashed)));
    }
    for kind in SpecialKind::ALL {
        if special(input).any(|point| point.kind == kind) {
            legend.push(LegendEntry::marker(kind.name(), kind.marker()));
        }
    }
    for (points, name, marker) in [
        (&input.sweep_up, "sweep up", SWEEP_UP),
        (&input.sweep_down, "sweep down", SWEEP_DOWN),
    ] {
        if !points.is_empty() {
            legend.push(LegendEntry::marker(name, marker));
        }
    }
    legend
}

/// What tells the curves apart, written beside them for grey prints: of `K_{d} = 10` the value, since the
/// legend tells the rest. Not for a single name.
fn labels(input: &Response) -> Vec<CurveLabel> {
    let names = names(input);
    if names.len() < 2 {
        return Vec::new();
    }
    names
        .iter()
        .filter_map(|name| {
            let branch = input
                .branches
                .iter()
                .find(|branch| branch.name.as_deref() == Some(name))?;
            let points = branch.x.iter().zip(&branch.y).map(|(x, y)| [*x, *y]).collect();
            Some(CurveLabel {
                text: name.rsplit(" = ").next().unwrap_or(name).to_string(),
                points,
                color: stroke_of(input, Some(name)).color,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unstable_part_is_one_dashed_path() {
        let n = 4000;
        let x: Vec<f64> = (0..n).map(|i| f64::from(i) / f64::from(n)).collect();
        let input = Response {
            branches: vec![Branch {
                y: x.iter().map(|x| (7.0 * x).sin()).collect(),
                stable: x.iter().map(|x| !(0.3..0.6).contains(x)).collect(),
                x,
                ..Branch::default()
            }],
            ..Response::default()
        };
        let svg = response(&input, &FigureOptions::default()).svg();
        let dashed: Vec<&str> = svg
            .lines()
            .filter(|line| line.contains("stroke-dasharray"))
            .collect();
        // The branch and its sample in the legend.
        assert_eq!(dashed.len(), 2);
        assert!(dashed.iter().all(|line| line.matches('M').count() == 1));
    }
}
