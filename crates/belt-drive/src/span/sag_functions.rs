//! What the excess length of a span and its compliance are made of: the symmetric part `tanh(u)/u` and the antisymmetric
//! part `coth(u)/u − 1/u²` with their derivatives in `s = u² = (λL/2)²` (theory 04 (3.16)).
//!
//! The closed forms lose digits as `u⁻⁶` when `u` is small; below 1 the power series take over.

/// Value, first and second derivative in `s`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    pub value: f64,
    pub first: f64,
    pub second: f64,
}

/// Terms of the series: those of `tanh(√s)/√s` fall as `(4s/π²)^k`.
const TERMS: usize = 48;
/// `k`-th coefficient of `tanh(√s)/√s` in `s`, and of `coth(√s)/√s − 1/s`.
const SYMMETRIC: [f64; TERMS] = series(1.0);
const ANTISYMMETRIC: [f64; TERMS] = series(3.0);

/// The series of the solution `f` of `first·f + 2s f' = 1 − s f²`: of `tanh(√s)/√s` for 1, of `coth(√s)/√s − 1/s` for 3.
const fn series(first: f64) -> [f64; TERMS] {
    let mut coefficients = [0.0; TERMS];
    coefficients[0] = 1.0 / first;
    let mut k = 1;
    while k < TERMS {
        let (mut square, mut i) = (0.0, 0);
        while i < k {
            square += coefficients[i] * coefficients[k - 1 - i];
            i += 1;
        }
        coefficients[k] = -square / (first + 2.0 * k as f64);
        k += 1;
    }
    coefficients
}

/// The symmetric part at `u > 0`.
pub(super) fn symmetric(u: f64) -> Part {
    if u < 1.0 {
        return sum(&SYMMETRIC, u * u);
    }
    let decay = (-2.0 * u).exp();
    let tanh = (1.0 - decay) / (1.0 + decay);
    let inverse_cosh_squared = 4.0 * decay / (1.0 + decay).powi(2);
    Part {
        value: tanh / u,
        first: (u * inverse_cosh_squared - tanh) / (2.0 * u.powi(3)),
        second: (3.0 * tanh - u * inverse_cosh_squared * (3.0 + 2.0 * u * tanh)) / (4.0 * u.powi(5)),
    }
}

/// The antisymmetric part at `u > 0`.
pub(super) fn antisymmetric(u: f64) -> Part {
    if u < 1.0 {
        return sum(&ANTISYMMETRIC, u * u);
    }
    let decay = (-2.0 * u).exp();
    let coth = (1.0 + decay) / (1.0 - decay);
    let inverse_sinh_squared = 4.0 * decay / (1.0 - decay).powi(2);
    Part {
        value: coth / u - u.powi(-2),
        first: u.powi(-4) - (u * inverse_sinh_squared + coth) / (2.0 * u.powi(3)),
        second: (3.0 * coth + u * inverse_sinh_squared * (3.0 + 2.0 * u * coth)) / (4.0 * u.powi(5))
            - 2.0 * u.powi(-6),
    }
}

fn sum(coefficients: &[f64; TERMS], s: f64) -> Part {
    let (mut value, mut first, mut second) = (0.0, 0.0, 0.0);
    // Horner's scheme with two derivatives.
    for coefficient in coefficients.iter().rev() {
        second = second * s + 2.0 * first;
        first = first * s + value;
        value = value * s + coefficient;
    }
    Part { value, first, second }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_closed_forms_meet() {
        for part in [symmetric, antisymmetric] {
            let (below, above) = (part(1.0 - 1e-15), part(1.0));
            assert!((below.value / above.value - 1.0).abs() < 1e-14);
            assert!((below.first / above.first - 1.0).abs() < 1e-13);
            assert!((below.second / above.second - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn limits_at_zero() {
        assert!((symmetric(1e-9).first + 1.0 / 3.0).abs() < 1e-15);
        assert!((symmetric(1e-9).second - 4.0 / 15.0).abs() < 1e-15);
        assert!((antisymmetric(1e-9).first + 1.0 / 45.0).abs() < 1e-16);
        assert!((antisymmetric(1e-9).second - 4.0 / 945.0).abs() < 1e-17);
    }
}
