//! Where an axis is marked and what stands there.
//!
//! Major ticks of a linear axis lie at multiples of 1, 2 or 5 times a power of ten; minor ticks divide their
//! distance by 5 or 4. When the largest value is at least 10⁵ or below 10⁻², the labels are divided by a power
//! of ten that the axis label then names.

use super::axis::{Range, Scale};

/// A labelled position.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Position in units of the axis.
    pub value: f64,
    /// What is written there, with `^{…}` for powers.
    pub label: String,
}

/// All marks of an axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ticks {
    /// Labelled positions, ascending.
    pub major: Vec<Tick>,
    /// Positions without label, ascending.
    pub minor: Vec<f64>,
    /// Common power of ten taken out of the labels; 0 when none is.
    pub exponent: i32,
}

/// The marks of a range with about `count` labels at most.
pub(super) fn ticks(range: &Range, count: usize) -> Ticks {
    match range.scale {
        Scale::Linear => linear(range.low, range.high, count),
        Scale::Logarithmic => logarithmic(range.low, range.high, count),
    }
}

/// Marks of a linear range at multiples of `step`, minor ones at thirds of it; `None` for more than `most` labels
/// or a range or step that does not allow it.
pub(super) fn stepped(range: &Range, step: f64, most: usize) -> Option<Ticks> {
    let possible = range.scale == Scale::Linear && step.is_finite() && step > 0.0;
    let (first, last) = (
        (range.low / step - 1e-9).ceil(),
        (range.high / step + 1e-9).floor(),
    );
    // Written so that a range that is not finite fails.
    let few = last - first < most as f64 && first <= last;
    if !(possible && few) {
        return None;
    }
    let major = (0..=(last - first) as usize)
        .map(|index| (first + index as f64) * step + 0.0)
        .map(|value| Tick {
            value,
            label: format!("{value}").replace('-', "−"),
        })
        .collect();
    let thirds = (3.0 * first) as i64 - 2..=(3.0 * last) as i64 + 2;
    let minor = thirds
        .filter(|index| index % 3 != 0)
        .map(|index| index as f64 * step / 3.0)
        .filter(|value| (range.low..=range.high).contains(value))
        .collect();
    Some(Ticks {
        major,
        minor,
        exponent: 0,
    })
}

/// Marks of the linear axis from `low` to `high` with at most `count` (at least 2) labels, give or take one.
pub fn linear(low: f64, high: f64, count: usize) -> Ticks {
    if !(low.is_finite() && high.is_finite() && high > low) {
        return Ticks::default();
    }
    let raw = (high - low) / count.max(2) as f64;
    let mut power = raw.log10().floor() as i32;
    let (mut mantissa, divisions) = match raw / 10f64.powi(power) {
        m if m <= 1.0 => (1, 5),
        m if m <= 2.0 => (2, 4),
        m if m <= 5.0 => (5, 5),
        _ => (10, 5),
    };
    if mantissa == 10 {
        (mantissa, power) = (1, power + 1);
    }
    let exponent = common_exponent(low.abs().max(high.abs()));
    let decimals = usize::try_from(exponent - power).unwrap_or(0).min(17);

    let major = multiples(low, high, f64::from(mantissa), power)
        .map(|value| Tick {
            value,
            label: decimal(value / 10f64.powi(exponent), decimals),
        })
        .collect();
    // A fifth of 1 or 5 and a fourth of 2 are exact in the next power of ten.
    let minor_step = f64::from(mantissa) * 10.0 / f64::from(divisions);
    let minor = multiples(low, high, minor_step, power - 1)
        .filter(|value| {
            let in_majors = value / (f64::from(mantissa) * 10f64.powi(power));
            (in_majors - in_majors.round()).abs() > 1e-6
        })
        .collect();
    Ticks {
        major,
        minor,
        exponent,
    }
}

/// Multiples of `mantissa` · 10^`power` from `low` to `high`, with the tolerance of rounding at the ends.
fn multiples(low: f64, high: f64, mantissa: f64, power: i32) -> impl Iterator<Item = f64> {
    let step = mantissa * 10f64.powi(power);
    let slack = 1e-9 * (high - low) / step;
    let first = (low / step - slack).ceil();
    let last = (high / step + slack).floor();
    // A range holds a few dozen multiples at most; the bound stops what rounding could make of extreme ones.
    let number = if last >= first {
        ((last - first) as usize + 1).min(1000)
    } else {
        0
    };
    (0..number).map(move |index| {
        let multiple = (first + index as f64) * mantissa;
        // Dividing by a positive power is exact where multiplying by a negative one is not.
        let value = if (-300..0).contains(&power) {
            multiple / 10f64.powi(-power)
        } else {
            multiple * 10f64.powi(power)
        };
        value + 0.0
    })
}

/// The power of ten that shortens labels of numbers up to `largest`, a multiple of three, or 0.
fn common_exponent(largest: f64) -> i32 {
    if largest >= 1e5 || (largest > 0.0 && largest < 1e-2) {
        (largest.log10() / 3.0).floor() as i32 * 3
    } else {
        0
    }
}

/// Marks of the logarithmic axis from `low` to `high`: powers of ten; 1, 2 and 5 times them where fewer than two lie
/// inside; linear marks on an axis shorter than that serves.
pub fn logarithmic(low: f64, high: f64, count: usize) -> Ticks {
    if !(low > 0.0 && high.is_finite() && high > low) {
        return Ticks::default();
    }
    let first = (low.log10() - 1e-9).ceil() as i32;
    let last = (high.log10() + 1e-9).floor() as i32;
    if last - first < 1 {
        return within_decades(low, high).unwrap_or_else(|| linear(low, high, count.min(4)));
    }
    let decades = (last - first + 1) as usize;
    let every = decades.div_ceil(count.max(2)) as i32;
    let plain = (-2..=3).contains(&first) && (-2..=3).contains(&last);
    let major = (first..=last)
        .filter(|power| power.rem_euclid(every) == 0)
        .map(|power| Tick {
            value: 10f64.powi(power),
            label: if plain {
                decimal(10f64.powi(power), usize::try_from(-power).unwrap_or(0))
            } else {
                format!("10^{{{}}}", signed(power))
            },
        })
        .collect();
    let minor = if every == 1 && decades <= 10 {
        (first - 1..=last)
            .flat_map(|power| (2..10).map(move |digit| f64::from(digit) * 10f64.powi(power)))
            .filter(|value| (low..=high).contains(value))
            .collect()
    } else {
        (first..=last)
            .filter(|power| power.rem_euclid(every) != 0)
            .map(|power| 10f64.powi(power))
            .collect()
    };
    Ticks {
        major,
        minor,
        exponent: 0,
    }
}

/// Labels at 1, 2 and 5 times powers of ten for a range of at most two decades; `None` for one so short that equal
/// distances serve better.
fn within_decades(low: f64, high: f64) -> Option<Ticks> {
    const SHORT: f64 = 4.0;
    if high / low < SHORT {
        return None;
    }
    let powers = low.log10().floor() as i32..=high.log10().floor() as i32;
    let mut ticks = Ticks::default();
    for (power, digit) in powers.flat_map(|power| (1..10).map(move |digit| (power, digit))) {
        let value = f64::from(digit) * 10f64.powi(power);
        if !(low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(&value) {
            continue;
        }
        if ![1, 2, 5].contains(&digit) {
            ticks.minor.push(value);
            continue;
        }
        let label = match (power, digit) {
            (-2..=3, _) => decimal(value, usize::try_from(-power).unwrap_or(0)),
            (_, 1) => format!("10^{{{}}}", signed(power)),
            _ => format!("{digit}·10^{{{}}}", signed(power)),
        };
        ticks.major.push(Tick { value, label });
    }
    (ticks.major.len() > 1).then_some(ticks)
}

/// A whole number with a true minus sign.
pub(super) fn signed(value: i32) -> String {
    value.to_string().replace('-', "−")
}

/// A decimal with a true minus sign and no negative zero.
fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_string(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn less_than_two_decades_are_labelled_at_one_two_and_five() {
        let ticks = logarithmic(1.9, 97.0, 5);
        assert_eq!(labels(&ticks), ["2", "5", "10", "20", "50"]);
        assert_eq!(ticks.minor.first(), Some(&3.0));
        assert_eq!(labels(&logarithmic(0.03, 0.3, 5)), ["0.05", "0.1", "0.2"]);
        assert_eq!(
            labels(&logarithmic(3e5, 2e6, 5)),
            ["5·10^{5}", "10^{6}", "2·10^{6}"]
        );
        assert_eq!(
            labels(&logarithmic(100.0, 150.0, 4)),
            labels(&linear(100.0, 150.0, 4))
        );
    }

    #[test]
    fn linear_steps_are_nice() {
        assert_eq!(
            labels(&linear(0.0, 1.0, 5)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(
            labels(&linear(-0.13, 0.11, 5)),
            ["−0.10", "−0.05", "0.00", "0.05", "0.10"]
        );
        assert_eq!(labels(&linear(3.0, 47.0, 5)), ["10", "20", "30", "40"]);
        assert_eq!(linear(0.0, 1.0, 5).minor.len(), 15);
        assert_eq!(linear(0.0, 0.3, 3).major[3].value, 0.3);
    }

    #[test]
    fn large_and_small_numbers_share_a_power() {
        let large = linear(0.0, 250_000.0, 5);
        assert_eq!(large.exponent, 3);
        assert_eq!(labels(&large), ["0", "50", "100", "150", "200", "250"]);
        let small = linear(0.0, 4e-6, 4);
        assert_eq!(small.exponent, -6);
        assert_eq!(labels(&small), ["0", "1", "2", "3", "4"]);
        let middle = linear(0.0, 2e-3, 4);
        assert_eq!((middle.exponent, labels(&middle)[1]), (-3, "0.5"));
    }

    #[test]
    fn logarithmic_marks_powers() {
        let wide = logarithmic(1e-6, 1e3, 10);
        assert_eq!(wide.major.len(), 10);
        assert_eq!(wide.major[0].label, "10^{−6}");
        let narrow = logarithmic(0.1, 100.0, 6);
        assert_eq!(labels(&narrow), ["0.1", "1", "10", "100"]);
        assert_eq!(narrow.minor.len(), 24);
        // 300 decades: few labels.
        assert!(logarithmic(1e-290, 1e10, 6).major.len() <= 8);
        // Inside one decade: linear numbers.
        assert_eq!(labels(&logarithmic(2.0, 7.0, 6)), ["2", "4", "6"]);
    }

    #[test]
    fn a_given_step_is_kept_while_the_labels_are_few() {
        let range = |low, high| Range {
            low,
            high,
            scale: Scale::Linear,
        };
        let ticks = stepped(&range(-180.0, 180.0), 90.0, 6).unwrap();
        assert_eq!(labels(&ticks), ["−180", "−90", "0", "90", "180"]);
        assert_eq!(
            ticks.minor,
            [-150.0, -120.0, -60.0, -30.0, 30.0, 60.0, 120.0, 150.0]
        );
        assert_eq!(stepped(&range(-180.0, 180.0), 90.0, 3), None);
        for (low, high, step) in [
            (0.0, 1e300, 1.0),
            (-1e300, 1e300, 1e-300),
            (0.0, 1.0, 0.0),
            (0.0, 1.0, f64::NAN),
        ] {
            assert_eq!(stepped(&range(low, high), step, 9), None, "{low} {high} {step}");
        }
    }

    #[test]
    fn extreme_ranges_stay_finite_and_few() {
        for (low, high) in [
            (0.0, 1e300),
            (-1e300, 1e300),
            (0.0, 1e-300),
            (1e9, 1e9 + 1e-3),
            (-5e-324, 5e-324),
            (1.0, 1.0 + 1e-12),
        ] {
            let ticks = linear(low, high, 6);
            assert!(ticks.major.len() <= 13, "{low} {high}: {ticks:?}");
            assert!(ticks.major.iter().all(|tick| tick.value.is_finite()));
        }
        assert_eq!(linear(1.0, f64::NAN, 5), Ticks::default());
        assert_eq!(logarithmic(-1.0, 1.0, 5), Ticks::default());
    }
}
