//! Values of any parameter at which a locked element begins to move: critical load with load-dependent tension, critical
//! inertia, critical speed (theory 05 §4.4, §5.2).

use super::{ClosedFormError, LockedElement};
use slackside_mechanics::{OperatingPoint, SystemFamily};

/// A value of the parameter at which the element just begins to move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticalValue {
    /// The value.
    pub value: f64,
    /// Whether the element is locked for all time just above the value (and moves just below).
    pub locked_above: bool,
}

/// The margin by which the element with this index stays locked, see [`LockedElement::margin`].
///
/// # Errors
/// Those of [`LockedElement`].
pub fn locking_margin(point: &OperatingPoint, element: usize) -> Result<f64, ClosedFormError> {
    let mut locked = LockedElement::new(&point.system, element)?;
    let force = locked.force(point.frequency)?;
    locked.margin(&force, point.frequency)
}

/// All values of the family's parameter between the first and last of `grid` (ascending) at which the element begins to move.
/// With the load of a clutch as the parameter, on which the tension may depend, this is its critical load.
///
/// # Errors
/// Those of [`LockedElement`], and [`ClosedFormError::OutsideDomain`].
pub fn critical_values(
    family: &dyn SystemFamily,
    element: usize,
    grid: &[f64],
) -> Result<Vec<CriticalValue>, ClosedFormError> {
    zeros_of_margin(grid, &mut |value| locking_margin(&family.at(value)?, element))
}

/// All zeros of a margin between the first and last of `grid` (ascending), each bracketed by two neighbours of the grid and
/// refined to rounding. Two zeros between two neighbours are not seen.
///
/// # Errors
/// Those of the margin.
pub fn zeros_of_margin<E>(
    grid: &[f64],
    margin: &mut dyn FnMut(f64) -> Result<f64, E>,
) -> Result<Vec<CriticalValue>, E> {
    let values = (grid.iter().map(|&value| margin(value))).collect::<Result<Vec<f64>, E>>()?;
    let mut found = Vec::new();
    for (ends, margins) in grid.windows(2).zip(values.windows(2)) {
        let rises = margins[0] < 0.0 && margins[1] >= 0.0;
        if rises || (margins[0] >= 0.0 && margins[1] < 0.0) {
            found.push(CriticalValue {
                value: refine(margin, (ends[0], margins[0]), (ends[1], margins[1]))?,
                locked_above: rises,
            });
        }
    }
    Ok(found)
}

/// The zero between two ends of opposite sign, by regula falsi with halved weights (Illinois) and bisection when that is slow.
fn refine<E>(
    margin: &mut dyn FnMut(f64) -> Result<f64, E>,
    mut a: (f64, f64),
    mut b: (f64, f64),
) -> Result<f64, E> {
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
