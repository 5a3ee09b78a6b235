//! Hub loads in polar diagrams: magnitude and direction over speed, one diagram for each pulley.

use std::f64::consts::TAU;

use super::FigureOptions;
use super::number::short;
use crate::plot::{
    Axis, Color, Dash, Figure, Layer, LegendEntry, Marker, Note, NotePlace, Panel, Shape, Stroke, Width,
    circle, direction, linear_ticks,
};

/// Input of [`hub_load_polar`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HubLoadPolar {
    /// The pulleys, one diagram for each.
    pub pulleys: Vec<HubLoadPath>,
    /// Speeds whose points are marked, in the unit of the paths; the nearest point of a path is taken.
    pub marked_speeds: Vec<f64>,
    /// Unit of the speed, for example `rpm`.
    pub speed_unit: String,
    /// Unit of the load, for example `N`.
    pub load_unit: String,
}

/// The hub load of one pulley over speed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HubLoadPath {
    /// Name of the pulley.
    pub name: String,
    /// Speeds, in the order of the path.
    pub speed: Vec<f64>,
    /// Loads `[x, y]`, as many.
    pub load: Vec<[f64; 2]>,
}

const GRID: Stroke = Stroke {
    color: Color(190, 190, 190),
    width: 0.4,
    dash: Dash::Solid,
};
const PATH: Stroke = Stroke {
    color: Color::BLUE,
    width: 1.3,
    dash: Dash::Solid,
};
const VECTOR: Stroke = Stroke {
    color: Color::GREY,
    width: 0.6,
    dash: Dash::Solid,
};
const MARK: Marker = Marker {
    shape: Shape::Circle,
    size: 3.0,
    filled: true,
    color: Color::BLUE,
};

/// Draws a polar diagram for each pulley: rings of equal load, angles from the x axis counter-clockwise, the
/// path of the load over speed, and the load as a vector at the marked speeds.
pub fn hub_load_polar(input: &HubLoadPolar, options: &FigureOptions) -> Figure {
    let columns = match (options.width, input.pulleys.len()) {
        (_, 0 | 1) => 1,
        (Width::Single, _) | (Width::Double, 2 | 4) => 2,
        (Width::Double, _) => 3,
    };
    let panels: Vec<Panel> = input.pulleys.iter().map(|path| diagram(input, path)).collect();
    let rows: Vec<Vec<Panel>> = panels.chunks(columns).map(<[Panel]>::to_vec).collect();
    let cell = (options.width.millimetres() / columns as f64).min(95.0);
    let height = rows.len().max(1) as f64 * (cell + 4.0) + 6.0;
    let mut figure = options.figure(rows, height, height);
    figure.legend = vec![
        LegendEntry::line(format!("hub load in {} over speed", input.load_unit), PATH),
        LegendEntry::marker(format!("at a speed in {}", input.speed_unit), MARK),
    ];
    figure
}

fn diagram(input: &HubLoadPolar, path: &HubLoadPath) -> Panel {
    let largest = path
        .load
        .iter()
        .map(|load| load[0].hypot(load[1]))
        .filter(|load| load.is_finite())
        .fold(0.0, f64::max);
    let (step, rings) = rings(largest);
    let radius = step * rings as f64;
    let at = |radius: f64, angle: f64| [radius * angle.cos(), radius * angle.sin()];
    let mut layers: Vec<Layer> = (1..=rings)
        .map(|ring| circle([0.0, 0.0], step * ring as f64))
        .chain((0..8).map(|spoke| vec![[0.0, 0.0], at(radius, TAU * f64::from(spoke) / 8.0)]))
        .map(|points| Layer::Line { points, stroke: GRID })
        .collect();
    let marked = marked(path, &input.marked_speeds);
    for index in &marked {
        layers.push(Layer::Arrow {
            points: vec![[0.0, 0.0], path.load[*index]],
            stroke: VECTOR,
            head: 4.0,
        });
    }
    layers.push(Layer::Line {
        points: path.load.clone(),
        stroke: PATH,
    });
    layers.push(Layer::Points {
        points: marked.iter().map(|index| path.load[*index]).collect(),
        marker: MARK,
    });
    let mut notes: Vec<Note> = (0..8)
        .map(|spoke| Note {
            text: format!("{}°", 45 * spoke),
            anchors: vec![at(1.16 * radius, TAU * f64::from(spoke) / 8.0)],
            place: NotePlace::Over,
        })
        .collect();
    let free = free_direction(&path.load);
    // From the outside: where two would touch, the outermost stays.
    notes.extend((1..=rings).rev().map(|ring| Note {
        text: short(step * ring as f64),
        anchors: vec![at(step * ring as f64, free)],
        place: NotePlace::Over,
    }));
    notes.extend(marked.iter().map(|index| Note {
        text: short(path.speed[*index]),
        anchors: vec![path.load[*index]],
        place: NotePlace::Beside {
            radius: 0.0,
            toward: away(&path.load, path.load[*index]),
            reach: 90.0,
        },
    }));
    let limits = 1.3 * radius;
    let axis = |label: &str| Axis::linear(label, &input.load_unit).with_limits(-limits, limits);
    Panel {
        x: axis("x"),
        y: axis("y"),
        layers,
        notes,
        heading: (!path.name.is_empty()).then(|| path.name.clone()),
        equal_aspect: true,
        bare: true,
        ..Panel::default()
    }
}

/// Distance and number of the rings that hold a load.
fn rings(largest: f64) -> (f64, usize) {
    let ticks = linear_ticks(0.0, largest, 4).major;
    let step = match ticks.as_slice() {
        [first, second, ..] => second.value - first.value,
        _ => return (1.0, 1),
    };
    let count = (largest / step - 1e-9).ceil().clamp(1.0, 20.0);
    (step, count as usize)
}

/// Indices of the points nearest to the marked speeds, each once, in their order.
fn marked(path: &HubLoadPath, speeds: &[f64]) -> Vec<usize> {
    let count = path.speed.len().min(path.load.len());
    let mut indices: Vec<usize> = Vec::new();
    for speed in speeds.iter().filter(|speed| speed.is_finite()) {
        let nearest = (0..count)
            .filter(|index| path.speed[*index].is_finite())
            .min_by(|a, b| {
                let distance = |index: &usize| (path.speed[*index] - speed).abs();
                distance(a).total_cmp(&distance(b))
            });
        indices.extend(nearest.filter(|index| !indices.contains(index)));
    }
    indices
}

/// The direction in which the name of a point stands clear of the path: outward, to the side of it where fewer
/// loads lie.
fn away(loads: &[[f64; 2]], load: [f64; 2]) -> [f64; 2] {
    let turned: f64 = loads
        .iter()
        .map(|other| load[0] * other[1] - load[1] * other[0])
        .filter(|cross| cross.is_finite())
        .map(f64::signum)
        .sum();
    let side = if turned > 0.0 { 1.0 } else { -1.0 };
    [load[0] + side * load[1], load[1] - side * load[0]]
}

/// A direction between two spokes away from all loads, rather a steep one, where labels stand above each other.
fn free_direction(loads: &[[f64; 2]]) -> f64 {
    let between = |spoke: u32| TAU * (f64::from(spoke) + 0.5) / 8.0;
    let distance = |angle: f64| {
        loads
            .iter()
            .map(|load| direction([0.0, 0.0], *load))
            .filter(|other| other.is_finite())
            .map(|other| {
                let turn = (angle - other).rem_euclid(TAU);
                turn.min(TAU - turn)
            })
            .fold(f64::INFINITY, f64::min)
    };
    (0..8)
        .map(between)
        .max_by(|a, b| {
            let merit = |angle: f64| distance(angle).min(1.2) + 0.3 * angle.sin().abs();
            merit(*a).total_cmp(&merit(*b))
        })
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_hold_the_load() {
        assert_eq!(rings(830.0), (500.0, 2));
        assert_eq!(rings(1000.0), (500.0, 2));
        assert_eq!(rings(0.0), (1.0, 1));
        assert_eq!(rings(f64::NAN), (1.0, 1));
        for largest in [1e-3, 0.7, 12.0, 999.0, 4321.0] {
            let (step, count) = rings(largest);
            assert!(step * count as f64 >= largest * (1.0 - 1e-9) && count <= 5);
        }
    }

    #[test]
    fn marks_are_the_nearest_points() {
        let path = HubLoadPath {
            speed: vec![800.0, 1600.0, 2400.0],
            load: vec![[1.0, 0.0]; 3],
            ..HubLoadPath::default()
        };
        assert_eq!(marked(&path, &[750.0, 2300.0, 2500.0]), [0, 2]);
        assert!(marked(&HubLoadPath::default(), &[1.0]).is_empty());
    }

    #[test]
    fn ring_labels_stand_away_from_the_loads() {
        let angle = free_direction(&[[1.0, 0.1], [1.0, -0.1]]);
        assert!(angle.cos() < 0.0 && angle.sin().abs() > 0.9, "{angle}");
    }
}
