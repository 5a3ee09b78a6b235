//! What periodic motions say about designs: certificate, optimum, and what each member of a family buys.

use crate::plots;
use crate::table_text::{number, table, with_unit};
use slackside_report::{Column, Table};
use slackside_studies::response::{PointRow, ResponseDocument};
use slackside_studies::{Label, Measure};

/// Measures in the table of designs, by prefix: what an engineer looks at first.
const SHOWN: [&str; 4] = ["arm.", "tension.", "clutch_torque.", "hub_load."];

/// The certificate of uniqueness in words, one line for each interval.
pub fn verdicts(document: &ResponseDocument) -> String {
    let key = &document.parameter.key;
    let lines = document.uniqueness.iter().map(|row| {
        let about = row
            .label
            .as_ref()
            .map_or_else(String::new, |label| format!("{}, ", plots::label(label)));
        format!(
            "{about}{key} = {} to {}: {}\n",
            plots::short(row.from),
            plots::short(row.to),
            row.verdict
        )
    });
    lines.collect()
}

/// The optimum, a line for each member of the family.
pub fn optimum(document: &ResponseDocument) -> String {
    let lines = document.optimum.iter().map(|row| {
        let about = row
            .label
            .as_ref()
            .map_or_else(String::new, |label| format!("{}: ", plots::label(label)));
        let mut line = format!(
            "{about}{} {} {} at {} = {}",
            row.sense,
            row.of,
            number(row.value),
            row.at.key,
            number(row.at.value)
        );
        if row.at_end {
            line += ", an end of the range";
        }
        let others: Vec<String> = row.others.iter().map(|other| number(other.at.value)).collect();
        if !others.is_empty() {
            line += &format!("; other local optima at {}", others.join(", "));
        }
        line + "\n"
    });
    lines.collect()
}

/// What one member of the family reaches along the range.
struct Reached {
    rms: f64,
    max: f64,
    min: f64,
}

fn points<'a>(
    document: &'a ResponseDocument,
    label: &'a Option<Label>,
) -> impl Iterator<Item = &'a PointRow> {
    let branches = document
        .branches
        .iter()
        .filter(move |branch| branch.label == *label);
    branches.flat_map(|branch| &branch.points)
}

fn labels(document: &ResponseDocument) -> Vec<&Option<Label>> {
    let mut labels: Vec<&Option<Label>> = Vec::new();
    for branch in &document.branches {
        if !labels.contains(&&branch.label) {
            labels.push(&branch.label);
        }
    }
    labels
}

fn reached(document: &ResponseDocument, label: &Option<Label>, measure: &str) -> Option<Reached> {
    let measures = || points(document, label).filter_map(|point| point.motion.measures.get(measure));
    measures().next()?;
    let largest = |of: &dyn Fn(&Measure) -> f64| measures().map(of).fold(f64::NEG_INFINITY, f64::max);
    Some(Reached {
        rms: largest(&|measure| measure.rms),
        max: largest(&|measure| measure.max),
        min: measures()
            .map(|measure| measure.min)
            .fold(f64::INFINITY, f64::min),
    })
}

/// Names and units of the measures that any member has: all, or those shown first.
fn names(document: &ResponseDocument, only_shown: bool) -> Vec<(String, String)> {
    let mut names: Vec<(String, String)> = Vec::new();
    for label in labels(document) {
        let Some(first) = points(document, label).next() else {
            continue;
        };
        for (name, _) in &first.motion.measures.0 {
            let is_shown = !name.ends_with(".rate") && SHOWN.iter().any(|prefix| name.starts_with(prefix));
            if (is_shown || !only_shown) && !names.iter().any(|(known, _)| known == name) {
                // The units of what only another member has are not in the head.
                let unit = document.header.units.measures.get(name);
                let unit = if unit.is_empty() && name.contains("torque") {
                    "N m"
                } else {
                    unit
                };
                names.push((name.clone(), unit.to_owned()));
            }
        }
    }
    names
}

/// Largest RMS of the main measures of every member along the range, and how much that is of the first member's.
pub fn compared(document: &ResponseDocument) -> String {
    let labels = labels(document);
    if labels.len() < 2 {
        return String::new();
    }
    let mut shown = names(document, true);
    if shown.is_empty() {
        shown = names(document, false);
    }
    let heads: Vec<String> = labels
        .iter()
        .map(|label| label.as_ref().map_or_else(String::new, plots::label))
        .collect();
    let mut head = vec!["largest RMS"];
    head.extend(heads.iter().map(String::as_str));
    let rows = shown.iter().map(|(name, unit)| {
        let values: Vec<Option<f64>> = labels
            .iter()
            .map(|label| Some(reached(document, label, name)?.rms))
            .collect();
        let first = values.first().copied().flatten();
        let mut row = vec![with_unit(name, unit)];
        row.extend(values.iter().enumerate().map(|(i, value)| match (value, first) {
            (None, _) => "–".to_owned(),
            (Some(value), Some(first)) if i > 0 && first > 0.0 => {
                format!("{} ({:.0} %)", plots::short(*value), 100.0 * value / first)
            }
            (Some(value), _) => plots::short(*value),
        }));
        row
    });
    format!("\nWhat each buys\n{}\n", table(&head, rows.collect()))
}

/// Largest RMS and extremes of all measures of every member of a family.
pub fn table_of_designs(document: &ResponseDocument) -> Option<Table> {
    let labels = labels(document);
    if labels.len() < 2 {
        return None;
    }
    let (mut member, mut measure, mut units) = (Vec::new(), Vec::new(), Vec::new());
    let (mut rms, mut max, mut min, mut relative) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (name, unit) in names(document, false) {
        let mut first = f64::NAN;
        for (i, label) in labels.iter().enumerate() {
            let Some(reached) = reached(document, label, &name) else {
                continue;
            };
            if i == 0 {
                first = reached.rms;
            }
            member.push(
                label
                    .as_ref()
                    .map_or_else(String::new, |label| label.value.to_string()),
            );
            measure.push(name.clone());
            units.push(unit.clone());
            rms.push(reached.rms);
            max.push(reached.max);
            min.push(reached.min);
            relative.push(reached.rms / first);
        }
    }
    let mut table = Table::new("designs");
    table.columns = vec![
        Column::text("for", member),
        Column::text("measure", measure),
        Column::text("unit", units),
        Column::number("largest_rms", "", rms),
        Column::number("largest", "", max),
        Column::number("smallest", "", min),
        Column::number("rms_relative_to_first", "", relative),
    ];
    Some(table)
}

/// Certificate and optimum as tables.
pub fn tables(document: &ResponseDocument) -> Vec<Table> {
    let mut tables = Vec::new();
    if !document.uniqueness.is_empty() {
        let rows = || document.uniqueness.iter();
        let mut table = Table::new("uniqueness");
        table.columns = vec![
            Column::text("for", rows().map(|row| value(&row.label)).collect()),
            Column::number("from", "", rows().map(|row| row.from).collect()),
            Column::number("to", "", rows().map(|row| row.to).collect()),
            Column::boolean("unique", rows().map(|row| row.unique).collect()),
            Column::boolean("no_jumps", rows().map(|row| row.no_jumps).collect()),
            Column::text("verdict", rows().map(|row| row.verdict.clone()).collect()),
        ];
        tables.push(table);
    }
    if !document.optimum.is_empty() {
        let rows = || document.optimum.iter();
        let mut table = Table::new("optimum");
        table.columns = vec![
            Column::text("for", rows().map(|row| value(&row.label)).collect()),
            Column::text("of", rows().map(|row| row.of.clone()).collect()),
            Column::text("sense", rows().map(|row| row.sense.to_owned()).collect()),
            Column::number(
                document.parameter.key.clone(),
                "",
                rows().map(|row| row.at.value).collect(),
            ),
            Column::number("value", "", rows().map(|row| row.value).collect()),
            Column::boolean("at_end", rows().map(|row| row.at_end).collect()),
        ];
        tables.push(table);
    }
    tables.extend(table_of_designs(document));
    tables
}

fn value(label: &Option<Label>) -> String {
    label
        .as_ref()
        .map_or_else(String::new, |label| label.value.to_string())
}
