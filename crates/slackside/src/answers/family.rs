//! Families of curves in tables.

use slackside_report::Column;
use slackside_studies::{Label, LabelValue};

/// The column of the family key, if there is one: numbers, or texts if one of the values is a text.
pub fn family_column<'a>(labels: impl Iterator<Item = &'a Option<Label>>) -> Option<Column> {
    let labels: Vec<Option<&Label>> = labels.map(Option::as_ref).collect();
    let key = format!("for.{}", labels.iter().flatten().next()?.key);
    let is_text = |label: &&Label| matches!(label.value, LabelValue::Text(_));
    if labels.iter().flatten().any(is_text) {
        let texts = labels
            .iter()
            .map(|label| label.map_or_else(String::new, |label| label.value.to_string()));
        return Some(Column::text(key, texts.collect()));
    }
    let numbers = labels
        .iter()
        .map(|label| label.and_then(Label::number).unwrap_or(f64::NAN));
    Some(Column::number(key, "", numbers.collect()))
}
