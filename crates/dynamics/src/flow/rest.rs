//! Which regimes hold when ports are at rest: the box complementarity problem of theory 05 §3.4.
//!
//! A candidate gives every element at rest one of its regimes. It holds if the forces of those that stick lie within their
//! limits and the others begin to move the way their regime says. One linear solve with the ports' mobility per candidate
//! decides that, except for ties (a force at its limit, an acceleration of zero); those are decided by the first derivative
//! that does not vanish, from the candidate's own tables.

use super::regime_factory::RegimeFactory;
use super::step_map::GuardMap;
use super::{ExactFlow, FlowError};
use slackside_linalg::dot;
use slackside_mechanics::{Piece, Transition};
use slackside_numerics::polynomial::TERMS;

/// Relative size below which a sum of that many terms counts as zero.
const ROUNDING: f64 = 1e-11;

/// Relative speed below which a port is at rest.
const REST: f64 = 1e-12;

/// A guard that vanishes at the start of a regime by construction: its number and the multiplicity of that zero, which is
/// [`TERMS`] if it vanishes identically.
pub(super) type KnownRoot = (usize, usize);

/// A joint regime with the zeros that its guards have at the start.
#[derive(Debug, Clone, Default)]
pub(super) struct Resolved {
    pub joint: usize,
    pub known: Vec<KnownRoot>,
}

/// How a candidate passes the cheap test.
#[derive(PartialEq)]
enum Verdict {
    Refused,
    Tie,
    Holds,
}

impl RegimeFactory {
    /// Whether a port is at rest: its speed is rounding beside what the kinetic energy would allow it.
    pub fn is_at_rest(&self, element: usize, x: &[f64]) -> bool {
        let n = self.layout.coordinates;
        let velocities = &x[n..2 * n];
        let port = dot(&self.ports[element], velocities);
        let energy = dot(velocities, &self.mass.times(velocities)).max(0.0);
        port.abs() <= REST * (self.mobility[(element, element)] * energy).sqrt()
    }

    /// The cheap test of a candidate: `regimes` of the elements `at_rest`, in a state with accelerations `base` (and their
    /// scale of rounding) of everything else.
    fn verdict(
        &self,
        at_rest: &[usize],
        regimes: &[usize],
        z: &[f64],
        base: &(Vec<f64>, Vec<f64>),
    ) -> Result<Verdict, FlowError> {
        let mut forces = vec![0.0; at_rest.len()];
        let mut held = Vec::new();
        for (slot, (&element, &regime)) in at_rest.iter().zip(regimes).enumerate() {
            let (u, _, zeta) = self.port_motion(element, z);
            match self.tables[element].regimes[regime].piece {
                Piece::Affine {
                    constant,
                    displacement,
                    internal,
                    ..
                } => forces[slot] = constant + displacement * u + internal * zeta,
                _ => held.push(slot),
            }
        }
        // Accelerations of the ports without and with the forces, and the sizes of what they are sums of.
        let along = |slot: usize, forces: &[f64]| {
            let element = at_rest[slot];
            let port = self.ports[element].iter();
            let mut value: f64 = port.clone().zip(&base.0).map(|(b, a)| b * a).sum();
            let mut size: f64 = port.zip(&base.1).map(|(b, a)| (b * a).abs()).sum();
            for (&other, f) in at_rest.iter().zip(forces) {
                let term = self.mobility[(element, other)] * f;
                value -= term;
                size += term.abs();
            }
            (value, size)
        };
        let mut sizes = vec![0.0; at_rest.len()];
        if !held.is_empty() {
            let elements: Vec<usize> = held.iter().map(|&slot| at_rest[slot]).collect();
            let mut multipliers = Vec::with_capacity(held.len());
            for &slot in &held {
                let (value, size) = along(slot, &forces);
                multipliers.push(value);
                sizes[slot] = size / self.mobility[(at_rest[slot], at_rest[slot])];
            }
            self.held_mobility(&elements)?.solve_in_place(&mut multipliers);
            for (&slot, multiplier) in held.iter().zip(multipliers) {
                forces[slot] = multiplier;
            }
        }
        let mut verdict = Verdict::Holds;
        let mut judge = |value: f64, size: f64| {
            if value < -ROUNDING * size {
                verdict = Verdict::Refused;
            } else if value <= ROUNDING * size && verdict == Verdict::Holds {
                verdict = Verdict::Tie;
            }
        };
        for (slot, (&element, &regime)) in at_rest.iter().zip(regimes).enumerate() {
            let (u, _, zeta) = self.port_motion(element, z);
            let (acceleration, size) = along(slot, &forces);
            for guard in &self.tables[element].regimes[regime].guards {
                if guard.force != 0.0 {
                    let limit = guard.displacement * u + guard.internal * zeta + guard.constant;
                    let value = guard.force * forces[slot] + limit;
                    judge(value, (guard.force * sizes[slot]).abs() + limit.abs());
                } else if guard.velocity != 0.0 {
                    judge(guard.velocity * acceleration, (guard.velocity * size).abs());
                } else if guard.internal != 0.0 {
                    // The spring of a decoupler winds up or not with the acceleration.
                    judge(guard.internal * acceleration, (guard.internal * size).abs());
                } else if let Transition::Impact { .. } = guard.transition {
                    judge(
                        guard.displacement * acceleration,
                        (guard.displacement * size).abs(),
                    );
                }
            }
        }
        Ok(verdict)
    }
}

/// The first coefficient of a guard beyond the rounding of its terms: its order and whether it is positive. `None` if the
/// guard vanishes identically.
pub(super) fn leading(guard: &GuardMap, z: &[f64], first: usize) -> Option<(usize, bool)> {
    let value = guard.coefficients(z);
    (first..TERMS).find_map(|k| {
        let scale: f64 = guard
            .taylor
            .iter()
            .zip(z)
            .map(|(column, value)| (column[k] * value).abs())
            .sum();
        (value[k].abs() > ROUNDING * scale).then_some((k, value[k] > 0.0))
    })
}

impl ExactFlow {
    /// The joint regime that holds when the elements `at_rest`, each with its [`slackside_mechanics::Rest`], have no port
    /// velocity, all others keeping theirs.
    ///
    /// # Errors
    /// [`FlowError::NoRegime`] if no candidate holds, which a positive definite mobility excludes for monotone laws.
    pub(super) fn resolve_rest(
        &mut self,
        z: &[f64],
        joint: usize,
        at_rest: &[(usize, usize)],
    ) -> Result<Resolved, FlowError> {
        let elements: Vec<usize> = at_rest.iter().map(|&(element, _)| element).collect();
        let choices: Vec<Vec<usize>> = at_rest
            .iter()
            .map(|&(element, rest)| self.factory.tables[element].rests[rest].candidates().collect())
            .collect();
        let base = self.accelerations_without(z, joint, &elements);
        let mut ties = Vec::new();
        let total: usize = choices.iter().map(Vec::len).product();
        for number in 0..total {
            let mut rest = number;
            let regimes: Vec<usize> = choices
                .iter()
                .map(|choice| {
                    let regime = choice[rest % choice.len()];
                    rest /= choice.len();
                    regime
                })
                .collect();
            let verdict = self.factory.verdict(&elements, &regimes, z, &base)?;
            if verdict == Verdict::Refused {
                continue;
            }
            let candidate = elements
                .iter()
                .zip(&regimes)
                .fold(joint, |joint, (&element, &to)| {
                    self.factory.after(joint, element, to)
                });
            if verdict == Verdict::Holds {
                return self.with_known_roots(z, candidate, &elements);
            }
            ties.push(candidate);
        }
        for &candidate in &ties {
            if self.begins(z, candidate, &elements)? {
                return self.with_known_roots(z, candidate, &elements);
            }
        }
        // Everything vanishes to rounding: any of the candidates holds, and the first sticks.
        match ties.first() {
            Some(&candidate) => self.with_known_roots(z, candidate, &elements),
            None => Err(FlowError::NoRegime {
                phase: self.phase_of(z),
            }),
        }
    }

    /// Accelerations from the load and from all elements but the given ones.
    fn accelerations_without(&self, z: &[f64], joint: usize, without: &[usize]) -> (Vec<f64>, Vec<f64>) {
        let factory = &self.factory;
        let (mut value, mut size) = factory.free_acceleration(z);
        for element in (0..factory.tables.len()).filter(|element| !without.contains(element)) {
            let Piece::Affine {
                constant,
                displacement,
                velocity,
                internal,
            } = factory.regime(joint, element).piece
            else {
                continue;
            };
            let (u, v, zeta) = factory.port_motion(element, z);
            let force = constant + displacement * u + velocity * v + internal * zeta;
            for (i, response) in factory.port_acceleration[element].iter().enumerate() {
                value[i] -= response * force;
                size[i] += (response * force).abs();
            }
        }
        (value, size)
    }

    /// Whether a motion begins in the joint regime: every guard of the elements rises from zero or is positive.
    fn begins(&mut self, z: &[f64], joint: usize, elements: &[usize]) -> Result<bool, FlowError> {
        let position = self.position(joint)?;
        let guards = self.maps[position].guards.iter();
        Ok(guards
            .filter(|guard| elements.contains(&guard.guard.element))
            .all(|guard| leading(guard, z, guard.guard.vanishing_at_rest).is_none_or(|(_, rises)| rises)))
    }

    fn with_known_roots(
        &mut self,
        z: &[f64],
        joint: usize,
        elements: &[usize],
    ) -> Result<Resolved, FlowError> {
        let position = self.position(joint)?;
        let known = self.maps[position].guards.iter().enumerate();
        let known = known
            .filter(|(_, guard)| elements.contains(&guard.guard.element))
            .filter_map(|(number, guard)| {
                let order =
                    leading(guard, z, guard.guard.vanishing_at_rest).map_or(TERMS, |(order, _)| order);
                (order > 0).then_some((number, order))
            })
            .collect();
        Ok(Resolved { joint, known })
    }

    /// Phase of the load in an augmented state.
    pub(super) fn phase_of(&self, z: &[f64]) -> f64 {
        let at = self.factory.layout.state() + 1;
        match (z.get(at), z.get(at + 1), self.factory.layout.orders.first()) {
            (Some(c), Some(s), Some(&order)) => s.atan2(*c) / order as f64,
            _ => 0.0,
        }
    }
}
