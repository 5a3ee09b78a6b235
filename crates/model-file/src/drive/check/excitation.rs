//! Which excitations are sound.

use super::{check_length, check_list, check_number, check_speeds};
use crate::drive::{Amount, Excitation, Order};
use crate::error::Issue;
use crate::reader::Read;
use crate::scalar::{Bound, join};

impl Excitation {
    pub(super) fn check(&self) -> Read<()> {
        if !self.motion.is_empty() && !self.torque.is_empty() {
            return Err(Issue::wrong_value(
                "excitation.torque",
                "the motion of the driver is prescribed, so that no torque can change it",
            )
            .with_help("keep `motion` or `torque`"));
        }
        for (list, orders) in [("motion", &self.motion), ("torque", &self.torque)] {
            for (index, order) in orders.iter().enumerate() {
                let path = format!("excitation.{list}.{index}");
                order.check(&path)?;
                let earlier = &orders[..index];
                if let Some(first) = earlier.iter().position(|other| other.order == order.order) {
                    return Err(Issue::wrong_value(
                        join(&path, "order"),
                        format!("the order is already given by excitation.{list}.{first}"),
                    )
                    .with_number(order.order)
                    .with_help("put both into one item"));
                }
            }
        }
        Ok(())
    }
}

impl Order {
    fn check(&self, path: &str) -> Read<()> {
        check_number(|| join(path, "order"), self.order, Bound::Positive)?;
        if !self.speed.is_empty() {
            check_speeds(&join(path, "speed"), &self.speed)?;
        }
        self.check_amount(path, "amplitude", &self.amplitude, Bound::NotNegative)?;
        self.check_amount(path, "phase", &self.phase, Bound::Any)
    }

    fn check_amount(&self, path: &str, key: &str, amount: &Amount, bound: Bound) -> Read<()> {
        let path = join(path, key);
        match amount {
            Amount::Constant(value) => check_number(|| path, *value, bound),
            Amount::Each(values) => {
                check_list(&path, values, bound)?;
                if self.speed.is_empty() {
                    return Err(
                        Issue::wrong_value(path, "a list belongs to speeds, and there are none").with_help(
                            "add `speed = [\"1000 rpm\", …]` with as many values, or give one value",
                        ),
                    );
                }
                check_length(&path, values.len(), self.speed.len())
            }
        }
    }
}
