//! Closed forms of one span against quadrature and series (theory 04 §2.2, §3.6).

use crate::drives::{close, config};
use proptest::prelude::*;
use slackside_belt_drive::drive::SpanEnds;
use slackside_belt_drive::span::SpanEquilibrium;

const LENGTH: f64 = 0.4;
const TENSION: f64 = 350.0;

/// A span of given `z` with end curvatures of both signs.
fn span(z: f64, curvatures: [f64; 2]) -> SpanEquilibrium {
    let bending = TENSION * (LENGTH / z).powi(2);
    SpanEquilibrium::new(LENGTH, TENSION, bending, curvatures, SpanEnds::Tangent)
}

/// Composite Gauss quadrature that resolves the boundary layers.
pub(crate) fn integral(length: f64, cells: usize, f: impl Fn(f64) -> f64) -> f64 {
    let rule = slackside_numerics::quadrature::gauss_legendre();
    let cell = length / cells as f64;
    (0..cells)
        .flat_map(|k| {
            rule.nodes
                .iter()
                .zip(&rule.weights)
                .map(move |(x, w)| (cell * (k as f64 + x), w))
        })
        .map(|(x, w)| w * cell * f(x))
        .sum()
}

proptest! {
    #![proptest_config(config(96))]

    #[test]
    fn shape_satisfies_its_equation(exponent in 0.0..1.0_f64, start in -40.0..40.0_f64, end in -40.0..40.0_f64) {
        let z = 300_f64.powf(exponent);
        let span = span(z, [start, end]);
        let bending = TENSION * (LENGTH / z).powi(2);
        close(span.slenderness(), z, 1e-12, 0.0, "z");
        let size = start.abs().max(end.abs());
        close(span.curvature(0.0), start, 1e-12, 0.0, "curvature at the start");
        close(span.curvature(LENGTH), end, 1e-12, 0.0, "curvature at the end");
        let height = size * (LENGTH / z).powi(2);
        assert!(span.deflection(0.0).abs() < 1e-12 * height && span.deflection(LENGTH).abs() < 1e-12 * height);
        let step = 1e-3 * LENGTH / z.max(3.0);
        for share in [0.02, 0.3, 0.5, 0.77, 0.98] {
            let x = share * LENGTH;
            let slope = |f: &dyn Fn(f64) -> f64| {
                (8.0 * (f(x + step) - f(x - step)) - (f(x + 2.0 * step) - f(x - 2.0 * step))) / (12.0 * step)
            };
            close(span.slope(x), slope(&|x| span.deflection(x)), 1e-9, size * LENGTH / z, "slope");
            close(span.curvature(x), slope(&|x| span.slope(x)), 1e-9, size, "curvature");
            // Q = EI w''' − T w' is the same everywhere.
            let shear = bending * slope(&|x| span.curvature(x)) - TENSION * span.slope(x);
            close(span.shear(), shear, 1e-8, bending * size * z / LENGTH, "shear");
        }
    }

    #[test]
    fn integrals_are_quadratures(exponent in 0.0..1.0_f64, start in -40.0..40.0_f64, end in -40.0..40.0_f64) {
        let z = 300_f64.powf(exponent);
        let span = span(z, [start, end]);
        let cells = 20 + z as usize;
        let scale = (start * start + end * end) * (LENGTH / z).powi(3);
        close(
            span.excess_length(),
            0.5 * integral(LENGTH, cells, |x| span.slope(x).powi(2)),
            1e-11, 1e-3 * scale, "excess length",
        );
        close(
            span.curvature_integral(),
            integral(LENGTH, cells, |x| span.curvature(x).powi(2)),
            1e-12, 0.0, "curvature integral",
        );
        for n in [1, 2, 3, 7, 12] {
            let beta = span.wave_number(n);
            close(
                span.coupling(n),
                integral(LENGTH, cells + n, |x| span.slope(x) * beta * (beta * x).cos()),
                1e-10, 1e-3 * start.abs().max(end.abs()) * LENGTH / z, "coupling",
            );
        }
    }

    #[test]
    fn sag_compliance_is_the_series_and_the_slope_of_the_excess_length(
        exponent in -0.2..1.0_f64, start in -40.0..40.0_f64, end in -40.0..40.0_f64,
    ) {
        let z = 300_f64.powf(exponent);
        let span = span(z, [start, end]);
        let series: f64 = (1..4000).map(|n| span.coupling(n).powi(2) / span.term_stiffness(n)).sum();
        // What is left out of the series falls as the fifth power of z over the number of terms.
        close(span.sag_compliance(), series, 1e-9, 0.0, "sag compliance");
        let bending = TENSION * (LENGTH / z).powi(2);
        for ends in [SpanEnds::Tangent, SpanEnds::Contact] {
            let at = |tension: f64| SpanEquilibrium::new(LENGTH, tension, bending, [start, end], ends);
            let step = 1e-3 * TENSION;
            let excess = |k: f64| at(TENSION + k * step).excess_length();
            let slope = (8.0 * (excess(1.0) - excess(-1.0)) - (excess(2.0) - excess(-2.0))) / (12.0 * step);
            close(at(TENSION).excess_length_rate(), slope, 1e-7, 0.0, "rate of the excess length");
        }
    }
}

/// Towards zero tension the span becomes a beam with end moments: a polynomial, whose integrals are rational.
#[test]
fn a_span_without_tension_is_a_beam_with_end_moments() {
    let (bending, [start, end]) = (0.02, [30.0, -11.0]);
    for tension in [1e-2, 1e-5, 1e-8, 1e-14] {
        let span = SpanEquilibrium::new(LENGTH, tension, bending, [start, end], SpanEnds::Tangent);
        let correction = 10.0 * span.slenderness().powi(2) + 1e-12;
        // w' = ∫κ, κ linear, w(0) = w(L) = 0.
        let excess = LENGTH.powi(3) * (start * start + end * end + 1.75 * start * end) / 90.0;
        close(span.excess_length(), excess, correction, 0.0, "excess length");
        let squares = LENGTH * (start * start + start * end + end * end) / 3.0;
        close(
            span.curvature_integral(),
            squares,
            correction,
            0.0,
            "curvature integral",
        );
        let series: f64 = (1..2000)
            .map(|n| span.coupling(n).powi(2) / span.term_stiffness(n))
            .sum();
        close(span.sag_compliance(), series, 1e-10, 0.0, "sag compliance");
    }
}
