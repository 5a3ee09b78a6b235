//! Natural frequencies over speed, followed from one speed to the next (theory 04 §4.3).

use super::{Kind, Mode, ModesError, undamped_modes};
use crate::drive::Drive;
use crate::model::LinearModel;
use crate::steady::{Installed, SteadyError, SteadyState};
use slackside_linalg::Complex;

/// The modes at one speed.
#[derive(Debug, Clone)]
pub struct CampbellPoint {
    /// Speed of the driver, rad/s.
    pub driver_speed: f64,
    /// The lowest modes, in the order of the curves once they are tracked.
    pub modes: Vec<Mode>,
    /// `A* y` of every mode with `y = (iωφ, φ)`, by which neighbouring speeds are matched.
    momenta: Vec<Vec<Complex>>,
}

/// Natural frequencies over speed.
#[derive(Debug, Clone)]
pub struct Campbell {
    /// Ascending in speed.
    pub points: Vec<CampbellPoint>,
}

/// Why there are no modes at a speed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CampbellError {
    /// There is no steady state.
    #[error(transparent)]
    Steady(#[from] SteadyError),
    /// There are no modes.
    #[error(transparent)]
    Modes(#[from] ModesError),
}

/// The `count` lowest modes at one speed, not yet matched with any other.
///
/// # Errors
/// [`CampbellError`].
pub fn campbell_point(
    drive: &Drive,
    installed: &Installed,
    driver_speed: f64,
    driver_is_free: bool,
    count: usize,
) -> Result<CampbellPoint, CampbellError> {
    let steady = SteadyState::solve(drive, installed, driver_speed)?;
    let model = LinearModel::new(drive, &steady);
    let mut modes = undamped_modes(drive, &model, driver_is_free)?;
    modes.truncate(count);
    let momenta = modes
        .iter()
        .map(|mode| {
            let along = |matrix: &slackside_linalg::Matrix, factor: Complex| -> Vec<Complex> {
                (0..mode.shape.len())
                    .map(|i| {
                        let sum: Complex = matrix.row(i).iter().zip(&mode.shape).map(|(a, b)| b * *a).sum();
                        factor * sum
                    })
                    .collect()
            };
            let mut momentum = along(&model.mass, Complex::new(0.0, mode.frequency));
            momentum.extend(along(&model.stiffness, Complex::new(1.0, 0.0)));
            momentum
        })
        .collect();
    Ok(CampbellPoint {
        driver_speed,
        modes,
        momenta,
    })
}

/// Modes over ascending speeds, matched by the largest `|φ_oldᴴ A* φ_new|` between neighbours.
///
/// # Errors
/// [`CampbellError`] at the first speed without modes.
pub fn campbell(
    drive: &Drive,
    installed: &Installed,
    speeds: &[f64],
    driver_is_free: bool,
    count: usize,
) -> Result<Campbell, CampbellError> {
    let points: Result<Vec<_>, _> = speeds
        .iter()
        .map(|speed| campbell_point(drive, installed, *speed, driver_is_free, count))
        .collect();
    Ok(track(points?))
}

/// Puts the modes of every point into the order of the curves that start at the first one.
pub fn track(mut points: Vec<CampbellPoint>) -> Campbell {
    for k in 1..points.len() {
        let (before, after) = points.split_at_mut(k);
        let (old, new) = (&before[k - 1], &mut after[0]);
        let order = matching(old, new);
        new.modes = order.iter().map(|m| new.modes[*m].clone()).collect();
        new.momenta = order.iter().map(|m| new.momenta[*m].clone()).collect();
    }
    Campbell { points }
}

/// For every old mode the new one that resembles it most; the most certain pairs first.
fn matching(old: &CampbellPoint, new: &CampbellPoint) -> Vec<usize> {
    let mut pairs = Vec::new();
    for (a, mode) in old.modes.iter().enumerate() {
        for (b, momentum) in new.momenta.iter().enumerate() {
            pairs.push((resemblance(mode, momentum), a, b));
        }
    }
    pairs.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut found = vec![None; old.modes.len()];
    let mut taken = vec![false; new.modes.len()];
    for (_, a, b) in pairs {
        if found[a].is_none() && !taken[b] {
            found[a] = Some(b);
            taken[b] = true;
        }
    }
    let mut order: Vec<usize> = found.into_iter().flatten().collect();
    order.extend((0..taken.len()).filter(|b| !taken[*b]));
    order
}

fn resemblance(old: &Mode, momentum: &[Complex]) -> f64 {
    let half = momentum.len() / 2;
    let velocity = Complex::new(0.0, old.frequency);
    let sum: Complex = old
        .shape
        .iter()
        .enumerate()
        .map(|(i, value)| (velocity * value).conj() * momentum[i] + value.conj() * momentum[half + i])
        .sum();
    sum.norm()
}

impl Campbell {
    /// Speeds (rad/s) at which the excitation line of an order meets a mode of the given curve, linear between points.
    pub fn crossings(&self, curve: usize, order: f64) -> Vec<f64> {
        let gap = |point: &CampbellPoint| {
            point
                .modes
                .get(curve)
                .map(|mode| order * point.driver_speed - mode.frequency)
        };
        let between = self.points.windows(2).filter_map(|pair| {
            let (left, right) = (gap(&pair[0])?, gap(&pair[1])?);
            let share = left / (left - right);
            (left * right < 0.0)
                .then(|| pair[0].driver_speed + share * (pair[1].driver_speed - pair[0].driver_speed))
        });
        let at_points = self
            .points
            .iter()
            .filter(|point| gap(point) == Some(0.0))
            .map(|point| point.driver_speed);
        let mut speeds: Vec<f64> = between.chain(at_points).collect();
        speeds.sort_by(f64::total_cmp);
        speeds
    }

    /// Kinds of a curve's mode over speed.
    pub fn kinds(&self, curve: usize) -> Vec<Kind> {
        self.points
            .iter()
            .filter_map(|point| point.modes.get(curve).map(|mode| mode.kind))
            .collect()
    }
}
