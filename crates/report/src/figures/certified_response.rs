//! Measures over a parameter together with how far they can be trusted: dashed where uniqueness is not guaranteed,
//! with lanes and warnings for slack spans, gross slip and runs that ended early.

use super::branch::parts;
use super::lanes::{Lane, Stretch, lane_panel, visible};
use super::{Branch, FigureOptions, extent, shared_legend};
use crate::plot::{Axis, Color, CurveLabel, Dash, Figure, Layer, LegendEntry, Panel, Stroke, curve_color};

/// Input of [`certified_response`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CertifiedResponse {
    /// The parameter, for example the engine speed.
    pub x: Axis,
    /// The measures, a panel each, from top to bottom.
    pub measures: Vec<CertifiedMeasure>,
    /// What limits the results in intervals of the parameter.
    pub warnings: Vec<RangeWarning>,
}

/// A measure over the parameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CertifiedMeasure {
    /// The measure.
    pub y: Axis,
    /// Its curves. Curves look alike in all panels if they come in the same order.
    pub curves: Vec<CertifiedCurve>,
}

/// A curve with its certificate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CertifiedCurve {
    /// Name in the legend, for example `Q_{m} = 2 N m`; may be empty for a single curve.
    pub name: String,
    /// Parameters.
    pub x: Vec<f64>,
    /// Values, as many; not finite where there is no result.
    pub y: Vec<f64>,
    /// Whether the response is certified to be unique at each point, as many; points beyond its end count as
    /// certified, so it may be empty.
    pub unique: Vec<bool>,
}

/// A warning that concerns intervals of the parameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RangeWarning {
    /// Name of its lane, for example `slack span 2`, `gross slip` or `event budget`; warnings of one name share a
    /// lane. Cut when it is wider than 25 mm.
    pub name: String,
    /// What it means, written at the foot of the page; may be empty.
    pub text: String,
    /// The intervals `[from, to]`; single points may be given as `[x, x]`.
    pub intervals: Vec<[f64; 2]>,
}

const CONCERNED: Color = Color(240, 240, 240);
const NOT_CERTIFIED: &str = "uniqueness not guaranteed";

/// Draws the measures, dashed where uniqueness is not guaranteed. Warnings have lanes above the panels; the panels
/// are shaded in their intervals, and their texts stand at the foot of the page.
pub fn certified_response(input: &CertifiedResponse, options: &FigureOptions) -> Figure {
    let curves = || input.measures.iter().flat_map(|measure| &measure.curves);
    let within = input.x.limits.map_or_else(
        || extent(curves().flat_map(|curve| curve.x.iter().copied())),
        |(a, b)| Some([a.min(b), a.max(b)]),
    );
    let lanes = lanes(&input.warnings, within.unwrap_or([0.0, 1.0]));
    let mut rows: Vec<Vec<Panel>> = Vec::new();
    if !lanes.is_empty() {
        rows.push(vec![lane_panel(input.x.clone(), &lanes)]);
    }
    let concerned: Vec<[f64; 2]> = lanes
        .iter()
        .flat_map(|lane| lane.stretches.iter().map(|stretch| stretch.x))
        .collect();
    rows.extend(
        input
            .measures
            .iter()
            .map(|measure| vec![panel(input, measure, &concerned)]),
    );
    let (count, height) = (input.measures.len().max(1) as f64, 4.1 * lanes.len() as f64);
    let mut figure = options.figure(rows, 26.0 + 38.0 * count + height, 26.0 + 48.0 * count + height);
    figure.share_x = true;
    figure.legend = shared_legend(figure.rows.iter_mut().flatten());
    // Behind the warnings that the options have put first.
    if let Some(panel) = figure.rows.iter_mut().flatten().next() {
        panel.warnings.extend(texts(input));
    }
    figure
}

/// The different names of warnings with their intervals.
fn lanes(warnings: &[RangeWarning], within: [f64; 2]) -> Vec<Lane<'_>> {
    let mut lanes: Vec<Lane> = Vec::new();
    for warning in warnings {
        let stretches = visible(&warning.intervals, within).into_iter().map(|x| Stretch {
            x,
            height: [0.0, 1.0],
            color: Color::VERMILLION,
        });
        match lanes.iter_mut().find(|lane| lane.name == warning.name) {
            Some(lane) => lane.stretches.extend(stretches),
            None => lanes.push(Lane {
                name: &warning.name,
                stretches: stretches.collect(),
            }),
        }
    }
    // A warning about the whole run has a text only.
    lanes.retain(|lane| !lane.stretches.is_empty());
    lanes
}

/// Texts at the foot of the page: of the warnings, and of missing certificates.
fn texts(input: &CertifiedResponse) -> Vec<String> {
    let mut texts: Vec<String> = input
        .warnings
        .iter()
        .map(|warning| match (warning.name.as_str(), warning.text.as_str()) {
            (name, "") => name.to_string(),
            ("", text) => text.to_string(),
            (name, text) => format!("{name}: {text}"),
        })
        .collect();
    let curves = || input.measures.iter().flat_map(|measure| &measure.curves);
    if curves().any(|curve| curve.unique.contains(&false)) {
        texts.push(format!(
            "{NOT_CERTIFIED} where lines are dashed: other responses may exist there."
        ));
    }
    texts
}

fn panel(input: &CertifiedResponse, measure: &CertifiedMeasure, concerned: &[[f64; 2]]) -> Panel {
    let mut panel = Panel {
        x: input.x.clone(),
        y: measure.y.clone(),
        layers: vec![Layer::Bands {
            intervals: concerned.to_vec(),
            color: CONCERNED,
        }],
        ..Panel::default()
    };
    let several = measure.curves.len() > 1;
    for (index, curve) in measure.curves.iter().enumerate() {
        let stroke = Stroke::solid(curve_color(index));
        let branch = Branch {
            x: curve.x.clone(),
            y: curve.y.clone(),
            stable: curve.unique.clone(),
            ..Branch::default()
        };
        for part in parts(&branch) {
            let dash = if part.stable { Dash::Solid } else { Dash::Dashed };
            panel.layers.push(Layer::Line {
                points: part.points,
                stroke: stroke.with_dash(dash),
            });
        }
        if curve.name.is_empty() {
            continue;
        }
        panel.legend.push(LegendEntry::line(&curve.name, stroke));
        if several {
            panel.labels.push(CurveLabel {
                text: curve.name.rsplit(" = ").next().unwrap_or(&curve.name).to_string(),
                points: curve.x.iter().zip(&curve.y).map(|(x, y)| [*x, *y]).collect(),
                color: stroke.color,
            });
        }
    }
    if measure.curves.iter().any(|curve| curve.unique.contains(&false)) {
        let stroke = Stroke::solid(Color::BLACK).with_dash(Dash::Dashed);
        panel.legend.push(LegendEntry::line(NOT_CERTIFIED, stroke));
    }
    if !concerned.is_empty() {
        panel.legend.push(LegendEntry::fill("see warnings", CONCERNED));
    }
    panel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_of_one_name_share_a_lane_and_all_are_written() {
        let warning = |name: &str, intervals: &[[f64; 2]]| RangeWarning {
            name: name.into(),
            text: format!("text {}", intervals.len()),
            intervals: intervals.to_vec(),
        };
        let warnings = vec![
            warning("slack", &[[1.0, 2.0], [4.0, 4.0]]),
            warning("whole run", &[]),
            warning("slack", &[[6.0, 7.0]]),
        ];
        let lanes = lanes(&warnings, [0.0, 10.0]);
        assert_eq!(lanes.len(), 1);
        assert_eq!(lanes[0].stretches.len(), 3);
        let texts = texts(&CertifiedResponse {
            warnings,
            ..CertifiedResponse::default()
        });
        assert_eq!(texts, ["slack: text 2", "whole run: text 0", "slack: text 1"]);
    }
}
