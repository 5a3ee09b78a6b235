//! Floquet multipliers of a periodic motion and the test functions of its bifurcations (theory 02 §6, §7).
//!
//! The monodromy matrix maps a small disturbance of the state at the start of a period to that at its end; its
//! eigenvalues are the multipliers `μ`. The motion is stable if all `|μ| < 1`.

use slackside_linalg::{Complex, LinalgError, Matrix, determinant, eigenvalues};

/// Largest order for which the bialternate product is formed: its order is `n(n−1)/2`, here at most 66.
const BIALTERNATE_LIMIT: usize = 12;

/// Eigenvalues of the monodromy matrix, largest modulus first; of a complex pair the one with positive imaginary part
/// first.
///
/// # Errors
/// [`LinalgError`] if the matrix is not square or not finite, or the eigenvalue iteration fails.
pub fn multipliers(monodromy: &Matrix) -> Result<Vec<Complex>, LinalgError> {
    let mut values = eigenvalues(monodromy)?;
    sort(&mut values);
    Ok(values)
}

/// Orders multipliers by falling modulus with conjugates adjacent, although the computed moduli of a pair, or of two pairs,
/// may differ by rounding.
pub(crate) fn sort(values: &mut [Complex]) {
    let mut upper: Vec<Complex> = values.iter().copied().filter(|value| value.im >= 0.0).collect();
    upper.sort_by(|a, b| b.norm_sqr().total_cmp(&a.norm_sqr()).then(b.re.total_cmp(&a.re)));
    let paired: Vec<Complex> = upper
        .iter()
        .flat_map(|&value| std::iter::once(value).chain((value.im > 0.0).then(|| value.conj())))
        .collect();
    if paired.len() == values.len() {
        values.copy_from_slice(&paired);
    } else {
        values.sort_by(|a, b| b.norm_sqr().total_cmp(&a.norm_sqr()));
    }
}

/// `det(Mon + I) = Π (μ_i + 1)`: changes sign where a real multiplier passes −1 (period doubling). NaN if the matrix is
/// not square or not finite.
pub fn period_doubling_test(monodromy: &Matrix) -> f64 {
    let mut shifted = monodromy.clone();
    for i in 0..shifted.rows().min(shifted.columns()) {
        shifted[(i, i)] += 1.0;
    }
    determinant(&shifted).unwrap_or(f64::NAN)
}

/// `Π_{i<j} (μ_i μ_j − 1)`: changes sign where a complex pair passes the unit circle (Neimark–Sacker), and also where two
/// real multipliers have the product 1 (a neutral saddle, no bifurcation). NaN if the matrix is not square or not finite.
///
/// For small matrices it is `det(Mon ⊙ Mon − I)` with the bialternate product (theory 02 §6), which is smooth in the
/// entries; beyond 12 states it is the product over pairs of eigenvalues, `O(n³)`.
pub fn neimark_sacker_test(monodromy: &Matrix) -> f64 {
    let n = monodromy.rows();
    if monodromy.columns() != n {
        return f64::NAN;
    }
    if n > BIALTERNATE_LIMIT {
        return match eigenvalues(monodromy) {
            Ok(values) => pair_product(&values),
            Err(_) => f64::NAN,
        };
    }
    determinant(&bialternate_minus_identity(monodromy)).unwrap_or(f64::NAN)
}

/// `Π_{i<j} (μ_i μ_j − 1)`, real because the factors of conjugate pairs are conjugate.
fn pair_product(values: &[Complex]) -> f64 {
    let mut product = Complex::new(1.0, 0.0);
    for i in 0..values.len() {
        for j in 0..i {
            product *= values[i] * values[j] - 1.0;
        }
    }
    product.re
}

/// `Mon ⊙ Mon − I` with `(Mon ⊙ Mon)_{(ij),(kl)} = m_ik m_jl − m_il m_jk`, `i > j`, `k > l`.
fn bialternate_minus_identity(m: &Matrix) -> Matrix {
    let n = m.rows();
    let pairs: Vec<(usize, usize)> = (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
    let mut product = Matrix::zeros(pairs.len(), pairs.len());
    for (row, &(i, j)) in pairs.iter().enumerate() {
        for (column, &(k, l)) in pairs.iter().enumerate() {
            product[(row, column)] = m[(i, k)] * m[(j, l)] - m[(i, l)] * m[(j, k)];
        }
        product[(row, row)] -= 1.0;
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix similar to blocks with known eigenvalues: rotations scaled by `moduli` at angle 1, then `real` ones.
    fn with_spectrum(moduli: &[f64], real: &[f64]) -> Matrix {
        let n = 2 * moduli.len() + real.len();
        let mut blocks = Matrix::zeros(n, n);
        for (k, r) in moduli.iter().enumerate() {
            let (s, c) = 1.0_f64.sin_cos();
            let i = 2 * k;
            blocks[(i, i)] = r * c;
            blocks[(i, i + 1)] = -r * s;
            blocks[(i + 1, i)] = r * s;
            blocks[(i + 1, i + 1)] = r * c;
        }
        for (k, &value) in real.iter().enumerate() {
            let i = 2 * moduli.len() + k;
            blocks[(i, i)] = value;
        }
        // Similarity by a unit lower triangular matrix, whose inverse is applied by forward substitution.
        let mut t = Matrix::identity(n);
        for i in 0..n {
            for j in 0..i {
                t[(i, j)] = 0.3 * ((3 * i + 5 * j) as f64).sin();
            }
        }
        let inverse = slackside_linalg::Lu::new(&t)
            .unwrap()
            .solve_matrix(&Matrix::identity(n));
        t.product(&blocks).product(&inverse)
    }

    fn expected_pairs(moduli: &[f64], real: &[f64]) -> f64 {
        let mut values: Vec<Complex> = real.iter().map(|&v| Complex::new(v, 0.0)).collect();
        for &r in moduli {
            values.push(Complex::from_polar(r, 1.0));
            values.push(Complex::from_polar(r, -1.0));
        }
        pair_product(&values)
    }

    #[test]
    fn test_functions_are_products_over_the_multipliers() {
        let (moduli, real) = ([0.9, 0.7], [0.5, -0.8]);
        let matrix = with_spectrum(&moduli, &real);
        let found = multipliers(&matrix).unwrap();
        assert!((found[0] - Complex::from_polar(0.9, 1.0)).norm() < 1e-12);
        assert!((found[1] - Complex::from_polar(0.9, -1.0)).norm() < 1e-12);
        assert!((found[2] - Complex::new(-0.8, 0.0)).norm() < 1e-12);
        let doubling: Complex = found.iter().map(|v| v + 1.0).product();
        assert!((period_doubling_test(&matrix) - doubling.re).abs() < 1e-12);
        assert!((neimark_sacker_test(&matrix) - expected_pairs(&moduli, &real)).abs() < 1e-12);
    }

    #[test]
    fn signs_change_at_the_unit_circle() {
        for moduli in [[0.5, 0.3].as_slice(), &[0.4; 7]] {
            let with = |first: f64| {
                let mut all = moduli.to_vec();
                all[0] = first;
                neimark_sacker_test(&with_spectrum(&all, &[0.2]))
            };
            assert!(with(0.999) * with(1.001) < 0.0);
        }
        let with = |real: f64| period_doubling_test(&with_spectrum(&[0.5], &[real, 0.1]));
        assert!(with(-0.999) * with(-1.001) < 0.0);
    }

    #[test]
    fn large_matrices_agree_with_the_product_over_pairs() {
        let (moduli, real) = ([0.95, 0.9, 0.6, 0.5, 0.3, 0.2], [0.4, -0.3]);
        let found = neimark_sacker_test(&with_spectrum(&moduli, &real));
        assert!((found / expected_pairs(&moduli, &real) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_not_a_monodromy_matrix_gives_nan() {
        let mut bad = Matrix::identity(4);
        bad[(1, 2)] = f64::NAN;
        assert!(period_doubling_test(&bad).is_nan());
        assert!(neimark_sacker_test(&bad).is_nan());
        assert!(multipliers(&Matrix::zeros(2, 3)).is_err());
    }
}
