//! Branches from the motions of all passes, and what must be told of them.

use super::search::Outcome;
use super::{Pass, Remark, verdict};
use crate::Label;
use crate::drive::trust::in_words;
use crate::response::{BranchRow, PointRow, ResponseDocument};

/// Relative difference of states from which motions count as different.
const DIFFERENT: f64 = 1e-6;
/// Imbalance of the energy from which a motion is not trusted.
const IMBALANCE: f64 = 1e-8;

/// Adds the branches of one member of the family, its certificate and its warnings to the document.
pub(super) fn add(
    document: &mut ResponseDocument,
    label: &Option<Label>,
    passes: Vec<(Pass, Vec<Outcome>)>,
    periods: usize,
    interrupted: bool,
) {
    let key = document.parameter.key.clone();
    let about = label
        .as_ref()
        .map_or_else(String::new, |label| format!("{label}: "));
    let mut warn = |text: String| document.header.warnings.push(format!("{about}{text}"));
    let ends = [document.parameter.from, document.parameter.to];
    let mut known: Vec<PointRow> = Vec::new();
    let mut rows = Vec::new();
    let mut further = 0;
    let several = passes.len() > 1;
    for (index, (_, mut outcomes)) in passes.into_iter().enumerate() {
        outcomes.sort_by(|a, b| a.value.total_cmp(&b.value));
        if index == 0 {
            document.uniqueness.extend(verdict::runs(label, &outcomes));
        }
        tell_failures(&outcomes, &key, &mut warn);
        let scales = scales(&outcomes);
        let mut segment: Vec<PointRow> = Vec::new();
        let mut fresh: Vec<PointRow> = Vec::new();
        for outcome in outcomes {
            let new = outcome
                .found
                .ok()
                .filter(|point| !is_known(&known, point, &scales));
            match new {
                Some(point) => segment.push(point),
                None if segment.is_empty() => {}
                None => fresh.extend(end(&mut segment, &mut rows, (label, periods, ends, interrupted))),
            }
        }
        fresh.extend(end(&mut segment, &mut rows, (label, periods, ends, interrupted)));
        if index > 0 {
            further += fresh.len();
        }
        known.extend(fresh);
    }
    tell_remarks(&known, &key, &mut warn);
    if let Some(worst) = worst_imbalance(&known) {
        warn(format!(
            "the energy account of the motion at {key} = {} misses {:.1e} of its largest term",
            worst.0, worst.1
        ));
    }
    let doubtful = document
        .uniqueness
        .iter()
        .filter(|row| row.label == *label && !row.no_jumps);
    for row in doubtful.cloned().collect::<Vec<_>>() {
        let found = match (several, further) {
            (false, _) => "motions were sought in one direction only".to_owned(),
            (true, 0) => "going up, going down and starting from rest lead to the same motions".to_owned(),
            (true, count) => format!(
                "going down or starting from rest leads to other motions at {count} values; they are branches of their own"
            ),
        };
        document.header.warnings.push(format!(
            "{about}from {key} = {} to {}: {}; {found}",
            row.from, row.to, row.verdict
        ));
    }
    document.branches.extend(rows);
}

type BranchFacts<'a> = (&'a Option<Label>, usize, [f64; 2], bool);

/// Makes a branch of a segment and returns its points for comparison.
fn end(segment: &mut Vec<PointRow>, rows: &mut Vec<BranchRow>, facts: BranchFacts) -> Vec<PointRow> {
    let (label, periods, [from, to], interrupted) = facts;
    let points = std::mem::take(segment);
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return points;
    };
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (to - from).abs();
    let name = |reaches: bool| match (reaches, interrupted) {
        (true, _) => "range",
        (false, true) => "interrupted",
        (false, false) => "step",
    };
    rows.push(BranchRow {
        label: label.clone(),
        periods,
        ends: [name(close(first.at.value, from)), name(close(last.at.value, to))],
        points: points.clone(),
        special: Vec::new(),
    });
    points
}

/// Largest size of each entry of the state.
fn scales(outcomes: &[Outcome]) -> Vec<f64> {
    let mut scales = Vec::new();
    for point in outcomes.iter().filter_map(|outcome| outcome.found.as_ref().ok()) {
        scales.resize(point.start.len().max(scales.len()), 0.0);
        for (scale, value) in scales.iter_mut().zip(&point.start) {
            *scale = f64::max(*scale, value.abs());
        }
    }
    scales
}

fn is_known(known: &[PointRow], point: &PointRow, scales: &[f64]) -> bool {
    let same = |other: &PointRow| {
        let entries = other.start.iter().zip(&point.start).zip(scales);
        let mut entries = entries.filter(|(_, scale)| **scale > 0.0);
        entries.all(|((a, b), scale)| (a - b).abs() <= DIFFERENT * scale)
    };
    known
        .iter()
        .any(|other| other.at.value == point.at.value && same(other))
}

fn tell_failures(outcomes: &[Outcome], key: &str, warn: &mut dyn FnMut(String)) {
    let failures = || {
        let all = outcomes.iter();
        all.filter_map(|outcome| Some((outcome.value, outcome.found.as_ref().err()?)))
    };
    if let Some((value, reason)) = failures().next() {
        warn(format!(
            "{} of {} values of {key} have no periodic motion, the first is {value}: {reason}",
            failures().count(),
            outcomes.len()
        ));
    }
}

/// One warning for each kind of remark: where each span or pulley is concerned.
fn tell_remarks(points: &[PointRow], key: &str, warn: &mut dyn FnMut(String)) {
    let remarks = points.iter().flat_map(|point| {
        let trust = point.trust.iter().flat_map(|trust| &trust.remarks);
        trust.map(|remark| (point.at.value, remark.clone()))
    });
    let remarks: Vec<(f64, Remark)> = remarks.collect();
    in_words(&remarks, Some(key)).into_iter().for_each(warn);
}

fn worst_imbalance(points: &[PointRow]) -> Option<(f64, f64)> {
    points
        .iter()
        .filter_map(|point| Some((point.at.value, point.motion.energy?.imbalance)))
        .filter(|(_, imbalance)| *imbalance > IMBALANCE)
        .max_by(|a, b| a.1.total_cmp(&b.1))
}
