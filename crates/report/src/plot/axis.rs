//! An axis: what is measured, in which unit, over which range, on which scale.

/// Spacing of values along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal distances for equal differences.
    #[default]
    Linear,
    /// Equal distances for equal ratios; values that are not positive are not drawn.
    Logarithmic,
}

/// An axis of a panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// The quantity, for example `Excitation frequency Ω`. `_{…}` lowers and `^{…}` raises what stands in the
    /// braces.
    pub label: String,
    /// The unit, for example `Hz`, or `–` for a dimensionless quantity; nothing is written when it is empty.
    pub unit: String,
    /// Lower and upper end; from the data when absent.
    pub limits: Option<(f64, f64)>,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Distance of labelled ticks of a linear axis, for example 90 for angles in degrees; chosen from 1, 2 and 5
    /// times a power of ten when absent or when the labels would touch.
    pub step: Option<f64>,
    /// Names that stand at values in place of numbers, in any order; none for an axis of numbers.
    pub names: Vec<(f64, String)>,
}

impl Axis {
    /// A linear axis that takes its limits from the data.
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Axis {
            label: label.into(),
            unit: unit.into(),
            limits: None,
            scale: Scale::Linear,
            step: None,
            names: Vec::new(),
        }
    }

    /// A logarithmic axis that takes its limits from the data.
    pub fn logarithmic(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Axis {
            scale: Scale::Logarithmic,
            ..Axis::linear(label, unit)
        }
    }

    /// The same axis with given limits.
    pub fn with_limits(self, low: f64, high: f64) -> Self {
        Axis {
            limits: Some((low, high)),
            ..self
        }
    }

    /// The same axis with a given distance of labelled ticks.
    pub fn with_step(self, step: f64) -> Self {
        Axis {
            step: Some(step),
            ..self
        }
    }

    /// Label with unit and the common power of ten of the tick labels, `Torque (10^{3} N m)`.
    pub(super) fn text(&self, exponent: i32) -> String {
        let unit = match (exponent, self.unit.as_str()) {
            (0, "") => return self.label.clone(),
            (0, unit) => unit.to_string(),
            (power, "" | "–" | "-") => format!("10^{{{}}}", super::ticks::signed(power)),
            (power, unit) => format!("10^{{{}}} {unit}", super::ticks::signed(power)),
        };
        if self.label.is_empty() {
            format!("({unit})")
        } else {
            format!("{} ({unit})", self.label)
        }
    }
}

/// The interval an axis shows, ready to map values to fractions of its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
    pub scale: Scale,
}

impl Range {
    /// From the axis' own limits, or the extent of the data widened by `margin` (a fraction of the span, at
    /// both ends). Never empty, always finite.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>, margin: f64, from_zero: bool) -> Range {
        let logarithmic = axis.scale == Scale::Logarithmic;
        let valid = |value: &f64| value.is_finite() && (!logarithmic || *value > 0.0);
        let mut extent: Option<(f64, f64)> = None;
        for value in values.filter(valid) {
            extent = Some(extent.map_or((value, value), |(low, high)| (low.min(value), high.max(value))));
        }
        let given = axis
            .limits
            .map(|(a, b)| (a.min(b), a.max(b)))
            .filter(|(a, b)| valid(a) && valid(b));
        let (mut low, mut high) =
            given
                .or(extent)
                .unwrap_or(if logarithmic { (1.0, 10.0) } else { (0.0, 1.0) });
        if logarithmic {
            (low, high) = (low.clamp(1e-300, 1e300), high.clamp(1e-300, 1e300));
            if high / low < 1.0 + 1e-9 {
                (low, high) = (low / 2.0, high * 2.0);
            } else if given.is_none() {
                let widen = (high.ln() - low.ln()) * margin;
                low = (low.ln() - widen).exp();
                high = (high.ln() + widen).exp();
            }
            return Range {
                low,
                high,
                scale: axis.scale,
            };
        }
        // Stay away from the overflow of differences.
        (low, high) = (low.clamp(-1e300, 1e300), high.clamp(-1e300, 1e300));
        let size = low.abs().max(high.abs());
        if high - low <= (size * 1e-10).max(1e-290) {
            // All values equal: show them in the middle.
            let half = if size < 1e-290 { 1.0 } else { 0.05 * size };
            (low, high) = (low - half, high + half);
        } else if given.is_none() {
            let widen = (high - low) * margin;
            let rests_on_zero = from_zero && low >= 0.0 && low < 0.25 * high;
            low = if rests_on_zero { 0.0 } else { low - widen };
            high += widen;
        }
        Range {
            low,
            high,
            scale: axis.scale,
        }
    }

    /// Position of `value` as a fraction of the axis, 0 at the low end; `None` where it cannot be drawn.
    pub fn fraction(&self, value: f64) -> Option<f64> {
        let fraction = match self.scale {
            // Halved, so that the difference of two large numbers cannot overflow.
            Scale::Linear => (value / 2.0 - self.low / 2.0) / (self.high / 2.0 - self.low / 2.0),
            Scale::Logarithmic if value > 0.0 => {
                (value.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
            }
            Scale::Logarithmic => return None,
        };
        fraction.is_finite().then_some(fraction)
    }

    /// Whether `value` lies within the limits, with the tolerance of rounding.
    pub fn contains(&self, value: f64) -> bool {
        self.fraction(value)
            .is_some_and(|fraction| (-1e-9..=1.0 + 1e-9).contains(&fraction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn label_carries_unit_and_power() {
        let axis = Axis::linear("Torque", "N m");
        assert_eq!(axis.text(0), "Torque (N m)");
        assert_eq!(axis.text(3), "Torque (10^{3} N m)");
        assert_eq!(
            Axis::linear("Excitation frequency Ω", "–").text(0),
            "Excitation frequency Ω (–)"
        );
        assert_eq!(Axis::linear("Ω", "–").text(-3), "Ω (10^{−3})");
        assert_eq!(Axis::linear("Count", "").text(0), "Count");
    }

    #[test]
    fn ranges_are_never_empty() {
        for values in [
            vec![],
            vec![0.0],
            vec![3.0; 4],
            vec![f64::NAN],
            vec![1e308, -1e308],
            vec![5e-324],
        ] {
            for axis in [Axis::linear("", ""), Axis::logarithmic("", "")] {
                let range = Range::new(&axis, values.iter().copied(), 0.05, true);
                assert!(range.low < range.high && range.low.is_finite() && range.high.is_finite());
                let (low, high) = (
                    range.fraction(range.low).unwrap(),
                    range.fraction(range.high).unwrap(),
                );
                assert!(
                    low.abs() < 1e-9 && (high - 1.0).abs() < 1e-9,
                    "{values:?} {axis:?} {range:?}"
                );
            }
        }
    }

    #[test]
    fn amplitudes_rest_on_zero_and_offsets_do_not() {
        let axis = Axis::linear("", "");
        assert_eq!(Range::new(&axis, [0.01, 2.0].into_iter(), 0.05, true).low, 0.0);
        assert!(Range::new(&axis, [1.9, 2.0].into_iter(), 0.05, true).low > 1.8);
    }

    #[test]
    fn given_limits_are_kept_and_ordered() {
        let axis = Axis::linear("", "").with_limits(4.0, 1.0);
        let range = Range::new(&axis, [100.0].into_iter(), 0.05, true);
        assert_eq!((range.low, range.high), (1.0, 4.0));
    }
}
