//! Reading `"0.05 N m s/rad"`: a number, a product of units, and the check of the dimension.

use super::product::{ProductError, read_product};
use super::{Quantity, UnitError, table};

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
