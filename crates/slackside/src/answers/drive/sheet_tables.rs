//! Tables of the steady sheet.

use slackside_report::{Column, Table};
use slackside_studies::drive::steady::{Outcome, PulleyRow, SpanRow, StateRow, SteadyDocument, TensionerRow};

/// All tables of a sheet.
pub fn tables(sheet: &SteadyDocument) -> Vec<Table> {
    let mut tables = vec![spans(&sheet.spans), pulleys(&sheet.pulleys)];
    if !sheet.tensioners.is_empty() {
        tables.push(tensioners(&sheet.tensioners));
    }
    if !sheet.conditions.is_empty() {
        let names = sheet.conditions.iter().map(|row| row.name.clone()).collect();
        let outcomes: Vec<&Outcome> = sheet.conditions.iter().map(|row| &row.outcome).collect();
        let mut table = Table::new("conditions");
        table.columns.push(Column::text("condition", names));
        table.columns.extend(states(sheet, &outcomes));
        tables.push(table);
    }
    if let Some(parameter) = &sheet.parameter {
        let mut table = Table::new("over");
        let rows = || {
            sheet
                .over
                .iter()
                .flat_map(|row| row.values.iter().zip(&row.outcomes).map(move |at| (row, at)))
        };
        let outcomes: Vec<&Outcome> = rows().map(|(_, (_, outcome))| outcome).collect();
        table.columns = vec![
            Column::text("condition", rows().map(|(row, _)| row.name.clone()).collect()),
            Column::number(
                parameter.key.clone(),
                parameter.unit.clone(),
                rows().map(|(_, (value, _))| *value).collect(),
            ),
        ];
        table.columns.extend(states(sheet, &outcomes));
        tables.push(table);
    }
    tables
}

fn spans(spans: &[SpanRow]) -> Table {
    let column = |value: &dyn Fn(&SpanRow) -> f64| spans.iter().map(value).collect::<Vec<f64>>();
    let mut table = Table::new("spans");
    table.columns = vec![
        Column::text("from", spans.iter().map(|span| span.from.clone()).collect()),
        Column::text("to", spans.iter().map(|span| span.to.clone()).collect()),
        Column::number("length", "m", column(&|span| span.length)),
        Column::number("tension", "N", column(&|span| span.tension)),
        Column::number("effective_tension", "N", column(&|span| span.effective_tension)),
        Column::number("frequency_1", "Hz", column(&|span| span.frequency_1)),
        Column::number("sag_indicator", "", column(&|span| span.sag_indicator)),
    ];
    table
}

fn pulleys(pulleys: &[PulleyRow]) -> Table {
    let column = |value: &dyn Fn(&PulleyRow) -> f64| pulleys.iter().map(value).collect::<Vec<f64>>();
    let optional =
        |value: &dyn Fn(&PulleyRow) -> Option<f64>| column(&|pulley| value(pulley).unwrap_or(f64::NAN));
    let mut table = Table::new("pulleys");
    table.columns = vec![
        Column::text("name", pulleys.iter().map(|pulley| pulley.name.clone()).collect()),
        Column::number("radius", "m", column(&|pulley| pulley.radius)),
        Column::number("wrap", "rad", column(&|pulley| pulley.wrap)),
        Column::number("speed", "rpm", column(&|pulley| pulley.speed)),
        Column::number("ratio", "", column(&|pulley| pulley.ratio)),
        Column::number("torque", "N m", column(&|pulley| pulley.torque)),
        Column::number("hub_load_x", "N", column(&|pulley| pulley.hub_load[0])),
        Column::number("hub_load_y", "N", column(&|pulley| pulley.hub_load[1])),
        Column::number("hub_load", "N", column(&|pulley| pulley.hub_load_magnitude)),
        Column::number("slip_safety", "", optional(&|pulley| pulley.slip_safety)),
        Column::number("slip_torque", "N m", column(&|pulley| pulley.slip_torque)),
        Column::number("slip_arc", "rad", optional(&|pulley| pulley.slip_arc)),
        Column::number("speed_loss", "", optional(&|pulley| pulley.speed_loss)),
    ];
    table
}

fn tensioners(rows: &[TensionerRow]) -> Table {
    let column = |value: &dyn Fn(&TensionerRow) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    let mut table = Table::new("tensioners");
    table.columns = vec![
        Column::text("name", rows.iter().map(|row| row.name.clone()).collect()),
        Column::text("kind", rows.iter().map(|row| row.kind.to_owned()).collect()),
        Column::number(
            "position",
            "rad or m",
            column(&|row| row.angle.or(row.position).unwrap_or(f64::NAN)),
        ),
        Column::number("travel", "rad or m", column(&|row| row.travel)),
        Column::number("take_up", "m/rad or 1", column(&|row| row.take_up)),
        Column::number("torque", "N m or N", column(&|row| row.torque)),
    ];
    table
}

/// Columns of steady states, empty where one is impossible, with the reason in the last column.
fn states(sheet: &SteadyDocument, outcomes: &[&Outcome]) -> Vec<Column> {
    let column = |value: &dyn Fn(&StateRow) -> f64| -> Vec<f64> {
        outcomes
            .iter()
            .map(|outcome| match outcome {
                Outcome::State(state) => value(state),
                Outcome::Impossible { .. } => f64::NAN,
            })
            .collect()
    };
    let mut columns = Vec::new();
    for (i, span) in sheet.spans.iter().enumerate() {
        let name = format!("tension.{}-{}", span.from, span.to);
        columns.push(Column::number(name, "N", column(&|state| state.tensions[i])));
    }
    for (j, pulley) in sheet.pulleys.iter().enumerate() {
        for (axis, letter) in ["x", "y"].into_iter().enumerate() {
            columns.push(Column::number(
                format!("hub_load.{}.{letter}", pulley.name),
                "N",
                column(&|state| state.hub_loads[j][axis]),
            ));
        }
        columns.push(Column::number(
            format!("slip_safety.{}", pulley.name),
            "",
            column(&|state| state.slip_safeties[j].unwrap_or(f64::NAN)),
        ));
    }
    for (arm, tensioner) in sheet.tensioners.iter().enumerate() {
        columns.push(Column::number(
            format!("arm.{}", tensioner.name),
            if tensioner.angle.is_some() { "rad" } else { "m" },
            column(&|state| state.positions[arm]),
        ));
    }
    columns.push(Column::text(
        "impossible",
        outcomes
            .iter()
            .map(|outcome| match outcome {
                Outcome::State(_) => String::new(),
                Outcome::Impossible { impossible } => impossible.clone(),
            })
            .collect(),
    ));
    columns
}
