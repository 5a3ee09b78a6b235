//! Branches by the method of multiple scales (theory 02 §10, §11): which resonances the range holds, their branches, and
//! what must be said of them.

mod resonance;

use super::{Found, Response};
use crate::{Quantity, Signal, StudyError};
use resonance::Job;
use slackside_continuation::Options;
use slackside_dynamics::orbit::multiple_scales::{ModalForm, MultipleScalesError, Order, PrimaryResonance};

/// Distance from a natural frequency, relative to it, within which a load is near its primary resonance.
pub(crate) const NEAR: f64 = 0.5;
/// Parameter values at which branches are looked for, and at which the linear response is tested for separation.
const STARTS: usize = 13;
/// Values at which the linear response is tested for separation, and points of a linear branch.
const LINEAR: usize = 401;
/// Distance in the scaled unknowns below which a state counts as lying on a branch.
const ON_BRANCH: f64 = 1e-2;

/// A mode and the part of the range (family's parameter) in which its primary resonance is treated.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Window {
    /// Index of the mode, from zero.
    pub mode: usize,
    /// Part of the range.
    pub range: (f64, f64),
}

/// The failure as a study tells it.
pub(crate) fn fault(error: MultipleScalesError) -> StudyError {
    match error {
        MultipleScalesError::Mode { .. } => StudyError::question("--mode", error.to_string()),
        _ => StudyError::NoAnswer(error.to_string()),
    }
}

/// Runs one job of the study.
///
/// # Errors
/// [`StudyError::NoAnswer`] if the system is not of the form that the method needs, or the range holds no primary resonance.
pub(super) fn run(
    question: &Response,
    quantity: &Quantity,
    (order, mode): (Order, Option<usize>),
    value: Option<f64>,
    options: &Options,
    signal: &Signal,
) -> Result<Found, StudyError> {
    let label = question.label(value);
    let mut found = Found {
        value,
        branches: Vec::new(),
        orbits: Vec::new(),
        up: Vec::new(),
        down: Vec::new(),
        warnings: Vec::new(),
    };
    for window in windows(quantity, mode, options.range, &mut found.warnings)? {
        if signal.is_interrupted() {
            break;
        }
        let job = Job {
            quantity,
            order,
            label: label.as_ref(),
            harmonics: question.harmonics,
            window: &window,
        };
        if job.is_linear()? {
            found.warnings.push(format!(
                "nothing separates near mode {} ({}): the linear response is exact, and is given",
                window.mode + 1,
                job.reach()?
            ));
            let at = question.at.iter().map(|at| quantity.parameter(*at));
            let inside: Vec<f64> = at
                .filter(|p| (window.range.0..=window.range.1).contains(p))
                .collect();
            let orbits = inside.iter().map(|&p| job.linear_orbit(p, found.branches.len()));
            let orbits = orbits.collect::<Result<Vec<_>, _>>()?;
            found.orbits.extend(orbits);
            found.branches.push(job.linear_branch()?);
            continue;
        }
        job.branches(
            &Options {
                range: window.range,
                ..options.clone()
            },
            &mut found,
            signal,
        )?;
        for at in &question.at {
            let parameter = quantity.parameter(*at);
            if (window.range.0..=window.range.1).contains(&parameter) {
                job.orbits(*at, parameter, &mut found)?;
            }
        }
    }
    if found.branches.is_empty() && !signal.is_interrupted() {
        return Err(StudyError::NoAnswer(format!(
            "multiple scales finds no steady state in the range; {}",
            found.warnings.join("; ")
        )));
    }
    Ok(found)
}

/// The one resonance that the range reaches, or that is asked for.
///
/// # Errors
/// [`StudyError`] if there is none, or several.
pub(crate) fn window(
    quantity: &Quantity,
    asked: Option<usize>,
    range: (f64, f64),
    warnings: &mut Vec<String>,
) -> Result<Window, StudyError> {
    let mut found = windows(quantity, asked, range, warnings)?;
    if found.len() > 1 {
        return Err(StudyError::question(
            "--mode",
            "the range holds several resonances; choose one by its number, or a narrower range",
        ));
    }
    found
        .pop()
        .ok_or_else(|| StudyError::NoAnswer("the range holds no primary resonance".to_owned()))
}

/// Parameter and deflection RMS along the branch that begins at the upper end of a window, without further measures; empty
/// if nothing separates there.
///
/// # Errors
/// [`StudyError`] as [`run`].
pub(crate) fn deflection_curve(
    quantity: &Quantity,
    window: &Window,
    order: Order,
    options: &Options,
    signal: &Signal,
) -> Result<Vec<(f64, f64)>, StudyError> {
    let job = Job {
        quantity,
        order,
        label: None,
        harmonics: 0,
        window,
    };
    let (resonance, point) = job.resonance(window.range.1)?;
    let mut curve = Vec::new();
    if let Some(state) = resonance.states_at(order, point.frequency).first()
        && let Some(track) = job.follow(window.range.1, state, options, signal)
    {
        for point in &track.joined.points {
            let (resonance, state) = track.state(point)?;
            curve.push((point.parameter, resonance.windup(order, &state).rms));
        }
    }
    Ok(curve)
}

/// Largest swing of the linear response over a window, relative to the distance from the switching point; at or below one
/// nothing separates.
///
/// # Errors
/// [`StudyError`] as [`run`].
pub(crate) fn linear_swing(quantity: &Quantity, window: &Window) -> Result<f64, StudyError> {
    let job = Job {
        quantity,
        order: Order::First,
        label: None,
        harmonics: 0,
        window,
    };
    job.largest_swing()
}

/// The resonances that the range reaches.
fn windows(
    quantity: &Quantity,
    asked: Option<usize>,
    (low, high): (f64, f64),
    warnings: &mut Vec<String>,
) -> Result<Vec<Window>, StudyError> {
    let point = quantity.family.at(low)?;
    let form = ModalForm::new(&point.system).map_err(fault)?;
    if asked == Some(0) {
        return Err(StudyError::question("--mode", "modes are counted from 1"));
    }
    let asked = asked.map(|mode| mode - 1);
    if let Some(mode) = asked {
        PrimaryResonance::new(form.clone(), mode).map_err(fault)?;
    }
    let shown = |frequency: f64| {
        if quantity.is_frequency() {
            quantity.value(frequency)
        } else {
            frequency
        }
    };
    let natural: Vec<f64> = form.modes.iter().map(|mode| mode.frequency).collect();
    let no_resonance = |what: String| {
        let list: Vec<String> = natural.iter().map(|w| format!("{:.6}", shown(*w))).collect();
        StudyError::NoAnswer(format!(
            "no primary resonance: {what} is not within {:.0} % of a natural frequency that the load excites ({})",
            100.0 * NEAR,
            list.join(", ")
        ))
    };
    if !quantity.is_frequency() {
        let ratio = |w: f64| (point.frequency / w).ln().abs();
        let nearest = (0..natural.len()).min_by(|&a, &b| ratio(natural[a]).total_cmp(&ratio(natural[b])));
        let mode = asked.or(nearest).unwrap_or(0);
        let near = natural
            .get(mode)
            .is_some_and(|w| (point.frequency / w - 1.0).abs() <= NEAR);
        if !near {
            return Err(no_resonance(format!("the frequency {:.6}", point.frequency)));
        }
        PrimaryResonance::new(form, mode).map_err(fault)?;
        return Ok(vec![Window {
            mode,
            range: (low, high),
        }]);
    }
    let (mut windows, mut refused) = (Vec::new(), Vec::new());
    for (mode, w) in natural.iter().enumerate() {
        if asked.is_some_and(|asked| asked != mode) {
            continue;
        }
        let mut range = (low.max((1.0 - NEAR) * w), high.min((1.0 + NEAR) * w));
        if asked.is_none() {
            // Between two resonances each has the frequencies that are nearer to it.
            if mode > 0 {
                range.0 = range.0.max((natural[mode - 1] * w).sqrt());
            }
            if let Some(next) = natural.get(mode + 1) {
                range.1 = range.1.min((next * w).sqrt());
            }
        }
        if range.0 < range.1 {
            if let Err(error) = PrimaryResonance::new(form.clone(), mode) {
                refused.push(error.to_string());
                continue;
            }
            windows.push(Window { mode, range });
        }
    }
    let covered: f64 = windows.iter().map(|window| window.range.1 - window.range.0).sum();
    if windows.is_empty() && !refused.is_empty() {
        return Err(StudyError::NoAnswer(refused.join("; ")));
    }
    warnings.append(&mut refused);
    if windows.is_empty() {
        return Err(no_resonance(format!(
            "the range {} to {}",
            shown(low),
            shown(high)
        )));
    }
    if covered < (1.0 - 1e-9) * (high - low) {
        let parts: Vec<String> = windows
            .iter()
            .map(|window| {
                let (from, to) = window.range;
                format!(
                    "{:.6} to {:.6} (mode {})",
                    shown(from),
                    shown(to),
                    window.mode + 1
                )
            })
            .collect();
        warnings.push(format!(
            "multiple scales holds near a resonance only; covered are {}",
            parts.join(", ")
        ));
    }
    Ok(windows)
}
