//! What is read from a harmonic motion of the linear model: tensions, deflections, hub loads (theory 04 §3.8).

use super::LinearModel;
use crate::drive::Drive;
use crate::steady::SteadyState;
use slackside_linalg::Complex;
use std::f64::consts::PI;

/// A harmonic motion `q(t) = Re(q̂ e^{iωt})` of all coordinates; results are complex amplitudes of the same kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Angular frequency `ω`, rad/s.
    pub frequency: f64,
    /// Amplitudes `q̂` of all coordinates.
    pub amplitudes: Vec<Complex>,
}

/// Transverse motion of one span.
#[derive(Debug, Clone, PartialEq)]
pub struct SpanMotion {
    /// Amplitudes of `[b⁰, b^L, a_1 …]`, m.
    pub local: Vec<Complex>,
    length: f64,
}

impl SpanMotion {
    /// Amplitude of the displacement along the left normal at `x`, m.
    pub fn at(&self, x: f64) -> Complex {
        let share = x / self.length;
        let sines: Complex = self.local[2..]
            .iter()
            .enumerate()
            .map(|(n, amplitude)| amplitude * ((n + 1) as f64 * PI * share).sin())
            .sum();
        self.local[0] * (1.0 - share) + self.local[1] * share + sines
    }

    /// Root over the span of the mean square amplitude, `√((1/L)∫|ŵ|² dx)`, m. Divide by √2 for the RMS in time.
    pub fn mean_amplitude(&self) -> f64 {
        let (start, end) = (self.local[0], self.local[1]);
        let ramp = (start.norm_sqr() + (start * end.conj()).re + end.norm_sqr()) / 3.0;
        let sines: f64 = self.local[2..]
            .iter()
            .enumerate()
            .map(|(n, amplitude)| {
                let order = (n + 1) as f64;
                let alternating = if n % 2 == 0 { -1.0 } else { 1.0 };
                0.5 * amplitude.norm_sqr()
                    + 2.0 * (amplitude * (start - alternating * end).conj()).re / (order * PI)
            })
            .sum();
        (ramp + sines).max(0.0).sqrt()
    }
}

impl LinearModel {
    /// Amplitude of the dynamic tension of a span, `p̂ = (k_i + iωc_i) D_i q̂`, N.
    pub fn dynamic_tension(&self, motion: &Motion, span: usize) -> Complex {
        let stretch: Complex = self
            .stretch
            .row(span)
            .iter()
            .zip(&motion.amplitudes)
            .map(|(row, amplitude)| amplitude * *row)
            .sum();
        Complex::new(
            self.span_stiffness[span],
            motion.frequency * self.span_dashpots[span],
        ) * stretch
    }

    /// Transverse motion of a span.
    pub fn span_motion(&self, steady: &SteadyState, motion: &Motion, span: usize) -> SpanMotion {
        let local = self.local[span]
            .iter()
            .map(|terms| {
                terms
                    .iter()
                    .map(|(index, factor)| motion.amplitudes[*index] * *factor)
                    .sum()
            })
            .collect();
        SpanMotion {
            local,
            length: steady.layout.spans[span].length,
        }
    }

    /// Amplitudes of the forces of a span on the bodies at its start and end along the left normal, N. They are the rows of
    /// the span's own matrices, which converge much faster than derivatives of the sine series.
    pub fn end_forces(&self, steady: &SteadyState, motion: &Motion, span: usize) -> [Complex; 2] {
        let local = self.span_motion(steady, motion, span).local;
        let frequency = motion.frequency;
        let matrices = &self.spans[span];
        let row = |row: usize| -> Complex {
            local
                .iter()
                .enumerate()
                .map(|(column, amplitude)| {
                    let dynamic = Complex::new(
                        matrices.stiffness[(row, column)]
                            - frequency * frequency * matrices.mass[(row, column)],
                        frequency * matrices.gyroscopic[(row, column)],
                    );
                    dynamic * amplitude
                })
                .sum()
        };
        [-row(0), -row(1)]
    }

    /// Amplitude `[x, y]` of the dynamic force of the belt on a pulley, N.
    pub fn dynamic_hub_load(
        &self,
        drive: &Drive,
        steady: &SteadyState,
        motion: &Motion,
        pulley: usize,
    ) -> [Complex; 2] {
        let before = drive.span_before(pulley);
        let (incoming, outgoing) = (&steady.layout.spans[before], &steady.layout.spans[pulley]);
        let pull = self.dynamic_tension(motion, pulley);
        let drag = self.dynamic_tension(motion, before);
        let at_start = self.end_forces(steady, motion, pulley)[0];
        let at_end = self.end_forces(steady, motion, before)[1];
        let component =
            |e: (f64, f64), n: (f64, f64)| pull * e.0 - drag * e.1 + at_start * n.0 + at_end * n.1;
        [
            component(
                (outgoing.direction.x, incoming.direction.x),
                (outgoing.normal.x, incoming.normal.x),
            ),
            component(
                (outgoing.direction.y, incoming.direction.y),
                (outgoing.normal.y, incoming.normal.y),
            ),
        ]
    }
}
