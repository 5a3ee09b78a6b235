//! The dimensionless form of a drive's linear model (theory 04 §3.9).

use crate::drive::{Drive, Guide, Mount};
use crate::model::{Coordinate, LinearModel};
use crate::steady::SteadyState;
use slackside_linalg::Matrix;

/// Scales and dimensionless groups: lengths by a reference span, forces by a reference tension, time by
/// `t* = ℓ √(m/P_0)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimensionless {
    /// Reference length `ℓ`, m.
    pub length: f64,
    /// Reference force `P_0`, N.
    pub force: f64,
    /// Reference time `t*`, s.
    pub time: f64,
    /// Belt speed `s = c √(m/P_0)`.
    pub speed: f64,
    /// Bending `ε = √(EI/(P_0 ℓ²))`.
    pub bending: f64,
    /// Axial stiffness `γ = EA/P_0`.
    pub stretch: f64,
    /// `J_j/(m ℓ r_j²)` of every pulley.
    pub pulley_inertia: Vec<f64>,
    /// `J_t/(m ℓ r_t²)` of every tensioner, with `r_t` its arm length; `M/(mℓ)` of a slide.
    pub arm_inertia: Vec<f64>,
    /// `k_t ℓ/(P_0 r_t²)` of every tensioner; `k ℓ/P_0` of a slide.
    pub arm_spring: Vec<f64>,
    /// `M_l/(P_0 r_j)` of every pulley.
    pub load: Vec<f64>,
    /// `S` of `q = S q̂`, one entry for each coordinate.
    scale: Vec<f64>,
    mass_per_length: f64,
}

impl Dimensionless {
    /// The form with one span's length and one tension (N) as references.
    pub fn new(drive: &Drive, steady: &SteadyState, model: &LinearModel, span: usize, force: f64) -> Self {
        let length = steady.layout.spans[span].length;
        let mass_per_length = drive.belt.mass_per_length;
        let per_force = (mass_per_length / force).sqrt();
        let arm_lengths: Vec<f64> = (0..drive.tensioners.len())
            .map(|arm| arm_length(drive, arm))
            .collect();
        let of_pulleys = |value: &dyn Fn(usize) -> f64| (0..drive.pulleys.len()).map(value).collect();
        let of_arms = |value: &dyn Fn(usize) -> f64| (0..arm_lengths.len()).map(value).collect();
        let radius = |j: usize| drive.pulleys[j].radius;
        let scale = |coordinate| match coordinate {
            Coordinate::Pulley(j) | Coordinate::Accessory(j) => length / radius(j),
            Coordinate::Arm(arm) => length / arm_lengths[arm],
            Coordinate::Sine { .. } => length,
        };
        Self {
            length,
            force,
            time: length * per_force,
            speed: steady.belt_speed * per_force,
            bending: (drive.belt.acting_bending_stiffness() / force).sqrt() / length,
            stretch: drive.belt.axial_stiffness / force,
            pulley_inertia: of_pulleys(&|j| {
                model.lumped_inertia[model.coordinates.pulley(j)]
                    / (mass_per_length * length * radius(j).powi(2))
            }),
            arm_inertia: of_arms(&|arm| {
                model.lumped_inertia[model.coordinates.arm(arm)]
                    / (mass_per_length * length * arm_lengths[arm].powi(2))
            }),
            arm_spring: of_arms(&|arm| {
                drive.tensioners[arm].spring_rate * length / (force * arm_lengths[arm].powi(2))
            }),
            load: of_pulleys(&|j| steady.loads[j] / (force * radius(j))),
            scale: model.coordinates.iter().map(scale).collect(),
            mass_per_length,
        }
    }

    /// `M̂ = SᵀMS/(mℓ³)`.
    pub fn mass(&self, mass: &Matrix) -> Matrix {
        self.scaled(mass, self.mass_per_length * self.length.powi(3))
    }

    /// `Ĝ = SᵀGS/(ℓ² √(m P_0))`, of a gyroscopic or damping matrix.
    pub fn damping(&self, damping: &Matrix) -> Matrix {
        let unit = self.length.powi(2) * (self.mass_per_length * self.force).sqrt();
        self.scaled(damping, unit)
    }

    /// `K̂ = SᵀKS/(P_0 ℓ)`.
    pub fn stiffness(&self, stiffness: &Matrix) -> Matrix {
        self.scaled(stiffness, self.force * self.length)
    }

    /// `Ω = ω t*`.
    pub fn frequency(&self, frequency: f64) -> f64 {
        frequency * self.time
    }

    fn scaled(&self, matrix: &Matrix, unit: f64) -> Matrix {
        let mut scaled = matrix.clone();
        for i in 0..matrix.rows() {
            for j in 0..matrix.columns() {
                scaled[(i, j)] *= self.scale[i] * self.scale[j] / unit;
            }
        }
        scaled
    }
}

/// Distance of the first pulley that it carries from the pivot; 1 for a slide, whose coordinate is a length already.
fn arm_length(drive: &Drive, arm: usize) -> f64 {
    let carried = drive.carried_by(arm).next();
    match (
        drive.tensioners[arm].guide,
        carried.map(|j| drive.pulleys[j].mount),
    ) {
        (Guide::Rotary { .. }, Some(Mount::Carried { place, .. })) => place.length(),
        _ => 1.0,
    }
}
