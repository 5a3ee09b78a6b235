//! Ranges as users write them: `KEY=FROM:TO[:STEP]`.

use std::str::FromStr;

/// A range of one key, in the user's unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// `frequency`, or any key of the model that holds a number.
    pub key: String,
    /// First value.
    pub from: f64,
    /// Last value, above the first.
    pub to: f64,
    /// Distance of values, positive.
    pub step: Option<f64>,
}

/// Why a text is not a range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "`{text}` is not a range: {reason}; write KEY=FROM:TO or KEY=FROM:TO:STEP, for example frequency=0.5:9"
)]
pub struct RangeError {
    text: String,
    reason: String,
}

/// Most values that a range may have.
const MOST_VALUES: f64 = 1e6;

impl Range {
    /// Lower and upper end.
    pub fn bounds(&self) -> (f64, f64) {
        (self.from.min(self.to), self.from.max(self.to))
    }

    /// The values from first to last, by the range's step or, without one, `count` of them. The last value is met exactly
    /// if the step divides the range (to a millionth of a step), otherwise values end before it.
    pub fn values(&self, count: usize) -> Vec<f64> {
        let span = self.to - self.from;
        match self.step {
            Some(step) => {
                let steps = (span / step + 1e-6).floor();
                let exact = (steps * step - span).abs() <= 1e-6 * step;
                (0..=steps as usize)
                    .map(|i| {
                        if exact && i as f64 == steps {
                            self.to
                        } else {
                            self.from + i as f64 * step
                        }
                    })
                    .collect()
            }
            None if count < 2 => vec![self.from],
            None => (0..count)
                .map(|i| self.from + span * i as f64 / (count - 1) as f64)
                .collect(),
        }
    }
}

impl FromStr for Range {
    type Err = RangeError;

    fn from_str(text: &str) -> Result<Self, RangeError> {
        let fault = |reason: &str| RangeError {
            text: text.to_owned(),
            reason: reason.to_owned(),
        };
        let (key, values) = text.split_once('=').ok_or_else(|| fault("there is no `=`"))?;
        let key = key.trim();
        if key.is_empty() {
            return Err(fault("the key is missing"));
        }
        let mut numbers = Vec::new();
        for part in values.split(':') {
            let number: f64 = part
                .trim()
                .parse()
                .map_err(|_| fault(&format!("`{}` is not a number", part.trim())))?;
            if !number.is_finite() {
                return Err(fault("all numbers must be finite"));
            }
            numbers.push(number);
        }
        let (from, to, step) = match numbers[..] {
            [from, to] => (from, to, None),
            [from, to, step] => (from, to, Some(step)),
            _ => return Err(fault("it needs two or three numbers")),
        };
        if from == to {
            return Err(fault("both ends are equal"));
        }
        if from > to {
            return Err(fault("the ends are reversed, the lower one comes first"));
        }
        if let Some(step) = step {
            if step <= 0.0 {
                return Err(fault("the step must be positive"));
            }
            if (to - from) / step > MOST_VALUES {
                return Err(fault("that are more than a million values"));
            }
        }
        Ok(Self {
            key: key.to_owned(),
            from,
            to,
            step,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_meet_both_ends_when_the_step_divides_the_range() {
        let range: Range = "dimensionless.preload=0.1:0.4:0.1".parse().unwrap();
        assert_eq!(range.key, "dimensionless.preload");
        assert_eq!(range.values(0), [0.1, 0.2, 0.1 + 2.0 * 0.1, 0.4]);
        let short: Range = "frequency=1:2:0.4".parse().unwrap();
        assert_eq!(short.values(0), [1.0, 1.4, 1.8]);
        let plain: Range = "frequency=1:2".parse().unwrap();
        assert_eq!(plain.values(3), [1.0, 1.5, 2.0]);
        assert_eq!(plain.values(1), [1.0]);
    }

    #[test]
    fn texts_that_are_no_ranges_are_told_why() {
        for (text, reason) in [
            ("frequency", "no `=`"),
            ("=1:2", "key is missing"),
            ("f=1", "two or three numbers"),
            ("f=1:2:3:4", "two or three numbers"),
            ("f=1:x", "`x` is not a number"),
            ("f=1:inf", "finite"),
            ("f=1:1", "equal"),
            ("f=9:1", "reversed"),
            ("f=1:2:0", "positive"),
            ("f=0:1:1e-9", "million"),
        ] {
            let message = text.parse::<Range>().unwrap_err().to_string();
            assert!(message.contains(reason), "{text}: {message}");
        }
    }
}
