//! Forced response by orders: amplitude, and phase if wanted, of measures over speed.

use super::number::short;
use super::{FigureOptions, shared_legend};
use crate::plot::{Axis, Color, Dash, Figure, Layer, LegendEntry, Panel, Stroke, Width};

/// Input of [`order_response`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OrderResponse {
    /// Speed.
    pub speed: Axis,
    /// The measures, one panel each.
    pub measures: Vec<OrderMeasure>,
    /// Phase in degrees, in a panel below each measure; none when absent.
    pub phase: Option<Axis>,
}

/// A measure over speed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OrderMeasure {
    /// Amplitude, linear or logarithmic.
    pub amplitude: Axis,
    /// What stands over the panel; may be empty.
    pub heading: String,
    /// The orders.
    pub orders: Vec<OrderCurve>,
    /// Sums over the orders, for example RMS or peak.
    pub totals: Vec<super::Curve>,
}

/// One order of a measure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OrderCurve {
    /// The order.
    pub order: f64,
    /// Speeds.
    pub speed: Vec<f64>,
    /// Amplitudes, as many.
    pub amplitude: Vec<f64>,
    /// Phases, degrees, as many; empty where they are not known.
    pub phase: Vec<f64>,
}

/// Colours of orders; totals are black.
const ORDERS: [Color; 6] = [
    Color::BLUE,
    Color::ORANGE,
    Color::VERMILLION,
    Color::SKY_BLUE,
    Color::GREEN,
    Color::PURPLE,
];

/// Draws the amplitude of measures over speed for each order, with totals in black. Orders look alike in all
/// panels. Panels stand below each other, with a common speed axis; on a wide page phases stand beside their
/// amplitudes.
pub fn order_response(input: &OrderResponse, options: &FigureOptions) -> Figure {
    let orders = orders(input);
    let mut rows: Vec<Vec<Panel>> = Vec::new();
    for measure in &input.measures {
        let amplitude = amplitude_panel(input, measure, &orders);
        let phase = input
            .phase
            .as_ref()
            .map(|axis| phase_panel(input, axis, measure, &orders));
        match (phase, options.width) {
            (None, _) => rows.push(vec![amplitude]),
            (Some(phase), Width::Double) => rows.push(vec![amplitude, phase]),
            (Some(phase), Width::Single) => rows.extend([vec![amplitude], vec![phase]]),
        }
    }
    let legend = shared_legend(rows.iter_mut().flatten());
    let count = rows.len().max(1) as f64;
    let mut figure = options.figure(rows, 24.0 + 38.0 * count, 24.0 + 42.0 * count);
    figure.share_x = true;
    figure.legend = legend;
    figure
}

/// All different orders in ascending order.
fn orders(input: &OrderResponse) -> Vec<f64> {
    let mut orders: Vec<f64> = input
        .measures
        .iter()
        .flat_map(|measure| measure.orders.iter().map(|curve| curve.order))
        .collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    orders
}

/// The look of an order.
fn stroke(order: f64, orders: &[f64]) -> Stroke {
    let index = orders.iter().position(|other| *other == order).unwrap_or(0);
    // After six colours the dash pattern changes.
    Stroke::solid(ORDERS[index % ORDERS.len()]).with_dash(Dash::of_curve(index / ORDERS.len()))
}

fn order_name(order: f64) -> String {
    format!("order {}", short(order))
}

fn amplitude_panel(input: &OrderResponse, measure: &OrderMeasure, orders: &[f64]) -> Panel {
    let mut panel = Panel {
        x: input.speed.clone(),
        y: measure.amplitude.clone(),
        heading: (!measure.heading.is_empty()).then(|| measure.heading.clone()),
        ..Panel::default()
    };
    for curve in &measure.orders {
        let stroke = stroke(curve.order, orders);
        let points = curve.speed.iter().zip(&curve.amplitude);
        panel.layers.push(Layer::Line {
            points: points.map(|(x, y)| [*x, *y]).collect(),
            stroke,
        });
        panel
            .legend
            .push(LegendEntry::line(order_name(curve.order), stroke));
    }
    for (index, total) in measure.totals.iter().enumerate() {
        let stroke = Stroke::solid(Color::BLACK)
            .with_width(1.2)
            .with_dash(Dash::of_curve(index));
        panel.layers.push(Layer::Line {
            points: total.points(),
            stroke,
        });
        if !total.name.is_empty() {
            panel.legend.push(LegendEntry::line(&total.name, stroke));
        }
    }
    panel
}

fn phase_panel(input: &OrderResponse, axis: &Axis, measure: &OrderMeasure, orders: &[f64]) -> Panel {
    let mut axis = axis.clone();
    axis.limits = axis.limits.or(Some((-180.0, 180.0)));
    axis.step = axis.step.or(Some(90.0));
    Panel {
        x: input.speed.clone(),
        y: axis,
        layers: measure
            .orders
            .iter()
            .map(|curve| Layer::Line {
                points: wrapped(&curve.speed, &curve.phase),
                stroke: stroke(curve.order, orders),
            })
            .collect(),
        ..Panel::default()
    }
}

/// A phase curve within ±180°: where it leaves the interval on one side it is interrupted and returns on the
/// other.
fn wrapped(speed: &[f64], phase: &[f64]) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (speed, phase) in speed.iter().zip(phase) {
        let here = [*speed, (phase + 180.0).rem_euclid(360.0) - 180.0];
        if let Some(before) = points.last().copied() {
            let step = here[1] - before[1];
            if step.abs() > 180.0 {
                // Seen from the point before, this one lies a turn away, beyond the edge.
                let edge = -180.0 * step.signum();
                let beyond = here[1] + 2.0 * edge;
                let t = (edge - before[1]) / (beyond - before[1]);
                let crossing = before[0] + t * (here[0] - before[0]);
                points.extend([[crossing, edge], [f64::NAN, f64::NAN], [crossing, -edge]]);
            }
        }
        points.push(here);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_leave_at_one_edge_and_return_at_the_other() {
        let points = wrapped(&[1.0, 2.0, 3.0], &[-170.0, -190.0, -550.0]);
        assert_eq!(points[..2], [[1.0, -170.0], [1.5, -180.0]]);
        assert!(points[2][0].is_nan());
        assert_eq!(points[3..], [[1.5, 180.0], [2.0, 170.0], [3.0, 170.0]]);
        let rising = wrapped(&[0.0, 1.0], &[150.0, 200.0]);
        assert!((rising[1][0] - 0.6).abs() < 1e-12 && rising[1][1] == 180.0 && rising[3][1] == -180.0);
    }

    #[test]
    fn orders_keep_their_look() {
        let orders = [0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0];
        let looks: Vec<Stroke> = orders.iter().map(|order| stroke(*order, &orders)).collect();
        for (index, look) in looks.iter().enumerate() {
            assert!(looks[..index].iter().all(|other| other != look));
        }
    }
}
