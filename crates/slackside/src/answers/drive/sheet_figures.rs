//! Figures of the steady sheet: the layout, and what varies over speed or a key.

use super::layout::layout;
use crate::plots;
use slackside_report::Figure;
use slackside_report::figures::{
    Curve, CurveFamily, HubLoadPath, HubLoadPolar, TensionFan, TensionPanel, curve_family, drive_layout,
    hub_load_polar, tension_fan,
};
use slackside_report::plot::Axis;
use slackside_studies::drive::steady::{FanRow, Outcome, StateRow, SteadyDocument};

/// Speeds marked in a polar diagram.
const MARKED_SPEEDS: usize = 4;

/// All figures of a sheet.
pub fn figures(sheet: &SteadyDocument) -> Vec<(String, Figure)> {
    let mut figures = vec![(
        "layout".to_owned(),
        drive_layout(&layout(sheet), &plots::options()),
    )];
    let (Some(parameter), Some(first)) = (&sheet.parameter, sheet.over.first()) else {
        return figures;
    };
    let axis = varied_axis(&parameter.key, &parameter.unit);
    figures.push(("tensions".to_owned(), fan(sheet, axis.clone())));
    if parameter.key == "speed" {
        figures.push(("hub_loads".to_owned(), polar(sheet, first)));
    }
    for (arm, tensioner) in sheet.tensioners.iter().enumerate() {
        let (label, unit, factor) = match tensioner.angle {
            None => ("Position", "mm", 1e3),
            Some(_) => ("Arm angle", "°", 1f64.to_degrees()),
        };
        let curves = sheet.over.iter().map(|row| Curve {
            name: row.name.clone(),
            x: row.values.clone(),
            y: of_states(row, &|state| factor * state.positions[arm]),
        });
        let family = CurveFamily {
            x: axis.clone(),
            y: Axis::linear(format!("{label} of {}", tensioner.name), unit),
            curves: curves.collect(),
        };
        figures.push((
            format!("arm_{}", arm + 1),
            curve_family(&family, &plots::options()),
        ));
    }
    figures
}

/// The axis of the varied quantity.
pub(super) fn varied_axis(key: &str, unit: &str) -> Axis {
    match key {
        "speed" => Axis::linear("Speed of the driver", unit),
        "frequency" => Axis::linear("Frequency of the lowest order", unit),
        _ => plots::axis(key, if unit == "SI" { "" } else { unit }),
    }
}

/// A number of every state of a row; NaN where there is none.
fn of_states(row: &FanRow, value: &dyn Fn(&StateRow) -> f64) -> Vec<f64> {
    row.outcomes
        .iter()
        .map(|outcome| match outcome {
            Outcome::State(state) => value(state),
            Outcome::Impossible { .. } => f64::NAN,
        })
        .collect()
}

fn fan(sheet: &SteadyDocument, axis: Axis) -> Figure {
    let panels = sheet.spans.iter().enumerate().map(|(i, span)| TensionPanel {
        heading: format!("{} {} – {}", i + 1, span.from, span.to),
        conditions: sheet
            .over
            .iter()
            .map(|row| Curve {
                name: row.name.clone(),
                x: row.values.clone(),
                y: of_states(row, &|state| state.effective_tensions[i]),
            })
            .collect(),
    });
    let input = TensionFan {
        speed: axis,
        tension: Axis::linear("Effective tension", "N"),
        panels: panels.collect(),
        band: sheet.over.len() > 1,
        threshold: None,
    };
    tension_fan(&input, &plots::options())
}

fn polar(sheet: &SteadyDocument, row: &FanRow) -> Figure {
    let (first, last) = (
        row.values.first().copied().unwrap_or_default(),
        row.values.last().copied().unwrap_or_default(),
    );
    let input = HubLoadPolar {
        pulleys: sheet
            .pulleys
            .iter()
            .enumerate()
            .map(|(j, pulley)| HubLoadPath {
                name: pulley.name.clone(),
                speed: row.values.clone(),
                load: row
                    .outcomes
                    .iter()
                    .map(|outcome| match outcome {
                        Outcome::State(state) => state.hub_loads[j],
                        Outcome::Impossible { .. } => [f64::NAN; 2],
                    })
                    .collect(),
            })
            .collect(),
        marked_speeds: (0..MARKED_SPEEDS)
            .map(|k| first + (last - first) * k as f64 / (MARKED_SPEEDS - 1) as f64)
            .collect(),
        speed_unit: "rpm".to_owned(),
        load_unit: "N".to_owned(),
    };
    hub_load_polar(&input, &plots::options())
}
