//! Response diagram: branches of solutions over a parameter, with stability, special points and sweeps.
//!
//! Stable parts are solid, unstable parts dashed. A branch changes its style at the special point that lies
//! between two of its points, if one is given there, otherwise half-way between the two points.

use super::FigureOptions;
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

/// A branch of solutions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Branch {
    /// Name in the legend, for example `K_{d} = 10`; branches of one name share a colour. Without a name a
    /// branch is black and not in the legend.
    pub name: Option<String>,
    /// Parameter along the branch.
    pub x: Vec<f64>,
    /// Measure, as many values.
    pub y: Vec<f64>,
    /// Whether each point is stable, as many values.
    pub stable: Vec<bool>,
    /// Special points of the branch.
    pub special: Vec<SpecialPoint>,
}

/// A located special point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpecialPoint {
    /// Parameter.
    pub x: f64,
    /// Measure.
    pub y: f64,
    /// What happens there.
    pub kind: SpecialKind,
    /// Number of the branch point that it follows: the curve is drawn through it, and changes between solid
    /// and dashed there. `None` draws the symbol only.
    pub after: Option<usize>,
}

/// Kinds of special points, each with a symbol of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpecialKind {
    /// Fold (limit point of cycles).
    Fold,
    /// Period doubling (flip).
    PeriodDoubling,
    /// Neimark–Sacker (torus) point.
    NeimarkSacker,
    /// Grazing of a switching surface.
    Grazing,
    /// Crossing of two branches.
    BranchPoint,
    /// Neutral saddle: multipliers of product one without loss of stability.
    NeutralSaddle,
}

impl SpecialKind {
    const ALL: [SpecialKind; 6] = [
        SpecialKind::Fold,
        SpecialKind::PeriodDoubling,
        SpecialKind::NeimarkSacker,
        SpecialKind::BranchPoint,
        SpecialKind::NeutralSaddle,
        SpecialKind::Grazing,
    ];

    fn name(self) -> &'static str {
        match self {
            SpecialKind::Fold => "fold",
            SpecialKind::PeriodDoubling => "period doubling",
            SpecialKind::NeimarkSacker => "Neimark–Sacker",
            SpecialKind::Grazing => "grazing",
            SpecialKind::BranchPoint => "branch point",
            SpecialKind::NeutralSaddle => "neutral saddle",
        }
    }

    fn marker(self) -> Marker {
        match self {
            SpecialKind::Fold => Marker::filled(Shape::Circle, 3.6, Color::BLACK),
            SpecialKind::PeriodDoubling => Marker::filled(Shape::Square, 3.8, Color::BLACK),
            SpecialKind::NeimarkSacker => Marker::filled(Shape::Diamond, 3.6, Color::BLACK),
            SpecialKind::Grazing => Marker::open(Shape::Circle, 2.0, Color::BLACK),
            SpecialKind::BranchPoint => Marker::open(Shape::Asterisk, 5.2, Color::BLACK),
            SpecialKind::NeutralSaddle => Marker::open(Shape::Diamond, 3.6, Color::BLACK),
        }
    }

    /// Whether stability can change there.
    fn changes_stability(self) -> bool {
        !matches!(self, SpecialKind::Grazing | SpecialKind::NeutralSaddle)
    }
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
        return options.figure(vec![vec![panel]], 62.0, 85.0);
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

/// Names beside the curves, which also a grey print can tell apart; not for a single name.
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
                text: name.to_string(),
                points,
                color: stroke_of(input, Some(name)).color,
            })
        })
        .collect()
}

/// A part of a branch of one stability.
#[derive(Debug, Clone, PartialEq)]
struct Part {
    stable: bool,
    points: Vec<[f64; 2]>,
}

/// Divides a branch where its stability changes. Neighbouring parts share the point of the change.
fn parts(branch: &Branch) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let points: Vec<([f64; 2], bool)> = branch
        .x
        .iter()
        .zip(&branch.y)
        .zip(&branch.stable)
        .map(|((x, y), stable)| ([*x, *y], *stable))
        .collect();
    let Some(&(first, stable)) = points.first() else {
        return parts;
    };
    let mut part = Part {
        stable,
        points: vec![first],
    };
    for (index, pair) in points.windows(2).enumerate() {
        let ((from, before), (to, after)) = (pair[0], pair[1]);
        let mut between = branch.special.iter().filter(|point| point.after == Some(index));
        if before == after {
            part.points.extend(between.map(|point| [point.x, point.y]));
        } else {
            let change = between
                .find(|point| point.kind.changes_stability())
                .map_or([(from[0] + to[0]) / 2.0, (from[1] + to[1]) / 2.0], |point| {
                    [point.x, point.y]
                });
            part.points.push(change);
            parts.push(std::mem::replace(
                &mut part,
                Part {
                    stable: after,
                    points: vec![change],
                },
            ));
        }
        part.points.push(to);
    }
    parts.push(part);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn branch(stable: &[bool]) -> Branch {
        let x: Vec<f64> = (0..stable.len()).map(|i| i as f64).collect();
        Branch {
            y: x.iter().map(|x| 2.0 * x).collect(),
            x,
            stable: stable.to_vec(),
            ..Branch::default()
        }
    }

    #[test]
    fn a_branch_changes_style_half_way_between_points() {
        let parts = parts(&branch(&[true, true, false, true]));
        assert_eq!(
            parts,
            [
                Part {
                    stable: true,
                    points: vec![[0.0, 0.0], [1.0, 2.0], [1.5, 3.0]]
                },
                Part {
                    stable: false,
                    points: vec![[1.5, 3.0], [2.0, 4.0], [2.5, 5.0]]
                },
                Part {
                    stable: true,
                    points: vec![[2.5, 5.0], [3.0, 6.0]]
                },
            ]
        );
    }

    #[test]
    fn a_branch_changes_style_at_the_special_point() {
        let mut branch = branch(&[true, false]);
        let at = |x, y, kind| SpecialPoint {
            x,
            y,
            kind,
            after: Some(0),
        };
        branch.special = vec![
            at(0.2, 0.3, SpecialKind::Grazing),
            at(1.25, 1.0, SpecialKind::Fold),
        ];
        let parts = parts(&branch);
        assert_eq!(parts[0].points, [[0.0, 0.0], [1.25, 1.0]]);
        assert_eq!(parts[1].points, [[1.25, 1.0], [1.0, 2.0]]);
    }

    #[test]
    fn a_curve_passes_through_special_points_that_change_nothing() {
        let mut branch = branch(&[true, true]);
        branch.special = vec![SpecialPoint {
            x: 0.4,
            y: 0.9,
            kind: SpecialKind::Grazing,
            after: Some(0),
        }];
        assert_eq!(parts(&branch)[0].points, [[0.0, 0.0], [0.4, 0.9], [1.0, 2.0]]);
    }

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

    #[test]
    fn empty_branches_have_no_parts() {
        assert!(parts(&Branch::default()).is_empty());
        assert_eq!(parts(&branch(&[false])).len(), 1);
    }
}
