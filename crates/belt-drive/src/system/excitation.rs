//! Engine orders as harmonics of one fundamental.

use super::DriveSystemError;
use crate::drive::Excitation;
use slackside_linalg::Complex;

/// Most revolutions of the driver after which the excitation must repeat.
const MOST_REVOLUTIONS: usize = 24;
/// How close to a whole number a multiple of an order must come.
const WHOLE: f64 = 1e-9;

/// The largest order of which all orders of an excitation are multiples.
#[derive(Debug, Clone, PartialEq)]
pub struct CommonOrder {
    /// The common order; its multiple of the driver's speed is the fundamental frequency.
    pub order: f64,
    /// What multiple each order is.
    pub multiples: Vec<usize>,
}

impl CommonOrder {
    /// The common order of an excitation; 1 if there is none.
    ///
    /// # Errors
    /// [`DriveSystemError::NoCommonOrder`] if the orders do not repeat together within 24 revolutions.
    pub fn of(excitation: &Excitation) -> Result<Self, DriveSystemError> {
        let orders: Vec<f64> = excitation.orders().iter().map(|order| order.order).collect();
        if orders.is_empty() {
            return Ok(Self {
                order: 1.0,
                multiples: Vec::new(),
            });
        }
        (1..=MOST_REVOLUTIONS)
            .find_map(|revolutions| cycles(&orders, revolutions).map(|cycles| (revolutions, cycles)))
            .map(|(revolutions, cycles)| {
                let divisor = cycles.iter().copied().fold(0, common_divisor);
                Self {
                    order: divisor as f64 / revolutions as f64,
                    multiples: cycles.iter().map(|count| count / divisor).collect(),
                }
            })
            .ok_or(DriveSystemError::NoCommonOrder {
                orders,
                revolutions: MOST_REVOLUTIONS,
            })
    }
}

/// Whole cycles of every order in so many revolutions, if they are whole.
fn cycles(orders: &[f64], revolutions: usize) -> Option<Vec<usize>> {
    orders
        .iter()
        .map(|order| {
            let turns = order * revolutions as f64;
            let whole = turns.round();
            // Orders are positive and far below the range of whole numbers; a saturated one would not be close.
            ((turns - whole).abs() <= WHOLE * whole && whole >= 1.0).then_some(whole as usize)
        })
        .collect()
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// Harmonic and complex amplitude `A e^{iφ}` of every order at a driver speed.
pub(super) fn loads(
    excitation: &Excitation,
    common: &CommonOrder,
    driver_speed: f64,
) -> Vec<(usize, Complex)> {
    common
        .multiples
        .iter()
        .zip(excitation.orders())
        .map(|(multiple, order)| {
            let (amplitude, phase) = order.at(driver_speed);
            (*multiple, Complex::from_polar(amplitude, phase))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::{OrderAmplitude, OrderTable};

    fn common(orders: &[f64]) -> Result<CommonOrder, DriveSystemError> {
        let of = |order: &f64| OrderAmplitude {
            order: *order,
            table: OrderTable::Constant {
                amplitude: 1.0,
                phase: 0.0,
            },
        };
        CommonOrder::of(&Excitation::Motion(orders.iter().map(of).collect()))
    }

    #[test]
    fn orders_are_multiples_of_their_greatest_common_divisor() {
        for (orders, order, multiples) in [
            (vec![2.0], 2.0, vec![1]),
            (vec![2.0, 4.0, 6.0], 2.0, vec![1, 2, 3]),
            (vec![0.5, 1.5, 2.0], 0.5, vec![1, 3, 4]),
            (vec![1.5, 3.0], 1.5, vec![1, 2]),
            (vec![2.0 / 3.0, 2.0], 2.0 / 3.0, vec![1, 3]),
            (vec![3.0, 2.0], 1.0, vec![3, 2]),
        ] {
            let found = common(&orders).unwrap();
            assert!((found.order - order).abs() < 1e-12, "{orders:?}: {}", found.order);
            assert_eq!(found.multiples, multiples);
        }
        assert_eq!(CommonOrder::of(&Excitation::None).unwrap().order, 1.0);
    }

    #[test]
    fn orders_without_a_common_period_are_refused() {
        assert!(matches!(
            common(&[2.0, 2.0_f64.sqrt()]),
            Err(DriveSystemError::NoCommonOrder { revolutions: 24, .. })
        ));
    }
}
