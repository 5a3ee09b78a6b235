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
        assert_eq!(three_digits(-12.34), "−12.3");
        assert_eq!((short(0.5), short(2.0)), ("0.5".to_string(), "2".to_string()));
    }
}
