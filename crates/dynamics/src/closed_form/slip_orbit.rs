//! The orbit of pure slip of a gyroscopic system with dry friction at one port: Den Hartog's solution for any number of
//! coordinates (theory 05 (5.4)).

use super::ClosedFormError;
use super::optimum_torque::single_order;
use crate::receptance::{LinearSystem, project};
use slackside_linalg::{Complex, Lu, Matrix, eigenvalues, exponential};
use slackside_mechanics::OperatingPoint;
use slackside_numerics::polynomial::{Coefficients, TERMS, first_crossing};
use std::f64::consts::PI;

/// Product of spectral radius and step of the certificate of negative velocity.
const REACH: f64 = 1.6;

/// The antisymmetric orbit on which the port reverses once per half period and never stops.
#[derive(Debug, Clone, PartialEq)]
pub struct SlipOrbit {
    /// The port's largest displacement, measured from its mean.
    pub extreme: f64,
    /// Energy dissipated by the friction per period, `4 Q θ_max`.
    pub dissipation: f64,
    /// Whether the port really moves backward through the whole half period after its maximum; if not, it stops somewhere and
    /// the orbit does not exist as computed.
    pub without_stops: bool,
    /// Time of the port's maximum within the period of the load.
    pub maximum_at: f64,
    /// Coordinates, then their rates, at that time.
    pub state: Vec<f64>,
    /// The largest torque for which the phase condition has a solution, `W |u| Q / |d_v|`; infinite if friction does not turn
    /// the phase.
    pub limit: f64,
}

/// The orbit of pure slip for a kinetic and static friction torque `torque` at the element with this index, under a load of
/// one harmonic. A constant load shifts the mean.
///
/// With `d = (1 − 2 (1 + e^{AT/2})⁻¹) [K⁻¹b; 0]` and the linear amplitudes `X`, the state at the maximum is
/// `Re([X; iωX] e^{iφ}) + Q d`, where `φ` makes the port's velocity vanish.
///
/// # Errors
/// [`ClosedFormError::SeveralHarmonics`], [`ClosedFormError::NoHarmonic`], [`ClosedFormError::NoStaticStiffness`] if `K` is
/// singular, [`ClosedFormError::NoSlipOrbit`], and errors of the linear part.
pub fn slip_orbit(point: &OperatingPoint, element: usize, torque: f64) -> Result<SlipOrbit, ClosedFormError> {
    let open = LinearSystem::new(&point.system, &[element])?;
    let order = single_order(&open)?;
    let n = open.order();
    let omega = order as f64 * point.frequency;
    let half_period = PI / omega;
    if open.held_coordinates(point.frequency).len() < n {
        return Err(ClosedFormError::NoStaticStiffness);
    }
    let port = open.port(0);
    let stiffness =
        Lu::new(&open.stiffness_at(point.frequency)).map_err(|_| ClosedFormError::NoStaticStiffness)?;
    let mut held = stiffness.solve(port);
    held.resize(2 * n, 0.0);

    // With positions times a typical frequency the matrix has entries of one size, and its exponential keeps its digits.
    let (mut matrix, _) = open.state_matrix(point.frequency)?;
    let unit = (0..n)
        .map(|i| (n..2 * n).map(|j| matrix[(j, i)].abs()).fold(0.0, f64::max))
        .fold(omega * omega, f64::max)
        .sqrt();
    for i in 0..n {
        for j in 0..2 * n {
            matrix[(i, j)] *= unit;
            matrix[(j, i)] /= unit;
        }
        held[i] *= unit;
    }
    let mut sum = exponential(&matrix.scaled(half_period))?;
    for i in 0..2 * n {
        sum[(i, i)] += 1.0;
    }
    let mut shift = Lu::new(&sum)?.solve(&held);
    for (d, x) in shift.iter_mut().zip(&held) {
        *d = x - 2.0 * *d;
    }
    let along = |state: &[f64]| -> f64 { port.iter().zip(state).map(|(b, x)| b * x).sum() };
    let (shift_u, shift_v) = (along(&shift[..n]) / unit, along(&shift[n..]));

    let responses = open.responses(order, omega, point.frequency)?;
    let amplitude = project(port, &responses, 0);
    let turn = torque * shift_v / (omega * amplitude.norm());
    let limit = omega * amplitude.norm() / shift_v.abs();
    if turn.is_nan() || turn.abs() > 1.0 {
        return Err(ClosedFormError::NoSlipOrbit { torque, limit });
    }
    let phase = turn.asin() - amplitude.arg();
    let rotation = Complex::cis(phase);
    let mean = stiffness.solve(&open.constant);
    let mut state = vec![0.0; 2 * n];
    for i in 0..n {
        let x = responses[(i, 0)] * rotation;
        state[i] = x.re + torque * shift[i] / unit + mean[i];
        state[n + i] = -omega * x.im + torque * shift[n + i];
    }
    let extreme = amplitude.norm() * (1.0 - turn * turn).sqrt() + torque * shift_u;
    // On the way down the motion is the forced one, plus Q K⁻¹ b, plus a free motion that starts from Q (d − [K⁻¹b; 0]).
    let free: Vec<f64> = (shift.iter().zip(&held)).map(|(d, x)| torque * (d - x)).collect();
    let velocity = Velocity {
        matrix: &matrix,
        row: port,
        forced: Complex::new(0.0, omega) * amplitude * rotation,
        omega,
    };
    Ok(SlipOrbit {
        extreme,
        dissipation: 4.0 * torque * extreme,
        without_stops: velocity.is_negative(free, half_period)?,
        maximum_at: phase.rem_euclid(2.0 * PI) / omega,
        state,
        limit,
    })
}

/// The port's velocity `Re(V e^{iωt}) + bᵀ v(t)` with `v` the rates of a free motion.
struct Velocity<'a> {
    matrix: &'a Matrix,
    row: &'a [f64],
    forced: Complex,
    omega: f64,
}

impl Velocity<'_> {
    /// Whether the velocity, zero at both ends, is negative in between: certified step by step by the Bernstein form of its
    /// Taylor polynomial (theory 05 §3.2).
    fn is_negative(&self, mut state: Vec<f64>, duration: f64) -> Result<bool, ClosedFormError> {
        let radius = eigenvalues(self.matrix)?
            .iter()
            .fold(self.omega, |a, pole| a.max(pole.norm()));
        let steps = ((duration * radius / REACH).ceil() as usize).max(2);
        let step = duration / steps as f64;
        for i in 0..steps {
            let negative = self.polynomial(&mut state, i as f64 * step, step).map(|a| -a);
            let (polynomial, known) = if i == 0 {
                (negative, 1)
            } else if i + 1 == steps {
                (reversed(&negative), 1)
            } else {
                (negative, 0)
            };
            if polynomial[known] <= 0.0 || first_crossing(&polynomial, known).is_some() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Taylor coefficients of one step in `s = (t − start)/step`; `state` moves on to its end.
    fn polynomial(&self, state: &mut Vec<f64>, start: f64, step: f64) -> Coefficients {
        let n = self.row.len();
        let rate = Complex::new(0.0, self.omega * step);
        let mut forced = self.forced * Complex::cis(self.omega * start);
        let mut term = state.clone();
        let mut end = state.clone();
        let mut result = [0.0; TERMS];
        for (k, coefficient) in result.iter_mut().enumerate() {
            if k > 0 {
                let factor = step / k as f64;
                forced *= rate / k as f64;
                term = self.matrix.times(&term);
                term.iter_mut().for_each(|x| *x *= factor);
                end.iter_mut().zip(&term).for_each(|(sum, x)| *sum += x);
            }
            let free: f64 = self.row.iter().zip(&term[n..]).map(|(b, v)| b * v).sum();
            *coefficient = forced.re + free;
        }
        *state = end;
        result
    }
}

/// Coefficients of `p(1 − s)`, by repeated Horner steps.
fn reversed(c: &Coefficients) -> Coefficients {
    let mut result = *c;
    for start in 0..TERMS - 1 {
        for k in (start..TERMS - 1).rev() {
            result[k] += result[k + 1];
        }
    }
    for k in (1..TERMS).step_by(2) {
        result[k] = -result[k];
    }
    result
}
