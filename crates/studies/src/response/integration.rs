//! The check of branches by time integration: settled motions with the parameter stepped up and down.

use super::SweepPointRow;
use super::tracer::Setup;
use crate::document::Measure;
use crate::{Label, Measures, Parameter, Progress, Quantity, Range, Signal, StudyError, static_equilibrium};
use slackside_dynamics::attractor::{SweepOptions, SweepStop, sweep};

/// Periods discarded at each value.
const TRANSIENT: usize = 400;

/// Settled motions at `count` values of the range, up and down. An interruption leaves what is finished.
///
/// # Errors
/// [`StudyError`] if a motion cannot be computed.
pub fn up_and_down(
    setup: &Setup,
    quantity: &Quantity,
    over: &Range,
    count: usize,
    label: Option<&Label>,
    signal: &Signal,
) -> Result<(Vec<SweepPointRow>, Vec<SweepPointRow>), StudyError> {
    let (low, high) = over.bounds();
    let last = count.saturating_sub(1).max(1) as f64;
    let values: Vec<f64> = (0..count).map(|i| low + (high - low) * i as f64 / last).collect();
    let falling: Vec<f64> = values.iter().rev().copied().collect();
    let (up, down) = rayon::join(
        || one_way(setup, quantity, &values, label, signal),
        || one_way(setup, quantity, &falling, label, signal),
    );
    Ok((up?, down?))
}

fn one_way(
    setup: &Setup,
    quantity: &Quantity,
    values: &[f64],
    label: Option<&Label>,
    signal: &Signal,
) -> Result<Vec<SweepPointRow>, StudyError> {
    let Some(first) = values.first() else {
        return Ok(Vec::new());
    };
    let point = setup.point(quantity.parameter(*first))?;
    let n = point.system.order();
    let mut state = static_equilibrium(&point.system, point.frequency).unwrap_or_else(|_| vec![0.0; n]);
    state.resize(2 * n, 0.0);
    let options = SweepOptions {
        transient_periods: TRANSIENT,
        samples: 0,
        poincare_points: 0,
        ..SweepOptions::default()
    };
    let parameters: Vec<f64> = values.iter().map(|value| quantity.parameter(*value)).collect();
    let mut rows = Vec::new();
    let stop = sweep(setup.systems(), &parameters, &mut state, &options, &mut |step| {
        let names = point.system.outputs.iter().map(|output| output.name.clone());
        let value = quantity.value(step.parameter);
        rows.push(SweepPointRow {
            at: Parameter {
                key: quantity.key.clone(),
                value,
            },
            label: label.cloned(),
            kind: crate::sweep::kind(&step.attractor),
            measures: Measures(
                names
                    .zip(step.record.measures.iter().map(Measure::from))
                    .collect(),
            ),
        });
        signal.tell(Progress::Step(format!("check at {} = {value:.4}", quantity.key)));
        !signal.is_interrupted()
    });
    match stop {
        SweepStop::Failed { error, .. } => Err(error.into()),
        _ => Ok(rows),
    }
}
