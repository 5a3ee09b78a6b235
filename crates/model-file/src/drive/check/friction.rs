//! Which frictions and contacts of a tensioner are sound.

use super::{check_list, check_number};
use crate::drive::{
    Drive, DryFriction, FrictionLaw, MeasuredLoop, Mount, PulleyContact, StopContact, Tensioner,
};
use crate::error::{Issue, Problem};
use crate::nearest::{enumerate, nearest};
use crate::reader::Read;
use crate::scalar::{Bound, Scalars, join};

impl DryFriction {
    pub(super) fn check(&self, path: &str, is_rotary: bool) -> Read<()> {
        self.check_scalars(path)?;
        let (right, wrong, wrong_value) = if is_rotary {
            ("torque", "force", self.force)
        } else {
            ("force", "torque", self.torque)
        };
        if let Some(value) = wrong_value {
            let kind = if is_rotary { "rotary" } else { "linear" };
            return Err(Issue::wrong_value(
                join(path, wrong),
                format!("the friction of a {kind} tensioner is a {right}"),
            )
            .with_number(value)
            .with_help(format!("write `{right} = …`")));
        }
        match self.law {
            FrictionLaw::Coulomb => self.check_coulomb(path, right)?,
            FrictionLaw::SpringSlider | FrictionLaw::Dahl | FrictionLaw::Lugre => {
                if self.torque.or(self.force).is_none() {
                    return Err(missing(path, right, "the friction of steady sliding"));
                }
                if self.stiffness.is_none() {
                    return Err(missing(
                        path,
                        "stiffness",
                        "how the tensioner gives before it slides",
                    ));
                }
                if self.law == FrictionLaw::Lugre && self.stribeck_velocity.is_none() {
                    let what = "the velocity over which friction falls from that at rest";
                    return Err(missing(path, "stribeck_velocity", what));
                }
            }
            FrictionLaw::MeasuredLoop => match &self.measured {
                Some(measured) => measured.check(&join(path, "loop"))?,
                None => return Err(missing(path, "loop", "the measured torques")),
            },
        }
        if self.static_ratio < 1.0 {
            return Err(Issue::wrong_value(
                join(path, "static_ratio"),
                "friction at rest is not below that in motion",
            )
            .with_number(self.static_ratio)
            .with_help("give a ratio of at least 1"));
        }
        Ok(())
    }

    fn check_coulomb(&self, path: &str, right: &str) -> Read<()> {
        let symmetric = self.torque.or(self.force);
        match (symmetric, self.loading, self.unloading) {
            (Some(_), None, None) | (None, Some(_), Some(_)) => Ok(()),
            (Some(_), _, _) => Err(Issue::wrong_value(
                join(path, right),
                "the friction is given both for all directions and for one of them",
            )
            .with_help(format!("keep `{right}`, or keep `loading` and `unloading`"))),
            (None, None, None) => Err(Issue::new(
                Problem::MissingKey,
                join(path, right),
                "nothing says how large the friction is",
            )
            .with_help(format!("add `{right}`, or `loading` and `unloading`"))),
            (None, loading, _) => {
                let missing = if loading.is_some() { "unloading" } else { "loading" };
                Err(
                    Issue::new(Problem::MissingKey, join(path, missing), "is missing").with_help(format!(
                        "friction that depends on the direction has `loading` and `unloading`; for one value write `{right}`"
                    )),
                )
            }
        }
    }
}

fn missing(path: &str, key: &str, what: &str) -> Box<Issue> {
    Issue::new(Problem::MissingKey, join(path, key), "is missing").with_help(format!("add `{key}`: {what}"))
}

impl MeasuredLoop {
    fn check(&self, path: &str) -> Read<()> {
        check_list(&join(path, "position"), &self.position, Bound::Any)?;
        if self.position.len() < 2 {
            return Err(
                Issue::wrong_value(join(path, "position"), "a loop has at least two positions")
                    .with_help("give the ends of the stroke, and positions in between"),
            );
        }
        if let Some(index) = self.position.windows(2).position(|pair| pair[0] >= pair[1]) {
            return Err(Issue::wrong_value(
                join(path, &format!("position.{}", index + 1)),
                "the positions of a loop ascend, and this one is not above the one before",
            )
            .with_number(self.position[index + 1])
            .with_help("sort the loop by position"));
        }
        for (key, values) in [("loading", &self.loading), ("unloading", &self.unloading)] {
            let path = join(path, key);
            check_list(&path, values, Bound::Any)?;
            if values.len() != self.position.len() {
                return Err(Issue::wrong_value(
                    path,
                    format!("{} values for {} positions", values.len(), self.position.len()),
                )
                .with_help("give one value for each position"));
            }
        }
        match self.loading.iter().zip(&self.unloading).position(|(a, b)| a < b) {
            None => Ok(()),
            Some(index) => Err(Issue::wrong_value(
                join(path, &format!("loading.{index}")),
                "the torque while loading is below that while unloading: friction would drive the tensioner",
            )
            .with_number(self.loading[index])
            .with_help("exchange `loading` and `unloading`, or correct the values")),
        }
    }
}

impl StopContact {
    pub(super) fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        match (self.restitution, self.stiffness, self.damping) {
            (Some(_), None, None) | (None, Some(_), _) => Ok(()),
            (Some(value), _, _) => Err(Issue::wrong_value(
                join(path, "restitution"),
                "a contact is either rigid, with a restitution, or compliant, with a stiffness",
            )
            .with_number(value)
            .with_help("keep `restitution`, or keep `stiffness` and `damping`")),
            (None, None, _) => Err(Issue::new(
                Problem::MissingKey,
                join(path, "stiffness"),
                "nothing says what happens at the contact",
            )
            .with_help("add `restitution = 0.5` for a rigid contact, or `stiffness` for a compliant one")),
        }
    }
}

impl Drive {
    /// Checks what a tensioner may touch: a pulley that it does not carry, by one that it carries.
    pub(super) fn check_pulley_contacts(&self, tensioner: &Tensioner) -> Read<()> {
        for (index, contact) in tensioner.pulley_contacts.iter().enumerate() {
            let path = format!("tensioner.{}.pulley_contact.{index}", tensioner.name);
            self.check_pulley_contact(tensioner, contact, &path)?;
        }
        Ok(())
    }

    fn check_pulley_contact(&self, tensioner: &Tensioner, contact: &PulleyContact, path: &str) -> Read<()> {
        check_number(
            || join(path, "belt_thickness"),
            contact.belt_thickness,
            Bound::Any,
        )?;
        contact.contact().check(path)?;
        let carried: Vec<&str> = self.carried_names(&tensioner.name).collect();
        let others = || {
            let all = self.pulleys.iter().map(|pulley| &*pulley.name);
            all.filter(|name| !carried.contains(name))
        };
        if !others().any(|name| name == contact.pulley) {
            let help = match nearest(&contact.pulley, others()) {
                Some(meant) => format!("did you mean \"{meant}\"?"),
                None => format!("it may touch {}", enumerate(others())),
            };
            return Err(Issue::wrong_value(
                join(path, "pulley"),
                "there is no such pulley that the tensioner does not carry",
            )
            .with_value(format!("\"{}\"", contact.pulley))
            .with_help(help));
        }
        match (&contact.carried, carried.len()) {
            (Some(name), _) if !carried.contains(&&**name) => Err(Issue::wrong_value(
                join(path, "carried"),
                "the tensioner carries no such pulley",
            )
            .with_value(format!("\"{name}\""))
            .with_help(format!("it carries {}", enumerate(carried.iter().copied())))),
            (None, 2..) => Err(Issue::new(
                Problem::MissingKey,
                join(path, "carried"),
                "the tensioner carries several pulleys, and nothing says which one touches",
            )
            .with_help(format!(
                "add `carried`, one of {}",
                enumerate(carried.iter().copied())
            ))),
            _ => Ok(()),
        }
    }

    /// Names of the pulleys that a tensioner carries.
    pub(in crate::drive) fn carried_names<'a>(&'a self, tensioner: &'a str) -> impl Iterator<Item = &'a str> {
        self.pulleys
            .iter()
            .filter(
                move |pulley| matches!(&pulley.mount, Mount::Carried(carried) if carried.arm == tensioner),
            )
            .map(|pulley| &*pulley.name)
    }
}
