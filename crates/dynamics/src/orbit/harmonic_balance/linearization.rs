//! How the elements are split into a linear part and a remainder, and the coordinates in which the system may drift.
//!
//! Each element is a linear spring and damper `(k, c)` plus a remainder `N = f − k u − c v`. Where the stiffness with these
//! springs is still singular (an accessory behind an overrunning clutch), the motion is `q = N α t +` a periodic part, with
//! the null space `N` of the stiffness and drift rates `α`. The mean of the equations then is
//! `K q_0 + C N α + B f_0 = F_0`: with `q_0` orthogonal to `N` the single vector `x = q_0 + N α` obeys `(K + C N Nᵀ) x =
//! F_0 − B f_0`, and a port that drifts has its mean velocity `Bᵀ N α` in place of its mean displacement (theory 05 §5.3: the
//! mobility in place of the receptance).

use slackside_linalg::{Matrix, dot, orthonormalize};
use slackside_mechanics::{Port, System};

/// Pivots below this share of the largest one are zero.
const RANK: f64 = 1e-11;

/// The linear part of every element, and the drift of the system.
#[derive(Debug, Clone)]
pub struct Linearization {
    /// Spring and damper of each element.
    pub elements: Vec<(f64, f64)>,
    /// Whether each element's port drifts.
    pub drifting: Vec<bool>,
    /// The projector `N Nᵀ` onto the coordinates that drift, and their number.
    pub drift: Option<(Matrix, usize)>,
}

impl Linearization {
    /// The split of a system. Coordinates drift if the stiffness leaves them free, whatever the frequency, and every element
    /// acting there depends on the velocity alone.
    ///
    /// A drifting port whose law has no damper of its own is given one, of a size typical for the system: its remainder
    /// takes it off again, and the mean of the equations is then regular even without other damping.
    pub fn of(system: &System) -> Self {
        let mut elements: Vec<(f64, f64)> = system.elements.iter().map(|e| e.law.linearized()).collect();
        let mut drifting = vec![false; elements.len()];
        let Some(basis) = free_motions(system, &elements) else {
            return Self {
                elements,
                drifting,
                drift: None,
            };
        };
        for (drifts, element) in drifting.iter_mut().zip(&system.elements) {
            *drifts = (0..basis.columns()).any(|j| moves(&element.port, &basis, j));
        }
        let held = drifting
            .iter()
            .zip(&system.elements)
            .any(|(&drifts, element)| drifts && element.law.depends_on_displacement());
        if held {
            drifting.fill(false);
            return Self {
                elements,
                drifting,
                drift: None,
            };
        }
        let n = system.order();
        let rate = (0..n)
            .map(|i| (system.stiffness[(i, i)] / system.mass[(i, i)]).abs())
            .fold(0.0, f64::max)
            .sqrt()
            .max(1.0);
        for ((linear, &drifts), element) in elements.iter_mut().zip(&drifting).zip(&system.elements) {
            if drifts && linear.1 == 0.0 {
                let port = element.port.dense(n);
                linear.1 = rate * dot(&system.mass.times(&port), &port) / dot(&port, &port);
            }
        }
        let projector = basis.product(&basis.transpose());
        Self {
            elements,
            drifting,
            drift: Some((projector, basis.columns())),
        }
    }
}

fn moves(port: &Port, basis: &Matrix, column: usize) -> bool {
    let terms = port.terms().iter();
    let (sum, size) = terms.fold((0.0, 0.0), |(sum, size): (f64, f64), &(i, factor)| {
        let term = factor * basis[(i, column)];
        (sum + term, size.max(factor.abs()))
    });
    sum.abs() > 1e-9 * size
}

/// An orthonormal basis of the motions that meet no stiffness, neither of the system nor of the elements' springs, at any
/// frequency; `None` if there are none. Gaussian elimination with full pivoting of both stiffness matrices, scaled by the
/// masses.
fn free_motions(system: &System, elements: &[(f64, f64)]) -> Option<Matrix> {
    let n = system.order();
    let scale: Vec<f64> = (0..n).map(|i| system.mass[(i, i)].sqrt()).collect();
    let mut stiffness = system.stiffness.clone();
    for (element, (spring, _)) in system.elements.iter().zip(elements) {
        for &(i, a) in element.port.terms() {
            for &(j, b) in element.port.terms() {
                stiffness[(i, j)] += a * b * spring;
            }
        }
    }
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for matrix in [Some(&stiffness), system.stiffness_quadratic_in_frequency.as_ref()] {
        let Some(matrix) = matrix else { continue };
        let entry = |i: usize, j: usize| matrix[(i, j)] / (scale[i] * scale[j]);
        let block: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
        let largest = block.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
        if largest > 0.0 {
            rows.extend(block.iter().map(|row| row.iter().map(|v| v / largest).collect()));
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    let mut rank = 0;
    while rank < n.min(rows.len()) {
        let places = (rank..rows.len()).flat_map(|i| (rank..n).map(move |j| (i, j)));
        let (i, j) = places.max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs()))?;
        if rows[i][j].abs() <= RANK {
            break;
        }
        rows.swap(rank, i);
        order.swap(rank, j);
        rows.iter_mut().for_each(|row| row.swap(rank, j));
        let pivot = rows[rank].clone();
        for row in rows.iter_mut().skip(rank + 1) {
            let factor = row[rank] / pivot[rank];
            for (value, p) in row.iter_mut().zip(&pivot).skip(rank) {
                *value -= factor * p;
            }
        }
        rank += 1;
    }
    if rank == n {
        return None;
    }
    let mut basis = Matrix::zeros(n, n - rank);
    for free in rank..n {
        let mut x = vec![0.0; n];
        x[free] = 1.0;
        for i in (0..rank).rev() {
            x[i] = -dot(&rows[i][i + 1..], &x[i + 1..]) / rows[i][i];
        }
        for (value, &original) in x.iter().zip(&order) {
            basis[(original, free - rank)] = value / scale[original];
        }
    }
    orthonormalize(&mut basis);
    Some(basis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use slackside_mechanics::laws::{coulomb, one_way_damper, wrap_spring};
    use slackside_mechanics::{Element, Forcing, Law};

    fn pair(law: impl Law + 'static) -> System {
        let port = Port::new([(0, 1.0), (1, -1.0)]);
        System {
            coordinates: vec!["pulley".into(), "accessory".into()],
            mass: Matrix::diagonal(&[1.0, 1.6]),
            damping: Matrix::zeros(2, 2),
            stiffness: Matrix::diagonal(&[2.6, 0.0]),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing: Forcing::none(2),
            elements: vec![Element::new("clutch", port, law)],
            outputs: vec![],
        }
    }

    #[test]
    fn an_accessory_behind_a_velocity_law_drifts() {
        let found = Linearization::of(&pair(one_way_damper(5.0)));
        let (projector, count) = found.drift.unwrap();
        assert_eq!((count, found.drifting[0]), (1, true));
        assert_eq!(found.elements[0], (0.0, 5.0));
        assert!((projector[(1, 1)] - 1.0).abs() < 1e-15 && projector[(0, 0)].abs() < 1e-15);
        // Dry friction has no damper of its own and is given one.
        let found = Linearization::of(&pair(coulomb(1.0, 1.0)));
        assert!(found.drifting[0] && found.elements[0].1 > 0.0);
    }

    #[test]
    fn a_spring_holds_it() {
        assert!(Linearization::of(&pair(wrap_spring(24.0))).drift.is_none());
    }

    #[test]
    fn two_free_pulleys_on_a_belt_drift_together() {
        let mut system = pair(one_way_damper(5.0));
        system.stiffness = Matrix::from_rows(&[vec![2.0, -2.0], vec![-2.0, 2.0]]).unwrap();
        let found = Linearization::of(&system);
        let (projector, _) = found.drift.unwrap();
        assert!(projector.as_slice().iter().all(|v| (v - 0.5).abs() < 1e-14));
        // The clutch between them does not feel it.
        assert!(!found.drifting[0]);
    }
}
