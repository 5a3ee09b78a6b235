//! Equilibrium of one span with bending stiffness under tension, in closed form (theory 04 §2.2, §3.6).
//!
//! All hyperbolic ratios are written with decaying exponentials: `z = λL` is 10 to 300 in practice.

mod sag_functions;

use crate::drive::SpanEnds;
use sag_functions::{antisymmetric, symmetric};
use std::f64::consts::PI;

/// A span with given tension and end curvatures.
///
/// ```
/// use slackside_belt_drive::drive::SpanEnds;
/// use slackside_belt_drive::span::SpanEquilibrium;
/// let span = SpanEquilibrium::new(0.35, 300.0, 0.015, [20.0, -30.0], SpanEnds::Tangent);
/// // The static compliance of the curved shape is the sum over the sine terms (theory 04 (3.16)).
/// let sum: f64 = (1..4000).map(|n| span.coupling(n).powi(2) / span.term_stiffness(n)).sum();
/// assert!((span.sag_compliance() / sum - 1.0).abs() < 1e-8);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpanEquilibrium {
    length: f64,
    tension: f64,
    bending_stiffness: f64,
    curvatures: [f64; 2],
    ends: SpanEnds,
}

impl SpanEquilibrium {
    /// A span of this length (m), effective tension `T > 0` (N), bending stiffness (N·m²; zero for a string) and curvatures
    /// `κ = σ/r` (1/m) at its start and end.
    pub fn new(
        length: f64,
        tension: f64,
        bending_stiffness: f64,
        curvatures: [f64; 2],
        ends: SpanEnds,
    ) -> Self {
        Self {
            length,
            tension,
            bending_stiffness,
            curvatures,
            ends,
        }
    }

    /// `λ = √(T/EI)`, 1/m; infinite for a string.
    pub fn lambda(&self) -> f64 {
        (self.tension / self.bending_stiffness).sqrt()
    }

    /// `z = λL`.
    pub fn slenderness(&self) -> f64 {
        self.lambda() * self.length
    }

    fn is_string(&self) -> bool {
        self.bending_stiffness == 0.0
    }

    /// The share of the tangent-point value that remains with free contact points.
    fn share(&self, contact: f64) -> f64 {
        match self.ends {
            SpanEnds::Tangent => 1.0,
            SpanEnds::Contact => contact,
        }
    }

    /// Shear `Q`, constant along the span, N (theory 04 (2.4)).
    pub fn shear(&self) -> f64 {
        let [start, end] = self.curvatures;
        self.share(0.5) * self.bending_stiffness * (end - start) / self.length
    }

    /// Excess length `E = ½∫w'² dx` over the straight span, m (theory 04 (2.5); §8.1 for free contact points). It is minus
    /// the integral of the sag compliance over the tension.
    pub fn excess_length(&self) -> f64 {
        if self.is_string() {
            return 0.0;
        }
        let [start, end] = self.curvatures;
        if self.ends == SpanEnds::Contact {
            return (start * start + end * end) / (12.0 * self.lambda().powi(3));
        }
        let u = 0.5 * self.slenderness();
        -self.length.powi(3) / 32.0
            * ((start + end).powi(2) * symmetric(u).first + (start - end).powi(2) * antisymmetric(u).first)
    }

    /// `∂E/∂T` at fixed length, m/N; `−S` with the ends at the tangent points.
    pub fn excess_length_rate(&self) -> f64 {
        match self.ends {
            SpanEnds::Tangent => -self.sag_compliance(),
            SpanEnds::Contact => -1.5 * self.excess_length() / self.tension,
        }
    }

    /// `∫w''² dx` with the ends at the tangent points, 1/m (theory 04 (2.6)).
    pub fn curvature_integral(&self) -> f64 {
        if self.is_string() {
            return 0.0;
        }
        let [start, end] = self.curvatures;
        let u = 0.5 * self.slenderness();
        let (even, odd) = (symmetric(u).value, antisymmetric(u).value);
        // ∫cosh²/cosh² u and ∫sinh²/sinh² u over the span, in these parts.
        let even = 1.0 - (u * even).powi(2) + even;
        let odd = 1.0 - (u * odd).powi(2) - odd;
        0.125 * self.length * ((start + end).powi(2) * even + (start - end).powi(2) * odd)
    }

    /// Sag compliance `S`, the extra length per unit of tension from flattening the span, m/N (theory 04 (3.16)).
    pub fn sag_compliance(&self) -> f64 {
        if self.is_string() {
            return 0.0;
        }
        let [start, end] = self.curvatures;
        let u = 0.5 * self.slenderness();
        let tangent = self.length.powi(5) / (128.0 * self.bending_stiffness)
            * ((start + end).powi(2) * symmetric(u).second + (start - end).powi(2) * antisymmetric(u).second);
        self.share(1.0 / 3.0) * tangent
    }

    /// Coupling `h_n = ∫w' (sin β_n x)' dx` of the span's stretch to its `n`-th sine term, `n ≥ 1` (theory 04 (3.3)).
    pub fn coupling(&self, n: usize) -> f64 {
        if self.is_string() {
            return 0.0;
        }
        let [start, end] = self.curvatures;
        let beta = self.wave_number(n);
        let alternating = if n.is_multiple_of(2) { end } else { -end };
        let load = self.bending_stiffness * (start - alternating);
        -self.share(0.5) * beta * load / (self.tension + self.bending_stiffness * beta * beta)
    }

    /// `K_nn = ½L (Tβ_n² + EIβ_n⁴)`, N/m (theory 04 (3.8)).
    pub fn term_stiffness(&self, n: usize) -> f64 {
        let squared = self.wave_number(n).powi(2);
        0.5 * self.length * squared * (self.tension + self.bending_stiffness * squared)
    }

    /// `β_n = nπ/L`, 1/m.
    pub fn wave_number(&self, n: usize) -> f64 {
        n as f64 * PI / self.length
    }

    /// Displacement `w` to the left of the line between the tangent points at `x`, m (theory 04 (2.3)); always the shape
    /// that ends at the tangent points.
    pub fn deflection(&self, x: f64) -> f64 {
        if self.is_string() {
            return 0.0;
        }
        let inverse = self.bending_stiffness / self.tension;
        inverse * (self.curvature(x) - self.curvatures[0]) + self.ramp() * x
    }

    /// Slope `w'` at `x`.
    pub fn slope(&self, x: f64) -> f64 {
        if self.is_string() {
            return 0.0;
        }
        let [start, end] = self.curvatures;
        let (lambda, length) = (self.lambda(), self.length);
        let both = 1.0 - (-2.0 * lambda * length).exp();
        // cosh(λy)/sinh z for 0 ≤ y ≤ L.
        let ratio = |y: f64| (-lambda * (length - y)).exp() * (1.0 + (-2.0 * lambda * y).exp()) / both;
        (end * ratio(x) - start * ratio(length - x)) / lambda + self.ramp()
    }

    /// Curvature `w''` at `x`, 1/m.
    pub fn curvature(&self, x: f64) -> f64 {
        let [start, end] = self.curvatures;
        let (lambda, length) = (self.lambda(), self.length);
        let both = 1.0 - (-2.0 * lambda * length).exp();
        // sinh(λy)/sinh z for 0 ≤ y ≤ L.
        let ratio = |y: f64| (-lambda * (length - y)).exp() * (1.0 - (-2.0 * lambda * y).exp()) / both;
        start * ratio(length - x) + end * ratio(x)
    }

    /// `B = (κ_0 − κ_L)/(λ²L)`.
    fn ramp(&self) -> f64 {
        let [start, end] = self.curvatures;
        (start - end) * self.bending_stiffness / (self.tension * self.length)
    }
}
