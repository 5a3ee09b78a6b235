//! Dissipation in a cycle over the Coulomb torque, with its optimum, and the counters of reversals and stops.

use super::number::with_unit;
use super::{Curve, FigureOptions, extent};
use crate::plot::{
    Axis, Color, Dash, Figure, Layer, LegendEntry, LegendPlace, Marker, Panel, Scale, Shape, Stroke,
    curve_color,
};

/// Input of [`dissipation`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Dissipation {
    /// Coulomb torque.
    pub torque: Axis,
    /// Energy dissipated in a cycle.
    pub energy: Axis,
    /// The curves, one for each operating point.
    pub curves: Vec<DissipationCurve>,
    /// How the arm moves in intervals of the torque, where one operating point is shown.
    pub regions: Vec<FrictionRegion>,
    /// A second panel with counters.
    pub counters: Option<ReversalCounters>,
}

/// Dissipation at one operating point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DissipationCurve {
    /// Torques and energies; the name, for example `Ω = 300 rad/s`, may be empty.
    pub curve: Curve,
    /// Torque and energy of the largest dissipation.
    pub optimum: Option<[f64; 2]>,
}

/// An interval of the torque in which the arm moves in one way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionRegion {
    /// Lower end.
    pub from: f64,
    /// Upper end; beyond the panel for an open interval.
    pub to: f64,
    /// How the arm moves.
    pub kind: FrictionRegionKind,
}

/// How an arm with dry friction moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrictionRegionKind {
    /// It slips all the time.
    Slip,
    /// It sticks for a part of the cycle.
    StickSlip,
    /// It does not move.
    Locked,
}

impl FrictionRegionKind {
    /// All kinds in the order of the legend.
    const ALL: [FrictionRegionKind; 3] = [
        FrictionRegionKind::Slip,
        FrictionRegionKind::StickSlip,
        FrictionRegionKind::Locked,
    ];

    fn name(self) -> &'static str {
        match self {
            FrictionRegionKind::Slip => "slip",
            FrictionRegionKind::StickSlip => "stick–slip",
            FrictionRegionKind::Locked => "locked",
        }
    }

    /// The darker, the less the arm moves.
    fn color(self) -> Color {
        match self {
            FrictionRegionKind::Slip => Color::WHITE,
            FrictionRegionKind::StickSlip => Color(235, 240, 246),
            FrictionRegionKind::Locked => Color(208, 208, 208),
        }
    }
}

/// Counters over the torque.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReversalCounters {
    /// The axis of both, a number.
    pub count: Axis,
    /// Reversals of the arm in a cycle.
    pub reversals: Curve,
    /// Stops in each half cycle.
    pub stops: Curve,
}

const OPTIMUM: Marker = Marker {
    shape: Shape::Diamond,
    size: 4.4,
    filled: true,
    color: Color::VERMILLION,
};

/// Draws the dissipation over the torque and, below it, the counters as steps. The legend tells the optimum of each
/// curve; the regions are shaded in both panels.
pub fn dissipation(input: &Dissipation, options: &FigureOptions) -> Figure {
    let mut energy = Panel {
        x: input.torque.clone(),
        y: input.energy.clone(),
        layers: shading(&input.regions),
        legend_place: LegendPlace::Above,
        ..Panel::default()
    };
    let mut optima = Vec::new();
    for (index, one) in input.curves.iter().enumerate() {
        let stroke = Stroke::solid(curve_color(index)).with_dash(Dash::of_curve(index));
        energy.layers.push(Layer::Line {
            points: one.curve.points(),
            stroke,
        });
        let optimum = one
            .optimum
            .filter(|point| point.iter().all(|value| value.is_finite()));
        let value = optimum.map(|point| with_unit(point[0], &input.torque.unit));
        match (one.curve.name.as_str(), value) {
            ("", _) => {}
            (name, Some(value)) => {
                let text = format!("{name}, optimum {value}");
                energy.legend.push(LegendEntry::line(text, stroke));
            }
            (name, None) => energy.legend.push(LegendEntry::line(name, stroke)),
        }
        optima.extend(optimum);
    }
    let text = match (input.curves.as_slice(), optima.as_slice()) {
        // A curve without name has no entry that could tell the value.
        ([one], [optimum]) if one.curve.name.is_empty() => {
            format!("optimum {}", with_unit(optimum[0], &input.torque.unit))
        }
        _ => "optimum".to_string(),
    };
    if !optima.is_empty() {
        energy.legend.push(LegendEntry::marker(text, OPTIMUM));
    }
    energy.layers.push(Layer::Points {
        points: optima,
        marker: OPTIMUM,
    });
    let kinds = FrictionRegionKind::ALL
        .into_iter()
        .filter(|kind| input.regions.iter().any(|region| region.kind == *kind));
    energy
        .legend
        .extend(kinds.map(|kind| LegendEntry::fill(kind.name(), kind.color())));
    let mut rows = vec![vec![energy]];
    if let Some(counters) = &input.counters {
        rows.push(vec![counter_panel(input, counters)]);
    }
    let (single, double) = if rows.len() > 1 {
        (105.0, 110.0)
    } else {
        (66.0, 85.0)
    };
    let mut figure = options.figure(rows, single, double);
    figure.share_x = true;
    figure
}

fn shading(regions: &[FrictionRegion]) -> Vec<Layer> {
    regions
        .iter()
        .filter(|region| region.kind != FrictionRegionKind::Slip)
        .map(|region| Layer::Bands {
            intervals: vec![[region.from, region.to]],
            color: region.kind.color(),
        })
        .collect()
}

fn counter_panel(input: &Dissipation, counters: &ReversalCounters) -> Panel {
    /// Up to this count every number is labelled.
    const FEW: f64 = 8.0;
    let mut count = counters.count.clone();
    let values = counters.reversals.y.iter().chain(&counters.stops.y).copied();
    if let (None, Scale::Linear, Some([low, high])) = (count.limits, count.scale, extent(values)) {
        // Steps must not run along the frame.
        let margin = (0.06 * (high - low)).max(0.3);
        count.limits = Some((low.min(0.0) - margin, high + margin));
        count.step = count.step.or((high <= FEW && low >= 0.0).then_some(1.0));
    }
    let looks = [
        (&counters.reversals, Stroke::solid(Color::BLACK)),
        (
            &counters.stops,
            Stroke::solid(Color::VERMILLION).with_dash(Dash::Dashed),
        ),
    ];
    let mut panel = Panel {
        x: input.torque.clone(),
        y: count,
        layers: shading(&input.regions),
        legend_place: LegendPlace::Above,
        ..Panel::default()
    };
    for ((curve, stroke), usual) in looks.into_iter().zip(["reversals", "stops in a half cycle"]) {
        let points = steps(&curve.points());
        if points.is_empty() {
            continue;
        }
        panel.layers.push(Layer::Line { points, stroke });
        let name = if curve.name.is_empty() { usual } else { &curve.name };
        panel.legend.push(LegendEntry::line(name, stroke));
    }
    panel
}

/// Counts change between two points: half-way, since it is not known where.
fn steps(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut steps: Vec<[f64; 2]> = points.iter().take(1).copied().collect();
    for pair in points.windows(2) {
        let ([a, from], [b, to]) = (pair[0], pair[1]);
        if from != to {
            let middle = a / 2.0 + b / 2.0;
            steps.extend([[middle, from], [middle, to]]);
        }
        steps.push(pair[1]);
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_change_half_way() {
        assert_eq!(
            steps(&[[0.0, 2.0], [1.0, 2.0], [2.0, 4.0]]),
            [[0.0, 2.0], [1.0, 2.0], [1.5, 2.0], [1.5, 4.0], [2.0, 4.0]]
        );
        assert!(steps(&[]).is_empty());
    }
}
