//! Impacts on rigid stops, and their end (theory 05 §6.4).

use super::FlowError;
use super::event::Crossing;
use super::exact::{ExactFlow, FlowState};
use super::visitor::{Event, Visitor};
use slackside_linalg::dot;
use std::f64::consts::TAU;

/// Share of the load's period below which the impacts that are still to come count as done.
const CHATTER: f64 = 1e-10;

/// A port hits its stop.
pub(super) struct Impact {
    pub element: usize,
    pub rest: usize,
    pub restitution: f64,
}

/// The linear map of velocities at an impact, by the impulses at the stop and at the one-sided constraints that take part.
struct Reset {
    elements: Vec<usize>,
    /// Velocity that each impulse takes away, as a multiple of the port's velocity: `1 + e` at the stop, 1 elsewhere.
    factors: Vec<f64>,
}

impl ExactFlow {
    /// Passes an impact; returns the position of the regime that follows. A locked one-way clutch transmits an impulse of
    /// its direction, dry friction none: it slides afterwards.
    pub(super) fn collide<V: Visitor>(
        &mut self,
        hit: &Impact,
        crossing: &Crossing,
        z: &mut [f64],
        state: &mut FlowState,
        variations: &mut [f64],
        visitor: &mut V,
    ) -> Result<usize, FlowError> {
        let factory = self.factory.clone();
        let (n, nx) = (factory.layout.coordinates, factory.layout.state());
        let before_joint = state.joint;
        let before = z.to_vec();
        let energy = |z: &[f64]| 0.5 * dot(&z[n..2 * n], &factory.mass.times(&z[n..2 * n]));
        let held = self.held_rests(before_joint);
        let mut reset = self.impulses(hit, hit.restitution, &held, z)?;
        self.apply_reset(&reset, z)?;
        let ceased = self.has_ceased(hit, crossing.position, z);
        if ceased {
            z[..nx].copy_from_slice(&before[..nx]);
            reset = self.impulses(hit, 0.0, &held, z)?;
            self.apply_reset(&reset, z)?;
        }
        // What held before and moves now slides; what is at rest is decided by the balance of forces.
        let mut at_rest: Vec<(usize, usize)> =
            ceased.then_some((hit.element, hit.rest)).into_iter().collect();
        for &(element, rest) in &held {
            let (_, v, _) = factory.port_motion(element, z);
            let rests = factory.tables[element].rests[rest];
            let slides = if v < 0.0 { rests.backward } else { rests.forward };
            match slides {
                Some(to) if !factory.is_at_rest(element, z) && !reset.elements.contains(&element) => {
                    state.joint = factory.after(state.joint, element, to);
                }
                _ => at_rest.push((element, rest)),
            }
        }
        state.entry.clear();
        if !at_rest.is_empty() {
            self.settle_at_rest(z, state, &at_rest)?;
        }
        let next = self.position(state.joint)?;
        if !ceased {
            let mut entry = std::mem::take(&mut state.entry);
            self.know_stop(next, hit.element, z, &mut entry);
            state.entry = entry;
        }
        self.saltate_impact(&reset, crossing, next, &before, z, variations)?;
        visitor.impact(hit.element, energy(&before) - energy(z));
        if !ceased {
            let regime = factory.regime_of(state.joint, hit.element);
            visitor.event(&Event {
                time: crossing.time,
                element: hit.element,
                from: regime,
                to: regime,
            });
        }
        self.announce(before_joint, state.joint, crossing.time, visitor);
        Ok(next)
    }

    /// The impulses of a hit: at the stop, and at those locked ports that would otherwise be driven through.
    fn impulses(
        &self,
        hit: &Impact,
        restitution: f64,
        held: &[(usize, usize)],
        z: &[f64],
    ) -> Result<Reset, FlowError> {
        let factory = &self.factory;
        let mut reset = Reset {
            elements: vec![hit.element],
            factors: vec![1.0 + restitution],
        };
        let one_sided: Vec<usize> = held
            .iter()
            .filter(|&&(element, rest)| factory.tables[element].rests[rest].forward.is_none())
            .map(|&(element, _)| element)
            .collect();
        for _ in 0..one_sided.len() {
            let mut after = z.to_vec();
            self.apply_reset(&reset, &mut after)?;
            let driven = one_sided.iter().find(|&&element| {
                !reset.elements.contains(&element)
                    && !factory.is_at_rest(element, &after)
                    && factory.port_motion(element, &after).1 > 0.0
            });
            let Some(&element) = driven else { break };
            reset.elements.push(element);
            reset.factors.push(1.0);
        }
        Ok(reset)
    }

    fn apply_reset(&self, reset: &Reset, x: &mut [f64]) -> Result<(), FlowError> {
        let factory = &self.factory;
        let n = factory.layout.coordinates;
        let mut impulses: Vec<f64> = reset
            .elements
            .iter()
            .zip(&reset.factors)
            .map(|(&element, factor)| factor * dot(&factory.ports[element], &x[n..2 * n]))
            .collect();
        factory
            .held_mobility(&reset.elements)?
            .solve_in_place(&mut impulses);
        for (&element, impulse) in reset.elements.iter().zip(impulses) {
            for (v, response) in x[n..2 * n].iter_mut().zip(&factory.port_acceleration[element]) {
                *v -= impulse * response;
            }
        }
        Ok(())
    }

    /// Whether the impacts that follow this one are over within a negligible time: under a pressing acceleration `a` they
    /// take `2 v₊ / (a (1 − e))` together.
    fn has_ceased(&self, hit: &Impact, position: usize, z: &[f64]) -> bool {
        let n = self.factory.layout.coordinates;
        let mut field = vec![0.0; z.len()];
        self.maps[position].generator.apply(z, &mut field);
        let pressing = dot(&self.factory.ports[hit.element], &field[n..2 * n]);
        let (_, velocity, _) = self.factory.port_motion(hit.element, z);
        let period = TAU / self.frequency;
        if hit.restitution >= 1.0 {
            return false;
        }
        if hit.restitution <= 0.0 {
            return true;
        }
        pressing > 0.0 && -2.0 * velocity <= CHATTER * period * pressing * (1.0 - hit.restitution)
    }

    /// `S = J + (f₊ − J f₋) gᵀ / (gᵀ f₋)` with the reset `J` (theory 05 §3.5).
    fn saltate_impact(
        &self,
        reset: &Reset,
        crossing: &Crossing,
        next: usize,
        before: &[f64],
        after: &[f64],
        variations: &mut [f64],
    ) -> Result<(), FlowError> {
        if variations.is_empty() {
            return Ok(());
        }
        let nx = self.factory.layout.state();
        let map = &self.maps[crossing.position];
        let mut field = vec![0.0; before.len()];
        map.generator.apply(before, &mut field);
        let mut jump = vec![0.0; before.len()];
        self.maps[next].generator.apply(after, &mut jump);
        let normal = &map.guards[crossing.number].guard.row;
        let speed = dot(normal, &field);
        self.apply_reset(reset, &mut field)?;
        for (j, f) in jump.iter_mut().zip(&field) {
            *j = (*j - f) / speed;
        }
        let columns = variations.len() / nx;
        for (number, column) in variations.chunks_exact_mut(nx).enumerate() {
            let mut along = dot(&normal[..nx], column);
            if number + 1 == columns {
                along += map.guard_rate(crossing.number, before);
            }
            self.apply_reset(reset, column)?;
            for (value, jump) in column.iter_mut().zip(&jump) {
                *value += jump * along;
            }
        }
        self.confine_to(next, variations)
    }
}
