//! Hill's method: the disturbance as `e^{λt}` times a truncated Fourier series, in first-order real form.
//!
//! With `x = (q, q')` and `x = e^{λt} (x_0 + Σ (x_ck cos kωt + x_sk sin kωt))`, the equation `x' = A(t) x` becomes the real
//! eigenvalue problem `λ X = (T(A) − ωD) X`. Of its eigenvalues, copies of the exponents shifted by multiples of `iω`, those
//! are kept whose eigenvectors have the smallest mean order `|Σ k |x_k|²| / Σ |x_k|²` (theory 02 §7).

use super::super::balance::graphs;
use super::super::force::{ExactSwitching, ForceEvaluation, PortForce};
use super::super::graph::Graph;
use super::super::{HarmonicBalanceError, HarmonicOrbit};
use super::StateMatrices;
use crate::orbit::floquet;
use num_complex::Complex;
use slackside_linalg::{ComplexMatrix, Matrix, eigen};
use slackside_numerics::fourier::FourierPlanner;

/// The `2n` multipliers over one period of the motion, largest modulus first. `O((2n(2H+1))³)`.
pub fn multipliers(orbit: &HarmonicOrbit) -> Result<Vec<Complex<f64>>, HarmonicBalanceError> {
    let (states, harmonics) = (2 * orbit.system.order(), orbit.harmonics);
    let problem = eigen(&hill_matrix(orbit)?)?;
    let mut ranked: Vec<(f64, Complex<f64>)> = problem
        .values
        .iter()
        .enumerate()
        .map(|(column, &lambda)| (mean_order(&problem.vectors, column, states, harmonics), lambda))
        .collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    let kept = ranked.iter().take(states);
    let mut result: Vec<_> = kept.map(|(_, lambda)| (lambda * orbit.period()).exp()).collect();
    floquet::sort(&mut result);
    Ok(result)
}

/// The matrix in the order `x_0, x_c1, x_s1, …`, each a block of all states.
fn hill_matrix(orbit: &HarmonicOrbit) -> Result<Matrix, HarmonicBalanceError> {
    let harmonics = orbit.harmonics;
    let matrices = StateMatrices::new(&orbit.system, orbit.frequency)?;
    let elements = orbit.system.elements.len();
    let mut planner = FourierPlanner::default();
    let graphs = graphs(&orbit.system, &orbit.linearization);
    let tangents: Vec<TangentHarmonics> = (0..elements)
        .map(|e| match &graphs[e] {
            Some(graph) => switched_tangents(orbit, e, graph.clone(), &mut planner),
            None => sampled_tangents(orbit, e, &mut planner),
        })
        .collect();
    let zero = matrices.with_tangents((0..elements).map(|_| (0.0, 0.0)));
    // Amplitude m of A(t) = A_0 + Re Σ A_m e^{imωt}: cosine and sine parts.
    let mut parts: Vec<(Matrix, Matrix)> = Vec::with_capacity(2 * harmonics + 1);
    for m in 0..=2 * harmonics {
        let amplitudes: Vec<_> = tangents
            .iter()
            .map(|t| (t.by_displacement[m], t.by_velocity[m]))
            .collect();
        let mut cosine = matrices.with_tangents(amplitudes.iter().map(|(u, v)| (u.re, v.re)));
        let mut sine = matrices.with_tangents(amplitudes.iter().map(|(u, v)| (-u.im, -v.im)));
        if m > 0 {
            cosine.add_scaled(-1.0, &zero);
        }
        sine.add_scaled(-1.0, &zero);
        parts.push((cosine, sine));
    }
    Ok(assemble(&parts, harmonics, orbit.omega()))
}

/// Amplitudes of the two tangents of one element.
struct TangentHarmonics {
    by_displacement: Vec<Complex<f64>>,
    by_velocity: Vec<Complex<f64>>,
}

/// Tangents of a piecewise-linear law, exactly from its switching angles.
fn switched_tangents(
    orbit: &HarmonicOrbit,
    element: usize,
    graph: Graph,
    planner: &mut FourierPlanner,
) -> TangentHarmonics {
    let mut force = PortForce::default();
    let drifts = orbit.linearization.drifting[element];
    let mut displacement = orbit.displacements[element].clone();
    if drifts {
        displacement[0].re = orbit.drifts[element];
    }
    ExactSwitching::new(graph, drifts, displacement.len() - 1, planner).evaluate(
        &displacement,
        orbit.omega(),
        &mut force,
    );
    let (spring, damper) = orbit.linearization.elements[element];
    let amplitudes = |coefficients: &[Complex<f64>], linear: f64| {
        let mut result: Vec<_> = coefficients.iter().map(|c| 2.0 * c).collect();
        result.resize(2 * orbit.harmonics + 1, Complex::ZERO);
        result[0] = Complex::new(0.5 * result[0].re + linear, 0.0);
        result
    };
    TangentHarmonics {
        by_displacement: amplitudes(&force.by_displacement, spring),
        by_velocity: amplitudes(&force.by_velocity, damper),
    }
}

/// Tangents of any other law, from samples.
fn sampled_tangents(orbit: &HarmonicOrbit, element: usize, planner: &mut FourierPlanner) -> TangentHarmonics {
    let law = &orbit.system.elements[element].law;
    let length = orbit.samples.max(16 * orbit.harmonics).next_power_of_two();
    let mut transform = planner.transform(length);
    let displacement = &orbit.displacements[element];
    let rate = orbit.port_rate(element);
    let (mut u, mut v) = (vec![0.0; length], vec![0.0; length]);
    transform.synthesize(displacement, &mut u);
    transform.synthesize(&rate, &mut v);
    let responses: Vec<_> = u.iter().zip(&v).map(|(&u, &v)| law.response(u, v)).collect();
    let mut analyze = |samples: Vec<f64>| {
        let mut result = vec![Complex::ZERO; 2 * orbit.harmonics + 1];
        transform.analyze(&samples, &mut result);
        result
    };
    TangentHarmonics {
        by_displacement: analyze(responses.iter().map(|r| r.by_displacement).collect()),
        by_velocity: analyze(responses.iter().map(|r| r.by_velocity).collect()),
    }
}

/// `T(A) − ωD` from the cosine and sine parts of `A(t)`, orders `0 … 2H`.
fn assemble(parts: &[(Matrix, Matrix)], harmonics: usize, omega: f64) -> Matrix {
    let states = parts[0].0.rows();
    let order = states * (2 * harmonics + 1);
    let mut result = Matrix::zeros(order, order);
    let mut add = |row: usize, column: usize, factor: f64, block: &Matrix| {
        for i in 0..states {
            for j in 0..states {
                result[(row * states + i, column * states + j)] += factor * block[(i, j)];
            }
        }
    };
    let (c, s) = (|k: usize| 2 * k - 1, |k: usize| 2 * k);
    add(0, 0, 1.0, &parts[0].0);
    for k in 1..=harmonics {
        // Mean row and column: products of equal orders; a mean disturbance excites order k by A_k.
        add(0, c(k), 0.5, &parts[k].0);
        add(0, s(k), 0.5, &parts[k].1);
        add(c(k), 0, 1.0, &parts[k].0);
        add(s(k), 0, 1.0, &parts[k].1);
        for l in 1..=harmonics {
            let (sum, difference) = (&parts[k + l], &parts[k.abs_diff(l)]);
            // The sine part is odd in the order k − l; that of order zero vanishes.
            let sign = if k >= l { 1.0 } else { -1.0 };
            let half = if k == l { 1.0 } else { 0.5 };
            add(c(k), c(l), half, &difference.0);
            add(c(k), c(l), 0.5, &sum.0);
            add(s(k), s(l), half, &difference.0);
            add(s(k), s(l), -0.5, &sum.0);
            add(c(k), s(l), 0.5, &sum.1);
            add(s(k), c(l), 0.5, &sum.1);
            if k != l {
                add(c(k), s(l), -0.5 * sign, &difference.1);
                add(s(k), c(l), 0.5 * sign, &difference.1);
            }
        }
    }
    // −d/dt of the series: the cosine row receives −kω x_s, the sine row +kω x_c.
    let identity = Matrix::identity(states);
    for k in 1..=harmonics {
        add(c(k), s(k), -(k as f64) * omega, &identity);
        add(s(k), c(k), k as f64 * omega, &identity);
    }
    result
}

/// `|Σ k |x_k|²| / Σ |x_k|²` over both signs of `k`, with `x_{±k} = (x_ck ∓ i x_sk)/2`.
fn mean_order(vectors: &ComplexMatrix, column: usize, states: usize, harmonics: usize) -> f64 {
    let (mut weighted, mut total) = (0.0, 0.0);
    for j in 0..states {
        total += vectors[(j, column)].norm_sqr();
        for k in 1..=harmonics {
            let cosine = vectors[((2 * k - 1) * states + j, column)];
            let sine = vectors[(2 * k * states + j, column)] * Complex::I;
            let (plus, minus) = (
                0.25 * (cosine - sine).norm_sqr(),
                0.25 * (cosine + sine).norm_sqr(),
            );
            weighted += k as f64 * (plus - minus);
            total += plus + minus;
        }
    }
    (weighted / total).abs()
}
