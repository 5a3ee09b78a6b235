//! Values of any parameter at which a locked element begins to move: critical load with load-dependent tension, critical
//! inertia, critical speed (theory 05 §4.4, §5.2).

use super::{ClosedFormError, LockedElement};
use slackside_mechanics::{OperatingPoint, SystemFamily};

/// How far a locked element is from moving.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// Distance of the transmitted force from the limits, at its closest; negative if they are exceeded. An element with
    /// static stiffness at its port takes the offset that is best for it.
    pub margin: f64,
    /// Half the range of the transmitted force, its scale.
    pub half_range: f64,
}

/// A value of the parameter at which the element just begins to move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticalValue {
    /// The value.
    pub value: f64,
    /// Whether the element is locked for all time just above the value (and moves just below).
    pub locked_above: bool,
}

/// The margin of the element with this index.
///
/// # Errors
/// Those of [`LockedElement`].
pub fn locking_margin(point: &OperatingPoint, element: usize) -> Result<Margin, ClosedFormError> {
    let mut locked = LockedElement::new(&point.system, element)?;
    let force = locked.force(point.frequency)?;
    let (low, high) = locked.limits;
    let half_range = 0.5 * (force.dynamic.maximum - force.dynamic.minimum);
    let shifts = low.is_finite() && high.is_finite() && locked.static_stiffness(point.frequency)? > 0.0;
    let margin = if shifts {
        0.5 * (high - low) - half_range
    } else {
        let mean = locked.mean_force(point.frequency)?.unwrap_or(0.0);
        (mean + force.dynamic.minimum - low).min(high - mean - force.dynamic.maximum)
    };
    Ok(Margin { margin, half_range })
}

/// All values of the family's parameter between the first and last of `grid` (ascending) at which the element begins to move:
/// the zeros of the margin, each bracketed by two neighbours of the grid and refined to rounding. Two zeros between two
/// neighbours are not seen.
///
/// # Errors
/// Those of [`LockedElement`], and [`ClosedFormError::OutsideDomain`].
pub fn critical_values(
    family: &dyn SystemFamily,
    element: usize,
    grid: &[f64],
) -> Result<Vec<CriticalValue>, ClosedFormError> {
    let margin = |value: f64| -> Result<f64, ClosedFormError> {
        Ok(locking_margin(&family.at(value)?, element)?.margin)
    };
    let values = (grid.iter().map(|&value| margin(value))).collect::<Result<Vec<f64>, _>>()?;
    let mut found = Vec::new();
    for (ends, margins) in grid.windows(2).zip(values.windows(2)) {
        let rises = margins[0] < 0.0 && margins[1] >= 0.0;
        if rises || (margins[0] >= 0.0 && margins[1] < 0.0) {
            found.push(CriticalValue {
                value: refine(&margin, (ends[0], margins[0]), (ends[1], margins[1]))?,
                locked_above: rises,
            });
        }
    }
    Ok(found)
}

/// The zero between two ends of opposite sign, by regula falsi with halved weights (Illinois) and bisection when that is slow.
fn refine(
    margin: &dyn Fn(f64) -> Result<f64, ClosedFormError>,
    mut a: (f64, f64),
    mut b: (f64, f64),
) -> Result<f64, ClosedFormError> {
    for round in 0..200 {
        let width = (b.0 - a.0).abs();
        if width <= 4.0 * f64::EPSILON * a.0.abs().max(b.0.abs()) {
            break;
        }
        if b.1 == 0.0 {
            return Ok(b.0);
        }
        let secant = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        let inside = secant > a.0.min(b.0) && secant < a.0.max(b.0);
        let middle = if round % 8 == 7 || !inside {
            0.5 * (a.0 + b.0)
        } else {
            secant
        };
        let value = margin(middle)?;
        if value * b.1 < 0.0 {
            a = b;
        } else {
            a.1 *= 0.5;
        }
        let step = (middle - b.0).abs();
        b = (middle, value);
        if step <= 2.0 * f64::EPSILON * middle.abs() {
            break;
        }
    }
    Ok(b.0)
}
