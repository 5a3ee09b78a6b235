//! Closed forms, and an independent linear-algebra library as oracle.

use nalgebra::DMatrix;
use slackside_linalg::*;

/// Deterministic pseudo-random matrix with entries in (-1, 1).
fn sample(n: usize, seed: u64) -> Matrix {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut matrix = Matrix::zeros(n, n);
    for value in matrix.as_mut_slice() {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        *value = (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
    }
    matrix
}

fn oracle(matrix: &Matrix) -> DMatrix<f64> {
    DMatrix::from_row_slice(matrix.rows(), matrix.columns(), matrix.as_slice())
}

fn spd(n: usize, seed: u64) -> Matrix {
    let a = sample(n, seed);
    let mut s = a.product(&a.transpose());
    s.add_scaled(1.0, &Matrix::identity(n));
    s
}

#[test]
fn lu_solves_small_and_large_systems() {
    for n in [1, 2, 4, 5, 12, 24, 25, 60] {
        let a = sample(n, n as u64);
        let x: Vec<f64> = (0..n).map(|i| (i as f64 + 1.0).sin()).collect();
        let solved = Lu::new(&a).unwrap().solve(&a.times(&x));
        for (s, e) in solved.iter().zip(&x) {
            assert!((s - e).abs() < 1e-10, "n = {n}: {s} against {e}");
        }
        let determinant_oracle = oracle(&a).determinant();
        let value = determinant(&a).unwrap();
        assert!(
            (value - determinant_oracle).abs() <= 1e-10 * determinant_oracle.abs(),
            "n = {n}"
        );
    }
}

#[test]
fn singular_and_non_finite_matrices_are_refused() {
    assert_eq!(Lu::new(&Matrix::zeros(3, 3)).unwrap_err(), LinalgError::Singular);
    assert_eq!(
        Lu::new(&Matrix::zeros(30, 30)).unwrap_err(),
        LinalgError::Singular
    );
    assert_eq!(
        Lu::new(&Matrix::zeros(3, 2)).unwrap_err(),
        LinalgError::NotSquare { rows: 3, columns: 2 }
    );
    let mut bad = Matrix::identity(3);
    bad[(1, 1)] = f64::NAN;
    assert_eq!(eigenvalues(&bad).unwrap_err(), LinalgError::NotFinite);
    assert_eq!(determinant(&Matrix::zeros(2, 2)).unwrap(), 0.0);
}

#[test]
fn complex_lu_solves_a_dynamic_stiffness() {
    let (m, c, k) = (spd(5, 1), sample(5, 2), spd(5, 3));
    let w = 1.3;
    let d = ComplexMatrix::combination(&[
        (Complex::new(-w * w, 0.0), &m),
        (Complex::new(0.0, w), &c),
        (Complex::new(1.0, 0.0), &k),
    ]);
    let x: Vec<Complex> = (0..5).map(|i| Complex::new(i as f64, 1.0 - i as f64)).collect();
    let solved = d.lu().unwrap().solve(&d.times(&x));
    for (s, e) in solved.iter().zip(&x) {
        assert!((s - e).norm() < 1e-12);
    }
}

#[test]
fn eigenvalues_agree_with_the_oracle() {
    for n in [2, 4, 9, 30] {
        let a = sample(n, 7 + n as u64);
        let mut ours = eigenvalues(&a).unwrap();
        let mut theirs: Vec<Complex> = oracle(&a)
            .complex_eigenvalues()
            .iter()
            .map(|v| Complex::new(v.re, v.im))
            .collect();
        let order = |v: &Complex, w: &Complex| (v.re, v.im).partial_cmp(&(w.re, w.im)).unwrap();
        ours.sort_by(order);
        theirs.sort_by(order);
        for (a, b) in ours.iter().zip(&theirs) {
            assert!((a - b).norm() < 1e-11, "{a} against {b}");
        }
        let e = eigen(&a).unwrap();
        for j in 0..n {
            let v: Vec<Complex> = (0..n).map(|i| e.vectors[(i, j)]).collect();
            for i in 0..n {
                let av: Complex = (0..n).map(|k| a[(i, k)] * v[k]).sum();
                assert!((av - e.values[j] * v[i]).norm() < 1e-11);
            }
        }
    }
}

#[test]
fn undamped_modes_are_mass_orthonormal() {
    let (m, k) = (spd(6, 11), spd(6, 12));
    let modes = undamped_modes(&m, &k).unwrap();
    let phi = &modes.shapes;
    let mass = phi.transpose().product(&m.product(phi));
    let stiffness = phi.transpose().product(&k.product(phi));
    for i in 0..6 {
        for j in 0..6 {
            let unit = if i == j { 1.0 } else { 0.0 };
            assert!((mass[(i, j)] - unit).abs() < 1e-12);
            assert!((stiffness[(i, j)] - unit * modes.squared_frequencies[i]).abs() < 1e-11);
        }
    }
    let mut indefinite = m;
    indefinite[(0, 0)] = -1.0;
    assert_eq!(
        undamped_modes(&indefinite, &k).unwrap_err(),
        LinalgError::NotPositiveDefinite
    );
}

#[test]
fn exponential_agrees_with_oracle_and_with_a_rotation() {
    for (n, size) in [(3, 0.3), (4, 4.0), (7, 30.0)] {
        let a = sample(n, 21).scaled(size);
        let ours = exponential(&a).unwrap();
        let theirs = oracle(&a).exp();
        let scale = ours.max_abs();
        for i in 0..n {
            for j in 0..n {
                assert!((ours[(i, j)] - theirs[(i, j)]).abs() < 1e-12 * scale);
            }
        }
    }
    let angle = 100.0_f64;
    let rotation = exponential(&Matrix::from_rows(&[vec![0.0, -angle], vec![angle, 0.0]]).unwrap()).unwrap();
    assert!((rotation[(0, 0)] - angle.cos()).abs() < 1e-12);
    assert!((rotation[(1, 0)] - angle.sin()).abs() < 1e-12);
}

#[test]
fn orthonormalization_keeps_the_span_and_the_volume() {
    let a = sample(4, 31);
    let mut q = a.clone();
    let diagonal = orthonormalize(&mut q);
    let gram = q.transpose().product(&q);
    for i in 0..4 {
        for j in 0..4 {
            assert!((gram[(i, j)] - if i == j { 1.0 } else { 0.0 }).abs() < 1e-14);
        }
    }
    let volume: f64 = diagonal.iter().product();
    assert!((volume - determinant(&a).unwrap().abs()).abs() < 1e-13);
}

#[test]
fn large_products_take_the_library_path() {
    let (a, b) = (sample(30, 1), sample(30, 2));
    let p = a.product(&b);
    let q = oracle(&a) * oracle(&b);
    for i in 0..30 {
        for j in 0..30 {
            assert!((p[(i, j)] - q[(i, j)]).abs() < 1e-12);
        }
    }
}

/// A random gyroscopic system.
fn gyroscopic(n: usize, seed: u64) -> [Matrix; 3] {
    let a = sample(n, seed + 7);
    let mut skew = a.clone();
    skew.add_scaled(-1.0, &a.transpose());
    [spd(n, seed), skew, spd(n, seed + 3)]
}

/// Largest `|(K − ω²M + iωG) φ|` over the modes, and largest deviation of `ω² φᴴMψ + φᴴKψ` from the identity.
fn gyroscopic_errors([mass, skew, stiffness]: &[Matrix; 3], modes: &GyroscopicModes) -> (f64, f64) {
    let n = mass.rows();
    let shape = |j: usize| (0..n).map(|i| modes.shapes[(i, j)]).collect::<Vec<Complex>>();
    let (mut residual, mut orthogonality) = (0.0_f64, 0.0_f64);
    for j in 0..n {
        let omega = modes.frequencies[j];
        let dynamic = ComplexMatrix::combination(&[
            (Complex::new(-omega * omega, 0.0), mass),
            (Complex::new(0.0, omega), skew),
            (Complex::new(1.0, 0.0), stiffness),
        ]);
        let rest = dynamic.times(&shape(j));
        residual = rest.iter().fold(residual, |a, v| a.max(v.norm()));
        for k in 0..n {
            let product = |matrix: &Matrix| -> Complex {
                let as_complex = ComplexMatrix::combination(&[(Complex::new(1.0, 0.0), matrix)]);
                as_complex
                    .times(&shape(k))
                    .iter()
                    .zip(shape(j))
                    .map(|(a, b)| b.conj() * a)
                    .sum()
            };
            let inner = product(mass) * omega * modes.frequencies[k] + product(stiffness);
            let expected = if j == k { 1.0 } else { 0.0 };
            orthogonality = orthogonality.max((inner - expected).norm());
        }
    }
    (residual, orthogonality)
}

#[test]
fn gyroscopic_modes_solve_their_equation() {
    for n in [1, 2, 5, 12, 40] {
        let system = gyroscopic(n, n as u64);
        let modes = gyroscopic_modes(&system[0], &system[1], &system[2]).unwrap();
        let (residual, orthogonality) = gyroscopic_errors(&system, &modes);
        assert!(residual < 1e-10 * n as f64, "n = {n}: residual {residual}");
        assert!(orthogonality < 1e-9, "n = {n}: orthogonality {orthogonality}");
        assert!(modes.frequencies.windows(2).all(|pair| pair[0] <= pair[1]));
    }
}

#[test]
fn gyroscopic_modes_of_equal_frequency_are_separated() {
    // Two copies of one system side by side: every frequency twice.
    let half = gyroscopic(6, 5);
    let double = half.clone().map(|matrix| {
        let mut both = Matrix::zeros(12, 12);
        for i in 0..6 {
            for j in 0..6 {
                both[(i, j)] = matrix[(i, j)];
                both[(6 + i, 6 + j)] = matrix[(i, j)];
            }
        }
        both
    });
    let modes = gyroscopic_modes(&double[0], &double[1], &double[2]).unwrap();
    let (residual, orthogonality) = gyroscopic_errors(&double, &modes);
    assert!(residual < 1e-10, "residual {residual}");
    assert!(orthogonality < 1e-9, "orthogonality {orthogonality}");
    let single = gyroscopic_modes(&half[0], &half[1], &half[2]).unwrap();
    for (k, frequency) in modes.frequencies.iter().enumerate() {
        assert!((frequency - single.frequencies[k / 2]).abs() < 1e-12 * frequency);
    }
}

#[test]
fn gyroscopic_modes_refuse_an_unstable_system() {
    let identity = Matrix::identity(2);
    let result = gyroscopic_modes(&identity, &Matrix::zeros(2, 2), &Matrix::diagonal(&[1.0, -1.0]));
    assert_eq!(result.unwrap_err(), LinalgError::NotPositiveDefinite);
}
