//! Amplitude spectra: lines for discrete harmonics, curves for densely sampled spectra.

use super::curve_family::curves_panel;
use super::{Curve, FigureOptions};
use crate::plot::{
    Axis, Color, Figure, Layer, LegendEntry, Marker, Panel, Scale, Shape, Stroke, curve_color,
};

/// Input of [`spectrum`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spectrum {
    /// Response frequency or harmonic order.
    pub frequency: Axis,
    /// Amplitude, linear or logarithmic.
    pub amplitude: Axis,
    /// The spectra.
    pub spectra: Vec<Curve>,
    /// How they are drawn.
    pub style: SpectrumStyle,
}

/// How a spectrum is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpectrumStyle {
    /// An upright line for each frequency, with a marker on its tip.
    #[default]
    Stems,
    /// A curve.
    Curve,
}

/// Draws amplitude spectra.
pub fn spectrum(input: &Spectrum, options: &FigureOptions) -> Figure {
    let panel = match input.style {
        SpectrumStyle::Stems => stems(input),
        SpectrumStyle::Curve => {
            curves_panel(input.frequency.clone(), input.amplitude.clone(), &input.spectra)
        }
    };
    options.figure(vec![vec![panel]], 55.0, 70.0)
}

fn stems(input: &Spectrum) -> Panel {
    const SHAPES: [Shape; 4] = [Shape::Circle, Shape::Square, Shape::Diamond, Shape::TriangleUp];
    // A logarithmic axis has no zero: the lines start at its lower end.
    let base = match input.amplitude.scale {
        Scale::Linear => 0.0,
        Scale::Logarithmic => f64::NAN,
    };
    let mut panel = Panel {
        x: input.frequency.clone(),
        y: input.amplitude.clone(),
        ..Panel::default()
    };
    for (index, spectrum) in input.spectra.iter().enumerate() {
        let color = curve_color(index);
        let marker = if index == 0 {
            Marker::filled(SHAPES[0], 2.4, Color::BLACK)
        } else {
            Marker::open(SHAPES[index % SHAPES.len()], 3.0, color)
        };
        let points = spectrum.points();
        panel.layers.push(Layer::Stems {
            points: points.clone(),
            base,
            stroke: Stroke::solid(color).with_width(0.7),
        });
        panel.layers.push(Layer::Points { points, marker });
        if !spectrum.name.is_empty() {
            panel.legend.push(LegendEntry::marker(&spectrum.name, marker));
        }
    }
    panel
}
