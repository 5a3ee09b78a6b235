//! `[[pulley]]`: size, place, contact and load of a pulley.

use schemars::JsonSchema;
use serde::Serialize;

use super::{Coupling, Load};
use crate::scalar::{Absent, Bound, Numbers, Scalars, collect_items, item_mut, join, scalars, split_first};
use crate::schema::{QuantitySchema, RatioSchema};
use crate::units::quantities;

/// A pulley.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pulley {
    /// Name, for results and for key paths.
    pub name: String,
    /// What holds the centre.
    #[serde(flatten)]
    pub mount: Mount,
    /// How large it is.
    #[serde(flatten)]
    pub size: Size,
    /// Which side of the belt touches it.
    #[serde(default)]
    pub contact: Contact,
    /// Inertia of the pulley and of what turns rigidly with it, kg m².
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub inertia: f64,
    /// Whether it drives the belt; exactly one pulley does.
    #[serde(default)]
    pub driver: bool,
    /// Load of the accessory, positive against the belt's travel.
    #[serde(default)]
    pub load: Load,
    /// Viscous friction of the bearing, N m s/rad.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub bearing_damping: f64,
    /// Distance of the cord line from the surface that touches this pulley, m, in place of the belt's.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub cord_offset: Option<f64>,
    /// Effective friction coefficient of this pulley, in place of the belt's.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<RatioSchema>")]
    pub friction: Option<f64>,
    /// Wrap below which a warning is given, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub minimum_wrap: Option<f64>,
    /// What connects it with the accessory; without it the pulley's inertia contains the accessory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupling: Option<Coupling>,
}

scalars!(Pulley {
    inertia: quantities::INERTIA, Bound::NotNegative => Absent::Value(0.0);
    bearing_damping: quantities::TORSIONAL_DAMPING, Bound::NotNegative => Absent::Value(0.0);
    cord_offset: quantities::LENGTH, Bound::NotNegative => Absent::Nothing;
    friction: quantities::NUMBER, Bound::Positive => Absent::Nothing;
    minimum_wrap: quantities::ANGLE, Bound::NotNegative => Absent::Nothing;
});

/// What holds the centre of a pulley.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Mount {
    /// A fixed centre.
    Fixed(Fixed),
    /// A tensioner.
    Carried(Carried),
}

/// A fixed centre.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Fixed {
    /// The centre `[x, y]`, m.
    #[schemars(with = "[QuantitySchema; 2]")]
    pub center: [f64; 2],
}

/// A place on a tensioner.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Carried {
    /// Name of the tensioner that carries the pulley.
    pub arm: String,
    /// Distance from the pivot, m, if it is not the tensioner's `arm_length`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub arm_length: Option<f64>,
    /// Angle from the arm to the line from the pivot to this pulley, counter-clockwise, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<QuantitySchema>")]
    pub arm_angle_offset: Option<f64>,
    /// Offset `[x, y]` from the point of a linear tensioner, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[QuantitySchema; 2]>")]
    pub offset: Option<[f64; 2]>,
    /// Mass of the pulley, kg; zero if the tensioner's inertia or mass contains it.
    #[serde(default)]
    #[schemars(with = "QuantitySchema")]
    pub mass: f64,
}

scalars!(Carried {
    arm_length: quantities::LENGTH, Bound::Positive => Absent::Nothing;
    arm_angle_offset: quantities::ANGLE, Bound::Any => Absent::Nothing;
    mass: quantities::MASS, Bound::NotNegative => Absent::Value(0.0);
});

/// How large a pulley is; exactly one of the forms (theory 04 §1).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Size {
    /// Pitch radius: of the belt's cord line, m.
    Radius(#[schemars(with = "QuantitySchema")] f64),
    /// Outside diameter, m: the pitch radius is half of it and the cord offset of the side that touches.
    OutsideDiameter(#[schemars(with = "QuantitySchema")] f64),
    /// Effective diameter of a ribbed pulley, m: the pitch radius is half of it and `cord_offset_ribs`.
    EffectiveDiameter(#[schemars(with = "QuantitySchema")] f64),
}

impl Size {
    /// The key that gives the size.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Radius(_) => "radius",
            Self::OutsideDiameter(_) => "outside_diameter",
            Self::EffectiveDiameter(_) => "effective_diameter",
        }
    }

    /// The number of that key, m.
    pub fn value(&self) -> f64 {
        match self {
            Self::Radius(value) | Self::OutsideDiameter(value) | Self::EffectiveDiameter(value) => *value,
        }
    }

    fn value_mut(&mut self) -> &mut f64 {
        match self {
            Self::Radius(value) | Self::OutsideDiameter(value) | Self::EffectiveDiameter(value) => value,
        }
    }
}

/// Which side of the belt touches a pulley.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Contact {
    /// The ribbed side: the pulley is inside the loop.
    #[default]
    Ribs,
    /// The back: the pulley is outside the loop.
    Back,
}

impl Numbers for Pulley {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("center", rest) => match &mut self.mount {
                Mount::Fixed(fixed) => item_mut(&mut fixed.center, rest),
                Mount::Carried(_) => None,
            },
            ("arm_length" | "arm_angle_offset" | "mass", "") => match &mut self.mount {
                Mount::Fixed(_) => None,
                Mount::Carried(carried) => carried.scalar_mut(path),
            },
            ("offset", rest) => match &mut self.mount {
                Mount::Fixed(_) => None,
                Mount::Carried(carried) => item_mut(carried.offset.as_mut()?, rest),
            },
            ("load", rest) => self.load.number_mut(rest),
            ("coupling", rest) => self.coupling.as_mut()?.scalar_mut(rest),
            (key, "") if key == self.size.key() => Some(self.size.value_mut()),
            _ => self.scalar_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        match &self.mount {
            Mount::Fixed(fixed) => collect_items(&fixed.center, &join(prefix, "center"), keys),
            Mount::Carried(carried) => {
                carried.collect_scalar_keys(prefix, keys);
                if let Some(offset) = &carried.offset {
                    collect_items(offset, &join(prefix, "offset"), keys);
                }
            }
        }
        keys.push(join(prefix, self.size.key()));
        self.collect_scalar_keys(prefix, keys);
        // The driver has no load that could be changed.
        if !self.driver {
            self.load.collect_keys(&join(prefix, "load"), keys);
        }
        if let Some(coupling) = &self.coupling {
            coupling.collect_scalar_keys(&join(prefix, "coupling"), keys);
        }
    }
}
