//! Polynomials of fixed length on the unit interval: certified crossings and extremes (theory 05 §3.2).
//!
//! The Taylor polynomial of a guard over one step of the exact flow has [`TERMS`] coefficients in `s ∈ [0, 1]`. Its
//! Bernstein coefficients bound it, and their sign variations count its zeros (Descartes): none or one is a proof, more
//! mean "divide the interval".

use crate::multiply_add;

/// Number of coefficients. With steps of at most [`REACH`] over the spectral radius the truncated part of an exponential
/// is below `2²⁴/24! = 3e-17` of its size.
pub const TERMS: usize = 24;

/// Largest product of spectral radius and step for which [`TERMS`] coefficients reach rounding.
pub const REACH: f64 = 2.0;

/// Coefficients of `Σ c_k s^k`.
pub type Coefficients = [f64; TERMS];

const DEGREE: usize = TERMS - 1;

/// Interval width below which an undecided case is a tangency, not a crossing.
const TANGENCY_WIDTH: f64 = 1e-9;

/// `1 / C(DEGREE, k)`.
const INVERSE_BINOMIAL: Coefficients = {
    let mut table = [1.0; TERMS];
    let mut binomial = 1.0;
    let mut k = 1;
    while k < TERMS {
        binomial = binomial * ((TERMS - k) as f64) / (k as f64);
        table[k] = 1.0 / binomial;
        k += 1;
    }
    table
};

/// Degree of the short polynomial of the quick certificate: the tail beyond it is below a hundredth.
const SHORT: usize = 7;

/// `C(i, k) / C(SHORT, k)`, power to Bernstein form of degree [`SHORT`], one column per power.
const SHORT_BERNSTEIN: [[f64; SHORT + 1]; SHORT + 1] = {
    let mut table = [[0.0; SHORT + 1]; SHORT + 1];
    let mut i = 0;
    while i <= SHORT {
        let mut ratio = 1.0;
        let mut k = 0;
        while k <= i {
            table[k][i] = ratio;
            ratio = ratio * ((i - k) as f64) / ((SHORT - k) as f64);
            if k == SHORT {
                break;
            }
            k += 1;
        }
        i += 1;
    }
    table
};

/// Value at `s` by Horner's rule.
#[inline]
pub fn value(c: &Coefficients, s: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, &a| sum * s + a)
}

/// Values at several places at once: independent chains that fill the vector units.
#[inline]
pub fn values<const N: usize>(c: &Coefficients, s: &[f64; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    for &a in c.iter().rev() {
        for i in 0..N {
            sums[i] = multiply_add(sums[i], s[i], a);
        }
    }
    sums
}

/// Coefficients of the derivative.
#[inline]
pub fn derivative(c: &Coefficients) -> Coefficients {
    let mut slope = [0.0; TERMS];
    for k in 1..TERMS {
        slope[k - 1] = k as f64 * c[k];
    }
    slope
}

/// Value and derivative at `s`.
#[inline]
pub fn value_and_slope(c: &Coefficients, s: f64) -> (f64, f64) {
    let (mut sum, mut slope) = (0.0, 0.0);
    for &a in c.iter().rev() {
        slope = multiply_add(slope, s, sum);
        sum = multiply_add(sum, s, a);
    }
    (sum, slope)
}

/// Bounds of the polynomial on `[0, 1]` for a few operations: those of its first terms by their Bernstein coefficients,
/// widened by the sizes of all others.
#[inline]
fn quick_bounds(c: &Coefficients) -> (f64, f64) {
    let mut tails = [0.0; 4];
    for block in c[SHORT + 1..].chunks_exact(4) {
        for i in 0..4 {
            tails[i] += block[i].abs();
        }
    }
    let tail = (tails[0] + tails[1]) + (tails[2] + tails[3]);
    let mut bernstein = [0.0; SHORT + 1];
    for (k, column) in SHORT_BERNSTEIN.iter().enumerate() {
        for i in 0..=SHORT {
            bernstein[i] = multiply_add(c[k], column[i], bernstein[i]);
        }
    }
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for b in bernstein {
        low = low.min(b);
        high = high.max(b);
    }
    (low - tail, high + tail)
}

/// Whether the polynomial is certainly positive on `[0, 1]`: a sufficient test of a few operations.
#[inline]
pub fn is_certainly_positive(c: &Coefficients) -> bool {
    quick_bounds(c).0 > 0.0
}

/// The first `s ∈ (0, 1]` at which the polynomial, positive before, becomes negative; `None` if there is none.
///
/// `root_at_start` is the multiplicity of a zero at `s = 0` that is known from elsewhere (the event at which the step
/// begins); the coefficients below it are then ignored and the next one must be positive. A tangency is not a crossing.
pub fn first_crossing(c: &Coefficients, root_at_start: usize) -> Option<f64> {
    if root_at_start == 0 {
        return crossing_of(c);
    }
    let mut reduced = [0.0; TERMS];
    reduced[..TERMS - root_at_start].copy_from_slice(&c[root_at_start..]);
    crossing_of(&reduced)
}

fn crossing_of(c: &Coefficients) -> Option<f64> {
    if is_certainly_positive(c) {
        return None;
    }
    let slope = derivative(c);
    let end: f64 = c.iter().sum();
    if c[0] > 0.0 && end < 0.0 && is_certainly_positive(&slope.map(|a| -a)) {
        return Some(falling_zero(c, &slope, end));
    }
    search(c, bernstein(c), 0.0, 1.0)
}

/// The zero of a polynomial that certainly falls on `[0, 1]` from a positive value to `end < 0`: Newton's method from the
/// cubic through values and slopes of the inverse function at both ends.
fn falling_zero(c: &Coefficients, slope: &Coefficients, end: f64) -> f64 {
    let slope_end: f64 = slope.iter().sum();
    let range = end - c[0];
    let t = -c[0] / range;
    let (start_rate, end_rate) = (range / slope[0], range / slope_end);
    let square = t * t;
    let inverse = square * (3.0 - 2.0 * t)
        + t * (1.0 - t) * (1.0 - t) * start_rate.min(3.0)
        + square * (t - 1.0) * end_rate.min(3.0);
    let mut s = inverse.clamp(0.0, 1.0);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let powers = powers(s);
        let f = dot(c, &powers);
        if f > 0.0 {
            low = s;
        } else {
            high = s;
        }
        let newton = s - f / dot(slope, &powers);
        let inside = newton >= low && newton <= high;
        let next = if inside { newton } else { 0.5 * (low + high) };
        // Quadratic convergence: the error after a step is of the order of its square.
        if inside && (next - s).abs() < 1e-9 {
            return next;
        }
        s = next;
    }
    s
}

/// `1, s, s², …` in independent chains of four.
#[inline]
fn powers(s: f64) -> Coefficients {
    let mut powers = [1.0; TERMS];
    powers[1] = s;
    powers[2] = s * s;
    powers[3] = powers[2] * s;
    let fourth = powers[2] * powers[2];
    for k in 4..TERMS {
        powers[k] = powers[k - 4] * fourth;
    }
    powers
}

/// Scalar product in four independent sums.
#[inline]
fn dot(a: &Coefficients, b: &Coefficients) -> f64 {
    let mut sums = [0.0; 4];
    for (x, y) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for i in 0..4 {
            sums[i] = multiply_add(x[i], y[i], sums[i]);
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Smallest and largest value on `[0, end]`, given that values between `known.0` and `known.1` are of no interest:
/// returns the union of that range with the polynomial's.
pub fn extend_range(c: &Coefficients, end: f64, known: (f64, f64)) -> (f64, f64) {
    let mut scaled = *c;
    let mut power = 1.0;
    for a in &mut scaled {
        *a *= power;
        power *= end;
    }
    let (first, last) = (scaled[0], scaled.iter().sum::<f64>());
    let mut range = (known.0.min(first).min(last), known.1.max(first).max(last));
    let (low, high) = quick_bounds(&scaled);
    if low >= range.0 && high <= range.1 {
        return range;
    }
    let slope = derivative(&scaled);
    let (least, most) = quick_bounds(&slope);
    if least > 0.0 || most < 0.0 {
        return range;
    }
    let b = bernstein(&slope);
    match sign_variations(&b) {
        0 => {}
        1 if b[0] * b[DEGREE] < 0.0 => {
            let extreme = value(&scaled, polish(&slope, 0.0, 1.0, b[0].signum()));
            range = (range.0.min(extreme), range.1.max(extreme));
        }
        _ => range_of(bernstein(&scaled), 40, &mut range),
    }
    range
}

/// All zeros of the derivative in `[0, end]` at which it changes sign, with the value of the polynomial there.
pub fn extrema(c: &Coefficients, end: f64) -> Vec<(f64, f64)> {
    let slope = derivative(c);
    let mut found = Vec::new();
    isolate(&slope, bernstein(&slope), 0.0, 1.0, &mut found);
    found
        .into_iter()
        .filter(|&s| s <= end)
        .map(|s| (s, value(c, s)))
        .collect()
}

/// Bernstein coefficients on `[0, 1]`, by repeated sums.
fn bernstein(c: &Coefficients) -> Coefficients {
    let mut b = [0.0; TERMS];
    for k in 0..TERMS {
        b[k] = c[k] * INVERSE_BINOMIAL[k];
    }
    for j in 1..TERMS {
        for i in (j..TERMS).rev() {
            b[i] += b[i - 1];
        }
    }
    b
}

/// De Casteljau division at the middle: Bernstein coefficients on the left and right halves.
fn divide(b: &Coefficients) -> (Coefficients, Coefficients) {
    let mut work = *b;
    let mut left = [0.0; TERMS];
    let mut right = [0.0; TERMS];
    left[0] = work[0];
    right[DEGREE] = work[DEGREE];
    for level in 1..TERMS {
        for i in 0..TERMS - level {
            work[i] = 0.5 * (work[i] + work[i + 1]);
        }
        left[level] = work[0];
        right[DEGREE - level] = work[DEGREE - level];
    }
    (left, right)
}

fn sign_variations(b: &Coefficients) -> usize {
    let mut last = 0.0;
    let mut count = 0;
    for &value in b {
        if value != 0.0 {
            if value * last < 0.0 {
                count += 1;
            }
            last = value.signum();
        }
    }
    count
}

fn search(c: &Coefficients, b: Coefficients, low: f64, high: f64) -> Option<f64> {
    if b.iter().all(|&value| value > 0.0) {
        return None;
    }
    if b[0] <= 0.0
        && b[1..]
            .iter()
            .find(|value| **value != 0.0)
            .is_none_or(|value| *value < 0.0)
    {
        // The left end is a zero that division hit exactly, or rounding put it below.
        return Some(low);
    }
    let variations = sign_variations(&b);
    if variations == 1 && b[0] > 0.0 && b[DEGREE] < 0.0 {
        return Some(polish(c, low, high, 1.0));
    }
    if high - low < TANGENCY_WIDTH {
        return if b[DEGREE] < 0.0 { Some(high) } else { None };
    }
    let (left, right) = divide(&b);
    let middle = 0.5 * (low + high);
    search(c, left, low, middle).or_else(|| search(c, right, middle, high))
}

/// All sign changes, left to right.
fn isolate(c: &Coefficients, b: Coefficients, low: f64, high: f64, found: &mut Vec<f64>) {
    match sign_variations(&b) {
        0 => {}
        1 if b[0] * b[DEGREE] < 0.0 => found.push(polish(c, low, high, b[0].signum())),
        _ if high - low < TANGENCY_WIDTH => {}
        _ => {
            let (left, right) = divide(&b);
            let middle = 0.5 * (low + high);
            isolate(c, left, low, middle, found);
            isolate(c, right, middle, high, found);
        }
    }
}

/// Newton's method, safeguarded by bisection, for the one zero in `[low, high]`; `sign` is the sign at `low`.
fn polish(c: &Coefficients, low: f64, high: f64, sign: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let mut s = 0.5 * (low + high);
    for _ in 0..100 {
        let (f, slope) = value_and_slope(c, s);
        if f == 0.0 {
            return s;
        }
        if f * sign > 0.0 {
            low = s;
        } else {
            high = s;
        }
        let newton = s - f / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - s).abs() <= 2.0 * f64::EPSILON * s.abs().max(1e-3) {
            return next;
        }
        s = next;
    }
    s
}

fn range_of(b: Coefficients, depth: usize, range: &mut (f64, f64)) {
    range.0 = range.0.min(b[0]).min(b[DEGREE]);
    range.1 = range.1.max(b[0]).max(b[DEGREE]);
    let (low, high) = b.iter().fold((b[0], b[0]), |(l, h), &v| (l.min(v), h.max(v)));
    let slack = 1e-16 * low.abs().max(high.abs());
    if depth == 0 || (low >= range.0 - slack && high <= range.1 + slack) {
        return;
    }
    let (left, right) = divide(&b);
    range_of(left, depth - 1, range);
    range_of(right, depth - 1, range);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Taylor coefficients of `offset + amplitude cos(ω s + phase)`.
    fn cosine(offset: f64, amplitude: f64, omega: f64, phase: f64) -> Coefficients {
        let mut c = [0.0; TERMS];
        let mut factor = amplitude;
        for k in 0..TERMS {
            c[k] = factor * (phase + 0.5 * std::f64::consts::PI * k as f64).cos();
            factor *= omega / (k as f64 + 1.0);
        }
        c[0] += offset;
        c
    }

    #[test]
    fn finds_the_first_of_two_close_crossings() {
        // 1 + cos has a double zero at π; lowered by d it dips below over an angle of 2 √(2 d).
        for depth in [1e-2, 1e-6, 1e-10, 1e-13] {
            let c = cosine(1.0 - depth, 1.0, 2.0, std::f64::consts::PI - 1.0);
            let s = first_crossing(&c, 0).unwrap();
            let expected = 0.5 - (0.5 * depth).sqrt().asin();
            assert!(
                (s - expected).abs() < 2e-16 / depth.sqrt(),
                "depth {depth}: {s} {expected}"
            );
        }
    }

    #[test]
    fn a_tangency_from_above_is_not_a_crossing() {
        for lift in [1e-3, 1e-9, 1e-13] {
            assert_eq!(
                first_crossing(&cosine(1.0 + lift, 1.0, 2.0, std::f64::consts::PI - 1.0), 0),
                None
            );
        }
    }

    #[test]
    fn a_known_root_at_the_start_is_not_found_again() {
        // sin(2s) starts at zero, rising, and stays positive on (0, 1]; minus a quarter of its slope it comes back.
        let c = cosine(0.0, 1.0, 2.0, -0.5 * std::f64::consts::PI);
        assert_eq!(first_crossing(&c, 1), None);
        let mut back = c;
        back[1] -= 1.6;
        let s = first_crossing(&back, 1).unwrap();
        assert!(((2.0 * s).sin() - 1.6 * s).abs() < 1e-15 && s > 0.1);
    }

    #[test]
    fn ranges_and_extrema_agree_with_the_closed_form() {
        let c = cosine(0.3, 0.7, 2.0, -1.0);
        let (low, high) = extend_range(&c, 1.0, (f64::INFINITY, f64::NEG_INFINITY));
        assert!((high - 1.0).abs() < 1e-15);
        assert!((low - (0.3 + 0.7 * 1.0_f64.cos())).abs() < 1e-15);
        let found = extrema(&c, 1.0);
        assert_eq!(found.len(), 1);
        assert!((found[0].0 - 0.5).abs() < 1e-15 && (found[0].1 - 1.0).abs() < 1e-15);
        assert!(extrema(&c, 0.4).is_empty());
    }

    #[test]
    fn value_and_slope_agree_with_the_function() {
        let c = cosine(0.1, 2.0, 1.7, 0.4);
        let (v, d) = value_and_slope(&c, 0.83);
        assert!((v - (0.1 + 2.0 * (1.7_f64 * 0.83 + 0.4).cos())).abs() < 1e-15);
        assert!((d + 3.4 * (1.7_f64 * 0.83 + 0.4).sin()).abs() < 1e-14);
        assert_eq!(v, value(&c, 0.83));
    }
}
