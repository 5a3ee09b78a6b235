//! Equal scales on both axes, for drawings to scale.

use super::axis::{Range, Scale};
use super::svg::Rect;

/// Widens one of two linear ranges about its middle until a unit is as long in y as in x on a frame. Ranges of
/// which one is logarithmic stay as they are.
pub(super) fn equal(x: Range, y: Range, frame: &Rect) -> (Range, Range) {
    if x.scale != Scale::Linear || y.scale != Scale::Linear {
        return (x, y);
    }
    let unit = ((x.high - x.low) / frame.width).max((y.high - y.low) / frame.height);
    (
        about_middle(x, unit * frame.width),
        about_middle(y, unit * frame.height),
    )
}

fn about_middle(range: Range, span: f64) -> Range {
    let middle = range.low / 2.0 + range.high / 2.0;
    Range {
        low: middle - span / 2.0,
        high: middle + span / 2.0,
        ..range
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_become_equal_and_nothing_is_cut_off() {
        let range = |low, high| Range {
            low,
            high,
            scale: Scale::Linear,
        };
        for (width, height) in [(200.0, 50.0), (50.0, 200.0), (100.0, 100.0)] {
            let frame = Rect {
                x: 7.0,
                y: 9.0,
                width,
                height,
            };
            let (x, y) = equal(range(-1.0, 3.0), range(2.0, 5.0), &frame);
            let units = ((x.high - x.low) / width, (y.high - y.low) / height);
            assert!((units.0 - units.1).abs() < 1e-12, "{units:?}");
            assert!(x.low <= -1.0 && x.high >= 3.0 && y.low <= 2.0 && y.high >= 5.0);
        }
    }
}
