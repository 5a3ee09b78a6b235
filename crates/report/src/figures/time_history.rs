//! Time histories in panels one above the other, with the intervals shaded in which a clutch is disengaged.

use super::curve_family::curves_panel;
use super::{Curve, FigureOptions};
use crate::plot::{Axis, Color, Figure, Layer, LegendEntry, LegendPlace};

/// Input of [`time_history`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TimeHistory {
    /// Time.
    pub time: Axis,
    /// The panels from top to bottom.
    pub panels: Vec<TimePanel>,
    /// Intervals of time to be shaded, `[from, to]`.
    pub disengaged: Vec<[f64; 2]>,
}

/// One panel of a [`TimeHistory`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TimePanel {
    /// The quantity.
    pub y: Axis,
    /// Its curves over time; a panel with one curve needs no name for it.
    pub curves: Vec<Curve>,
}

/// Draws time histories with a common time axis.
pub fn time_history(input: &TimeHistory, options: &FigureOptions) -> Figure {
    let rows: Vec<_> = input
        .panels
        .iter()
        .enumerate()
        .map(|(index, time_panel)| {
            let mut panel = curves_panel(input.time.clone(), time_panel.y.clone(), &time_panel.curves);
            let bands = Layer::Bands {
                intervals: input.disengaged.clone(),
                color: Color::LIGHT_GREY,
            };
            panel.layers.insert(0, bands);
            if index == 0 && !input.disengaged.is_empty() {
                panel
                    .legend
                    .push(LegendEntry::fill("disengaged", Color::LIGHT_GREY));
            }
            panel.legend_place = LegendPlace::Above;
            vec![panel]
        })
        .collect();
    let height = 18.0 + 32.0 * rows.len().max(1) as f64;
    let mut figure = options.figure(rows, height, height);
    figure.share_x = true;
    figure
}
