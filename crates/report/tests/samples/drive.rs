//! A serpentine drive of eight pulleys, its geometry from the tangents of circles, and plausible results.

use std::f64::consts::{PI, TAU};

use slackside_report::figures::*;
use slackside_report::plot::{Axis, Figure, Width, direction};

/// The figures of a drive with a name, at one width.
pub fn all(width: Width) -> Vec<(&'static str, Figure)> {
    let options = FigureOptions {
        width,
        ..FigureOptions::default()
    };
    let mut modes = mode_shapes(&shapes(), &options);
    let pages = modes.len();
    assert_eq!(pages, 2, "eight modes fill one page and a part of another");
    vec![
        ("drive-layout", drive_layout(&layout(), &options)),
        (
            "drive-layout-three",
            drive_layout(&drive(&THREE, [250.8, 63.5]), &options),
        ),
        ("drive-layout-plain", drive_layout(&plain_layout(), &options)),
        ("mode-shapes", modes.remove(0)),
        ("mode-shapes-rest", modes.remove(0)),
        ("campbell", campbell(&speeds(), &options)),
        ("tension-fan", tension_fan(&fan(3), &options)),
        ("tension-fan-one", tension_fan(&fan(1), &options)),
        ("hub-load-polar", hub_load_polar(&polar(7), &options)),
        ("hub-load-polar-one", hub_load_polar(&polar(1), &options)),
        ("order-response", order_response(&orders(true), &options)),
        (
            "order-response-amplitude",
            order_response(&orders(false), &options),
        ),
    ]
}

/// Name, centre and radius in millimetres, sense, torque in N m.
type Pulley = (&'static str, [f64; 2], f64, f64, f64);

/// A drive of eight pulleys that turns clockwise, with idlers on the back of the belt.
const EIGHT: [Pulley; 8] = [
    ("crank", [0.0, 0.0], 78.0, -1.0, 0.0),
    ("tensioner", [-118.0, 118.0], 36.0, 1.0, 0.0),
    ("water pump", [-60.0, 225.0], 62.0, -1.0, 9.0),
    ("idler 1", [30.0, 300.0], 33.0, 1.0, 0.0),
    ("alternator", [185.0, 330.0], 28.5, -1.0, 8.0),
    ("power steering", [260.0, 205.0], 64.0, -1.0, 11.0),
    ("idler 2", [180.0, 110.0], 36.0, 1.0, 0.0),
    ("air conditioner", [225.0, -15.0], 58.0, -1.0, 22.0),
];
/// A drive of three pulleys that turns counter-clockwise, its tensioner on the back of the belt.
const THREE: [Pulley; 3] = [
    ("crank", [552.5, 55.6], 88.9, 1.0, 0.0),
    ("tensioner", [347.8, 57.6], 45.2, -1.0, 0.0),
    ("accessory", [0.0, 0.0], 26.9, 1.0, 12.0),
];
const TENSIONER: usize = 1;

/// Start and end of the belt between two pulleys, by the common tangent (theory 04 §1.1), millimetres.
fn tangent((_, a, r_a, sense_a, _): Pulley, (_, b, r_b, sense_b, _): Pulley) -> [[f64; 2]; 2] {
    let d = [b[0] - a[0], b[1] - a[1]];
    let delta = sense_b * r_b - sense_a * r_a;
    let squared = d[0] * d[0] + d[1] * d[1];
    let length = (squared - delta * delta).sqrt();
    let e = [
        (length * d[0] + delta * d[1]) / squared,
        (length * d[1] - delta * d[0]) / squared,
    ];
    let n = [-e[1], e[0]];
    [
        [a[0] - sense_a * r_a * n[0], a[1] - sense_a * r_a * n[1]],
        [b[0] - sense_b * r_b * n[0], b[1] - sense_b * r_b * n[1]],
    ]
}

fn metres(point: [f64; 2]) -> [f64; 2] {
    point.map(|c| c / 1000.0)
}

/// Effective tension of each span, N: the span behind the crank is the slack side.
fn tensions(pulleys: &[Pulley]) -> Vec<f64> {
    let mut tension = 320.0;
    pulleys
        .iter()
        .map(|(_, _, radius, _, torque)| {
            tension += torque / (radius / 1000.0);
            tension
        })
        .collect()
}

fn unit([a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    [(b[0] - a[0]) / length, (b[1] - a[1]) / length]
}

/// The drive of eight pulleys with everything that a layout can show.
pub fn layout() -> DriveLayout {
    drive(&EIGHT, [-198.0, 62.0])
}

/// A drive with the pivot of its arm.
fn drive(list: &[Pulley], pivot: [f64; 2]) -> DriveLayout {
    let count = list.len();
    let tensions = tensions(list);
    let pulleys = (0..count)
        .map(|i| {
            let (name, center, radius, sense, torque) = list[i];
            let before = (i + count - 1) % count;
            let (span_in, span_out) = (
                tangent(list[before], list[i]),
                tangent(list[i], list[(i + 1) % count]),
            );
            let turn = direction(center, span_out[0]) - direction(center, span_in[1]);
            let (e_in, e_out) = (unit(span_in), unit(span_out));
            LayoutPulley {
                label: (i + 1).to_string(),
                name: name.to_string(),
                center: metres(center),
                radius: radius / 1000.0,
                sense,
                tangent_in: metres(span_in[1]),
                tangent_out: metres(span_out[0]),
                wrap: (sense * turn).rem_euclid(TAU),
                driver: i == 0,
                carried: i == TENSIONER,
                note: if torque > 0.0 {
                    format!("{torque} N m")
                } else {
                    String::new()
                },
                hub_load: Some([
                    tensions[i] * e_out[0] - tensions[before] * e_in[0],
                    tensions[i] * e_out[1] - tensions[before] * e_in[1],
                ]),
            }
        })
        .collect();
    let spans = (0..count)
        .map(|i| {
            let [start, end] = tangent(list[i], list[(i + 1) % count]);
            LayoutSpan {
                label: format!("span {}", i + 1),
                start: metres(start),
                end: metres(end),
                note: format!("{:.0} N", tensions[i]),
            }
        })
        .collect();
    let center = list[TENSIONER].1;
    let angle = direction(pivot, center);
    DriveLayout {
        pulleys,
        spans,
        tensioners: vec![LayoutTensioner {
            name: "arm".into(),
            mount: TensionerMount::Rotary {
                pivot: metres(pivot),
                stops: Some([angle - 0.3, angle + 0.45]),
            },
            centers: vec![metres(center)],
        }],
    }
}

/// The same drive with a slide, without loads and notes.
fn plain_layout() -> DriveLayout {
    let mut layout = layout();
    for pulley in &mut layout.pulleys {
        pulley.hub_load = None;
        pulley.note.clear();
    }
    for span in &mut layout.spans {
        span.note.clear();
    }
    layout.tensioners[0].name = "slide".into();
    layout.tensioners[0].mount = TensionerMount::Linear {
        direction: [1.0, 0.4],
        stops: Some([-0.05, 0.03]),
    };
    layout
}

/// Modes of three kinds: pulleys turn, the arm moves, one span vibrates.
fn shapes() -> ModeShapes {
    let layout = layout();
    let count = layout.pulleys.len();
    let rest: Vec<[f64; 2]> = layout.pulleys.iter().map(|pulley| pulley.center).collect();
    let bulge = |span: usize, height: f64, waves: f64, shift: [[f64; 2]; 2]| {
        let (start, end) = (layout.spans[span].start, layout.spans[span].end);
        let e = unit([start, end]);
        (0..=60)
            .map(|k| f64::from(k) / 60.0)
            .map(|t| {
                let w = height * (waves * PI * t).sin();
                let at = |c: usize, normal: f64| {
                    let (from, to) = (start[c] + shift[0][c], end[c] + shift[1][c]);
                    from + t * (to - from) + w * normal
                };
                [at(0, -e[1]), at(1, e[0])]
            })
            .collect::<Vec<_>>()
    };
    let still = [[0.0; 2]; 2];
    let modes = (0..8)
        .map(|mode| {
            let mut shape = ModeShape {
                spans: (0..count).map(|span| bulge(span, 0.004, 1.0, still)).collect(),
                centers: rest.clone(),
                ..ModeShape::default()
            };
            let frequency = 18.0 + 13.0 * f64::from(mode);
            if mode % 3 == 0 {
                shape.heading = format!("{}: {frequency:.1} Hz, rotation", mode + 1);
                shape.rotations = (0..count)
                    .map(|pulley| 1.3 * (0.9 * pulley as f64 + f64::from(mode)).cos())
                    .collect();
            } else if mode % 3 == 1 {
                shape.heading = format!("{}: {frequency:.1} Hz, arm", mode + 1);
                let moved = [0.012, -0.018];
                for (c, by) in moved.into_iter().enumerate() {
                    shape.centers[TENSIONER][c] += by;
                }
                shape.rotations = vec![0.2; count];
                shape.spans[0] = bulge(0, 0.006, 1.0, [[0.0; 2], moved]);
                shape.spans[1] = bulge(1, -0.005, 1.0, [moved, [0.0; 2]]);
            } else {
                let span = mode as usize;
                shape.heading = format!("{}: {frequency:.1} Hz, span {}", mode + 1, span + 1);
                shape.spans[span] = bulge(span, 0.025, 1.0 + f64::from(mode % 2), still);
            }
            shape
        })
        .collect();
    ModeShapes { layout, modes }
}

fn rpm() -> Vec<f64> {
    (0..=120).map(|k| 600.0 + 45.0 * f64::from(k)).collect()
}

fn speed_axis() -> Axis {
    Axis::linear("Crank speed", "rpm")
}

/// Modes that fall slowly with speed; one veers with another and exchanges its kind.
fn speeds() -> Campbell {
    let speed = rpm();
    let string = |f0: f64, c: f64| {
        speed
            .iter()
            .map(|n| f0 * (1.0 - (n / c).powi(2)).max(0.0).sqrt())
            .collect::<Vec<f64>>()
    };
    let level = |f0: f64| speed.iter().map(|n| f0 + 0.0004 * n).collect::<Vec<f64>>();
    let mode = |name: &str, frequency: Vec<f64>, kind: ModeKind| CampbellMode {
        name: name.into(),
        speed: speed.clone(),
        kinds: vec![kind; frequency.len()],
        frequency,
    };
    // The pair veers where the string frequency falls through the level one.
    let (falling, steady) = (string(104.0, 9500.0), level(85.0));
    let coupled = |sign: f64| -> (Vec<f64>, Vec<ModeKind>) {
        falling
            .iter()
            .zip(&steady)
            .map(|(a, b)| {
                let half = ((a - b) / 2.0).hypot(2.0);
                let kind = if (a - b).abs() < 3.0 {
                    ModeKind::Mixed
                } else if (a > b) == (sign > 0.0) {
                    ModeKind::Span(7)
                } else {
                    ModeKind::Rotation
                };
                ((a + b) / 2.0 + sign * half, kind)
            })
            .unzip()
    };
    let (upper, lower) = (coupled(1.0), coupled(-1.0));
    let mut modes = vec![
        mode("1", level(22.0), ModeKind::Rotation),
        mode("2", level(41.0), ModeKind::Arm),
        mode("3", string(68.0, 9800.0), ModeKind::Span(8)),
        CampbellMode {
            name: "4".into(),
            speed: speed.clone(),
            frequency: lower.0,
            kinds: lower.1,
        },
        CampbellMode {
            name: "5".into(),
            speed: speed.clone(),
            frequency: upper.0,
            kinds: upper.1,
        },
        mode("6", string(128.0, 11000.0), ModeKind::Span(1)),
        mode("7", level(141.0), ModeKind::Rotation),
        mode("8", string(176.0, 12000.0), ModeKind::Span(4)),
    ];
    // A mode that was lost on the way.
    modes[7].frequency.truncate(100);
    let orders = vec![0.5, 1.0, 2.0, 3.0, 4.0, 6.0];
    let mut crossings = Vec::new();
    for mode in &modes {
        for order in &orders {
            for k in 1..mode.frequency.len() {
                let gap = |k: usize| mode.frequency[k] - order * mode.speed[k] / 60.0;
                if gap(k - 1) > 0.0 && gap(k) <= 0.0 {
                    let t = gap(k - 1) / (gap(k - 1) - gap(k));
                    let n = mode.speed[k - 1] + t * (mode.speed[k] - mode.speed[k - 1]);
                    crossings.push([n, order * n / 60.0]);
                }
            }
        }
    }
    Campbell {
        speed: speed_axis(),
        frequency: Axis::linear("Frequency", "Hz"),
        modes,
        orders,
        order_slope: 1.0 / 60.0,
        crossings,
        critical_speed: Some(5750.0),
    }
}

fn fan(spans: usize) -> TensionFan {
    let speed = rpm();
    let panels = (0..spans)
        .map(|span| TensionPanel {
            heading: if spans > 1 {
                format!("span {}", span + 1)
            } else {
                String::new()
            },
            conditions: [
                ("new, cold", 1.0),
                ("new, hot", 0.93),
                ("worn, cold", 0.84),
                ("worn, hot", 0.78),
            ]
            .iter()
            .map(|(name, factor)| Curve {
                name: (*name).to_string(),
                x: speed.clone(),
                y: speed
                    .iter()
                    .map(|n| {
                        factor * (420.0 + 180.0 * span as f64 * (-n / 3500.0).exp())
                            - 90.0 * (n / 6000.0).powi(2)
                    })
                    .collect(),
            })
            .collect(),
        })
        .collect();
    TensionFan {
        speed: speed_axis(),
        tension: Axis::linear("Effective tension T", "N"),
        panels,
        band: true,
        threshold: Some((250.0, "least tension".into())),
    }
}

fn polar(count: usize) -> HubLoadPolar {
    let speed = rpm();
    let layout = layout();
    HubLoadPolar {
        pulleys: layout
            .pulleys
            .iter()
            .take(count)
            .map(|pulley| {
                let base = pulley.hub_load.unwrap();
                HubLoadPath {
                    name: pulley.name.clone(),
                    load: speed
                        .iter()
                        .map(|n| {
                            let (size, turn) = (1.0 - 0.4 * (n / 6000.0).powi(2), 0.3 * (n / 6000.0));
                            [
                                size * (base[0] * turn.cos() - base[1] * turn.sin()),
                                size * (base[0] * turn.sin() + base[1] * turn.cos()),
                            ]
                        })
                        .collect(),
                    speed: speed.clone(),
                }
            })
            .collect(),
        marked_speeds: vec![600.0, 2400.0, 4200.0, 6000.0],
        speed_unit: "rpm".into(),
        load_unit: "N".into(),
    }
}

fn orders(phase: bool) -> OrderResponse {
    let speed = rpm();
    let measure = |label: &str, unit: &str, size: f64, resonance: f64, heading: &str, log: bool| {
        let orders: Vec<OrderCurve> = [(2.0, 1.0), (4.0, 0.45), (6.0, 0.2)]
            .iter()
            .map(|(order, share)| {
                let response = |n: &f64| {
                    let r = order * n / 60.0 / resonance;
                    ((1.0 - r * r), 0.12 * r)
                };
                OrderCurve {
                    order: *order,
                    speed: speed.clone(),
                    amplitude: speed
                        .iter()
                        .map(|n| {
                            let (re, im) = response(n);
                            size * share / re.hypot(im)
                        })
                        .collect(),
                    phase: speed
                        .iter()
                        .map(|n| {
                            let (re, im) = response(n);
                            -im.atan2(re).to_degrees() - 60.0
                        })
                        .collect(),
                }
            })
            .collect();
        let total = |peak: bool| {
            (0..speed.len())
                .map(|k| {
                    let amplitudes = orders.iter().map(|curve| curve.amplitude[k]);
                    if peak {
                        amplitudes.sum()
                    } else {
                        (amplitudes.map(|a| a * a / 2.0).sum::<f64>()).sqrt()
                    }
                })
                .collect::<Vec<f64>>()
        };
        let named = |name: &str, y: Vec<f64>| Curve {
            name: name.into(),
            x: speed.clone(),
            y,
        };
        OrderMeasure {
            amplitude: if log {
                Axis::logarithmic(label, unit)
            } else {
                Axis::linear(label, unit)
            },
            heading: heading.into(),
            totals: vec![
                named("RMS of all orders", total(false)),
                named("peak of all orders", total(true)),
            ],
            orders,
        }
    };
    OrderResponse {
        speed: speed_axis(),
        measures: vec![
            measure(
                "Amplitude of tension",
                "N",
                60.0,
                85.0,
                "tension of span 1",
                false,
            ),
            measure("Amplitude of arm", "°", 0.6, 41.0, "rotation of the arm", true),
        ],
        phase: phase.then(|| Axis::linear("Phase", "°")),
    }
}
