//! Figures for one-way clutches and dry friction: data of small models with the shapes that drives produce.

use std::f64::consts::{PI, TAU};

use slackside_report::figures::*;
use slackside_report::plot::{Axis, Figure, Width};

/// All kinds of figures for nonsmooth elements with a name, at one width.
pub fn all(width: Width) -> Vec<(&'static str, Figure)> {
    let options = FigureOptions {
        width,
        ..FigureOptions::default()
    };
    let warned = FigureOptions {
        warnings: vec![
            "uniqueness not guaranteed: the static friction torque exceeds the kinetic one; started from 5 states, \
             all led to this response."
                .into(),
        ],
        ..options.clone()
    };
    vec![
        (
            "regime-timeline-clutch",
            regime_timeline(&clutch_timeline(), &options),
        ),
        ("regime-timeline-arm", regime_timeline(&arm_timeline(), &options)),
        ("torque-angle", torque_angle(&friction_loops(), &options)),
        ("torque-angle-warned", torque_angle(&one_loop(), &warned)),
        ("dissipation", dissipation(&dissipation_with_counters(), &options)),
        ("dissipation-family", dissipation(&dissipation_family(), &options)),
        ("engaged-ratio", engaged_ratio(&engaged(true), &options)),
        ("engaged-ratio-one", engaged_ratio(&engaged(false), &options)),
        ("tension-extremes", tension_extremes(&tensions(false), &options)),
        (
            "tension-extremes-one",
            tension_extremes(&tensions(true), &options),
        ),
        ("clutch-comparison", comparison(&clutches(4), &options)),
        ("clutch-comparison-one", comparison(&clutches(1), &options)),
        (
            "critical-level",
            critical_level(&critical(Axis::linear("Critical load M_{cr}", "N m")), &options),
        ),
        (
            "critical-level-log",
            critical_level(
                &critical(Axis::logarithmic("Critical load M_{cr}", "N m")),
                &options,
            ),
        ),
        ("waterfall-orders", waterfall_orders(&orders(), &options)),
        ("waterfall-orders-map", waterfall_map(&orders(), &options)),
        ("certified-response", certified_response(&certified(), &options)),
        (
            "certified-response-clean",
            certified_response(
                &CertifiedResponse {
                    warnings: vec![],
                    measures: certified()
                        .measures
                        .into_iter()
                        .take(1)
                        .map(|mut measure| {
                            measure.curves.iter_mut().for_each(|curve| curve.unique.clear());
                            measure
                        })
                        .collect(),
                    ..certified()
                },
                &options,
            ),
        ),
    ]
}

fn speed() -> Axis {
    Axis::linear("Engine speed", "rpm")
}

fn curve(name: impl Into<String>, x: &[f64], y: impl Fn(f64) -> f64) -> Curve {
    Curve {
        name: name.into(),
        x: x.to_vec(),
        y: x.iter().map(|x| y(*x)).collect(),
    }
}

/// Values from `low` to `high` at equal distances.
fn range(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|i| low + (high - low) * i as f64 / (count - 1) as f64)
        .collect()
}

fn resonance(x: f64, at: f64, width: f64) -> f64 {
    1.0 / ((1.0 - (x / at).powi(2)).powi(2) + (width * x / at).powi(2)).sqrt()
}

/// A pulley that moves as given with an accessory behind a one-way clutch: the accessory follows, or coasts down.
pub fn clutch_timeline() -> RegimeTimeline {
    const PERIOD: f64 = 20.0;
    let pulley = |t: f64| {
        let phase = TAU * t / PERIOD;
        9.0 * phase.cos() + 3.5 * (3.0 * phase + 0.6).cos()
    };
    let (steps, coasting) = (4000, -1.1);
    let step = PERIOD / f64::from(steps);
    let mut accessory = pulley(0.0);
    let mut open = false;
    let (mut times, mut speeds, mut torques, mut states) = (vec![], vec![], vec![], vec![]);
    for index in 0..=2 * steps {
        let t = f64::from(index) * step;
        let rate = (pulley(t + step) - pulley(t - step)) / (2.0 * step);
        if open {
            accessory += coasting * step;
            open = accessory > pulley(t);
        } else {
            open = rate < coasting;
        }
        if !open {
            accessory = pulley(t);
        }
        // The second period is periodic.
        if index >= steps {
            times.push(t - PERIOD);
            speeds.push(accessory);
            torques.push(if open { 0.0 } else { 1.4 * (rate - coasting) });
            states.push(open);
        }
    }
    let mut lane = RegimeLane {
        name: "alternator".into(),
        ..RegimeLane::default()
    };
    let mut from = 0;
    for index in 1..states.len() {
        let changes = states[index] != states[from];
        if changes || index + 1 == states.len() {
            lane.intervals.push(RegimeInterval {
                from: times[from],
                to: times[index],
                regime: if states[from] {
                    Regime::Overrunning
                } else {
                    Regime::Locked
                },
            });
        }
        if changes {
            lane.events.push(TimelineEvent {
                time: times[index],
                kind: if states[index] {
                    RegimeEvent::Release
                } else {
                    RegimeEvent::Locking
                },
            });
            from = index;
        }
    }
    let named = |name: &str, y: &[f64]| Curve {
        name: name.into(),
        x: times.clone(),
        y: y.to_vec(),
    };
    let pulley: Vec<f64> = times.iter().map(|t| pulley(*t)).collect();
    RegimeTimeline {
        time: Axis::linear("Time", "ms"),
        panels: vec![
            TimePanel {
                y: Axis::linear("Speed", "rad/s"),
                curves: vec![named("pulley", &pulley), named("accessory", &speeds)],
            },
            TimePanel {
                y: Axis::linear("Clutch torque", "N m"),
                curves: vec![named("", &torques)],
            },
        ],
        lanes: vec![lane],
        repetition: Some(Repetition {
            period: PERIOD,
            count: 2,
        }),
    }
}

/// One settled cycle of an arm with dry friction.
struct Cycle {
    time: Vec<f64>,
    angle: Vec<f64>,
    friction: Vec<f64>,
    /// −1, 0 or 1.
    direction: Vec<i8>,
}

/// x″ + 0.05 x′ + x + q sgn x′ = cos Ωt + 0.3 cos 3Ωt at Ω = 0.31, by small steps.
fn arm(q: f64) -> Cycle {
    const FREQUENCY: f64 = 0.31;
    const STEPS: usize = 2000;
    let step = TAU / FREQUENCY / STEPS as f64;
    let (mut x, mut v, mut direction) = (0.0, 0.0, 0_i8);
    let mut cycle = Cycle {
        time: vec![],
        angle: vec![],
        friction: vec![],
        direction: vec![],
    };
    for index in 0..8 * STEPS {
        let t = index as f64 * step;
        let push = (FREQUENCY * t).cos() + 0.3 * (3.0 * FREQUENCY * t).cos() - x - 0.05 * v;
        if direction == 0 && push.abs() > q {
            direction = if push > 0.0 { 1 } else { -1 };
        }
        let friction = if direction == 0 {
            push
        } else {
            q * f64::from(direction)
        };
        if direction != 0 {
            let next = v + step * (push - friction);
            if next * f64::from(direction) <= 0.0 && v != 0.0 {
                v = 0.0;
                direction = if push.abs() > q { -direction } else { 0 };
            } else {
                v = next;
            }
            x += step * v;
        }
        if index >= 7 * STEPS {
            cycle.time.push((index - 7 * STEPS) as f64 * step);
            cycle.angle.push(1.8 * x);
            cycle.friction.push(6.0 * friction);
            cycle.direction.push(direction);
        }
    }
    cycle
}

impl Cycle {
    /// Dissipated energy, joules, from newton metres and degrees.
    fn energy(&self) -> f64 {
        let steps = self.angle.windows(2).zip(self.friction.windows(2));
        steps
            .map(|(angle, torque)| (angle[1] - angle[0]).to_radians() * (torque[0] + torque[1]) / 2.0)
            .sum()
    }

    fn count(&self, change: impl Fn(i8, i8) -> bool) -> f64 {
        let pairs = self.direction.windows(2);
        pairs.filter(|pair| change(pair[0], pair[1])).count() as f64
    }

    fn sticks(&self) -> Vec<bool> {
        self.direction.iter().map(|direction| *direction == 0).collect()
    }
}

fn arm_timeline() -> RegimeTimeline {
    let cycle = arm(0.42);
    let scale = 20.0 / cycle.time[cycle.time.len() - 1];
    let time: Vec<f64> = cycle.time.iter().map(|t| t * scale).collect();
    let mut arm = RegimeLane {
        name: "tensioner arm".into(),
        ..RegimeLane::default()
    };
    let mut from = 0;
    for index in 1..time.len() {
        let (before, after) = (cycle.direction[from], cycle.direction[index]);
        if before != after || index + 1 == time.len() {
            arm.intervals.push(RegimeInterval {
                from: time[from],
                to: time[index],
                regime: match before {
                    0 => Regime::Stick,
                    1 => Regime::SlipPositive,
                    _ => Regime::SlipNegative,
                },
            });
        }
        if before != after {
            arm.events.push(TimelineEvent {
                time: time[index],
                kind: match (before, after) {
                    (_, 0) => RegimeEvent::Stop,
                    (0, _) => RegimeEvent::BreakAway,
                    _ => RegimeEvent::Reversal,
                },
            });
            from = index;
        }
    }
    let named = |y: &[f64]| {
        vec![Curve {
            name: String::new(),
            x: time.clone(),
            y: y.to_vec(),
        }]
    };
    let stop = RegimeLane {
        name: "end stop".into(),
        intervals: vec![
            RegimeInterval {
                from: 0.0,
                to: 1.4,
                regime: Regime::Contact,
            },
            RegimeInterval {
                from: 1.4,
                to: 18.5,
                regime: Regime::Free,
            },
            RegimeInterval {
                from: 18.5,
                to: 20.0,
                regime: Regime::Contact,
            },
        ],
        events: vec![TimelineEvent {
            time: 18.5,
            kind: RegimeEvent::Impact,
        }],
    };
    let clutch = clutch_timeline().lanes.remove(0);
    RegimeTimeline {
        time: Axis::linear("Time", "ms"),
        panels: vec![
            TimePanel {
                y: Axis::linear("Arm angle", "°"),
                curves: named(&cycle.angle),
            },
            TimePanel {
                y: Axis::linear("Friction torque", "N m"),
                curves: named(&cycle.friction),
            },
        ],
        lanes: vec![arm, clutch, stop],
        repetition: None,
    }
}

fn friction_loop(q: f64, name: String) -> FrictionLoop {
    let cycle = arm(q);
    FrictionLoop {
        name,
        dissipation: Some(cycle.energy()),
        sticks: cycle.sticks(),
        angle: cycle.angle,
        torque: cycle.friction,
    }
}

pub fn friction_loops() -> TorqueAngle {
    TorqueAngle {
        angle: Axis::linear("Arm angle", "°"),
        torque: Axis::linear("Friction torque", "N m"),
        loops: [0.1, 0.3, 0.5, 0.8]
            .map(|q| friction_loop(q, format!("Q_{{m}} = {:.1} N m", 6.0 * q)))
            .to_vec(),
    }
}

/// Torque of the whole arm: spring and friction.
fn one_loop() -> TorqueAngle {
    let mut one = friction_loop(0.3, String::new());
    one.torque
        .iter_mut()
        .zip(&one.angle)
        .for_each(|(torque, angle)| *torque += 3.0 * angle);
    TorqueAngle {
        torque: Axis::linear("Arm torque", "N m"),
        loops: vec![one],
        ..friction_loops()
    }
}

pub fn dissipation_with_counters() -> Dissipation {
    let levels = range(0.01, 1.5, 75);
    let cycles: Vec<Cycle> = levels.iter().map(|q| arm(*q)).collect();
    let torque: Vec<f64> = levels.iter().map(|q| 6.0 * q).collect();
    let of = |f: &dyn Fn(&Cycle) -> f64| Curve {
        name: String::new(),
        x: torque.clone(),
        y: cycles.iter().map(f).collect(),
    };
    let energy = of(&|cycle| cycle.energy());
    let best = (0..energy.y.len())
        .max_by(|a, b| energy.y[*a].total_cmp(&energy.y[*b]))
        .unwrap();
    let optimum = Some([energy.x[best], energy.y[best]]);
    let first = |moves: &dyn Fn(&Cycle) -> bool| torque[cycles.iter().position(moves).unwrap()];
    let (sticks, locked) = (
        first(&|cycle| cycle.direction.contains(&0)),
        first(&|cycle| cycle.direction.iter().all(|direction| *direction == 0)),
    );
    let region = |from, to, kind| FrictionRegion { from, to, kind };
    Dissipation {
        torque: Axis::linear("Coulomb torque Q_{m}", "N m"),
        energy: Axis::linear("Dissipation in a cycle", "J"),
        curves: vec![DissipationCurve {
            curve: energy,
            optimum,
        }],
        regions: vec![
            region(0.0, sticks, FrictionRegionKind::Slip),
            region(sticks, locked, FrictionRegionKind::StickSlip),
            region(locked, 100.0, FrictionRegionKind::Locked),
        ],
        counters: Some(ReversalCounters {
            count: Axis::linear("Count", ""),
            reversals: of(&|cycle| cycle.count(|a, b| a != b && b != 0) - 0.0),
            stops: of(&|cycle| (cycle.count(|a, b| a != 0 && b == 0) / 2.0).ceil()),
        }),
    }
}

fn dissipation_family() -> Dissipation {
    let torque = range(0.0, 12.0, 200);
    let curves = [(1200, 4.0, 0.35), (1800, 7.5, 1.2), (2600, 11.0, 0.8)].map(|(speed, locked, peak)| {
        let curve = curve(format!("{speed} rpm"), &torque, |q| {
            let s = (q / locked).min(1.0);
            4.0 * peak * s * (1.0 - s).powf(1.2)
        });
        let best = (0..curve.y.len())
            .max_by(|a, b| curve.y[*a].total_cmp(&curve.y[*b]))
            .unwrap();
        DissipationCurve {
            optimum: Some([curve.x[best], curve.y[best]]),
            curve,
        }
    });
    Dissipation {
        torque: Axis::linear("Coulomb torque Q_{m}", "N m"),
        energy: Axis::linear("Dissipation in a cycle", "J"),
        curves: curves.to_vec(),
        ..Dissipation::default()
    }
}

pub fn engaged(several: bool) -> EngagedRatio {
    let load = range(0.1, 12.0, 300);
    let of = |name: &str, critical: f64| EngagedRatioCurve {
        curve: curve(name, &load, |m| match m / critical {
            s if s < 1.0 => 1.0 - 0.55 * (1.0 - s).sqrt() - 0.01 * (9.0 * s).sin() * (1.0 - s),
            _ => 1.0,
        }),
        critical: Some(critical),
    };
    EngagedRatio {
        x: Axis::linear("Alternator load M_{l}", "N m"),
        ratio: Axis::linear("Engaged-time ratio", "–"),
        curves: if several {
            vec![of("1500 rpm", 4.37), of("2000 rpm", 7.62), of("3000 rpm", 10.9)]
        } else {
            vec![of("", 7.62)]
        },
    }
}

pub fn tensions(one: bool) -> TensionExtremes {
    let x = range(600.0, 6000.0, 400);
    let of = |number: usize, amplitude: f64, at: f64| TensionRange {
        name: if one {
            format!("span {number}")
        } else {
            String::new()
        },
        static_tension: x
            .iter()
            .map(|x| 380.0 - 25.0 * number as f64 + 8e-6 * x * x)
            .collect(),
        min: x
            .iter()
            .map(|x| -amplitude * (0.4 + resonance(*x, at, 0.2)))
            .collect(),
        max: x
            .iter()
            .map(|x| amplitude * (0.5 + resonance(*x, at, 0.22)))
            .collect(),
        x: x.clone(),
    };
    let ranges = vec![of(1, 35.0, 2200.0), of(2, 48.0, 2250.0), of(3, 70.0, 2100.0)];
    TensionExtremes {
        x: speed(),
        tension: Axis::linear("Span tension", "N"),
        panels: if one {
            vec![TensionRangePanel {
                heading: String::new(),
                ranges,
            }]
        } else {
            let names = [
                "span 1: crank – idler",
                "span 2: idler – alternator",
                "span 3: alternator – crank",
            ];
            let panels = names.into_iter().zip(ranges);
            panels
                .map(|(heading, range)| TensionRangePanel {
                    heading: heading.into(),
                    ranges: vec![range],
                })
                .collect()
        },
    }
}

fn clutches(count: usize) -> Comparison {
    let x = range(600.0, 6000.0, 400);
    let measures = [
        ("Alternator speed ripple, RMS", "rad/s", 1.0),
        ("Arm angle, RMS", "°", 0.25),
        ("Greatest tension", "N", 90.0),
        ("Greatest clutch torque", "N m", 6.0),
    ];
    let measure = |(label, unit, scale): (&str, &str, f64)| {
        let of = |name: &str, at: f64, width: f64, high: f64| {
            curve(name, &x, |x| {
                scale * (resonance(x, at, width) + high * (x / 6000.0))
            })
        };
        ComparedMeasure {
            heading: String::new(),
            y: Axis::linear(label, unit),
            curves: vec![
                of("rigid pulley", 2100.0, 0.12, 0.1),
                of("one-way clutch", 2000.0, 0.9, 0.6),
                of("decoupler", 950.0, 0.45, 0.2),
                of("isolator", 900.0, 0.3, 0.15),
            ],
        }
    };
    Comparison {
        x: speed(),
        measures: measures.into_iter().take(count).map(measure).collect(),
    }
}

pub fn critical(level: Axis) -> CriticalLevel {
    let x = range(600.0, 6000.0, 600);
    let of = |name: &str, ratio: f64| {
        curve(name, &x, |x| {
            ratio * (1.3 * resonance(x, 2100.0, 0.07) + 0.25 * resonance(x, 3900.0, 0.05) + 0.8)
        })
    };
    CriticalLevel {
        x: speed(),
        level,
        curves: vec![of("J_{a}/J_{p} = 4", 2.0), of("J_{a}/J_{p} = 8", 4.0)],
        resonances: vec![2100.0, 3900.0, 5300.0],
        actual: Some((5.0, "alternator at full load".into())),
    }
}

fn orders() -> Waterfall {
    let spectra = range(600.0, 6000.0, 46).into_iter().map(|speed| {
        let frequency: Vec<f64> = (0..=15).map(f64::from).collect();
        let amplitude = frequency
            .iter()
            .map(|order| match *order as i32 {
                0 => 0.05,
                order if order % 2 == 1 => {
                    let at = 5600.0 / f64::from(order);
                    0.9 / f64::from(order) * (0.12 + resonance(speed, at, 0.25))
                }
                order => 0.15 / f64::from(order) * resonance(speed, 6200.0 / f64::from(order), 0.3),
            })
            .collect();
        ResponseSpectrum {
            parameter: speed,
            frequency,
            amplitude,
        }
    });
    Waterfall {
        parameter: speed(),
        frequency: Axis::linear("Harmonic order", "–"),
        amplitude: Axis::linear("Amplitude of span 2", "mm"),
        spectra: spectra.collect(),
    }
}

pub fn certified() -> CertifiedResponse {
    let x = range(600.0, 6000.0, 300);
    let measure = |label: &str, unit: &str, scale: f64| CertifiedMeasure {
        y: Axis::linear(label, unit),
        curves: [1.0, 2.0, 4.0]
            .map(|q| {
                let Curve { name, x, mut y } = curve(format!("Q_{{m}} = {q} N m"), &x, |x| {
                    scale * (resonance(x, 2000.0 + 150.0 * q, 0.12 + 0.1 * q) + 0.2 * (x / 6000.0))
                });
                // No result where the run ended early.
                let lost = x.iter().position(|x| *x > 3300.0).unwrap();
                if q == 4.0 {
                    (0..6).for_each(|i| y[lost + i] = f64::NAN);
                }
                let unique = x.iter().map(|x| !(2600.0..4200.0).contains(x)).collect();
                CertifiedCurve { name, x, y, unique }
            })
            .to_vec(),
    };
    let warning = |name: &str, text: &str, intervals: &[[f64; 2]]| RangeWarning {
        name: name.into(),
        text: text.into(),
        intervals: intervals.to_vec(),
    };
    CertifiedResponse {
        x: speed(),
        measures: vec![
            measure("Arm angle, RMS", "°", 0.3),
            measure("Alternator speed ripple, RMS", "rad/s", 2.0 * PI),
        ],
        warnings: vec![
            warning(
                "slack span 3",
                "static plus dynamic tension is negative, the linear model does not hold there.",
                &[[1980.0, 2290.0]],
            ),
            warning(
                "gross slip",
                "predicted at the alternator, tension ratio above 9.6.",
                &[[2100.0, 2180.0], [5200.0, 5200.0]],
            ),
            warning(
                "event budget",
                "10000 events in a period at Q_{m} = 4 N m, no result.",
                &[[3310.0, 3410.0]],
            ),
        ],
    }
}
