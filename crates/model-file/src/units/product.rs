//! Products of units: `N m s/rad`, `kg/(m s)`, `m^2`.
//!
//! Factors are separated by blanks, `*` or `·`, carry an optional integer power (`m^2`, `m²`) and may be divided by a
//! factor or by a group in parentheses. A factor after a division without parentheses (`N/m s`) has two readings and is
//! refused.

use super::{Dimension, table};

/// A conversion factor as numerator and denominator: `120 mm` is computed as 120·1e-3 and `5 /min` as 5/60, each with
/// one rounding.
#[derive(Clone, Copy)]
pub(super) struct Factor {
    numerator: f64,
    denominator: f64,
}

impl Factor {
    const ONE: Self = Self {
        numerator: 1.0,
        denominator: 1.0,
    };

    fn times_power(self, base: f64, power: i32) -> Self {
        // A factor below one is better divided by its exact reciprocal: 120/1000 is the double nearest to 0.12.
        let reciprocal = (1.0 / base).round();
        let (base, power) = if base < 1.0 && reciprocal * base == 1.0 && reciprocal > 1.0 {
            (reciprocal, -power)
        } else {
            (base, power)
        };
        if power >= 0 {
            Self {
                numerator: self.numerator * base.powi(power),
                ..self
            }
        } else {
            Self {
                denominator: self.denominator * base.powi(-power),
                ..self
            }
        }
    }

    /// The number in SI units.
    pub fn apply(self, number: f64) -> f64 {
        number * self.numerator / self.denominator
    }
}

/// Why a product of units cannot be read.
pub(super) enum ProductError {
    /// A unit that is not in the table.
    Unknown(String),
    /// What is wrong and how to write it.
    Malformed(&'static str),
}

const MALFORMED_POWER: ProductError =
    ProductError::Malformed("a power is a whole number between -9 and 9, as in m^2");
const MALFORMED_DIVISION: ProductError = ProductError::Malformed("write N s/m or N/(m s) instead of N/m s");
const MALFORMED_GROUP: ProductError =
    ProductError::Malformed("parentheses enclose the units after one division, as in kg/(m s)");
const MALFORMED_OPERATOR: ProductError =
    ProductError::Malformed("a unit is missing before or after an operator");

/// Factor and dimension of a product of units; the empty product is 1.
pub(super) fn read_product(text: &str) -> Result<(Factor, Dimension), ProductError> {
    let mut factor = Factor::ONE;
    let mut dimension = Dimension::NONE;
    let mut rest = text;
    let mut divided = false;
    let mut in_group = false;
    let mut divide_next = false;
    let mut expects_unit = false;
    let mut group_has_unit = false;
    loop {
        rest = rest.trim_start();
        let Some(first) = rest.chars().next() else {
            break;
        };
        let after_first = &rest[first.len_utf8()..];
        match first {
            '*' | '·' | '⋅' => {
                if expects_unit || dimension == Dimension::NONE && rest.len() == text.len() {
                    return Err(MALFORMED_OPERATOR);
                }
                expects_unit = true;
                rest = after_first;
            }
            '/' => {
                if expects_unit || in_group {
                    return Err(if in_group {
                        MALFORMED_GROUP
                    } else {
                        MALFORMED_OPERATOR
                    });
                }
                divide_next = true;
                divided = true;
                expects_unit = true;
                rest = after_first;
            }
            '(' => {
                if !divide_next || in_group {
                    return Err(MALFORMED_GROUP);
                }
                in_group = true;
                group_has_unit = false;
                rest = after_first;
            }
            ')' => {
                if !in_group || !group_has_unit || expects_unit {
                    return Err(MALFORMED_GROUP);
                }
                in_group = false;
                divide_next = false;
                rest = after_first;
            }
            _ => {
                if divided && !divide_next && !in_group {
                    return Err(MALFORMED_DIVISION);
                }
                let end = rest
                    .find(|c: char| c.is_whitespace() || "*·⋅/()^²³".contains(c))
                    .unwrap_or(rest.len());
                let (name, after_name) = rest.split_at(end);
                let (power, after_power) = read_power(after_name)?;
                if name.is_empty() {
                    return Err(MALFORMED_OPERATOR);
                }
                // `1` lets a reciprocal be written: `1/min`.
                if name != "1" {
                    let Some(unit) = table::find(name) else {
                        return Err(ProductError::Unknown(name.to_owned()));
                    };
                    let power = if divide_next { -power } else { power };
                    factor = factor.times_power(unit.factor, power);
                    dimension = dimension.times_power(unit.dimension, power);
                }
                expects_unit = false;
                group_has_unit = true;
                if !in_group {
                    divide_next = false;
                }
                rest = after_power;
            }
        }
    }
    if expects_unit {
        return Err(MALFORMED_OPERATOR);
    }
    if in_group {
        return Err(MALFORMED_GROUP);
    }
    Ok((factor, dimension))
}

/// The power at the start of `text` (`^2`, `^-1`, `²`, or none, which is 1) and what follows it.
fn read_power(text: &str) -> Result<(i32, &str), ProductError> {
    if let Some(rest) = text.strip_prefix('²') {
        return Ok((2, rest));
    }
    if let Some(rest) = text.strip_prefix('³') {
        return Ok((3, rest));
    }
    let Some(rest) = text.strip_prefix('^') else {
        return Ok((1, text));
    };
    let (sign, rest) = match rest.strip_prefix('-') {
        Some(rest) => (-1, rest),
        None => (1, rest),
    };
    let mut characters = rest.chars();
    match characters.next().and_then(|digit| digit.to_digit(10)) {
        // One digit: the cast is exact.
        Some(digit) if !rest[1..].starts_with(|c: char| c.is_ascii_digit() || c == '.') => {
            Ok((sign * digit as i32, characters.as_str()))
        }
        _ => Err(MALFORMED_POWER),
    }
}
