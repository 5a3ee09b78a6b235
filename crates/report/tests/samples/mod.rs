//! Synthetic data of the shapes that studies produce, one figure for each kind.

pub mod drive;
pub mod nonsmooth;

use std::f64::consts::TAU;

use slackside_report::figures::*;
use slackside_report::plot::{Axis, Figure, Width};

/// All kinds of figures with a name, at one width.
pub fn all(width: Width) -> Vec<(&'static str, Figure)> {
    let options = FigureOptions {
        width,
        ..FigureOptions::default()
    };
    let mut figures = vec![
        ("response", response(&duffing_response(), &options)),
        (
            "response-zoom",
            response(
                &Response {
                    zoom: Some(Zoom {
                        x: [1.25, 1.6],
                        y: None,
                    }),
                    ..duffing_response()
                },
                &options,
            ),
        ),
        ("response-family", response(&response_family(), &options)),
        ("curve-family", curve_family(&natural_frequencies(), &options)),
        ("time-history", time_history(&clutch_history(), &options)),
        (
            "spectrum-stems",
            spectrum(&harmonics(Axis::linear("Amplitude of δθ", "rad")), &options),
        ),
        (
            "spectrum-stems-log",
            spectrum(&harmonics(Axis::logarithmic("Amplitude of δθ", "rad")), &options),
        ),
        ("spectrum-curve", spectrum(&dense_spectrum(), &options)),
        ("waterfall-lines", waterfall_lines(&run_up(), &options)),
        ("waterfall-map", waterfall_map(&run_up(), &options)),
        (
            "waterfall-map-log",
            waterfall_map(
                &Waterfall {
                    amplitude: Axis::logarithmic("Amplitude of δθ", "rad"),
                    ..run_up()
                },
                &options,
            ),
        ),
        ("phase-portrait", phase_portrait(&orbits(), &options)),
        ("poincare-map", poincare_map(&section(), &options)),
        ("poincare-parameter", poincare_map(&cascade(), &options)),
        ("engagement-strip-few", engagement_strip(&engagement(7), &options)),
        (
            "engagement-strip-many",
            engagement_strip(&engagement(160), &options),
        ),
        ("basin", basin(&basins(), &options)),
    ];
    figures.extend(drive::all(width));
    figures.extend(nonsmooth::all(width));
    figures
}

fn frequency() -> Axis {
    Axis::linear("Excitation frequency Ω", "–")
}

/// A hardening resonance, its backbone through amplitudes a: Ω² = 1 + c a² ± sqrt((f/a)² − (2ζΩ)²) roughly.
fn hardening(hardness: f64, name: Option<&str>) -> Branch {
    let (force, damping) = (0.15, 0.035);
    let mut branch = Branch {
        name: name.map(str::to_string),
        ..Branch::default()
    };
    let largest = force / (2.0 * damping);
    let n = 1500;
    for step in 0..=2 * n {
        // Up the left side, down the right side.
        let rising = step <= n;
        let s = if rising {
            f64::from(step)
        } else {
            f64::from(2 * n - step)
        } / f64::from(n);
        let low = if rising { 0.157 } else { 0.05 };
        let a = low + (largest - low) * (s * TAU / 4.0).sin();
        let width = ((force / a).powi(2) - (2.0 * damping).powi(2)).max(0.0).sqrt();
        let squared = 1.0 + hardness * a * a + if rising { -width } else { width };
        if squared > 0.02 {
            branch.x.push(squared.sqrt());
            branch.y.push(a / 2f64.sqrt());
        }
    }
    // Between the folds the parameter runs backwards.
    for i in 0..branch.x.len() {
        let next = (i + 1).min(branch.x.len() - 1);
        let forward = branch.x[next] >= branch.x[next - 1];
        branch.stable.push(forward);
    }
    for i in 1..branch.x.len() {
        if branch.stable[i] != branch.stable[i - 1] {
            let (x, y) = (
                (branch.x[i] + branch.x[i - 1]) / 2.0,
                (branch.y[i] + branch.y[i - 1]) / 2.0,
            );
            branch.special.push(SpecialPoint {
                x,
                y,
                kind: SpecialKind::Fold,
                after: Some(i - 1),
            });
        }
    }
    branch
}

fn duffing_response() -> Response {
    let mut main = hardening(0.25, None);
    let at = |branch: &Branch, i: usize, kind| SpecialPoint {
        x: branch.x[i],
        y: branch.y[i],
        kind,
        after: None,
    };
    let last = main.x.len() - 1;
    for (i, kind) in [
        (300, SpecialKind::Grazing),
        (500, SpecialKind::Grazing),
        (700, SpecialKind::PeriodDoubling),
        (1000, SpecialKind::PeriodDoubling),
        (850, SpecialKind::NeimarkSacker),
        (last - 150, SpecialKind::NeutralSaddle),
        (600, SpecialKind::BranchPoint),
    ] {
        main.special.push(at(&main, i, kind));
    }
    (700..1000).for_each(|i| main.stable[i] = false);
    let mut doubled = Branch::default();
    for i in (700..=1000).step_by(3) {
        let s = f64::from(i - 700) / 300.0;
        doubled.x.push(main.x[i as usize]);
        doubled.y.push(main.y[i as usize] - 0.25 * (s * TAU / 2.0).sin());
        doubled.stable.push(!(0.4..0.7).contains(&s));
    }
    let stable: Vec<[f64; 2]> = main
        .x
        .iter()
        .zip(&main.y)
        .zip(&main.stable)
        .filter(|(_, s)| **s)
        .map(|((x, y), _)| [*x, *y])
        .collect();
    let peak = main.y.iter().copied().fold(0.0, f64::max);
    let top = stable.iter().position(|p| p[1] > 0.98 * peak).unwrap_or(0);
    Response {
        x: frequency(),
        y: Axis::linear("RMS of wind-up δθ", "rad"),
        sweep_up: stable[..top].iter().step_by(45).copied().collect(),
        sweep_down: stable[top..].iter().rev().step_by(45).copied().collect(),
        branches: vec![main, doubled],
        zoom: None,
    }
}

fn response_family() -> Response {
    let branches = [0.0, 0.12, 0.25, 0.4]
        .iter()
        .map(|hardness| hardening(*hardness, Some(&format!("K_{{d}} = {}", 10.0 + 100.0 * hardness))))
        .collect();
    Response {
        x: frequency(),
        y: Axis::linear("RMS of wind-up δθ", "rad"),
        branches,
        ..Response::default()
    }
}

fn natural_frequencies() -> CurveFamily {
    let x: Vec<f64> = (0..=200).map(|i| 0.2 * f64::from(i)).collect();
    let curve = |name: &str, f: &dyn Fn(f64) -> f64| Curve {
        name: name.to_string(),
        x: x.clone(),
        y: x.iter().map(|x| f(*x)).collect(),
    };
    let root = |k: f64, sign: f64| {
        let (a, b) = (20.0 + k * 1.5, 10.0 * k);
        ((a + sign * (a * a - 4.0 * b).max(0.0).sqrt()) / 2.0).sqrt()
    };
    CurveFamily {
        x: Axis::linear("Clutch stiffness K_{d}", "–"),
        y: Axis::linear("Natural frequency ω", "–"),
        curves: vec![
            curve("engaged, first", &|k| root(k, -1.0)),
            curve("engaged, second", &|k| root(k, 1.0)),
            curve("disengaged", &|_| 20f64.sqrt()),
        ],
    }
}

fn clutch_history() -> TimeHistory {
    let t: Vec<f64> = (0..=6000).map(|i| 0.005 * f64::from(i)).collect();
    let windup: Vec<f64> = t
        .iter()
        .map(|t| 0.05 + 0.11 * (1.3 * t).sin() + 0.03 * (5.2 * t + 0.4).sin())
        .collect();
    let mut disengaged = Vec::new();
    let mut start = None;
    for (t, w) in t.iter().zip(&windup) {
        match (start, *w < 0.0) {
            (None, true) => start = Some(*t),
            (Some(from), false) => {
                disengaged.push([from, *t]);
                start = None;
            }
            _ => {}
        }
    }
    let torque = windup.iter().map(|w| 10.0 * w.max(0.0)).collect();
    let unnamed = |y: Vec<f64>| {
        vec![Curve {
            name: String::new(),
            x: t.clone(),
            y,
        }]
    };
    TimeHistory {
        time: Axis::linear("Time", "s"),
        panels: vec![
            TimePanel {
                y: Axis::linear("Wind-up δθ", "rad"),
                curves: unnamed(windup.clone()),
            },
            TimePanel {
                y: Axis::linear("Rotation", "rad"),
                curves: vec![
                    Curve {
                        name: "pulley".into(),
                        x: t.clone(),
                        y: t.iter().map(|t| 0.1 * (1.3 * t).sin()).collect(),
                    },
                    Curve {
                        name: "accessory".into(),
                        x: t.clone(),
                        y: t.iter().map(|t| 0.06 * (1.3 * t + 0.9).sin()).collect(),
                    },
                ],
            },
            TimePanel {
                y: Axis::linear("Clutch torque", "N m"),
                curves: unnamed(torque),
            },
        ],
        disengaged,
    }
}

fn harmonics(amplitude: Axis) -> Spectrum {
    let curve = |name: &str, scale: f64, decay: f64| Curve {
        name: name.to_string(),
        x: (1..=20).map(f64::from).collect(),
        y: (1..=20)
            .map(|k| scale * (-decay * f64::from(k)).exp() * (1.2 + (2.1 * f64::from(k)).sin()))
            .collect(),
    };
    Spectrum {
        frequency: Axis::linear("Harmonic order", "–"),
        amplitude,
        spectra: vec![curve("Ω = 5.5", 0.2, 0.35)],
        style: SpectrumStyle::Stems,
    }
}

fn spectrum_at(parameter: f64) -> (Vec<f64>, Vec<f64>) {
    let frequency: Vec<f64> = (0..400).map(|i| 0.03 * f64::from(i)).collect();
    let amplitude = frequency
        .iter()
        .map(|f| {
            let peak = |at: f64, a: f64, w: f64| a / (1.0 + ((f - at) / w).powi(2));
            let resonance = 0.2 / (1.0 + ((parameter - 3.2) / 0.5).powi(2));
            let sub = if (4.4..5.6).contains(&parameter) {
                peak(parameter / 2.0, 0.12, 0.03) + peak(1.5 * parameter, 0.05, 0.03)
            } else {
                0.0
            };
            peak(parameter, 0.04 + resonance, 0.03)
                + peak(2.0 * parameter, 0.3 * resonance + 0.004, 0.03)
                + sub
                + 2e-5
        })
        .collect();
    (frequency, amplitude)
}

fn dense_spectrum() -> Spectrum {
    let curve = |parameter: f64| {
        let (x, y) = spectrum_at(parameter);
        Curve {
            name: format!("Ω = {parameter}"),
            x,
            y,
        }
    };
    Spectrum {
        frequency: Axis::linear("Response frequency", "–"),
        amplitude: Axis::logarithmic("Amplitude of δθ", "rad"),
        spectra: vec![curve(3.2), curve(5.0)],
        style: SpectrumStyle::Curve,
    }
}

fn run_up() -> Waterfall {
    let spectra = (0..60)
        .map(|i| {
            let parameter = 1.0 + 0.1 * f64::from(i);
            let (frequency, amplitude) = spectrum_at(parameter);
            ResponseSpectrum {
                parameter,
                frequency,
                amplitude,
            }
        })
        .collect();
    Waterfall {
        parameter: frequency(),
        frequency: Axis::linear("Response frequency", "–"),
        amplitude: Axis::linear("Amplitude of δθ", "rad"),
        spectra,
    }
}

fn orbits() -> PhasePortrait {
    let phase: Vec<f64> = (0..=1000).map(|i| TAU * f64::from(i) / 1000.0).collect();
    let orbit = |name: &str, a: f64, b: f64, sub: f64| Curve {
        name: name.to_string(),
        x: phase
            .iter()
            .map(|p| a * (2.0 * p).cos() + b * (4.0 * p + 1.0).cos() + sub * p.cos())
            .collect(),
        y: phase
            .iter()
            .map(|p| -a * (2.0 * p).sin() - 2.0 * b * (4.0 * p + 1.0).sin() - 0.5 * sub * p.sin())
            .collect(),
    };
    let orbits = vec![
        orbit("period 1", 0.1, 0.01, 0.0),
        orbit("period 2", 0.16, 0.02, 0.05),
    ];
    let point = |orbit: &Curve, i: usize| [orbit.x[i], orbit.y[i]];
    PhasePortrait {
        x: Axis::linear("Wind-up δθ", "rad"),
        y: Axis::linear("Relative velocity δθ′", "rad"),
        poincare: vec![PointSet {
            name: "Poincaré points".into(),
            points: vec![point(&orbits[0], 0), point(&orbits[1], 0), point(&orbits[1], 500)],
        }],
        orbits,
    }
}

/// Points of the Hénon map, and a circle.
fn section() -> PoincareMap {
    let mut points = Vec::new();
    let (mut x, mut y) = (0.1, 0.1);
    for i in 0..4000 {
        (x, y) = (1.0 - 1.4 * x * x + y, 0.3 * x);
        if i > 50 {
            points.push([x, y]);
        }
    }
    let torus = (0..120)
        .map(|i| f64::from(i) * 2.4)
        .map(|a| [0.25 * a.cos(), 0.08 * a.sin()])
        .collect();
    PoincareMap {
        x: Axis::linear("Wind-up δθ", "rad"),
        y: Axis::linear("Relative velocity δθ′", "rad"),
        sets: vec![
            PointSet {
                name: "chaotic".into(),
                points,
            },
            PointSet {
                name: "quasi-periodic".into(),
                points: torus,
            },
        ],
    }
}

/// Period doubling of the logistic map over its parameter.
fn cascade() -> PoincareMap {
    let mut points = Vec::new();
    for i in 0..400 {
        let r = 2.8 + 1.2 * f64::from(i) / 400.0;
        let mut x = 0.4;
        for n in 0..400 {
            x *= r * (1.0 - x);
            if n > 340 {
                points.push([r, x]);
            }
        }
    }
    PoincareMap {
        x: frequency(),
        y: Axis::linear("Wind-up δθ at phase 0", "rad"),
        sets: vec![PointSet {
            name: String::new(),
            points,
        }],
    }
}

fn engagement(count: usize) -> EngagementStrip {
    let rows = (0..count)
        .map(|i| {
            let value = 2.0 + 5.0 * i as f64 / count as f64;
            let start = 0.35 + 0.3 * (value - 2.0).sin();
            EngagementRow {
                value,
                engaged: vec![[start, start + 0.5 + 0.2 * (1.7 * value).cos()]],
            }
        })
        .collect();
    EngagementStrip {
        phase: Axis::linear("Phase within the period", "–"),
        row: frequency(),
        rows,
    }
}

fn basins() -> Basin {
    let columns = 120;
    let cells = (0..columns * columns)
        .map(|k| {
            let (x, y) = (
                (k % columns) as f64 / 60.0 - 1.0,
                (k / columns) as f64 / 60.0 - 1.0,
            );
            let (r, angle) = (x.hypot(y), y.atan2(x));
            let spiral = (angle * 3.0 + 9.0 * r).sin();
            if r > 1.25 {
                None
            } else if spiral > 0.4 {
                Some(0)
            } else if spiral > -0.5 {
                Some(1)
            } else {
                Some(2)
            }
        })
        .collect();
    Basin {
        x: Axis::linear("Initial wind-up δθ_{0}", "rad"),
        y: Axis::linear("Initial relative velocity δθ′_{0}", "rad"),
        x_centres: [-1.0, 1.0],
        y_centres: [-1.0, 1.0],
        columns,
        cells,
        attractors: vec![
            "period 1, small".into(),
            "period 1, large".into(),
            "period 2".into(),
        ],
        points: vec![[0.1, 0.05], [-0.4, 0.3], [0.5, -0.4], [0.45, -0.6]],
    }
}
