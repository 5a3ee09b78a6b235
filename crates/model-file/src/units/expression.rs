//! Reading `"0.05 N m s/rad"`: number, product of units, check of the dimension.
//!
//! Grammar: `number [unit-product]`, where factors are separated by blanks, `*` or `·`, carry an optional integer power
//! (`m^2`, `m²`) and may be divided by a factor or by a group in parentheses (`N m/rad`, `kg/(m s)`). A factor after a
//! division without parentheses (`N/m s`) has two readings and is refused.

use thiserror::Error;

use super::{Dimension, table};

/// What a key expects: words and an example for messages, and the dimensions that are right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Name with its article, for example `a torque`.
    pub name: &'static str,
    /// A value as it is written in a file, without quotes, for example `4.5 N m`.
    pub example: &'static str,
    /// Permitted dimensions. A bare number is always permitted and means SI.
    pub dimensions: &'static [Dimension],
}

impl Quantity {
    /// True if the quantity has no unit.
    pub fn is_plain_number(&self) -> bool {
        self.dimensions == [Dimension::NONE]
    }

    /// For messages: `a torque such as "4.5 N m"`.
    pub fn description(&self) -> String {
        if self.is_plain_number() {
            format!("{} such as {}", self.name, self.example)
        } else {
            format!("{} such as \"{}\"", self.name, self.example)
        }
    }
}

/// Why a text is not the quantity that was expected.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum UnitError {
    /// The text does not start with a number.
    #[error("expected {expected}, found \"{text}\", which does not start with a number")]
    NoNumber {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
    },
    /// There is a number, but no unit.
    #[error("expected {expected}, found \"{text}\" without a unit")]
    NoUnit {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
    },
    /// A unit is not in the table.
    #[error("expected {expected}, found \"{text}\", whose unit \"{unit}\" is not known")]
    UnknownUnit {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
        /// The unit that is not known.
        unit: String,
        /// The known unit with the nearest spelling, if one is near.
        nearest: Option<&'static str>,
    },
    /// The units do not form a product that can be read in one way.
    #[error("expected {expected}, found \"{text}\", whose unit cannot be read: {reason}")]
    Malformed {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
        /// What is wrong and how to write it.
        reason: &'static str,
    },
    /// The unit measures something else.
    #[error("expected {expected}, found \"{text}\"")]
    WrongDimension {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
    },
    /// The value is too large for a double-precision number.
    #[error("expected {expected}, found \"{text}\", which is not a finite number")]
    NotFinite {
        /// What was expected, with an example.
        expected: String,
        /// The text.
        text: String,
    },
}

/// Value of `text` in SI units, if it is a quantity of the expected kind.
///
/// # Errors
/// [`UnitError`]: no number, no unit, an unknown unit, an unreadable product of units, the wrong dimension, overflow.
pub fn read(text: &str, expected: &Quantity) -> Result<f64, UnitError> {
    let description = || expected.description();
    let found = || shorten(text);
    let trimmed = text.trim();
    let number_end = number_length(trimmed);
    let (number, unit_text) = trimmed.split_at(number_end);
    let Ok(number) = number.parse::<f64>() else {
        return Err(UnitError::NoNumber {
            expected: description(),
            text: found(),
        });
    };
    let unit_text = unit_text.trim();
    if unit_text.is_empty() && !expected.is_plain_number() {
        return Err(UnitError::NoUnit {
            expected: description(),
            text: found(),
        });
    }
    let (factor, dimension) = read_product(unit_text).map_err(|problem| match problem {
        ProductError::Unknown(unit) => UnitError::UnknownUnit {
            expected: description(),
            text: found(),
            nearest: crate::nearest::nearest(&unit, table::UNITS.iter().map(|known| known.name)),
            unit,
        },
        ProductError::Malformed(reason) => UnitError::Malformed {
            expected: description(),
            text: found(),
            reason,
        },
    })?;
    if !expected.dimensions.contains(&dimension) {
        return Err(UnitError::WrongDimension {
            expected: description(),
            text: found(),
        });
    }
    let value = factor.apply(number);
    if !value.is_finite() {
        return Err(UnitError::NotFinite {
            expected: description(),
            text: found(),
        });
    }
    Ok(value)
}

/// The text for a message, cut where a message would become unreadable.
fn shorten(text: &str) -> String {
    const LONGEST: usize = 60;
    if text.chars().count() <= LONGEST {
        text.to_owned()
    } else {
        text.chars().take(LONGEST).chain(['…']).collect()
    }
}

/// Number of bytes of the decimal number at the start of `text`.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits_from = |start: usize| {
        bytes[start..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count()
    };
    let is_sign = |at: usize| matches!(bytes.get(at), Some(b'+' | b'-'));
    let mut end = usize::from(is_sign(0));
    end += digits_from(end);
    if bytes.get(end) == Some(&b'.') {
        end += 1;
        end += digits_from(end);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = end + 1 + usize::from(is_sign(end + 1));
        let digits = if exponent <= bytes.len() {
            digits_from(exponent)
        } else {
            0
        };
        if digits > 0 {
            end = exponent + digits;
        }
    }
    end
}

/// A conversion factor as numerator and denominator: `120 mm` is computed as 120·1e-3 and `5 /min` as 5/60, each with
/// one rounding.
#[derive(Clone, Copy)]
struct Factor {
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

    fn apply(self, number: f64) -> f64 {
        number * self.numerator / self.denominator
    }
}

enum ProductError {
    Unknown(String),
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
fn read_product(text: &str) -> Result<(Factor, Dimension), ProductError> {
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

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::quantities;
    use super::*;

    #[test]
    fn units_become_si() {
        let cases: &[(&str, &Quantity, f64)] = &[
            ("120 mm", &quantities::LENGTH, 0.12),
            ("88.9mm", &quantities::LENGTH, 0.0889),
            ("-3.75 deg", &quantities::ANGLE, -3.75 * PI / 180.0),
            ("0.57°", &quantities::ANGLE, 0.57 * PI / 180.0),
            ("3000 rpm", &quantities::ANGULAR_FREQUENCY, 100.0 * PI),
            ("3000 rev/min", &quantities::ANGULAR_FREQUENCY, 100.0 * PI),
            ("41.9 Hz", &quantities::ANGULAR_FREQUENCY, 83.8 * PI),
            ("0.5 N m/deg", &quantities::TORSIONAL_STIFFNESS, 90.0 / PI),
            ("332 N m/rad", &quantities::TORSIONAL_STIFFNESS, 332.0),
            ("332 N·m·rad^-1", &quantities::TORSIONAL_STIFFNESS, 332.0),
            ("332 Nm/rad", &quantities::TORSIONAL_STIFFNESS, 332.0),
            ("2e-4 kg m^2", &quantities::INERTIA, 2e-4),
            ("2e-4 kg·m²", &quantities::INERTIA, 2e-4),
            ("4e4 N/m", &quantities::STIFFNESS, 4e4),
            ("4e4 kg/(s s)", &quantities::STIFFNESS, 4e4),
            ("4 N/mm", &quantities::STIFFNESS, 4e3),
            ("3 %", &quantities::NUMBER, 0.03),
            ("3", &quantities::NUMBER, 3.0),
        ];
        for (text, quantity, expected) in cases {
            let value = read(text, quantity).unwrap();
            assert!(
                (value - expected).abs() <= 2.0 * f64::EPSILON * expected.abs(),
                "{text}: {value} instead of {expected}"
            );
        }
        assert_eq!(read("120 mm", &quantities::LENGTH), Ok(0.12));
    }

    #[test]
    fn messages_name_the_expected_unit() {
        let cases: &[(&str, &Quantity, &str)] = &[
            (
                "4.5 N",
                &quantities::TORQUE,
                r#"expected a torque such as "4.5 N m", found "4.5 N""#,
            ),
            (
                "4.5",
                &quantities::TORQUE,
                r#"expected a torque such as "4.5 N m", found "4.5" without a unit"#,
            ),
            (
                "332 N m",
                &quantities::TORSIONAL_STIFFNESS,
                r#"expected a torsional stiffness such as "332 N m/rad", found "332 N m""#,
            ),
            (
                "two mm",
                &quantities::LENGTH,
                r#"expected a length such as "120 mm", found "two mm", which does not start with a number"#,
            ),
            (
                "4 nm",
                &quantities::LENGTH,
                r#"expected a length such as "120 mm", found "4 nm", whose unit "nm" is not known"#,
            ),
            (
                "4 N/m s",
                &quantities::STIFFNESS,
                r#"expected a stiffness such as "4e4 N/m", found "4 N/m s", whose unit cannot be read: write N s/m or N/(m s) instead of N/m s"#,
            ),
            (
                "2 mm",
                &quantities::NUMBER,
                r#"expected a plain number such as 2.0, found "2 mm""#,
            ),
            (
                "1e400 mm",
                &quantities::LENGTH,
                r#"expected a length such as "120 mm", found "1e400 mm", which is not a finite number"#,
            ),
        ];
        for (text, quantity, expected) in cases {
            assert_eq!(read(text, quantity).unwrap_err().to_string(), *expected);
        }
    }

    #[test]
    fn malformed_products_are_refused() {
        for unit in [
            "m/", "/", "*m", "m**m", "m^", "m^x", "m^12", "m^1.5", "m/(s", "m)", "(m)", "m/()", "m^^2",
            "m/(s/s)", "²", "m/(s*)",
        ] {
            let error = read(&format!("1 {unit}"), &quantities::LENGTH).unwrap_err();
            assert!(matches!(error, UnitError::Malformed { .. }), "{unit}: {error:?}");
        }
    }

    #[test]
    fn nearest_unit_is_suggested() {
        let Err(UnitError::UnknownUnit { nearest, .. }) = read("3 RPM", &quantities::ANGULAR_FREQUENCY)
        else {
            panic!("RPM is not a unit");
        };
        assert_eq!(nearest, Some("rpm"));
    }
}
