//! Critical load of a one-way clutch, or critical torque of dry friction, over frequency or speed.

use super::curve_family::curves_panel;
use super::number::with_unit;
use super::{Curve, FigureOptions, extent};
use crate::plot::{Axis, Color, Dash, Figure, Layer, LegendEntry, Stroke};

/// Input of [`critical_level`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CriticalLevel {
    /// Frequency or speed.
    pub x: Axis,
    /// Critical load or torque, linear or logarithmic.
    pub level: Axis,
    /// The curves.
    pub curves: Vec<Curve>,
    /// Where the locked system is in resonance.
    pub resonances: Vec<f64>,
    /// A level that the drive has, with its name, for example the load of the alternator.
    pub actual: Option<(f64, String)>,
}

const RESONANCE: Stroke = Stroke {
    color: Color::GREY,
    width: 0.4,
    dash: Dash::Dashed,
};
const ACTUAL: Stroke = Stroke {
    color: Color::VERMILLION,
    width: 0.8,
    dash: Dash::LongDash,
};

/// Draws critical levels, thin upright lines at the resonances of the locked system, and the actual level.
pub fn critical_level(input: &CriticalLevel, options: &FigureOptions) -> Figure {
    let mut panel = curves_panel(input.x.clone(), input.level.clone(), &input.curves);
    let abscissae = || {
        let limits = input.x.limits.map(|(a, b)| [a, b]).into_iter().flatten();
        limits.chain(input.curves.iter().flat_map(|curve| curve.x.iter().copied()))
    };
    if let (Some((level, name)), Some([from, to])) = (&input.actual, extent(abscissae())) {
        panel.layers.push(Layer::Line {
            points: vec![[from, *level], [to, *level]],
            stroke: ACTUAL,
        });
        let value = with_unit(*level, &input.level.unit);
        let text = match name.as_str() {
            "" => value,
            name => format!("{name}: {value}"),
        };
        panel.legend.push(LegendEntry::line(text, ACTUAL));
    }
    if !input.resonances.is_empty() {
        panel.layers.insert(
            0,
            Layer::Uprights {
                x: input.resonances.clone(),
                stroke: RESONANCE,
            },
        );
        panel
            .legend
            .push(LegendEntry::line("resonance of the locked system", RESONANCE));
    }
    options.figure(vec![vec![panel]], 68.0, 85.0)
}
