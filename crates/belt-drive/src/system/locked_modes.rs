//! Modal damping of the drive with all couplings engaged, in the coordinates of the one with its accessories free.

use super::DriveSystemError;
use crate::drive::Drive;
use crate::model::{Coordinate, LinearModel};
use crate::steady::SteadyState;
use slackside_linalg::Matrix;

/// Damping matrix of `model` with the modal damping of the drive in which all couplings transmit. It acts in every state of the
/// couplings; on an accessory behind a one-way clutch it acts through its pulley only, so that one that runs ahead coasts freely.
pub(super) fn damping(
    drive: &Drive,
    steady: &SteadyState,
    model: &LinearModel,
    driver_is_free: bool,
) -> Result<Matrix, DriveSystemError> {
    let mut damping = model.damping.clone();
    if drive.belt.damping.modal.is_none() {
        return Ok(damping);
    }
    let locked = LinearModel::new(drive, steady);
    let free = locked.free_coordinates(drive, driver_is_free);
    let mut modal = locked.damping_of(drive, &free)?;
    modal.add_scaled(-1.0, &locked.damping.selected(&free));
    let all: Vec<Coordinate> = locked.coordinates.iter().collect();
    let places: Vec<usize> = free
        .iter()
        .filter_map(|index| model.coordinates.iter().position(|other| other == all[*index]))
        .collect();
    for (i, row) in places.iter().enumerate() {
        for (j, column) in places.iter().enumerate() {
            damping[(*row, *column)] += modal[(i, j)];
        }
    }
    Ok(damping)
}
