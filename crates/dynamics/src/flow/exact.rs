//! The exact flow of a piecewise-linear system: linear propagation between events, every event found with a certificate
//! (theory 02 §3, theory 05 §3).

use super::generator::{Generator, GuardRow, RegimeFactory};
use super::measure::{Record, Request, SummaryVisitor};
use super::rate::Rate;
use super::saltation::Saltation;
use super::scan::Scan;
use super::settled::{DecayingRegime, ForcedMotion};
use super::step_map::{StepMap, Work};
use super::visitor::{Event, EventCount, Piece, Visitor};
use super::{Flow, FlowError};
use slackside_mechanics::{OperatingPoint, Output, SystemFamily};
use slackside_numerics::polynomial::{Coefficients, TERMS, first_crossing};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Events allowed in one period of the load before the motion is given up.
pub const EVENT_BUDGET: usize = 10_000;

/// A mechanical state together with the joint regime that holds.
#[derive(Debug, Clone)]
pub(crate) struct FlowState {
    /// Coordinates, then rates.
    pub x: Vec<f64>,
    /// Number of the joint regime.
    pub joint: usize,
    /// The guard that is zero because the state lies on the surface at which the regime was entered: its element and the
    /// regime behind it.
    pub surface: Option<(usize, usize)>,
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

/// Periods from which on tables for looking far ahead pay.
const LONG_RUN: usize = 8;

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
        let generator = Generator {
            layout: self.factory.layout.clone(),
            frequency: self.frequency,
            acceleration: self.factory.acceleration(joint),
        };
        let rate = self.frequency_rate.map(|frequency| Rate {
            frequency,
            acceleration: (!self.neighbours.is_empty()).then(|| {
                let mut rows = vec![0.0; generator.acceleration.len()];
                for (weight, factory) in &self.neighbours {
                    for (sum, value) in rows.iter_mut().zip(factory.acceleration(joint)) {
                        *sum += weight * value;
                    }
                }
                rows
            }),
        });
        let map = StepMap::new(joint, generator, self.factory.guards(joint), rate, &mut self.work)?;
        self.maps.push(map);
        self.index.insert(joint, self.maps.len() - 1);
        Ok(self.maps.len() - 1)
    }

    /// A start at phase zero: the regime that holds there, decided by the first derivative of the guard that does not
    /// vanish if the state lies on a surface.
    ///
    /// # Errors
    /// [`FlowError::StateLength`], or a failure to build tables.
    pub(crate) fn start(&mut self, x: &[f64]) -> Result<FlowState, FlowError> {
        if x.len() != self.dimension() {
            return Err(FlowError::StateLength {
                expected: self.dimension(),
                found: x.len(),
            });
        }
        if x.iter().any(|value| !value.is_finite()) {
            return Err(FlowError::Unbounded { periods: 0 });
        }
        let mut joint = self.factory.regime_at(x);
        let layout = self.factory.layout.clone();
        self.z[..x.len()].copy_from_slice(x);
        layout.set_phase(&mut self.z, 0.0);
        // Each round corrects one element; every element needs at most one per regime.
        for _ in 0..=2 * self.factory.tables.len() {
            let position = self.position(joint)?;
            let wrong = self.maps[position].guards.iter().find_map(|map| {
                let c = map.coefficients(&self.z);
                let leaves = c[0] <= 0.0 && root_order(&c, 0).is_none();
                leaves.then_some((map.guard.element, map.guard.to))
            });
            let Some((element, to)) = wrong else { break };
            joint = self.factory.after(joint, element, to);
        }
        Ok(FlowState {
            x: x.to_vec(),
            joint,
            surface: None,
        })
    }

    /// Moves a state through one period of the load, from phase zero to phase zero. `variations`, if not empty, holds
    /// columns of length `2n` that are carried along; with a rate, the last is the derivative with respect to the parameter.
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
        let nx = self.dimension();
        let mut position = self.position(state.joint)?;
        let mut time = 0.0;
        let mut events = 0;
        loop {
            let map = &self.maps[position];
            let remaining = period - time;
            if remaining <= 4.0 * f64::EPSILON * period {
                return Ok(());
            }
            let step = map.step.min(remaining);
            let (earliest, crossed) = first_event(map, z, state.surface, step / map.step);
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
            let Some(number) = crossed else {
                if step == map.step {
                    if !variations.is_empty() {
                        map.vary_full(z, variations, &mut self.work);
                    }
                    map.advance_full(z, &mut self.work);
                    time += step;
                } else {
                    if !variations.is_empty() {
                        map.vary_partial(z, earliest, variations, &mut self.work);
                    }
                    map.advance_partial(z, earliest, &mut self.work);
                    time = period;
                }
                state.surface = None;
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
            let next = self.behind(position, number)?;
            let GuardRow {
                element, from, to, ..
            } = self.maps[position].guards[number].guard;
            if !variations.is_empty() {
                self.saltate(position, next, number, z, &mut variations[..], nx);
            }
            visitor.event(&Event {
                time,
                element,
                from,
                to,
            });
            position = next;
            state.joint = self.maps[next].joint;
            state.surface = Some((element, from));
            events += 1;
            if events > EVENT_BUDGET {
                return Err(FlowError::EventBudget {
                    budget: EVENT_BUDGET,
                    phase: time * self.frequency,
                });
            }
        }
    }

    /// Position of the regime behind a guard.
    pub(super) fn behind(&mut self, position: usize, number: usize) -> Result<usize, FlowError> {
        let guard = &self.maps[position].guards[number];
        if let Some(next) = guard.next {
            if self.maps[next].generator.frequency != self.frequency {
                self.maps[next].set_frequency(self.frequency, &mut self.work);
            }
            return Ok(next);
        }
        let joint = self
            .factory
            .after(self.maps[position].joint, guard.guard.element, guard.guard.to);
        let next = self.position(joint)?;
        self.maps[position].guards[number].next = Some(next);
        Ok(next)
    }

    fn saltate(
        &mut self,
        before: usize,
        after: usize,
        guard: usize,
        z: &[f64],
        variations: &mut [f64],
        nx: usize,
    ) {
        let mut field_before = vec![0.0; z.len()];
        let mut field_after = vec![0.0; z.len()];
        self.maps[before].generator.apply(z, &mut field_before);
        self.maps[after].generator.apply(z, &mut field_after);
        let normal = &self.maps[before].guards[guard].guard.row[..nx];
        let saltation = Saltation::new(&field_before[..nx], &field_after[..nx], normal);
        for column in variations.chunks_exact_mut(nx) {
            saltation.apply(column);
        }
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
        let mut current = self.start(state)?;
        let mut count = EventCount::default();
        if variations.is_empty() && periods >= LONG_RUN {
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
        let mut current = self.start(state)?;
        if !request.extremes
            && periods >= LONG_RUN
            && let Some(record) = self.settled_record(&mut current, periods, outputs, request)?
        {
            state.copy_from_slice(&current.x);
            return Ok(record);
        }
        if outputs.is_empty() && periods >= LONG_RUN {
            self.long_run(&mut current, periods, &mut visitor)?;
            state.copy_from_slice(&current.x);
            return Ok(visitor.finish());
        }
        for period in 0..periods {
            visitor.offset = TAU * period as f64;
            self.period(&mut current, &mut [], &mut visitor)
                .map_err(|error| error.after(period))?;
        }
        state.copy_from_slice(&current.x);
        Ok(visitor.finish())
    }
}

/// The first event within `limit` of a step from `z`: its share of the step and the number of the guard. Without one, the
/// limit itself.
#[inline]
pub(super) fn first_event(
    map: &StepMap,
    z: &[f64],
    surface: Option<(usize, usize)>,
    limit: f64,
) -> (f64, Option<usize>) {
    let mut earliest = (limit, None);
    for (number, guard) in map.guards.iter().enumerate() {
        let c = guard.coefficients(z);
        let known = surface == Some((guard.guard.element, guard.guard.to));
        if let Some(s) = crossing(&c, known)
            && s < earliest.0
        {
            earliest = (s, Some(number));
        }
    }
    earliest
}

/// Multiplicity of the zero at the start from which the guard rises; `None` if it falls (or vanishes identically).
fn root_order(c: &Coefficients, first: usize) -> Option<usize> {
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
    match root_order(c, 1) {
        Some(order) => first_crossing(c, order),
        None => Some(0.0),
    }
}
