//! Balancing of a matrix before its eigenvalues are computed.

use crate::Matrix;

/// Rounds at most; each is cheap, and three or four settle.
const ROUNDS: usize = 20;

/// Scales `matrix` to `D⁻¹ A D` with a diagonal `D` of powers of two such that rows and columns have similar sums, and
/// returns the diagonal. Eigenvalues are unchanged, without any rounding; an eigenvector `v` of the result belongs to `D v`.
///
/// The error of an eigenvalue iteration is relative to the largest entry. Displacements and rates in units of different
/// size (rad and rad/s) make entries that differ by many orders of magnitude, which the balanced matrix does not have.
/// `O(n²)` per round (Parlett and Reinsch 1969).
pub(crate) fn balance(matrix: &mut Matrix) -> Vec<f64> {
    let n = matrix.rows();
    let mut diagonal = vec![1.0; n];
    for _ in 0..ROUNDS {
        let mut settled = true;
        for i in 0..n {
            let others = || (0..n).filter(move |&j| j != i);
            let column: f64 = others().map(|j| matrix[(j, i)].abs()).sum();
            let row: f64 = others().map(|j| matrix[(i, j)].abs()).sum();
            if !(column > 0.0 && row > 0.0) {
                continue;
            }
            // The power of two nearest to the factor that makes both sums equal.
            let factor = (0.5 * (row / column).log2()).round().exp2();
            if !factor.is_normal() || column * factor + row / factor >= 0.95 * (column + row) {
                continue;
            }
            settled = false;
            diagonal[i] *= factor;
            for j in 0..n {
                matrix[(j, i)] *= factor;
                matrix[(i, j)] /= factor;
            }
        }
        if settled {
            break;
        }
    }
    diagonal
}

#[cfg(test)]
mod tests {
    use super::balance;
    use crate::Matrix;

    #[test]
    fn a_badly_scaled_matrix_becomes_one_of_even_entries() {
        let units = [1.0, 1e4, 1e-5];
        let mut matrix = Matrix::zeros(3, 3);
        for i in 0..3 {
            for j in 0..3 {
                matrix[(i, j)] = (1.0 + (3 * i + j) as f64) * units[i] / units[j];
            }
        }
        let original = matrix.clone();
        let diagonal = balance(&mut matrix);
        for i in 0..3 {
            for j in 0..3 {
                assert_eq!(matrix[(i, j)], original[(i, j)] * diagonal[j] / diagonal[i]);
            }
        }
        assert!(original.max_abs() > 1e8 && matrix.max_abs() < 30.0, "{matrix:?}");
    }

    #[test]
    fn a_triangular_matrix_is_left_alone_where_a_sum_is_zero() {
        let mut matrix = Matrix::from_rows(&[vec![1.0, 1e9], vec![0.0, 2.0]]).unwrap();
        let original = matrix.clone();
        assert_eq!(balance(&mut matrix), [1.0, 1.0]);
        assert_eq!(matrix.as_slice(), original.as_slice());
    }
}
