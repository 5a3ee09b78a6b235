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
/// ([`crate::Law::linearized`], or the constraint of [`crate::Law::locks`]) or, where `engaged` is false, removed. Ascending
/// in frequency; every constraint takes one mode away.
///
/// # Errors
/// [`LinalgError`] if the mass matrix is not positive definite or the iteration fails.
pub fn modes(system: &System, frequency: f64, engaged: bool) -> Result<Vec<Mode>, LinalgError> {
    let (damping, stiffness) = linearized(system, frequency, engaged);
    let basis = engaged.then(|| locked_basis(system)).flatten();
    let decomposition = match &basis {
        None => undamped_modes(&system.mass, &stiffness)?,
        Some(basis) => {
            let onto = |matrix: &Matrix| basis.transpose().product(&matrix.product(basis));
            undamped_modes(&onto(&system.mass), &onto(&stiffness))?
        }
    };
    let count = decomposition.squared_frequencies.len();
    let floor = 1e-12
        * decomposition
            .squared_frequencies
            .iter()
            .fold(0.0_f64, |a, v| a.max(v.abs()));
    Ok((0..count)
        .map(|j| {
            let reduced = decomposition.shapes.column(j);
            let mut shape = basis
                .as_ref()
                .map_or(reduced.clone(), |basis| basis.times(&reduced));
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

/// A basis of the motions in which every locking element holds its port, by columns; `None` if there is no such element.
fn locked_basis(system: &System) -> Option<Matrix> {
    let n = system.order();
    let mut columns: Vec<Vec<f64>> = (0..n)
        .map(|j| (0..n).map(|i| f64::from(u8::from(i == j))).collect())
        .collect();
    for element in system.elements.iter().filter(|element| element.law.locks()) {
        // The motion that moves the port most is removed from all others, which then do not move it.
        let moves: Vec<f64> = columns.iter().map(|c| element.port.project(c)).collect();
        let largest = (0..columns.len()).max_by(|&a, &b| moves[a].abs().total_cmp(&moves[b].abs()))?;
        if moves[largest] == 0.0 {
            continue;
        }
        let pivot = columns.remove(largest);
        let others = moves.iter().enumerate().filter(|(j, _)| *j != largest);
        for (column, (_, share)) in columns.iter_mut().zip(others) {
            for (value, p) in column.iter_mut().zip(&pivot) {
                *value -= share / moves[largest] * p;
            }
        }
    }
    (columns.len() < n).then(|| {
        let mut basis = Matrix::zeros(n, columns.len());
        for (j, column) in columns.iter().enumerate() {
            for (i, value) in column.iter().enumerate() {
                basis[(i, j)] = *value;
            }
        }
        basis
    })
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
    use crate::{
        Element, Forcing, Port,
        laws::{one_way, wrap_spring},
    };

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

    #[test]
    fn a_locked_clutch_makes_pulley_and_accessory_one() {
        let mut system = System {
            coordinates: vec!["pulley".into(), "accessory".into()],
            mass: Matrix::diagonal(&[1.0, 1.6]),
            damping: Matrix::zeros(2, 2),
            stiffness: Matrix::diagonal(&[2.6, 0.0]),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing: Forcing::none(2),
            elements: vec![],
            outputs: vec![],
        };
        let port = Port::new([(0, 1.0), (1, -1.0)]);
        system.elements.push(Element::new("clutch", port, one_way()));
        let locked = modes(&system, 1.0, true).unwrap();
        assert_eq!(locked.len(), 1);
        assert!((locked[0].frequency - 1.0).abs() < 1e-14);
        assert!((locked[0].shape[0] - locked[0].shape[1]).abs() < 1e-14);
    }
}
