//! Waterfall diagram: spectra of the response over a parameter such as the excitation frequency.
//!
//! [`waterfall_lines`] is the classical form, each spectrum a line on its own base line, the nearer hiding the
//! farther. [`waterfall_map`] shows the same data as a map of colours. [`waterfall_orders`] draws harmonics, of
//! which a line exists at whole orders only, as peaks.

use std::ops::Range;

use super::FigureOptions;
use crate::plot::{
    Axis, Color, ColorBar, Figure, HeatMap, Layer, Panel, Scale, ScaleBar, Stroke, sequential_color,
};

/// Input of [`waterfall_lines`] and [`waterfall_map`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Waterfall {
    /// The parameter.
    pub parameter: Axis,
    /// The response frequency.
    pub frequency: Axis,
    /// The amplitude; a logarithmic scale concerns the map only.
    pub amplitude: Axis,
    /// The spectra, in any order.
    pub spectra: Vec<ResponseSpectrum>,
}

/// The spectrum at one value of the parameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ResponseSpectrum {
    /// The parameter.
    pub parameter: f64,
    /// Response frequencies, ascending.
    pub frequency: Vec<f64>,
    /// Amplitudes, as many.
    pub amplitude: Vec<f64>,
}

/// Spectra with a finite parameter, ascending in it.
fn sorted(input: &Waterfall) -> Vec<&ResponseSpectrum> {
    let mut spectra: Vec<&ResponseSpectrum> = input
        .spectra
        .iter()
        .filter(|spectrum| spectrum.parameter.is_finite())
        .collect();
    spectra.sort_by(|a, b| a.parameter.total_cmp(&b.parameter));
    spectra
}

fn largest(spectra: &[&ResponseSpectrum]) -> f64 {
    spectra
        .iter()
        .map(|spectrum| largest_of(spectrum))
        .fold(0.0, f64::max)
}

fn largest_of(spectrum: &ResponseSpectrum) -> f64 {
    spectrum
        .amplitude
        .iter()
        .copied()
        .filter(|amplitude| amplitude.is_finite())
        .fold(0.0, f64::max)
}

/// Draws each spectrum as a line that starts from its parameter on the vertical axis; a bar at the right shows
/// the scale of amplitudes.
pub fn waterfall_lines(input: &Waterfall, options: &FigureOptions) -> Figure {
    /// Height of the largest amplitude relative to the interval of the parameter.
    const RISE: f64 = 0.22;
    let spectra = sorted(input);
    let (first, last) = match (spectra.first(), spectra.last()) {
        (Some(first), Some(last)) => (first.parameter, last.parameter),
        _ => (0.0, 1.0),
    };
    let span = if last > first {
        last - first
    } else {
        first.abs().max(1.0)
    };
    let largest = largest(&spectra);
    let gain = if largest > 0.0 { RISE * span / largest } else { 0.0 };
    let stroke = Stroke::solid(Color::BLACK).with_width(0.5);
    let layers = spectra
        .iter()
        .rev()
        .map(|spectrum| Layer::CoveringLine {
            points: spectrum
                .frequency
                .iter()
                .zip(&spectrum.amplitude)
                .map(|(frequency, amplitude)| [*frequency, spectrum.parameter + gain * amplitude])
                .collect(),
            base: spectrum.parameter,
            stroke,
        })
        .collect();
    let bar = nice_below(largest / 2.0);
    let mut parameter = input.parameter.clone();
    parameter.scale = Scale::Linear;
    if parameter.limits.is_none() {
        let tops = spectra
            .iter()
            .map(|spectrum| spectrum.parameter + gain * largest_of(spectrum));
        parameter.limits = Some((first - 0.02 * span, tops.fold(last, f64::max) + 0.03 * span));
    }
    let text = match input.amplitude.unit.as_str() {
        "" | "–" | "-" => short(bar),
        unit => format!("{} {unit}", short(bar)),
    };
    let panel = Panel {
        x: input.frequency.clone(),
        y: parameter,
        layers,
        scale_bar: (bar > 0.0).then_some(ScaleBar {
            length: gain * bar,
            text,
        }),
        ..Panel::default()
    };
    options.figure(vec![vec![panel]], 80.0, 100.0)
}

/// Draws spectra of harmonics as [`waterfall_lines`] does, each line as a narrow peak at its order: the frequencies
/// of the spectra are orders. Nearer peaks hide farther ones, so that each order shows as a ridge over the parameter.
pub fn waterfall_orders(input: &Waterfall, options: &FigureOptions) -> Figure {
    let mut peaks = input.clone();
    peaks.spectra = input.spectra.iter().map(peaked).collect();
    waterfall_lines(&peaks, options)
}

/// The spectrum with each line as a triangle of this amplitude about its frequency.
fn peaked(spectrum: &ResponseSpectrum) -> ResponseSpectrum {
    /// Half of the width of a peak relative to the least distance of the lines.
    const HALF: f64 = 0.36;
    let lines: Vec<(f64, f64)> = spectrum
        .frequency
        .iter()
        .copied()
        .zip(spectrum.amplitude.iter().copied())
        .filter(|(frequency, _)| frequency.is_finite())
        .collect();
    let least = lines
        .windows(2)
        .map(|pair| pair[1].0 - pair[0].0)
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    let half = HALF * if least.is_finite() { least } else { 1.0 };
    let corners = lines.iter().flat_map(|(frequency, amplitude)| {
        let amplitude = if amplitude.is_finite() { *amplitude } else { 0.0 };
        [
            (frequency - half, 0.0),
            (*frequency, amplitude),
            (frequency + half, 0.0),
        ]
    });
    let (frequency, amplitude) = corners.unzip();
    ResponseSpectrum {
        parameter: spectrum.parameter,
        frequency,
        amplitude,
    }
}

/// The largest of 1, 2 or 5 times a power of ten that is not above `value`; 0 for none.
fn nice_below(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 0.0;
    }
    let exponent = value.log10().floor() as i32;
    let mantissa = value / 10f64.powi(exponent);
    let digit = if mantissa >= 5.0 {
        5
    } else if mantissa >= 2.0 {
        2
    } else {
        1
    };
    // Parsing a decimal gives the nearest double, which prints short.
    format!("{digit}e{exponent}").parse().unwrap_or(0.0)
}

/// A number from [`nice_below`] as a plain decimal, or with a power of ten when that would be long.
fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value) {
        return format!("{value}");
    }
    let scientific = format!("{value:e}");
    match scientific.split_once('e') {
        Some((digit, exponent)) => format!("{digit}·10^{{{}}}", exponent.replace('-', "−")),
        None => scientific,
    }
}

/// Draws the spectra as one map: the parameter across, the response frequency up, the amplitude as colour, on
/// a linear or, by the scale of the amplitude axis, logarithmic colour scale (five decades unless limits are
/// given).
///
/// Cells of the map are regular, at most 400 in each direction. Each shows the largest amplitude of the lines
/// inside it, so that narrow peaks survive, or that of the line nearest to its centre.
pub fn waterfall_map(input: &Waterfall, options: &FigureOptions) -> Figure {
    let spectra = sorted(input);
    let largest = largest(&spectra);
    let mut amplitude = input.amplitude.clone();
    if amplitude.limits.is_none() {
        let top = if largest > 0.0 { largest } else { 1.0 };
        amplitude.limits = Some(match amplitude.scale {
            Scale::Linear => (0.0, top),
            Scale::Logarithmic => (top * 1e-5, top),
        });
    }
    let mut panel = Panel {
        x: Axis {
            scale: Scale::Linear,
            ..input.parameter.clone()
        },
        y: Axis {
            scale: Scale::Linear,
            ..input.frequency.clone()
        },
        color_bar: Some(ColorBar {
            axis: amplitude.clone(),
        }),
        ..Panel::default()
    };
    if let Some(map) = map(&spectra, &amplitude) {
        panel.layers.push(Layer::HeatMap(map));
    }
    options.figure(vec![vec![panel]], 65.0, 85.0)
}

fn map(spectra: &[&ResponseSpectrum], amplitude: &Axis) -> Option<HeatMap> {
    let parameters: Vec<f64> = spectra.iter().map(|spectrum| spectrum.parameter).collect();
    let longest = spectra.iter().max_by_key(|spectrum| spectrum.frequency.len())?;
    let (columns, x) = regular(&parameters)?;
    let frequencies: Vec<f64> = longest
        .frequency
        .iter()
        .copied()
        .filter(|f| f.is_finite())
        .collect();
    let (rows, y) = regular(&frequencies)?;
    let (low, high) = amplitude.limits.unwrap_or((0.0, 1.0));
    let color = |value: f64| {
        if !value.is_finite() {
            return Color::WHITE;
        }
        sequential_color(match amplitude.scale {
            Scale::Linear => (value - low) / (high - low),
            Scale::Logarithmic => (value.max(low) / low).ln() / (high / low).ln(),
        })
    };
    let in_column: Vec<Range<usize>> = (0..columns)
        .map(|column| members(&parameters, x, column, columns))
        .collect();
    let mut cells = Vec::with_capacity(rows * columns);
    for row in 0..rows {
        for spectra in in_column.iter().map(|column| &spectra[column.clone()]) {
            let largest = spectra.iter().flat_map(|spectrum| {
                let length = spectrum.frequency.len().min(spectrum.amplitude.len());
                let lines = members(&spectrum.frequency[..length], y, row, rows);
                spectrum.amplitude[lines]
                    .iter()
                    .copied()
                    .filter(|amplitude| amplitude.is_finite())
            });
            cells.push(color(largest.fold(f64::NAN, f64::max)));
        }
    }
    Some(HeatMap { x, y, columns, cells })
}

/// Number of regular cells that resolve ascending values, and the outer edges, half a cell outside the values.
fn regular(values: &[f64]) -> Option<(usize, [f64; 2])> {
    /// More could not be told apart on paper.
    const MOST: usize = 400;
    let (first, last) = (*values.first()?, *values.last()?);
    let span = last - first;
    let finest = values
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    if !(finest.is_finite() && span.is_finite()) {
        let half = if first == 0.0 { 0.5 } else { 0.05 * first.abs() };
        return Some((1, [first - half, first + half]));
    }
    let steps = (span / finest).round().clamp(1.0, (MOST - 1) as f64);
    let half = span / steps / 2.0;
    Some((steps as usize + 1, [first - half, last + half]))
}

/// The values, of an ascending slice, that lie in cell `index` of `count`, or the one nearest to its centre.
fn members(values: &[f64], edges: [f64; 2], index: usize, count: usize) -> Range<usize> {
    let edge = |index: f64| edges[0] + (edges[1] - edges[0]) * index / count as f64;
    let (low, high) = (edge(index as f64), edge(index as f64 + 1.0));
    let inside = values.partition_point(|value| *value < low)..values.partition_point(|value| *value < high);
    if inside.start < inside.end || values.is_empty() {
        return inside.start..inside.end.max(inside.start);
    }
    let nearest = nearest(values, edge(index as f64 + 0.5));
    nearest..nearest + 1
}

/// Index of the value nearest to `target` in an ascending slice that is not empty.
fn nearest(values: &[f64], target: f64) -> usize {
    let after = values
        .partition_point(|value| *value < target)
        .min(values.len() - 1);
    if after > 0 && (target - values[after - 1]).abs() <= (values[after] - target).abs() {
        after - 1
    } else {
        after
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nice_amplitudes_print_short() {
        assert_eq!(nice_below(0.37), 0.2);
        assert_eq!(format!("{}", nice_below(0.0012)), "0.001");
        assert_eq!(short(nice_below(2.3e-7)), "2·10^{−7}");
        assert_eq!(short(0.05), "0.05");
        assert_eq!(nice_below(7.0), 5.0);
        assert_eq!(nice_below(0.0), 0.0);
    }

    #[test]
    fn harmonics_become_peaks_between_which_nothing_is() {
        let peaked = peaked(&ResponseSpectrum {
            parameter: 600.0,
            frequency: vec![0.0, 1.0],
            amplitude: vec![0.5, f64::NAN],
        });
        let corners = [-0.36, 0.0, 0.36, 0.64, 1.0, 1.36];
        let pairs = peaked.frequency.iter().zip(corners);
        assert!(peaked.frequency.len() == 6 && pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12));
        assert_eq!(peaked.amplitude, [0.0, 0.5, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn cells_take_the_nearest_spectrum() {
        assert_eq!(nearest(&[0.0, 1.0, 3.0], 1.9), 1);
        assert_eq!(nearest(&[0.0, 1.0, 3.0], 2.1), 2);
        assert_eq!(nearest(&[0.0, 1.0, 3.0], 99.0), 2);
        assert_eq!(members(&[0.0, 1.0, 3.0], [-0.5, 3.5], 2, 4), 1..2);
        assert_eq!(members(&[0.0, 1.0, 3.0], [-0.5, 3.5], 0, 2), 0..2);
        assert_eq!(members(&[], [0.0, 1.0], 0, 1), 0..0);
        assert_eq!(regular(&[0.0, 1.0, 3.0]), Some((4, [-0.5, 3.5])));
        assert_eq!(regular(&[2.0]).map(|r| r.0), Some(1));
    }

    #[test]
    fn a_narrow_peak_survives_a_coarse_map() {
        let spectrum = |parameter| ResponseSpectrum {
            parameter,
            frequency: (0..5000).map(f64::from).collect(),
            amplitude: (0..5000)
                .map(|line| if line == 1234 { 1.0 } else { 0.0 })
                .collect(),
        };
        let (first, second) = (spectrum(0.0), spectrum(1.0));
        let map = map(&[&first, &second], &Axis::linear("A", "").with_limits(0.0, 1.0)).unwrap();
        assert_eq!(map.cells.len(), 2 * 400);
        assert_eq!(
            map.cells
                .iter()
                .filter(|cell| **cell == sequential_color(1.0))
                .count(),
            2
        );
    }

    #[test]
    fn the_map_is_one_image_and_its_bar_another() {
        let spectra = (0..40)
            .map(|i| ResponseSpectrum {
                parameter: f64::from(i),
                frequency: (0..50).map(f64::from).collect(),
                amplitude: (0..50).map(|j| f64::from((i * j) % 7)).collect(),
            })
            .collect();
        let svg = waterfall_map(
            &Waterfall {
                spectra,
                ..Waterfall::default()
            },
            &FigureOptions::default(),
        )
        .svg();
        assert_eq!(svg.matches("<image").count(), 2);
    }
}
