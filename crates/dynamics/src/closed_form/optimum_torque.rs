//! Estimate of the friction torque that dissipates most (theory 05 (5.5)).

use super::ClosedFormError;
use crate::receptance::LinearSystem;
use slackside_mechanics::OperatingPoint;
use std::f64::consts::PI;

/// The friction torque that dissipates most, from one harmonic of the motion. Errors of 1 to 15 % are usual, and at low
/// frequency the dissipation has several maxima, of which this knows one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OptimumTorque {
    /// Estimate of the torque.
    pub torque: f64,
    /// Estimate of the energy dissipated per period of the load's harmonic.
    pub dissipation: f64,
    /// The critical torque `|S_1 u_lin,1|`, at which the dissipation ends.
    pub critical: f64,
}

/// The estimate for the friction element with this index, under a load of one harmonic: with the port's dynamic stiffness
/// `S = 1/R` and `σ = arg S`, `Q_opt ≈ (π/4) Q_cr / √(2 (1 + sin σ))`, `E_max ≈ π Q_cr² / (2 |S| (1 + sin σ))`.
///
/// # Errors
/// [`ClosedFormError::NoHarmonic`], [`ClosedFormError::SeveralHarmonics`], or [`ClosedFormError::Receptance`].
pub fn optimum_torque(point: &OperatingPoint, element: usize) -> Result<OptimumTorque, ClosedFormError> {
    let open = LinearSystem::new(&point.system, &[element])?;
    let order = single_order(&open)?;
    let omega = order as f64 * point.frequency;
    let stiffness = open.receptance(omega, point.frequency)?[(0, 0)].inv();
    let displacement = open.open_displacements(order, point.frequency)?[0];
    let critical = (stiffness * displacement).norm();
    let matching = 1.0 + stiffness.arg().sin();
    Ok(OptimumTorque {
        torque: PI / 4.0 * critical / (2.0 * matching).sqrt(),
        dissipation: PI * critical * critical / (2.0 * stiffness.norm() * matching),
        critical,
    })
}

/// The order of a load of one harmonic.
pub(super) fn single_order(open: &LinearSystem) -> Result<usize, ClosedFormError> {
    let orders = open.orders();
    match orders.as_slice() {
        [] => Err(ClosedFormError::NoHarmonic),
        [order] => Ok(*order),
        _ => Err(ClosedFormError::SeveralHarmonics { orders }),
    }
}
