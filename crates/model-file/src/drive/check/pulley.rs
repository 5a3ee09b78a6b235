//! Which pulleys, loads and couplings are sound.

use super::{check_length, check_list, check_number, check_speeds};
use crate::drive::{Carried, Coupling, CouplingKind, Guide, Load, LoadTable, Mount, Power, Pulley};
use crate::error::{Issue, Problem};
use crate::reader::Read;
use crate::scalar::{Bound, Scalars, join};

impl Pulley {
    pub(super) fn check(&self) -> Read<()> {
        let path = join("pulley", &self.name);
        self.check_scalars(&path)?;
        check_number(
            || join(&path, self.size.key()),
            self.size.value(),
            Bound::Positive,
        )?;
        match &self.mount {
            Mount::Fixed(fixed) => check_list(&join(&path, "center"), &fixed.center, Bound::Any)?,
            Mount::Carried(carried) => carried.check_scalars(&path)?,
        }
        self.load.check(&join(&path, "load"))?;
        if self.driver && !self.load.is_zero() {
            return Err(Issue::wrong_value(
                join(&path, "load"),
                "the driver has no load of its own: its torque follows from the others",
            )
            .with_help("remove it, or put it on the accessory that takes it"));
        }
        match &self.coupling {
            None => Ok(()),
            Some(coupling) => {
                let path = join(&path, "coupling");
                if self.driver && coupling.kind != CouplingKind::Rigid {
                    return Err(Issue::wrong_value(
                        join(&path, "kind"),
                        "a coupling is between a driven pulley and its accessory, and this pulley is the driver",
                    )
                    .with_value(format!("\"{}\"", coupling.kind.word()))
                    .with_help("remove it, and shake the pulley by [excitation]"));
                }
                coupling.check(&path)
            }
        }
    }
}

impl Carried {
    /// Checks the place on a tensioner that is known.
    pub(super) fn check(&self, path: &str, guide: &Guide) -> Read<()> {
        let misplaced = |key: &str, message: &str, help: &str| {
            Err(Issue::wrong_value(join(path, key), message).with_help(help))
        };
        match guide {
            Guide::Rotary(rotary) => {
                if self.offset.is_some() {
                    return misplaced(
                        "offset",
                        "an offset belongs to a linear tensioner, and this arm is rotary",
                        "give `arm_length` and `arm_angle_offset`",
                    );
                }
                if self.arm_length.or(rotary.arm_length).is_none() {
                    return Err(Issue::new(
                        Problem::MissingKey,
                        format!("tensioner.{}.arm_length", self.arm),
                        "is missing",
                    )
                    .with_help("add the distance from the pivot to the centre of the pulley, such as `arm_length = \"97.1 mm\"`"));
                }
                Ok(())
            }
            Guide::Linear(_) => {
                let why = "belongs to a rotary arm, and this tensioner is linear";
                let help = "give `offset = [x, y]` from the point of the tensioner";
                if self.arm_length.is_some() {
                    return misplaced("arm_length", why, help);
                }
                if self.arm_angle_offset.is_some() {
                    return misplaced("arm_angle_offset", why, help);
                }
                match &self.offset {
                    Some(offset) => check_list(&join(path, "offset"), offset, Bound::Any),
                    None => Ok(()),
                }
            }
        }
    }
}

impl Load {
    fn check(&self, path: &str) -> Read<()> {
        match self {
            Self::Torque(value) | Self::Power(Power { power: value }) => {
                check_number(|| path.to_owned(), *value, Bound::Any)
            }
            Self::Table(table) => table.check(path),
        }
    }
}

impl LoadTable {
    fn check(&self, path: &str) -> Read<()> {
        check_speeds(&join(path, "speed"), &self.speed)?;
        for (key, values) in [("torque", &self.torque), ("power", &self.power)] {
            if let Some(values) = values {
                let path = join(path, key);
                check_list(&path, values, Bound::Any)?;
                check_length(&path, values.len(), self.speed.len())?;
            }
        }
        Ok(())
    }
}

impl Coupling {
    fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        let missing = |key: &str, what: &str, example: &str| {
            Err(Issue::new(
                Problem::MissingKey,
                join(path, key),
                format!(
                    "is missing: a coupling of kind \"{}\" has {what}",
                    self.kind.word()
                ),
            )
            .with_help(format!("add a line such as `{key} = \"{example}\"`")))
        };
        if self.kind.is_flexible() && self.stiffness.is_none() {
            return missing("stiffness", "a spring", "20 N m/rad");
        }
        if self.kind != CouplingKind::Rigid && self.accessory_inertia == 0.0 {
            return missing("accessory_inertia", "an accessory behind it", "3e-3 kg m^2");
        }
        Ok(())
    }
}
