//! Balances of pulleys, arms and belt length over the forces of the spans and the positions of the arms.

use super::ElasticaError;
use super::span::{Elastica, Shape, SpanProblem};
use crate::drive::{ArcStretch, Drive, Guide};
use crate::layout::{Kinematics, Layout};
use crate::steady::SteadyError;
use glam::DVec2;
use slackside_linalg::{Lu, Matrix};
use std::f64::consts::TAU;

/// Largest `λL`: the effort grows with its third power, and real spans reach a few hundred.
const LARGEST_SLENDERNESS: f64 = 600.0;

/// A wrap above this stands for a slightly negative one.
const LARGEST_WRAP: f64 = 330.0 / 360.0 * TAU;

/// Newton steps.
const STEPS: usize = 30;

/// Halvings of a step that leads out of the region where the spans exist.
const HALVINGS: usize = 12;

/// Relative step of the differences that make the Jacobian.
const DIFFERENCE: f64 = 1e-6;

/// Scaled residual that rounding allows, and the one that is good enough when rounding ends the descent.
const CONVERGED: (f64, f64) = (1e-14, 1e-11);

/// A drive at one speed.
pub(super) struct Balance<'a> {
    pub drive: &'a Drive,
    /// `mc²`, N.
    centrifugal: f64,
    /// Load torques, N·m.
    pub loads: Vec<f64>,
    /// Spring torques at the reference positions.
    pub spring_torques: Vec<f64>,
    /// Natural belt length; `None` if the arms stand at their reference positions and the length follows.
    pub natural_length: Option<f64>,
}

/// Arms and spans.
#[derive(Clone)]
pub(super) struct Place {
    pub positions: Vec<f64>,
    pub layout: Layout,
    kinematics: Kinematics,
    pub spans: Vec<Elastica>,
}

impl<'a> Balance<'a> {
    pub fn new(drive: &'a Drive, driver_speed: f64) -> Self {
        let belt_speed = drive.belt_speed(driver_speed);
        Self {
            drive,
            centrifugal: drive.belt.mass_per_length * belt_speed * belt_speed,
            loads: drive.load_torques(driver_speed),
            spring_torques: vec![0.0; drive.tensioners.len()],
            natural_length: None,
        }
    }

    /// At rest and without loads.
    pub fn at_rest(drive: &'a Drive) -> Self {
        Self {
            loads: vec![0.0; drive.pulleys.len()],
            ..Self::new(drive, 0.0)
        }
    }

    /// Natural length and spring torques that give every span this force (N) with the arms at their reference positions.
    pub fn installed(&self, force: f64) -> Result<(f64, Vec<f64>), ElasticaError> {
        let forces = vec![force; self.drive.pulleys.len()];
        let place = self.place(&forces, &self.drive.reference_positions(), None)?;
        let torques = self.arm_residuals(&place).iter().map(|torque| -torque).collect();
        Ok((self.natural_length(&place), torques))
    }

    /// Spans under given forces `H_i` (N) with the arms at given positions, sought from the shapes of another place.
    fn place(&self, forces: &[f64], positions: &[f64], near: Option<&Place>) -> Result<Place, ElasticaError> {
        let drive = self.drive;
        let layout = Layout::new(drive, positions).map_err(SteadyError::from)?;
        let spans = forces
            .iter()
            .enumerate()
            .map(|(i, force)| self.span(&layout, i, *force, near.map(|place| &place.spans[i].shape)))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Place {
            positions: positions.to_vec(),
            kinematics: Kinematics::new(drive, &layout, positions),
            layout,
            spans,
        })
    }

    fn span(
        &self,
        layout: &Layout,
        i: usize,
        force: f64,
        near: Option<&Shape>,
    ) -> Result<Elastica, ElasticaError> {
        let drive = self.drive;
        let next = drive.next(i);
        let signed_radius = |j: usize| drive.pulleys[j].sense.sign() * drive.pulleys[j].radius;
        let problem = SpanProblem {
            bending: drive.belt.bending_stiffness,
            force,
            centrifugal: self.centrifugal,
            axial_stiffness: drive.belt.axial_stiffness,
            radii: [signed_radius(i), signed_radius(next)],
            centres: layout.centres[next] - layout.centres[i],
        };
        let slenderness = (force / problem.bending).sqrt() * layout.spans[i].length;
        if slenderness > LARGEST_SLENDERNESS {
            return Err(ElasticaError::Slender {
                span: drive.span_name(i),
                slenderness,
                largest: LARGEST_SLENDERNESS,
            });
        }
        let found = if force > 0.0 {
            match near {
                Some(shape) => problem.solve(shape),
                None => problem.solve(&problem.first_shape(layout.spans[i].length)),
            }
        } else {
            None
        };
        found.ok_or_else(|| ElasticaError::Span {
            span: drive.span_name(i),
            force,
        })
    }

    /// `N = mc² + H cos(ψ − χ)` at the start (0) or the end (1) of a span.
    pub fn tension(&self, span: &Elastica, end: usize) -> f64 {
        self.centrifugal + span.force * span.end_angles[end].cos()
    }

    /// Wraps between the contact points; negative where the belt would have to be pulled onto the pulley.
    pub fn wraps(&self, place: &Place) -> Vec<f64> {
        (0..place.spans.len())
            .map(|j| {
                let (before, after) = (&place.spans[self.drive.span_before(j)], &place.spans[j]);
                let turn = after.direction + after.end_angles[0] - before.direction - before.end_angles[1];
                let wrap = (self.drive.pulleys[j].sense.sign() * turn).rem_euclid(TAU);
                if wrap > LARGEST_WRAP { wrap - TAU } else { wrap }
            })
            .collect()
    }

    /// `F_j = H_j χ_j − H_{j−1} χ_{j−1}`.
    pub fn belt_forces(&self, place: &Place) -> Vec<DVec2> {
        let pull = |i: usize| place.spans[i].force * DVec2::from_angle(place.spans[i].direction);
        (0..place.spans.len())
            .map(|j| pull(j) - pull(self.drive.span_before(j)))
            .collect()
    }

    /// Natural length of a belt that lies in this place.
    pub fn natural_length(&self, place: &Place) -> f64 {
        let stiffness = self.drive.belt.axial_stiffness;
        let arcs: f64 = self
            .wraps(place)
            .iter()
            .enumerate()
            .map(|(j, wrap)| {
                let before = self.tension(&place.spans[self.drive.span_before(j)], 1);
                let after = self.tension(&place.spans[j], 0);
                let strain = match self.drive.belt.arc_stretch {
                    ArcStretch::None => 0.0,
                    ArcStretch::Mean => 0.5 * (before + after) / stiffness,
                    ArcStretch::Entry => before / stiffness,
                };
                self.drive.pulleys[j].radius * wrap / (1.0 + strain)
            })
            .sum();
        arcs + place.spans.iter().map(|span| span.natural_length).sum::<f64>()
    }

    /// Torque on every arm along its coordinate: belt, drag and spring (theory 04 (2.9)).
    fn arm_residuals(&self, place: &Place) -> Vec<f64> {
        let forces = self.belt_forces(place);
        (0..self.drive.tensioners.len())
            .map(|arm| {
                let tensioner = &self.drive.tensioners[arm];
                let is_rotary = matches!(tensioner.guide, Guide::Rotary { .. });
                let pushed: f64 = self
                    .drive
                    .carried_by(arm)
                    .map(|j| {
                        let pulley = &self.drive.pulleys[j];
                        let drag = if is_rotary && pulley.drag_reacts_on_arm {
                            pulley.sense.sign() * self.loads[j]
                        } else {
                            0.0
                        };
                        forces[j].dot(place.kinematics.centre_rates[j][arm]) + drag
                    })
                    .sum();
                let travel = place.positions[arm] - tensioner.reference;
                pushed + self.spring_torques[arm] - tensioner.spring_rate * travel
            })
            .collect()
    }

    /// Arms that move.
    fn free_arms(&self) -> Vec<usize> {
        (0..self.drive.tensioners.len())
            .filter(|arm| !self.drive.tensioners[*arm].locked)
            .collect()
    }

    /// Open balances: torques of the driven pulleys as forces, then belt length and arms, all in units of typical terms.
    fn residuals(&self, place: &Place) -> Vec<f64> {
        let drive = self.drive;
        let force = place.spans.iter().map(|span| span.force).fold(0.0, f64::max);
        let mut residuals: Vec<f64> = (0..place.spans.len())
            .filter(|j| *j != drive.driver)
            .map(|j| {
                let rise =
                    self.tension(&place.spans[j], 0) - self.tension(&place.spans[drive.span_before(j)], 1);
                (rise - self.loads[j] / drive.pulleys[j].radius) / force
            })
            .collect();
        let arms = self.arm_residuals(place);
        let scaled_arm = |arm: usize| {
            let lever = drive
                .carried_by(arm)
                .map(|j| place.kinematics.centre_rates[j][arm].length())
                .sum::<f64>();
            arms[arm] / (force * lever)
        };
        match self.natural_length {
            Some(length) => {
                residuals.push(self.natural_length(place) / length - 1.0);
                residuals.extend(self.free_arms().into_iter().map(scaled_arm));
            }
            None => residuals.extend(self.free_arms().first().copied().map(scaled_arm)),
        }
        residuals
    }

    /// Forces and positions in which everything balances, by Newton's method from a start.
    ///
    /// With an unknown natural length the arms stay where they are, and the balance of the one free arm takes the place of
    /// the length.
    pub fn solve(&self, forces: &[f64], positions: &[f64]) -> Result<Place, ElasticaError> {
        let free = match self.natural_length {
            Some(_) => self.free_arms(),
            None => Vec::new(),
        };
        if self.natural_length.is_none() && self.free_arms().len() > 1 {
            return Err(ElasticaError::SeveralArms {
                arms: self.free_arms().len(),
            });
        }
        let mut place = self.place(forces, positions, None)?;
        let mut best = f64::INFINITY;
        for _ in 0..STEPS {
            let residuals = self.residuals(&place);
            let size = residuals
                .iter()
                .fold(0.0_f64, |largest, value| largest.max(value.abs()));
            if size <= CONVERGED.0 || (size <= CONVERGED.1 && size >= 0.5 * best) {
                return Ok(place);
            }
            best = best.min(size);
            let jacobian = self.jacobian(&place, &free, &residuals)?;
            let Ok(factors) = Lu::new(&jacobian) else { break };
            let step = factors.solve(&residuals);
            place = self.advance(&place, &free, &step)?;
        }
        Err(ElasticaError::NoConvergence { residual: best })
    }

    /// The place after a Newton step, which is halved while it leads to spans that do not exist or halves a force.
    fn advance(&self, place: &Place, free: &[usize], step: &[f64]) -> Result<Place, ElasticaError> {
        let count = place.spans.len();
        let mut factor = 1.0;
        let mut tries = 0;
        loop {
            let forces: Vec<f64> = (0..count)
                .map(|i| place.spans[i].force - factor * step[i])
                .collect();
            let mut positions = place.positions.clone();
            for (k, arm) in free.iter().enumerate() {
                positions[*arm] -= factor * step[count + k];
            }
            let is_moderate = (0..count).all(|i| forces[i] > 0.5 * place.spans[i].force);
            tries += 1;
            if is_moderate || tries == HALVINGS {
                match self.place(&forces, &positions, Some(place)) {
                    Err(error) if tries == HALVINGS => return Err(error),
                    Err(_) => {}
                    Ok(next) => return Ok(next),
                }
            }
            factor *= 0.5;
        }
    }

    /// Rates of the residuals in the forces and the free positions, by differences.
    fn jacobian(&self, place: &Place, free: &[usize], residuals: &[f64]) -> Result<Matrix, ElasticaError> {
        let count = place.spans.len();
        let order = count + free.len();
        let mut jacobian = Matrix::zeros(order, order);
        let mut set = |column: usize, moved: &Place, step: f64| {
            for (row, (after, before)) in self.residuals(moved).iter().zip(residuals).enumerate() {
                jacobian[(row, column)] = (after - before) / step;
            }
        };
        for i in 0..count {
            let step = DIFFERENCE * place.spans[i].force;
            let mut moved = place.clone();
            let force = place.spans[i].force + step;
            moved.spans[i] = self.span(&place.layout, i, force, Some(&place.spans[i].shape))?;
            set(i, &moved, step);
        }
        let forces: Vec<f64> = place.spans.iter().map(|span| span.force).collect();
        for (k, arm) in free.iter().enumerate() {
            let lever = self
                .drive
                .carried_by(*arm)
                .map(|j| place.kinematics.centre_rates[j][*arm].length())
                .sum::<f64>();
            let longest = place
                .layout
                .spans
                .iter()
                .map(|span| span.length)
                .fold(0.0, f64::max);
            let step = DIFFERENCE * longest / lever;
            let mut positions = place.positions.clone();
            positions[*arm] += step;
            set(count + k, &self.place(&forces, &positions, Some(place))?, step);
        }
        Ok(jacobian)
    }
}
