//! Circles and arcs as polylines, in data coordinates.

use std::f64::consts::{PI, TAU};

/// Vertices of a full turn: the polygon stays within 0.015 % of the radius of the circle.
const VERTICES_OF_A_TURN: f64 = 180.0;
/// Longest arc, turns; what is longer only covers itself.
const MOST_TURNS: f64 = 4.0;

/// The arc about `center` that starts in the direction `from` (radians from the x axis, counter-clockwise) and
/// turns by `turn` (radians, negative for clockwise). Both end points belong to it.
pub fn arc(center: [f64; 2], radius: f64, from: f64, turn: f64) -> Vec<[f64; 2]> {
    let turn = turn.clamp(-MOST_TURNS * TAU, MOST_TURNS * TAU);
    if !turn.is_finite() {
        return Vec::new();
    }
    let steps = (turn.abs() / TAU * VERTICES_OF_A_TURN).ceil().max(1.0) as usize;
    (0..=steps)
        .map(|step| {
            let angle = from + turn * step as f64 / steps as f64;
            [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
        })
        .collect()
}

/// The circle about `center`, closed: the last vertex is the first.
pub fn circle(center: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    arc(center, radius, 0.0, TAU)
}

/// The sector between the centre and an [`arc`], as a closed outline.
pub fn sector(center: [f64; 2], radius: f64, from: f64, turn: f64) -> Vec<[f64; 2]> {
    let mut outline = vec![center];
    outline.extend(arc(center, radius, from, turn));
    outline.push(center);
    outline
}

/// The angle, radians in (−π, π], of the direction from one point to another.
pub fn direction(from: [f64; 2], to: [f64; 2]) -> f64 {
    let angle = (to[1] - from[1]).atan2(to[0] - from[0]);
    if angle == -PI { PI } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_starts_and_ends_where_it_should() {
        let points = arc([1.0, 2.0], 3.0, PI / 2.0, -PI);
        let (first, last) = (points[0], points[points.len() - 1]);
        assert!((first[0] - 1.0).abs() < 1e-12 && (first[1] - 5.0).abs() < 1e-12);
        assert!((last[0] - 1.0).abs() < 1e-12 && (last[1] + 1.0).abs() < 1e-12);
        // Clockwise from the top it passes the right-hand side.
        let middle = points[points.len() / 2];
        assert!((middle[0] - 4.0).abs() < 1e-12, "{middle:?}");
    }

    #[test]
    fn a_circle_is_closed_and_round() {
        let points = circle([0.0, 0.0], 2.0);
        assert!(points.iter().all(|p| (p[0].hypot(p[1]) - 2.0).abs() < 1e-12));
        let (first, last) = (points[0], points[points.len() - 1]);
        assert!((first[0] - last[0]).hypot(first[1] - last[1]) < 1e-12);
        let sag = 2.0 * (1.0 - (PI / VERTICES_OF_A_TURN).cos());
        assert!(sag < 0.00016 * 2.0);
    }

    #[test]
    fn angles_that_are_not_finite_give_nothing() {
        assert!(arc([0.0, 0.0], 1.0, 0.0, f64::NAN).is_empty());
        assert!(arc([0.0, 0.0], 1.0, 0.0, 1e30).len() < 1000);
    }
}
