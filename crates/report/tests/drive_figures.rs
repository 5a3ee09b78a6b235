//! What must hold for the figures of a drive beyond what holds for all figures: true to scale, complete, and no
//! panic from empty or extreme data.

#[path = "samples/drive.rs"]
mod drive;

use slackside_report::figures::*;
use slackside_report::plot::{Axis, Figure, Width};

fn figure(name: &str, width: Width) -> Figure {
    let (_, figure) = drive::all(width)
        .into_iter()
        .find(|(other, _)| *other == name)
        .unwrap();
    figure
}

fn texts(figure: &Figure) -> Vec<String> {
    figure.text_boxes().into_iter().map(|text| text.text).collect()
}

/// Vertices of all paths of a figure, path by path.
fn paths(figure: &Figure) -> Vec<Vec<[f64; 2]>> {
    let svg = figure.svg();
    let document = roxmltree::Document::parse(&svg).unwrap();
    document
        .descendants()
        .filter_map(|node| node.attribute("d"))
        .map(|data| {
            data.split(|c: char| c.is_ascii_alphabetic())
                .filter_map(|pair| {
                    let (x, y) = pair.trim().split_once(' ')?;
                    Some([x.parse().ok()?, y.parse().ok()?])
                })
                .collect()
        })
        .collect()
}

/// Width and height of the box of some points.
fn size(points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|c| {
        let values = || points.iter().map(|point| point[c]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    })
}

#[test]
fn circles_are_round_and_to_one_scale() {
    let radii: Vec<f64> = drive::layout()
        .pulleys
        .iter()
        .map(|pulley| pulley.radius)
        .collect();
    for width in [Width::Single, Width::Double] {
        for height in [None, Some(60.0), Some(220.0)] {
            let options = FigureOptions {
                width,
                height,
                title: Some("A drive".into()),
                ..FigureOptions::default()
            };
            let figure = drive_layout(&drive::layout(), &options);
            // A full turn has many vertices; the discs come first, in the order of the pulleys.
            let discs: Vec<[f64; 2]> = paths(&figure)
                .iter()
                .filter(|path| path.len() > 150)
                .step_by(2)
                .map(|path| size(path))
                .collect();
            assert_eq!(discs.len(), radii.len(), "{width:?} {height:?}");
            let scale = discs[0][0] / radii[0];
            for (disc, radius) in discs.iter().zip(&radii) {
                let bounds = (disc[0] - disc[1], disc[0] - scale * radius);
                assert!(
                    bounds.0.abs() < 0.04 && bounds.1.abs() < 0.04,
                    "{disc:?} {bounds:?}"
                );
            }
        }
    }
}

#[test]
fn the_layout_names_every_pulley_span_and_load() {
    let layout = drive::layout();
    for width in [Width::Single, Width::Double] {
        let written = texts(&figure("drive-layout", width));
        for pulley in &layout.pulleys {
            let wrap = format!("wrap {:.1}°", pulley.wrap.to_degrees());
            for text in [
                format!("{}  {}", pulley.label, pulley.name),
                wrap,
                pulley.note.clone(),
            ] {
                assert!(
                    text.is_empty() || written.contains(&text),
                    "{width:?}: {text} is missing"
                );
            }
        }
        for span in &layout.spans {
            // A narrow page breaks the line.
            let expected = match width {
                Width::Single => vec![span.label.clone(), span.note.clone()],
                Width::Double => vec![format!("{}  {}", span.label, span.note)],
            };
            for text in expected {
                assert!(written.contains(&text), "{width:?}: {text} is missing");
            }
        }
        assert!(written.contains(&"arm".to_string()));
        assert!(written.contains(&"x (mm)".to_string()) && written.contains(&"y (mm)".to_string()));
    }
    let written = texts(&figure("drive-layout", Width::Double));
    for pulley in &layout.pulleys {
        let [x, y] = pulley.hub_load.unwrap();
        let load = x.hypot(y);
        let text = if load < 100.0 {
            format!("{load:.1} N")
        } else {
            format!("{load:.0} N")
        };
        assert!(written.contains(&text), "{text} is missing");
    }
}

#[test]
fn wrap_and_spans_of_the_sample_close_a_loop() {
    let layout = drive::layout();
    let turning: f64 = layout
        .pulleys
        .iter()
        .map(|pulley| pulley.sense * pulley.wrap)
        .sum();
    assert!((turning + std::f64::consts::TAU).abs() < 1e-9, "{turning}");
}

#[test]
fn no_label_of_the_layout_covers_the_belt() {
    for width in [Width::Single, Width::Double] {
        let figure = figure("drive-layout", width);
        let svg = figure.svg();
        let document = roxmltree::Document::parse(&svg).unwrap();
        // The belt is the only thing drawn with this stroke.
        let belt: Vec<Vec<[f64; 2]>> = document
            .descendants()
            .filter(|node| node.attribute("stroke-width") == Some("1.5"))
            .filter_map(|node| node.attribute("d"))
            .map(|data| {
                data.split(['M', 'L'])
                    .filter_map(|pair| pair.trim().split_once(' '))
                    .map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()])
                    .collect()
            })
            .collect();
        assert!(belt.len() >= 16, "spans and arcs");
        for text in figure.text_boxes() {
            for pair in belt.iter().flat_map(|path| path.windows(2)) {
                for k in 0..=200 {
                    let t = f64::from(k) / 200.0;
                    let [x, y] = [0, 1].map(|c: usize| pair[0][c] + t * (pair[1][c] - pair[0][c]));
                    let inside = x > text.left && x < text.right && y > text.top && y < text.bottom;
                    assert!(!inside, "{width:?}: the belt runs through {text:?}");
                }
            }
        }
    }
}

#[test]
fn diagrams_name_their_quantities_units_and_curves() {
    let cases: [(&str, &[&str]); 5] = [
        (
            "campbell",
            &[
                "Crank speed (rpm)",
                "Frequency (Hz)",
                "order 2",
                "order 0.5",
                "6: span 1",
                "critical speed",
            ],
        ),
        (
            "tension-fan",
            &[
                "Effective tension T (N)",
                "span 2",
                "worn, hot",
                "least tension",
                "between the extremes",
            ],
        ),
        (
            "hub-load-polar",
            &[
                "alternator",
                "800",
                "90°",
                "hub load in N over speed",
                "600",
                "6000",
                "at a speed in rpm",
            ],
        ),
        (
            "order-response",
            &[
                "Amplitude of tension (N)",
                "Amplitude of arm (°)",
                "Phase (°)",
                "order 4",
                "RMS of all orders",
            ],
        ),
        (
            "mode-shapes",
            &["1: 18.0 Hz, rotation", "6: 83.0 Hz, span 6", "at rest"],
        ),
    ];
    for (name, expected) in cases {
        let written = texts(&figure(name, Width::Double));
        for text in expected {
            assert!(
                written.contains(&(*text).to_string()),
                "{name}: {text} is missing in {written:?}"
            );
        }
    }
}

#[test]
fn every_marked_speed_is_written_in_every_polar_diagram() {
    for width in [Width::Single, Width::Double] {
        for name in ["hub-load-polar", "hub-load-polar-one"] {
            let figure = figure(name, width);
            let written = texts(&figure);
            for speed in ["600", "2400", "4200", "6000"] {
                let count = written.iter().filter(|text| *text == speed).count();
                // 600 is a ring of some diagrams as well.
                assert!(
                    count >= figure.rows.iter().flatten().count(),
                    "{width:?} {name}: {speed}"
                );
            }
        }
    }
}

/// Numbers that drawing code stumbles over.
const EXTREMES: [f64; 8] = [0.0, 1.0, -1.0, f64::NAN, f64::INFINITY, 1e300, -1e300, 5e-324];

#[test]
fn extreme_drives_are_drawn_without_panic_or_overlap() {
    for (index, a) in EXTREMES.iter().enumerate() {
        let b = EXTREMES[(index + 3) % EXTREMES.len()];
        let layout = DriveLayout {
            pulleys: vec![
                LayoutPulley {
                    name: "first".into(),
                    center: [*a, b],
                    radius: *a,
                    sense: *a,
                    tangent_in: [b, *a],
                    tangent_out: [*a, *a],
                    wrap: b,
                    hub_load: Some([*a, b]),
                    ..LayoutPulley::default()
                };
                2
            ],
            spans: vec![LayoutSpan {
                label: "span".into(),
                start: [*a, b],
                end: [b, *a],
                note: String::new(),
            }],
            tensioners: [
                TensionerMount::Rotary {
                    pivot: [b, *a],
                    stops: Some([*a, b]),
                },
                TensionerMount::Linear {
                    direction: [0.0, *a],
                    stops: Some([*a, b]),
                },
            ]
            .map(|mount| LayoutTensioner {
                name: "arm".into(),
                mount,
                centers: vec![[*a, b]],
            })
            .to_vec(),
        };
        let values = vec![*a, b, 1.0];
        let curve = Curve {
            name: "curve".into(),
            x: values.clone(),
            y: vec![b, *a, *a],
        };
        let options = FigureOptions::default();
        let mut figures = mode_shapes(
            &ModeShapes {
                layout: layout.clone(),
                modes: vec![ModeShape {
                    heading: "mode".into(),
                    spans: vec![vec![[*a, b], [b, *a]]],
                    rotations: vec![*a, b, 3.0],
                    centers: vec![[b, *a]; 5],
                }],
            },
            &options,
        );
        figures.push(drive_layout(&layout, &options));
        figures.push(campbell(
            &Campbell {
                modes: vec![CampbellMode {
                    name: "1".into(),
                    speed: values.clone(),
                    frequency: vec![b, *a, *a],
                    kinds: vec![ModeKind::Span(1)],
                }],
                orders: values.clone(),
                order_slope: *a,
                crossings: vec![[*a, b]],
                critical_speed: Some(b),
                ..Campbell::default()
            },
            &options,
        ));
        figures.push(tension_fan(
            &TensionFan {
                panels: vec![
                    TensionPanel {
                        heading: "span".into(),
                        conditions: vec![curve.clone(); 2],
                    };
                    2
                ],
                band: true,
                threshold: Some((*a, "least".into())),
                ..TensionFan::default()
            },
            &options,
        ));
        figures.push(hub_load_polar(
            &HubLoadPolar {
                pulleys: vec![HubLoadPath {
                    name: "first".into(),
                    speed: values.clone(),
                    load: vec![[*a, b], [b, *a]],
                }],
                marked_speeds: values.clone(),
                ..HubLoadPolar::default()
            },
            &options,
        ));
        figures.push(order_response(
            &OrderResponse {
                measures: vec![OrderMeasure {
                    amplitude: Axis::logarithmic("A", "N"),
                    orders: vec![OrderCurve {
                        order: *a,
                        speed: values.clone(),
                        amplitude: vec![b, *a],
                        phase: values.clone(),
                    }],
                    totals: vec![curve],
                    ..OrderMeasure::default()
                }],
                phase: Some(Axis::linear("phase", "°")),
                ..OrderResponse::default()
            },
            &options,
        ));
        for (number, figure) in figures.iter().enumerate() {
            let name = format!("figure {number} with {a} and {b}");
            let svg = figure.svg();
            assert!(roxmltree::Document::parse(&svg).is_ok(), "{name}");
            let boxes = figure.text_boxes();
            for (index, text) in boxes.iter().enumerate() {
                for other in &boxes[..index] {
                    assert!(!text.overlaps(other), "{name}: {text:?} overlaps {other:?}");
                }
            }
            figure.png(0.5).unwrap();
        }
    }
}

#[test]
fn empty_input_gives_empty_figures() {
    let options = FigureOptions::default();
    let figures = [
        drive_layout(&DriveLayout::default(), &options),
        campbell(&Campbell::default(), &options),
        tension_fan(&TensionFan::default(), &options),
        hub_load_polar(&HubLoadPolar::default(), &options),
        order_response(&OrderResponse::default(), &options),
    ];
    for figure in figures {
        figure.png(0.5).unwrap();
    }
    assert!(mode_shapes(&ModeShapes::default(), &options).is_empty());
}
