//! All motions at exact values of the parameter.

use super::OrbitRow;
use super::curve::Curve;
use super::document::multiplier_pairs;
use super::start::distance;
use super::tracer::{KnownMotion, Setup};
use crate::{Label, Parameter, Quantity, StudyError};
use rayon::prelude::*;

/// The motions of all branches at the values (user's unit), each corrected at the fixed parameter.
///
/// # Errors
/// [`StudyError`] if a motion that the branches show is not found.
pub fn orbits(
    setup: &Setup,
    curves: &[Curve],
    quantity: &Quantity,
    values: &[f64],
    label: Option<Label>,
    harmonics: usize,
) -> Result<Vec<OrbitRow>, StudyError> {
    let wanted: Vec<(f64, usize, Vec<f64>)> = values
        .iter()
        .flat_map(|value| {
            curves.iter().enumerate().flat_map(move |(branch, curve)| {
                let states = curve.states_at(quantity.parameter(*value)).into_iter();
                states.map(move |state| (*value, branch, state))
            })
        })
        .collect();
    let found: Vec<(f64, usize, Vec<f64>, OrbitRow)> = wanted
        .par_iter()
        .map(|(value, branch, state)| {
            let setup = setup.of_curve(&curves[*branch]);
            let near = KnownMotion {
                parameter: quantity.parameter(*value),
                state: state.clone(),
            };
            let solved = setup.solve(&near, harmonics)?;
            let row = OrbitRow {
                at: Parameter {
                    key: quantity.key.clone(),
                    value: *value,
                },
                label: label.clone(),
                branch: *branch,
                periods: setup.periods,
                stable: solved.multipliers.iter().all(|m| m.norm() < 1.0),
                multipliers: multiplier_pairs(&solved.multipliers),
                residual: solved.residual,
                start: solved.state.clone(),
                multiple_scales: None,
                trust: None,
                motion: solved.motion,
                history: None,
            };
            Ok((*value, *branch, solved.state, row))
        })
        .collect::<Result<_, StudyError>>()?;
    // Next to a fold or a crossing two starts may lead to one motion.
    let mut rows: Vec<(f64, usize, Vec<f64>, OrbitRow)> = Vec::new();
    for entry in found {
        let known = rows.iter().any(|(value, branch, state, _)| {
            *value == entry.0 && *branch == entry.1 && distance(state, &entry.2, &setup.scales) < 1e-9
        });
        if !known {
            rows.push(entry);
        }
    }
    Ok(rows.into_iter().map(|(_, _, _, row)| row).collect())
}
