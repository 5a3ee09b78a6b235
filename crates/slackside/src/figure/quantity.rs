//! Measured quantities, conditions on them and the sentence that tells them.

use super::columns::{rows, values};
use super::recipe::{Quantity, Take};
use exmex::prelude::*;
use slackside_report::Table;
use std::collections::BTreeMap;

/// Quantities by name.
pub type Quantities = BTreeMap<String, f64>;

/// Measures a quantity in its table.
///
/// # Errors
/// Why there is no such quantity.
pub fn measure(quantity: &Quantity, table: &Table, found: &mut Quantities) -> Result<(), String> {
    let rows = rows(table, &quantity.filter)?;
    let name = &quantity.name;
    if quantity.take == Take::Count {
        found.insert(name.clone(), rows.len() as f64);
        return Ok(());
    }
    let (values, _) = values(table, &rows, &quantity.value)?;
    let at = match &quantity.at {
        Some(at) => Some(self::values(table, &rows, at)?.0),
        None => None,
    };
    let Some(last) = values.len().checked_sub(1) else {
        return Err(format!("no row of the table \"{}\" is asked for", table.name));
    };
    // The number of the value, where it is one of them.
    let index = match quantity.take {
        Take::All => {
            let mut values = values;
            values.sort_by(f64::total_cmp);
            if let [only] = values[..] {
                found.insert(name.clone(), only);
            }
            for (i, value) in values.iter().enumerate() {
                found.insert(format!("{name}_{}", i + 1), *value);
            }
            return Ok(());
        }
        Take::Mean => {
            found.insert(name.clone(), values.iter().sum::<f64>() / values.len() as f64);
            return Ok(());
        }
        Take::Crossing => {
            let (Some(at), Some(level)) = (at, quantity.level) else {
                return Err("a crossing needs `at` and `level`".to_owned());
            };
            let mut count = 0;
            for (a, y) in at.windows(2).zip(values.windows(2)) {
                if (a[0] - level) * (a[1] - level) < 0.0 || a[1] == level {
                    count += 1;
                    let share = (level - a[0]) / (a[1] - a[0]);
                    found.insert(format!("{name}_{count}"), y[0] + share * (y[1] - y[0]));
                }
            }
            found.insert(format!("{name}_count"), f64::from(count));
            return Ok(());
        }
        Take::JumpUp | Take::JumpDown => {
            let sign = if quantity.take == Take::JumpUp { 1.0 } else { -1.0 };
            let steps = values.windows(2).map(|pair| sign * (pair[1] - pair[0]));
            let largest = steps.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((index, _)) = largest else {
                return Err("a jump needs two rows".to_owned());
            };
            found.insert(format!("{name}_from"), values[index]);
            found.insert(format!("{name}_to"), values[index + 1]);
            if let Some(at) = at {
                found.insert(format!("{name}_at"), 0.5 * (at[index] + at[index + 1]));
            }
            return Ok(());
        }
        Take::Max => (0..=last).max_by(|a, b| values[*a].total_cmp(&values[*b])),
        Take::Min => (0..=last).min_by(|a, b| values[*a].total_cmp(&values[*b])),
        Take::First => Some(0),
        Take::Last | Take::Count => Some(last),
    };
    let index = index.unwrap_or(last);
    found.insert(name.clone(), values[index]);
    if let Some(at) = at {
        found.insert(format!("{name}_at"), at[index]);
    }
    Ok(())
}

/// The value of an expression in quantities.
///
/// # Errors
/// What is wrong with the expression, or that a quantity is missing.
pub fn evaluate(text: &str, found: &Quantities) -> Result<f64, String> {
    // Expressions know no powers of ten like 1e-8, numbers do.
    if let Ok(number) = text.trim().parse() {
        return Ok(number);
    }
    let expression = exmex::parse::<f64>(text.trim()).map_err(|error| format!("`{text}`: {error}"))?;
    let inputs = expression.var_names().iter().map(|name| {
        let known = || found.keys().cloned().collect::<Vec<_>>().join(", ");
        let value = found.get(name).copied();
        value.ok_or_else(|| format!("`{name}` was not found; there are {}", known()))
    });
    let inputs = inputs.collect::<Result<Vec<f64>, String>>()?;
    expression
        .eval(&inputs)
        .map_err(|error| format!("`{text}`: {error}"))
}

/// Whether a chain of expressions joined by `<` rises.
///
/// # Errors
/// As [`evaluate`]; that there is no `<`.
pub fn holds(check: &str, found: &Quantities) -> Result<bool, String> {
    let values = check.split('<').map(|part| evaluate(part, found));
    let values = values.collect::<Result<Vec<f64>, String>>()?;
    if values.len() < 2 {
        return Err(format!("`{check}` has no `<`"));
    }
    Ok(values.windows(2).all(|pair| pair[0] < pair[1]))
}

/// The sentence with numbers in place of its braces.
///
/// # Errors
/// As [`evaluate`].
pub fn sentence(text: &str, found: &Quantities) -> Result<String, String> {
    let mut told = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let (inside, behind) = after.split_once('}').ok_or("a `{` has no `}`")?;
        let (expression, digits) = match inside.rsplit_once(':') {
            Some((expression, digits)) => (
                expression,
                digits
                    .trim()
                    .parse()
                    .map_err(|_| format!("`{digits}` is no number of digits"))?,
            ),
            None => (inside, 4),
        };
        told += before;
        told += &rounded(evaluate(expression, found)?, digits);
        rest = behind;
    }
    Ok((told + rest).trim().to_owned())
}

/// A number with so many significant digits, without trailing zeros behind the point.
fn rounded(value: f64, digits: u8) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 {
            "0".to_owned()
        } else {
            "–".to_owned()
        };
    }
    let size = value.abs().log10().floor() as i32;
    if !(-4..7).contains(&size) {
        return format!("{value:.*e}", usize::from(digits.saturating_sub(1)));
    }
    let places = usize::try_from(i32::from(digits) - 1 - size).unwrap_or(0);
    let text = format!("{value:.places$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_hold_numbers_with_the_digits_asked_for() {
        let found = Quantities::from([("fold".to_owned(), 4.480823726), ("small".to_owned(), 1.25e-7)]);
        let told = sentence("folds at {fold}, twice {2*fold:2}, error {small:2}", &found);
        assert_eq!(told.unwrap(), "folds at 4.481, twice 9, error 1.2e-7");
        assert!(sentence("{missing}", &found).unwrap_err().contains("fold, small"));
        assert!(sentence("{fold", &found).is_err());
    }

    #[test]
    fn chains_must_rise_everywhere() {
        let found = Quantities::from([("a".to_owned(), 1.0), ("b".to_owned(), 2.0)]);
        assert!(holds("a < b < a + 3", &found).unwrap());
        assert!(!holds("a < b < 2", &found).unwrap());
        assert!(holds("a", &found).is_err());
    }
}
