//! One step of the exact flow within a regime, tabulated (theory 05 §3.2).
//!
//! With `h ≤ 2/ρ(A)` the step is a Taylor polynomial of 24 terms to rounding. Tabulated per regime are the terms
//! `(A h)^k / k!`, their derivatives with respect to the parameter, and for every guard the linear map from the state to
//! the guard's Taylor coefficients over the step. Columns that belong to the state and the constant do not depend on the
//! frequency of the load; when it changes only those of the harmonics are computed anew.
//!
//! Columns stand one after another, so that every evaluation is a sum of contiguous blocks.

use super::generator::{Generator, GuardRow};
use super::{FlowError, Rate};
use slackside_linalg::{LinalgError, Matrix, eigenvalues};
use slackside_numerics::multiply_add;
use slackside_numerics::polynomial::{Coefficients, REACH, TERMS};

/// A guard with its Taylor table.
#[derive(Debug, Clone)]
pub(crate) struct GuardMap {
    pub guard: GuardRow,
    /// Coefficients per entry of the augmented state.
    pub taylor: Vec<Coefficients>,
    /// Position of the regime after the transition in the flow's store, once it is known.
    pub next: Option<usize>,
}

impl GuardMap {
    /// Taylor coefficients of the guard over one full step from `z`.
    #[inline]
    pub fn coefficients(&self, z: &[f64]) -> Coefficients {
        let mut c = [0.0; TERMS];
        for (column, &value) in self.taylor.iter().zip(z) {
            for k in 0..TERMS {
                c[k] = multiply_add(value, column[k], c[k]);
            }
        }
        c
    }
}

/// The tabulated step of one joint regime.
#[derive(Debug, Clone)]
pub(crate) struct StepMap {
    /// Number of the joint regime.
    pub joint: usize,
    pub generator: Generator,
    /// Step length in time.
    pub step: f64,
    pub guards: Vec<GuardMap>,
    /// Spectral radius of the mechanical part.
    radius: f64,
    /// `(A h)^k / k!`, rows of the mechanical state: `n_z` columns of [`TERMS`] blocks of its length.
    terms: Vec<f64>,
    /// Derivatives of `terms` at fixed phases, laid out alike; empty without a rate.
    rate_terms: Vec<f64>,
    /// `Φ = exp(A h)`, the sum of `terms`: `n_z` columns.
    full: Vec<f64>,
    /// The sum of `rate_terms`.
    rate_full: Vec<f64>,
    /// The mechanical part of `Φ^(2^k)`, made when many steps are taken at once.
    powers: Vec<Vec<f64>>,
    /// `(cos, sin)` of each order's phase over a full step.
    rotation: Vec<(f64, f64)>,
    rate: Option<Rate>,
}

impl StepMap {
    pub fn new(
        joint: usize,
        generator: Generator,
        guards: Vec<GuardRow>,
        rate: Option<Rate>,
        work: &mut Work,
    ) -> Result<Self, FlowError> {
        let radius = spectral_radius(&generator.state_matrix())?;
        let guards = guards
            .into_iter()
            .map(|guard| GuardMap {
                taylor: vec![[0.0; TERMS]; guard.row.len()],
                guard,
                next: None,
            })
            .collect();
        let layout = &generator.layout;
        let size = layout.augmented() * layout.state();
        let rate_size = if rate.is_some() { size } else { 0 };
        let mut map = Self {
            joint,
            step: 0.0,
            guards,
            radius,
            terms: vec![0.0; size * TERMS],
            rate_terms: vec![0.0; rate_size * TERMS],
            full: vec![0.0; size],
            rate_full: vec![0.0; rate_size],
            powers: Vec::new(),
            rotation: vec![(1.0, 0.0); layout.orders.len()],
            rate,
            generator,
        };
        map.tabulate_all(work);
        Ok(map)
    }

    /// Adopts another frequency of the load, the matrices being unchanged.
    pub fn set_frequency(&mut self, frequency: f64, work: &mut Work) {
        let before = self.generator.frequency;
        self.generator.frequency = frequency;
        if self.step * self.fastest_load() > REACH {
            self.tabulate_all(work);
            return;
        }
        // Columns of state and constant: the derivative at fixed phase is −(h/Ω) A z, all else is unchanged.
        let layout = &self.generator.layout;
        let fixed = (layout.state() + 1) * layout.state();
        let ratio = before / frequency;
        self.rate_full
            .iter_mut()
            .take(fixed)
            .for_each(|value| *value *= ratio);
        self.rate_terms
            .iter_mut()
            .take(fixed * TERMS)
            .for_each(|value| *value *= ratio);
        self.tabulate(layout.state() + 1, work);
    }

    /// Largest circular frequency of the load.
    fn fastest_load(&self) -> f64 {
        self.generator.layout.orders.last().copied().unwrap_or(1) as f64 * self.generator.frequency
    }

    fn tabulate_all(&mut self, work: &mut Work) {
        self.powers.clear();
        // A fast load is allowed to become faster yet: a rising frequency would otherwise end here every time.
        self.step = REACH / self.radius.max(1.3 * self.fastest_load());
        self.tabulate(0, work);
    }

    /// Computes the columns from `first` on. Continuation does this for every frequency it visits, so the common small
    /// sizes are compiled with their loops unrolled.
    fn tabulate(&mut self, first: usize, work: &mut Work) {
        let layout = &self.generator.layout;
        match (layout.coordinates, layout.internals, layout.orders.len()) {
            (1, 0, 1) => self.tabulate_sized(1, 0, 1, first, work),
            (2, 0, 1) => self.tabulate_sized(2, 0, 1, first, work),
            (3, 0, 1) => self.tabulate_sized(3, 0, 1, first, work),
            (n, ..) if n > 4 => self.tabulate_wide(first),
            (n, internals, orders) => self.tabulate_sized(n, internals, orders, first, work),
        }
    }

    #[inline(always)]
    fn tabulate_sized(&mut self, n: usize, internals: usize, orders: usize, first: usize, work: &mut Work) {
        let nx = 2 * n + internals;
        let nz = nx + 1 + 2 * orders;
        for (&order, rotation) in self.generator.layout.orders.iter().zip(&mut self.rotation) {
            let (sin, cos) = (order as f64 * self.generator.frequency * self.step).sin_cos();
            *rotation = (cos, sin);
        }
        let (term, next) = (&mut work.term[..nz], &mut work.next[..nz]);
        let (variation, next_variation) = (&mut work.variation[..nx], &mut work.next_variation[..nx]);
        let share = self
            .rate
            .as_ref()
            .map_or(0.0, |rate| rate.frequency / self.generator.frequency);
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
            for guard in &mut self.guards {
                guard.taylor[j][0] = guard.guard.row[j];
            }
            for k in 1..TERMS {
                let factor = self.step / k as f64;
                if let Some(rate) = &self.rate {
                    self.generator
                        .apply_to_state_sized(n, internals, orders, variation, next_variation);
                    rate.add_source(term, next_variation, n);
                }
                self.generator.apply_sized(n, internals, orders, term, next);
                for i in 0..nz {
                    term[i] = factor * next[i];
                }
                for i in 0..nx {
                    terms[k * nx + i] = term[i];
                }
                for guard in &mut self.guards {
                    // Only a force that holds its port depends on the load's part of the state.
                    let length = if guard.guard.on_load { nz } else { nx };
                    let row = &guard.guard.row[..length];
                    let mut sum = 0.0;
                    for i in 0..length {
                        sum = multiply_add(row[i], term[i], sum);
                    }
                    guard.taylor[j][k] = sum;
                }
                if self.rate.is_some() {
                    // W_k = (h/k) (A W_{k−1} + A_p Y_{k−1}) − (Ω_p/Ω) Y_k, with Y the terms of the state.
                    let rate_terms = &mut self.rate_terms[block.clone()];
                    for i in 0..nx {
                        variation[i] = factor * next_variation[i] - share * term[i];
                        rate_terms[k * nx + i] = variation[i];
                    }
                }
            }
            let column = j * nx..(j + 1) * nx;
            horner(&self.terms[block.clone()], 1.0, &mut self.full[column.clone()]);
            if self.rate.is_some() {
                horner(&self.rate_terms[block], 1.0, &mut self.rate_full[column]);
            }
        }
    }

    /// [`Self::tabulate`] for many coordinates: all columns at once, term by term, so that the inner loop runs over columns.
    fn tabulate_wide(&mut self, first: usize) {
        let layout = &self.generator.layout;
        let (n, nx, nz) = (layout.coordinates, layout.state(), layout.augmented());
        for (&order, rotation) in layout.orders.iter().zip(&mut self.rotation) {
            let (sin, cos) = (order as f64 * self.generator.frequency * self.step).sin_cos();
            *rotation = (cos, sin);
        }
        let width = nz - first;
        // Rows of the current term: entry (i, j) belongs to column `first + j`.
        let mut term = vec![0.0; nz * width];
        for j in 0..width {
            term[(first + j) * width + j] = 1.0;
        }
        let mut next = vec![0.0; nz * width];
        let mut variation = vec![0.0; if self.rate.is_some() { nx * width } else { 0 }];
        let mut next_variation = variation.clone();
        let share = self
            .rate
            .as_ref()
            .map_or(0.0, |rate| rate.frequency / self.generator.frequency);
        self.store_term(0, first, &term);
        for k in 1..TERMS {
            let factor = self.step / k as f64;
            multiply_rates(&self.generator.rates, &term, n, nz, width, factor, &mut next);
            let mut at = nx + 1;
            next[nx * width..at * width].fill(0.0);
            for &order in &self.generator.layout.orders {
                let rate = factor * order as f64 * self.generator.frequency;
                for j in 0..width {
                    next[at * width + j] = -rate * term[(at + 1) * width + j];
                    next[(at + 1) * width + j] = rate * term[at * width + j];
                }
                at += 2;
            }
            if let Some(rate) = &self.rate {
                // W_k = (h/k) (A W_{k−1} + A_p Y_{k−1}) − (Ω_p/Ω) Y_k, with Y the terms of the state.
                multiply_block(
                    &self.generator.rates,
                    &variation,
                    (n, nx, nz),
                    width,
                    factor,
                    &mut next_variation,
                );
                if let Some(rows) = &rate.rates {
                    for (row, out) in rows
                        .chunks_exact(nz)
                        .zip(next_variation[n * width..].chunks_exact_mut(width))
                    {
                        add_combination(row, &term, width, factor, out);
                    }
                }
                for (value, y) in next_variation.iter_mut().zip(&next) {
                    *value -= share * y;
                }
                std::mem::swap(&mut variation, &mut next_variation);
                for j in 0..width {
                    let column = ((first + j) * TERMS + k) * nx;
                    for i in 0..nx {
                        self.rate_terms[column + i] = variation[i * width + j];
                    }
                }
            }
            std::mem::swap(&mut term, &mut next);
            self.store_term(k, first, &term);
        }
        for j in first..nz {
            let block = j * TERMS * nx..(j + 1) * TERMS * nx;
            let column = j * nx..(j + 1) * nx;
            horner(&self.terms[block.clone()], 1.0, &mut self.full[column.clone()]);
            if self.rate.is_some() {
                horner(&self.rate_terms[block], 1.0, &mut self.rate_full[column]);
            }
        }
    }

    /// Stores term `k` of the columns from `first` on, given by rows, and what the guards see of it.
    fn store_term(&mut self, k: usize, first: usize, term: &[f64]) {
        let (nx, nz) = (self.generator.layout.state(), self.generator.layout.augmented());
        let width = nz - first;
        for j in 0..width {
            let column = ((first + j) * TERMS + k) * nx;
            for i in 0..nx {
                self.terms[column + i] = term[i * width + j];
            }
        }
        let mut seen = vec![0.0; width];
        for guard in &mut self.guards {
            seen.fill(0.0);
            add_combination(&guard.guard.row, term, width, 1.0, &mut seen);
            for (taylor, value) in guard.taylor[first..].iter_mut().zip(&seen) {
                taylor[k] = *value;
            }
        }
    }

    /// Derivative of a guard's value at `z` with respect to the parameter; zero without a rate.
    pub fn guard_rate(&self, number: usize, z: &[f64]) -> f64 {
        let row = self.rate.as_ref().and_then(|rate| rate.guards.get(number));
        row.map_or(0.0, |row| slackside_linalg::dot(row, z))
    }

    /// One full step: `z ← exp(A h) z`.
    #[inline]
    pub fn advance_full(&self, z: &mut [f64], work: &mut Work) {
        let nx = work.state.len();
        combine(&self.full, z, &mut work.state);
        z[..nx].copy_from_slice(&work.state);
        let mut at = nx;
        for &(cos, sin) in &self.rotation {
            let (c, s) = (z[at + 1], z[at + 2]);
            z[at + 1] = c * cos - s * sin;
            z[at + 2] = s * cos + c * sin;
            at += 2;
        }
    }

    /// A full step of the variations, columns of the state's length, of which the last is the derivative with respect to the parameter if
    /// there is a rate. `z` is the augmented state before the step.
    pub fn vary_full(&self, z: &[f64], variations: &mut [f64], work: &mut Work) {
        let nx = work.state.len();
        vary(&self.full[..nx * nx], variations, &mut work.state);
        if !self.rate_full.is_empty() {
            combine(&self.rate_full, z, &mut work.state);
            add_to_last(variations, &work.state);
        }
    }

    /// Whether [`Self::vary_steps`] may take the place of as many calls of [`Self::vary_full`]: the variations do not depend on
    /// the state, and there are enough of them to pay.
    pub fn varies_in_powers(&self) -> bool {
        self.rate.is_none() && self.generator.layout.coordinates > 4
    }

    /// Many full steps of the variations at once, by powers of the step's matrix.
    pub fn vary_steps(&mut self, count: usize, variations: &mut [f64], work: &mut Work) {
        let nx = work.state.len();
        let mut rest = count;
        let mut exponent = 0;
        while rest > 0 {
            if self.powers.len() <= exponent {
                let power = match self.powers.last() {
                    None => self.full[..nx * nx].to_vec(),
                    Some(last) => {
                        let mut square = last.clone();
                        vary(last, &mut square, &mut work.state);
                        square
                    }
                };
                self.powers.push(power);
            }
            if rest % 2 == 1 {
                vary(&self.powers[exponent], variations, &mut work.state);
            }
            rest /= 2;
            exponent += 1;
        }
    }

    /// The mechanical state over the step as a polynomial in `s ∈ [0, 1]`: [`TERMS`] blocks, in `work`.
    #[inline]
    pub fn polynomial<'a>(&self, z: &[f64], work: &'a mut Work) -> &'a [f64] {
        combine(&self.terms, z, &mut work.polynomial);
        &work.polynomial
    }

    /// A partial step of `share ≤ 1` of the step. The harmonic part of `z` is left to the caller.
    #[inline]
    pub fn advance_partial(&self, z: &mut [f64], share: f64, work: &mut Work) {
        combine(&self.terms, z, &mut work.polynomial);
        let nx = work.state.len();
        horner(&work.polynomial, share, &mut z[..nx]);
    }

    /// The mechanical state after `share` of the step from `z`, into `out`.
    pub fn state_at(&self, z: &[f64], share: f64, work: &mut Work, out: &mut [f64]) {
        combine(&self.terms, z, &mut work.polynomial);
        horner(&work.polynomial, share, &mut out[..work.state.len()]);
    }

    /// A partial step of the variations, as [`Self::vary_full`].
    pub fn vary_partial(&self, z: &[f64], share: f64, variations: &mut [f64], work: &mut Work) {
        let nx = work.state.len();
        for (column, block) in work
            .matrix
            .chunks_exact_mut(nx)
            .zip(self.terms.chunks_exact(TERMS * nx))
        {
            horner(block, share, column);
        }
        vary(&work.matrix, variations, &mut work.state);
        if !self.rate_terms.is_empty() {
            combine(&self.rate_terms, z, &mut work.polynomial);
            horner(&work.polynomial, share, &mut work.state);
            add_to_last(variations, &work.state);
        }
    }

    /// Taylor coefficients over the full step of a measure, given as a row on the augmented state, from the state's
    /// polynomial.
    pub fn measure(&self, row: &[f64], z: &[f64], polynomial: &[f64]) -> Coefficients {
        let nx = self.generator.layout.state();
        let mut c = [0.0; TERMS];
        // Rows are sparse: most measures see one or two entries of the state.
        for (i, &factor) in row[..nx].iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
            for (value, block) in c.iter_mut().zip(polynomial.chunks_exact(nx)) {
                *value += factor * block[i];
            }
        }
        c[0] += row[nx];
        for (k, &order) in self.generator.layout.orders.iter().enumerate() {
            let at = nx + 1 + 2 * k;
            let (on_cosine, on_sine) = (row[at], row[at + 1]);
            if on_cosine == 0.0 && on_sine == 0.0 {
                continue;
            }
            let angle = order as f64 * self.generator.frequency * self.step;
            let (mut cosine, mut sine) = (z[at], z[at + 1]);
            for (degree, value) in c.iter_mut().enumerate() {
                *value += on_cosine * cosine + on_sine * sine;
                let factor = angle / (degree as f64 + 1.0);
                (cosine, sine) = (-factor * sine, factor * cosine);
            }
        }
        c
    }
}

/// `out = factor · A · term` for the mechanical rows: rates are copied, the others multiplied. Blocks of rows of `width`.
fn multiply_rates(
    rates: &[f64],
    term: &[f64],
    n: usize,
    nz: usize,
    width: usize,
    factor: f64,
    out: &mut [f64],
) {
    for (o, v) in out[..n * width].iter_mut().zip(&term[n * width..2 * n * width]) {
        *o = factor * v;
    }
    for (row, out) in rates
        .chunks_exact(nz)
        .zip(out[n * width..].chunks_exact_mut(width))
    {
        out.fill(0.0);
        add_combination(row, term, width, factor, out);
    }
}

/// The same for the mechanical block of `A`; sizes are coordinates, state, augmented state.
fn multiply_block(
    rates: &[f64],
    term: &[f64],
    (n, nx, nz): (usize, usize, usize),
    width: usize,
    factor: f64,
    out: &mut [f64],
) {
    for (o, v) in out[..n * width].iter_mut().zip(&term[n * width..2 * n * width]) {
        *o = factor * v;
    }
    for (row, out) in rates
        .chunks_exact(nz)
        .zip(out[n * width..].chunks_exact_mut(width))
    {
        out.fill(0.0);
        add_combination(&row[..nx], term, width, factor, out);
    }
}

/// `out += factor · Σ_i row_i · rows_i`, the rows of length `width` one after another.
#[inline]
fn add_combination(row: &[f64], rows: &[f64], width: usize, factor: f64, out: &mut [f64]) {
    for (weight, values) in row.iter().zip(rows.chunks_exact(width)) {
        if *weight == 0.0 {
            continue;
        }
        let weight = factor * weight;
        for (o, v) in out.iter_mut().zip(values) {
            *o = multiply_add(weight, *v, *o);
        }
    }
}

/// Largest size of a matrix whose spectral radius is computed from its eigenvalues.
const EIGENVALUES_UP_TO: usize = 8;

/// The spectral radius, or for larger matrices the bound `‖A^128‖^(1/128)` on it by seven squarings, which is a few percent
/// too large and several times cheaper.
fn spectral_radius(matrix: &Matrix) -> Result<f64, FlowError> {
    if matrix.rows() <= EIGENVALUES_UP_TO {
        let values = eigenvalues(matrix)?;
        return Ok(values.iter().map(|v| v.norm()).fold(0.0, f64::max));
    }
    if !matrix.is_finite() {
        return Err(LinalgError::NotFinite.into());
    }
    let mut power = matrix.clone();
    let mut square = matrix.clone();
    // The power is carried as `e^logarithm · power`, against overflow.
    let (mut logarithm, mut exponent) = (0.0, 1.0);
    for _ in 0..7 {
        let norm = power.norm_infinity();
        if norm == 0.0 {
            return Ok(0.0);
        }
        power.as_mut_slice().iter_mut().for_each(|value| *value /= norm);
        power.product_into(&power, &mut square);
        std::mem::swap(&mut power, &mut square);
        logarithm = 2.0 * (logarithm + norm.ln());
        exponent *= 2.0;
    }
    let norm = power.norm_infinity();
    Ok(if norm == 0.0 {
        0.0
    } else {
        ((logarithm + norm.ln()) / exponent).exp()
    })
}

/// Entries that are summed together in registers.
const BLOCK: usize = 16;

/// `out = Σ_j z_j column_j`, columns one after another.
#[inline]
pub(crate) fn combine(columns: &[f64], z: &[f64], out: &mut [f64]) {
    let length = out.len();
    let mut start = 0;
    while length - start >= BLOCK {
        combine_fixed::<BLOCK>(columns, start, z, out);
        start += BLOCK;
    }
    while length - start >= 4 {
        combine_fixed::<4>(columns, start, z, out);
        start += 4;
    }
    while start < length {
        combine_fixed::<1>(columns, start, z, out);
        start += 1;
    }
}

/// [`combine`] for the `N` entries from `start` on, summed in registers.
#[inline]
fn combine_fixed<const N: usize>(columns: &[f64], start: usize, z: &[f64], out: &mut [f64]) {
    let length = out.len();
    let mut sums = [0.0; N];
    let columns = columns
        .chunks_exact(length)
        .filter_map(|column| column[start..].first_chunk::<N>());
    for (column, &value) in columns.zip(z) {
        for i in 0..N {
            sums[i] = multiply_add(value, column[i], sums[i]);
        }
    }
    out[start..start + N].copy_from_slice(&sums);
}

/// `out = Σ_k s^k block_k` over [`TERMS`] blocks of the length of `out`.
#[inline]
fn horner(blocks: &[f64], s: f64, out: &mut [f64]) {
    match out.len() {
        2 => horner_fixed::<2>(blocks, s, out),
        4 => horner_fixed::<4>(blocks, s, out),
        6 => horner_fixed::<6>(blocks, s, out),
        8 => horner_fixed::<8>(blocks, s, out),
        length => {
            out.fill(0.0);
            for block in blocks.chunks_exact(length).rev() {
                for (sum, a) in out.iter_mut().zip(block) {
                    *sum = *sum * s + a;
                }
            }
        }
    }
}

/// [`horner`] for blocks whose length the compiler knows: even and odd terms in two independent chains.
#[inline]
fn horner_fixed<const N: usize>(blocks: &[f64], s: f64, out: &mut [f64]) {
    let square = s * s;
    let (mut even, mut odd) = ([0.0; N], [0.0; N]);
    for pair in blocks.chunks_exact(2 * N).rev() {
        for i in 0..N {
            even[i] = multiply_add(even[i], square, pair[i]);
            odd[i] = multiply_add(odd[i], square, pair[N + i]);
        }
    }
    for i in 0..N {
        out[i] = even[i] + s * odd[i];
    }
}

/// `variation ← matrix · variation` for every column of `variations`.
#[inline]
fn vary(matrix: &[f64], variations: &mut [f64], state: &mut [f64]) {
    for column in variations.chunks_exact_mut(state.len()) {
        combine(matrix, column, state);
        column.copy_from_slice(state);
    }
}

#[inline]
fn add_to_last(variations: &mut [f64], state: &[f64]) {
    let start = variations.len() - state.len();
    for (sum, value) in variations[start..].iter_mut().zip(state) {
        *sum += value;
    }
}

/// Space for steps, allocated once.
#[derive(Debug, Clone)]
pub(crate) struct Work {
    term: Vec<f64>,
    next: Vec<f64>,
    variation: Vec<f64>,
    next_variation: Vec<f64>,
    state: Vec<f64>,
    polynomial: Vec<f64>,
    matrix: Vec<f64>,
}

impl Work {
    pub fn new(state: usize, augmented: usize) -> Self {
        Self {
            term: vec![0.0; augmented],
            next: vec![0.0; augmented],
            variation: vec![0.0; state],
            next_variation: vec![0.0; state],
            state: vec![0.0; state],
            polynomial: vec![0.0; state * TERMS],
            matrix: vec![0.0; state * state],
        }
    }
}
