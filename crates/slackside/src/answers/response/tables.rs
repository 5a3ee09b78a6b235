//! Tables of branches.

use crate::answers::family::family_column;
use crate::answers::simulate::unit;
use slackside_report::{Column, Table};
use slackside_studies::response::periodic::Trust;
use slackside_studies::response::{
    BranchRow, OrbitRow, PointRow, ResponseDocument, ScalesRow, SweepPointRow,
};
use slackside_studies::{ElementRow, Label, Measure, Motion};

/// A motion with its place: what the rows of `branches` and `at` share.
struct Row<'a> {
    branch: usize,
    point: usize,
    label: &'a Option<Label>,
    periods: usize,
    value: f64,
    stable: bool,
    residual: f64,
    multipliers: &'a [[f64; 2]],
    scales: Option<ScalesRow>,
    trust: Option<&'a Trust>,
    motion: &'a Motion,
}

/// All tables of the document.
pub fn all(document: &ResponseDocument) -> Vec<Table> {
    let points: Vec<Row> = document
        .branches
        .iter()
        .enumerate()
        .flat_map(|(branch, row)| {
            let points = row.points.iter().enumerate();
            points.map(move |(point, found)| of_point(branch, point, row, found))
        })
        .collect();
    let mut tables = vec![
        motions("branches", document, &points),
        special(document),
        events("events", &points),
        harmonics("harmonics", document, &points),
    ];
    if !document.at.is_empty() {
        let orbits: Vec<Row> = document
            .at
            .iter()
            .enumerate()
            .map(|(i, orbit)| of_orbit(i, orbit))
            .collect();
        tables.push(motions("at", document, &orbits));
        tables.push(events("at_events", &orbits));
        tables.push(harmonics("at_harmonics", document, &orbits));
    }
    if !document.up.is_empty() || !document.down.is_empty() {
        tables.push(sweep(document));
    }
    tables.extend(super::designs::tables(document));
    tables
}

fn of_point<'a>(branch: usize, point: usize, row: &'a BranchRow, found: &'a PointRow) -> Row<'a> {
    Row {
        branch,
        point,
        label: &row.label,
        periods: row.periods,
        value: found.at.value,
        stable: found.stable,
        residual: found.residual,
        multipliers: &found.multipliers,
        scales: found.multiple_scales,
        trust: found.trust.as_ref(),
        motion: &found.motion,
    }
}

fn of_orbit(point: usize, orbit: &OrbitRow) -> Row<'_> {
    Row {
        branch: orbit.branch,
        point,
        label: &orbit.label,
        periods: orbit.periods,
        value: orbit.at.value,
        stable: orbit.stable,
        residual: orbit.residual,
        multipliers: &orbit.multipliers,
        scales: orbit.multiple_scales,
        trust: orbit.trust.as_ref(),
        motion: &orbit.motion,
    }
}

fn motions(name: &str, document: &ResponseDocument, rows: &[Row]) -> Table {
    let number = |value: &dyn Fn(&Row) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    let integer = |value: &dyn Fn(&Row) -> usize| {
        // Counts are far below the range of the column.
        rows.iter()
            .map(|row| i64::try_from(value(row)).unwrap_or(i64::MAX))
            .collect::<Vec<i64>>()
    };
    let mut table = Table::new(name);
    table.columns = vec![
        Column::integer("branch", integer(&|row| row.branch)),
        Column::integer("point", integer(&|row| row.point)),
        Column::integer("periods", integer(&|row| row.periods)),
    ];
    table
        .columns
        .extend(family_column(rows.iter().map(|row| row.label)));
    let parameter = &document.parameter;
    table.columns.extend([
        Column::number(
            parameter.key.clone(),
            unit(&parameter.unit),
            number(&|row| row.value),
        ),
        Column::boolean("stable", rows.iter().map(|row| row.stable).collect()),
        Column::number("residual", "", number(&|row| row.residual)),
        Column::number(
            "engaged_ratio",
            "",
            number(&|row| row.motion.engaged_ratio.unwrap_or(f64::NAN)),
        ),
        Column::integer("events", integer(&|row| row.motion.events.len())),
    ]);
    for (name, label) in &document.header.units.measures.0 {
        let of = |value: &dyn Fn(&Measure) -> f64| {
            number(&|row| row.motion.measures.get(name).map_or(f64::NAN, value))
        };
        table.columns.extend([
            Column::number(format!("{name}.mean"), unit(label), of(&|m| m.mean)),
            Column::number(format!("{name}.rms"), unit(label), of(&|m| m.rms)),
            Column::number(format!("{name}.max"), unit(label), of(&|m| m.max)),
            Column::number(format!("{name}.min"), unit(label), of(&|m| m.min)),
        ]);
    }
    if rows.iter().any(|row| row.scales.is_some()) {
        let of =
            |value: &dyn Fn(&ScalesRow) -> f64| number(&|row| row.scales.as_ref().map_or(f64::NAN, value));
        table.columns.extend([
            Column::integer("mode", integer(&|row| row.scales.map_or(0, |scales| scales.mode))),
            Column::number("amplitude", "", of(&|s| s.amplitude)),
            Column::number("phase", "rad", of(&|s| s.phase)),
            Column::number("gamma", "", of(&|s| s.gamma)),
            Column::number("correction", "", of(&|s| s.correction)),
            Column::boolean(
                "validated",
                rows.iter()
                    .map(|row| row.scales.is_none_or(|scales| scales.validated))
                    .collect(),
            ),
        ]);
    }
    table.columns.extend(element_columns(rows));
    let count = rows.iter().map(|row| row.multipliers.len()).max().unwrap_or(0);
    for i in 0..count {
        let part = |k: usize| number(&|row| row.multipliers.get(i).map_or(f64::NAN, |m| m[k]));
        table
            .columns
            .push(Column::number(format!("multiplier.{i}.re"), "", part(0)));
        table
            .columns
            .push(Column::number(format!("multiplier.{i}.im"), "", part(1)));
    }
    table
}

/// What each element does: shares of its regimes, dissipation, counters; drifts; how many remarks concern each motion.
fn element_columns(rows: &[Row]) -> Vec<Column> {
    let number = |value: &dyn Fn(&Motion) -> Option<f64>| {
        let values = rows.iter().map(|row| value(row.motion).unwrap_or(f64::NAN));
        values.collect::<Vec<f64>>()
    };
    let mut columns = Vec::new();
    let mut shares: Vec<(&str, &str)> = Vec::new();
    let mut elements: Vec<&str> = Vec::new();
    let mut drifts: Vec<&str> = Vec::new();
    for row in rows {
        for (element, regimes) in &row.motion.regimes.0 {
            for (regime, _) in &regimes.0 {
                if !shares.contains(&(element, regime)) {
                    shares.push((element, regime));
                }
            }
        }
        for (element, _) in &row.motion.elements.0 {
            if !elements.contains(&element.as_str()) {
                elements.push(element);
            }
        }
        for (coordinate, _) in &row.motion.drift.0 {
            if !drifts.contains(&coordinate.as_str()) {
                drifts.push(coordinate);
            }
        }
    }
    for (element, regime) in shares {
        let share = number(&|motion| motion.regimes.get(element)?.get(regime));
        columns.push(Column::number(format!("{element}.{regime}"), "", share));
    }
    for coordinate in drifts {
        let drift = number(&|motion| motion.drift.get(coordinate));
        columns.push(Column::number(format!("drift.{coordinate}"), "", drift));
    }
    for element in elements {
        let of = |value: &dyn Fn(&ElementRow) -> Option<f64>| {
            number(&|motion| motion.elements.get(element).and_then(value))
        };
        for (name, values) in [
            ("dissipation", of(&|row| Some(row.dissipation + row.impact_loss))),
            ("stops", of(&|row| Some(row.stops as f64))),
            ("impacts", of(&|row| Some(row.impacts as f64))),
            (
                "velocity_reversals",
                of(&|row| row.velocity_reversals.map(|count| count as f64)),
            ),
            (
                "force_reversals",
                of(&|row| row.force_reversals.map(|count| count as f64)),
            ),
        ] {
            columns.push(Column::number(format!("{element}.{name}"), "", values));
        }
    }
    if rows.iter().any(|row| row.trust.is_some()) {
        let told = |kind: &str| -> Vec<String> {
            let of = |row: &Row| {
                let remarks = row.trust.iter().flat_map(|trust| &trust.remarks);
                let places = remarks
                    .filter(|remark| remark.kind == kind)
                    .map(|remark| remark.at.as_str());
                places.collect::<Vec<&str>>().join(", ")
            };
            rows.iter().map(of).collect()
        };
        columns.push(Column::text("slack_spans", told("slack-span")));
        columns.push(Column::text("gross_slip", told("gross-slip")));
    }
    columns
}

fn special(document: &ResponseDocument) -> Table {
    let rows: Vec<(i64, &slackside_studies::response::SpecialRow)> = document
        .branches
        .iter()
        .zip(0..)
        .flat_map(|(branch, index)| branch.special.iter().map(move |special| (index, special)))
        .collect();
    let mut table = Table::new("special");
    table.columns = vec![
        Column::integer("branch", rows.iter().map(|(branch, _)| *branch).collect()),
        Column::text("kind", rows.iter().map(|(_, row)| row.kind.to_owned()).collect()),
        Column::number(
            document.parameter.key.clone(),
            unit(&document.parameter.unit),
            rows.iter().map(|(_, row)| row.at.value).collect(),
        ),
    ];
    for (name, label) in &document.header.units.measures.0 {
        let values = rows
            .iter()
            .map(|(_, row)| row.measures.get(name).map_or(f64::NAN, |m| m.rms));
        table.columns.push(Column::number(
            format!("{name}.rms"),
            unit(label),
            values.collect(),
        ));
    }
    table
}

fn events(name: &str, rows: &[Row]) -> Table {
    let (mut branch, mut point, mut phase) = (Vec::new(), Vec::new(), Vec::new());
    let (mut element, mut from, mut to) = (Vec::new(), Vec::new(), Vec::new());
    for row in rows {
        for event in &row.motion.events {
            branch.push(i64::try_from(row.branch).unwrap_or(i64::MAX));
            point.push(i64::try_from(row.point).unwrap_or(i64::MAX));
            phase.push(event.phase);
            element.push(event.element.clone());
            from.push(event.from.clone());
            to.push(event.to.clone());
        }
    }
    let mut table = Table::new(name);
    table.columns = vec![
        Column::integer("branch", branch),
        Column::integer("point", point),
        Column::number("phase", "", phase),
        Column::text("element", element),
        Column::text("from", from),
        Column::text("to", to),
    ];
    table
}

fn harmonics(name: &str, document: &ResponseDocument, rows: &[Row]) -> Table {
    let (mut branch, mut point, mut order) = (Vec::new(), Vec::new(), Vec::new());
    let highest = rows
        .iter()
        .flat_map(|row| row.motion.measures.0.iter().map(|(_, m)| m.harmonics.len()))
        .max()
        .unwrap_or(0);
    for row in rows {
        for k in 0..highest {
            branch.push(i64::try_from(row.branch).unwrap_or(i64::MAX));
            point.push(i64::try_from(row.point).unwrap_or(i64::MAX));
            order.push(i64::try_from(k).unwrap_or(i64::MAX));
        }
    }
    let mut table = Table::new(name);
    table.columns = vec![
        Column::integer("branch", branch),
        Column::integer("point", point),
        Column::integer("order", order),
    ];
    for (name, label) in &document.header.units.measures.0 {
        let part = |i: usize| -> Vec<f64> {
            let values = rows.iter().flat_map(|row| {
                let measure = row.motion.measures.get(name);
                (0..highest).map(move |k| {
                    measure
                        .and_then(|m| m.harmonics.get(k))
                        .map_or(f64::NAN, |h| h[i])
                })
            });
            values.collect()
        };
        table
            .columns
            .push(Column::number(format!("{name}.re"), unit(label), part(0)));
        table
            .columns
            .push(Column::number(format!("{name}.im"), unit(label), part(1)));
    }
    table
}

fn sweep(document: &ResponseDocument) -> Table {
    let rows: Vec<(&str, &SweepPointRow)> = document
        .up
        .iter()
        .map(|row| ("up", row))
        .chain(document.down.iter().map(|row| ("down", row)))
        .collect();
    let mut table = Table::new("sweep");
    table.columns = vec![
        Column::text(
            "direction",
            rows.iter().map(|(name, _)| (*name).to_owned()).collect(),
        ),
        Column::number(
            document.parameter.key.clone(),
            unit(&document.parameter.unit),
            rows.iter().map(|(_, row)| row.at.value).collect(),
        ),
        Column::text("kind", rows.iter().map(|(_, row)| row.kind.clone()).collect()),
    ];
    for (name, label) in &document.header.units.measures.0 {
        let of = |value: &dyn Fn(&Measure) -> f64| -> Vec<f64> {
            rows.iter()
                .map(|(_, row)| row.measures.get(name).map_or(f64::NAN, value))
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
