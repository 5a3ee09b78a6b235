//! A periodic motion recovered from the harmonics of its ports.

use super::balance::{Balance, graphs};
use super::crossings::{Crossing, CrossingSearch};
use super::graph::{Argument, Graph};
use super::linearization::Linearization;
use super::{HarmonicBalanceError, Settings, elimination};
use crate::orbit::EventRecord;
use num_complex::Complex;
use slackside_mechanics::System;
use slackside_numerics::fourier::{FourierPlanner, differentiate, value};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Orders kept of a recovered motion, as a multiple of `H`.
const EXTENSION: usize = 4;

/// A periodic motion by harmonic balance: amplitudes of all coordinates and element forces, events, and from these
/// measures and stability.
///
/// The forces along the solution of `H` harmonics have all orders; the motion under them is kept to `4H`. Switching phases,
/// states and multipliers are far more accurate for it than from the `H` harmonics alone, whose truncation they feel first.
#[derive(Debug, Clone)]
pub struct HarmonicOrbit {
    /// The system.
    pub system: Arc<System>,
    /// Fundamental frequency `Ω` of the load.
    pub frequency: f64,
    /// Subharmonic order `n`; the period is `2πn/Ω`.
    pub subharmonic: usize,
    /// Number of harmonics `H` of `Ω/n` that were solved for.
    pub harmonics: usize,
    /// Share `τ` of the highest quarter of the amplitudes (theory 02 §5.5).
    pub tail: f64,
    /// Number of time samples of sampled laws; zero if all forces were evaluated exactly.
    pub samples: usize,
    /// Amplitudes `h_0 … h_4H` of each coordinate.
    pub coordinates: Vec<Vec<Complex<f64>>>,
    /// Mean rate at which each coordinate drifts; zero where something holds its mean. Its amplitudes are those of the motion
    /// about the drift.
    pub coordinate_drifts: Vec<f64>,
    /// Amplitudes of each element's displacement about its drift.
    pub displacements: Vec<Vec<Complex<f64>>>,
    /// Mean velocity of each element's port (an overrunning clutch slips on the average); zero where it does not drift.
    pub drifts: Vec<f64>,
    /// Amplitudes of each element's force.
    pub forces: Vec<Vec<Complex<f64>>>,
    /// All switchings, by rising phase `Ωt` in `[0, 2πn)`.
    pub events: Vec<EventRecord>,
    /// Regime of each element at the start; `None` for a law without regimes, or whose regimes are not pieces of a graph
    /// of displacement or velocity.
    pub regimes_at_start: Vec<Option<usize>>,
    /// Share of the period that each element spends in transmitting regimes; `None` as for the regimes.
    pub transmitting: Vec<Option<f64>>,
    /// Internal states at the start of the elements with a smooth memory, in element order.
    pub internal_states: Vec<f64>,
    pub(super) linearization: Arc<Linearization>,
}

impl HarmonicOrbit {
    /// Recovers everything from the unknowns `z` at frequency `Ω`: `q_k = D_k⁻¹ (F_k − B N_k)`. `O(H n³)`.
    pub(super) fn recover(
        balance: &mut Balance,
        z: &[f64],
        frequency: f64,
        planner: &mut FourierPlanner,
    ) -> Result<Self, HarmonicBalanceError> {
        balance.unpack(z);
        let harmonics = balance.harmonics;
        let remainders = balance.remainders(frequency, EXTENSION * harmonics);
        let coordinates = coordinates(balance, &remainders, frequency)?;
        let internal_states = balance.internal_states(frequency);
        let found = Self {
            internal_states,
            linearization: balance.linearization.clone(),
            drifts: Vec::new(),
            coordinate_drifts: vec![0.0; balance.linear.order()],
            system: balance.system.clone(),
            frequency,
            subharmonic: balance.subharmonic,
            harmonics,
            tail: balance.tail(),
            samples: balance.samples(),
            coordinates,
            displacements: Vec::new(),
            forces: Vec::new(),
            events: Vec::new(),
            regimes_at_start: Vec::new(),
            transmitting: Vec::new(),
        };
        Ok(found.with_ports(&balance.nonlinear, &remainders, planner))
    }

    /// The motion with the given amplitudes `h_0 … h_4H` of each coordinate, by whichever method they were found, with the
    /// forces that the elements' laws make of it.
    ///
    /// # Errors
    /// [`HarmonicBalanceError::System`] if the system is not sound, [`HarmonicBalanceError::Start`] if the amplitudes do not
    /// fit it.
    pub(in crate::orbit) fn of_coordinates(
        system: &Arc<System>,
        frequency: f64,
        coordinates: Vec<Vec<Complex<f64>>>,
    ) -> Result<Self, HarmonicBalanceError> {
        system.check()?;
        let orders = coordinates.first().map_or(0, |q| q.len().saturating_sub(1));
        let fits = coordinates.iter().all(|q| q.len() == orders + 1);
        if coordinates.len() != system.order() || !fits || orders == 0 || !orders.is_multiple_of(EXTENSION) {
            return Err(HarmonicBalanceError::Start {
                what: "amplitudes of coordinates",
                expected: system.order(),
                found: coordinates.len(),
            });
        }
        let mut planner = FourierPlanner::default();
        let settings = Settings::fixed(orders);
        let mut balance = Balance::new(system.clone(), &settings, orders, settings.samples, &mut planner);
        for (port, &element) in balance.displacements.iter_mut().zip(&balance.nonlinear) {
            let terms = system.elements[element].port.terms();
            for (k, amplitude) in port.iter_mut().enumerate() {
                *amplitude = terms.iter().map(|&(i, factor)| coordinates[i][k] * factor).sum();
            }
        }
        let remainders = balance.remainders(frequency, orders);
        let internal_states = balance.internal_states(frequency);
        let found = Self {
            internal_states,
            linearization: balance.linearization.clone(),
            drifts: Vec::new(),
            coordinate_drifts: vec![0.0; system.order()],
            system: system.clone(),
            frequency,
            subharmonic: 1,
            harmonics: orders / EXTENSION,
            tail: balance.tail(),
            samples: balance.samples(),
            coordinates,
            displacements: Vec::new(),
            forces: Vec::new(),
            events: Vec::new(),
            regimes_at_start: Vec::new(),
            transmitting: Vec::new(),
        };
        Ok(found.with_ports(&balance.nonlinear, &remainders, &mut planner))
    }

    /// The same with displacements, forces and events of all elements, from the coordinates and the remainder forces of the
    /// nonlinear elements.
    fn with_ports(
        mut self,
        nonlinear: &[usize],
        remainders: &[Vec<Complex<f64>>],
        planner: &mut FourierPlanner,
    ) -> Self {
        let omega = self.omega();
        // The mean solution holds drift and mean position; they are perpendicular.
        if let Some((projector, _)) = &self.linearization.drift {
            let mean: Vec<f64> = self.coordinates.iter().map(|q| q[0].re).collect();
            self.coordinate_drifts = projector.times(&mean);
            for (q, drift) in self.coordinates.iter_mut().zip(&self.coordinate_drifts) {
                q[0].re -= drift;
            }
        }
        for (e, element) in self.system.elements.iter().enumerate() {
            let slot = nonlinear.iter().position(|&index| index == e);
            let terms = element.port.terms();
            let of_order = |k: usize| {
                terms
                    .iter()
                    .map(|&(i, factor)| self.coordinates[i][k] * factor)
                    .sum()
            };
            let displacement: Vec<Complex<f64>> = (0..=EXTENSION * self.harmonics).map(of_order).collect();
            let (spring, damper) = self.linearization.elements[e];
            let drift = match self.linearization.drifting[e] {
                true => element.port.project(&self.coordinate_drifts),
                false => 0.0,
            };
            self.drifts.push(drift);
            let force = displacement.iter().enumerate().map(|(k, u)| {
                let mut linear = Complex::new(spring, damper * k as f64 * omega) * u;
                if k == 0 {
                    linear.re += damper * drift;
                }
                linear + slot.map_or(Complex::ZERO, |slot| remainders[slot][k])
            });
            self.forces.push(force.collect());
            self.displacements.push(displacement);
        }
        self.find_events(planner);
        self
    }

    fn find_events(&mut self, planner: &mut FourierPlanner) {
        let orders = EXTENSION * self.harmonics;
        let mut search = CrossingSearch::new(orders, planner);
        let mut crossings: Vec<Crossing> = Vec::new();
        let mut argument = vec![Complex::ZERO; orders + 1];
        for (element, graph) in graphs(&self.system, &self.linearization).into_iter().enumerate() {
            let Some(graph) = graph else {
                self.regimes_at_start.push(None);
                self.transmitting.push(None);
                continue;
            };
            match graph.argument {
                Argument::Displacement => argument.copy_from_slice(&self.displacements[element]),
                Argument::Velocity => argument.copy_from_slice(&self.port_rate(element)),
            }
            search.find(&argument, &graph.levels, &mut crossings);
            let start = graph.piece_at(value(&argument, 0.0));
            self.regimes_at_start.push(Some(graph.regimes[start]));
            self.transmitting
                .push(Some(transmitting(&graph, start, &crossings)));
            for crossing in &crossings {
                let (below, above) = (graph.regimes[crossing.level], graph.regimes[crossing.level + 1]);
                let (from, to) = if crossing.rising {
                    (below, above)
                } else {
                    (above, below)
                };
                self.events.push(EventRecord {
                    phase: crossing.angle * self.subharmonic as f64,
                    element,
                    from,
                    to,
                });
            }
        }
        self.events.sort_by(|a, b| a.phase.total_cmp(&b.phase));
    }

    /// Amplitudes of the velocity of an element's port, with its drift as the mean.
    pub(super) fn port_rate(&self, element: usize) -> Vec<Complex<f64>> {
        let displacement = &self.displacements[element];
        let mut rate = vec![Complex::ZERO; displacement.len()];
        differentiate(displacement, self.omega(), &mut rate);
        rate[0].re = self.drifts[element];
        rate
    }

    /// The fundamental frequency `ω = Ω/n` of the motion.
    pub fn omega(&self) -> f64 {
        self.frequency / self.subharmonic as f64
    }

    /// The period `2πn/Ω`.
    pub fn period(&self) -> f64 {
        TAU / self.omega()
    }

    /// The turn `0 … 2π` in intervals that end at the switchings and are no longer than `widest`, on each of which the motion
    /// of every piecewise-linear law is smooth.
    pub(super) fn panels(&self, widest: f64) -> Vec<(f64, f64)> {
        let mut panels = Vec::new();
        let mut start = 0.0;
        let switchings = self
            .events
            .iter()
            .map(|event| event.phase / self.subharmonic as f64);
        for end in switchings.chain([TAU]).filter(|&end| end <= TAU) {
            let parts = ((end - start) / widest).ceil().max(0.0) as usize;
            let at = |i: usize| start + (end - start) * i as f64 / parts as f64;
            panels.extend((0..parts).map(|i| (at(i), at(i + 1))));
            start = end.max(start);
        }
        panels
    }

    /// Coordinates, then their rates, at phase `Ωt` (radians, counted from the start of the motion); internal states are not
    /// part of it.
    pub fn state_at(&self, phase: f64) -> Vec<f64> {
        let angle = phase / self.subharmonic as f64;
        let mut rate = vec![Complex::ZERO; EXTENSION * self.harmonics + 1];
        let time = phase / self.frequency;
        let moving = || self.coordinates.iter().zip(&self.coordinate_drifts);
        let mut state: Vec<f64> = moving()
            .map(|(q, drift)| value(q, angle) + drift * time)
            .collect();
        for (q, drift) in moving() {
            differentiate(q, self.omega(), &mut rate);
            state.push(value(&rate, angle) + drift);
        }
        state
    }

    /// The initial state `(q, q')` at `t = 0`, followed by the internal states of the elements with a smooth memory.
    pub fn initial_state(&self) -> Vec<f64> {
        let mut state = self.state_at(0.0);
        state.extend(&self.internal_states);
        state
    }
}

/// Share of the turn on transmitting pieces.
fn transmitting(graph: &Graph, start: usize, crossings: &[Crossing]) -> f64 {
    let (mut piece, mut from, mut sum) = (start, 0.0, 0.0);
    for crossing in crossings {
        if graph.transmitting[piece] {
            sum += crossing.angle - from;
        }
        piece = if crossing.rising {
            crossing.level + 1
        } else {
            crossing.level
        };
        from = crossing.angle;
    }
    if graph.transmitting[piece] {
        sum += TAU - from;
    }
    sum / TAU
}

/// Amplitudes of all coordinates under load and remainder forces.
fn coordinates(
    balance: &Balance,
    remainders: &[Vec<Complex<f64>>],
    frequency: f64,
) -> Result<Vec<Vec<Complex<f64>>>, HarmonicBalanceError> {
    let n = balance.linear.order();
    let highest = EXTENSION * balance.harmonics;
    let mut result = vec![vec![Complex::ZERO; highest + 1]; n];
    let mut stiffness = vec![Complex::ZERO; n * n];
    let mut right = vec![Complex::ZERO; n];
    for k in 0..=highest {
        right.fill(Complex::ZERO);
        if let Some(load) = balance.linear.load(k, balance.subharmonic) {
            right.copy_from_slice(load);
        }
        for (port, remainder) in balance.linear.ports.iter().zip(remainders) {
            for &(i, factor) in port.terms() {
                right[i] -= remainder[k] * factor;
            }
        }
        balance
            .linear
            .dynamic_stiffness(k, frequency, balance.subharmonic, &mut stiffness);
        if !elimination::solve(&mut stiffness, &mut right, n, 1) {
            return Err(HarmonicBalanceError::Resonance {
                harmonic: k,
                frequency,
            });
        }
        for (q, h) in result.iter_mut().zip(&right) {
            q[k] = *h;
        }
    }
    Ok(result)
}
