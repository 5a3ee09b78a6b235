//! Rows and columns of tables as recipes name them.

use super::recipe::Filter;
use exmex::prelude::*;
use slackside_report::{Column, Table, Values};

/// The rows that pass a filter.
///
/// # Errors
/// What is wrong with the filter.
pub fn rows(table: &Table, filter: &Filter) -> Result<Vec<usize>, String> {
    let mut kept: Vec<usize> = (0..table.rows()).collect();
    for (name, wanted) in filter {
        let column = column(table, name)?;
        let passes: Box<dyn Fn(usize) -> bool> = match wanted {
            toml::Value::String(text) => match bound(text) {
                Some((relation, limit)) => {
                    let values = numbers(column)?;
                    Box::new(move |row| {
                        values[row]
                            .partial_cmp(&limit)
                            .is_some_and(|order| relation.contains(&order))
                    })
                }
                None => {
                    let values = texts(column);
                    let text = text.clone();
                    Box::new(move |row| values[row] == text)
                }
            },
            toml::Value::Boolean(flag) => {
                let values = texts(column);
                let text = flag.to_string();
                Box::new(move |row| values[row] == text)
            }
            toml::Value::Integer(_) | toml::Value::Float(_) => {
                let values = numbers(column)?;
                let wanted = wanted
                    .as_float()
                    .or(wanted.as_integer().map(|number| number as f64));
                let wanted = wanted.unwrap_or(f64::NAN);
                // A value that came through a file and a unit may have lost its last digit.
                Box::new(move |row| (values[row] - wanted).abs() <= 1e-12 * wanted.abs())
            }
            _ => return Err(format!("`where.{name}` is neither a text nor a number")),
        };
        kept.retain(|row| passes(*row));
    }
    Ok(kept)
}

/// `>= 5` as orders that pass, and the limit.
fn bound(text: &str) -> Option<(Vec<std::cmp::Ordering>, f64)> {
    use std::cmp::Ordering::{Equal, Greater, Less};
    let relations = [
        (">=", vec![Greater, Equal]),
        ("<=", vec![Less, Equal]),
        (">", vec![Greater]),
        ("<", vec![Less]),
    ];
    let (sign, orders) = relations.into_iter().find(|(sign, _)| text.starts_with(sign))?;
    Some((orders, text[sign.len()..].trim().parse().ok()?))
}

/// A column by name.
///
/// # Errors
/// That there is none, and which there are.
pub fn column<'a>(table: &'a Table, name: &str) -> Result<&'a Column, String> {
    let found = table.columns.iter().find(|column| column.name == name);
    found.ok_or_else(|| {
        let known: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        format!(
            "the table \"{}\" has no column \"{name}\"; it has {}",
            table.name,
            known.join(", ")
        )
    })
}

/// The values of a column as numbers.
///
/// # Errors
/// That it holds texts.
pub fn numbers(column: &Column) -> Result<Vec<f64>, String> {
    Ok(match &column.values {
        Values::Number(values) => values.clone(),
        Values::Integer(values) => values.iter().map(|value| *value as f64).collect(),
        Values::Boolean(values) => values.iter().map(|value| f64::from(u8::from(*value))).collect(),
        Values::Text(_) => return Err(format!("the column \"{}\" holds texts", column.name)),
    })
}

/// The values of a column as texts.
pub fn texts(column: &Column) -> Vec<String> {
    match &column.values {
        Values::Number(values) => values.iter().map(|value| crate::plots::short(*value)).collect(),
        Values::Integer(values) => values.iter().map(i64::to_string).collect(),
        Values::Boolean(values) => values.iter().map(bool::to_string).collect(),
        Values::Text(values) => values.clone(),
    }
}

/// A column, or an expression in columns, at some rows, and its unit if it is a column.
///
/// # Errors
/// What is wrong with the expression.
pub fn values(table: &Table, rows: &[usize], text: &str) -> Result<(Vec<f64>, Option<String>), String> {
    if let Some(column) = table.columns.iter().find(|column| column.name == text) {
        let values = numbers(column)?;
        let unit = Some(column.unit.clone());
        return Ok((rows.iter().map(|row| values[*row]).collect(), unit));
    }
    let expression = exmex::parse::<f64>(text).map_err(|error| match column(table, text) {
        Err(unknown) => format!("{unknown}; and it is no expression: {error}"),
        Ok(_) => error.to_string(),
    })?;
    let inputs = expression
        .var_names()
        .iter()
        .map(|name| numbers(column(table, name)?));
    let inputs = inputs.collect::<Result<Vec<Vec<f64>>, String>>()?;
    let at = |row: &usize| {
        let inputs: Vec<f64> = inputs.iter().map(|values| values[*row]).collect();
        expression
            .eval(&inputs)
            .map_err(|error| format!("`{text}`: {error}"))
    };
    Ok((rows.iter().map(at).collect::<Result<_, String>>()?, None))
}
