//! Linear analysis: modes with every element in its engaged, linear form.

use crate::System;
use slackside_linalg::{LinalgError, Matrix, undamped_modes};

/// One mode of the linearised system.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Undamped natural frequency `ω`, radians per unit of time; zero for a rigid-body mode.
    pub frequency: f64,
    /// Modal damping ratio `φᵀCφ / (2ω)`; zero for a rigid-body mode.
    pub damping_ratio: f64,
    /// Shape, scaled to `φᵀMφ = 1`, with its largest entry positive.
    pub shape: Vec<f64>,
}

/// Undamped modes of the system at frequency `Ω` of the load, with every element replaced by its linearisation
/// ([`crate::Law::linearized`]) or, where `engaged` is false, removed. Ascending in frequency.
///
/// # Errors
/// [`LinalgError`] if the mass matrix is not positive definite or the iteration fails.
pub fn modes(system: &System, frequency: f64, engaged: bool) -> Result<Vec<Mode>, LinalgError> {
    let (damping, stiffness) = linearized(system, frequency, engaged);
    let n = system.order();
    let decomposition = undamped_modes(&system.mass, &stiffness)?;
    let floor = 1e-12
        * decomposition
            .squared_frequencies
            .iter()
            .fold(0.0_f64, |a, v| a.max(v.abs()));
    Ok((0..n)
        .map(|j| {
            let mut shape = decomposition.shapes.column(j);
            let largest = shape
                .iter()
                .copied()
                .fold(0.0_f64, |a, v| if v.abs() > a.abs() { v } else { a });
            if largest < 0.0 {
                shape.iter_mut().for_each(|v| *v = -*v);
            }
            let square = decomposition.squared_frequencies[j];
            let omega = if square > floor { square.sqrt() } else { 0.0 };
            let dissipation = slackside_linalg::dot(&shape, &damping.times(&shape));
            let damping_ratio = if omega > 0.0 {
                dissipation / (2.0 * omega)
            } else {
                0.0
            };
            Mode {
                frequency: omega,
                damping_ratio,
                shape,
            }
        })
        .collect())
}

/// Damping and stiffness matrices with every element linearised, or removed.
fn linearized(system: &System, frequency: f64, engaged: bool) -> (Matrix, Matrix) {
    let mut damping = system.damping_at(frequency);
    let mut stiffness = system.stiffness_at(frequency);
    if engaged {
        for element in &system.elements {
            let (spring, damper) = element.law.linearized();
            for &(i, a) in element.port.terms() {
                for &(j, b) in element.port.terms() {
                    stiffness[(i, j)] += a * b * spring;
                    damping[(i, j)] += a * b * damper;
                }
            }
        }
    }
    (damping, stiffness)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Element, Forcing, Port, laws::wrap_spring};

    #[test]
    fn an_engaged_clutch_couples_and_an_open_one_frees_the_accessory() {
        let system = System {
            coordinates: vec!["pulley".into(), "accessory".into()],
            mass: Matrix::diagonal(&[1.0, 1.6]),
            damping: Matrix::zeros(2, 2),
            stiffness: Matrix::diagonal(&[2.6, 0.0]),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing: Forcing::none(2),
            elements: vec![Element::new(
                "clutch",
                Port::new([(0, 1.0), (1, -1.0)]),
                wrap_spring(24.0),
            )],
            outputs: vec![],
        };
        let engaged = modes(&system, 1.0, true).unwrap();
        // theory 02 §15
        assert!((engaged[0].frequency - 0.9796106880251735).abs() < 1e-13);
        assert!((engaged[1].frequency - 6.374979443096805).abs() < 1e-13);
        let open = modes(&system, 1.0, false).unwrap();
        assert_eq!(open[0].frequency, 0.0);
        assert!((open[1].frequency - 2.6_f64.sqrt()).abs() < 1e-14);
    }
}
