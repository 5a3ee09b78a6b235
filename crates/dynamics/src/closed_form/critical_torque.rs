//! The critical torque of dry friction (theory 05 (5.1)).

use super::{ClosedFormError, LockedElement};
use slackside_linalg::Complex;
use slackside_mechanics::OperatingPoint;

/// The friction torque above which a port stays at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalTorque {
    /// `Q_cr = (max τ − min τ)/2`: a motion locked for all time exists iff the (static) friction torque is at least this.
    pub critical: f64,
    /// Smallest constraint torque `τ` while the port is held at displacement zero; the mean is part of it.
    pub minimum: f64,
    /// Largest constraint torque.
    pub maximum: f64,
    /// Displacement `θ₀* = (max τ + min τ) / (2 k_eff)` in the middle of the locked motions; `None` without static stiffness.
    pub offset: Option<f64>,
    /// Static stiffness `k_eff` of the port.
    pub stiffness: f64,
    /// Order and amplitude of the torque's harmonics.
    pub harmonics: Vec<(usize, Complex)>,
}

impl CriticalTorque {
    /// Half the width of the range of offsets at which a friction torque `Q` holds the port,
    /// `|θ₀ − θ₀*| ≤ (Q − Q_cr)/k_eff`; `None` if it does not hold, or at any offset.
    pub fn offset_range(&self, torque: f64) -> Option<f64> {
        (torque >= self.critical && self.stiffness > 0.0).then(|| (torque - self.critical) / self.stiffness)
    }
}

/// The critical torque of the friction element with this index, the only nonlinear element of the system.
///
/// # Errors
/// [`ClosedFormError::OtherKind`] if the element holds one way only, and those of [`LockedElement`].
pub fn critical_torque(point: &OperatingPoint, element: usize) -> Result<CriticalTorque, ClosedFormError> {
    LockedElement::new(&point.system, element)?.critical_torque(point.frequency)
}

impl LockedElement {
    /// The critical torque under a load of frequency `Ω` (theory 05 (5.1)).
    ///
    /// # Errors
    /// [`ClosedFormError::OtherKind`] for an element that holds one way only, and those of [`LockedElement::force`].
    pub fn critical_torque(&mut self, frequency: f64) -> Result<CriticalTorque, ClosedFormError> {
        if !(self.limits.0.is_finite() && self.limits.1.is_finite()) {
            return Err(ClosedFormError::OtherKind {
                element: self.name.clone(),
                kind: self.kind,
                wanted: "dry friction",
            });
        }
        let force = self.force(frequency)?;
        let mean = self.mean_force(frequency)?.unwrap_or(0.0);
        let stiffness = self.static_stiffness(frequency)?;
        let (minimum, maximum) = (mean + force.dynamic.minimum, mean + force.dynamic.maximum);
        Ok(CriticalTorque {
            critical: 0.5 * (maximum - minimum),
            minimum,
            maximum,
            offset: (stiffness > 0.0).then(|| (maximum + minimum) / (2.0 * stiffness)),
            stiffness,
            harmonics: force.harmonics,
        })
    }
}
