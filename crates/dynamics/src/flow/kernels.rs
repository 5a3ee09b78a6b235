//! Kernels of the step tables: sums of columns and Horner's rule, in registers.

use slackside_numerics::multiply_add;

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

/// `out = Σ_k s^k block_k` over the Taylor blocks of the length of `out`.
#[inline]
pub(super) fn horner(blocks: &[f64], s: f64, out: &mut [f64]) {
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
pub(super) fn vary(matrix: &[f64], variations: &mut [f64], state: &mut [f64]) {
    for column in variations.chunks_exact_mut(state.len()) {
        combine(matrix, column, state);
        column.copy_from_slice(state);
    }
}

/// Adds a vector to the last column.
#[inline]
pub(super) fn add_to_last(variations: &mut [f64], state: &[f64]) {
    let start = variations.len() - state.len();
    for (sum, value) in variations[start..].iter_mut().zip(state) {
        *sum += value;
    }
}

/// `out += factor · Σ_i row_i · rows_i`, the rows of length `width` one after another.
#[inline]
pub(super) fn add_combination(row: &[f64], rows: &[f64], width: usize, factor: f64, out: &mut [f64]) {
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
