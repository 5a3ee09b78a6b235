//! The eigenvalue problems (theory 04 §4.1).

use super::{Mode, ModesError, Shares};
use crate::drive::Drive;
use crate::model::{Coordinate, LinearModel};
use slackside_linalg::{Complex, ComplexMatrix, LinalgError, Lu, Matrix, dot, eigen, gyroscopic_modes};

/// Undamped modes, ascending in frequency, of the drive with its driver's motion prescribed or free. With the driver free
/// the first mode is the rotation of the whole drive at zero frequency; an accessory behind an open clutch adds another.
///
/// # Errors
/// [`ModesError`].
pub fn undamped_modes(
    drive: &Drive,
    model: &LinearModel,
    driver_is_free: bool,
) -> Result<Vec<Mode>, ModesError> {
    check_inertia(drive, model)?;
    let free = model.free_coordinates(drive, driver_is_free);
    let rigid = rigid_motions(drive, model, &free, driver_is_free);
    let basis = complement(&model.mass.selected(&free), &rigid);
    let reduce = |matrix: &Matrix| reduced(&matrix.selected(&free), basis.as_ref());
    let found = gyroscopic_modes(
        &reduce(&model.mass),
        &reduce(&model.gyroscopic),
        &reduce(&model.stiffness),
    )
    .map_err(unstable)?;
    let mut modes: Vec<Mode> = rigid
        .iter()
        .map(|motion| {
            let shape = motion.iter().map(|value| Complex::new(*value, 0.0)).collect();
            mode(drive, model, &free, 0.0, 0.0, shape)
        })
        .collect();
    for (k, frequency) in found.frequencies.iter().enumerate() {
        let column: Vec<Complex> = (0..found.shapes.rows()).map(|i| found.shapes[(i, k)]).collect();
        let shape = match &basis {
            Some(basis) => (0..free.len())
                .map(|i| basis.row(i).iter().zip(&column).map(|(a, b)| b * *a).sum())
                .collect(),
            None => column,
        };
        modes.push(mode(drive, model, &free, *frequency, 0.0, shape));
    }
    Ok(modes)
}

/// Damped modes, ascending in `|s|`, one for every pair of eigenvalues `s`, and one for every real one.
///
/// # Errors
/// [`ModesError`].
pub fn damped_modes(
    drive: &Drive,
    model: &LinearModel,
    driver_is_free: bool,
) -> Result<Vec<Mode>, ModesError> {
    check_inertia(drive, model)?;
    let free = model.free_coordinates(drive, driver_is_free);
    let count = free.len();
    let rigid = rigid_motions(drive, model, &free, driver_is_free).len();
    let mut velocity = model.damping_of(drive, &free).map_err(ModesError::Linalg)?;
    velocity.add_scaled(1.0, &model.gyroscopic.selected(&free));
    let mut position = model.stiffness.selected(&free);
    position.add_scaled(1.0, &model.circulatory.selected(&free));
    let inverse = Lu::new(&model.mass.selected(&free)).map_err(ModesError::Linalg)?;
    let (position, velocity) = (inverse.solve_matrix(&position), inverse.solve_matrix(&velocity));
    let mut first_order = Matrix::zeros(2 * count, 2 * count);
    for i in 0..count {
        first_order[(i, count + i)] = 1.0;
        for j in 0..count {
            first_order[(count + i, j)] = -position[(i, j)];
            first_order[(count + i, count + j)] = -velocity[(i, j)];
        }
    }
    let found = eigen(&first_order).map_err(ModesError::Linalg)?;
    let largest = found.values.iter().fold(0.0_f64, |a, v| a.max(v.norm()));
    let mut modes: Vec<Mode> = found
        .values
        .iter()
        .enumerate()
        .filter(|(_, value)| value.im >= 0.0)
        .map(|(k, value)| {
            let shape = (0..count).map(|i| found.vectors[(i, k)]).collect();
            let frequency = value.norm();
            let ratio = if frequency > 0.0 {
                -value.re / frequency
            } else {
                0.0
            };
            mode(drive, model, &free, frequency, ratio, shape)
        })
        .collect();
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    // A rigid motion has two eigenvalues next to zero (one if a bearing brakes it); they are one mode.
    let near_zero = modes
        .iter()
        .take(2 * rigid)
        .filter(|mode| mode.frequency < 1e-7 * largest)
        .count();
    modes.drain(..near_zero.saturating_sub(rigid));
    for mode in modes.iter_mut().take(near_zero.min(rigid)) {
        (mode.frequency, mode.damping_ratio) = (0.0, 0.0);
    }
    Ok(modes)
}

fn mode(
    drive: &Drive,
    model: &LinearModel,
    free: &[usize],
    frequency: f64,
    damping_ratio: f64,
    shape: Vec<Complex>,
) -> Mode {
    let mut whole = vec![Complex::ZERO; model.coordinates.len()];
    for (index, value) in free.iter().zip(shape) {
        whole[*index] = value;
    }
    let shares = Shares::new(drive, model, &whole);
    Mode {
        frequency,
        damping_ratio,
        kind: shares.kind(),
        shares,
        shape: whole,
    }
}

fn check_inertia(drive: &Drive, model: &LinearModel) -> Result<(), ModesError> {
    let without = (0..model.coordinates.len()).find(|index| model.mass[(*index, *index)] <= 0.0);
    match without {
        Some(index) => Err(ModesError::NoInertia {
            coordinate: model.coordinates.name(drive, index),
        }),
        None => Ok(()),
    }
}

fn unstable(error: LinalgError) -> ModesError {
    match error {
        LinalgError::NotPositiveDefinite => ModesError::Unstable,
        other => ModesError::Linalg(other),
    }
}

/// Motions without any force, over the free coordinates: all pulleys turning with the belt, and accessories behind open
/// clutches. They are independent and orthogonal in mass.
fn rigid_motions(drive: &Drive, model: &LinearModel, free: &[usize], driver_is_free: bool) -> Vec<Vec<f64>> {
    let is_open = |j: usize| {
        model
            .coordinates
            .accessory(j)
            .is_some_and(|index| (0..model.coordinates.len()).all(|k| model.stiffness[(index, k)] == 0.0))
    };
    let over_free = |value: &dyn Fn(Coordinate) -> f64| -> Vec<f64> {
        let all: Vec<f64> = model.coordinates.iter().map(value).collect();
        free.iter().map(|index| all[*index]).collect()
    };
    let mut motions = Vec::new();
    if driver_is_free {
        motions.push(over_free(&|coordinate| match coordinate {
            Coordinate::Pulley(j) => 1.0 / drive.pulleys[j].radius,
            Coordinate::Accessory(j) if !is_open(j) => 1.0 / drive.pulleys[j].radius,
            _ => 0.0,
        }));
    }
    for open in (0..drive.pulleys.len()).filter(|j| is_open(*j)) {
        motions.push(over_free(&|coordinate| {
            f64::from(coordinate == Coordinate::Accessory(open))
        }));
    }
    motions
}

/// Orthonormal basis of all motions that are orthogonal in mass to the rigid ones; `None` if there are none of these.
/// Each rigid motion removes one dimension by a Householder reflection.
fn complement(mass: &Matrix, rigid: &[Vec<f64>]) -> Option<Matrix> {
    let mut basis: Option<Matrix> = None;
    for motion in rigid {
        let momentum = mass.times(motion);
        let seen = match &basis {
            Some(basis) => basis.transpose().times(&momentum),
            None => momentum,
        };
        let reflected = without_direction(&seen);
        basis = Some(match basis {
            Some(basis) => basis.product(&reflected),
            None => reflected,
        });
    }
    basis
}

/// The columns but the first of the reflection that turns the first axis into `direction`.
fn without_direction(direction: &[f64]) -> Matrix {
    let size = direction.len();
    let length = dot(direction, direction).sqrt();
    let mut mirror = direction.to_vec();
    mirror[0] += length.copysign(direction[0]);
    let squared = dot(&mirror, &mirror);
    let mut columns = Matrix::zeros(size, size - 1);
    for i in 0..size {
        for j in 1..size {
            columns[(i, j - 1)] = f64::from(i == j) - 2.0 * mirror[i] * mirror[j] / squared;
        }
    }
    columns
}

fn reduced(matrix: &Matrix, basis: Option<&Matrix>) -> Matrix {
    match basis {
        Some(basis) => basis.transpose().product(matrix).product(basis),
        None => matrix.clone(),
    }
}

impl LinearModel {
    /// Damping matrix of the free coordinates, modal damping included: `C + MΦ diag(2ζ_kω_k) ΦᵀM` with the modes of
    /// mass and stiffness alone (theory 04 §3.6).
    pub(crate) fn damping_of(&self, drive: &Drive, free: &[usize]) -> Result<Matrix, LinalgError> {
        let mut damping = self.damping.selected(free);
        if let Some(modal) = &drive.belt.damping.modal {
            let mass = self.mass.selected(free);
            let modes = slackside_linalg::undamped_modes(&mass, &self.stiffness.selected(free))?;
            let momenta = mass.product(&modes.shapes);
            for (k, squared) in modes.squared_frequencies.iter().enumerate() {
                let factor = 2.0 * modal.ratio(k) * squared.max(0.0).sqrt();
                crate::model::add_outer(&mut damping, &momenta.column(k), factor);
            }
        }
        Ok(damping)
    }

    /// Dynamic stiffness `K + K_c − ω²M + iω(C + G)` of rows and columns of the free coordinates.
    pub(crate) fn dynamic_stiffness(
        &self,
        drive: &Drive,
        free: &[usize],
        frequency: f64,
    ) -> Result<ComplexMatrix, LinalgError> {
        let mut velocity = self.damping_of(drive, free)?;
        velocity.add_scaled(1.0, &self.gyroscopic.selected(free));
        let mut position = self.stiffness.selected(free);
        position.add_scaled(1.0, &self.circulatory.selected(free));
        Ok(ComplexMatrix::combination(&[
            (Complex::new(1.0, 0.0), &position),
            (
                Complex::new(-frequency * frequency, 0.0),
                &self.mass.selected(free),
            ),
            (Complex::new(0.0, frequency), &velocity),
        ]))
    }
}
