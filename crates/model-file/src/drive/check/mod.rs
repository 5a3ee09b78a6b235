//! Which numbers and names make a sound drive. Whether a belt can run round the pulleys is found when the drive is laid
//! out, because it takes the mechanics to tell.

mod belt;
mod excitation;
mod friction;
mod pulley;
mod tensioner;

use super::{Condition, Contact, Drive, Mount, Size};
use crate::error::{Issue, Problem};
use crate::names::check_item_names;
use crate::nearest::{enumerate, nearest};
use crate::reader::Read;
use crate::scalar::{Bound, Scalars, join};

impl Drive {
    pub(crate) fn check(&self) -> Read<()> {
        check_item_names("pulley", self.pulleys.iter().map(|pulley| &*pulley.name))?;
        check_item_names(
            "tensioner",
            self.tensioners.iter().map(|tensioner| &*tensioner.name),
        )?;
        check_item_names(
            "condition",
            self.conditions.iter().map(|condition| &*condition.name),
        )?;
        if self.pulleys.len() < 2 {
            return Err(Issue::new(
                Problem::MissingKey,
                "pulley",
                format!(
                    "a drive has at least two pulleys, and this one has {}",
                    self.pulleys.len()
                ),
            )
            .with_help("add a [[pulley]] for each, in the order in which the belt meets them"));
        }
        self.check_driver()?;
        self.belt.check("belt", self.pulleys.len())?;
        self.check_installation()?;
        for pulley in &self.pulleys {
            pulley.check()?;
            self.check_size(pulley)?;
            self.check_mount(pulley)?;
        }
        for tensioner in &self.tensioners {
            tensioner.check()?;
            self.check_carries(tensioner)?;
            self.check_pulley_contacts(tensioner)?;
        }
        self.operating.check_scalars("operating")?;
        self.excitation.check()?;
        self.check_loss_factor()?;
        self.conditions.iter().try_for_each(Condition::check)
    }

    fn check_driver(&self) -> Read<()> {
        let drivers: Vec<&str> = self
            .pulleys
            .iter()
            .filter(|pulley| pulley.driver)
            .map(|pulley| &*pulley.name)
            .collect();
        match drivers.as_slice() {
            [_] => Ok(()),
            [] => Err(
                Issue::new(Problem::MissingKey, "pulley", "no pulley drives the belt")
                    .with_help("add `driver = true` to the crank pulley"),
            ),
            [first, second, ..] => Err(Issue::wrong_value(
                format!("pulley.{second}.driver"),
                format!("both \"{first}\" and \"{second}\" drive the belt"),
            )
            .with_value(true)
            .with_help("keep `driver = true` at one pulley; another one that pushes has a negative load")),
        }
    }

    /// The pitch radius needs the cord offset of the side that touches, except if it is given itself.
    fn check_size(&self, pulley: &super::Pulley) -> Read<()> {
        let path = || format!("pulley.{}.{}", pulley.name, pulley.size.key());
        let (key, offset) = match (pulley.size, pulley.contact) {
            (Size::Radius(_), _) => return Ok(()),
            (Size::EffectiveDiameter(_), Contact::Back) => {
                return Err(Issue::wrong_value(
                    path(),
                    "an effective diameter belongs to ribs, and the back of the belt touches this pulley",
                )
                .with_number(pulley.size.value())
                .with_help("give `outside_diameter` or `radius`"));
            }
            (_, Contact::Ribs) => ("cord_offset_ribs", self.belt.cord_offset_ribs),
            (_, Contact::Back) => ("cord_offset_back", self.belt.cord_offset_back),
        };
        match pulley.cord_offset.or(offset) {
            Some(_) => Ok(()),
            None => Err(Issue::wrong_value(
                path(),
                format!("the pitch radius follows only with belt.{key}, the distance of the cord line"),
            )
            .with_number(pulley.size.value())
            .with_help(format!(
                "add `{key} = \"…\"` to [belt] (about 1 mm for PK belts), or give the pitch radius as `radius`"
            ))),
        }
    }

    fn check_mount(&self, pulley: &super::Pulley) -> Read<()> {
        let Mount::Carried(carried) = &pulley.mount else {
            return Ok(());
        };
        let path = format!("pulley.{}", pulley.name);
        let Some(tensioner) = self
            .tensioners
            .iter()
            .find(|tensioner| tensioner.name == carried.arm)
        else {
            let names = || self.tensioners.iter().map(|tensioner| &*tensioner.name);
            let help = match nearest(&carried.arm, names()) {
                Some(meant) => format!("did you mean \"{meant}\"?"),
                None if self.tensioners.is_empty() => {
                    format!("add a [[tensioner]] with `name = \"{}\"`", carried.arm)
                }
                None => format!("the tensioners are {}", enumerate(names())),
            };
            return Err(
                Issue::wrong_value(join(&path, "arm"), "there is no such tensioner")
                    .with_value(format!("\"{}\"", carried.arm))
                    .with_help(help),
            );
        };
        carried.check(&path, &tensioner.guide)
    }

    fn check_carries(&self, tensioner: &super::Tensioner) -> Read<()> {
        let carries = |pulley: &super::Pulley| matches!(&pulley.mount, Mount::Carried(carried) if carried.arm == tensioner.name);
        if self.pulleys.iter().any(carries) {
            return Ok(());
        }
        Err(Issue::wrong_value(
            format!("tensioner.{}", tensioner.name),
            "the tensioner carries no pulley",
        )
        .with_help(format!(
            "give a pulley `arm = \"{}\"` in place of `center`",
            tensioner.name
        )))
    }

    fn check_loss_factor(&self) -> Read<()> {
        let damping = &self.belt.damping;
        let Some(loss_factor) = damping.loss_factor else {
            return Ok(());
        };
        if loss_factor == 0.0 || self.loss_factor_frequency().is_some() {
            return Ok(());
        }
        Err(Issue::wrong_value(
            "belt.damping.loss_factor",
            "a loss factor holds at one frequency, and there is no excitation at a speed above zero that would say which",
        )
        .with_number(loss_factor)
        .with_help("add `reference_frequency = \"100 Hz\"` beside it"))
    }

    /// Angular frequency at which the dashpots of the spans have the loss factor.
    pub(super) fn loss_factor_frequency(&self) -> Option<f64> {
        self.belt.damping.reference_frequency.or_else(|| {
            let frequency = self.excitation.lowest_order()? * self.operating.speed;
            Some(frequency).filter(|frequency| *frequency > 0.0)
        })
    }
}

impl Condition {
    fn check(&self) -> Read<()> {
        let path = format!("condition.{}", self.name);
        self.check_scalars(&path)?;
        if self.elongation <= -1.0 {
            return Err(Issue::wrong_value(
                join(&path, "elongation"),
                "an elongation is a strain: minus one would leave no belt",
            )
            .with_number(self.elongation)
            .with_help("give a strain such as 0.003 or \"0.3 %\""));
        }
        Ok(())
    }
}

/// Checks one number.
fn check_number(path: impl FnOnce() -> String, value: f64, bound: Bound) -> Read<()> {
    match bound.complaint(value) {
        None => Ok(()),
        Some((message, help)) => Err(Issue::wrong_value(path(), message)
            .with_number(value)
            .with_help(help)),
    }
}

/// Checks the numbers of a list.
fn check_list(path: &str, values: &[f64], bound: Bound) -> Read<()> {
    values
        .iter()
        .enumerate()
        .try_for_each(|(index, value)| check_number(|| join(path, &index.to_string()), *value, bound))
}

/// Checks the speeds of a table: there are some, and they ascend.
fn check_speeds(path: &str, speeds: &[f64]) -> Read<()> {
    if speeds.is_empty() {
        return Err(Issue::wrong_value(path, "the table is empty")
            .with_value("[]")
            .with_help("give at least one speed"));
    }
    check_list(path, speeds, Bound::NotNegative)?;
    match speeds.windows(2).position(|pair| pair[0] >= pair[1]) {
        None => Ok(()),
        Some(index) => Err(Issue::wrong_value(
            join(path, &(index + 1).to_string()),
            "the speeds of a table ascend, and this one is not above the one before",
        )
        .with_number(speeds[index + 1])
        .with_help("sort the table by speed")),
    }
}

/// Checks that a list of a table has one value for each speed.
fn check_length(path: &str, found: usize, speeds: usize) -> Read<()> {
    if found == speeds {
        return Ok(());
    }
    let values = if found == 1 { "value" } else { "values" };
    let for_speeds = if speeds == 1 { "speed" } else { "speeds" };
    Err(
        Issue::wrong_value(path, format!("{found} {values} for {speeds} {for_speeds}"))
            .with_help("give one value for each speed"),
    )
}
