//! The monodromy matrix of the periodic tangent by the Magnus series of order four.
//!
//! With `A₁, A₂` at the two Gauss points of a step `h`: `exp(h (A₁ + A₂)/2 + √3 h²/12 (A₂A₁ − A₁A₂))`. Every step is
//! compared with two of half its length and split where they differ; steps also end at switchings, where the tangent jumps.

use super::super::{HarmonicBalanceError, HarmonicOrbit};
use super::StateMatrices;
use num_complex::Complex;
use slackside_linalg::{LinalgError, Matrix, exponential};
use slackside_numerics::fourier::value;
use std::f64::consts::TAU;

/// Largest difference of a step and its halves, relative to their size.
const TOLERANCE: f64 = 1e-11;
/// Number of halvings after which a step is taken as it is (an unlisted kink of the law).
const DEPTH: usize = 24;

/// The monodromy matrix and an estimate of its error (largest entry).
pub fn monodromy(orbit: &HarmonicOrbit) -> Result<(Matrix, f64), HarmonicBalanceError> {
    let rates = (0..orbit.displacements.len())
        .map(|e| orbit.port_rate(e))
        .collect();
    let tangent = Tangent {
        orbit,
        rates,
        matrices: StateMatrices::new(&orbit.system, orbit.frequency)?,
    };
    // Short enough for narrow transitions of a smoothed law to be seen: they span several of its samples.
    let panels = (orbit.samples / 16).max(orbit.harmonics).max(32);
    let mut result = Matrix::identity(2 * orbit.system.order());
    let mut error = 0.0;
    for (a, b) in orbit.panels(TAU / panels as f64) {
        let whole = tangent.step(a, b)?;
        let (factor, part) = tangent.refine(a, b, whole, DEPTH)?;
        result = factor.product(&result);
        error += part;
    }
    let size = result.max_abs().max(1.0);
    Ok((result, error * size))
}

struct Tangent<'a> {
    orbit: &'a HarmonicOrbit,
    rates: Vec<Vec<Complex<f64>>>,
    matrices: StateMatrices<'a>,
}

impl Tangent<'_> {
    fn at(&self, angle: f64) -> Matrix {
        let elements = self.orbit.system.elements.iter().enumerate();
        let tangents = elements.map(|(e, element)| {
            let (u, v) = (
                value(&self.orbit.displacements[e], angle),
                value(&self.rates[e], angle),
            );
            let response = element.law.response(u, v);
            (response.by_displacement, response.by_velocity)
        });
        self.matrices.with_tangents(tangents)
    }

    fn step(&self, from: f64, to: f64) -> Result<Matrix, LinalgError> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let offset = half / 3.0_f64.sqrt();
        let (first, second) = (self.at(middle - offset), self.at(middle + offset));
        let h = (to - from) / self.orbit.omega();
        let mut exponent = first.scaled(0.5 * h);
        exponent.add_scaled(0.5 * h, &second);
        let weight = 3.0_f64.sqrt() * h * h / 12.0;
        exponent.add_scaled(weight, &second.product(&first));
        exponent.add_scaled(-weight, &first.product(&second));
        exponential(&exponent)
    }

    /// The transition matrix over a step and the error left, by halving until the halves agree with the whole.
    fn refine(&self, from: f64, to: f64, whole: Matrix, depth: usize) -> Result<(Matrix, f64), LinalgError> {
        let middle = 0.5 * (from + to);
        let (left, right) = (self.step(from, middle)?, self.step(middle, to)?);
        let halves = right.product(&left);
        let mut difference = whole;
        difference.add_scaled(-1.0, &halves);
        let size = difference.max_abs() / halves.max_abs().max(1.0);
        if size <= TOLERANCE || depth == 0 {
            // Two halves of a method of order four err by 1/15 of the difference.
            return Ok((halves, size / 15.0));
        }
        let (left, left_error) = self.refine(from, middle, left, depth - 1)?;
        let (right, right_error) = self.refine(middle, to, right, depth - 1)?;
        Ok((right.product(&left), left_error + right_error))
    }
}
