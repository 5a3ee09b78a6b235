//! Newton's iteration for the steady state (theory 04 §2.4).

use super::balance::{Balance, Running};
use crate::drive::Guide;
use slackside_linalg::Lu;

/// Largest step of a rotary arm, rad; of a slide as a share of the shortest span.
const LARGEST_STEP: f64 = 0.3;
const MOST_ITERATIONS: usize = 60;
/// Strain below which the tension of a belt is lost in the rounding of its length.
const SMALL_STRAIN: f64 = 1e-5;

/// Reference tension (effective, behind the driver) and arm positions.
#[derive(Debug, Clone)]
pub(super) struct Unknowns {
    pub reference_tension: f64,
    pub positions: Vec<f64>,
}

/// Solves from a start; `None` if the iteration does not converge.
pub(super) fn newton(running: &Running<'_>, start: Unknowns) -> Option<Unknowns> {
    let drive = running.drive;
    let free: Vec<usize> = (0..drive.tensioners.len())
        .filter(|arm| !drive.tensioners[*arm].locked)
        .collect();
    let mut at = start;
    at.reference_tension = at.reference_tension.max(running.least_reference_tension());
    let mut balance = running.balance(at.reference_tension, &at.positions).ok()?;
    let mut last_size = f64::INFINITY;
    for _ in 0..MOST_ITERATIONS {
        let mut step = vec![running.installed.natural_length - balance.natural_length];
        step.extend(free.iter().map(|arm| -balance.arm_residuals[*arm]));
        Lu::new(&running.jacobian(&balance, &free))
            .ok()?
            .solve_in_place(&mut step);
        let size = relative_size(running, &balance, &step, &free);
        if !size.is_finite() {
            return None;
        }
        let mut factor = running.largest_factor(&at, &balance, &step, &free);
        let next = loop {
            let mut trial = at.clone();
            trial.reference_tension += factor * step[0];
            for (index, &arm) in free.iter().enumerate() {
                trial.positions[arm] += factor * step[1 + index];
            }
            match running.balance(trial.reference_tension, &trial.positions) {
                Ok(found) => break (trial, found),
                Err(_) if factor > 1e-3 => factor *= 0.5,
                Err(_) => return None,
            }
        };
        (at, balance) = next;
        // Quadratic convergence ends in rounding: stop where steps no longer shrink.
        if size < 1e-15 || (size < 1e-10 && size >= 0.5 * last_size) {
            return Some(at);
        }
        last_size = size;
    }
    None
}

/// Size of a step against the unknowns' own. An effective tension may be close to zero; its rounding is that of the total
/// tension and of the belt length times `EA`, so it is measured against these.
fn relative_size(running: &Running<'_>, balance: &Balance, step: &[f64], free: &[usize]) -> f64 {
    let largest = balance
        .tensions
        .iter()
        .fold(0.0_f64, |a, tension| a.max(tension.abs()));
    let tension = step[0].abs() / (largest + SMALL_STRAIN * running.drive.belt.axial_stiffness);
    free.iter()
        .enumerate()
        .map(|(index, &arm)| step[1 + index].abs() / running.scale(balance, arm))
        .fold(tension, f64::max)
}

impl Running<'_> {
    /// The tension behind the driver at which the slackest span of a beam would still be taut.
    fn least_reference_tension(&self) -> f64 {
        if self.drive.belt.acting_bending_stiffness() == 0.0 {
            return f64::NEG_INFINITY;
        }
        let slackest = self
            .effective_tensions(0.0)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        1.0 - slackest
    }

    /// Size against which a step of an arm is measured: 1 rad, or the shortest span.
    fn scale(&self, balance: &Balance, arm: usize) -> f64 {
        match self.drive.tensioners[arm].guide {
            Guide::Rotary { .. } => 1.0,
            Guide::Linear { .. } => balance
                .layout
                .spans
                .iter()
                .map(|span| span.length)
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// Largest share of a step that keeps beams taut and arms near.
    fn largest_factor(&self, at: &Unknowns, balance: &Balance, step: &[f64], free: &[usize]) -> f64 {
        let mut factor: f64 = 1.0;
        for (index, &arm) in free.iter().enumerate() {
            let limit = LARGEST_STEP * self.scale(balance, arm);
            factor = factor.min(limit / step[1 + index].abs().max(f64::MIN_POSITIVE));
        }
        if self.drive.belt.acting_bending_stiffness() > 0.0 {
            let slackest = self
                .effective_tensions(at.reference_tension)
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            if step[0] < 0.0 {
                factor = factor.min(0.9 * slackest / -step[0]);
            }
        }
        factor
    }
}
