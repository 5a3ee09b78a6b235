//! Branches by the method of multiple scales (theory 02 §10, §11): which resonances the range holds, their branches, and
//! what must be said of them.

use super::curve::{End, Joined};
use super::document::{end_name, multiplier_pairs};
use super::tracer::harmonic_motion;
use super::{BranchRow, Found, OrbitRow, PointRow, Response, ScalesRow, SpecialRow};
use crate::{Parameter, Quantity, Signal, StudyError};
use rayon::prelude::*;
use slackside_continuation::{Options, StopReason};
use slackside_dynamics::branch::{BranchOptions, BranchPoint, SpecialKind, SpecialPoint, follow};
use slackside_dynamics::orbit::harmonic_balance::HarmonicOrbit;
use slackside_dynamics::orbit::multiple_scales::{
    ModalForm, MultipleScales, MultipleScalesError, Order, PrimaryResonance, SteadyState,
};
use slackside_mechanics::{OperatingPoint, System};
use std::sync::Arc;

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

/// A branch of steady states with what it is told of.
struct Track {
    joined: Joined,
    scales: MultipleScales,
}

/// The work at one resonance.
struct Job<'a> {
    quantity: &'a Quantity,
    order: Order,
    label: Option<&'a Parameter>,
    harmonics: usize,
    window: &'a Window,
}

impl Job<'_> {
    fn at(&self, value: f64) -> Parameter {
        Parameter {
            key: self.quantity.key.clone(),
            value,
        }
    }

    fn point(&self, parameter: f64) -> Result<OperatingPoint, StudyError> {
        Ok(self.quantity.family.at(parameter)?)
    }

    fn resonance(&self, parameter: f64) -> Result<(PrimaryResonance, OperatingPoint), StudyError> {
        let point = self.point(parameter)?;
        let form = ModalForm::new(&point.system).map_err(fault)?;
        Ok((
            PrimaryResonance::new(form, self.window.mode).map_err(fault)?,
            point,
        ))
    }

    fn grid(&self, count: usize) -> impl Iterator<Item = f64> + use<> {
        let (low, high) = self.window.range;
        (0..count).map(move |i| low + (high - low) * i as f64 / (count - 1) as f64)
    }

    /// Largest deflection of the linear response over the window, relative to the distance from the switching point.
    fn largest_swing(&self) -> Result<f64, StudyError> {
        let mut largest = 0.0_f64;
        if self.quantity.is_frequency() {
            let (resonance, _) = self.resonance(self.window.range.0)?;
            let (w, zeta) = (resonance.frequency(), resonance.damping_ratio());
            // Besides the window evenly, the peak densely: it is flat, so that its height is known to rounding.
            let peak = (-400..=400).map(|i| w * (1.0 + 0.005 * zeta * f64::from(i)));
            let (low, high) = self.window.range;
            for frequency in self.grid(LINEAR).chain(peak.filter(|w| (low..=high).contains(w))) {
                let swing = resonance.form.linear_deflection(frequency);
                largest = largest.max(swing / resonance.form.static_deflection);
            }
            return Ok(largest);
        }
        for parameter in self.grid(LINEAR) {
            let point = self.point(parameter)?;
            let form = ModalForm::new(&point.system).map_err(fault)?;
            largest = largest.max(form.linear_deflection(point.frequency) / form.static_deflection);
        }
        Ok(largest)
    }

    fn is_linear(&self) -> Result<bool, StudyError> {
        Ok(self.largest_swing()? <= 1.0)
    }

    /// How far the linear response is from separating, in words.
    fn reach(&self) -> Result<String, StudyError> {
        Ok(format!(
            "the deflection's amplitude is at most {:.4} of its static value",
            self.largest_swing()?
        ))
    }

    /// The linear response at a parameter.
    fn linear_orbit(&self, parameter: f64, branch: usize) -> Result<OrbitRow, StudyError> {
        let point = self.linear_point(parameter)?;
        Ok(OrbitRow {
            at: point.at,
            label: self.label.cloned(),
            branch,
            periods: 1,
            stable: point.stable,
            multipliers: point.multipliers,
            residual: point.residual,
            start: point.start,
            multiple_scales: None,
            motion: point.motion,
        })
    }

    fn linear_point(&self, parameter: f64) -> Result<PointRow, StudyError> {
        let point = self.point(parameter)?;
        let form = ModalForm::new(&point.system).map_err(fault)?;
        let orbit = motion_of(form.linear_motion(&point.system, point.frequency))?;
        let multipliers = form.linear_multipliers(point.frequency);
        Ok(PointRow {
            at: self.at(self.quantity.value(parameter)),
            stable: multipliers.iter().all(|m| m.norm() < 1.0),
            multipliers: multiplier_pairs(&multipliers),
            residual: 0.0,
            start: orbit.initial_state(),
            multiple_scales: None,
            motion: harmonic_motion(&orbit, self.harmonics),
        })
    }

    /// The linear response over the window, where it never switches.
    fn linear_branch(&self) -> Result<BranchRow, StudyError> {
        let parameters: Vec<f64> = self.grid(LINEAR).collect();
        let points = parameters
            .par_iter()
            .map(|&parameter| self.linear_point(parameter));
        let points: Result<Vec<PointRow>, StudyError> = points.collect();
        Ok(BranchRow {
            label: self.label.cloned(),
            periods: 1,
            ends: [end_name(End::Range); 2],
            points: points?,
            special: Vec::new(),
        })
    }

    /// All branches of the window, with remarks.
    fn branches(&self, options: &Options, found: &mut Found, signal: &Signal) -> Result<(), StudyError> {
        let (low, high) = self.window.range;
        let (resonance, _) = self.resonance(low)?;
        found
            .warnings
            .extend(resonance.remarks().iter().map(ToString::to_string));
        let mut tracks: Vec<Track> = Vec::new();
        let mut starts: Vec<f64> = vec![high, low];
        starts.extend(self.grid(STARTS + 2).skip(1).take(STARTS));
        for parameter in starts {
            // Where a key describes no system or no resonance there is nothing to start from.
            let Ok((resonance, point)) = self.resonance(parameter) else {
                continue;
            };
            for state in resonance.states_at(self.order, point.frequency) {
                if signal.is_interrupted() {
                    break;
                }
                if tracks
                    .iter()
                    .any(|track| is_on(&track.joined.points, parameter, &state, &resonance))
                {
                    continue;
                }
                if let Some(track) = self.follow(parameter, &state, options, signal) {
                    tracks.push(track);
                }
            }
        }
        let (mut points, mut doubtful) = (0, 0);
        for track in &tracks {
            let row = self.row(track)?;
            points += row.points.len();
            let scales = row.points.iter().filter_map(|point| point.multiple_scales);
            doubtful += scales.filter(|scales| !scales.validated).count();
            for (end, point) in track
                .joined
                .ends
                .iter()
                .zip([row.points.first(), row.points.last()])
            {
                if let (End::Step, Some(point)) = (end, point) {
                    found.warnings.push(format!(
                        "a branch was given up at {} = {}: no step was short enough to converge",
                        self.quantity.key, point.at.value
                    ));
                }
            }
            found.branches.push(row);
        }
        if doubtful > 0 {
            found.warnings.push(format!(
                "mode {}: at {doubtful} of {points} points the correction exceeds a tenth of the amplitude; these are not \
                 validated, compare with --compare",
                self.window.mode + 1
            ));
        }
        Ok(())
    }

    fn follow(
        &self,
        parameter: f64,
        state: &SteadyState,
        options: &Options,
        signal: &Signal,
    ) -> Option<Track> {
        let (low, high) = self.window.range;
        let family = self.quantity.family.clone();
        let mut scales = MultipleScales::new(
            family,
            self.order,
            self.window.mode,
            parameter,
            0.5 * (high - low),
        )
        .ok()?;
        let unknowns = [state.amplitude, state.phase];
        let mut one_way = |direction: f64| {
            let options = BranchOptions {
                continuation: options.clone(),
                direction,
            };
            let branch = follow(&mut scales, &unknowns, parameter, &options, &mut |_| {
                !signal.is_interrupted()
            });
            let started = !matches!(branch.stop, StopReason::NoStart(_)) && !branch.points.is_empty();
            started.then_some(branch)
        };
        let joined = if parameter <= low {
            Joined::new(one_way(1.0)?, None)
        } else if parameter >= high {
            Joined::new(one_way(-1.0)?, None)
        } else {
            let onward = one_way(1.0)?;
            let back = if onward.stop == StopReason::Closed {
                None
            } else {
                one_way(-1.0)
            };
            Joined::new(onward, back)
        };
        Some(Track { joined, scales })
    }

    fn row(&self, track: &Track) -> Result<BranchRow, StudyError> {
        let points: Result<Vec<PointRow>, StudyError> = track
            .joined
            .points
            .par_iter()
            .map(|point| {
                let (resonance, state) = track.state(point)?;
                let system = self.system(point.parameter)?;
                let orbit = motion_of(resonance.motion(&system, self.order, &state))?;
                Ok(PointRow {
                    at: self.at(self.quantity.value(point.parameter)),
                    stable: point.is_stable(),
                    multipliers: multiplier_pairs(&point.multipliers),
                    residual: point.residual,
                    start: orbit.initial_state(),
                    multiple_scales: Some(self.scales_row(&resonance, &state)),
                    motion: harmonic_motion(&orbit, self.harmonics),
                })
            })
            .collect();
        let special: Result<Vec<SpecialRow>, StudyError> = self
            .without_artefacts(track)?
            .into_iter()
            .map(|special| {
                let point = &special.point;
                let (resonance, state) = track.state(point)?;
                let system = self.system(point.parameter)?;
                let orbit = motion_of(resonance.motion(&system, self.order, &state))?;
                let before = |other: &BranchPoint| other.arclength <= point.arclength;
                Ok(SpecialRow {
                    kind: special.kind.name(),
                    at: self.at(self.quantity.value(point.parameter)),
                    after: track.joined.points.partition_point(before).saturating_sub(1),
                    multipliers: multiplier_pairs(&point.multipliers),
                    measures: harmonic_motion(&orbit, 0).measures,
                })
            })
            .collect();
        Ok(BranchRow {
            label: self.label.cloned(),
            periods: 1,
            ends: track.joined.ends.map(end_name),
            points: points?,
            special: special?,
        })
    }

    /// The special points without the pair of folds that the second order may show right at the onset of separation.
    fn without_artefacts<'t>(&self, track: &'t Track) -> Result<Vec<&'t SpecialPoint>, StudyError> {
        let mut at_onset = Vec::new();
        for special in &track.joined.special {
            let (resonance, state) = track.state(&special.point)?;
            at_onset.push(special.kind == SpecialKind::Fold && resonance.is_at_onset(state.amplitude));
        }
        let special = &track.joined.special;
        let is_artefact = |i: usize| {
            let neighbours = (0..special.len()).filter(|&j| j != i && at_onset[j]);
            let near = |j: usize| (special[j].point.arclength - special[i].point.arclength).abs() < 0.05;
            at_onset[i] && neighbours.clone().any(near)
        };
        Ok((0..special.len())
            .filter(|&i| !is_artefact(i))
            .map(|i| &special[i])
            .collect())
    }

    fn system(&self, parameter: f64) -> Result<Arc<System>, StudyError> {
        Ok(self.point(parameter)?.system)
    }

    fn scales_row(&self, resonance: &PrimaryResonance, state: &SteadyState) -> ScalesRow {
        ScalesRow {
            mode: self.window.mode + 1,
            amplitude: state.amplitude,
            phase: state.phase,
            gamma: resonance.gamma(state),
            correction: resonance.correction(state),
            validated: resonance.is_validated(state),
        }
    }

    /// All motions at a value of the parameter.
    fn orbits(&self, value: f64, parameter: f64, found: &mut Found) -> Result<(), StudyError> {
        let (resonance, point) = self.resonance(parameter)?;
        for state in resonance.states_at(self.order, point.frequency) {
            let orbit = motion_of(resonance.motion(&point.system, self.order, &state))?;
            let multipliers = resonance.multipliers(self.order, &state);
            let flow = resonance.slow_flow(self.order, &state);
            found.orbits.push(OrbitRow {
                at: self.at(value),
                label: self.label.cloned(),
                branch: nearest_branch(&found.branches, value, state.amplitude),
                periods: 1,
                stable: resonance.is_stable(self.order, &state),
                multipliers: multiplier_pairs(&multipliers),
                residual: flow.cosine.abs().max(flow.sine.abs()) / resonance.load().abs(),
                start: orbit.initial_state(),
                multiple_scales: Some(self.scales_row(&resonance, &state)),
                motion: harmonic_motion(&orbit, self.harmonics),
            });
        }
        Ok(())
    }
}

impl Track {
    fn state(&self, point: &BranchPoint) -> Result<(Arc<PrimaryResonance>, SteadyState), StudyError> {
        self.scales
            .state(&point.unknowns, point.parameter)
            .map_err(|error| StudyError::NoAnswer(error.to_string()))
    }
}

fn motion_of<E: ToString>(orbit: Result<HarmonicOrbit, E>) -> Result<HarmonicOrbit, StudyError> {
    orbit.map_err(|error| StudyError::NoAnswer(error.to_string()))
}

/// Whether a steady state lies on a branch, interpolated between its points.
fn is_on(points: &[BranchPoint], parameter: f64, state: &SteadyState, resonance: &PrimaryResonance) -> bool {
    let scale = resonance.onset_amplitude();
    let near = |amplitude: f64, phase: f64| {
        (amplitude - state.amplitude).abs() < ON_BRANCH * scale && (phase - state.phase).abs() < ON_BRANCH
    };
    let passes = points.windows(2).any(|pair| {
        let (a, b) = (pair[0].parameter - parameter, pair[1].parameter - parameter);
        if a * b > 0.0 || a == b {
            return false;
        }
        let share = a / (a - b);
        let at = |i: usize| pair[0].unknowns[i] + share * (pair[1].unknowns[i] - pair[0].unknowns[i]);
        near(at(0), at(1))
    });
    // Next to a fold the branch may turn before the parameter is reached between two points.
    passes
        || points
            .iter()
            .any(|p| (p.parameter / parameter - 1.0).abs() < 1e-3 && near(p.unknowns[0], p.unknowns[1]))
}

/// The branch that passes nearest to an amplitude at a value.
fn nearest_branch(branches: &[BranchRow], value: f64, amplitude: f64) -> usize {
    let distance = |branch: &BranchRow| {
        let points = branch.points.iter().filter_map(|point| {
            let scales = point.multiple_scales?;
            Some((point.at.value / value - 1.0).abs() + (scales.amplitude / amplitude - 1.0).abs())
        });
        points.fold(f64::INFINITY, f64::min)
    };
    let indexed = branches.iter().enumerate();
    let nearest = indexed.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
    nearest.map_or(0, |(index, _)| index)
}
