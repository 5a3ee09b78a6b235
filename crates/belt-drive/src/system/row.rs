//! A linear function of the motion of all coordinates, accelerations included, and the measure that it becomes.

use super::reduction::Reduction;
use slackside_linalg::{Complex, LinalgError, Lu, Matrix, dot};
use slackside_mechanics::{Element, Forcing, Output, System};

/// `constant + Σ a_i q_i + Σ b_i q'_i + Σ c_i q''_i + Σ g_j f_j` over the coordinates of the linear model.
#[derive(Debug, Clone, Default)]
pub(super) struct Row {
    pub constant: f64,
    pub displacement: Vec<(usize, f64)>,
    pub velocity: Vec<(usize, f64)>,
    pub acceleration: Vec<(usize, f64)>,
    pub force: Vec<(usize, f64)>,
}

impl Row {
    pub fn displacement(index: usize, factor: f64) -> Self {
        Self {
            displacement: vec![(index, factor)],
            ..Self::default()
        }
    }

    pub fn velocity(index: usize, factor: f64) -> Self {
        Self {
            velocity: vec![(index, factor)],
            ..Self::default()
        }
    }

    /// Adds `factor` times another row.
    pub fn add(&mut self, factor: f64, other: &Self) {
        let scaled = |terms: &[(usize, f64)]| -> Vec<(usize, f64)> {
            terms
                .iter()
                .map(|(index, value)| (*index, factor * value))
                .collect()
        };
        self.constant += factor * other.constant;
        self.displacement.extend(scaled(&other.displacement));
        self.velocity.extend(scaled(&other.velocity));
        self.acceleration.extend(scaled(&other.acceleration));
        self.force.extend(scaled(&other.force));
    }
}

/// Turns rows into measures of the free coordinates. Accelerations follow from the equations of motion, so that they too
/// are linear in state, forces and load.
pub(super) struct RowReader<'a> {
    reduction: &'a Reduction,
    forcing: &'a Forcing,
    elements: &'a [Element],
    /// Transposes of stiffness and velocity matrix.
    transposed: [Matrix; 2],
    mass: Lu,
}

impl<'a> RowReader<'a> {
    pub fn new(reduction: &'a Reduction, system: &'a System) -> Result<Self, LinalgError> {
        Ok(Self {
            reduction,
            forcing: &system.forcing,
            elements: &system.elements,
            transposed: [reduction.stiffness.transpose(), reduction.damping.transpose()],
            mass: Lu::new(&reduction.mass)?,
        })
    }

    /// The measure of a row under an excitation of this fundamental frequency, rad/s.
    pub fn output(&self, name: String, row: &Row, frequency: f64) -> Output {
        let mut constant = row.constant;
        let mut displacement = self.reduced(&row.displacement);
        let mut velocity = self.reduced(&row.velocity);
        let mut force = vec![0.0; self.elements.len()];
        for (index, factor) in &row.force {
            force[*index] += factor;
        }
        let mut harmonics: Vec<(usize, Complex)> = Vec::new();
        for (order, motion) in &self.reduction.prescribed {
            let omega = *order as f64 * frequency;
            let value = along(&row.displacement, motion)
                + Complex::new(0.0, omega) * along(&row.velocity, motion)
                - omega * omega * along(&row.acceleration, motion);
            add(&mut harmonics, *order, value);
        }
        if !row.acceleration.is_empty() {
            // w = M⁻¹ Tᵀc: c·q'' = w·(F − C q' − K q − Σ b f).
            let weights = self.mass.solve(&self.reduced(&row.acceleration));
            let [stiffness, damping] = &self.transposed;
            subtract(&mut displacement, &stiffness.times(&weights));
            subtract(&mut velocity, &damping.times(&weights));
            for (value, element) in force.iter_mut().zip(self.elements) {
                *value -= element.port.project(&weights);
            }
            constant += dot(&self.forcing.constant, &weights);
            for (order, load) in &self.reduction.forces {
                let value = load.iter().zip(&weights).map(|(load, w)| load * *w).sum();
                add(&mut harmonics, *order, value);
            }
        }
        Output {
            name,
            constant,
            displacement: sparse(&displacement),
            velocity: sparse(&velocity),
            force: sparse(&force),
            harmonics: harmonics
                .into_iter()
                .filter(|(_, value)| *value != Complex::ZERO)
                .map(|(order, value)| (order, value.re, -value.im))
                .collect(),
        }
    }

    /// `Tᵀ` times a row.
    fn reduced(&self, terms: &[(usize, f64)]) -> Vec<f64> {
        let mut result = vec![0.0; self.reduction.order()];
        for (index, factor) in terms {
            for (value, entry) in result.iter_mut().zip(self.reduction.transform.row(*index)) {
                *value += factor * entry;
            }
        }
        result
    }
}

fn along(terms: &[(usize, f64)], motion: &[Complex]) -> Complex {
    terms.iter().map(|(index, factor)| motion[*index] * *factor).sum()
}

fn add(harmonics: &mut Vec<(usize, Complex)>, order: usize, value: Complex) {
    match harmonics.iter_mut().find(|(known, _)| *known == order) {
        Some((_, sum)) => *sum += value,
        None => harmonics.push((order, value)),
    }
}

fn subtract(target: &mut [f64], other: &[f64]) {
    for (value, term) in target.iter_mut().zip(other) {
        *value -= term;
    }
}

fn sparse(values: &[f64]) -> Vec<(usize, f64)> {
    values
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, value)| *value != 0.0)
        .collect()
}
