//! Extremes of the span tensions over a parameter: the range of the dynamic tension about the static one, and where
//! a span would slacken.

use super::number::significant;
use super::{FigureOptions, extent, panel_grid};
use crate::plot::{Axis, Color, Dash, Figure, Layer, LegendEntry, Panel, Scale, Stroke, curve_color};

/// Input of [`tension_extremes`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TensionExtremes {
    /// The parameter, for example the engine speed.
    pub x: Axis,
    /// Tension; all panels share its limits.
    pub tension: Axis,
    /// The panels: one for each span, or one for all.
    pub panels: Vec<TensionRangePanel>,
}

/// One pair of axes of a [`TensionExtremes`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TensionRangePanel {
    /// What stands over it, for example `span 3: alternator – crank`; may be empty.
    pub heading: String,
    /// One range, drawn as a band, or several, drawn as pairs of lines.
    pub ranges: Vec<TensionRange>,
}

/// The tension of a span over the parameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TensionRange {
    /// Name in the legend, for example `span 3` or `one-way clutch`; may be empty for a single range.
    pub name: String,
    /// Parameters, ascending.
    pub x: Vec<f64>,
    /// Static tension, as many values; empty to draw the dynamic tension alone, about zero.
    pub static_tension: Vec<f64>,
    /// Least dynamic tension, as many values.
    pub min: Vec<f64>,
    /// Greatest dynamic tension, as many values.
    pub max: Vec<f64>,
}

const BAND: Color = Color(214, 228, 242);
const SLACK: Color = Color(243, 196, 170);
const STATIC: Dash = Dash::Dashed;

/// Draws the extremes of the tension, the static tension dashed. Where their sum is negative the belt cannot carry
/// it: the part below zero is shaded and a warning names span and interval.
pub fn tension_extremes(input: &TensionExtremes, options: &FigureOptions) -> Figure {
    let tension = shared(input);
    let panels = input.panels.iter().map(|panel| draw(input, panel, &tension));
    panel_grid(panels.collect(), options, (24.0, 26.0))
}

/// The extremes of a range with the static tension.
struct Total {
    low: Vec<[f64; 2]>,
    high: Vec<[f64; 2]>,
    middle: Vec<[f64; 2]>,
}

impl TensionRange {
    fn total(&self) -> Total {
        let rest = |index: usize| {
            if self.static_tension.is_empty() {
                0.0
            } else {
                self.static_tension.get(index).copied().unwrap_or(f64::NAN)
            }
        };
        let sum = |dynamic: &[f64]| -> Vec<[f64; 2]> {
            let points = self.x.iter().zip(dynamic).enumerate();
            points
                .map(|(index, (x, dynamic))| [*x, rest(index) + dynamic])
                .collect()
        };
        let points = self.x.iter().zip(&self.static_tension);
        Total {
            low: sum(&self.min),
            high: sum(&self.max),
            middle: points.map(|(x, y)| [*x, *y]).collect(),
        }
    }
}

/// The tension axis with limits that hold all panels and zero, so that the margin against slack is seen.
fn shared(input: &TensionExtremes) -> Axis {
    if input.tension.limits.is_some() || input.tension.scale != Scale::Linear {
        return input.tension.clone();
    }
    let ranges = input.panels.iter().flat_map(|panel| &panel.ranges);
    let values = ranges.flat_map(|range| {
        let Total { low, high, middle } = range.total();
        low.into_iter().chain(high).chain(middle).map(|point| point[1])
    });
    match extent(values.chain([0.0])) {
        Some([low, high]) if high > low => {
            let margin = 0.06 * (high - low);
            let low = if low < 0.0 { low - margin } else { low };
            input.tension.clone().with_limits(low, high + margin)
        }
        _ => input.tension.clone(),
    }
}

fn draw(input: &TensionExtremes, panel: &TensionRangePanel, tension: &Axis) -> Panel {
    let mut drawn = Panel {
        x: input.x.clone(),
        y: tension.clone(),
        heading: (!panel.heading.is_empty()).then(|| panel.heading.clone()),
        ..Panel::default()
    };
    // What holds for all ranges stands behind their names.
    let (mut common, mut shades) = (Vec::new(), Vec::new());
    let single = panel.ranges.len() == 1;
    let totals: Vec<Total> = panel.ranges.iter().map(TensionRange::total).collect();
    if single {
        for total in &totals {
            drawn.layers.push(Layer::Area {
                points: between(&total.low, &total.high),
                color: BAND,
            });
        }
        shades.push(LegendEntry::fill("range of the tension", BAND));
    }
    // Before all lines, so that no shade hides the line of another range.
    for (range, total) in panel.ranges.iter().zip(&totals) {
        let slack = slack(&total.low);
        if range.static_tension.is_empty() || slack.is_empty() {
            continue;
        }
        drawn.layers.push(Layer::Area {
            points: below_zero(&total.low),
            color: SLACK,
        });
        let entry = LegendEntry::fill("slack: the linear model does not hold", SLACK);
        if !shades.contains(&entry) {
            shades.push(entry);
        }
        drawn.warnings.push(warning(input, panel, range, &slack));
    }
    for (index, (range, total)) in panel.ranges.iter().zip(totals).enumerate() {
        let stroke = Stroke::solid(if single { Color::BLUE } else { curve_color(index) });
        for points in [total.low, total.high] {
            drawn.layers.push(Layer::Line { points, stroke });
        }
        if !range.name.is_empty() {
            drawn.legend.push(LegendEntry::line(&range.name, stroke));
        }
        if !total.middle.is_empty() {
            let stroke = Stroke::solid(if single { Color::BLACK } else { stroke.color })
                .with_width(0.7)
                .with_dash(STATIC);
            drawn.layers.push(Layer::Line {
                points: total.middle,
                stroke,
            });
            let color = Color::BLACK;
            common = vec![LegendEntry::line("static tension", Stroke { color, ..stroke })];
        }
    }
    drawn.legend.append(&mut common);
    drawn.legend.append(&mut shades);
    drawn
}

/// The outline between two curves over the same abscissae, one outline for each stretch without missing values.
fn between(low: &[[f64; 2]], high: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut outline = Vec::new();
    let pairs: Vec<([f64; 2], [f64; 2])> = low.iter().copied().zip(high.iter().copied()).collect();
    for stretch in
        pairs.split(|(low, high)| !(low[0].is_finite() && low[1].is_finite() && high[1].is_finite()))
    {
        if stretch.is_empty() {
            continue;
        }
        outline.extend(stretch.iter().map(|(low, _)| *low));
        outline.extend(stretch.iter().rev().map(|(_, high)| *high));
        outline.push([f64::NAN, f64::NAN]);
    }
    outline
}

/// The part of a curve below zero and the zero line above it.
fn below_zero(low: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut curve: Vec<[f64; 2]> = Vec::new();
    for (index, point) in low.iter().enumerate() {
        if let Some(crossing) = index
            .checked_sub(1)
            .and_then(|before| crossing(low[before], *point))
        {
            curve.push([crossing, 0.0]);
        }
        // The least of a missing value and zero would be zero.
        let depth = if point[1].is_nan() {
            point[1]
        } else {
            point[1].min(0.0)
        };
        curve.push([point[0], depth]);
    }
    let zero: Vec<[f64; 2]> = curve.iter().map(|point| [point[0], 0.0]).collect();
    between(&curve, &zero)
}

/// Where the line between two points crosses zero.
fn crossing(a: [f64; 2], b: [f64; 2]) -> Option<f64> {
    ((a[1] < 0.0) != (b[1] < 0.0) && a[1].is_finite() && b[1].is_finite())
        .then(|| a[0] + a[1] / (a[1] - b[1]) * (b[0] - a[0]))
        .filter(|x| x.is_finite())
}

/// The intervals in which a curve is negative.
fn slack(low: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut intervals: Vec<[f64; 2]> = Vec::new();
    let mut open = false;
    for (index, point) in low.iter().enumerate() {
        let crossing = index
            .checked_sub(1)
            .and_then(|before| crossing(low[before], *point));
        let negative = point[1] < 0.0 && point[0].is_finite();
        match (open, negative) {
            (false, true) => intervals.push([crossing.unwrap_or(point[0]), point[0]]),
            (true, _) => {
                if let (Some(last), Some(end)) =
                    (intervals.last_mut(), crossing.or(negative.then_some(point[0])))
                {
                    last[1] = end;
                }
            }
            (false, false) => {}
        }
        open = negative;
    }
    intervals
}

fn warning(
    input: &TensionExtremes,
    panel: &TensionRangePanel,
    range: &TensionRange,
    slack: &[[f64; 2]],
) -> String {
    /// More intervals are counted.
    const MOST: usize = 3;
    let who = match (panel.heading.as_str(), range.name.as_str()) {
        ("", "") => "the span".to_string(),
        ("", name) => name.to_string(),
        (heading, "") => heading.to_string(),
        (heading, name) => format!("{heading}, {name}"),
    };
    let mut places: Vec<String> = slack
        .iter()
        .take(MOST)
        .map(|[from, to]| match (significant(*from), significant(*to)) {
            (from, to) if from == to => from,
            (from, to) => format!("{from} to {to}"),
        })
        .collect();
    if slack.len() > MOST {
        places.push(format!("{} more intervals", slack.len() - MOST));
    }
    let unit = match input.x.unit.as_str() {
        "" | "–" | "-" => String::new(),
        unit => format!(" {unit}"),
    };
    format!(
        "{who} would be slack at {}{unit}: static plus dynamic tension is negative, the linear model does not hold there.",
        places.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slack_begins_and_ends_between_points() {
        let low = [[0.0, 1.0], [1.0, -1.0], [2.0, -3.0], [3.0, 1.0], [4.0, -1.0]];
        let slack = slack(&low);
        let expected = [[0.5, 2.75], [3.5, 4.0]];
        for (found, expected) in slack.iter().zip(expected) {
            assert!((found[0] - expected[0]).abs() < 1e-12 && (found[1] - expected[1]).abs() < 1e-12);
        }
        assert_eq!(slack.len(), 2);
    }

    #[test]
    fn missing_values_end_an_interval_and_an_area() {
        let low = [[0.0, -1.0], [1.0, f64::NAN], [2.0, -1.0]];
        assert_eq!(slack(&low), [[0.0, 0.0], [2.0, 2.0]]);
        let outline = below_zero(&low);
        assert!(outline.iter().any(|point| point[0].is_nan()), "{outline:?}");
        assert!(!outline.contains(&[1.0, 0.0]));
    }

    #[test]
    fn the_static_tension_is_added() {
        let range = TensionRange {
            x: vec![1.0, 2.0],
            static_tension: vec![300.0, 310.0],
            min: vec![-100.0, -400.0],
            max: vec![100.0, 120.0],
            ..TensionRange::default()
        };
        let total = range.total();
        assert_eq!(total.low, [[1.0, 200.0], [2.0, -90.0]]);
        assert_eq!(total.high, [[1.0, 400.0], [2.0, 430.0]]);
        let dynamic = TensionRange {
            static_tension: vec![],
            ..range
        };
        assert_eq!(dynamic.total().low[1], [2.0, -400.0]);
        assert!(dynamic.total().middle.is_empty());
    }
}
