//! The equations of motion solved for the accelerations, and their linearisation along a motion (theory 05 (1.1)).

use crate::flow::FlowError;
use slackside_linalg::{Lu, Matrix, dot};
use slackside_mechanics::{Element, Gradient, Law, MemoryResponse, Port, System};
use std::sync::Arc;

/// `q'' = M⁻¹ (F(φ) − C q' − K q − Σ b f(bᵀq, bᵀq', ζ))`, `ζ' = g(bᵀq, bᵀq', ζ)` at one frequency of the load; `φ = Ωt` is
/// the phase. The state is `(q, q', ζ)`.
#[derive(Debug, Clone)]
pub(super) struct Equations {
    coordinates: usize,
    internal: usize,
    /// `(−M⁻¹K, −M⁻¹C)` by rows of length `2n`.
    linear: Vec<f64>,
    /// `M⁻¹F₀`.
    constant: Vec<f64>,
    /// Order, `M⁻¹Fc` and `M⁻¹Fs` of each harmonic of the load.
    harmonics: Vec<(usize, Vec<f64>, Vec<f64>)>,
    elements: Vec<LocalForce>,
}

/// An element with its effect on the accelerations.
#[derive(Debug, Clone)]
struct LocalForce {
    port: Port,
    law: Arc<dyn Law>,
    /// `M⁻¹b`.
    acceleration: Vec<f64>,
    /// Which internal state is its own.
    internal: Option<usize>,
}

impl Equations {
    /// # Errors
    /// [`FlowError::Linalg`] if the mass matrix is singular, [`FlowError::Mixed`] if a law's force is no function of the state.
    pub fn new(system: &System, frequency: f64) -> Result<Self, FlowError> {
        check_laws(system)?;
        let n = system.order();
        let mass = Lu::new(&system.mass)?;
        let mut linear = vec![0.0; 2 * n * n];
        for (offset, matrix) in [
            (0, system.stiffness_at(frequency)),
            (n, system.damping_at(frequency)),
        ] {
            let solved: Matrix = mass.solve_matrix(&matrix);
            for i in 0..n {
                for j in 0..n {
                    linear[2 * n * i + offset + j] = -solved[(i, j)];
                }
            }
        }
        let mut internal = 0;
        let mut local = |element: &Element| {
            let index = internal;
            let remembers = element.law.memory().is_some();
            internal += usize::from(remembers);
            LocalForce {
                port: element.port.clone(),
                law: element.law.clone(),
                acceleration: mass.solve(&element.port.dense(n)),
                internal: remembers.then_some(index),
            }
        };
        let elements: Vec<LocalForce> = system.elements.iter().map(&mut local).collect();
        let harmonics = system
            .forcing
            .harmonics
            .iter()
            .map(|h| (h.order, mass.solve(&h.cosine), mass.solve(&h.sine)));
        Ok(Self {
            coordinates: n,
            internal,
            linear,
            constant: mass.solve(&system.forcing.constant),
            harmonics: harmonics.collect(),
            elements,
        })
    }

    /// Number of coordinates `n`.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Length of the state: `2n` and the internal states.
    pub fn state(&self) -> usize {
        2 * self.coordinates + self.internal
    }

    /// Force of an element and rate of its internal state, with tangents, at state `x`.
    pub fn response(&self, element: usize, x: &[f64]) -> MemoryResponse {
        let (q, rest) = x.split_at(self.coordinates);
        let (v, zeta) = rest.split_at(self.coordinates);
        let LocalForce {
            port, law, internal, ..
        } = &self.elements[element];
        let (u, v) = (port.project(q), port.project(v));
        if let (Some(index), Some(memory)) = (internal, law.memory()) {
            return memory.evaluate(u, v, zeta[*index]);
        }
        let response = law.response(u, v);
        MemoryResponse {
            force: response.force,
            force_by: Gradient {
                displacement: response.by_displacement,
                velocity: response.by_velocity,
                internal: 0.0,
            },
            ..MemoryResponse::default()
        }
    }

    /// Accelerations and rates of the internal states at state `x`; leaves the responses of the elements in `responses`.
    pub fn rates(&self, phase: f64, x: &[f64], responses: &mut Vec<MemoryResponse>, out: &mut [f64]) {
        let (accelerations, internal_rates) = out.split_at_mut(self.coordinates);
        let motion = &x[..2 * self.coordinates];
        let rows = self.linear.chunks_exact(motion.len());
        for ((row, constant), value) in rows.zip(&self.constant).zip(accelerations.iter_mut()) {
            *value = constant + dot(row, motion);
        }
        for (order, cosine, sine) in &self.harmonics {
            let (sin, cos) = (*order as f64 * phase).sin_cos();
            for ((value, a), b) in accelerations.iter_mut().zip(cosine).zip(sine) {
                *value += a * cos + b * sin;
            }
        }
        responses.clear();
        for (element, local) in self.elements.iter().enumerate() {
            let response = self.response(element, x);
            for (value, b) in accelerations.iter_mut().zip(&local.acceleration) {
                *value -= b * response.force;
            }
            if let Some(index) = local.internal {
                internal_rates[index] = response.rate;
            }
            responses.push(response);
        }
    }

    /// Derivative of a variation `column` of the state, with the tangents of the elements in `responses`.
    pub fn vary(&self, responses: &[MemoryResponse], column: &[f64], out: &mut [f64]) {
        let n = self.coordinates;
        let (motion, internal) = column.split_at(2 * n);
        let (q, v) = motion.split_at(n);
        let (rates, rest) = out.split_at_mut(n);
        let (accelerations, internal_rates) = rest.split_at_mut(n);
        rates.copy_from_slice(v);
        let rows = self.linear.chunks_exact(2 * n);
        for (row, value) in rows.zip(accelerations.iter_mut()) {
            *value = dot(row, motion);
        }
        for (local, response) in self.elements.iter().zip(responses) {
            let (u, v) = (local.port.project(q), local.port.project(v));
            let zeta = local.internal.map_or(0.0, |index| internal[index]);
            let along = |by: &Gradient| by.displacement * u + by.velocity * v + by.internal * zeta;
            let force = along(&response.force_by);
            for (value, b) in accelerations.iter_mut().zip(&local.acceleration) {
                *value -= b * force;
            }
            if let Some(index) = local.internal {
                internal_rates[index] = along(&response.rate_by);
            }
        }
    }
}

/// Checks that every law's force is a function of the state.
fn check_laws(system: &System) -> Result<(), FlowError> {
    let switching = system.elements.iter().find(|element| {
        let table = element.law.regimes();
        table.is_some_and(|table| table.internal || !table.rests.is_empty())
    });
    let Some(switching) = switching else { return Ok(()) };
    let smooth = system
        .elements
        .iter()
        .find(|element| element.law.regimes().is_none());
    Err(FlowError::Mixed {
        smooth: smooth.map_or_else(String::new, |element| element.name.clone()),
        switching: switching.name.clone(),
    })
}
