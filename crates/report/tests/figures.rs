//! What must hold for every kind of figure: well-formed, inside the page, without overlapping text, equal bytes
//! for equal input, and no panic from empty or extreme data.

mod samples;

use slackside_report::figures::*;
use slackside_report::plot::{Axis, Figure, Scale, TextBox, Width};

const WIDTHS: [Width; 2] = [Width::Single, Width::Double];

/// Width and height of the page in points, from the root element.
fn page(document: &roxmltree::Document) -> (f64, f64) {
    let numbers: Vec<f64> = document
        .root_element()
        .attribute("viewBox")
        .unwrap()
        .split(' ')
        .map(|number| number.parse().unwrap())
        .collect();
    (numbers[2], numbers[3])
}

/// Asserts that a figure is a well-formed SVG with all text inside the page and none on top of other text.
fn check(name: &str, figure: &Figure) {
    let svg = figure.svg();
    assert!(
        !svg.contains("NaN") && !svg.contains("inf"),
        "{name}: a number is not finite"
    );
    let document = roxmltree::Document::parse(&svg).unwrap();
    let (width, height) = page(&document);
    let texts = figure.text_boxes();
    for (index, text) in texts.iter().enumerate() {
        let inside = text.left >= 0.0 && text.top >= 0.0 && text.right <= width && text.bottom <= height;
        assert!(inside, "{name}: {text:?} leaves the page of {width} x {height}");
        for other in &texts[..index] {
            assert!(!text.overlaps(other), "{name}: {text:?} overlaps {other:?}");
        }
    }
}

fn texts(figure: &Figure) -> Vec<String> {
    figure.text_boxes().into_iter().map(|text| text.text).collect()
}

#[test]
fn figures_are_well_formed_and_their_text_does_not_overlap() {
    for width in WIDTHS {
        for (name, figure) in samples::all(width) {
            check(name, &figure);
        }
    }
}

#[test]
fn titles_and_other_heights_do_not_overlap_either() {
    for width in WIDTHS {
        for height in [40.0, 60.0, 150.0] {
            for (name, mut figure) in samples::all(width) {
                figure.height = height * figure.rows.len() as f64;
                figure.title = Some("A title that says what the figure shows".to_string());
                check(name, &figure);
            }
        }
    }
}

#[test]
fn equal_input_gives_equal_bytes() {
    for ((name, first), (_, second)) in samples::all(Width::Single)
        .into_iter()
        .zip(samples::all(Width::Single))
    {
        assert_eq!(first.svg(), second.svg(), "{name}");
        assert_eq!(first.png(1.0).unwrap(), second.png(1.0).unwrap(), "{name}");
    }
}

#[test]
fn axes_name_quantity_and_unit() {
    let figures = samples::all(Width::Double);
    let (_, response) = figures.iter().find(|(name, _)| *name == "response").unwrap();
    let texts = texts(response);
    assert!(texts.contains(&"Excitation frequency Ω (–)".to_string()));
    assert!(texts.contains(&"RMS of wind-up δθ (rad)".to_string()));
    for entry in [
        "stable",
        "unstable",
        "fold",
        "Neimark–Sacker",
        "grazing",
        "sweep up",
        "sweep down",
    ] {
        assert!(texts.contains(&entry.to_string()), "{entry}");
    }
}

#[test]
fn png_has_the_size_of_print() {
    let (_, figure) = samples::all(Width::Single).remove(0);
    let png = figure.png(3.125).unwrap();
    // 85 mm at 300 pixels per inch; the width stands in the header at byte 16.
    let width = u32::from_be_bytes([png[16], png[17], png[18], png[19]]);
    assert_eq!(width, (85.0_f64 / 25.4 * 300.0).ceil() as u32);
}

/// Data that plotting code stumbles over.
fn degenerate() -> Vec<Vec<[f64; 2]>> {
    vec![
        vec![],
        vec![[1.0, 1.0]],
        vec![[0.0, 0.0], [1.0, 0.0]],
        vec![[2.0, 5.0]; 4],
        vec![[f64::NAN, f64::NAN]; 3],
        vec![
            [0.0, 1.0],
            [1.0, f64::NAN],
            [2.0, 3.0],
            [f64::INFINITY, 1.0],
            [3.0, f64::NEG_INFINITY],
        ],
        vec![[0.0, 1e300], [1.0, -1e300]],
        vec![[-1.7e308, 1.7e308], [1.7e308, -1.7e308]],
        vec![[0.0, 1e-300], [1e-300, 2e-300]],
        vec![[5e-324, 5e-324], [0.0, 0.0]],
        vec![[1e9, 1.0], [1e9 + 1e-3, 1.0 + 1e-13]],
        vec![[-1e-9, 123456.789], [1e-9, 123456.790]],
    ]
}

#[test]
fn degenerate_data_is_drawn_without_panic_or_overlap() {
    let options = FigureOptions::default();
    for points in degenerate() {
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let axis = |label: &str| Axis {
                scale,
                ..Axis::linear(label, "rad")
            };
            let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|p| (p[0], p[1])).unzip();
            let curve = Curve {
                name: "curve".into(),
                x: x.clone(),
                y: y.clone(),
            };
            let set = PointSet {
                name: "set".into(),
                points: points.clone(),
            };
            let special = points
                .iter()
                .enumerate()
                .map(|(i, p)| SpecialPoint {
                    x: p[0],
                    y: p[1],
                    kind: SpecialKind::Fold,
                    after: Some(i),
                })
                .collect();
            let branch = Branch {
                name: Some("branch".into()),
                stable: (0..x.len()).map(|i| i % 2 == 0).collect(),
                x: x.clone(),
                y: y.clone(),
                special,
            };
            let spectra = points
                .iter()
                .map(|p| ResponseSpectrum {
                    parameter: p[0],
                    frequency: x.clone(),
                    amplitude: y.clone(),
                })
                .collect::<Vec<_>>();
            let waterfall = Waterfall {
                parameter: axis("Ω"),
                frequency: axis("ω"),
                amplitude: axis("A"),
                spectra,
            };
            let zoom = points.first().map(|p| Zoom {
                x: [p[0], p[1]],
                y: None,
            });
            let figures = [
                response(
                    &Response {
                        x: axis("x"),
                        y: axis("y"),
                        branches: vec![branch],
                        sweep_up: points.clone(),
                        sweep_down: points.clone(),
                        zoom,
                    },
                    &options,
                ),
                curve_family(
                    &CurveFamily {
                        x: axis("x"),
                        y: axis("y"),
                        curves: vec![curve.clone()],
                    },
                    &options,
                ),
                time_history(
                    &TimeHistory {
                        time: axis("t"),
                        panels: vec![
                            TimePanel {
                                y: axis("y"),
                                curves: vec![curve.clone()]
                            };
                            2
                        ],
                        disengaged: points.clone(),
                    },
                    &options,
                ),
                spectrum(
                    &Spectrum {
                        frequency: axis("f"),
                        amplitude: axis("A"),
                        spectra: vec![curve.clone()],
                        style: SpectrumStyle::Stems,
                    },
                    &options,
                ),
                waterfall_lines(&waterfall, &options),
                waterfall_map(&waterfall, &options),
                phase_portrait(
                    &PhasePortrait {
                        x: axis("x"),
                        y: axis("y"),
                        orbits: vec![curve.clone()],
                        poincare: vec![set.clone()],
                    },
                    &options,
                ),
                poincare_map(
                    &PoincareMap {
                        x: axis("x"),
                        y: axis("y"),
                        sets: vec![set],
                    },
                    &options,
                ),
                engagement_strip(
                    &EngagementStrip {
                        phase: axis("phase"),
                        row: axis("Ω"),
                        rows: points
                            .iter()
                            .map(|p| EngagementRow {
                                value: p[0],
                                engaged: points.clone(),
                            })
                            .collect(),
                    },
                    &options,
                ),
                basin(
                    &Basin {
                        x: axis("x"),
                        y: axis("y"),
                        x_centres: *points.first().unwrap_or(&[0.0, 1.0]),
                        y_centres: *points.last().unwrap_or(&[0.0, 1.0]),
                        columns: points.len() / 2,
                        cells: vec![Some(3); points.len()],
                        attractors: vec!["one".into()],
                        points: points.clone(),
                    },
                    &options,
                ),
            ];
            for (index, figure) in figures.iter().enumerate() {
                check(&format!("figure {index} of {points:?}, {scale:?}"), figure);
                figure.png(0.5).unwrap();
            }
        }
    }
}

#[test]
fn a_figure_without_panels_is_an_empty_page() {
    let figure = Figure {
        width: Width::Single,
        height: f64::NAN,
        title: None,
        legend: vec![],
        rows: vec![],
        share_x: true,
    };
    assert!(figure.text_boxes().is_empty());
    figure.png(1.0).unwrap();
}

#[test]
fn long_names_stay_on_the_page() {
    let curves = (0..9)
        .map(|i| Curve {
            name: format!("a curve with a long and winding name, number {i}"),
            x: vec![0.0, 1.0],
            y: vec![0.0, f64::from(i)],
        })
        .collect();
    let family = CurveFamily {
        x: Axis::linear(
            "A quantity whose name is far longer than the axis on which it has to stand, indeed",
            "N m",
        ),
        y: Axis::linear(
            "Another quantity whose name is far longer than the axis on which it stands",
            "rad/s",
        ),
        curves,
    };
    check("long names", &curve_family(&family, &FigureOptions::default()));
}

#[test]
fn overlap_is_recognised() {
    let at = |left: f64| TextBox {
        text: "t".into(),
        left,
        top: 0.0,
        right: left + 10.0,
        bottom: 8.0,
    };
    assert!(at(0.0).overlaps(&at(9.0)));
    assert!(!at(0.0).overlaps(&at(10.0)));
}
