//! The critical load of a one-way clutch (theory 05 (4.1)).

use super::{ClosedFormError, LockedElement};
use slackside_linalg::Complex;
use slackside_mechanics::OperatingPoint;

/// The mean torque above which a one-way clutch never opens.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalLoad {
    /// Critical mean torque `M_cr = −min g_dyn`: the clutch never opens iff it transmits at least this in the mean.
    pub critical: f64,
    /// The mean torque that it transmits while locked under the load as it is; `None` if the load leaves it open.
    pub mean: Option<f64>,
    /// Angle `Ωt` at which the clutch opens first.
    pub opens_at: f64,
    /// Order and amplitude of the torque's harmonics in the locked clutch.
    pub harmonics: Vec<(usize, Complex)>,
}

impl CriticalLoad {
    /// Factor of the excitation at which the clutch begins to open, `A_cr/A = M_l/M_cr`.
    pub fn amplitude_factor(&self) -> Option<f64> {
        self.mean.map(|mean| mean / self.critical)
    }
}

/// The critical load of the one-way clutch with this index, the only nonlinear element of the system.
///
/// # Errors
/// [`ClosedFormError::OtherKind`] if the element holds both ways, and those of [`LockedElement`].
pub fn critical_load(point: &OperatingPoint, element: usize) -> Result<CriticalLoad, ClosedFormError> {
    LockedElement::new(&point.system, element)?.critical_load(point.frequency)
}

impl LockedElement {
    /// The critical load under a load of frequency `Ω` (theory 05 (4.1)). A clutch that drives with negative force is
    /// measured by its amount.
    ///
    /// # Errors
    /// [`ClosedFormError::OtherKind`] for an element that holds both ways, and those of [`LockedElement::force`].
    pub fn critical_load(&mut self, frequency: f64) -> Result<CriticalLoad, ClosedFormError> {
        let sign = match self.limits {
            (low, f64::INFINITY) if low.is_finite() => 1.0,
            (f64::NEG_INFINITY, high) if high.is_finite() => -1.0,
            _ => {
                return Err(ClosedFormError::OtherKind {
                    element: self.name.clone(),
                    kind: self.kind,
                    wanted: "one-way clutch",
                });
            }
        };
        let force = self.force(frequency)?;
        let mean = self.mean_force(frequency)?;
        let threshold = if sign > 0.0 { self.limits.0 } else { self.limits.1 };
        let (critical, opens_at) = if sign > 0.0 {
            (-force.dynamic.minimum, force.dynamic.minimum_at)
        } else {
            (force.dynamic.maximum, force.dynamic.maximum_at)
        };
        Ok(CriticalLoad {
            critical,
            mean: mean.map(|mean| sign * (mean - threshold)),
            opens_at,
            harmonics: force.harmonics,
        })
    }

    /// Derivative of the critical load with respect to the inertia of a coordinate. With `J_a = α J_p` and `J_p` fixed,
    /// `dM_cr/dα = J_p · dM_cr/dJ_a` (theory 05 §4.4).
    ///
    /// # Errors
    /// Those of [`LockedElement::critical_load`].
    pub fn critical_load_by_inertia(
        &mut self,
        coordinate: usize,
        frequency: f64,
    ) -> Result<f64, ClosedFormError> {
        let load = self.critical_load(frequency)?;
        let rates = self.force_rates_by_inertia(coordinate, frequency)?;
        // The place of the minimum moves, but the function is stationary there.
        let rate: f64 = (load.harmonics.iter().zip(rates))
            .map(|((order, _), rate)| (rate * Complex::cis(*order as f64 * load.opens_at)).re)
            .sum();
        Ok(if self.limits.0.is_finite() { -rate } else { rate })
    }
}
