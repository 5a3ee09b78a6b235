//! The matrix exponential by scaling and squaring with the Padé approximant of order 13.

use crate::{LinalgError, Lu, Matrix};

/// Coefficients of the numerator of the [13/13] Padé approximant of `exp`: `b_k = (26−k)! 13! / (26! k! (13−k)!) · b_0`.
const PADE_13: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];

/// Largest 1-norm (here: row-sum norm) for which the approximant is accurate to rounding without scaling.
const PADE_13_REACH: f64 = 5.371920351148152;

/// `exp(matrix)`, about `30 n³` operations plus `2n³` per squaring.
///
/// # Errors
/// [`LinalgError::NotSquare`], [`LinalgError::NotFinite`], or [`LinalgError::Singular`] if the scaled denominator is
/// singular (it is not for finite input of reasonable size).
pub fn exponential(matrix: &Matrix) -> Result<Matrix, LinalgError> {
    matrix.check_square()?;
    let n = matrix.rows();
    let norm = matrix.norm_infinity();
    let squarings = if norm > PADE_13_REACH {
        (norm / PADE_13_REACH).log2().ceil() as i32
    } else {
        0
    };
    let a = matrix.scaled(0.5_f64.powi(squarings));
    let a2 = a.product(&a);
    let a4 = a2.product(&a2);
    let a6 = a4.product(&a2);
    let b = &PADE_13;
    let identity = Matrix::identity(n);
    let sum = |c: [f64; 4]| {
        let mut result = identity.scaled(c[0]);
        result.add_scaled(c[1], &a2);
        result.add_scaled(c[2], &a4);
        result.add_scaled(c[3], &a6);
        result
    };
    let mut odd = a6.product(&sum([0.0, b[9], b[11], b[13]]));
    odd.add_scaled(1.0, &sum([b[1], b[3], b[5], b[7]]));
    let odd = a.product(&odd);
    let mut even = a6.product(&sum([0.0, b[8], b[10], b[12]]));
    even.add_scaled(1.0, &sum([b[0], b[2], b[4], b[6]]));
    let mut numerator = even.clone();
    numerator.add_scaled(1.0, &odd);
    let mut denominator = even;
    denominator.add_scaled(-1.0, &odd);
    let mut result = Lu::new(&denominator)?.solve_matrix(&numerator);
    for _ in 0..squarings {
        result = result.product(&result);
    }
    Ok(result)
}
