//! What the figures of several verbs share.

use crate::table_text::number;
use slackside_report::figures::FigureOptions;
use slackside_report::plot::{Axis, Width};
use slackside_studies::{Label, LabelValue};

/// Names of measures as axes call them.
const QUANTITIES: [(&str, &str); 9] = [
    ("windup", "wind-up δθ"),
    ("pulley", "pulley rotation θ_{p}"),
    ("accessory", "accessory rotation θ_{a}"),
    ("clutch_torque", "clutch torque"),
    ("belt_torque", "belt torque"),
    ("windup.rate", "wind-up rate δθ′"),
    ("pulley.rate", "pulley rate θ_{p}′"),
    ("accessory.rate", "accessory rate θ_{a}′"),
    ("frequency", "excitation frequency Ω"),
];

/// Kinds of measures of drives, which stand before the name of a pulley, span or tensioner.
const OF_DRIVES: [(&str, &str); 11] = [
    ("arm.", "arm position"),
    ("rotation.", "rotation"),
    ("accessory.", "accessory rotation"),
    ("tension.", "tension"),
    ("clutch_torque.", "clutch torque"),
    ("friction_torque.", "friction torque"),
    ("windup.", "wind-up"),
    ("overrun.", "overrun speed"),
    ("hub_load.", "hub load"),
    ("deflection.", "deflection"),
    ("contact_force.", "contact force"),
];

/// The name of a measure or key in words.
pub fn words(name: &str) -> String {
    let of_drive = OF_DRIVES.iter().find_map(|(prefix, words)| {
        let rest = name.strip_prefix(prefix)?;
        (!QUANTITIES.iter().any(|(known, _)| *known == name)).then_some((words, rest))
    });
    if let Some((words, rest)) = of_drive {
        let rest = rest.replace(['{', '}', '_', '^'], " ");
        return match rest.strip_suffix(".rate") {
            Some(rest) => format!("rate of {words}, {rest}"),
            None => format!("{words}, {rest}"),
        };
    }
    let known = QUANTITIES.iter().find(|(known, _)| *known == name);
    match known {
        Some((_, words)) => (*words).to_owned(),
        None => {
            // Of a key the last part says what it is; braces and marks of subscripts must not be taken from names.
            let last = match name.strip_suffix(".rate") {
                Some(coordinate) => format!("rate of {coordinate}"),
                None => name.rsplit('.').next().unwrap_or(name).to_owned(),
            };
            last.replace(['{', '}', '_', '^'], " ")
        }
    }
}

/// The words with a capital.
pub fn capital(text: &str) -> String {
    let mut characters = text.chars();
    match characters.next() {
        Some(first) => first.to_uppercase().chain(characters).collect(),
        None => String::new(),
    }
}

/// An axis for a measure or key.
pub fn axis(name: &str, unit: &str) -> Axis {
    Axis::linear(capital(&words(name)), unit)
}

/// The size of figures: two columns wide.
pub fn options() -> FigureOptions {
    FigureOptions {
        width: Width::Double,
        ..FigureOptions::default()
    }
}

/// A member of a family in words: `preload = 0.5`.
pub fn label(label: &Label) -> String {
    let value = match &label.value {
        LabelValue::Number(value) => short(*value),
        // Marks of subscripts must not be taken from files.
        LabelValue::Text(text) => return text.replace(['{', '}', '_', '^'], " "),
    };
    format!("{} = {value}", words(&label.key))
}

/// A value as it was given, without trailing zeros.
pub fn short(value: f64) -> String {
    let text = number(value);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
