//! Tables of a comparison.

use crate::answers::family::family_column;
use crate::answers::simulate::unit;
use slackside_report::{Column, Table};
use slackside_studies::Measure;
use slackside_studies::compare::{CompareDocument, Contestant, HistoryRow};

/// All tables of the document.
pub fn all(document: &CompareDocument) -> Vec<Table> {
    let mut tables = vec![branches(document), errors(document), within(document)];
    if !document.histories.is_empty() {
        tables.push(histories(document));
    }
    if document.map.is_some() {
        tables.push(map(document));
    }
    tables
}

fn branches(document: &CompareDocument) -> Table {
    let rows: Vec<_> = document
        .branches
        .iter()
        .flat_map(|entry| entry.branch.points.iter().map(move |point| (entry, point)))
        .collect();
    let mut table = Table::new("branches");
    let methods = rows.iter().map(|(entry, _)| entry.method.words().to_owned());
    table.columns.push(Column::text("method", methods.collect()));
    table
        .columns
        .extend(family_column(rows.iter().map(|(entry, _)| &entry.branch.label)));
    table.columns.push(Column::number(
        document.parameter.key.clone(),
        unit(&document.parameter.unit),
        rows.iter().map(|(_, point)| point.at.value).collect(),
    ));
    table.columns.push(Column::boolean(
        "stable",
        rows.iter().map(|(_, point)| point.stable).collect(),
    ));
    let ratios = rows
        .iter()
        .map(|(_, point)| point.motion.engaged_ratio.unwrap_or(f64::NAN));
    table
        .columns
        .push(Column::number("engaged_ratio", "", ratios.collect()));
    for (name, label) in &document.header.units.measures.0 {
        let of = |value: &dyn Fn(&Measure) -> f64| -> Vec<f64> {
            rows.iter()
                .map(|(_, point)| point.motion.measures.get(name).map_or(f64::NAN, value))
                .collect()
        };
        table.columns.extend([
            Column::number(format!("{name}.mean"), unit(label), of(&|m| m.mean)),
            Column::number(format!("{name}.rms"), unit(label), of(&|m| m.rms)),
            Column::number(format!("{name}.max"), unit(label), of(&|m| m.max)),
            Column::number(format!("{name}.min"), unit(label), of(&|m| m.min)),
        ]);
    }
    table
}

fn errors(document: &CompareDocument) -> Table {
    let rows = &document.errors;
    let number =
        |value: &dyn Fn(&slackside_studies::compare::ErrorRow) -> f64| rows.iter().map(value).collect();
    let mut table = Table::new("errors");
    table
        .columns
        .extend(family_column(rows.iter().map(|row| &row.label)));
    table.columns.push(Column::number(
        document.parameter.key.clone(),
        unit(&document.parameter.unit),
        number(&|row| row.at.value),
    ));
    table.columns.push(Column::boolean(
        "stable",
        rows.iter().map(|row| row.stable).collect(),
    ));
    let label = document.header.units.measures.get(&document.measure);
    table.columns.push(Column::number(
        format!("{}.rms", document.measure),
        unit(label),
        number(&|row| row.rms),
    ));
    table
        .columns
        .push(Column::number("gamma", "", number(&|row| row.gamma)));
    for (name, method) in [
        ("first_order", Contestant::FirstOrder),
        ("second_order", Contestant::SecondOrder),
        ("harmonic_balance", Contestant::HarmonicBalance),
    ] {
        let values = number(&|row| row.of(method).unwrap_or(f64::NAN));
        table
            .columns
            .push(Column::number(format!("error.{name}"), "", values));
    }
    table
}

fn within(document: &CompareDocument) -> Table {
    let rows = &document.within;
    let number =
        |value: &dyn Fn(&slackside_studies::compare::WithinRow) -> f64| rows.iter().map(value).collect();
    let mut table = Table::new("within");
    table
        .columns
        .extend(family_column(rows.iter().map(|row| &row.label)));
    table.columns.extend([
        Column::text(
            "method",
            rows.iter().map(|row| row.method.words().to_owned()).collect(),
        ),
        Column::boolean("everywhere", rows.iter().map(|row| row.everywhere).collect()),
        Column::number("up_to_rms", "", number(&|row| row.rms.unwrap_or(f64::NAN))),
        Column::number("down_to_gamma", "", number(&|row| row.gamma.unwrap_or(f64::NAN))),
        Column::number("largest_error", "", number(&|row| row.worst.unwrap_or(f64::NAN))),
    ]);
    table
}

fn histories(document: &CompareDocument) -> Table {
    let rows: Vec<(&HistoryRow, usize)> = document
        .histories
        .iter()
        .flat_map(|row| (0..row.phase.len()).map(move |i| (row, i)))
        .collect();
    let number =
        |value: &dyn Fn(&HistoryRow, usize) -> f64| rows.iter().map(|(row, i)| value(row, *i)).collect();
    let mut table = Table::new("histories");
    table
        .columns
        .extend(family_column(rows.iter().map(|(row, _)| &row.label)));
    let angle = unit(document.header.units.measures.get(&document.measure));
    table.columns.extend([
        Column::text(
            "method",
            rows.iter()
                .map(|(row, _)| row.method.words().to_owned())
                .collect(),
        ),
        Column::number(
            document.parameter.key.clone(),
            unit(&document.parameter.unit),
            number(&|row, _| row.at.value),
        ),
        Column::number("phase", "", number(&|row, i| row.phase[i])),
        Column::number(
            document.measure.clone(),
            angle,
            number(&|row, i| row.deflection[i]),
        ),
        Column::number(
            "force",
            unit(&document.header.units.torque),
            number(&|row, i| row.force[i]),
        ),
    ]);
    table
}

fn map(document: &CompareDocument) -> Table {
    let mut table = Table::new("map");
    let Some(map) = &document.map else { return table };
    let (mut x, mut y, mut validity) = (Vec::new(), Vec::new(), Vec::new());
    let (mut first, mut second, mut gamma) = (Vec::new(), Vec::new(), Vec::new());
    for (row, down) in map.cells.iter().zip(&map.down.values) {
        for (cell, across) in row.iter().zip(&map.across.values) {
            x.push(*across);
            y.push(*down);
            let of = |value: Option<Option<f64>>| value.flatten().unwrap_or(f64::NAN);
            validity.push(
                cell.as_ref()
                    .map_or("no answer", |cell| super::words(cell.validity))
                    .to_owned(),
            );
            first.push(of(cell.as_ref().map(|cell| cell.first_order)));
            second.push(of(cell.as_ref().map(|cell| cell.second_order)));
            gamma.push(of(cell.as_ref().map(|cell| cell.gamma)));
        }
    }
    table.columns.extend([
        Column::number(map.across.key.clone(), "", x),
        Column::number(map.down.key.clone(), "", y),
        Column::text("validity", validity),
        Column::number("error.first_order", "", first),
        Column::number("error.second_order", "", second),
        Column::number("smallest_gamma", "", gamma),
    ]);
    table
}
