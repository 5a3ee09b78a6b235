//! Step tables by terms, for many coordinates: only the transition matrices are tabulated, single states are developed by
//! recursion, which touches less memory than a table of all columns would.

use super::column_tables::Tabulation;
use super::generator::Generator;
use super::kernels::add_combination;
use super::rate::Rate;
use super::step_map::Work;
use slackside_numerics::polynomial::TERMS;

/// The mechanical part of `(A h)^k / k!`: [`TERMS`] matrices by rows, one after another.
#[derive(Debug, Clone)]
pub(super) struct TermTables {
    terms: Vec<f64>,
}

impl TermTables {
    pub fn new(state: usize) -> Self {
        Self {
            terms: vec![0.0; TERMS * state * state],
        }
    }

    /// Computes the columns from `first` on, all at once and term by term, so that the inner loops run over columns; with what
    /// the guards see of them and the sum `full` of each.
    pub fn tabulate(&mut self, step: &mut Tabulation<'_>, first: usize) {
        let layout = &step.generator.layout;
        let (n, nx, nz) = (layout.coordinates, layout.state(), layout.augmented());
        let width = nz - first;
        // Rows of the current term: entry (i, j) belongs to column `first + j`.
        let mut term = vec![0.0; nz * width];
        for j in 0..width {
            term[(first + j) * width + j] = 1.0;
        }
        let mut next = vec![0.0; nz * width];
        let mut sum = term[..nx * width].to_vec();
        let mut seen = vec![0.0; width];
        for k in 0..TERMS {
            if k > 0 {
                let factor = step.length / k as f64;
                advance_term(step.generator, (n, nx, nz), width, factor, &term, &mut next);
                std::mem::swap(&mut term, &mut next);
                for (s, value) in sum.iter_mut().zip(&term) {
                    *s += value;
                }
            }
            if first == 0 {
                let block = &mut self.terms[k * nx * nx..(k + 1) * nx * nx];
                for (row, values) in block.chunks_exact_mut(nx).zip(term.chunks_exact(width)) {
                    row.copy_from_slice(&values[..nx]);
                }
            }
            for guard in step.guards.iter_mut() {
                seen.fill(0.0);
                add_combination(&guard.guard.row, &term, width, 1.0, &mut seen);
                for (taylor, value) in guard.taylor[first..].iter_mut().zip(&seen) {
                    taylor[k] = *value;
                }
            }
        }
        for (j, column) in step.full.chunks_exact_mut(nx).skip(first).enumerate() {
            for (i, value) in column.iter_mut().enumerate() {
                *value = sum[i * width + j];
            }
        }
    }

    /// The mechanical part of the transition over a share of the step, by columns.
    pub fn transition(&self, share: f64, state: usize, work: &mut Vec<f64>, out: &mut [f64]) {
        let size = state * state;
        work.clear();
        work.resize(size, 0.0);
        for block in self.terms.chunks_exact(size).rev() {
            for (sum, value) in work.iter_mut().zip(block) {
                *sum = *sum * share + value;
            }
        }
        for (j, column) in out.chunks_exact_mut(state).enumerate() {
            for (i, value) in column.iter_mut().enumerate() {
                *value = work[i * state + j];
            }
        }
    }
}

/// `next = factor · A · term`, blocks of rows of length `width`.
fn advance_term(
    generator: &Generator,
    (n, nx, nz): (usize, usize, usize),
    width: usize,
    factor: f64,
    term: &[f64],
    next: &mut [f64],
) {
    for (o, v) in next[..n * width].iter_mut().zip(&term[n * width..2 * n * width]) {
        *o = factor * v;
    }
    let rows = generator.rates.chunks_exact(nz);
    for (row, out) in rows.zip(next[n * width..].chunks_exact_mut(width)) {
        out.fill(0.0);
        add_combination(row, term, width, factor, out);
    }
    let mut at = nx + 1;
    next[nx * width..at * width].fill(0.0);
    for &order in &generator.layout.orders {
        let rate = factor * order as f64 * generator.frequency;
        for j in 0..width {
            next[at * width + j] = -rate * term[(at + 1) * width + j];
            next[(at + 1) * width + j] = rate * term[at * width + j];
        }
        at += 2;
    }
}

/// The mechanical state over the step as a polynomial, by recursion on its terms.
pub(super) fn polynomial(generator: &Generator, length: f64, z: &[f64], work: &mut Work) {
    let nx = work.state.len();
    work.term.copy_from_slice(z);
    work.polynomial[..nx].copy_from_slice(&z[..nx]);
    for k in 1..TERMS {
        let factor = length / k as f64;
        generator.apply_wide(&work.term, &mut work.next);
        for (t, value) in work.term.iter_mut().zip(&work.next) {
            *t = factor * value;
        }
        work.polynomial[k * nx..(k + 1) * nx].copy_from_slice(&work.term[..nx]);
    }
}

/// The derivative of that polynomial with respect to the parameter at fixed phases,
/// `w_k = (h/k) (A w_{k−1} + A_p y_{k−1}) − (Ω_p/Ω) y_k` with the terms `y` of the state.
pub(super) fn rate_polynomial(generator: &Generator, rate: &Rate, length: f64, z: &[f64], work: &mut Work) {
    let (nx, nz) = (work.state.len(), z.len());
    let n = generator.layout.coordinates;
    let share = rate.frequency / generator.frequency;
    work.term.copy_from_slice(z);
    work.polynomial[..nx].fill(0.0);
    let mut variation = vec![0.0; nz];
    let mut next_variation = vec![0.0; nz];
    for k in 1..TERMS {
        let factor = length / k as f64;
        generator.apply_wide(&variation, &mut next_variation);
        rate.add_source(&work.term, &mut next_variation[..nx], n);
        generator.apply_wide(&work.term, &mut work.next);
        for (t, value) in work.term.iter_mut().zip(&work.next) {
            *t = factor * value;
        }
        for i in 0..nx {
            variation[i] = factor * next_variation[i] - share * work.term[i];
        }
        work.polynomial[k * nx..(k + 1) * nx].copy_from_slice(&variation[..nx]);
    }
}
