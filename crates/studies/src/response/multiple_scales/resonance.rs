//! The work at one resonance: its branches of steady states, their rows, and the linear response beside them.

use super::{LINEAR, ON_BRANCH, STARTS, Window, fault};
use crate::response::curve::{End, Joined};
use crate::response::document::{end_name, multiplier_pairs};
use crate::response::tracer::harmonic_motion;
use crate::response::{BranchRow, Found, OrbitRow, PointRow, ScalesRow, SpecialRow};
use crate::{Label, Parameter, Quantity, Signal, StudyError};
use rayon::prelude::*;
use slackside_continuation::{Options, StopReason};
use slackside_dynamics::branch::{BranchOptions, BranchPoint, SpecialKind, SpecialPoint, follow};
use slackside_dynamics::orbit::harmonic_balance::HarmonicOrbit;
use slackside_dynamics::orbit::multiple_scales::{
    ModalForm, MultipleScales, Order, PrimaryResonance, SteadyState,
};
use slackside_mechanics::{OperatingPoint, System};
use std::sync::Arc;

/// A branch of steady states with what it is told of.
pub(super) struct Track {
    pub(super) joined: Joined,
    pub(super) scales: MultipleScales,
}

/// The work at one resonance.
pub(super) struct Job<'a> {
    pub(super) quantity: &'a Quantity,
    pub(super) order: Order,
    pub(super) label: Option<&'a Label>,
    pub(super) harmonics: usize,
    pub(super) window: &'a Window,
}

impl Job<'_> {
    pub(super) fn at(&self, value: f64) -> Parameter {
        Parameter {
            key: self.quantity.key.clone(),
            value,
        }
    }

    pub(super) fn point(&self, parameter: f64) -> Result<OperatingPoint, StudyError> {
        Ok(self.quantity.family.at(parameter)?)
    }

    pub(super) fn resonance(&self, parameter: f64) -> Result<(PrimaryResonance, OperatingPoint), StudyError> {
        let point = self.point(parameter)?;
        let form = ModalForm::new(&point.system).map_err(fault)?;
        Ok((
            PrimaryResonance::new(form, self.window.mode).map_err(fault)?,
            point,
        ))
    }

    pub(super) fn grid(&self, count: usize) -> impl Iterator<Item = f64> + use<> {
        let (low, high) = self.window.range;
        (0..count).map(move |i| low + (high - low) * i as f64 / (count - 1) as f64)
    }

    /// Largest deflection of the linear response over the window, relative to the distance from the switching point.
    pub(super) fn largest_swing(&self) -> Result<f64, StudyError> {
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

    pub(super) fn is_linear(&self) -> Result<bool, StudyError> {
        Ok(self.largest_swing()? <= 1.0)
    }

    /// How far the linear response is from separating, in words.
    pub(super) fn reach(&self) -> Result<String, StudyError> {
        Ok(format!(
            "the deflection's amplitude is at most {:.4} of its static value",
            self.largest_swing()?
        ))
    }

    /// The linear response at a parameter.
    pub(super) fn linear_orbit(&self, parameter: f64, branch: usize) -> Result<OrbitRow, StudyError> {
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
            trust: None,
            motion: point.motion,
            history: None,
        })
    }

    pub(super) fn linear_point(&self, parameter: f64) -> Result<PointRow, StudyError> {
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
            trust: None,
            motion: harmonic_motion(&orbit, self.harmonics),
        })
    }

    /// The linear response over the window, where it never switches.
    pub(super) fn linear_branch(&self) -> Result<BranchRow, StudyError> {
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
    pub(super) fn branches(
        &self,
        options: &Options,
        found: &mut Found,
        signal: &Signal,
    ) -> Result<(), StudyError> {
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

    pub(super) fn follow(
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

    pub(super) fn row(&self, track: &Track) -> Result<BranchRow, StudyError> {
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
                    trust: None,
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

    pub(super) fn system(&self, parameter: f64) -> Result<Arc<System>, StudyError> {
        Ok(self.point(parameter)?.system)
    }

    pub(super) fn scales_row(&self, resonance: &PrimaryResonance, state: &SteadyState) -> ScalesRow {
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
    pub(super) fn orbits(&self, value: f64, parameter: f64, found: &mut Found) -> Result<(), StudyError> {
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
                trust: None,
                motion: harmonic_motion(&orbit, self.harmonics),
                history: None,
            });
        }
        Ok(())
    }
}

impl Track {
    pub(super) fn state(
        &self,
        point: &BranchPoint,
    ) -> Result<(Arc<PrimaryResonance>, SteadyState), StudyError> {
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
