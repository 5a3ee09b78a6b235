//! Which tensioners are sound.

use super::{check_list, check_number};
use crate::drive::{Direction, Guide, Linear, Tensioner};
use crate::error::{Issue, Problem};
use crate::reader::Read;
use crate::scalar::{Bound, Scalars, join};

impl Tensioner {
    pub(super) fn check(&self) -> Read<()> {
        let path = join("tensioner", &self.name);
        self.check_scalars(&path)?;
        match &self.guide {
            Guide::Rotary(rotary) => {
                check_list(&join(&path, "pivot"), &rotary.pivot, Bound::Any)?;
                rotary.check_scalars(&path)?;
            }
            Guide::Linear(linear) => linear.check(&path)?,
        }
        match &self.spring {
            Some(spring) => spring.check_scalars(&join(&path, "spring"))?,
            None if self.locked => {}
            None => {
                return Err(
                    Issue::new(Problem::MissingKey, join(&path, "spring"), "is missing").with_help(
                        "add a line such as `spring = { rate = \"54 N m/rad\" }`, or `locked = true` for a tensioner that \
                         is held where it stands",
                    ),
                );
            }
        }
        if let Some(friction) = &self.friction {
            friction.check(&join(&path, "friction"), matches!(self.guide, Guide::Rotary(_)))?;
        }
        if let Some(stops) = &self.stops {
            self.check_stops(&path, stops)?;
        }
        match &self.stop_contact {
            Some(contact) => contact.check(&join(&path, "stop_contact")),
            None => Ok(()),
        }
    }

    fn check_stops(&self, path: &str, stops: &[f64; 2]) -> Read<()> {
        let stops_path = join(path, "stops");
        check_list(&stops_path, stops, Bound::Any)?;
        let [least, greatest] = *stops;
        if least >= greatest {
            return Err(Issue::wrong_value(
                stops_path,
                "the second stop is not above the first: stops are the smallest and the largest position",
            )
            .with_value(format!("[{least:?}, {greatest:?}]"))
            .with_help("give the smaller one first"));
        }
        let (key, reference) = self.guide.reference();
        if (least..=greatest).contains(&reference) {
            return Ok(());
        }
        let coordinate = match self.guide {
            Guide::Rotary(_) => "angles are counter-clockwise from +x, as the stops",
            Guide::Linear(_) => "positions are along the slide, as the stops",
        };
        Err(Issue::wrong_value(
            join(path, key),
            format!("the reference position is beyond the stops; {coordinate}"),
        )
        .with_number(reference)
        .with_help("correct the reference position or the stops"))
    }
}

impl Linear {
    fn check(&self, path: &str) -> Read<()> {
        self.check_scalars(path)?;
        check_list(&join(path, "point"), &self.point, Bound::Any)?;
        let direction = join(path, "direction");
        match &self.direction {
            Direction::Angle(angle) => check_number(|| direction, *angle, Bound::Any),
            Direction::Vector(vector) => {
                check_list(&direction, vector, Bound::Any)?;
                let length = vector[0].hypot(vector[1]);
                if length > 0.0 && length.is_finite() {
                    return Ok(());
                }
                Err(Issue::wrong_value(direction, "the vector has no direction")
                    .with_value(format!("[{:?}, {:?}]", vector[0], vector[1]))
                    .with_help("give a vector such as [0.0, 1.0], or an angle such as \"90 deg\""))
            }
        }
    }
}
