//! Matrices of one span in the motions of its ends across the span and its sine amplitudes (theory 04 §3.3).

use crate::span::SpanEquilibrium;
use slackside_linalg::Matrix;
use std::f64::consts::PI;

/// Matrices in `[b⁰, b^L, a_1 … a_N]`.
#[derive(Debug, Clone, PartialEq)]
pub struct SpanMatrices {
    /// `m ∫φ_a φ_b dx`.
    pub mass: Matrix,
    /// `m c ∫(φ_a φ_b' − φ_a' φ_b) dx`.
    pub gyroscopic: Matrix,
    /// `∫(T φ_a' φ_b' + EI φ_a'' φ_b'') dx`.
    pub stiffness: Matrix,
}

impl SpanMatrices {
    /// The matrices of a span with `terms` sines.
    pub(super) fn new(
        span: &SpanEquilibrium,
        length: f64,
        tension: f64,
        mass_per_length: f64,
        belt_speed: f64,
        terms: usize,
    ) -> Self {
        let size = 2 + terms;
        let (mut mass, mut stiffness) = (Matrix::zeros(size, size), Matrix::zeros(size, size));
        let whole = mass_per_length * length;
        for end in 0..2 {
            mass[(end, end)] = whole / 3.0;
            mass[(end, 1 - end)] = whole / 6.0;
            stiffness[(end, end)] = tension / length;
            stiffness[(end, 1 - end)] = -tension / length;
        }
        for n in 1..=terms {
            let (row, order) = (1 + n, n as f64);
            mass[(row, row)] = 0.5 * whole;
            stiffness[(row, row)] = span.term_stiffness(n);
            let with_start = whole / (order * PI);
            let with_end = -alternating(n) * with_start;
            mass[(row, 0)] = with_start;
            mass[(0, row)] = with_start;
            mass[(row, 1)] = with_end;
            mass[(1, row)] = with_end;
        }
        let gyroscopic = convection(terms).scaled(mass_per_length * belt_speed);
        Self {
            mass,
            gyroscopic,
            stiffness,
        }
    }
}

fn alternating(n: usize) -> f64 {
    if n.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// `∫(φ_a φ_b' − φ_a' φ_b) dx`: the gyroscopic matrix of unit momentum (theory 04 (3.8)).
pub(super) fn convection(terms: usize) -> Matrix {
    let mut matrix = Matrix::zeros(2 + terms, 2 + terms);
    matrix[(0, 1)] = 1.0;
    matrix[(1, 0)] = -1.0;
    for n in 1..=terms {
        let with_end = 2.0 * (1.0 - alternating(n)) / (n as f64 * PI);
        matrix[(1 + n, 1)] = with_end;
        matrix[(1, 1 + n)] = -with_end;
        matrix[(1 + n, 0)] = -with_end;
        matrix[(0, 1 + n)] = with_end;
        for k in (1..=terms).filter(|k| (n + k) % 2 == 1) {
            let (a, b) = (n as f64, k as f64);
            matrix[(1 + n, 1 + k)] = 4.0 * a * b / (a * a - b * b);
        }
    }
    matrix
}

/// `½ ∫(φ_a φ_b' − φ_a' φ_b) dx + ½ [φ_a φ_b]_0^L = ∫φ_a φ_b' dx`: drag on the material velocity (theory 04 (3.14)).
pub(super) fn drag(terms: usize) -> Matrix {
    let mut matrix = convection(terms).scaled(0.5);
    matrix[(0, 0)] -= 0.5;
    matrix[(1, 1)] += 0.5;
    matrix
}

/// `∫φ_a'' φ_b''' dx` per unit, and `∫φ_a'' φ_b'' dx`: internal bending damping (theory 04 (3.15)).
pub(super) fn internal_bending(terms: usize, length: f64) -> (Matrix, Matrix) {
    let size = 2 + terms;
    let (mut rate, mut circulatory) = (Matrix::zeros(size, size), Matrix::zeros(size, size));
    let squared = |n: usize| (n as f64 * PI / length).powi(2);
    for n in 1..=terms {
        rate[(1 + n, 1 + n)] = 0.5 * length * squared(n).powi(2);
        for k in (1..=terms).filter(|k| (n + k) % 2 == 1) {
            let (a, b) = (n as f64, k as f64);
            circulatory[(1 + n, 1 + k)] = squared(n) * squared(k) * 2.0 * a * b / (a * a - b * b);
        }
    }
    (rate, circulatory)
}
