//! Which belts are sound.

use std::f64::consts::PI;

use super::{check_list, check_number};
use crate::drive::{
    Belt, BeltDamping, BeltModel, Drive, Friction, Installation, Length, ModalDamping, ModesPerSpan, Section,
};
use crate::error::{Issue, Problem};
use crate::reader::Read;
use crate::scalar::{Bound, Scalars, join};

/// Most terms of a span; the matrices are dense, and hundreds of terms already take minutes.
const MOST_TERMS: usize = 1000;

impl Belt {
    pub(super) fn check(&self, path: &str, spans: usize) -> Read<()> {
        self.check_scalars(path)?;
        self.check_section(path)?;
        self.check_terms(&join(path, "modes_per_span"), spans)?;
        match &self.length {
            Length::NaturalLength(length) => {
                check_number(|| join(path, "natural_length"), *length, Bound::Positive)?;
            }
            Length::EffectiveLength(length) => {
                check_number(|| join(path, "effective_length"), *length, Bound::Positive)?;
                if self.cord_offset_ribs.is_none() {
                    return Err(Issue::wrong_value(
                        join(path, "effective_length"),
                        "the length along the cord line follows only with belt.cord_offset_ribs",
                    )
                    .with_number(*length)
                    .with_help(
                        "add `cord_offset_ribs = \"…\"` to [belt] (about 1 mm for PK belts), or give `natural_length`",
                    ));
                }
            }
            Length::Installation(Installation::Tension(state)) => {
                check_number(
                    || join(path, "installation.tension"),
                    state.tension,
                    Bound::Positive,
                )?;
            }
            Length::Installation(Installation::OperatingPosition(state)) => {
                if !state.operating_position {
                    return Err(Issue::wrong_value(
                        join(path, "installation.operating_position"),
                        "then nothing says how long the belt is",
                    )
                    .with_value(false)
                    .with_help("write true, or give a tension or a length"));
                }
            }
        }
        if let Some(tension) = self.measuring_tension
            && !matches!(self.length, Length::EffectiveLength(_))
        {
            return Err(Issue::wrong_value(
                join(path, "measuring_tension"),
                "belongs to an effective length, and the belt has none",
            )
            .with_number(tension)
            .with_help("remove it, or give `effective_length`"));
        }
        self.check_friction(&join(path, "friction"))?;
        self.damping.check(&join(path, "damping"))
    }

    fn check_section(&self, path: &str) -> Read<()> {
        let (section, section_path) = match &self.section {
            Section::Whole(section) => (section, path.to_owned()),
            Section::PerRib(section) => {
                if self.ribs.is_none() {
                    return Err(Issue::new(
                        Problem::MissingKey,
                        join(path, "ribs"),
                        "is missing: the belt is described per rib",
                    )
                    .with_help("add a line such as `ribs = 6`"));
                }
                (&section.per_rib, join(path, "per_rib"))
            }
        };
        if self.ribs == Some(0) {
            return Err(
                Issue::wrong_value(join(path, "ribs"), "a belt has at least one rib")
                    .with_value(0)
                    .with_help("give the number of ribs, for example 6"),
            );
        }
        section.check_scalars(&section_path)?;
        if self.model == BeltModel::Beam && section.bending_stiffness == 0.0 {
            return Err(Issue::wrong_value(
                join(&section_path, "bending_stiffness"),
                "spans that are beams need a bending stiffness",
            )
            .with_value(section.bending_stiffness)
            .with_help(
                "give the bending stiffness, for example \"0.015 N m^2\", or write `model = \"string\"`",
            ));
        }
        Ok(())
    }

    fn check_terms(&self, path: &str, spans: usize) -> Read<()> {
        let check = |path: &str, terms: usize| {
            if (1..=MOST_TERMS).contains(&terms) {
                return Ok(());
            }
            Err(
                Issue::wrong_value(path, format!("a span has from 1 to {MOST_TERMS} sine terms"))
                    .with_value(terms)
                    .with_help("5 to 20 suffice; for spans that do not vibrate write `model = \"spring\"`"),
            )
        };
        match &self.modes_per_span {
            ModesPerSpan::Common(terms) => check(path, *terms),
            ModesPerSpan::Each(list) => {
                if list.len() != spans {
                    return Err(Issue::wrong_value(
                        path,
                        format!("{} numbers for {spans} spans", list.len()),
                    )
                    .with_help("give one number, or one for each pulley: of the span that starts there"));
                }
                list.iter()
                    .enumerate()
                    .try_for_each(|(index, terms)| check(&join(path, &index.to_string()), *terms))
            }
        }
    }

    fn check_friction(&self, path: &str) -> Read<()> {
        match &self.friction {
            None => Ok(()),
            Some(Friction::Effective(coefficient)) => {
                check_number(|| path.to_owned(), *coefficient, Bound::Positive)
            }
            Some(Friction::Grooved(friction)) => {
                friction.check_scalars(path)?;
                if friction.groove_angle > PI {
                    return Err(Issue::wrong_value(
                        join(path, "groove_angle"),
                        "a groove opens by less than 180 degrees",
                    )
                    .with_number(friction.groove_angle)
                    .with_help("give the full angle between its flanks, 40 deg for PK ribs"));
                }
                Ok(())
            }
        }
    }
}

impl BeltDamping {
    fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        if let Some(rayleigh) = &self.rayleigh {
            rayleigh.check_scalars(&join(path, "rayleigh"))?;
        }
        let modal = join(path, "modal");
        match &self.modal {
            None => Ok(()),
            Some(ModalDamping::Common(ratio)) => check_number(|| modal, *ratio, Bound::NotNegative),
            Some(ModalDamping::Each(ratios)) if ratios.is_empty() => {
                Err(Issue::wrong_value(modal, "the list of damping ratios is empty")
                    .with_value("[]")
                    .with_help("give one ratio, or a list from the lowest mode upwards"))
            }
            Some(ModalDamping::Each(ratios)) => check_list(&modal, ratios, Bound::NotNegative),
        }
    }
}

impl Drive {
    /// Everything but a tension at rest needs the preload of the springs (theory 04 §2.5).
    pub(super) fn check_installation(&self) -> Read<()> {
        let needs = match &self.belt.length {
            Length::Installation(Installation::Tension(_)) => return Ok(()),
            Length::Installation(Installation::OperatingPosition(_)) => {
                if self.tensioners.iter().all(|tensioner| tensioner.locked) {
                    return Err(Issue::wrong_value(
                        "belt.installation",
                        "the position at the operating point fixes the tension only through a tensioner that can move",
                    )
                    .with_help("write `installation = { tension = \"300 N\" }`, or give a length"));
                }
                "belt.installation = { operating_position = true }"
            }
            Length::NaturalLength(_) => "belt.natural_length",
            Length::EffectiveLength(_) => "belt.effective_length",
        };
        let without = self.tensioners.iter().find(|tensioner| {
            !tensioner.locked
                && tensioner
                    .spring
                    .as_ref()
                    .is_some_and(|spring| spring.preload.is_none())
        });
        match without {
            None => Ok(()),
            Some(tensioner) => Err(Issue::new(
                Problem::MissingKey,
                format!("tensioner.{}.spring.preload", tensioner.name),
                format!("is missing: with {needs} it does not follow from the installation"),
            )
            .with_help(
                "add the torque of the spring at the reference position, positive where it tightens the belt, or write \
                 `installation = { tension = \"300 N\" }`",
            )),
        }
    }
}
