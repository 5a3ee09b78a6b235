//! The validity map: errors of both orders along the whole branch, over two keys.

use super::matching::{Curve, error, is_backward};
use super::{Compare, MapCell, Validity, deflection, gamma};
use crate::response::multiple_scales::{deflection_curve, fault, linear_swing};
use crate::response::start::linear;
use crate::response::tracer::{Setup, Tracing};
use crate::response::{Order, Response};
use crate::{Signal, StudyError};
use slackside_continuation::Options;
use slackside_dynamics::branch::{BranchOptions, follow};
use slackside_dynamics::flow::Request;
use slackside_dynamics::orbit::multiple_scales::ModalForm;

/// The cell in a row (second key) and column (first key).
///
/// # Errors
/// [`StudyError`] if there is no system, no resonance or no exact branch.
pub(super) fn cell(
    study: &Compare,
    row: usize,
    column: usize,
    signal: &Signal,
) -> Result<MapCell, StudyError> {
    let (Some(keys), Some(values)) = (&study.map, study.map_values()) else {
        return Err(StudyError::question("--map", "give it twice, once for each key"));
    };
    let (Some(x), Some(y)) = (values[0].get(column), values[1].get(row)) else {
        return Err(StudyError::question("--map", "there is no such cell"));
    };
    let subject = study
        .response
        .subject
        .with_number(&keys[0].key, *x)?
        .with_number(&keys[1].key, *y)?;
    let at = Compare {
        response: Response {
            subject,
            ..study.response.clone()
        },
        ..study.clone()
    };
    let quantity = at.response.quantity(None)?;
    let window = at.window(&quantity, &mut Vec::new())?;
    if linear_swing(&quantity, &window)? <= 1.0 {
        return Ok(MapCell {
            validity: Validity::Linear,
            first_order: None,
            second_order: None,
            gamma: None,
        });
    }
    let options = Options {
        range: window.range,
        locate: false,
        ..at.response.options(&quantity)
    };
    let setup = Setup::new(&quantity, Tracing::Shooting, 1, window.range)?;
    let start = linear(&setup, window.range.1)?;
    let mut shooting = setup.shooting(window.range.1)?;
    let branch = follow(
        &mut shooting,
        &start.state,
        window.range.1,
        &BranchOptions {
            continuation: options.clone(),
            direction: -1.0,
        },
        &mut |_| !signal.is_interrupted(),
    );
    let measure = deflection(&quantity.family.at(window.range.1)?.system)?;
    let mut points = Vec::with_capacity(branch.points.len());
    let mut switching = Vec::with_capacity(branch.points.len());
    let mut deepest = f64::INFINITY;
    for point in &branch.points {
        let system = quantity.family.at(point.parameter)?.system;
        let output = system.output_index(&measure).map(|i| system.outputs[i].clone());
        let record = shooting.summarize(
            &point.unknowns,
            point.parameter,
            &output.into_iter().collect::<Vec<_>>(),
            &Request {
                harmonics: 0,
                extremes: false,
                samples: 0,
                ..Request::default()
            },
        )?;
        let rms = record.measures.first().map_or(f64::NAN, |m| m.rms);
        points.push([point.parameter, rms]);
        switching.push(point.events > 0);
        let form = ModalForm::new(&system).map_err(fault)?;
        deepest = deepest.min(gamma(form.static_deflection, rms));
    }
    // The curve may turn the points round.
    if points
        .first()
        .zip(points.last())
        .is_some_and(|(first, last)| is_backward(*first, *last, &points))
    {
        switching.reverse();
    }
    let exact = Curve::new(points);
    let worst = |order: Order| -> Result<Option<f64>, StudyError> {
        let curve = deflection_curve(&quantity, &window, order, &options, signal)?;
        let curve = [Curve::new(curve.into_iter().map(|(p, rms)| [p, rms]).collect())];
        let indices = (0..exact.points().len()).filter(|&i| switching.get(i) == Some(&true));
        let errors: Option<Vec<f64>> = indices
            .map(|i| error(&exact, i, &curve, study.tolerance))
            .collect();
        Ok(errors.map(|errors| errors.into_iter().fold(0.0, f64::max)))
    };
    let (first_order, second_order) = (worst(Order::First)?, worst(Order::Second)?);
    let fine = |error: Option<f64>| error.is_some_and(|error| error <= study.tolerance);
    Ok(MapCell {
        validity: match (fine(first_order), fine(second_order)) {
            (true, true) => Validity::FirstOrder,
            (_, true) => Validity::SecondOrder,
            _ => Validity::Neither,
        },
        first_order,
        second_order,
        gamma: Some(deepest),
    })
}
