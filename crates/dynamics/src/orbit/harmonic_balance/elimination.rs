//! Gaussian elimination of small complex systems in place, one per harmonic and Newton step, without allocation.

use num_complex::Complex;

/// Solves `A X = B` in place for a row-major `n × n` matrix and `columns` right-hand sides stored row by row; `matrix` is
/// destroyed and `right` holds `X` on return, `n³/3 + n² columns` operations. Returns false, leaving both undefined, if a
/// pivot is zero or not finite.
pub fn solve(matrix: &mut [Complex<f64>], right: &mut [Complex<f64>], n: usize, columns: usize) -> bool {
    for k in 0..n {
        let mut pivot = k;
        let mut largest = matrix[k * n + k].norm_sqr();
        for i in k + 1..n {
            let size = matrix[i * n + k].norm_sqr();
            if size > largest {
                (pivot, largest) = (i, size);
            }
        }
        if !(largest > 0.0 && largest.is_finite()) {
            return false;
        }
        if pivot != k {
            for j in k..n {
                matrix.swap(k * n + j, pivot * n + j);
            }
            for j in 0..columns {
                right.swap(k * columns + j, pivot * columns + j);
            }
        }
        let inverse = matrix[k * n + k].inv();
        for i in k + 1..n {
            let factor = matrix[i * n + k] * inverse;
            if factor == Complex::ZERO {
                continue;
            }
            for j in k + 1..n {
                let top = matrix[k * n + j];
                matrix[i * n + j] -= factor * top;
            }
            for j in 0..columns {
                let top = right[k * columns + j];
                right[i * columns + j] -= factor * top;
            }
        }
    }
    for k in (0..n).rev() {
        let inverse = matrix[k * n + k].inv();
        for j in 0..columns {
            let mut sum = right[k * columns + j];
            for i in k + 1..n {
                sum -= matrix[k * n + i] * right[i * columns + j];
            }
            right[k * columns + j] = sum * inverse;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solution_satisfies_the_equations() {
        let (n, columns) = (5, 3);
        let entry = |i: usize| Complex::new((1.7 * i as f64).sin(), (0.9 * i as f64 + 0.4).cos());
        let mut matrix: Vec<_> = (0..n * n).map(entry).collect();
        matrix[0] = Complex::ZERO;
        let original = matrix.clone();
        let right: Vec<_> = (0..n * columns).map(|i| entry(i + 100)).collect();
        let mut x = right.clone();
        assert!(solve(&mut matrix, &mut x, n, columns));
        for i in 0..n {
            for j in 0..columns {
                let sum: Complex<f64> = (0..n).map(|k| original[i * n + k] * x[k * columns + j]).sum();
                assert!((sum - right[i * columns + j]).norm() < 1e-13);
            }
        }
    }

    #[test]
    fn a_zero_column_is_reported() {
        let mut matrix = vec![Complex::ZERO, Complex::ONE, Complex::ZERO, Complex::ONE];
        assert!(!solve(&mut matrix, &mut [Complex::ONE; 2], 2, 1));
    }
}
