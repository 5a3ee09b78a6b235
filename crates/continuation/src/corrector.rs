//! Prediction along the tangent and correction by Newton's method (theory 02 §6).

use crate::options::Options;
use crate::point::Point;
use crate::{Evaluation, Family, FamilyError};
use slackside_linalg::{Lu, Matrix, dot, norm};

/// Scales of unknowns and parameter: arclength is measured in scaled variables.
pub(crate) struct Scales {
    unknowns: Vec<f64>,
    parameter: f64,
}

impl Scales {
    pub fn of(family: &dyn Family) -> Self {
        Self {
            unknowns: family.unknown_scales(),
            parameter: family.parameter_scale(),
        }
    }

    /// The point at scaled distance `s` from `from` along `tangent`.
    pub fn predict(&self, from: &Point, tangent: &[f64], s: f64) -> (Vec<f64>, f64) {
        let n = self.unknowns.len();
        let z = (0..n)
            .map(|i| from.z[i] + s * tangent[i] * self.unknowns[i])
            .collect();
        (z, from.p + s * tangent[n] * self.parameter)
    }

    /// The scaled difference `to − from`.
    pub fn difference(&self, from: &Point, z: &[f64], p: f64) -> Vec<f64> {
        let mut d: Vec<f64> = (0..z.len())
            .map(|i| (z[i] - from.z[i]) / self.unknowns[i])
            .collect();
        d.push((p - from.p) / self.parameter);
        d
    }
}

/// Newton's method for `F = 0` in the hyperplane at scaled distance `s` from `from` along `tangent`.
pub(crate) fn correct(
    family: &mut dyn Family,
    scales: &Scales,
    from: &Point,
    tangent: &[f64],
    s: f64,
    options: &Options,
) -> Result<Point, FamilyError> {
    let n = family.dimension();
    let (mut z, mut p) = scales.predict(from, tangent, s);
    let mut evaluation = Evaluation::new(n);
    let mut right = vec![0.0; n + 1];
    let mut previous = f64::INFINITY;
    for iteration in 0..=options.max_iterations {
        family.evaluate(&z, p, &mut evaluation)?;
        let bordered = bordered(&evaluation, scales, tangent);
        let lu = Lu::new(&bordered).map_err(|error| FamilyError(error.to_string()))?;
        for i in 0..n {
            right[i] = -evaluation.residual[i] / scales.unknowns[i];
        }
        right[n] = s - dot(&scales.difference(from, &z, p), tangent);
        lu.solve_in_place(&mut right);
        let size = norm(&right);
        let done = size <= options.tolerance || (size <= options.loose_tolerance && size > 0.5 * previous);
        if !size.is_finite() || (iteration > 0 && size > options.divergence * previous.max(options.tolerance))
        {
            break;
        }
        for i in 0..n {
            z[i] += right[i] * scales.unknowns[i];
        }
        p += right[n] * scales.parameter;
        if done {
            let mut new_tangent = vec![0.0; n + 1];
            new_tangent[n] = 1.0;
            lu.solve_in_place(&mut new_tangent);
            let length = norm(&new_tangent);
            new_tangent.iter_mut().for_each(|value| *value /= length);
            let tests = family.test_functions(&z, p, &evaluation);
            let determinant_sign = lu.determinant().signum() * new_tangent_sign(&new_tangent, tangent);
            let residual = evaluation
                .residual
                .iter()
                .zip(&scales.unknowns)
                .fold(0.0_f64, |largest, (r, scale)| largest.max((r / scale).abs()));
            let pattern = family.pattern(&z, p, &evaluation);
            let observed = family.observe(&z, p, &evaluation);
            return Ok(Point {
                z,
                p,
                tangent: new_tangent,
                arclength: 0.0,
                iterations: iteration,
                residual,
                tests,
                pattern,
                observed,
                determinant_sign,
            });
        }
        previous = size;
    }
    Err(FamilyError("Newton's method did not converge".into()))
}

fn new_tangent_sign(tangent: &[f64], reference: &[f64]) -> f64 {
    if dot(tangent, reference) < 0.0 { -1.0 } else { 1.0 }
}

/// The scaled bordered matrix `[F_z F_p; tᵀ]`.
fn bordered(evaluation: &Evaluation, scales: &Scales, tangent: &[f64]) -> Matrix {
    let n = evaluation.residual.len();
    let mut matrix = Matrix::zeros(n + 1, n + 1);
    for i in 0..n {
        let row = matrix.row_mut(i);
        for j in 0..n {
            row[j] = evaluation.jacobian[(i, j)] * scales.unknowns[j] / scales.unknowns[i];
        }
        row[n] = evaluation.by_parameter[i] * scales.parameter / scales.unknowns[i];
    }
    matrix.row_mut(n).copy_from_slice(tangent);
    matrix
}

pub(crate) fn align(tangent: &mut [f64], reference: &[f64]) {
    if dot(tangent, reference) < 0.0 {
        tangent.iter_mut().for_each(|value| *value = -*value);
    }
}
