//! The belt's path against direct trigonometry, and its rates against differences (theory 04 §1).

use crate::drives::{Case, close, config, running};
use glam::DVec2;
use proptest::prelude::*;
use slackside_belt_drive::drive::{Drive, Guide, Mount};
use slackside_belt_drive::layout::{Kinematics, Layout};
use std::f64::consts::TAU;

fn centre(drive: &Drive, j: usize, positions: &[f64]) -> DVec2 {
    match drive.pulleys[j].mount {
        Mount::Fixed(centre) => centre,
        Mount::Carried { tensioner, place } => match drive.tensioners[tensioner].guide {
            Guide::Rotary { pivot } => {
                let (sine, cosine) = positions[tensioner].sin_cos();
                pivot
                    + DVec2::new(
                        cosine * place.x - sine * place.y,
                        sine * place.x + cosine * place.y,
                    )
            }
            Guide::Linear { direction } => place + positions[tensioner] * direction,
        },
    }
}

/// Every span is straight, touches its circles at right angles to their radii, and turns them in their senses.
fn check_tangency(case: &Case, layout: &Layout, positions: &[f64]) {
    let drive = &case.drive;
    for (i, span) in layout.spans.iter().enumerate() {
        let along = span.end - span.start;
        close(
            along.length(),
            span.length,
            1e-12,
            0.0,
            "length between contact points",
        );
        for (j, contact) in [(i, span.start), (drive.next(i), span.end)] {
            let pulley = &drive.pulleys[j];
            let out = contact - centre(drive, j, positions);
            close(
                out.length(),
                pulley.radius,
                1e-12,
                0.0,
                "contact on the pitch circle",
            );
            assert!(out.dot(along).abs() < 1e-12, "span is tangent");
            // The belt moves along the rim: ω ẑ × out is along the span for a positive ω.
            assert!(
                pulley.sense.sign() * out.perp().dot(along) > 0.0,
                "belt turns the pulley in its sense"
            );
        }
    }
}

/// Wraps by the angle between contact points, counted in the sense of the pulley.
fn check_wraps(case: &Case, layout: &Layout) {
    let drive = &case.drive;
    for (j, pulley) in drive.pulleys.iter().enumerate() {
        let entry = layout.spans[drive.span_before(j)].end - layout.centres[j];
        let exit = layout.spans[j].start - layout.centres[j];
        let turn = pulley.sense.sign() * entry.angle_to(exit);
        close(
            (layout.wraps[j] - turn)
                .rem_euclid(TAU)
                .min((turn - layout.wraps[j]).rem_euclid(TAU)),
            0.0,
            1e-9,
            1.0,
            "wrap",
        );
    }
    close(layout.turning(drive).abs(), TAU, 1e-12, 0.0, "total turning");
}

proptest! {
    #![proptest_config(config(64))]

    #[test]
    fn path_is_tangent_and_closed(case in running()) {
        let steady = case.steady();
        check_tangency(&case, &steady.layout, &steady.positions);
        check_wraps(&case, &steady.layout);
        let free: f64 = steady.layout.spans.iter().map(|span| span.length).sum();
        let arcs: f64 = case.drive.pulleys.iter().zip(&steady.layout.wraps).map(|(p, w)| p.radius * w).sum();
        close(steady.layout.pitch_length, free + arcs, 1e-14, 0.0, "pitch length");
    }

    #[test]
    fn rates_are_differences(case in running(), shift in -0.02..0.02_f64) {
        let drive = &case.drive;
        let mut positions = drive.reference_positions();
        for (arm, tensioner) in drive.tensioners.iter().enumerate() {
            positions[arm] += match tensioner.guide {
                Guide::Rotary { .. } => shift,
                Guide::Linear { .. } => 0.1 * shift,
            };
        }
        let layout = Layout::new(drive, &positions).unwrap();
        prop_assume!(layout.check(drive).is_ok());
        let rates = Kinematics::new(drive, &layout, &positions);
        for arm in 0..drive.tensioners.len() {
            let step = 1e-4 * if matches!(drive.tensioners[arm].guide, Guide::Rotary { .. }) { 1.0 } else { 0.1 };
            let at = |k: f64| {
                let mut moved = positions.clone();
                moved[arm] += k * step;
                Layout::new(drive, &moved).unwrap()
            };
            let (minus2, minus1, plus1, plus2) = (at(-2.0), at(-1.0), at(1.0), at(2.0));
            let slope = |value: &dyn Fn(&Layout) -> f64| {
                (8.0 * (value(&plus1) - value(&minus1)) - (value(&plus2) - value(&minus2))) / (12.0 * step)
            };
            close(rates.take_up[arm], slope(&|l| l.pitch_length), 1e-8, 0.1, "take-up");
            for i in 0..drive.pulleys.len() {
                close(rates.spans[i][arm].length, slope(&|l| l.spans[i].length), 1e-8, 0.1, "span length");
                // Angles relative to the middle: no jump at ±π.
                let middle = layout.spans[i].direction;
                close(
                    rates.spans[i][arm].angle,
                    slope(&|l| middle.angle_to(l.spans[i].direction)),
                    1e-6, 1.0, "span angle",
                );
                close(rates.wrap_rates[i][arm], slope(&|l| l.wraps[i]), 1e-6, 1.0, "wrap");
                let velocity = DVec2::new(slope(&|l| l.centres[i].x), slope(&|l| l.centres[i].y));
                assert!((rates.centre_rates[i][arm] - velocity).length() < 1e-9);
                let second = (at(10.0).centres[i] - 2.0 * layout.centres[i] + at(-10.0).centres[i]) / (100.0 * step * step);
                assert!((rates.centre_curvatures[i][arm] - second).length() < 1e-6);
            }
        }
    }
}
