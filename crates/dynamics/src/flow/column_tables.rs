//! Step tables by columns: the Taylor terms of every column of the augmented state, for few coordinates.
//!
//! Columns stand one after another, so that every evaluation is a sum of contiguous blocks.

use super::generator::Generator;
use super::kernels::{combine, horner};
use super::rate::Rate;
use super::step_map::{GuardMap, Work};
use slackside_numerics::multiply_add;
use slackside_numerics::polynomial::TERMS;

/// `(A h)^k / k!` and its derivatives with respect to the parameter.
#[derive(Debug, Clone)]
pub(super) struct ColumnTables {
    /// Rows of the mechanical state: `n_z` columns of [`TERMS`] blocks of its length.
    terms: Vec<f64>,
    /// Derivatives of `terms` at fixed phases, laid out alike; empty without a rate.
    rate_terms: Vec<f64>,
    /// The sum of `rate_terms` over each column.
    rate_full: Vec<f64>,
}

impl ColumnTables {
    pub fn new(state: usize, augmented: usize, has_rate: bool) -> Self {
        let size = state * augmented;
        let rate_size = if has_rate { size } else { 0 };
        Self {
            terms: vec![0.0; size * TERMS],
            rate_terms: vec![0.0; rate_size * TERMS],
            rate_full: vec![0.0; rate_size],
        }
    }

    /// The frequency of the load has changed by `1/ratio`: of the columns of state and constant the derivative at fixed phase
    /// is −(h/Ω) A z, all else is unchanged.
    pub fn scale_rates(&mut self, fixed: usize, ratio: f64) {
        self.rate_full
            .iter_mut()
            .take(fixed)
            .for_each(|value| *value *= ratio);
        self.rate_terms
            .iter_mut()
            .take(fixed * TERMS)
            .for_each(|value| *value *= ratio);
    }

    /// Computes the columns from `first` on, with what the guards see of them and the sum `full` of each. Continuation does
    /// this for every frequency it visits, so the common small sizes are compiled with their loops unrolled.
    pub fn tabulate(&mut self, step: &mut Tabulation<'_>, first: usize, work: &mut Work) {
        let layout = &step.generator.layout;
        match (layout.coordinates, layout.internals, layout.orders.len()) {
            (1, 0, 1) => self.tabulate_sized(1, 0, 1, step, first, work),
            (2, 0, 1) => self.tabulate_sized(2, 0, 1, step, first, work),
            (3, 0, 1) => self.tabulate_sized(3, 0, 1, step, first, work),
            (n, internals, orders) => self.tabulate_sized(n, internals, orders, step, first, work),
        }
    }

    #[inline(always)]
    fn tabulate_sized(
        &mut self,
        n: usize,
        internals: usize,
        orders: usize,
        step: &mut Tabulation<'_>,
        first: usize,
        work: &mut Work,
    ) {
        let nx = 2 * n + internals;
        let nz = nx + 1 + 2 * orders;
        let (term, next) = (&mut work.term[..nz], &mut work.next[..nz]);
        let (variation, next_variation) = (&mut work.variation[..nx], &mut work.next_variation[..nx]);
        let share = step
            .rate
            .map_or(0.0, |rate| rate.frequency / step.generator.frequency);
        for j in first..nz {
            for i in 0..nz {
                term[i] = if i == j { 1.0 } else { 0.0 };
            }
            for value in variation.iter_mut() {
                *value = 0.0;
            }
            let block = j * TERMS * nx..(j + 1) * TERMS * nx;
            let terms = &mut self.terms[block.clone()];
            terms[..nx].copy_from_slice(&term[..nx]);
            for guard in step.guards.iter_mut() {
                guard.taylor[j][0] = guard.guard.row[j];
            }
            for k in 1..TERMS {
                let factor = step.length / k as f64;
                if let Some(rate) = step.rate {
                    step.generator
                        .apply_to_state_sized(n, internals, orders, variation, next_variation);
                    rate.add_source(term, next_variation, n);
                }
                step.generator.apply_sized(n, internals, orders, term, next);
                for i in 0..nz {
                    term[i] = factor * next[i];
                }
                for i in 0..nx {
                    terms[k * nx + i] = term[i];
                }
                for guard in step.guards.iter_mut() {
                    // Only a force that holds its port depends on the load's part of the state.
                    let length = if guard.guard.on_load { nz } else { nx };
                    let row = &guard.guard.row[..length];
                    let mut sum = 0.0;
                    for i in 0..length {
                        sum = multiply_add(row[i], term[i], sum);
                    }
                    guard.taylor[j][k] = sum;
                }
                if step.rate.is_some() {
                    // W_k = (h/k) (A W_{k−1} + A_p Y_{k−1}) − (Ω_p/Ω) Y_k, with Y the terms of the state.
                    let rate_terms = &mut self.rate_terms[block.clone()];
                    for i in 0..nx {
                        variation[i] = factor * next_variation[i] - share * term[i];
                        rate_terms[k * nx + i] = variation[i];
                    }
                }
            }
            let column = j * nx..(j + 1) * nx;
            horner(&self.terms[block.clone()], 1.0, &mut step.full[column.clone()]);
            if step.rate.is_some() {
                horner(&self.rate_terms[block], 1.0, &mut self.rate_full[column]);
            }
        }
    }

    /// The mechanical state over the step as a polynomial.
    pub fn polynomial(&self, z: &[f64], out: &mut [f64]) {
        combine(&self.terms, z, out);
    }

    /// The derivative of that polynomial with respect to the parameter.
    pub fn rate_polynomial(&self, z: &[f64], out: &mut [f64]) {
        combine(&self.rate_terms, z, out);
    }

    /// The derivative of the end of a full step.
    pub fn rate_full(&self, z: &[f64], out: &mut [f64]) {
        combine(&self.rate_full, z, out);
    }

    /// The mechanical part of the transition over a share of the step, by columns.
    pub fn transition(&self, share: f64, state: usize, out: &mut [f64]) {
        for (column, block) in out
            .chunks_exact_mut(state)
            .zip(self.terms.chunks_exact(TERMS * state))
        {
            horner(block, share, column);
        }
    }
}

/// What a table is made from, and what it fills besides itself.
pub(super) struct Tabulation<'a> {
    pub generator: &'a Generator,
    pub rate: Option<&'a Rate>,
    /// Length of the step.
    pub length: f64,
    pub guards: &'a mut [GuardMap],
    /// `exp(A h)` by columns.
    pub full: &'a mut [f64],
}
