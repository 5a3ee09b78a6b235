//! The answer of `modes`.

use crate::answer::Answer;
use crate::plots;
use crate::table_text::{number, table, with_unit};
use slackside_report::figures::{Curve, CurveFamily, curve_family};
use slackside_report::plot::Axis;
use slackside_report::{Column, Figure, Table};
use slackside_studies::Header;
use slackside_studies::modes::{ModeRow, ModesDocument};

/// The modes as a table on the terminal.
pub fn mode_lines(modes: &[ModeRow], unit: &str) -> String {
    let names: Vec<String> = modes.first().map_or(Vec::new(), |mode| {
        mode.shape.0.iter().map(|(name, _)| name.clone()).collect()
    });
    let mut head = vec![
        "mode".to_owned(),
        with_unit("frequency", unit),
        "damping ratio".to_owned(),
    ];
    head.extend(names.iter().map(|name| format!("{name} share")));
    let rows = modes.iter().map(|mode| {
        let mut row = vec![
            mode.kind.to_owned(),
            number(mode.frequency),
            number(mode.damping_ratio),
        ];
        row.extend(
            mode.shares
                .0
                .iter()
                .map(|(_, share)| format!("{:.1} %", 100.0 * share)),
        );
        row
    });
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    table(&head, rows.collect())
}

/// The modes as a table to save.
pub fn mode_table(modes: &[ModeRow], unit: &str) -> Table {
    let column = |value: &dyn Fn(&ModeRow) -> f64| modes.iter().map(value).collect::<Vec<f64>>();
    let mut table = Table::new("modes");
    table.columns = vec![
        Column::text("kind", modes.iter().map(|mode| mode.kind.to_owned()).collect()),
        Column::number("frequency", unit, column(&|mode| mode.frequency)),
        Column::number("damping_ratio", "", column(&|mode| mode.damping_ratio)),
    ];
    let coordinates = modes.first().map_or(0, |mode| mode.shape.0.len());
    for i in 0..coordinates {
        let name = &modes[0].shape.0[i].0;
        table.columns.push(Column::number(
            format!("shape.{name}"),
            "",
            column(&|mode| mode.shape.0[i].1),
        ));
        table.columns.push(Column::number(
            format!("share.{name}"),
            "",
            column(&|mode| mode.shares.0[i].1),
        ));
    }
    table
}

impl Answer for ModesDocument {
    fn header(&self) -> &Header {
        &self.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self)
    }

    fn summary(&self) -> String {
        let unit = &self.header.units.frequency;
        let mut text = mode_lines(&self.modes, unit);
        if let (Some(first), Some(last)) = (self.over.first(), self.over.last()) {
            text += &format!(
                "\n\n{} values of {} from {} to {}\n",
                self.over.len(),
                first.at.key,
                number(first.at.value),
                number(last.at.value)
            );
            let rows = first
                .modes
                .iter()
                .zip(&last.modes)
                .map(|(a, b)| vec![a.kind.to_owned(), number(a.frequency), number(b.frequency)]);
            text += &table(
                &[
                    "mode",
                    &with_unit("first frequency", unit),
                    &with_unit("last frequency", unit),
                ],
                rows.collect(),
            );
        }
        text + "\n"
    }

    fn tables(&self) -> Vec<Table> {
        let unit = &self.header.units.frequency;
        let mut tables = vec![mode_table(&self.modes, unit)];
        if let Some(first) = self.over.first() {
            let mut over = Table::new("over");
            let values = self.over.iter().map(|row| row.at.value).collect();
            over.columns
                .push(Column::number(first.at.key.clone(), "", values));
            for (i, (name, kind)) in curve_names(&first.modes).into_iter().enumerate() {
                let column = |value: &dyn Fn(&ModeRow) -> f64| -> Vec<f64> {
                    let rows = self.over.iter();
                    rows.map(|row| row.modes.get(i).map_or(f64::NAN, value)).collect()
                };
                over.columns.push(Column::number(
                    format!("{kind}.{name}.frequency"),
                    unit.clone(),
                    column(&|mode| mode.frequency),
                ));
                over.columns.push(Column::number(
                    format!("{kind}.{name}.damping_ratio"),
                    "",
                    column(&|mode| mode.damping_ratio),
                ));
            }
            tables.push(over);
        }
        tables
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        let Some(first) = self.over.first() else {
            return Vec::new();
        };
        let curves = curve_names(&first.modes)
            .into_iter()
            .enumerate()
            .map(|(i, (number, kind))| Curve {
                name: format!("{kind}, mode {number}"),
                x: self.over.iter().map(|row| row.at.value).collect(),
                y: self
                    .over
                    .iter()
                    .map(|row| row.modes.get(i).map_or(f64::NAN, |mode| mode.frequency))
                    .collect(),
            });
        let figure = curve_family(
            &CurveFamily {
                x: plots::axis(&first.at.key, ""),
                y: Axis::linear("Natural frequency", self.header.units.frequency.clone()),
                curves: curves.collect(),
            },
            &plots::options(),
        );
        vec![("natural_frequencies".to_owned(), figure)]
    }
}

/// Number within its kind, and kind, of each mode.
fn curve_names(modes: &[ModeRow]) -> Vec<(usize, &'static str)> {
    let mut names: Vec<(usize, &'static str)> = Vec::new();
    for mode in modes {
        let before = names.iter().filter(|(_, kind)| *kind == mode.kind).count();
        names.push((before + 1, mode.kind));
    }
    names
}
