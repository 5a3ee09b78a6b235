//! The exact flow of a piecewise-linear system: linear propagation between events, every event found with a certificate
//! (theory 02 §3, theory 05 §3).

use super::event::Crossing;
use super::generator::Generator;
use super::measure::{Record, Request, SummaryVisitor};
use super::rate::Rate;
use super::regime_factory::{GuardRow, JointRows, RegimeFactory};
use super::rest::KnownRoot;
use super::scan::Scan;
use super::settled::{DecayingRegime, ForcedMotion};
use super::step_map::{StepMap, Work};
use super::visitor::{EventCount, Piece, Visitor};
use super::{Flow, FlowError};
use slackside_mechanics::{OperatingPoint, Output, SystemFamily, Transition};
use slackside_numerics::polynomial::{Coefficients, TERMS, first_crossing};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Events allowed in one period of the load before the motion is given up.
pub const EVENT_BUDGET: usize = 10_000;

/// A mechanical state together with the joint regime that holds.
#[derive(Debug, Clone)]
pub(crate) struct FlowState {
    /// Coordinates, rates, internal states.
    pub x: Vec<f64>,
    /// Number of the joint regime.
    pub joint: usize,
    /// What is known of the guards at the start of the next step.
    pub entry: Entry,
}

/// Which guards are zero by construction where a regime was entered.
#[derive(Debug, Clone, Default)]
pub(crate) struct Entry {
    /// The guard back through the surface at which the regime was entered: its element and the regime behind it.
    pub surface: Option<(usize, usize)>,
    /// Guards of elements that were at rest.
    pub known: Vec<KnownRoot>,
}

impl Entry {
    /// Forgets everything: the step has led away.
    pub fn clear(&mut self) {
        self.surface = None;
        self.known.clear();
    }
}

/// The exact flow of one system at one frequency, with tables per regime that are built when first needed.
#[derive(Debug, Clone)]
pub struct ExactFlow {
    pub(super) factory: Arc<RegimeFactory>,
    /// Systems at neighbouring parameters with the weights that difference them, if derivatives are wanted.
    neighbours: Vec<(f64, RegimeFactory)>,
    /// `dΩ/dp` and whether derivatives with respect to the parameter are wanted at all.
    frequency_rate: Option<f64>,
    pub(super) frequency: f64,
    /// Whether more than the harmonics of the load depends on the frequency.
    frequency_dependent: bool,
    pub(super) maps: Vec<StepMap>,
    /// Tables for looking far ahead, by position of the regime.
    pub(super) scans: Vec<Option<Scan>>,
    /// Closed forms of regimes whose free motion decays, with the forced motion at the last frequency.
    pub(super) decaying: Vec<Option<(Option<DecayingRegime>, Option<ForcedMotion>)>>,
    index: HashMap<usize, usize>,
    pub(super) work: Work,
    pub(super) z: Vec<f64>,
}

/// Periods from which on tables for looking far ahead pay, and coordinates up to which they do.
const LONG_RUN: usize = 8;
const LONG_RUN_COORDINATES: usize = 4;

/// Relative step of parameter differences: the fourth-order rule is then accurate to about 1e-12.
const DIFFERENCE_STEP: f64 = 1e-3;

impl ExactFlow {
    /// The flow at an operating point, without derivatives with respect to a parameter.
    ///
    /// # Errors
    /// [`FlowError`] if a law is smooth or the matrices are unsound.
    pub fn new(point: &OperatingPoint) -> Result<Self, FlowError> {
        let factory = Arc::new(RegimeFactory::new(&point.system, point.frequency)?);
        let (nx, nz) = (factory.layout.state(), factory.layout.augmented());
        Ok(Self {
            factory,
            neighbours: Vec::new(),
            frequency_rate: None,
            frequency: point.frequency,
            frequency_dependent: point.system.is_frequency_dependent(),
            maps: Vec::new(),
            scans: Vec::new(),
            decaying: Vec::new(),
            index: HashMap::new(),
            work: Work::new(nx, nz),
            z: vec![0.0; nz],
        })
    }

    /// The flow of a family at a parameter value, with derivatives with respect to that parameter.
    ///
    /// # Errors
    /// As [`Self::new`], and where the family has no system.
    pub fn with_rate(family: &dyn SystemFamily, parameter: f64) -> Result<Self, FlowError> {
        let point = family.at(parameter)?;
        let mut flow = Self::new(&point)?;
        flow.frequency_rate = Some(1.0);
        if family.is_frequency() && !point.system.is_frequency_dependent() {
            return Ok(flow);
        }
        let step = DIFFERENCE_STEP * if parameter == 0.0 { 1.0 } else { parameter.abs() };
        let mut frequency_rate = 0.0;
        for (offset, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let weight = weight / (12.0 * step);
            let neighbour = family.at(parameter + offset * step)?;
            frequency_rate += weight * neighbour.frequency;
            flow.neighbours.push((
                weight,
                RegimeFactory::new(&neighbour.system, neighbour.frequency)?,
            ));
        }
        flow.frequency_rate = Some(frequency_rate);
        flow.frequency_dependent = true;
        Ok(flow)
    }

    /// Position of a joint regime in the store, with its tables up to date.
    pub(crate) fn position(&mut self, joint: usize) -> Result<usize, FlowError> {
        if let Some(&position) = self.index.get(&joint) {
            if self.maps[position].generator.frequency != self.frequency {
                self.maps[position].set_frequency(self.frequency, &mut self.work);
            }
            return Ok(position);
        }
        let JointRows { rates, forces } = self.factory.rows(joint)?;
        let guards = self.factory.guards(joint, &forces);
        let rate = match self.frequency_rate {
            Some(frequency) => Some(self.rate(joint, frequency, rates.len(), &guards)?),
            None => None,
        };
        let generator = Generator {
            layout: self.factory.layout.clone(),
            frequency: self.frequency,
            rates,
            forces,
        };
        let map = StepMap::new(joint, generator, guards, rate, &mut self.work)?;
        self.maps.push(map);
        self.index.insert(joint, self.maps.len() - 1);
        Ok(self.maps.len() - 1)
    }

    /// Derivatives of a joint regime's rows with respect to the parameter, by differences of the neighbours.
    fn rate(
        &self,
        joint: usize,
        frequency: f64,
        length: usize,
        guards: &[GuardRow],
    ) -> Result<Rate, FlowError> {
        if self.neighbours.is_empty() {
            return Ok(Rate {
                frequency,
                rates: None,
                guards: Vec::new(),
            });
        }
        let mut rates = vec![0.0; length];
        let mut guard_rates: Vec<Vec<f64>> = guards.iter().map(|guard| vec![0.0; guard.row.len()]).collect();
        let add = |sum: &mut [f64], weight: f64, row: &[f64]| {
            sum.iter_mut()
                .zip(row)
                .for_each(|(s, value)| *s += weight * value);
        };
        for (weight, factory) in &self.neighbours {
            let rows = factory.rows(joint)?;
            add(&mut rates, *weight, &rows.rates);
            for (sum, guard) in guard_rates.iter_mut().zip(factory.guards(joint, &rows.forces)) {
                add(sum, *weight, &guard.row);
            }
        }
        Ok(Rate {
            frequency,
            rates: Some(rates),
            guards: guard_rates,
        })
    }

    /// Moves a state through one period of the load, from phase zero to phase zero. `variations`, if not empty, holds
    /// columns of the state's length that are carried along; with a rate, the last is the derivative with respect to the parameter.
    pub(crate) fn period<V: Visitor>(
        &mut self,
        state: &mut FlowState,
        variations: &mut [f64],
        visitor: &mut V,
    ) -> Result<(), FlowError> {
        let nx = self.dimension();
        let period = TAU / self.frequency;
        let layout = self.factory.layout.clone();
        let mut z = std::mem::take(&mut self.z);
        z[..nx].copy_from_slice(&state.x);
        layout.set_phase(&mut z, 0.0);
        let outcome = self.run(&mut z, state, period, variations, visitor);
        state.x.copy_from_slice(&z[..nx]);
        self.z = z;
        outcome?;
        if state.x.iter().all(|value| value.abs() < 1e150) {
            Ok(())
        } else {
            Err(FlowError::Unbounded { periods: 1 })
        }
    }

    fn run<V: Visitor>(
        &mut self,
        z: &mut [f64],
        state: &mut FlowState,
        period: f64,
        variations: &mut [f64],
        visitor: &mut V,
    ) -> Result<(), FlowError> {
        let mut position = self.position(state.joint)?;
        let mut time = 0.0;
        let mut events = 0;
        // Full steps that the variations have not made yet.
        let mut behind = 0;
        loop {
            let map = &self.maps[position];
            let remaining = period - time;
            if remaining <= 4.0 * f64::EPSILON * period {
                self.catch_up(position, &mut behind, variations);
                return Ok(());
            }
            let step = map.step.min(remaining);
            let (earliest, crossed) = first_event(map, z, &state.entry, step / map.step);
            let duration = earliest * map.step;
            if V::WANTS_PIECES {
                visitor.piece(&Piece {
                    map,
                    position,
                    z,
                    time,
                    duration,
                    share: earliest,
                });
            }
            if crossed.is_none() && step == map.step {
                if map.varies_in_powers() {
                    behind += 1;
                } else if !variations.is_empty() {
                    map.vary_full(z, variations, &mut self.work);
                }
                map.advance_full(z, &mut self.work);
                time += step;
                state.entry.clear();
                continue;
            }
            self.catch_up(position, &mut behind, variations);
            let map = &self.maps[position];
            let Some(number) = crossed else {
                if !variations.is_empty() {
                    map.vary_partial(z, earliest, variations, &mut self.work);
                }
                map.advance_partial(z, earliest, &mut self.work);
                time = period;
                state.entry.clear();
                continue;
            };
            if duration > 0.0 {
                if !variations.is_empty() {
                    map.vary_partial(z, earliest, variations, &mut self.work);
                }
                map.advance_partial(z, earliest, &mut self.work);
                time += duration;
            }
            self.factory.layout.set_phase(z, time * self.frequency);
            let crossing = Crossing {
                position,
                number,
                time,
            };
            position = self.pass(&crossing, z, state, variations, visitor)?;
            events += 1;
            if events > EVENT_BUDGET {
                return Err(FlowError::EventBudget {
                    budget: EVENT_BUDGET,
                    phase: time * self.frequency,
                });
            }
        }
    }
}

impl ExactFlow {
    /// Whether a run of so many periods is made by looking far ahead.
    fn looks_ahead(&self, periods: usize) -> bool {
        periods >= LONG_RUN && self.factory.layout.coordinates <= LONG_RUN_COORDINATES
    }

    /// Lets the variations make the full steps that they are behind the state.
    fn catch_up(&mut self, position: usize, behind: &mut usize, variations: &mut [f64]) {
        if *behind > 0 && !variations.is_empty() {
            self.maps[position].vary_steps(*behind, variations, &mut self.work);
        }
        *behind = 0;
    }
}

impl Flow for ExactFlow {
    fn dimension(&self) -> usize {
        self.factory.layout.state()
    }

    fn frequency(&self) -> f64 {
        self.frequency
    }

    fn set_frequency(&mut self, frequency: f64) -> bool {
        if !self.frequency_dependent {
            self.frequency = frequency;
        }
        !self.frequency_dependent
    }

    fn advance(
        &mut self,
        state: &mut [f64],
        periods: usize,
        variations: &mut [f64],
    ) -> Result<usize, FlowError> {
        let mut current = self.start(state, &mut EventCount::default())?;
        self.confine(&current, variations)?;
        let mut count = EventCount::default();
        if variations.is_empty() && self.looks_ahead(periods) {
            self.long_run(&mut current, periods, &mut count)?;
            state.copy_from_slice(&current.x);
            return Ok(count.events);
        }
        for period in 0..periods {
            self.period(&mut current, variations, &mut count)
                .map_err(|error| error.after(period))?;
        }
        state.copy_from_slice(&current.x);
        Ok(count.events)
    }

    fn record(
        &mut self,
        state: &mut [f64],
        periods: usize,
        outputs: &[Output],
        request: &Request,
    ) -> Result<Record, FlowError> {
        let mut visitor = SummaryVisitor::new(
            &self.factory,
            outputs.to_vec(),
            request.clone(),
            self.frequency,
            periods,
        );
        let mut current = self.start(state, &mut visitor)?;
        let from = current.x[..self.factory.layout.coordinates].to_vec();
        if !request.extremes
            && !request.account
            && self.looks_ahead(periods)
            && let Some(record) = self.settled_record(&mut current, periods, outputs, request)?
        {
            state.copy_from_slice(&current.x);
            return Ok(record);
        }
        if outputs.is_empty() && !request.account && self.looks_ahead(periods) {
            self.long_run(&mut current, periods, &mut visitor)?;
            state.copy_from_slice(&current.x);
            return Ok(finish(visitor, &from, &current.x));
        }
        for period in 0..periods {
            visitor.offset = TAU * period as f64;
            self.period(&mut current, &mut [], &mut visitor)
                .map_err(|error| error.after(period))?;
        }
        state.copy_from_slice(&current.x);
        Ok(finish(visitor, &from, &current.x))
    }
}

/// The record, with the change of the coordinates from start to end.
fn finish(visitor: SummaryVisitor, from: &[f64], to: &[f64]) -> Record {
    Record {
        drift: from.iter().zip(to).map(|(a, b)| b - a).collect(),
        ..visitor.finish()
    }
}

/// The first event within `limit` of a step from `z`: its share of the step and the number of the guard. Without one, the
/// limit itself.
#[inline]
pub(super) fn first_event(map: &StepMap, z: &[f64], entry: &Entry, limit: f64) -> (f64, Option<usize>) {
    let mut earliest = (limit, None);
    for (number, guard) in map.guards.iter().enumerate() {
        let c = guard.coefficients(z);
        let found = match entry.known.iter().find(|(known, _)| *known == number) {
            Some(&(_, order)) if order >= TERMS => None,
            Some(&(_, order)) => first_crossing(&c, order),
            None => {
                let back = matches!(guard.guard.transition, Transition::To(to)
                    if entry.surface == Some((guard.guard.element, to)));
                crossing(&c, back)
            }
        };
        if let Some(s) = found
            && s < earliest.0
        {
            earliest = (s, Some(number));
        }
    }
    earliest
}

/// Relative size beyond which a guard that is negative at the start has jumped there and is not zero up to rounding.
const JUMPED: f64 = 1e-9;

/// Multiplicity of the zero at the start from which the guard rises; `None` if it falls (or vanishes identically).
pub(super) fn root_order(c: &Coefficients, first: usize) -> Option<usize> {
    let noise = 1e-14 * c.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    let order = (first..TERMS).find(|&k| c[k].abs() > noise)?;
    (c[order] > 0.0).then_some(order)
}

/// First crossing of a guard over a step, in units of the step. `known`: the guard vanishes at the start by construction.
#[inline]
fn crossing(c: &Coefficients, known: bool) -> Option<f64> {
    if !known && c[0] > 0.0 {
        return first_crossing(c, 0);
    }
    // Another element's event has pushed this one out of its regime.
    if !known && c[0] < -JUMPED * c.iter().fold(0.0_f64, |a, v| a.max(v.abs())) {
        return Some(0.0);
    }
    match root_order(c, 1) {
        Some(order) => first_crossing(c, order),
        None => Some(0.0),
    }
}
