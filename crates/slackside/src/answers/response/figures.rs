//! Figures of branches.

use super::{Choice, Statistic};
use crate::answers::engagement::{engaged, switching_element};
use crate::plots;
use slackside_report::Figure;
use slackside_report::figures::{
    Branch, EngagementRow, EngagementStrip, Response, SpecialKind, SpecialPoint, engagement_strip, response,
};
use slackside_report::plot::Axis;
use slackside_studies::response::{PointRow, ResponseDocument};

/// Rows of an engagement strip.
const STRIPS: usize = 160;

/// All figures of the document: the chosen measure, the largest pulley rotation, the engagement of stable motions.
pub fn all(document: &ResponseDocument, choice: &Choice) -> Vec<(String, Figure)> {
    let mut choices = vec![choice.clone()];
    let known = &document.header.units.measures.0;
    let first = known.iter().find(|(name, _)| name == "pulley").or(known.first());
    if let Some((measure, _)) = first {
        let extreme = Choice {
            measure: measure.clone(),
            statistic: Statistic::Max,
        };
        if extreme != *choice {
            choices.push(extreme);
        }
    }
    let mut figures: Vec<(String, Figure)> = choices
        .iter()
        .map(|choice| {
            let name = format!("response_{}_{}", choice.measure, choice.statistic.name());
            (file_name(&name), branches(document, choice))
        })
        .collect();
    figures.extend(engagement(document, choice).map(|figure| ("engagement".to_owned(), figure)));
    figures
}

/// Names of measures come from files: nothing in them may lead out of the directory.
fn file_name(name: &str) -> String {
    name.chars()
        .map(|c| {
            if c.is_alphanumeric() || c == '_' || c == '-' {
                c
            } else {
                '_'
            }
        })
        .collect()
}

fn branches(document: &ResponseDocument, choice: &Choice) -> Figure {
    let curves = document.branches.iter().map(|branch| Branch {
        name: branch.label.as_ref().map(plots::label),
        x: branch.points.iter().map(|point| point.at.value).collect(),
        y: branch
            .points
            .iter()
            .map(|point| choice.of(&point.motion.measures))
            .collect(),
        stable: branch.points.iter().map(|point| point.stable).collect(),
        special: branch
            .special
            .iter()
            .filter_map(|special| {
                Some(SpecialPoint {
                    x: special.at.value,
                    y: choice.of(&special.measures),
                    kind: kind(special.kind)?,
                    after: Some(special.after),
                })
            })
            .collect(),
    });
    let sweep = |rows: &[slackside_studies::response::SweepPointRow]| {
        rows.iter()
            .map(|row| [row.at.value, choice.of(&row.measures)])
            .collect()
    };
    response(
        &Response {
            x: plots::axis(&document.parameter.key, &document.parameter.unit),
            y: choice.axis(&document.header),
            branches: curves.collect(),
            sweep_up: sweep(&document.up),
            sweep_down: sweep(&document.down),
            zoom: None,
        },
        &plots::options(),
    )
}

fn kind(name: &str) -> Option<SpecialKind> {
    Some(match name {
        "fold" => SpecialKind::Fold,
        "period-doubling" => SpecialKind::PeriodDoubling,
        "neimark-sacker" => SpecialKind::NeimarkSacker,
        "grazing" => SpecialKind::Grazing,
        "branch-point" => SpecialKind::BranchPoint,
        "neutral-saddle" => SpecialKind::NeutralSaddle,
        _ => return None,
    })
}

/// When the element that engages and disengages transmits, over the parameter: of the stable motions of the load's period, where there are
/// several the one of the largest measure.
pub fn engagement(document: &ResponseDocument, choice: &Choice) -> Option<Figure> {
    let parameter = &document.parameter;
    let label = document.branches.first()?.label.clone();
    let motions = document.branches.iter().flat_map(|branch| &branch.points);
    let element = switching_element(motions.map(|point| &point.motion))?;
    let (low, high) = (parameter.from.min(parameter.to), parameter.from.max(parameter.to));
    let mut rows: Vec<Option<&PointRow>> = vec![None; STRIPS];
    for branch in document
        .branches
        .iter()
        .filter(|b| b.periods == 1 && b.label == label)
    {
        for point in branch.points.iter().filter(|point| point.stable) {
            point.motion.engaged_ratio?;
            let place = (point.at.value - low) / (high - low) * STRIPS as f64;
            let row = &mut rows[(place.max(0.0) as usize).min(STRIPS - 1)];
            let size = |point: &PointRow| choice.of(&point.motion.measures);
            if row.is_none_or(|other| size(other) < size(point)) {
                *row = Some(point);
            }
        }
    }
    let rows: Vec<EngagementRow> = rows
        .into_iter()
        .enumerate()
        .filter_map(|(i, point)| Some((i, point?)))
        .map(|(i, point)| EngagementRow {
            value: low + (high - low) * (i as f64 + 0.5) / STRIPS as f64,
            engaged: engaged(&point.motion, element),
        })
        .collect();
    if rows.iter().all(|row| row.engaged == [[0.0, 1.0]]) {
        return None;
    }
    Some(engagement_strip(
        &EngagementStrip {
            phase: Axis::linear("Phase of the period", "–"),
            row: plots::axis(&parameter.key, &parameter.unit),
            rows,
        },
        &plots::options(),
    ))
}
