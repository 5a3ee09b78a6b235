//! Which tensioners are sound.

use super::{check_list, check_number};
use crate::drive::{Direction, DryFriction, Guide, Linear, Tensioner};
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
        match &self.stops {
            Some(stops) => self.check_stops(&path, stops),
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

impl DryFriction {
    fn check(&self, path: &str, is_rotary: bool) -> Read<()> {
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
        let symmetric = self.torque.or(self.force);
        match (symmetric, self.loading, self.unloading) {
            (Some(_), None, None) | (None, Some(_), Some(_)) => {}
            (Some(_), _, _) => {
                return Err(Issue::wrong_value(
                    join(path, right),
                    "the friction is given both for all directions and for one of them",
                )
                .with_help(format!("keep `{right}`, or keep `loading` and `unloading`")));
            }
            (None, None, None) => {
                return Err(Issue::new(
                    Problem::MissingKey,
                    join(path, right),
                    "nothing says how large the friction is",
                )
                .with_help(format!("add `{right}`, or `loading` and `unloading`")));
            }
            (None, loading, _) => {
                let missing = if loading.is_some() { "unloading" } else { "loading" };
                return Err(
                    Issue::new(Problem::MissingKey, join(path, missing), "is missing").with_help(format!(
                        "friction that depends on the direction has `loading` and `unloading`; for one value write `{right}`"
                    )),
                );
            }
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
}
