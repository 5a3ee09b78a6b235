//! What happens at an event: the regime behind it, the state after it, and what variations suffer (theory 05 §3.3 to §3.5).

use super::exact::{Entry, ExactFlow, FlowState, root_order};
use super::rest::leading;
use super::saltation::Saltation;
use super::visitor::{Event, Visitor};
use super::{FlowError, impact};
use slackside_linalg::dot;
use slackside_mechanics::{Piece, Transition};

/// A guard that has fallen through zero.
pub(super) struct Crossing {
    /// Position of the regime that ends.
    pub position: usize,
    /// Number of its guard.
    pub number: usize,
    /// Time of the event.
    pub time: f64,
}

impl ExactFlow {
    /// Passes an event: adapts the state and the variations, and returns the position of the regime that follows.
    ///
    /// # Errors
    /// [`FlowError`] if no regime follows or its tables fail.
    pub(super) fn pass<V: Visitor>(
        &mut self,
        crossing: &Crossing,
        z: &mut [f64],
        state: &mut FlowState,
        variations: &mut [f64],
        visitor: &mut V,
    ) -> Result<usize, FlowError> {
        let guard = &self.maps[crossing.position].guards[crossing.number].guard;
        let (element, from) = (guard.element, guard.from);
        match guard.transition {
            Transition::To(to) => {
                let next = self.behind(crossing.position, crossing.number, to)?;
                self.saltate(crossing, next, z, variations);
                self.confine_to(next, variations)?;
                visitor.event(&Event {
                    time: crossing.time,
                    element,
                    from,
                    to,
                });
                state.joint = self.maps[next].joint;
                state.entry = if self.factory.internal[element].is_some() {
                    self.way_back(next, (element, from), z)
                } else {
                    Entry {
                        surface: Some((element, from)),
                        known: Vec::new(),
                    }
                };
                Ok(next)
            }
            Transition::Rest(rest) => {
                let mut at_rest = vec![(element, rest)];
                at_rest.extend(
                    self.held_rests(state.joint)
                        .into_iter()
                        .filter(|(e, _)| *e != element),
                );
                let before = state.joint;
                self.settle_at_rest(z, state, &at_rest)?;
                let next = self.position(state.joint)?;
                if !variations.is_empty() {
                    if at_rest.len() == 1
                        && self.maps[crossing.position].guards[crossing.number]
                            .guard
                            .vanishing_at_rest
                            == 1
                    {
                        self.saltate_at_rest(crossing, next, element, z, variations);
                    } else {
                        self.saltate(crossing, next, z, variations);
                    }
                    self.confine_to(next, variations)?;
                }
                self.announce(before, state.joint, crossing.time, visitor);
                Ok(next)
            }
            Transition::Impact { restitution, rest } => {
                let hit = impact::Impact {
                    element,
                    rest,
                    restitution,
                };
                self.collide(&hit, crossing, z, state, variations, visitor)
            }
            // The language of laws may grow; what this interpreter does not know it must not pass over.
            _ => Err(FlowError::NoRegime {
                phase: crossing.time * self.frequency,
            }),
        }
    }

    /// A start at phase zero: the regime that holds there, decided by the first derivative of the guard that does not
    /// vanish if the state lies on a surface, and by the balance of forces if ports are at rest (theory 05 §3.4). A one-way
    /// clutch that is faster than it may be is stopped by an impulse.
    ///
    /// # Errors
    /// [`FlowError::StateLength`], or a failure to build tables.
    pub(crate) fn start<V: Visitor>(&mut self, x: &[f64], visitor: &mut V) -> Result<FlowState, FlowError> {
        let factory = self.factory.clone();
        let nx = factory.layout.state();
        if x.len() != nx {
            return Err(FlowError::StateLength {
                expected: nx,
                found: x.len(),
            });
        }
        if x.iter().any(|value| !value.is_finite()) {
            return Err(FlowError::Unbounded { periods: 0 });
        }
        let mut z = std::mem::take(&mut self.z);
        z[..nx].copy_from_slice(x);
        factory.layout.set_phase(&mut z, 0.0);
        let mut state = FlowState {
            x: x.to_vec(),
            joint: 0,
            entry: Entry::default(),
        };
        let outcome = self.begin(&mut z, &mut state, visitor);
        state.x.copy_from_slice(&z[..nx]);
        self.z = z;
        outcome.map(|()| state)
    }

    fn begin<V: Visitor>(
        &mut self,
        z: &mut [f64],
        state: &mut FlowState,
        visitor: &mut V,
    ) -> Result<(), FlowError> {
        let factory = self.factory.clone();
        let n = factory.layout.coordinates;
        let (mut at_rest, mut stopped) = (Vec::new(), Vec::new());
        for element in 0..factory.tables.len() {
            let start = factory.starting_regime(element, z);
            state.joint = factory.after(state.joint, element, start.regime);
            if let Some(rest) = start.rest {
                at_rest.push((element, rest));
            }
            if start.refused {
                stopped.push(element);
            }
        }
        if !stopped.is_empty() {
            let energy = |z: &[f64]| 0.5 * dot(&z[n..2 * n], &factory.mass.times(&z[n..2 * n]));
            let before = energy(z);
            factory.project(&stopped, z)?;
            visitor.impact(stopped[0], before - energy(z));
        }
        // Each round corrects one element; every element needs at most one per regime.
        for _ in 0..=2 * factory.tables.len() {
            let position = self.position(state.joint)?;
            let wrong = self.maps[position].guards.iter().find_map(|map| {
                let Transition::To(to) = map.guard.transition else {
                    return None;
                };
                let c = map.coefficients(z);
                let leaves = c[0] <= 0.0 && root_order(&c, 0).is_none();
                leaves.then_some((map.guard.element, to))
            });
            let Some((element, to)) = wrong else { break };
            state.joint = factory.after(state.joint, element, to);
        }
        if !at_rest.is_empty() {
            self.settle_at_rest(z, state, &at_rest)?;
        }
        Ok(())
    }

    /// Stops the ports at rest exactly and finds the joint regime that follows.
    pub(super) fn settle_at_rest(
        &mut self,
        z: &mut [f64],
        state: &mut FlowState,
        at_rest: &[(usize, usize)],
    ) -> Result<(), FlowError> {
        let factory = self.factory.clone();
        let elements: Vec<usize> = at_rest.iter().map(|&(element, _)| element).collect();
        factory.project(&elements, z)?;
        for &(element, rest) in at_rest {
            factory.place_on_stop(element, rest, z);
            if let Some(at) = factory.internal[element] {
                // At rest the spring of a decoupler is unwound.
                z[at] = 0.0;
            }
        }
        let resolved = self.resolve_rest(z, state.joint, at_rest)?;
        state.joint = resolved.joint;
        state.entry = Entry {
            surface: None,
            known: resolved.known,
        };
        Ok(())
    }

    /// What is known at the start of a regime of the guard back into the one just left, if it is the same surface. It need not
    /// be for a law with an internal state: a slider yields by its force and sticks again by its velocity, which is far from zero then. Several derivatives may vanish (a
    /// spring that stops winding up), which only the sizes of their terms tell from rounding.
    fn way_back(&self, position: usize, (element, from): (usize, usize), z: &[f64]) -> Entry {
        let mut entry = Entry::default();
        for (number, map) in self.maps[position].guards.iter().enumerate() {
            let guard = &map.guard;
            let back = matches!(guard.transition, Transition::To(to) if to == from);
            if guard.element != element || !back || matches!(leading(map, z, 0), Some((0, _))) {
                continue;
            }
            match leading(map, z, 1) {
                Some((order, true)) => entry.known.push((number, order)),
                _ => entry.surface = Some((element, from)),
            }
        }
        entry
    }

    /// Elements that stick in a joint regime, each with its rest.
    pub(super) fn held_rests(&self, joint: usize) -> Vec<(usize, usize)> {
        let factory = &self.factory;
        let held = factory.sticking(joint).into_iter();
        held.filter_map(|element| {
            let regime = factory.regime_of(joint, element);
            let rests = factory.tables[element].rests.iter();
            let rest = rests.enumerate().find(|(_, rest)| rest.stick == Some(regime));
            rest.map(|(rest, _)| (element, rest))
        })
        .collect()
    }

    /// Tells of every element that has changed its regime.
    pub(super) fn announce<V: Visitor>(&self, before: usize, after: usize, time: f64, visitor: &mut V) {
        for element in 0..self.factory.tables.len() {
            let from = self.factory.regime_of(before, element);
            let to = self.factory.regime_of(after, element);
            if from != to {
                visitor.event(&Event {
                    time,
                    element,
                    from,
                    to,
                });
            }
        }
    }

    /// Position of the regime behind a guard.
    fn behind(&mut self, position: usize, number: usize, to: usize) -> Result<usize, FlowError> {
        let guard = &self.maps[position].guards[number];
        if let Some(next) = guard.next {
            if self.maps[next].generator.frequency != self.frequency {
                self.maps[next].set_frequency(self.frequency, &mut self.work);
            }
            return Ok(next);
        }
        let joint = self
            .factory
            .after(self.maps[position].joint, guard.guard.element, to);
        let next = self.position(joint)?;
        self.maps[position].guards[number].next = Some(next);
        Ok(next)
    }

    /// Vector fields before and after an event.
    pub(super) fn fields(&self, before: usize, after: usize, z: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut fields = (vec![0.0; z.len()], vec![0.0; z.len()]);
        self.maps[before].generator.apply(z, &mut fields.0);
        self.maps[after].generator.apply(z, &mut fields.1);
        fields
    }

    /// The saltation of an event without reset.
    fn saltate(&self, crossing: &Crossing, after: usize, z: &[f64], variations: &mut [f64]) {
        if variations.is_empty() {
            return;
        }
        let nx = self.factory.layout.state();
        let map = &self.maps[crossing.position];
        let (before_field, after_field) = self.fields(crossing.position, after, z);
        let normal = &map.guards[crossing.number].guard.row;
        let speed = dot(normal, &before_field);
        let saltation = Saltation::new(&before_field[..nx], &after_field[..nx], &normal[..nx], speed);
        let columns = variations.len() / nx;
        for (number, column) in variations.chunks_exact_mut(nx).enumerate() {
            // The last column of a flow with a rate is the derivative with respect to the parameter, on which the guard
            // itself may depend.
            let shift = if number + 1 == columns {
                map.guard_rate(crossing.number, z)
            } else {
                0.0
            };
            saltation.apply(column, shift);
        }
    }

    /// The saltation where a single port comes to rest: `v ← v − (1 − ρ) M⁻¹b (b·v)/(bᵀM⁻¹b)` with the ratio `ρ` of the
    /// port's accelerations after and before (theory 05 (3.2)). It does not depend on the speed of approach.
    fn saltate_at_rest(
        &self,
        crossing: &Crossing,
        after: usize,
        element: usize,
        z: &[f64],
        variations: &mut [f64],
    ) {
        let (n, nx) = (self.factory.layout.coordinates, self.factory.layout.state());
        let (before_field, after_field) = self.fields(crossing.position, after, z);
        let port = &self.factory.ports[element];
        let acceleration = |field: &[f64]| dot(port, &field[n..2 * n]);
        let ratio = if self.factory.regime(self.maps[after].joint, element).sticks() {
            0.0
        } else {
            acceleration(&after_field) / acceleration(&before_field)
        };
        let share = (1.0 - ratio) / self.factory.mobility[(element, element)];
        for column in variations.chunks_exact_mut(nx) {
            let impulse = share * dot(port, &column[n..2 * n]);
            for (v, response) in column[n..2 * n]
                .iter_mut()
                .zip(&self.factory.port_acceleration[element])
            {
                *v -= impulse * response;
            }
        }
    }

    /// Keeps variations among the motions that the held ports allow, at the start.
    pub(super) fn confine(&self, state: &FlowState, variations: &mut [f64]) -> Result<(), FlowError> {
        self.confine_joint(state.joint, variations)
    }

    pub(super) fn confine_to(&self, position: usize, variations: &mut [f64]) -> Result<(), FlowError> {
        self.confine_joint(self.maps[position].joint, variations)
    }

    fn confine_joint(&self, joint: usize, variations: &mut [f64]) -> Result<(), FlowError> {
        if variations.is_empty() {
            return Ok(());
        }
        let (n, nx) = (self.factory.layout.coordinates, self.factory.layout.state());
        let held = self.factory.sticking(joint);
        if held.is_empty() {
            return Ok(());
        }
        let stops = held.iter().copied().filter(|&element| {
            matches!(
                self.factory.regime(joint, element).piece,
                Piece::Stick { position: Some(_) }
            )
        });
        let stops: Vec<usize> = stops.collect();
        let mut swapped = vec![0.0; nx];
        for column in variations.chunks_exact_mut(nx) {
            self.factory.project(&held, column)?;
            if !stops.is_empty() {
                // The displacement of a port that lies on its stop cannot vary either.
                swapped[n..2 * n].copy_from_slice(&column[..n]);
                self.factory.project(&stops, &mut swapped)?;
                column[..n].copy_from_slice(&swapped[n..2 * n]);
            }
        }
        Ok(())
    }

    /// The zero that the guard of a port has where it leaves its stop.
    pub(super) fn know_stop(&self, position: usize, element: usize, z: &[f64], entry: &mut Entry) {
        for (number, guard) in self.maps[position].guards.iter().enumerate() {
            let is_stop =
                guard.guard.element == element && matches!(guard.guard.transition, Transition::Impact { .. });
            if is_stop && let Some((order, true)) = leading(guard, z, 1) {
                entry.known.push((number, order));
            }
        }
    }
}
