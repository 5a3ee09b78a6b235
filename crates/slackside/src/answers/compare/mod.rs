//! The answer of `response --compare`.

mod figures;
mod tables;

use crate::answer::Answer;
use crate::table_text::{number, table, with_unit};
use slackside_report::{Figure, Table};
use slackside_studies::compare::{CompareDocument, Validity, WithinRow};
use slackside_studies::{Header, Label};

/// What holds at a cell of the map, in words.
fn words(validity: Validity) -> &'static str {
    match validity {
        Validity::Linear => "nothing separates: linear",
        Validity::FirstOrder => "first order within",
        Validity::SecondOrder => "second order within",
        Validity::Neither => "neither within",
    }
}

/// A share as percentage.
fn percent(share: f64) -> String {
    let value = 100.0 * share;
    if value != 0.0 && value < 1e-3 {
        format!("{value:.0e} %")
    } else {
        let text = format!("{value:.3}");
        format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
    }
}

/// The value of a family key as a name: `preload = 2`; empty without one.
fn name(label: &Option<Label>) -> String {
    label.as_ref().map_or_else(String::new, crate::plots::label)
}

/// How far a method is within the tolerance, in one sentence.
fn statement(row: &WithinRow, measure: &str, tolerance: f64) -> String {
    let about = match name(&row.label) {
        label if label.is_empty() => String::new(),
        label => format!("{label}: "),
    };
    let worst = row.worst.map_or_else(
        || "some motions of the branch are not found at all".to_owned(),
        |worst| format!("largest error {}", percent(worst)),
    );
    let method = row.method.words();
    let tolerance = percent(tolerance);
    match (row.everywhere, row.rms, row.gamma) {
        (true, ..) => format!("{about}{method} is within {tolerance} everywhere; {worst}."),
        (false, Some(rms), Some(gamma)) => format!(
            "{about}{method} is within {tolerance} up to {measure}.rms = {} (gamma down to {gamma:.3}); {worst}.",
            number(rms)
        ),
        _ => format!("{about}{method} is nowhere within {tolerance} where the clutch separates; {worst}."),
    }
}

impl Answer for CompareDocument {
    fn header(&self) -> &Header {
        &self.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }

    fn summary(&self) -> String {
        let head = with_unit(&self.parameter.key, &self.parameter.unit);
        let measure = format!("{}.rms", self.measure);
        let rows = self.branches.iter().map(|entry| {
            let branch = &entry.branch;
            let rms = |m: &slackside_studies::Measures| m.get(&self.measure).map_or(f64::NAN, |m| m.rms);
            let largest = branch
                .points
                .iter()
                .map(|p| rms(&p.motion.measures))
                .fold(f64::NAN, f64::max);
            let folds = branch.special.iter().filter(|special| special.kind == "fold");
            let folds: Vec<String> = folds.map(|fold| format!("{:.6}", fold.at.value)).collect();
            vec![
                entry.method.words().to_owned(),
                name(&branch.label),
                branch.points.len().to_string(),
                number(largest),
                folds.join(", "),
            ]
        });
        let mut text = String::from("Branches\n");
        text += &table(
            &[
                "method",
                "for",
                "points",
                &format!("largest {measure}"),
                &format!("folds: {head}"),
            ],
            rows.collect(),
        );
        text += "\n\n";
        if self.errors.is_empty() {
            text += "No motion separates: there is nothing to compare, the linear response is exact.\n";
        }
        for row in &self.within {
            text += &statement(row, &self.measure, self.tolerance);
            text += "\n";
        }
        if let Some(map) = &self.map {
            let cells = || map.cells.iter().flatten();
            text += &format!(
                "\n{} × {} cells over {} and {}\n",
                map.across.values.len(),
                map.down.values.len(),
                map.across.key,
                map.down.key
            );
            let rows = Validity::ALL.iter().map(|validity| {
                let of = |cell: &&Option<slackside_studies::compare::MapCell>| {
                    cell.as_ref().is_some_and(|cell| cell.validity == *validity)
                };
                vec![
                    words(*validity).to_owned(),
                    cells().filter(of).count().to_string(),
                ]
            });
            text += &table(&["along the whole branch", "cells"], rows.collect());
            text += "\n";
        }
        text
    }

    fn tables(&self) -> Vec<Table> {
        tables::all(self)
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        figures::all(self)
    }
}
