//! The equations of motion solved for the accelerations, and their linearisation along a motion (theory 05 (1.1)).

use crate::flow::FlowError;
use slackside_linalg::{Lu, Matrix, dot};
use slackside_mechanics::{Law, Port, Response, System};
use std::sync::Arc;

/// `q'' = M⁻¹ (F(φ) − C q' − K q − Σ b f(bᵀq, bᵀq'))` at one frequency of the load; `φ = Ωt` is the phase.
#[derive(Debug, Clone)]
pub(super) struct Equations {
    coordinates: usize,
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
}

impl Equations {
    /// # Errors
    /// [`FlowError::Linalg`] if the mass matrix is singular.
    pub fn new(system: &System, frequency: f64) -> Result<Self, FlowError> {
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
        let elements = system.elements.iter().map(|element| LocalForce {
            port: element.port.clone(),
            law: element.law.clone(),
            acceleration: mass.solve(&element.port.dense(n)),
        });
        let harmonics = system
            .forcing
            .harmonics
            .iter()
            .map(|h| (h.order, mass.solve(&h.cosine), mass.solve(&h.sine)));
        Ok(Self {
            coordinates: n,
            linear,
            constant: mass.solve(&system.forcing.constant),
            harmonics: harmonics.collect(),
            elements: elements.collect(),
        })
    }

    /// Length `2n` of the state.
    pub fn state(&self) -> usize {
        2 * self.coordinates
    }

    /// Force and tangents of an element at state `x`.
    pub fn response(&self, element: usize, x: &[f64]) -> Response {
        let (q, v) = x.split_at(self.coordinates);
        let LocalForce { port, law, .. } = &self.elements[element];
        law.response(port.project(q), port.project(v))
    }

    /// Accelerations at state `x`; leaves the responses of the elements in `responses`.
    pub fn accelerations(&self, phase: f64, x: &[f64], responses: &mut Vec<Response>, out: &mut [f64]) {
        for (i, (row, value)) in self.linear.chunks_exact(x.len()).zip(out.iter_mut()).enumerate() {
            *value = self.constant[i] + dot(row, x);
        }
        for (order, cosine, sine) in &self.harmonics {
            let (sin, cos) = (*order as f64 * phase).sin_cos();
            for ((value, a), b) in out.iter_mut().zip(cosine).zip(sine) {
                *value += a * cos + b * sin;
            }
        }
        responses.clear();
        for (element, local) in self.elements.iter().enumerate() {
            let response = self.response(element, x);
            for (value, b) in out.iter_mut().zip(&local.acceleration) {
                *value -= b * response.force;
            }
            responses.push(response);
        }
    }

    /// Derivative of a variation `column` of the state, with the tangents of the elements in `responses`.
    pub fn vary(&self, responses: &[Response], column: &[f64], out: &mut [f64]) {
        let (q, v) = column.split_at(self.coordinates);
        let (rates, accelerations) = out.split_at_mut(self.coordinates);
        rates.copy_from_slice(v);
        for (row, value) in self
            .linear
            .chunks_exact(column.len())
            .zip(accelerations.iter_mut())
        {
            *value = dot(row, column);
        }
        for (local, response) in self.elements.iter().zip(responses) {
            let force = response.by_displacement * local.port.project(q)
                + response.by_velocity * local.port.project(v);
            for (value, b) in accelerations.iter_mut().zip(&local.acceleration) {
                *value -= b * force;
            }
        }
    }
}
