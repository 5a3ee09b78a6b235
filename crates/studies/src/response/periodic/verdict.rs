//! What is known of the uniqueness of the response, in intervals of the parameter.

use super::search::Outcome;
use crate::Label;
use serde::Serialize;
use slackside_dynamics::receptance::Uniqueness;
use std::mem::discriminant;

/// The certificate of uniqueness over an interval of the parameter (theory 05 §2.1).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UniquenessRow {
    /// Value of the family key, if there are several.
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub label: Option<Label>,
    /// First value of the interval.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Whether the response is certainly unique and attracts all motions.
    pub unique: bool,
    /// Whether jumps and hysteresis are certainly absent.
    pub no_jumps: bool,
    /// The verdict in words; of an interval without a certificate that at its first value.
    pub verdict: String,
}

/// The verdict in words, with what holds as long as no stop is reached.
fn words(outcome: &Outcome, verdict: &Uniqueness) -> String {
    match &outcome.between_stops {
        Some(certificate) => {
            format!("{verdict}; among motions that reach no stop, as this one, {certificate}")
        }
        None => verdict.to_string(),
    }
}

/// Runs of equal verdicts over outcomes with rising values.
pub(super) fn runs(label: &Option<Label>, outcomes: &[Outcome]) -> Vec<UniquenessRow> {
    let mut rows: Vec<UniquenessRow> = Vec::new();
    let mut last: Option<&Uniqueness> = None;
    for outcome in outcomes {
        let Some(verdict) = &outcome.uniqueness else {
            last = None;
            continue;
        };
        match (last, rows.last_mut()) {
            (Some(known), Some(row)) if discriminant(known) == discriminant(verdict) => {
                row.to = outcome.value
            }
            _ => rows.push(UniquenessRow {
                label: label.clone(),
                from: outcome.value,
                to: outcome.value,
                unique: verdict.is_unique(),
                no_jumps: verdict.excludes_jumps(),
                verdict: words(outcome, verdict),
            }),
        }
        last = Some(verdict);
    }
    rows
}
