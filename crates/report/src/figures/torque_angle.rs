//! Torque over angle of a tensioner arm: a loop for each friction torque, whose area is the energy dissipated in
//! a cycle.

use super::number::with_unit;
use super::{FigureOptions, extent};
use crate::plot::{Axis, Color, Figure, Layer, LegendEntry, Panel, Stroke, curve_color};

/// Input of [`torque_angle`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TorqueAngle {
    /// Angle of the arm.
    pub angle: Axis,
    /// Friction torque, or torque of the whole arm.
    pub torque: Axis,
    /// The loops.
    pub loops: Vec<FrictionLoop>,
}

/// One cycle of an arm; the loop is closed from the last vertex to the first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FrictionLoop {
    /// Name in the legend, for example `Q_{m} = 2 N m`.
    pub name: String,
    /// Angles in the order of time.
    pub angle: Vec<f64>,
    /// Torques, as many.
    pub torque: Vec<f64>,
    /// Whether the arm sticks from each vertex to the next, as many; it slips beyond its end.
    pub sticks: Vec<bool>,
    /// Energy dissipated in the cycle, joules: the area of the loop.
    pub dissipation: Option<f64>,
}

/// Width of the line where an arm sticks.
const STICK_WIDTH: f64 = 2.3;

/// Length of the heads of arrows.
const HEAD: f64 = 6.0;

/// Draws the loops with arrows in the direction of time, the parts with a sticking arm as thick lines. The legend
/// names each loop and its dissipation.
pub fn torque_angle(input: &TorqueAngle, options: &FigureOptions) -> Figure {
    let mut panel = Panel {
        x: input.angle.clone(),
        y: input.torque.clone(),
        ..Panel::default()
    };
    let vertices = || input.loops.iter().flat_map(FrictionLoop::closed);
    let (angles, torques) = (extent(vertices().map(|p| p[0])), extent(vertices().map(|p| p[1])));
    // Loops must not touch the frame.
    if let (None, Some([low, high])) = (panel.x.limits, angles)
        && high > low
    {
        let margin = 0.06 * (high - low);
        panel.x.limits = Some((low - margin, high + margin));
    }
    let scale = [angles, torques].map(|extent| extent.map_or(1.0, |[low, high]| high - low));
    let mut heads = Vec::new();
    for (index, one) in input.loops.iter().enumerate() {
        let stroke = Stroke::solid(curve_color(index));
        let points = one.closed();
        for stick in stick_parts(&points, &one.sticks) {
            panel.layers.push(Layer::Line {
                points: stick,
                stroke: stroke.with_width(STICK_WIDTH),
            });
        }
        heads.extend(
            arrows(&points, &one.sticks, scale)
                .into_iter()
                .map(|points| Layer::Arrow {
                    points,
                    stroke,
                    head: HEAD,
                }),
        );
        panel.layers.push(Layer::Line { points, stroke });
        if let Some(text) = entry(one) {
            panel.legend.push(LegendEntry::line(text, stroke));
        }
    }
    // No loop hides the arrows of another.
    panel.layers.append(&mut heads);
    if input.loops.iter().any(|one| one.sticks.contains(&true)) {
        let stroke = Stroke::solid(Color::BLACK).with_width(STICK_WIDTH);
        panel.legend.push(LegendEntry::line("arm sticks", stroke));
    }
    options.figure(vec![vec![panel]], 72.0, 90.0)
}

impl FrictionLoop {
    /// The vertices; the first comes again as the last.
    fn closed(&self) -> Vec<[f64; 2]> {
        let pairs = self.angle.iter().zip(&self.torque);
        let mut points: Vec<[f64; 2]> = pairs.map(|(angle, torque)| [*angle, *torque]).collect();
        points.extend(points.first().copied());
        points
    }
}

/// Name and dissipation; `None` without both.
fn entry(one: &FrictionLoop) -> Option<String> {
    let energy = one
        .dissipation
        .filter(|energy| energy.is_finite())
        .map(|energy| match energy.abs() {
            size if size > 0.0 && size < 0.1 => with_unit(1e3 * energy, "mJ"),
            _ => with_unit(energy, "J"),
        });
    match (one.name.as_str(), energy) {
        ("", None) => None,
        ("", Some(energy)) => Some(format!("dissipation {energy}")),
        (name, None) => Some(name.to_string()),
        (name, Some(energy)) => Some(format!("{name}: {energy}")),
    }
}

/// The parts of a loop where the arm sticks.
fn stick_parts(points: &[[f64; 2]], sticks: &[bool]) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut sticking = false;
    for (pair, sticks) in points.windows(2).zip(sticks) {
        match (sticking, sticks, parts.last_mut()) {
            (true, true, Some(part)) => part.push(pair[1]),
            (false, true, _) => parts.push(pair.to_vec()),
            _ => {}
        }
        sticking = *sticks;
    }
    parts
}

/// Two short straight pieces of a loop, on which it slips, for the heads of arrows: those nearest to a quarter and
/// to three quarters of its length. Lengths are measured with the extent of the data in each direction as unit.
fn arrows(points: &[[f64; 2]], sticks: &[bool], scale: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    /// Length of a piece.
    const PIECE: f64 = 0.09;
    /// Places that are tried.
    const PLACES: usize = 200;
    let step = |a: &[f64; 2], b: &[f64; 2]| {
        let length = ((b[0] - a[0]) / scale[0]).hypot((b[1] - a[1]) / scale[1]);
        if length.is_finite() { length } else { 0.0 }
    };
    let mut along = vec![0.0];
    for pair in points.windows(2) {
        along.push(along.last().copied().unwrap_or(0.0) + step(&pair[0], &pair[1]));
    }
    let total = along.last().copied().unwrap_or(0.0);
    if !(total.is_finite() && total > 2.0 * PIECE) {
        return Vec::new();
    }
    let tips = (0..PLACES).map(|place| PIECE + (total - PIECE) * place as f64 / (PLACES - 1) as f64);
    let pieces: Vec<(f64, Vec<[f64; 2]>)> = tips
        .filter(|tip| {
            // The head must not lie on a corner, so the loop is straight for a while behind the tip, too.
            let end = (tip + PIECE / 2.0).min(total);
            let (tail, ahead) = (at(points, &along, tip - PIECE), at(points, &along, end));
            let chord = step(&tail, &ahead);
            // The arm moves: no jump of the torque at a reversal.
            let moves = ((ahead[0] - tail[0]) / scale[0]).abs() > 0.3 * chord;
            let first = along.partition_point(|length| *length <= tip - PIECE).max(1) - 1;
            let last = along.partition_point(|length| *length < end);
            let slips = (first..last).all(|vertex| sticks.get(vertex) != Some(&true));
            slips && moves && chord > 0.995 * (end - (tip - PIECE))
        })
        .map(|tip| {
            let mut piece = vec![at(points, &along, tip - PIECE)];
            let inner = along
                .iter()
                .zip(points)
                .filter(|(length, _)| (tip - PIECE..tip).contains(*length));
            piece.extend(inner.map(|(_, point)| *point));
            piece.push(at(points, &along, tip));
            (tip, piece)
        })
        .collect();
    [0.25, 0.75]
        .into_iter()
        .filter_map(|share| {
            let distance = |tip: f64| (tip - share * total).abs();
            let nearest = pieces
                .iter()
                .min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)))?;
            Some(nearest.1.clone())
        })
        .collect()
}

/// The point of a polyline at a length along it.
fn at(points: &[[f64; 2]], along: &[f64], length: f64) -> [f64; 2] {
    let after = along
        .partition_point(|value| *value < length)
        .clamp(1, points.len() - 1);
    let (a, b) = (points[after - 1], points[after]);
    let t = (length - along[after - 1]) / (along[after] - along[after - 1]);
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];

    #[test]
    fn arrows_point_in_the_direction_of_time_where_the_arm_slips() {
        let arrows = arrows(&SQUARE, &[false, true, false, true], [1.0, 1.0]);
        assert_eq!(arrows.len(), 2);
        let ends = |piece: &[[f64; 2]]| (piece[0], piece[piece.len() - 1]);
        let (tail, tip) = ends(&arrows[0]);
        assert!(
            tail[1] == 0.0 && tip[1] == 0.0 && tail[0] < tip[0] && tip[0] < 1.0,
            "{tail:?} {tip:?}"
        );
        let (tail, tip) = ends(&arrows[1]);
        assert!(
            tail[1] == 1.0 && tip[1] == 1.0 && tail[0] > tip[0],
            "{tail:?} {tip:?}"
        );
        // Upright sides are jumps of the torque, wherever they stand.
        let upright = [[0.0, 0.0], [0.0, 1.0], [0.001, 1.0], [0.001, 0.0], [0.0, 0.0]];
        assert!(super::arrows(&upright, &[], [1.0, 1.0]).is_empty());
        assert!(super::arrows(&SQUARE, &[true; 4], [1.0, 1.0]).is_empty());
        assert!(super::arrows(&[[1.0, 1.0]; 3], &[], [0.0, 0.0]).is_empty());
        assert!(super::arrows(&[], &[], [1.0, 1.0]).is_empty());
    }

    #[test]
    fn sticking_parts_are_found() {
        let parts = stick_parts(&SQUARE, &[false, true, false, true]);
        assert_eq!(
            parts,
            [vec![[1.0, 0.0], [1.0, 1.0]], vec![[0.0, 1.0], [0.0, 0.0]]]
        );
        assert_eq!(stick_parts(&SQUARE, &[true; 4])[0].len(), 5);
    }

    #[test]
    fn the_legend_names_the_energy() {
        let one = |name: &str, dissipation| {
            entry(&FrictionLoop {
                name: name.into(),
                dissipation,
                ..FrictionLoop::default()
            })
        };
        assert_eq!(one("Q = 2", Some(0.512)).as_deref(), Some("Q = 2: 0.512 J"));
        assert_eq!(one("", Some(0.02)).as_deref(), Some("dissipation 20 mJ"));
        assert_eq!(one("", None), None);
    }
}
