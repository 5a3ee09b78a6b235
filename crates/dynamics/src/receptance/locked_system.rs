//! The linear part with its ports held at rest, and the forces that this takes.
//!
//! With `Bᵀq = w` constant, `q = T y + E w`, where `BᵀT = 0` and `BᵀE = 1`. The reduced system has the matrices `TᵀMT` and so
//! on, and the constraint forces are `f = Eᵀ (F − D q)` (theory 05 (3.1), §3.1 (b)).

use super::{LinearSystem, ReceptanceError};
use crate::orbit::harmonic_balance::elimination;
use slackside_linalg::{Complex, Lu, Matrix};

/// A linear system whose ports are held at rest. It owns space for its solutions, so that those allocate nothing.
#[derive(Debug, Clone)]
pub struct LockedSystem {
    reduced: LinearSystem,
    /// Rows `EᵀMT` and so on, one per port, as a system of matrices of `ports × (n − ports)`.
    rows: Rows,
    /// `T` and `E`.
    basis: Matrix,
    offsets: Matrix,
    matrix: Vec<Complex>,
    solution: Vec<Complex>,
}

/// Rows on the reduced coordinates `y` that give the constraint forces, and the load's share.
#[derive(Debug, Clone)]
struct Rows {
    mass: Matrix,
    damping: Matrix,
    damping_linear: Option<Matrix>,
    stiffness: Matrix,
    stiffness_quadratic: Option<Matrix>,
    constant: Vec<f64>,
    harmonics: Vec<Vec<Complex>>,
    /// `K E` and `K₂ E`.
    offset_stiffness: Matrix,
    offset_stiffness_quadratic: Option<Matrix>,
}

impl LockedSystem {
    pub(super) fn new(open: &LinearSystem) -> Result<Self, ReceptanceError> {
        let (basis, offsets) = constraint_basis(open)?;
        let (left, up) = (basis.transpose(), offsets.transpose());
        let on = |side: &Matrix, matrix: &Matrix| side.product(&matrix.product(&basis));
        let real = |side: &Matrix, load: &[f64]| side.times(load);
        let complex = |side: &Matrix, load: &[Complex]| -> Vec<Complex> {
            (0..side.rows())
                .map(|i| side.row(i).iter().zip(load).map(|(a, f)| a * f).sum())
                .collect()
        };
        let optional = |side: &Matrix, matrix: &Option<Matrix>| matrix.as_ref().map(|m| on(side, m));
        let reduced = LinearSystem {
            mass: on(&left, &open.mass),
            damping: on(&left, &open.damping),
            damping_linear: optional(&left, &open.damping_linear),
            stiffness: on(&left, &open.stiffness),
            stiffness_quadratic: optional(&left, &open.stiffness_quadratic),
            constant: real(&left, &open.constant),
            harmonics: (open.harmonics.iter())
                .map(|(order, load)| (*order, complex(&left, load)))
                .collect(),
            ports: Vec::new(),
            names: Vec::new(),
        };
        let rows = Rows {
            mass: on(&up, &open.mass),
            damping: on(&up, &open.damping),
            damping_linear: optional(&up, &open.damping_linear),
            stiffness: on(&up, &open.stiffness),
            stiffness_quadratic: optional(&up, &open.stiffness_quadratic),
            constant: real(&up, &open.constant),
            harmonics: (open.harmonics.iter())
                .map(|(_, load)| complex(&up, load))
                .collect(),
            offset_stiffness: open.stiffness.product(&offsets),
            offset_stiffness_quadratic: (open.stiffness_quadratic.as_ref())
                .map(|matrix| matrix.product(&offsets)),
        };
        let r = reduced.order();
        Ok(Self {
            reduced,
            rows,
            basis,
            offsets,
            matrix: vec![Complex::ZERO; r * r],
            solution: vec![Complex::ZERO; r],
        })
    }

    /// Number of locked ports.
    pub fn ports(&self) -> usize {
        self.offsets.columns()
    }

    /// Orders of the load.
    pub fn orders(&self) -> impl Iterator<Item = usize> + '_ {
        self.reduced.harmonics.iter().map(|(order, _)| *order)
    }

    /// The poles of the system with its ports held, by rising imaginary part.
    ///
    /// # Errors
    /// [`ReceptanceError::Linalg`].
    pub fn poles(&self, frequency: f64) -> Result<Vec<Complex>, ReceptanceError> {
        self.reduced.poles(frequency)
    }

    /// Writes the amplitude of the constraint force of every port at the load's harmonic with the given place in the list of
    /// orders: `f_k = Eᵀ (F_k − D(kΩ) T y_k)` with `TᵀDT y_k = TᵀF_k`. `n³/3` complex operations, no allocation.
    ///
    /// # Errors
    /// [`ReceptanceError::Resonance`].
    pub fn force_of(
        &mut self,
        place: usize,
        frequency: f64,
        forces: &mut [Complex],
    ) -> Result<(), ReceptanceError> {
        let omega = self.solve(place, frequency)?;
        for (port, force) in forces.iter_mut().enumerate() {
            *force = self.rows.harmonics[place][port] - self.row_product(port, omega, frequency);
        }
        Ok(())
    }

    /// The response of all coordinates at the load's harmonic with this place in the list of orders, with the ports at rest.
    ///
    /// # Errors
    /// [`ReceptanceError::Resonance`].
    pub fn response_of(&mut self, place: usize, frequency: f64) -> Result<Vec<Complex>, ReceptanceError> {
        self.solve(place, frequency)?;
        Ok((0..self.basis.rows())
            .map(|i| {
                self.basis
                    .row(i)
                    .iter()
                    .zip(&self.solution)
                    .map(|(t, y)| t * y)
                    .sum()
            })
            .collect())
    }

    /// The constant part of the constraint forces with the ports held at displacement zero.
    ///
    /// # Errors
    /// [`ReceptanceError::FreeMean`] if a coordinate is free even so.
    pub fn mean_forces(&self, frequency: f64) -> Result<Vec<f64>, ReceptanceError> {
        let y = self.static_solution(frequency, &self.reduced.constant)?;
        let rows = self.static_rows(frequency);
        Ok((0..self.ports())
            .map(|port| self.rows.constant[port] - slackside_linalg::dot(rows.row(port), &y))
            .collect())
    }

    /// Static stiffness of the ports, `k_eff = K_ee − K_ey K_yy⁻¹ K_ye`: restoring force per displacement at which they are
    /// held (theory 05 §5.2). Zero for the port of a coordinate without stiffness.
    ///
    /// # Errors
    /// [`ReceptanceError::FreeMean`] if another coordinate is free.
    pub fn static_stiffness(&self, frequency: f64) -> Result<Matrix, ReceptanceError> {
        let mut offset = self.rows.offset_stiffness.clone();
        if let Some(quadratic) = &self.rows.offset_stiffness_quadratic {
            offset.add_scaled(frequency * frequency, quadratic);
        }
        let rows = self.static_rows(frequency);
        let m = self.ports();
        let mut result = self.offsets.transpose().product(&offset);
        let coupling = self.basis.transpose().product(&offset);
        for j in 0..m {
            let y = self.static_solution(frequency, &coupling.column(j))?;
            for i in 0..m {
                result[(i, j)] -= slackside_linalg::dot(rows.row(i), &y);
            }
        }
        Ok(result)
    }

    /// Derivative of the constraint forces of a harmonic with respect to an entry `M_cc` of the mass matrix:
    /// `df = −Eᵀ (dD T y + D T dy)`, `TᵀDT dy = −Tᵀ dD T y`, `dD = −(kΩ)² e_c e_cᵀ`.
    ///
    /// # Errors
    /// [`ReceptanceError::Resonance`].
    pub fn force_rate_by_inertia(
        &mut self,
        place: usize,
        coordinate: usize,
        frequency: f64,
        rates: &mut [Complex],
    ) -> Result<(), ReceptanceError> {
        let omega = self.solve(place, frequency)?;
        let row = self.basis.row(coordinate);
        let moved: Complex = row.iter().zip(&self.solution).map(|(t, y)| t * y).sum();
        let inertial = omega * omega * moved;
        let right: Vec<Complex> = row.iter().map(|t| t * inertial).collect();
        self.solution.copy_from_slice(&right);
        self.eliminate(omega, frequency)?;
        for (port, rate) in rates.iter_mut().enumerate() {
            *rate = self.offsets[(coordinate, port)] * inertial - self.row_product(port, omega, frequency);
        }
        Ok(())
    }

    /// Solves for `y` of a harmonic and returns its circular frequency.
    fn solve(&mut self, place: usize, frequency: f64) -> Result<f64, ReceptanceError> {
        let (order, load) = &self.reduced.harmonics[place];
        let omega = *order as f64 * frequency;
        self.solution.copy_from_slice(load);
        self.eliminate(omega, frequency)?;
        Ok(omega)
    }

    /// Replaces `solution` by `(TᵀD(ω)T)⁻¹ solution`.
    fn eliminate(&mut self, omega: f64, frequency: f64) -> Result<(), ReceptanceError> {
        let r = self.reduced.order();
        self.reduced.dynamic_stiffness(omega, frequency, &mut self.matrix);
        if elimination::solve(&mut self.matrix, &mut self.solution, r, 1) {
            Ok(())
        } else {
            Err(ReceptanceError::Resonance { omega })
        }
    }

    /// `EᵀD(ω)T y` of one port.
    fn row_product(&self, port: usize, omega: f64, frequency: f64) -> Complex {
        let rows = &self.rows;
        let (mass, damping) = (rows.mass.row(port), rows.damping.row(port));
        let stiffness = rows.stiffness.row(port);
        let linear = rows.damping_linear.as_ref().map(|m| m.row(port));
        let quadratic = rows.stiffness_quadratic.as_ref().map(|m| m.row(port));
        let mut sum = Complex::ZERO;
        for (j, y) in self.solution.iter().enumerate() {
            let c = damping[j] + linear.map_or(0.0, |row| frequency * row[j]);
            let k = stiffness[j] + quadratic.map_or(0.0, |row| frequency * frequency * row[j]);
            sum += Complex::new(k - omega * omega * mass[j], omega * c) * y;
        }
        sum
    }

    fn static_rows(&self, frequency: f64) -> Matrix {
        let mut rows = self.rows.stiffness.clone();
        if let Some(quadratic) = &self.rows.stiffness_quadratic {
            rows.add_scaled(frequency * frequency, quadratic);
        }
        rows
    }

    /// `(TᵀKT)⁻¹ load`; coordinates without stiffness must carry no load and stay where they are.
    fn static_solution(&self, frequency: f64, load: &[f64]) -> Result<Vec<f64>, ReceptanceError> {
        let held = self.reduced.held_coordinates(frequency);
        let scale = load.iter().fold(0.0_f64, |a, f| a.max(f.abs()));
        if (0..load.len()).any(|i| !held.contains(&i) && load[i].abs() > 1e-14 * scale) {
            return Err(ReceptanceError::FreeMean);
        }
        let stiffness = self.reduced.stiffness_at(frequency).selected(&held);
        let lu = Lu::new(&stiffness).map_err(|_| ReceptanceError::FreeMean)?;
        let right: Vec<f64> = held.iter().map(|&i| load[i]).collect();
        let found = lu.solve(&right);
        let mut result = vec![0.0; load.len()];
        for (&i, y) in held.iter().zip(found) {
            result[i] = y;
        }
        if result.iter().all(|y| y.is_finite()) {
            Ok(result)
        } else {
            Err(ReceptanceError::FreeMean)
        }
    }
}

/// `T` and `E` by Gauss–Jordan elimination of `Bᵀ` with the largest entry of each row as pivot: the pivot coordinates follow
/// from the others.
fn constraint_basis(open: &LinearSystem) -> Result<(Matrix, Matrix), ReceptanceError> {
    let (n, m) = (open.order(), open.ports.len());
    // [Bᵀ | 1] becomes [1 on the pivots, W elsewhere | B_P⁻ᵀ].
    let mut rows: Vec<Vec<f64>> = (0..m)
        .map(|j| {
            let mut row = open.ports[j].clone();
            row.extend((0..m).map(|i| f64::from(u8::from(i == j))));
            row
        })
        .collect();
    let mut pivots = Vec::with_capacity(m);
    for j in 0..m {
        let size = |i: &usize| rows[j][*i].abs();
        let largest = (open.ports[j].iter()).fold(0.0_f64, |a, b| a.max(b.abs()));
        let pivot = (0..n).max_by(|a, b| size(a).total_cmp(&size(b)));
        let Some(pivot) = pivot.filter(|i| size(i) > 1e-12 * largest) else {
            return Err(ReceptanceError::DependentPort {
                element: open.names[j].clone(),
            });
        };
        let inverse = 1.0 / rows[j][pivot];
        rows[j].iter_mut().for_each(|v| *v *= inverse);
        let top = rows[j].clone();
        for (other, row) in rows.iter_mut().enumerate() {
            let factor = row[pivot];
            if other != j && factor != 0.0 {
                row.iter_mut().zip(&top).for_each(|(v, t)| *v -= factor * t);
            }
        }
        pivots.push(pivot);
    }
    let free: Vec<usize> = (0..n).filter(|i| !pivots.contains(i)).collect();
    let mut basis = Matrix::zeros(n, free.len());
    let mut offsets = Matrix::zeros(n, m);
    for (column, &i) in free.iter().enumerate() {
        basis[(i, column)] = 1.0;
        for (row, &pivot) in pivots.iter().enumerate() {
            basis[(pivot, column)] = -rows[row][i];
        }
    }
    for (row, &pivot) in pivots.iter().enumerate() {
        for j in 0..m {
            offsets[(pivot, j)] = rows[row][n + j];
        }
    }
    Ok((basis, offsets))
}
