//! Named numbers of a table: which keys there are, what they measure, which values are sound.
//!
//! One list per table drives reading, checking, `--set`, continuation in any key, and the list of numeric keys.

use crate::error::Issue;
use crate::units::Quantity;

/// A key that holds one number.
#[derive(Debug)]
pub(crate) struct Scalar {
    pub key: &'static str,
    pub quantity: Quantity,
    pub bound: Bound,
    /// Said in place of the bound's own words when the value is out of bounds.
    pub reason: Option<&'static str>,
    /// What it means that the key is not written.
    pub absent: Absent,
}

/// What it means that a key is not written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Absent {
    /// It must be written.
    Refused,
    /// It has this value.
    Value(f64),
    /// The table has no such number.
    Nothing,
}

/// A field that holds the number of a key, or may hold one.
pub(crate) trait Slot {
    fn number(&self) -> Option<f64>;
    fn number_mut(&mut self) -> Option<&mut f64>;
    fn fill(&mut self, value: f64);
}

impl Slot for f64 {
    fn number(&self) -> Option<f64> {
        Some(*self)
    }

    fn number_mut(&mut self) -> Option<&mut f64> {
        Some(self)
    }

    fn fill(&mut self, value: f64) {
        *self = value;
    }
}

impl Slot for Option<f64> {
    fn number(&self) -> Option<f64> {
        *self
    }

    fn number_mut(&mut self) -> Option<&mut f64> {
        self.as_mut()
    }

    fn fill(&mut self, value: f64) {
        *self = Some(value);
    }
}

impl Scalar {
    pub const fn new(key: &'static str, quantity: Quantity, bound: Bound) -> Self {
        Self {
            key,
            quantity,
            bound,
            reason: None,
            absent: Absent::Refused,
        }
    }

    pub const fn because(mut self, reason: &'static str) -> Self {
        self.reason = Some(reason);
        self
    }

    pub const fn or(mut self, absent: Absent) -> Self {
        self.absent = absent;
        self
    }

    /// Checks a value of this key; `path` is the table's.
    pub fn check(&self, path: &str, value: f64) -> Result<(), Box<Issue>> {
        let complaint = self.bound.complaint(value);
        let Some((message, help)) = complaint else {
            return Ok(());
        };
        let message = match self.reason {
            Some(reason) if value.is_finite() => reason,
            _ => message,
        };
        Err(Issue::wrong_value(join(path, self.key), message)
            .with_number(value)
            .with_help(help))
    }
}

/// Which finite numbers a key may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bound {
    Any,
    NotNegative,
    Positive,
    /// From zero to one.
    Share,
}

impl Bound {
    /// What is wrong with a value and what to do, if anything.
    pub fn complaint(self, value: f64) -> Option<(&'static str, &'static str)> {
        if !value.is_finite() {
            return Some(("is not a finite number", "give a finite number"));
        }
        match self {
            Self::Positive if value <= 0.0 => {
                Some(("must be greater than zero", "give a value greater than zero"))
            }
            Self::NotNegative if value < 0.0 => {
                Some(("must not be negative", "give zero or a positive value"))
            }
            Self::Share if !(0.0..=1.0).contains(&value) => {
                Some(("must lie between zero and one", "give a share from 0 to 1"))
            }
            _ => None,
        }
    }
}

/// A table all of whose numbers are named keys.
pub(crate) trait Scalars {
    /// The keys, in the order of the documentation.
    const SCALARS: &'static [Scalar];

    /// The number of a key, if the table has it.
    fn scalar(&self, key: &str) -> Option<f64>;

    /// The number of a key, to be changed.
    fn scalar_mut(&mut self, key: &str) -> Option<&mut f64>;

    /// Gives a key its number, whether the table has it or not.
    fn fill_scalar(&mut self, key: &str, value: f64);

    /// Appends the paths of the keys that the table has; `prefix` is the path of this table.
    fn collect_scalar_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        let present = Self::SCALARS
            .iter()
            .filter(|scalar| self.scalar(scalar.key).is_some());
        keys.extend(present.map(|scalar| join(prefix, scalar.key)));
    }

    /// Checks every number.
    fn check_scalars(&self, path: &str) -> Result<(), Box<Issue>> {
        for scalar in Self::SCALARS {
            if let Some(value) = self.scalar(scalar.key) {
                scalar.check(path, value)?;
            }
        }
        Ok(())
    }
}

/// Implements [`Scalars`] for a struct whose fields are named as the keys; `=> Absent::…` says what a missing key means.
macro_rules! scalars {
    ($table:ident { $($field:ident: $quantity:expr, $bound:expr $(, $reason:literal)? $(=> $absent:expr)?;)* }) => {
        impl $crate::scalar::Scalars for $table {
            const SCALARS: &'static [$crate::scalar::Scalar] = &[$(
                $crate::scalar::Scalar::new(stringify!($field), $quantity, $bound)
                    $(.because($reason))?
                    $(.or($absent))?,
            )*];

            fn scalar(&self, key: &str) -> Option<f64> {
                $(if key == stringify!($field) {
                    return $crate::scalar::Slot::number(&self.$field);
                })*
                None
            }

            fn scalar_mut(&mut self, key: &str) -> Option<&mut f64> {
                $(if key == stringify!($field) {
                    return $crate::scalar::Slot::number_mut(&mut self.$field);
                })*
                None
            }

            fn fill_scalar(&mut self, key: &str, value: f64) {
                $(if key == stringify!($field) {
                    $crate::scalar::Slot::fill(&mut self.$field, value);
                })*
            }
        }
    };
}
pub(crate) use scalars;

/// Numbers below a key path, for continuation and studies.
pub(crate) trait Numbers {
    /// The number at `path`, relative to this table.
    fn number_mut(&mut self, path: &str) -> Option<&mut f64>;

    /// Appends the paths of all numbers; `prefix` is the path of this table.
    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>);
}

/// Path of a key below a table; the path of the document is empty.
pub(crate) fn join(path: &str, key: &str) -> String {
    if path.is_empty() {
        key.to_owned()
    } else {
        format!("{path}.{key}")
    }
}

/// First key of a path, and the rest.
pub(crate) fn split_first(path: &str) -> (&str, &str) {
    path.split_once('.').unwrap_or((path, ""))
}

/// The number at a position in a list.
pub(crate) fn item_mut<'a>(list: &'a mut [f64], position: &str) -> Option<&'a mut f64> {
    list.get_mut(position.parse::<usize>().ok()?)
}

/// Appends the paths of the numbers of a list.
pub(crate) fn collect_items(list: &[f64], path: &str, keys: &mut Vec<String>) {
    keys.extend((0..list.len()).map(|index| join(path, &index.to_string())));
}
