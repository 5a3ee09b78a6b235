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
    let mut product = Product {
        factor: Factor::ONE,
        dimension: Dimension::NONE,
    };
    if text.trim().is_empty() {
        return Ok((product.factor, product.dimension));
    }
    // Groups contain no division, so every slash starts a divisor.
    let mut parts = text.split('/');
    for factor in factors(parts.next().unwrap_or_default())? {
        product.multiply(factor, 1)?;
    }
    for divisor in parts.map(str::trim) {
        if let Some(group) = divisor.strip_prefix('(') {
            let group = group.strip_suffix(')').ok_or(MALFORMED_GROUP)?;
            for factor in factors(group)? {
                product.multiply(factor, -1)?;
            }
        } else {
            match factors(divisor)?.as_slice() {
                [factor] => product.multiply(factor, -1)?,
                _ => return Err(MALFORMED_DIVISION),
            }
        }
    }
    Ok((product.factor, product.dimension))
}

/// The factors of a text without divisions, at least one.
fn factors(text: &str) -> Result<Vec<&str>, ProductError> {
    if text.contains(['(', ')']) {
        return Err(MALFORMED_GROUP);
    }
    let mut factors = Vec::new();
    for group in text.split(['*', '·', '⋅']) {
        let before = factors.len();
        factors.extend(group.split_whitespace());
        if factors.len() == before {
            return Err(MALFORMED_OPERATOR);
        }
    }
    Ok(factors)
}

struct Product {
    factor: Factor,
    dimension: Dimension,
}

impl Product {
    /// Multiplies by a factor such as `m^2`, or divides by it for `sign` = -1.
    fn multiply(&mut self, factor: &str, sign: i32) -> Result<(), ProductError> {
        let (name, power) = factor.split_at(factor.find(['^', '²', '³']).unwrap_or(factor.len()));
        let power = sign * read_power(power)?;
        if name.is_empty() {
            return Err(MALFORMED_OPERATOR);
        }
        // `1` lets a reciprocal be written: `1/min`.
        if name != "1" {
            let unit = table::find(name).ok_or_else(|| ProductError::Unknown(name.to_owned()))?;
            self.factor = self.factor.times_power(unit.factor, power);
            self.dimension = self.dimension.times_power(unit.dimension, power);
        }
        Ok(())
    }
}

/// The power written as `^2`, `^-1` or `²`, or by nothing, which is 1.
fn read_power(text: &str) -> Result<i32, ProductError> {
    match text {
        "" => Ok(1),
        "²" => Ok(2),
        "³" => Ok(3),
        _ => {
            let number = text.strip_prefix('^').ok_or(MALFORMED_POWER)?;
            let (sign, digit) = match number.strip_prefix('-') {
                Some(digit) => (-1, digit),
                None => (1, number),
            };
            match digit.as_bytes() {
                [digit @ b'0'..=b'9'] => Ok(sign * i32::from(digit - b'0')),
                _ => Err(MALFORMED_POWER),
            }
        }
    }
}
