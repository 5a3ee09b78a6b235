//! Motions to begin with: the linear response at both ends of the range, and what long integrations settle on.

use super::tracer::{KnownMotion, Setup};
use crate::{Signal, StudyError, linear_response, static_equilibrium};
use rayon::prelude::*;
use slackside_dynamics::flow::open;

/// Parameter values at which motions are integrated until they settle.
const VALUES: usize = 13;
/// Periods after which an integration is given up.
const MOST_PERIODS: usize = 600;
/// Longest period looked for, in periods of the load.
const LONGEST: usize = 12;
/// Relative difference at which a state counts as repeated.
const REPEATED: f64 = 1e-7;

/// Motions of the setup's period, in the order in which their branches should be followed. Many lie on one branch.
pub fn find(setup: &Setup, signal: &Signal) -> Vec<KnownMotion> {
    let (low, high) = setup.range;
    let mut found = Vec::new();
    if setup.periods == 1 {
        found.extend([high, low].iter().filter_map(|p| linear(setup, *p).ok()));
    }
    let values: Vec<f64> = (0..VALUES)
        .map(|i| low + (high - low) * (i as f64 + 0.5) / VALUES as f64)
        .collect();
    let mut falling = values.clone();
    falling.reverse();
    // Chains keep a motion along as the parameter rises or falls; single runs begin at rest.
    let mut chains: Vec<Vec<f64>> = vec![values.clone(), falling];
    chains.extend(values.iter().map(|p| vec![*p]));
    let settled: Vec<Vec<KnownMotion>> = chains
        .par_iter()
        .map(|chain| run_chain(setup, chain, signal))
        .collect();
    found.extend(settled.into_iter().flatten());
    found
}

/// The motion near the linear response.
///
/// # Errors
/// [`StudyError::NoAnswer`] if shooting does not converge from it.
pub fn linear(setup: &Setup, parameter: f64) -> Result<KnownMotion, StudyError> {
    let point = setup.point(parameter)?;
    let rest = static_equilibrium(&point.system, point.frequency)?;
    let start = linear_response(&point.system, point.frequency, &rest)?.start();
    let mut still = rest;
    still.resize(start.len(), 0.0);
    let mut shooting = setup.shooting(parameter)?;
    let orbit = shooting
        .solve(&start, parameter)
        .or_else(|_| shooting.solve(&still, parameter))
        .map_err(|error| StudyError::NoAnswer(error.to_string()))?;
    Ok(KnownMotion {
        parameter,
        state: orbit.start,
    })
}

fn run_chain(setup: &Setup, chain: &[f64], signal: &Signal) -> Vec<KnownMotion> {
    let mut found = Vec::new();
    let mut state: Option<Vec<f64>> = None;
    for &parameter in chain {
        if signal.is_interrupted() {
            break;
        }
        let Ok((end, period)) = settle(setup, parameter, state.take(), signal) else {
            continue;
        };
        state = Some(end.clone());
        if period.is_some_and(|period| period != setup.periods) {
            continue;
        }
        // A motion that has not settled may still be near a periodic one.
        let polished = setup.shooting(parameter).and_then(|mut shooting| {
            shooting
                .solve(&end, parameter)
                .map_err(|error| StudyError::NoAnswer(error.to_string()))
        });
        if let Ok(orbit) = polished
            && primitive(setup, parameter, &orbit.start)
        {
            found.push(KnownMotion {
                parameter,
                state: orbit.start,
            });
        }
    }
    found
}

/// Whether a motion of the setup's period does not repeat earlier.
fn primitive(setup: &Setup, parameter: f64, state: &[f64]) -> bool {
    if setup.periods == 1 {
        return true;
    }
    let Ok(mut flow) = setup.point(parameter).and_then(|point| Ok(open(&point)?)) else {
        return false;
    };
    let mut moved = state.to_vec();
    for _ in 1..setup.periods {
        if flow.advance(&mut moved, 1, &mut []).is_err() {
            return false;
        }
        if distance(&moved, state, &setup.scales) < 1e-5 {
            return false;
        }
    }
    true
}

/// Integrates until the state repeats; the last state and after how many periods of the load it repeats.
fn settle(
    setup: &Setup,
    parameter: f64,
    start: Option<Vec<f64>>,
    signal: &Signal,
) -> Result<(Vec<f64>, Option<usize>), StudyError> {
    let point = setup.point(parameter)?;
    let mut flow = open(&point)?;
    let mut state = match start {
        Some(state) => state,
        None => {
            let mut rest = static_equilibrium(&point.system, point.frequency)
                .unwrap_or_else(|_| vec![0.0; point.system.order()]);
            rest.resize(2 * rest.len(), 0.0);
            rest
        }
    };
    let mut history: Vec<Vec<f64>> = Vec::with_capacity(LONGEST);
    for _ in 0..MOST_PERIODS {
        if signal.is_interrupted() {
            return Err(StudyError::Interrupted);
        }
        flow.advance(&mut state, 1, &mut [])?;
        let repeated = history
            .iter()
            .rev()
            .position(|earlier| distance(&state, earlier, &setup.scales) < REPEATED);
        if let Some(position) = repeated {
            return Ok((state, Some(position + 1)));
        }
        if history.len() == LONGEST {
            history.remove(0);
        }
        history.push(state.clone());
    }
    Ok((state, None))
}

/// Largest scaled difference of two states.
pub fn distance(a: &[f64], b: &[f64], scales: &[f64]) -> f64 {
    let pairs = a.iter().zip(b).zip(scales);
    pairs.fold(0.0, |largest, ((a, b), scale)| {
        largest.max(((a - b) / scale).abs())
    })
}
