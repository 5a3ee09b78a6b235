//! Rest under the constant load, and the linear response of a system whose elements keep their regimes.

mod rest;

pub use rest::{rest_state, static_equilibrium};

use crate::StudyError;
use slackside_linalg::Complex;
use slackside_mechanics::{System, modes};

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
    use slackside_linalg::Matrix;
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
