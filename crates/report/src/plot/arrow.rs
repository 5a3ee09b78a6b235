//! Arrows: a polyline with a filled head at its end, on the page.

/// Width of a head relative to its length.
const WIDTH: f64 = 0.72;
/// Part of the head that the shaft reaches into, so that no gap shows.
const OVERLAP: f64 = 0.3;

/// Shaft and head of an arrow on the page.
#[derive(Debug, PartialEq)]
pub(super) struct ArrowOnPage {
    pub shaft: Vec<[f64; 2]>,
    pub head: [[f64; 2]; 3],
}

/// The arrow along a polyline with a head of given length, all in points; `None` when it has no length.
///
/// The head points along the chord of the last part of the line, so that it sits well on an arc.
pub(super) fn on_page(line: &[[f64; 2]], head: f64) -> Option<ArrowOnPage> {
    let tip = *line.last()?;
    let length: f64 = line.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    let head = head.clamp(0.0, length);
    if head <= 0.0 {
        return None;
    }
    let neck = *without_end(line, head).last()?;
    let chord = distance(neck, tip);
    if chord <= 0.0 {
        return None;
    }
    let along = [(tip[0] - neck[0]) / chord, (tip[1] - neck[1]) / chord];
    let corner = |side: f64| {
        let across = side * WIDTH * head / 2.0;
        [
            tip[0] - head * along[0] - across * along[1],
            tip[1] - head * along[1] + across * along[0],
        ]
    };
    Some(ArrowOnPage {
        shaft: without_end(line, head * (1.0 - OVERLAP)),
        head: [tip, corner(1.0), corner(-1.0)],
    })
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The polyline shortened at its end by a length, at most by its own.
fn without_end(line: &[[f64; 2]], by: f64) -> Vec<[f64; 2]> {
    let mut rest = line.to_vec();
    let mut left = by;
    while let [.., before, last] = rest.as_slice() {
        let (before, last) = (*before, *last);
        let step = distance(before, last);
        rest.pop();
        if step > left {
            let t = 1.0 - left / step;
            rest.push([
                before[0] + t * (last[0] - before[0]),
                before[1] + t * (last[1] - before[1]),
            ]);
            break;
        }
        left -= step;
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_ends_at_the_tip_and_the_shaft_inside_the_head() {
        let arrow = on_page(&[[0.0, 0.0], [10.0, 0.0], [20.0, 0.0]], 4.0).unwrap();
        assert_eq!(arrow.head[0], [20.0, 0.0]);
        assert!((arrow.head[1][0] - 16.0).abs() < 1e-12 && (arrow.head[2][0] - 16.0).abs() < 1e-12);
        assert!((arrow.head[1][1] + arrow.head[2][1]).abs() < 1e-12);
        let end = arrow.shaft[arrow.shaft.len() - 1];
        assert!((end[0] - 17.2).abs() < 1e-12, "{end:?}");
    }

    #[test]
    fn a_short_arrow_is_all_head_and_a_point_is_none() {
        let arrow = on_page(&[[0.0, 0.0], [0.0, 2.0]], 4.0).unwrap();
        assert!((arrow.head[1][1]).abs() < 1e-12);
        assert_eq!(on_page(&[[1.0, 1.0]], 4.0), None);
        assert_eq!(on_page(&[], 4.0), None);
        assert_eq!(on_page(&[[1.0, 1.0], [1.0, 1.0]], 4.0), None);
    }
}
