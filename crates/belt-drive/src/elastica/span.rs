//! The elastica between two pulleys with free contact points (theory 04 §2.8).
//!
//! With the angle `α` of the tangent from the force, the belt obeys `EI α'' = H sin α`. In units of `1/λ = √(EI/H)` the force
//! and the stiffness disappear: `α'' = sin α`, `α' = 1/(σ r λ)` at both ends. Solutions grow and decay by `e^{λs}`, so the span
//! is divided into elements over which they grow by a small factor, and all are joined at once by Newton's method (multiple
//! shooting), the length of the span included.

use glam::DVec2;
use slackside_linalg::{Lu, Matrix};
use slackside_numerics::ode::{DormandPrince, Limits, Tolerance};

/// Length of an element in units of `1/λ`.
const ELEMENT: f64 = 3.0;

/// Relative tolerance of the integration.
const TOLERANCE: f64 = 1e-14;

/// Newton steps for one span.
const STEPS: usize = 30;

/// Step, in angles and units of `1/λ`, after which the next one is below rounding.
const CONVERGED: f64 = 1e-9;

/// State in an element: `α`, `α'`, position, natural length, and the derivatives of the first four in `α` and `α'` at its
/// start.
const STATE: usize = 13;

/// What bounds a span.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpanProblem {
    /// `EI`, N·m².
    pub bending: f64,
    /// `H`, N.
    pub force: f64,
    /// `mc²`, N.
    pub centrifugal: f64,
    /// `EA`, N.
    pub axial_stiffness: f64,
    /// `σ r` of the pulleys at its start and end, m.
    pub radii: [f64; 2],
    /// From centre to centre, m.
    pub centres: DVec2,
}

/// Angles and curvatures at the ends of the elements, in units of `1/λ`.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    length: f64,
    angles: Vec<f64>,
    curvatures: Vec<f64>,
}

/// A span in equilibrium.
#[derive(Debug, Clone)]
pub(super) struct Elastica {
    pub shape: Shape,
    /// `H`, N.
    pub force: f64,
    /// Direction of the force `χ`, rad.
    pub direction: f64,
    /// `ψ − χ` at start and end, rad.
    pub end_angles: [f64; 2],
    /// Length between the contact points, m.
    pub length: f64,
    /// Natural length, m.
    pub natural_length: f64,
}

impl SpanProblem {
    fn lambda(&self) -> f64 {
        (self.force / self.bending).sqrt()
    }

    /// Boundary layers of small rotation at both ends of a span of this length between the tangent points (m), as a start.
    pub fn first_shape(&self, tangent_length: f64) -> Shape {
        let lambda = self.lambda();
        // The belt leaves the pulleys about 1/λ before the tangent points.
        let length = lambda * tangent_length + 2.0;
        let elements = (length / ELEMENT).ceil().max(2.0) as usize;
        let [start, end] = self.radii.map(|radius| 1.0 / (radius * lambda));
        let layers = |k: usize| {
            let s = length * k as f64 / elements as f64;
            ((-s).exp() * start, (s - length).exp() * end)
        };
        let mut shape = Shape {
            length,
            angles: (0..=elements).map(|k| layers(k).1 - layers(k).0).collect(),
            curvatures: (0..=elements).map(|k| layers(k).1 + layers(k).0).collect(),
        };
        self.bind(&mut shape);
        shape
    }

    /// Sets the curvatures of the pulleys at the ends.
    fn bind(&self, shape: &mut Shape) {
        let last = shape.curvatures.len() - 1;
        shape.curvatures[0] = 1.0 / (self.radii[0] * self.lambda());
        shape.curvatures[last] = 1.0 / (self.radii[1] * self.lambda());
    }

    /// The elastica next to a shape; `None` if Newton's method does not lead to one.
    pub fn solve(&self, start: &Shape) -> Option<Elastica> {
        let lambda = self.lambda();
        if !lambda.is_finite() {
            return None;
        }
        let mut shape = start.clone();
        self.bind(&mut shape);
        let distance = self.centres.length() * lambda;
        let mut integrator = DormandPrince::new(
            Tolerance {
                relative: vec![TOLERANCE; STATE],
                floor: vec![1.0; STATE],
                block: STATE,
            },
            Limits {
                max_step: ELEMENT,
                max_steps: 1000,
            },
        );
        for _ in 0..STEPS {
            let ends = self.integrate(&mut integrator, &shape)?;
            let step = self.newton_step(&shape, &ends, distance)?;
            let size = step
                .iter()
                .fold(0.0_f64, |largest, value| largest.max(value.abs()));
            if !size.is_finite() {
                return None;
            }
            // Rotations of more than this leave the region where the equations are nearly linear.
            let factor = (0.5 / size).min(1.0);
            let elements = ends.len();
            for k in 0..=elements {
                shape.angles[k] += factor * step[angle_index(k)];
                if k > 0 && k < elements {
                    shape.curvatures[k] += factor * step[2 * k];
                }
            }
            shape.length += factor * step[2 * elements];
            if shape.length <= 0.0 {
                return None;
            }
            if size < CONVERGED {
                let ends = self.integrate(&mut integrator, &shape)?;
                return Some(self.result(shape, &ends));
            }
        }
        None
    }

    /// The states at the ends of the elements, each started from the shape.
    fn integrate(&self, integrator: &mut DormandPrince, shape: &Shape) -> Option<Vec<[f64; STATE]>> {
        let elements = shape.angles.len() - 1;
        let length = shape.length / elements as f64;
        (0..elements)
            .map(|k| {
                let mut state = [0.0; STATE];
                (state[0], state[1]) = (shape.angles[k], shape.curvatures[k]);
                (state[5], state[10]) = (1.0, 1.0);
                integrator.restart();
                integrator
                    .integrate(
                        &mut |_, y, rate| self.rates(y, rate),
                        0.0,
                        length,
                        &mut state,
                        None,
                    )
                    .ok()?;
                Some(state)
            })
            .collect()
    }

    fn rates(&self, y: &[f64], rate: &mut [f64]) {
        let (sine, cosine) = y[0].sin_cos();
        rate[0] = y[1];
        rate[1] = sine;
        rate[2] = cosine;
        rate[3] = sine;
        rate[4] = 1.0 / (1.0 + (self.centrifugal + self.force * cosine) / self.axial_stiffness);
        for first in [5, 9] {
            rate[first] = y[first + 1];
            rate[first + 1] = cosine * y[first];
            rate[first + 2] = -sine * y[first];
            rate[first + 3] = cosine * y[first];
        }
    }

    /// From centre to centre in the frame of the force, in units of `1/λ`.
    fn span_vector(&self, shape: &Shape, ends: &[[f64; STATE]]) -> DVec2 {
        let lambda = self.lambda();
        let way: DVec2 = ends.iter().map(|end| DVec2::new(end[2], end[3])).sum();
        let (first, last) = (shape.angles[0], shape.angles[ends.len()]);
        // Contact points lie at the distance −σ r along the left normal from the centres.
        way + self.radii[1] * lambda * DVec2::from_angle(last).perp()
            - self.radii[0] * lambda * DVec2::from_angle(first).perp()
    }

    /// Step of the unknowns `α_0, α_1, κ_1, …, α_M, S` towards joined elements and the right distance of the centres.
    fn newton_step(&self, shape: &Shape, ends: &[[f64; STATE]], distance: f64) -> Option<Vec<f64>> {
        let lambda = self.lambda();
        let elements = ends.len();
        let order = 2 * elements + 1;
        let closing = order - 1;
        let mut jacobian = Matrix::zeros(order, order);
        let mut residual = vec![0.0; order];
        let vector = self.span_vector(shape, ends);
        let along = vector / distance;
        residual[closing] = 0.5 * (vector.length_squared() / distance - distance);
        let per_element = 1.0 / elements as f64;
        for (k, end) in ends.iter().enumerate() {
            let mut rate = [0.0; STATE];
            self.rates(end, &mut rate);
            for part in 0..2 {
                let row = 2 * k + part;
                let next = if part == 0 {
                    shape.angles[k + 1]
                } else {
                    shape.curvatures[k + 1]
                };
                residual[row] = end[part] - next;
                jacobian[(row, angle_index(k))] += end[5 + part];
                if k > 0 {
                    jacobian[(row, 2 * k)] += end[9 + part];
                }
                if part == 0 {
                    jacobian[(row, angle_index(k + 1))] -= 1.0;
                } else if k + 1 < elements {
                    jacobian[(row, 2 * (k + 1))] -= 1.0;
                }
                jacobian[(row, closing)] += rate[part] * per_element;
            }
            let way = |first: usize| along.dot(DVec2::new(end[first], end[first + 1]));
            jacobian[(closing, angle_index(k))] += way(7);
            if k > 0 {
                jacobian[(closing, 2 * k)] += way(11);
            }
            jacobian[(closing, closing)] += along.dot(DVec2::new(rate[2], rate[3])) * per_element;
        }
        for (node, radius) in [(0, self.radii[0]), (elements, -self.radii[1])] {
            let tangent = DVec2::from_angle(shape.angles[node]);
            jacobian[(closing, angle_index(node))] += radius * lambda * along.dot(tangent);
        }
        let mut step = Lu::new(&jacobian).ok()?.solve(&residual);
        step.iter_mut().for_each(|value| *value = -*value);
        Some(step)
    }

    fn result(&self, shape: Shape, ends: &[[f64; STATE]]) -> Elastica {
        let lambda = self.lambda();
        let vector = self.span_vector(&shape, ends);
        Elastica {
            force: self.force,
            direction: self.centres.to_angle() - vector.to_angle(),
            end_angles: [shape.angles[0], shape.angles[ends.len()]],
            length: shape.length / lambda,
            natural_length: ends.iter().map(|end| end[4]).sum::<f64>() / lambda,
            shape,
        }
    }
}

/// Place of the angle at node `k` among the unknowns; the curvature at an inner node stands at `2k`.
fn angle_index(k: usize) -> usize {
    (2 * k).saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(bending: f64, force: f64) -> SpanProblem {
        SpanProblem {
            bending,
            force,
            centrifugal: 30.0,
            axial_stiffness: 170e3,
            radii: [-0.0452, 0.02697],
            centres: DVec2::new(-0.3477, -0.05715),
        }
    }

    #[test]
    fn energy_is_constant_along_the_span() {
        // ½EIκ² + H cos α is the same at both ends.
        for (bending, force) in [(0.005, 300.0), (0.05, 300.0), (0.05, 80.0)] {
            let problem = problem(bending, force);
            let found = problem.solve(&problem.first_shape(0.345)).unwrap();
            let energy =
                |end: usize| 0.5 * bending / problem.radii[end].powi(2) + force * found.end_angles[end].cos();
            assert!(
                (energy(0) / energy(1) - 1.0).abs() < 1e-13,
                "{} {}",
                energy(0),
                energy(1)
            );
        }
    }

    #[test]
    fn a_slender_span_approaches_the_common_tangent() {
        let problem = problem(1e-4, 300.0);
        let crossing = 0.0452_f64 + 0.02697;
        let tangent = (problem.centres.length_squared() - crossing * crossing).sqrt();
        let found = problem.solve(&problem.first_shape(tangent)).unwrap();
        // The contact points lie 1/λ before the tangent points on either side, to second order.
        let lambda = (300.0_f64 / 1e-4).sqrt();
        assert!((found.length - tangent - 2.0 / lambda).abs() < 3e-2 / lambda);
        let angle = problem.centres.to_angle() - (crossing / problem.centres.length()).asin();
        let difference = (found.direction - angle).sin();
        assert!(difference.abs() < 1e-4, "{difference}");
    }
}
