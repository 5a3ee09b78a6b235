//! Figures of a comparison.

use super::{name, words};
use crate::plots;
use slackside_report::Figure;
use slackside_report::figures::{
    Basin, Branch, Curve, Response, SpecialKind, SpecialPoint, Spectrum, SpectrumStyle, TimeHistory,
    TimePanel, basin, response, spectrum, time_history,
};
use slackside_report::plot::{
    Axis, Color, Dash, Layer, LegendEntry, LegendPlace, Marker, Panel, Shape, Stroke, Width, curve_color,
};
use slackside_studies::Label;
use slackside_studies::compare::{CompareDocument, Contestant, HistoryRow, MapAxis, Validity};

/// Panels side by side.
const COLUMNS: usize = 3;
/// Points of harmonic balance that are marked along a branch.
const MARKED: usize = 30;
/// Methods drawn as lines, in the order of their colours.
const LINES: [Contestant; 3] = [
    Contestant::Shooting,
    Contestant::SecondOrder,
    Contestant::FirstOrder,
];
/// Smallest error drawn, per cent.
const LEAST_ERROR: f64 = 1e-3;
/// The mark of harmonic balance.
const BALANCE: Marker = Marker {
    shape: Shape::Circle,
    size: 3.0,
    filled: false,
    color: Color::GREEN,
};

/// All figures of the document.
pub fn all(document: &CompareDocument) -> Vec<(String, Figure)> {
    let mut figures = vec![("comparison".to_owned(), comparison(document))];
    if !document.errors.is_empty() {
        figures.push(("errors".to_owned(), errors(document)));
    }
    let mut places: Vec<(f64, Option<Label>)> = Vec::new();
    for row in &document.histories {
        if !places.contains(&(row.at.value, row.label.clone())) {
            places.push((row.at.value, row.label.clone()));
        }
    }
    for (index, (at, label)) in places.iter().enumerate() {
        let rows: Vec<&HistoryRow> = document
            .histories
            .iter()
            .filter(|row| row.at.value == *at && row.label == *label)
            .collect();
        let rows = most_open(&rows);
        figures.push((format!("history_{index}"), history(document, &rows)));
        figures.push((format!("spectrum_{index}"), spectra(document, &rows)));
    }
    if document.map.is_some() {
        figures.push(("validity_map".to_owned(), map(document)));
    }
    figures
}

/// The values of the family key in their order.
fn labels(document: &CompareDocument) -> Vec<Option<Label>> {
    let mut labels: Vec<Option<Label>> = Vec::new();
    for entry in &document.branches {
        if !labels.contains(&entry.branch.label) {
            labels.push(entry.branch.label.clone());
        }
    }
    labels
}

/// Panels in rows, each with the value of the family key as its letter; the legend, the same in all, stands above.
fn arrange(panels: Vec<(Option<Label>, Panel)>) -> Figure {
    let single = panels.len() == 1;
    let mut rows: Vec<Vec<Panel>> = Vec::new();
    let mut legend: Vec<LegendEntry> = Vec::new();
    for (label, mut panel) in panels {
        if !single {
            panel.letter = Some(name(&label));
            for entry in std::mem::take(&mut panel.legend) {
                if !legend.contains(&entry) {
                    legend.push(entry);
                }
            }
        }
        match rows.last_mut() {
            Some(row) if row.len() < COLUMNS => row.push(panel),
            _ => rows.push(vec![panel]),
        }
    }
    Figure {
        width: Width::Double,
        height: if single { 85.0 } else { 78.0 * rows.len() as f64 },
        title: None,
        legend,
        rows,
        share_x: false,
    }
}

/// RMS over the parameter: lines for multiple scales and shooting, marks for harmonic balance, triangles for integration.
fn comparison(document: &CompareDocument) -> Figure {
    let unit = document.header.units.measures.get(&document.measure);
    let rms = |m: &slackside_studies::Measures| m.get(&document.measure).map_or(f64::NAN, |m| m.rms);
    let panels = labels(document).into_iter().map(|label| {
        let of = |method: Contestant| {
            let label = label.clone();
            let entries = document.branches.iter();
            entries.filter(move |entry| entry.method == method && entry.branch.label == label)
        };
        let lines = LINES.into_iter().flat_map(&of).map(|entry| Branch {
            name: Some(entry.method.words().to_owned()),
            x: entry.branch.points.iter().map(|point| point.at.value).collect(),
            y: entry
                .branch
                .points
                .iter()
                .map(|point| rms(&point.motion.measures))
                .collect(),
            stable: entry.branch.points.iter().map(|point| point.stable).collect(),
            special: entry
                .branch
                .special
                .iter()
                .filter(|special| special.kind == "fold")
                .map(|special| SpecialPoint {
                    x: special.at.value,
                    y: rms(&special.measures),
                    kind: SpecialKind::Fold,
                    after: Some(special.after),
                })
                .collect(),
        });
        let settled = |rows: &[slackside_studies::response::SweepPointRow]| {
            let rows = rows.iter().filter(|row| row.label == label);
            rows.map(|row| [row.at.value, rms(&row.measures)]).collect()
        };
        let drawn = response(
            &Response {
                x: plots::axis(&document.parameter.key, &document.parameter.unit),
                y: Axis::linear(format!("RMS of {}", plots::words(&document.measure)), unit),
                branches: lines.collect(),
                sweep_up: settled(&document.up),
                sweep_down: settled(&document.down),
                zoom: None,
            },
            &plots::options(),
        );
        let mut panel = drawn.rows.into_iter().flatten().next().unwrap_or_default();
        panel.labels.clear();
        let points: Vec<[f64; 2]> = of(Contestant::HarmonicBalance)
            .flat_map(|entry| {
                let every = (entry.branch.points.len() / MARKED).max(1);
                let points = entry.branch.points.iter().step_by(every);
                points.map(|point| [point.at.value, rms(&point.motion.measures)])
            })
            .collect();
        if !points.is_empty() {
            panel.layers.push(Layer::Points {
                points,
                marker: BALANCE,
            });
            let entry = LegendEntry::marker(Contestant::HarmonicBalance.words(), BALANCE);
            panel.legend.insert(1.min(panel.legend.len()), entry);
        }
        (label, panel)
    });
    let mut panels: Vec<_> = panels.collect();
    let all = document.branches.iter().flat_map(|entry| &entry.branch.points);
    let largest = all.map(|point| rms(&point.motion.measures)).fold(0.0, f64::max);
    if panels.len() > 1 && largest > 0.0 {
        for (_, panel) in &mut panels {
            panel.y = panel.y.clone().with_limits(0.0, 1.06 * largest);
        }
    }
    arrange(panels)
}

/// `frequency`, or the last part of a key in words: axes of narrow panels have no room for more.
fn last_word(key: &str) -> String {
    key.rsplit('.').next().unwrap_or(key).replace('_', " ")
}

/// Errors over the depth of separation.
fn errors(document: &CompareDocument) -> Figure {
    let tolerance = 100.0 * document.tolerance;
    let what = format!("Error of {}", last_word(&document.parameter.key));
    let of_all = |row: &slackside_studies::compare::ErrorRow| {
        let errors = LINES.into_iter().filter_map(|method| row.of(method));
        errors.map(|error| 100.0 * error).fold(0.0, f64::max)
    };
    let worst = document.errors.iter().map(of_all).fold(tolerance, f64::max);
    let deepest = document.errors.iter().map(|row| row.gamma).fold(0.95, f64::min);
    let panels = labels(document).into_iter().map(|label| {
        let rows: Vec<_> = document.errors.iter().filter(|row| row.label == label).collect();
        let mut panel = Panel {
            x: Axis::linear("γ, static deflection over amplitude", "–").with_limits(deepest, 1.0),
            y: Axis::logarithmic(what.clone(), "%").with_limits(LEAST_ERROR, 2.0 * worst),
            ..Panel::default()
        };
        for (index, method) in LINES.into_iter().enumerate().skip(1) {
            let stroke = Stroke::solid(curve_color(index));
            let points = rows
                .iter()
                .map(|row| [row.gamma, row.of(method).map_or(f64::NAN, |e| 100.0 * e)]);
            panel.layers.push(Layer::Line {
                points: points.collect(),
                stroke,
            });
            panel.legend.push(LegendEntry::line(method.words(), stroke));
        }
        let limit = Stroke::solid(Color::GREY).with_dash(Dash::Dashed);
        panel.layers.push(Layer::Line {
            points: vec![[deepest, tolerance], [1.0, tolerance]],
            stroke: limit,
        });
        panel.legend.push(LegendEntry::line("tolerance", limit));
        (label, panel)
    });
    arrange(panels.collect())
}

/// Of each method the motion that is open longest, in the order of the lines.
fn most_open<'a>(rows: &[&'a HistoryRow]) -> Vec<&'a HistoryRow> {
    let ratio = |row: &HistoryRow| row.engaged_ratio.unwrap_or(1.0);
    let of = |method: Contestant| {
        let rows = rows.iter().filter(move |row| row.method == method);
        rows.min_by(|a, b| ratio(a).total_cmp(&ratio(b))).copied()
    };
    let found: Vec<&HistoryRow> = LINES.into_iter().filter_map(of).collect();
    // Where the exact motion opens, one that does not is another motion, not an approximation of it.
    let opens = found.first().is_some_and(|row| !row.events.is_empty());
    found
        .into_iter()
        .filter(|row| !opens || !row.events.is_empty())
        .collect()
}

/// Deflection, force and separation over one period.
fn history(document: &CompareDocument, rows: &[&HistoryRow]) -> Figure {
    let units = &document.header.units;
    let curves = |value: &dyn Fn(&HistoryRow) -> Vec<f64>| -> Vec<Curve> {
        rows.iter()
            .map(|row| Curve {
                name: row.method.words().to_owned(),
                x: row.phase.clone(),
                y: value(row),
            })
            .collect()
    };
    let names = &units.measures.0;
    let is_clutch = names.iter().any(|(name, _)| name == "clutch_torque");
    let force = if is_clutch {
        "Clutch torque"
    } else {
        "Force of the element"
    };
    let input = TimeHistory {
        time: Axis::linear("Phase of the period", "–").with_limits(0.0, 1.0),
        panels: vec![
            TimePanel {
                y: plots::axis(&document.measure, units.measures.get(&document.measure)),
                curves: curves(&|row| row.deflection.clone()),
            },
            TimePanel {
                y: Axis::linear(force, &units.torque),
                curves: curves(&|row| row.force.clone()),
            },
        ],
        disengaged: Vec::new(),
    };
    let mut figure = time_history(&input, &plots::options());
    for panel in figure.rows.iter_mut().skip(1).flatten() {
        panel.legend.clear();
    }
    // The separation function: one where the motion is open.
    let mut separation = Panel {
        x: Axis::linear("Phase of the period", "–").with_limits(0.0, 1.0),
        y: Axis::linear("Separation function", "–").with_limits(-0.1, 1.1),
        legend_place: LegendPlace::Above,
        ..Panel::default()
    };
    for (index, row) in rows.iter().enumerate() {
        let open = |engaged: bool| if engaged { 0.0 } else { 1.0 };
        // Before the first event it is what it is after the last.
        let always = row.engaged_ratio.unwrap_or(1.0) > 0.5;
        let mut value = open(row.events.last().map_or(always, |event| event.engaged));
        let mut points = vec![[0.0, value]];
        for event in &row.events {
            points.push([event.phase, value]);
            value = open(event.engaged);
            points.push([event.phase, value]);
        }
        points.push([1.0, value]);
        separation.layers.push(Layer::Line {
            points,
            stroke: Stroke::solid(curve_color(index)).with_dash(Dash::of_curve(index)),
        });
    }
    figure.rows.push(vec![separation]);
    figure.height += 28.0;
    figure
}

fn spectra(document: &CompareDocument, rows: &[&HistoryRow]) -> Figure {
    let unit = document.header.units.measures.get(&document.measure);
    let curves = rows.iter().map(|row| Curve {
        name: row.method.words().to_owned(),
        x: (0..row.amplitudes.len()).map(|k| k as f64).collect(),
        y: row.amplitudes.clone(),
    });
    spectrum(
        &Spectrum {
            frequency: Axis::linear("Multiple of the excitation frequency", "–"),
            amplitude: Axis::logarithmic(format!("Amplitude of {}", plots::words(&document.measure)), unit),
            spectra: curves.collect(),
            style: SpectrumStyle::Stems,
        },
        &plots::options(),
    )
}

fn map(document: &CompareDocument) -> Figure {
    let Some(map) = &document.map else {
        return Figure {
            width: Width::Double,
            height: 85.0,
            title: None,
            legend: Vec::new(),
            rows: Vec::new(),
            share_x: false,
        };
    };
    let ends = |values: &[f64]| match (values.first(), values.last()) {
        (Some(first), Some(last)) => [*first, *last],
        _ => [0.0, 1.0],
    };
    // The map fills the panel: limits at the outer edges of its cells.
    let axis = |keys: &MapAxis| {
        let [first, last] = ends(&keys.values);
        let half = 0.5 * (last - first) / keys.values.len().saturating_sub(1).max(1) as f64;
        plots::axis(&keys.key, "").with_limits(first - half, last + half)
    };
    let number = |validity: Validity| Validity::ALL.iter().position(|known| *known == validity);
    basin(
        &Basin {
            x: axis(&map.across),
            y: axis(&map.down),
            x_centres: ends(&map.across.values),
            y_centres: ends(&map.down.values),
            columns: map.across.values.len(),
            cells: map
                .cells
                .iter()
                .flatten()
                .map(|cell| number(cell.as_ref()?.validity))
                .collect(),
            attractors: Validity::ALL
                .iter()
                .map(|validity| words(*validity).to_owned())
                .collect(),
            points: Vec::new(),
        },
        &plots::options(),
    )
}
