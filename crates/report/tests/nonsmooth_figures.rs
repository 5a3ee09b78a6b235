//! What must hold for the figures of one-way clutches and dry friction beyond what holds for all figures: values and
//! warnings are written, marks stand where they belong, and no panic from empty or extreme data.

#[path = "samples/nonsmooth.rs"]
mod nonsmooth;

use slackside_report::figures::*;
use slackside_report::plot::{Axis, Figure, Layer, Panel, Width};

const WIDTHS: [Width; 2] = [Width::Single, Width::Double];

fn figure(name: &str, width: Width) -> Figure {
    let (_, figure) = nonsmooth::all(width)
        .into_iter()
        .find(|(other, _)| *other == name)
        .unwrap();
    figure
}

/// All text of a figure; words of a broken line are joined by spaces.
fn written(figure: &Figure) -> String {
    let texts: Vec<String> = figure.text_boxes().into_iter().map(|text| text.text).collect();
    texts.join(" ")
}

fn panels(figure: &Figure) -> impl Iterator<Item = &Panel> {
    figure.rows.iter().flatten()
}

#[test]
fn every_figure_names_its_quantities_units_and_values() {
    let cases: [(&str, &[&str]); 10] = [
        (
            "regime-timeline-clutch",
            &[
                "Time (ms)",
                "Speed (rad/s)",
                "Clutch torque (N m)",
                "alternator",
                "locked",
                "overrunning",
                "release",
            ],
        ),
        (
            "regime-timeline-arm",
            &[
                "Arm angle (°)",
                "tensioner arm",
                "stick",
                "slip +",
                "slip −",
                "stop",
                "break-away",
                "contact",
            ],
        ),
        ("torque-angle", &["Q_{m} = 0.6 N m: 0.38", " J", "arm sticks"]),
        (
            "dissipation",
            &[
                "optimum ",
                "stick–slip",
                "locked",
                "reversals",
                "stops in a half cycle",
            ],
        ),
        ("dissipation-family", &["1200 rpm, optimum 1.8", "optimum"]),
        (
            "engaged-ratio",
            &[
                "1500 rpm, critical 4.37 N m",
                "2000 rpm, critical 7.62 N m",
                "critical value",
            ],
        ),
        (
            "tension-extremes",
            &[
                "span 3: alternator – crank",
                "static tension",
                "Span tension (N)",
                "Engine speed (rpm)",
            ],
        ),
        (
            "clutch-comparison",
            &[
                "rigid pulley",
                "one-way clutch",
                "decoupler",
                "isolator",
                "Arm angle, RMS (°)",
            ],
        ),
        (
            "critical-level-log",
            &[
                "J_{a}/J_{p} = 8",
                "alternator at full load: 5 N m",
                "resonance of the locked system",
            ],
        ),
        ("waterfall-orders", &["Harmonic order (–)", "mm"]),
    ];
    for (name, expected) in cases {
        for width in WIDTHS {
            let text = written(&figure(name, width));
            for part in expected {
                assert!(
                    text.contains(part),
                    "{name} {width:?}: {part} is missing in {text}"
                );
            }
        }
    }
}

#[test]
fn warnings_are_written_on_every_kind_of_figure_and_the_page_grows() {
    let warnings = vec!["event budget of 10000 exhausted at 2100 rpm".to_string()];
    for width in WIDTHS {
        let plain = FigureOptions {
            width,
            ..FigureOptions::default()
        };
        let warned = FigureOptions {
            warnings: warnings.clone(),
            ..plain.clone()
        };
        let family = CurveFamily::default();
        let pairs = [
            (curve_family(&family, &plain), curve_family(&family, &warned)),
            (
                engaged_ratio(&nonsmooth::engaged(true), &plain),
                engaged_ratio(&nonsmooth::engaged(true), &warned),
            ),
            // Nothing to draw is no reason for silence.
            (
                comparison(&Comparison::default(), &plain),
                comparison(&Comparison::default(), &warned),
            ),
        ];
        for (without, with) in pairs {
            assert!(!written(&without).contains("event budget"));
            assert!(written(&with).contains(&warnings[0]));
            let height = |figure: &Figure| {
                let svg = figure.svg();
                let document = roxmltree::Document::parse(&svg).unwrap();
                let view = document.root_element().attribute("viewBox").unwrap();
                view.rsplit(' ').next().unwrap().parse::<f64>().unwrap()
            };
            assert!(height(&with) > height(&without) + 8.0);
        }
    }
}

#[test]
fn a_slack_span_is_shaded_and_named_and_a_taut_one_is_not() {
    for (name, who) in [
        (
            "tension-extremes",
            "span 3: alternator – crank would be slack at ",
        ),
        ("tension-extremes-one", "span 3 would be slack at "),
    ] {
        for width in WIDTHS {
            let figure = figure(name, width);
            let text = written(&figure);
            assert!(text.contains(who), "{name}: {text}");
            assert_eq!(text.matches("would be slack").count(), 1, "{name}");
            assert!(text.contains("slack: the linear model does not hold"));
            // The shaded part lies below zero and where the least tension is negative.
            let range = &nonsmooth::tensions(true).panels[0].ranges[2];
            let low = |x: f64| {
                let i = range.x.iter().position(|other| *other >= x).unwrap();
                range.static_tension[i] + range.min[i]
            };
            let areas: Vec<&Vec<[f64; 2]>> = panels(&figure)
                .flat_map(|panel| &panel.layers)
                .filter_map(|layer| match layer {
                    Layer::Area { points, .. } => Some(points),
                    _ => None,
                })
                .filter(|points| points.iter().all(|point| point[1] <= 0.0 || point[1].is_nan()))
                .collect();
            assert_eq!(areas.len(), 1, "{name}");
            let deepest = areas[0]
                .iter()
                .filter(|point| point[1].is_finite())
                .min_by(|a, b| a[1].total_cmp(&b[1]))
                .unwrap();
            assert!(deepest[1] < -1.0 && (deepest[1] - low(deepest[0])).abs() < 1e-9);
        }
    }
}

#[test]
fn a_period_drawn_twice_shows_every_event_twice() {
    let once = RegimeTimeline {
        repetition: None,
        ..nonsmooth::clutch_timeline()
    };
    let events = once.lanes[0].events.len();
    assert!(events >= 2);
    let marks = |input: &RegimeTimeline| -> usize {
        let figure = regime_timeline(input, &FigureOptions::default());
        let lanes = figure.rows.last().unwrap().first().unwrap();
        let points = lanes.layers.iter().map(|layer| match layer {
            Layer::Points { points, .. } => points.len(),
            _ => 0,
        });
        points.sum()
    };
    assert_eq!(marks(&once), events);
    assert_eq!(marks(&nonsmooth::clutch_timeline()), 2 * events);
}

#[test]
fn lanes_are_as_high_as_their_number_and_curves_take_the_rest() {
    for height in [None, Some(180.0)] {
        let options = FigureOptions {
            height,
            ..FigureOptions::default()
        };
        let mut input = nonsmooth::clutch_timeline();
        input.lanes = vec![input.lanes[0].clone(); 3];
        let figure = regime_timeline(&input, &options);
        let svg = figure.svg();
        let document = roxmltree::Document::parse(&svg).unwrap();
        // Frames are the only outlined rectangles of half a point, apart from samples in the legend.
        let frames: Vec<f64> = document
            .descendants()
            .filter(|node| node.has_tag_name("rect") && node.attribute("stroke-width") == Some("0.5"))
            .map(|node| node.attribute("height").unwrap().parse().unwrap())
            .collect();
        assert_eq!(frames.len(), 3);
        assert!((frames[2] - 3.0 * 11.5).abs() < 0.02, "{frames:?}");
        assert!(
            (frames[0] - frames[1]).abs() < 0.02 && frames[0] > 40.0,
            "{frames:?}"
        );
    }
}

#[test]
fn lines_are_dashed_only_where_uniqueness_is_not_guaranteed() {
    let dashed = |figure: &Figure| -> Vec<Vec<[f64; 2]>> {
        panels(figure)
            .flat_map(|panel| &panel.layers)
            .filter_map(|layer| match layer {
                Layer::Line { points, stroke } if stroke.dash != slackside_report::plot::Dash::Solid => {
                    Some(points.clone())
                }
                _ => None,
            })
            .collect()
    };
    let doubtful = figure("certified-response", Width::Single);
    let parts = dashed(&doubtful);
    assert_eq!(parts.len(), 6, "three curves in two panels");
    let inside = parts
        .iter()
        .flatten()
        .all(|point| (2550.0..4250.0).contains(&point[0]));
    assert!(inside);
    let text = written(&doubtful);
    for part in [
        "uniqueness not guaranteed",
        "slack span 3",
        "gross slip",
        "event budget",
        "10000 events",
    ] {
        assert!(text.contains(part), "{part} is missing in {text}");
    }
    let clean = figure("certified-response-clean", Width::Single);
    assert!(dashed(&clean).is_empty() && !written(&clean).contains("uniqueness"));
}

#[test]
fn resonances_are_marked_over_the_whole_height_on_both_scales() {
    for axis in [Axis::linear("M", "N m"), Axis::logarithmic("M", "N m")] {
        let figure = critical_level(&nonsmooth::critical(axis), &FigureOptions::default());
        let marks: Vec<&Vec<f64>> = panels(&figure)
            .flat_map(|panel| &panel.layers)
            .filter_map(|layer| match layer {
                Layer::Uprights { x, .. } => Some(x),
                _ => None,
            })
            .collect();
        assert_eq!(marks, [&vec![2100.0, 3900.0, 5300.0]]);
    }
}

#[test]
fn loops_emphasise_sticking_and_grow_with_their_energy() {
    let loops = nonsmooth::friction_loops();
    // Pure slip has no sticking part, the largest torque has one.
    let sticks: Vec<bool> = loops.loops.iter().map(|one| one.sticks.contains(&true)).collect();
    assert!(!sticks[0] && sticks[3]);
    let figure = torque_angle(&loops, &FigureOptions::default());
    let thick = panels(&figure)
        .flat_map(|panel| &panel.layers)
        .filter(|layer| match layer {
            Layer::Line { stroke, .. } => stroke.width > 2.0,
            _ => false,
        });
    assert!(thick.count() >= 2);
    let arrows = panels(&figure)
        .flat_map(|panel| &panel.layers)
        .filter(|layer| matches!(layer, Layer::Arrow { .. }));
    assert_eq!(arrows.count(), 8);
}

/// Numbers that drawing code stumbles over.
const EXTREMES: [f64; 8] = [0.0, 1.0, -1.0, f64::NAN, f64::INFINITY, 1e300, -1e300, 5e-324];

#[test]
fn extreme_data_is_drawn_without_panic_or_overlap() {
    for (index, a) in EXTREMES.iter().copied().enumerate() {
        let b = EXTREMES[(index + 3) % EXTREMES.len()];
        let c = EXTREMES[(index + 5) % EXTREMES.len()];
        for axis in [Axis::linear("y", "N m"), Axis::logarithmic("y", "N m")] {
            let (x, y) = (vec![a, b, 1.0, c], vec![b, a, a]);
            let curve = Curve {
                name: "curve".into(),
                x: x.clone(),
                y: y.clone(),
            };
            let options = FigureOptions {
                warnings: vec![format!("a warning with {a}")],
                ..FigureOptions::default()
            };
            let lane = RegimeLane {
                name: "an element with a name far wider than a lane may be".into(),
                intervals: vec![RegimeInterval {
                    from: a,
                    to: b,
                    regime: Regime::Stick,
                }],
                events: vec![TimelineEvent {
                    time: b,
                    kind: RegimeEvent::Stop,
                }],
            };
            let figures = [
                regime_timeline(
                    &RegimeTimeline {
                        time: axis.clone(),
                        panels: vec![TimePanel {
                            y: axis.clone(),
                            curves: vec![curve.clone()],
                        }],
                        lanes: vec![lane; 2],
                        repetition: Some(Repetition { period: a, count: 3 }),
                    },
                    &options,
                ),
                torque_angle(
                    &TorqueAngle {
                        angle: axis.clone(),
                        torque: axis.clone(),
                        loops: vec![FrictionLoop {
                            name: "loop".into(),
                            angle: x.clone(),
                            torque: y.clone(),
                            sticks: vec![true, false],
                            dissipation: Some(a),
                        }],
                    },
                    &options,
                ),
                dissipation(
                    &Dissipation {
                        torque: axis.clone(),
                        energy: axis.clone(),
                        curves: vec![DissipationCurve {
                            curve: curve.clone(),
                            optimum: Some([a, b]),
                        }],
                        regions: vec![FrictionRegion {
                            from: a,
                            to: b,
                            kind: FrictionRegionKind::Locked,
                        }],
                        counters: Some(ReversalCounters {
                            count: axis.clone(),
                            reversals: curve.clone(),
                            stops: curve.clone(),
                        }),
                    },
                    &options,
                ),
                engaged_ratio(
                    &EngagedRatio {
                        x: axis.clone(),
                        ratio: axis.clone(),
                        curves: vec![EngagedRatioCurve {
                            curve: curve.clone(),
                            critical: Some(b),
                        }],
                    },
                    &options,
                ),
                tension_extremes(
                    &TensionExtremes {
                        x: axis.clone(),
                        tension: axis.clone(),
                        panels: vec![TensionRangePanel {
                            heading: "span".into(),
                            ranges: vec![TensionRange {
                                name: "range".into(),
                                x: x.clone(),
                                static_tension: vec![a, b],
                                min: y.clone(),
                                max: x.clone(),
                            }],
                        }],
                    },
                    &options,
                ),
                comparison(
                    &Comparison {
                        x: axis.clone(),
                        measures: vec![
                            ComparedMeasure {
                                heading: "measure".into(),
                                y: axis.clone(),
                                curves: vec![curve.clone()],
                            };
                            3
                        ],
                    },
                    &options,
                ),
                critical_level(
                    &CriticalLevel {
                        x: axis.clone(),
                        level: axis.clone(),
                        curves: vec![curve.clone()],
                        resonances: x.clone(),
                        actual: Some((a, "level".into())),
                    },
                    &options,
                ),
                waterfall_orders(
                    &Waterfall {
                        parameter: axis.clone(),
                        frequency: axis.clone(),
                        amplitude: axis.clone(),
                        spectra: vec![ResponseSpectrum {
                            parameter: a,
                            frequency: x.clone(),
                            amplitude: y.clone(),
                        }],
                    },
                    &options,
                ),
                certified_response(
                    &CertifiedResponse {
                        x: axis.clone(),
                        measures: vec![CertifiedMeasure {
                            y: axis.clone(),
                            curves: vec![CertifiedCurve {
                                name: "curve".into(),
                                x: x.clone(),
                                y: y.clone(),
                                unique: vec![true, false],
                            }],
                        }],
                        warnings: vec![RangeWarning {
                            name: "slack".into(),
                            text: "text".into(),
                            intervals: vec![[a, b], [b, c]],
                        }],
                    },
                    &options,
                ),
            ];
            for (number, figure) in figures.iter().enumerate() {
                let name = format!("figure {number} with {a}, {b} and {c}");
                let svg = figure.svg();
                assert!(!svg.contains("NaN") || svg.contains("with NaN"), "{name}");
                assert!(roxmltree::Document::parse(&svg).is_ok(), "{name}");
                let boxes = figure.text_boxes();
                for (index, text) in boxes.iter().enumerate() {
                    for other in &boxes[..index] {
                        assert!(!text.overlaps(other), "{name}: {text:?} overlaps {other:?}");
                    }
                }
                assert!(written(figure).contains("a warning with"), "{name}");
                figure.png(0.5).unwrap();
            }
        }
    }
}

#[test]
fn empty_input_gives_empty_figures() {
    let options = FigureOptions::default();
    let figures = [
        regime_timeline(&RegimeTimeline::default(), &options),
        torque_angle(&TorqueAngle::default(), &options),
        dissipation(&Dissipation::default(), &options),
        engaged_ratio(&EngagedRatio::default(), &options),
        tension_extremes(&TensionExtremes::default(), &options),
        comparison(&Comparison::default(), &options),
        critical_level(&CriticalLevel::default(), &options),
        waterfall_orders(&Waterfall::default(), &options),
        certified_response(&CertifiedResponse::default(), &options),
    ];
    for figure in figures {
        figure.png(0.5).unwrap();
    }
}
