//! Recognising that a motion has settled on a periodic one, and refining that to an exact orbit (theory 02 §9.3).

use super::poincare::stroboscopic;
use crate::flow::{Flow, FlowError, open};
use crate::orbit::shooting::{Orbit, Shooting, ShootingError};
use slackside_continuation::Family;
use slackside_mechanics::{FrequencyFamily, OperatingPoint};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

/// How periodic motions are recognised. Distances between states are relative to the scales of the state entries
/// (displacements under the load applied statically, and their rates at the lowest natural frequency).
#[derive(Debug, Clone, PartialEq)]
pub struct RecognitionOptions {
    /// Largest number of periods of the load after which a motion may repeat.
    pub longest_period: usize,
    /// Distance at which a stroboscopic point counts as repeated.
    pub tolerance: f64,
    /// Distance of the closest return up to which Newton's method looks for an orbit that the motion is still approaching.
    pub nearness: f64,
    /// Periods that a motion may take to arrive at an orbit found in this way.
    pub patience: usize,
}

impl Default for RecognitionOptions {
    /// Up to 40 periods, repeated to 1e-7, approached from within 1e-3 in at most 20 000 periods.
    fn default() -> Self {
        Self {
            longest_period: 40,
            tolerance: 1e-7,
            nearness: 1e-3,
            patience: 20_000,
        }
    }
}

/// A periodic motion that others settle on.
#[derive(Debug, Clone)]
pub struct PeriodicAttractor {
    /// Periods of the load after which it repeats.
    pub periods: usize,
    /// Its stroboscopic points, as many as periods; exact if there is an orbit.
    pub points: Vec<Vec<f64>>,
    /// The orbit to rounding, stable; `None` if Newton's method did not converge to the settled motion.
    pub orbit: Option<Orbit>,
    /// Distance between the first point of the settled motion and its repetition, before refinement.
    pub mismatch: f64,
}

impl PeriodicAttractor {
    /// Distance of a state from the nearest of the stroboscopic points.
    pub fn distance(&self, state: &[f64], scales: &[f64]) -> f64 {
        self.points
            .iter()
            .map(|point| distance(point, state, scales))
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether both are the same motion, possibly begun in different periods of the load.
    pub fn is_same(&self, other: &Self, scales: &[f64]) -> bool {
        let k = self.periods;
        k == other.periods
            && (0..k).any(|shift| {
                (0..k).all(|i| distance(&self.points[i], &other.points[(i + shift) % k], scales) <= SAME)
            })
    }
}

/// Distance below which a motion counts as arrived at an orbit, and two orbits as one.
pub(super) const SAME: f64 = 1e-5;

/// What was recognised.
#[derive(Debug, Clone)]
pub enum Recognition {
    /// The motion has settled on, or demonstrably approaches, a periodic one.
    Periodic(PeriodicAttractor),
    /// It does not repeat.
    NotPeriodic {
        /// Number of periods after which it came closest to its start.
        periods: usize,
        /// Distance then.
        mismatch: f64,
    },
}

/// Recognises periodic motions of one system under one load.
pub struct Recognizer {
    point: OperatingPoint,
    options: RecognitionOptions,
    flow: Box<dyn Flow>,
    scales: Vec<f64>,
    /// Shooting by number of periods.
    shootings: BTreeMap<usize, Shooting>,
}

impl Recognizer {
    /// A recogniser of the motions at an operating point.
    ///
    /// # Errors
    /// [`FlowError`] if the system is unsound.
    pub fn new(point: &OperatingPoint, options: RecognitionOptions) -> Result<Self, FlowError> {
        let shooting = shooting(point, 1)?;
        let mut scales = shooting.unknown_scales();
        // The angle of an overrunning accessory grows from period to period of a motion that repeats.
        for i in point.system.cyclic_coordinates() {
            scales[i] = f64::INFINITY;
        }
        Ok(Self {
            point: point.clone(),
            options,
            flow: open(point)?,
            scales,
            shootings: BTreeMap::from([(1, shooting)]),
        })
    }

    /// The flow at the operating point, without a rate.
    pub fn flow(&mut self) -> &mut dyn Flow {
        self.flow.as_mut()
    }

    /// Scales of the state entries to which distances are relative; infinite for cyclic coordinates, which do not count.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// Shooting over `periods` periods at the operating point, whose frequency is the parameter.
    ///
    /// # Errors
    /// [`FlowError`] if the system is unsound.
    pub fn shooting(&mut self, periods: usize) -> Result<&mut Shooting, FlowError> {
        match self.shootings.entry(periods) {
            Entry::Occupied(entry) => Ok(entry.into_mut()),
            Entry::Vacant(entry) => Ok(entry.insert(shooting(&self.point, periods)?)),
        }
    }

    /// Whether the motion from `state` repeats after some number of periods, the least that does. If it does not yet but
    /// comes close, Newton's method looks for a stable orbit nearby, and the motion counts as periodic if it is seen to
    /// arrive there.
    ///
    /// # Errors
    /// [`FlowError`] of the motion itself.
    pub fn recognize(&mut self, state: &[f64]) -> Result<Recognition, FlowError> {
        self.search(state, self.options.longest_period, self.options.nearness)
    }

    /// As [`Self::recognize`] for a motion that converges, as its exponents show: over more periods and from farther away.
    ///
    /// # Errors
    /// As [`Self::recognize`].
    pub(super) fn recognize_converging(&mut self, state: &[f64]) -> Result<Recognition, FlowError> {
        let longest = 5 * self.options.longest_period;
        self.search(state, longest, 20.0 * self.options.nearness)
    }

    fn search(&mut self, state: &[f64], longest: usize, nearness: f64) -> Result<Recognition, FlowError> {
        let longest = longest.max(1);
        let map = stroboscopic(self.flow.as_mut(), &mut state.to_vec(), longest)?;
        let returns: Vec<(usize, f64)> = (1..=longest)
            .map(|k| (k, distance(map.point(k), map.point(0), &self.scales)))
            .collect();
        let closest =
            returns.iter().copied().fold(
                (1, f64::INFINITY),
                |best, new| if new.1 < best.1 { new } else { best },
            );
        let not_periodic = Recognition::NotPeriodic {
            periods: closest.0,
            mismatch: closest.1,
        };

        // A motion that repeats after k periods also does after 2k; beside a period doubling the orbit of k periods may be
        // unstable although the settled motion, of 2k, misses it by less than the tolerance.
        let tolerance = self.options.tolerance;
        let repeated = returns.iter().filter(|r| r.1 <= tolerance).take(4);
        let mut unrefined = None;
        for &(periods, mismatch) in repeated {
            match self.refine(state, periods)? {
                Refined::Arrived(orbit) => return self.attractor(orbit, mismatch).map(Recognition::Periodic),
                Refined::Unstable => {}
                Refined::None => {
                    unrefined.get_or_insert((periods, mismatch));
                }
            }
        }
        if let Some((periods, mismatch)) = unrefined {
            return Ok(Recognition::Periodic(PeriodicAttractor {
                periods,
                points: (0..periods).map(|k| map.point(k).to_vec()).collect(),
                orbit: None,
                mismatch,
            }));
        }
        let (periods, mismatch) = closest;
        if mismatch > tolerance
            && mismatch <= nearness
            && let Refined::Arrived(orbit) = self.refine(state, periods)?
        {
            return self.attractor(orbit, mismatch).map(Recognition::Periodic);
        }
        Ok(not_periodic)
    }

    /// The orbit of at most `periods` periods near a state, if the motion from there arrives at it.
    fn refine(&mut self, state: &[f64], periods: usize) -> Result<Refined, FlowError> {
        let Some(orbit) = self.solve(state, periods)? else {
            return Ok(Refined::None);
        };
        if !orbit.is_stable() {
            return Ok(Refined::Unstable);
        }
        if !self.arrives(state, &orbit)? {
            return Ok(Refined::None);
        }
        // Newton's method for k periods also finds orbits of a fraction of them.
        let map = stroboscopic(self.flow.as_mut(), &mut orbit.start.clone(), periods)?;
        for divisor in (1..periods).filter(|&d| periods.is_multiple_of(d)) {
            if distance(map.point(divisor), map.point(0), &self.scales) <= SAME * 1e-3
                && let Some(shorter) = self.solve(&orbit.start, divisor)?
            {
                return Ok(Refined::Arrived(shorter));
            }
        }
        Ok(Refined::Arrived(orbit))
    }

    fn solve(&mut self, guess: &[f64], periods: usize) -> Result<Option<Orbit>, FlowError> {
        let frequency = self.point.frequency;
        match self.shooting(periods)?.solve(guess, frequency) {
            Ok(orbit) => Ok(Some(orbit)),
            // The Newton iteration may wander to where there is no motion; the settled motion itself is sound.
            Err(ShootingError::NoConvergence { .. } | ShootingError::Flow(_)) => Ok(None),
        }
    }

    /// Whether the motion from `state` arrives at a stable orbit within the time that its largest multiplier predicts.
    fn arrives(&mut self, state: &[f64], orbit: &Orbit) -> Result<bool, FlowError> {
        let start = distance(state, &orbit.start, &self.scales);
        if start <= SAME {
            return Ok(true);
        }
        if start > ATTEMPT {
            return Ok(false);
        }
        let modulus = orbit.multipliers.first().map_or(0.0, |m| m.norm());
        let turns = (SAME / start).ln() / modulus.max(f64::MIN_POSITIVE).ln();
        // Half as much again, for multipliers that come in pairs and growth before decay.
        let periods = (1.5 * turns).ceil().max(4.0) * orbit.periods as f64;
        if periods > self.options.patience as f64 {
            return Ok(false);
        }
        let mut end = state.to_vec();
        self.flow.advance(&mut end, periods as usize, &mut [])?;
        Ok(distance(&end, &orbit.start, &self.scales) <= SAME)
    }

    fn attractor(&mut self, orbit: Orbit, mismatch: f64) -> Result<PeriodicAttractor, FlowError> {
        let periods = orbit.periods;
        let map = stroboscopic(self.flow.as_mut(), &mut orbit.start.clone(), periods - 1)?;
        Ok(PeriodicAttractor {
            periods,
            points: map.points().map(<[f64]>::to_vec).collect(),
            orbit: Some(orbit),
            mismatch,
        })
    }
}

/// Distance from an orbit beyond which arriving there would be by chance.
const ATTEMPT: f64 = 0.1;

enum Refined {
    Arrived(Orbit),
    Unstable,
    None,
}

fn shooting(point: &OperatingPoint, periods: usize) -> Result<Shooting, FlowError> {
    let family = Arc::new(FrequencyFamily::new(point.system.clone()));
    Shooting::new(family, point.frequency, periods)
}

/// Largest difference between two states, entry by entry relative to their scales.
pub(super) fn distance(a: &[f64], b: &[f64], scales: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .zip(scales)
        .fold(0.0, |largest, ((x, y), scale)| largest.max((x - y).abs() / scale))
}
