//! Rest under the constant load, and the linear response of a system whose elements keep their regimes.

use crate::StudyError;
use slackside_linalg::{Complex, Lu, Matrix};
use slackside_mechanics::{System, modes};

/// Newton iterations on a piecewise-linear residual, which end once the regimes are right.
const MOST_ITERATIONS: usize = 100;

/// Coordinates at rest under the constant load: `K q + Σ b f(bᵀq, 0) = F₀`. Damped Newton iterations from the rest of
/// the system with all elements linear, which for a preloaded clutch is the answer already.
///
/// # Errors
/// [`StudyError::NoAnswer`] if there is no such state (a mean load that nothing carries).
pub fn static_equilibrium(system: &System, frequency: f64) -> Result<Vec<f64>, StudyError> {
    let n = system.order();
    let stiffness = system.stiffness_at(frequency);
    let load = &system.forcing.constant;
    let mut engaged = stiffness.clone();
    for element in &system.elements {
        add_port(&mut engaged, element.port.terms(), element.law.linearized().0);
    }
    let scale = load.iter().fold(0.0_f64, |a, f| a.max(f.abs()));
    let mut q = match Lu::new(&engaged) {
        Ok(lu) => lu.solve(load),
        Err(_) => vec![0.0; n],
    };
    if q.iter().any(|value| !value.is_finite()) {
        q.fill(0.0);
    }
    let mut residual = residual_at(system, &stiffness, &q);
    let mut stride = 1.0;
    for _ in 0..MOST_ITERATIONS {
        let size = slackside_linalg::norm(&residual);
        let forces = stiffness
            .times(&q)
            .iter()
            .fold(scale, |a, force| a.max(force.abs()));
        if size <= 1e-12 * forces || size == 0.0 {
            return Ok(q);
        }
        let mut tangent = stiffness.clone();
        for element in &system.elements {
            let response = element.law.response(element.port.project(&q), 0.0);
            add_port(&mut tangent, element.port.terms(), response.by_displacement);
        }
        let Ok(lu) = Lu::new(&tangent) else {
            // In a gap nothing carries the load: the tangent of engaged elements tells the way out, in growing strides.
            let Ok(lu) = Lu::new(&engaged) else { break };
            let step = lu.solve(&residual);
            q.iter_mut().zip(&step).for_each(|(q, s)| *q -= stride * s);
            stride *= 2.0;
            residual = residual_at(system, &stiffness, &q);
            if q.iter().all(|value| value.abs() < 1e100) {
                continue;
            }
            break;
        };
        let step = lu.solve(&residual);
        let mut share = 1.0;
        loop {
            let trial: Vec<f64> = q.iter().zip(&step).map(|(q, s)| q - share * s).collect();
            let found = residual_at(system, &stiffness, &trial);
            if slackside_linalg::norm(&found) < size || share < 1e-3 {
                (q, residual) = (trial, found);
                break;
            }
            share *= 0.5;
        }
        if q.iter().any(|value| !value.is_finite()) {
            break;
        }
    }
    Err(StudyError::NoAnswer(
        "no static equilibrium was found: some part of the constant load is carried by nothing".to_owned(),
    ))
}

/// Shortest natural periods that one period of the load may last: more would keep a user waiting for a typing error.
const LONGEST_PERIOD: f64 = 1e5;

/// Refuses loads so slow that a single period would take minutes to compute; `option` is where the frequency comes from.
///
/// # Errors
/// [`StudyError::Question`], or [`StudyError::Linalg`] if there are no modes.
pub fn check_period(system: &System, frequency: f64, option: &str) -> Result<(), StudyError> {
    let highest = modes(system, frequency, true)?
        .iter()
        .fold(0.0_f64, |highest, mode| highest.max(mode.frequency));
    if highest > LONGEST_PERIOD * frequency {
        return Err(StudyError::question(
            option,
            format!(
                "a period of the load at the angular frequency {frequency:e} lasts more than {LONGEST_PERIOD:e} of the \
                 shortest natural periods; give a higher frequency"
            ),
        ));
    }
    Ok(())
}

fn residual_at(system: &System, stiffness: &Matrix, q: &[f64]) -> Vec<f64> {
    let mut residual = stiffness.times(q);
    for (value, load) in residual.iter_mut().zip(&system.forcing.constant) {
        *value -= load;
    }
    for element in &system.elements {
        let force = element.law.response(element.port.project(q), 0.0).force;
        for &(i, factor) in element.port.terms() {
            residual[i] += factor * force;
        }
    }
    residual
}

fn add_port(matrix: &mut Matrix, port: &[(usize, f64)], value: f64) {
    for &(i, a) in port {
        for &(j, b) in port {
            matrix[(i, j)] += a * b * value;
        }
    }
}

/// The periodic motion of a system whose elements keep the regimes they have at rest (theory 02 §1.9).
#[derive(Debug, Clone, PartialEq)]
pub struct LinearResponse {
    /// Frequency of the load, radians per unit of time.
    pub frequency: f64,
    /// Coordinates at rest.
    pub rest: Vec<f64>,
    /// Order and complex amplitudes of the coordinates: `q = rest + Re Σ Q_k e^{ikΩt}`.
    pub harmonics: Vec<(usize, Vec<Complex>)>,
}

impl LinearResponse {
    /// The state `(q, q')` at phase zero.
    pub fn start(&self) -> Vec<f64> {
        let n = self.rest.len();
        let mut state = self.rest.clone();
        state.resize(2 * n, 0.0);
        for (order, amplitudes) in &self.harmonics {
            let rate = Complex::new(0.0, *order as f64 * self.frequency);
            for (i, amplitude) in amplitudes.iter().enumerate() {
                state[i] += amplitude.re;
                state[n + i] += (rate * amplitude).re;
            }
        }
        state
    }
}

/// The linear response about a state of rest.
///
/// # Errors
/// [`StudyError::Linalg`] at a resonance without damping.
pub fn linear_response(system: &System, frequency: f64, rest: &[f64]) -> Result<LinearResponse, StudyError> {
    let mut harmonics = Vec::with_capacity(system.forcing.harmonics.len());
    for harmonic in &system.forcing.harmonics {
        let omega = harmonic.order as f64 * frequency;
        let mut dynamic = system.dynamic_stiffness(omega, frequency);
        for element in &system.elements {
            let tangent = element.law.response(element.port.project(rest), 0.0);
            let value = Complex::new(tangent.by_displacement, omega * tangent.by_velocity);
            for &(i, a) in element.port.terms() {
                for &(j, b) in element.port.terms() {
                    dynamic[(i, j)] += value * (a * b);
                }
            }
        }
        let load: Vec<Complex> = harmonic
            .cosine
            .iter()
            .zip(&harmonic.sine)
            .map(|(cosine, sine)| Complex::new(*cosine, -sine))
            .collect();
        harmonics.push((harmonic.order, dynamic.lu()?.solve(&load)));
    }
    Ok(LinearResponse {
        frequency,
        rest: rest.to_vec(),
        harmonics,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use slackside_mechanics::{Element, Forcing, Harmonic, Port, laws};

    fn oscillator(law: laws::PiecewiseLinear, load: f64) -> System {
        System {
            coordinates: vec!["x".into()],
            mass: Matrix::diagonal(&[1.0]),
            damping: Matrix::diagonal(&[0.1]),
            stiffness: Matrix::zeros(1, 1),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing: Forcing {
                constant: vec![load],
                harmonics: vec![Harmonic {
                    order: 1,
                    cosine: vec![0.0],
                    sine: vec![1.0],
                }],
            },
            elements: vec![Element::new("spring", Port::new([(0, 1.0)]), law)],
            outputs: vec![],
        }
    }

    #[test]
    fn rest_lies_in_the_piece_that_carries_the_load() {
        let system = oscillator(laws::wrap_spring(4.0), 2.0);
        let rest = static_equilibrium(&system, 1.0).unwrap();
        assert!((rest[0] - 0.5).abs() < 1e-14);
        // A one-sided spring cannot carry a load that pulls the other way.
        let slack = oscillator(laws::wrap_spring(4.0), -2.0);
        assert!(matches!(
            static_equilibrium(&slack, 1.0),
            Err(StudyError::NoAnswer(_))
        ));
    }

    #[test]
    fn rest_is_found_beyond_a_gap() {
        let system = oscillator(laws::backlash(1.0, 50.0), -0.1);
        let rest = static_equilibrium(&system, 1.0).unwrap();
        assert!((rest[0] + 50.1).abs() < 1e-12, "{rest:?}");
    }

    #[test]
    fn linear_response_solves_the_equation_of_motion() {
        let system = oscillator(laws::wrap_spring(4.0), 2.0);
        let response = linear_response(&system, 1.5, &[0.5]).unwrap();
        let amplitude = response.harmonics[0].1[0];
        // sin Ωt = Re(−i e^{iΩt}).
        let expected = Complex::new(0.0, -1.0) / Complex::new(4.0 - 2.25, 0.15);
        assert!((amplitude - expected).norm() < 1e-14);
        let start = response.start();
        assert!((start[0] - 0.5 - expected.re).abs() < 1e-14);
        assert!((start[1] - (Complex::new(0.0, 1.5) * expected).re).abs() < 1e-14);
    }
}
