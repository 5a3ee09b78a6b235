//! From all coordinates of the linear model to those that move freely: `q = T y + Σ_k Re(s_k e^{ikΩt})`.
//!
//! * Driver prescribed: `y` are the free coordinates, `s_k` the driver's rotation, and the load is
//!   `F_k = −(K_fd + ikΩ C_fd − k²Ω² M_fd) Θ_k` (theory 05 §1).
//! * Driver free under torque: the drive can turn as a whole, `x` with `r_j x_j = r_d`, without any stiffness. All other
//!   rotations are taken relative to this motion. If something damps it, the driver's rotation stays as a coordinate
//!   without stiffness, like that of an accessory behind an open clutch. If nothing does, its momentum is conserved up
//!   to the excitation: `x` separates, with `s_k = −x τ_k / (J k²Ω²)`, and no neutral direction is left.

use super::DriveSystemError;
use super::locked_modes;
use crate::drive::{Drive, Excitation};
use crate::model::{Coordinate, LinearModel};
use crate::steady::SteadyState;
use slackside_linalg::{Complex, Matrix, dot};
use slackside_mechanics::Port;

/// Decay of the rotation of the whole drive over the frequency of the excitation below which nothing damps it.
const UNDAMPED: f64 = 1e-6;

/// Equations of motion of the free coordinates, without elements.
pub(super) struct Reduction {
    /// Mass matrix.
    pub mass: Matrix,
    /// Velocity matrix, gyroscopic terms included.
    pub damping: Matrix,
    /// Stiffness matrix, circulatory terms included.
    pub stiffness: Matrix,
    /// Order and complex amplitudes of the load.
    pub forces: Vec<(usize, Vec<Complex>)>,
    /// Order and complex amplitudes of the prescribed part of all coordinates.
    pub prescribed: Vec<(usize, Vec<Complex>)>,
    /// `T`, all coordinates by free ones.
    pub transform: Matrix,
    /// Coordinates of the linear model that the free ones stand for.
    pub kept: Vec<usize>,
    /// How the driver moves.
    pub driver: DriverMotion,
}

/// How the driver moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DriverMotion {
    /// As prescribed.
    Prescribed,
    /// Freely, with the rotation of the whole drive damped: a coordinate without stiffness.
    Damped,
    /// Freely, with the rotation of the whole drive undamped: known beforehand.
    Undamped,
}

/// Matrices over all coordinates.
struct Whole {
    mass: Matrix,
    velocity: Matrix,
    position: Matrix,
}

impl Reduction {
    pub fn new(
        drive: &Drive,
        steady: &SteadyState,
        model: &LinearModel,
        excitation: &Excitation,
        loads: &[(usize, Complex)],
        frequency: f64,
    ) -> Result<Self, DriveSystemError> {
        let is_free = matches!(excitation, Excitation::Torque(_));
        let free = model.free_coordinates(drive, is_free);
        if let Some(index) = free.iter().find(|index| model.mass[(**index, **index)] <= 0.0) {
            return Err(DriveSystemError::NoInertia {
                coordinate: model.coordinates.name(drive, *index),
            });
        }
        let mut velocity = locked_modes::damping(drive, steady, model, is_free)?;
        velocity.add_scaled(1.0, &model.gyroscopic);
        let mut position = model.stiffness.clone();
        position.add_scaled(1.0, &model.circulatory);
        let whole = Whole {
            mass: model.mass.clone(),
            velocity,
            position,
        };
        if !is_free {
            return Ok(Self::prescribed(&whole, model.driver, free, loads, frequency));
        }
        let rigid = whole_rotation(drive, model);
        let inertia = dot(&rigid, &whole.mass.times(&rigid));
        let decay = dot(&rigid, &whole.velocity.times(&rigid)) / inertia;
        Ok(if decay > UNDAMPED * frequency {
            Self::damped(&whole, model.driver, free, &rigid, loads)
        } else {
            Self::undamped(&whole, model.driver, &free, (&rigid, inertia), loads, frequency)
        })
    }

    fn prescribed(
        whole: &Whole,
        driver: usize,
        free: Vec<usize>,
        loads: &[(usize, Complex)],
        frequency: f64,
    ) -> Self {
        let size = whole.mass.rows();
        let mut transform = Matrix::zeros(size, free.len());
        for (column, row) in free.iter().enumerate() {
            transform[(*row, column)] = 1.0;
        }
        let force = |(order, rotation): &(usize, Complex)| {
            let omega = *order as f64 * frequency;
            let of_row = |row: &usize| {
                let at = (*row, driver);
                let coupling = Complex::new(
                    whole.position[at] - omega * omega * whole.mass[at],
                    omega * whole.velocity[at],
                );
                -coupling * rotation
            };
            (*order, free.iter().map(of_row).collect())
        };
        let moved = |(order, rotation): &(usize, Complex)| {
            let mut motion = vec![Complex::ZERO; size];
            motion[driver] = *rotation;
            (*order, motion)
        };
        Self {
            mass: whole.mass.selected(&free),
            damping: whole.velocity.selected(&free),
            stiffness: whole.position.selected(&free),
            forces: loads.iter().map(force).collect(),
            prescribed: loads.iter().map(moved).collect(),
            transform,
            kept: free,
            driver: DriverMotion::Prescribed,
        }
    }

    fn damped(
        whole: &Whole,
        driver: usize,
        free: Vec<usize>,
        rigid: &[f64],
        loads: &[(usize, Complex)],
    ) -> Self {
        let mut transform = Matrix::zeros(rigid.len(), free.len());
        for (column, row) in free.iter().enumerate() {
            if *row == driver {
                for (index, value) in rigid.iter().enumerate() {
                    transform[(index, column)] = *value;
                }
            } else {
                transform[(*row, column)] = 1.0;
            }
        }
        // The rotation of the whole drive has no stiffness; no rounding error may give it one.
        let mut stiffness = whole.position.selected(&free);
        for (k, _) in free.iter().enumerate().filter(|(_, index)| **index == driver) {
            for other in 0..free.len() {
                stiffness[(k, other)] = 0.0;
                stiffness[(other, k)] = 0.0;
            }
        }
        let force = |(order, torque): &(usize, Complex)| {
            let on_driver = |index: &usize| {
                if *index == driver { *torque } else { Complex::ZERO }
            };
            (*order, free.iter().map(on_driver).collect())
        };
        Self {
            mass: congruent(&transform, &whole.mass),
            damping: congruent(&transform, &whole.velocity),
            stiffness,
            forces: loads.iter().map(force).collect(),
            prescribed: Vec::new(),
            transform,
            kept: free,
            driver: DriverMotion::Damped,
        }
    }

    fn undamped(
        whole: &Whole,
        driver: usize,
        free: &[usize],
        (rigid, inertia): (&[f64], f64),
        loads: &[(usize, Complex)],
        frequency: f64,
    ) -> Self {
        let kept: Vec<usize> = free.iter().copied().filter(|index| *index != driver).collect();
        let momentum = whole.mass.times(rigid);
        let mut transform = Matrix::zeros(rigid.len(), kept.len());
        for (column, row) in kept.iter().enumerate() {
            transform[(*row, column)] = 1.0;
            for (index, value) in rigid.iter().enumerate() {
                transform[(index, column)] -= value * momentum[*row] / inertia;
            }
        }
        let on_driver = transform.row(driver);
        let force = |(order, torque): &(usize, Complex)| {
            (*order, on_driver.iter().map(|share| torque * *share).collect())
        };
        let moved = |(order, torque): &(usize, Complex)| {
            let omega = *order as f64 * frequency;
            let rotation = -torque / (inertia * omega * omega);
            (*order, rigid.iter().map(|value| rotation * *value).collect())
        };
        Self {
            mass: congruent(&transform, &whole.mass),
            damping: congruent(&transform, &whole.velocity),
            // `K x = 0`: the relative rotations have the stiffness of the absolute ones.
            stiffness: whole.position.selected(&kept),
            forces: loads.iter().map(force).collect(),
            prescribed: loads.iter().map(moved).collect(),
            transform,
            kept,
            driver: DriverMotion::Undamped,
        }
    }

    /// Number of free coordinates.
    pub fn order(&self) -> usize {
        self.kept.len()
    }

    /// Position of a coordinate of the linear model among the free ones.
    pub fn position(&self, index: usize) -> Option<usize> {
        self.kept.iter().position(|kept| *kept == index)
    }

    /// A port of the linear model's coordinates in the free ones. Ports do not see the rotation of the whole drive, so that
    /// relative rotations serve as well as absolute ones.
    pub fn port(&self, port: &Port) -> Port {
        let terms = port.terms().iter();
        Port::new(terms.filter_map(|(index, factor)| Some((self.position(*index)?, *factor))))
    }

    /// Names of the free coordinates: those of the linear model, with `.relative` for rotations relative to the driver's.
    pub fn names(&self, drive: &Drive, model: &LinearModel) -> Vec<String> {
        let relative = |index: usize| {
            self.driver != DriverMotion::Prescribed
                && index != model.driver
                && matches!(
                    model.coordinates.iter().nth(index),
                    Some(Coordinate::Pulley(_) | Coordinate::Accessory(_))
                )
        };
        self.kept
            .iter()
            .map(|index| {
                let name = model.coordinates.name(drive, *index);
                if relative(*index) {
                    format!("{name}.relative")
                } else {
                    name
                }
            })
            .collect()
    }
}

/// The rotation of the whole drive with the belt, one radian at the driver.
fn whole_rotation(drive: &Drive, model: &LinearModel) -> Vec<f64> {
    let of_driver = drive.pulleys[drive.driver].radius;
    model
        .coordinates
        .iter()
        .map(|coordinate| match coordinate {
            Coordinate::Pulley(j) | Coordinate::Accessory(j) => of_driver / drive.pulleys[j].radius,
            Coordinate::Arm(_) | Coordinate::Sine { .. } => 0.0,
        })
        .collect()
}

/// `Tᵀ A T`.
fn congruent(transform: &Matrix, matrix: &Matrix) -> Matrix {
    transform.transpose().product(matrix).product(transform)
}
