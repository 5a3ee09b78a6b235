//! Numbers inside drawings, with their units.

/// A force with three significant digits at least, `412 N`.
pub(super) fn force(newtons: f64) -> String {
    format!("{} N", three_digits(newtons))
}

/// An angle in degrees with one decimal, `168.3°`.
pub(super) fn degrees(radians: f64) -> String {
    format!("{:.1}°", radians.to_degrees()).replace('-', "−")
}

/// A decimal with at least three significant digits, but no more than two decimals.
pub(super) fn three_digits(value: f64) -> String {
    let decimals = match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        _ => 2,
    };
    format!("{value:.decimals$}").replace('-', "−")
}

/// A number with three significant digits at most: a plain decimal, or with a power of ten where that would be
/// long.
pub(super) fn significant(value: f64) -> String {
    let scientific = format!("{value:.2e}");
    let (Some((digits, exponent)), true) = (scientific.split_once('e'), value.is_finite()) else {
        return short(value);
    };
    let plain = value == 0.0 || (1e-3..99_950.0).contains(&value.abs());
    if plain {
        // Rounded to its digits, a number prints without any more.
        return short(scientific.parse().unwrap_or(value));
    }
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    format!("{digits}·10^{{{exponent}}}").replace('-', "−")
}

/// A number of three significant digits with the unit of an axis, `0.42 N m`.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "" | "–" | "-" => significant(value),
        unit => format!("{} {unit}", significant(value)),
    }
}

/// The shortest decimal of a number, with a true minus sign.
pub(super) fn short(value: f64) -> String {
    format!("{value}").replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_unit_and_digits() {
        assert_eq!(force(1234.56), "1235 N");
        assert_eq!(force(41.26), "41.3 N");
        assert_eq!(force(0.5), "0.50 N");
        assert_eq!(degrees(std::f64::consts::PI), "180.0°");
        let rounded = [0.042_04, 1234.5, -7.0, 0.0, 2.5e-7, 99_999.0].map(significant);
        assert_eq!(rounded, ["0.042", "1230", "−7", "0", "2.5·10^{−7}", "1·10^{5}"]);
        assert_eq!(
            (with_unit(0.5, "N m"), with_unit(0.5, "–")),
            ("0.5 N m".into(), "0.5".into())
        );
        assert_eq!(three_digits(-12.34), "−12.3");
        assert_eq!((short(0.5), short(2.0)), ("0.5".to_string(), "2".to_string()));
    }
}
