//! The linear motion within a joint regime of all elements, `z' = A z` with
//! `z = (q, v, ζ, 1, cos k₁Ωt, sin k₁Ωt, …)` (theory 05 §1, §3.1).
//!
//! Constant and harmonic loads need no particular solution in this form, and a singular stiffness (a free accessory) is no
//! special case.

use slackside_linalg::Matrix;
use slackside_numerics::multiply_add;

/// Sizes of the augmented state.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    /// Number of coordinates `n`.
    pub coordinates: usize,
    /// Number of internal states `m` of the elements.
    pub internals: usize,
    /// Orders of the load's harmonics.
    pub orders: Vec<usize>,
}

impl Layout {
    /// Length of the mechanical state `(q, v, ζ)`.
    pub fn state(&self) -> usize {
        2 * self.coordinates + self.internals
    }

    /// Length of the augmented state.
    pub fn augmented(&self) -> usize {
        self.state() + 1 + 2 * self.orders.len()
    }

    /// Writes the load's part `(1, cos kΩt, sin kΩt, …)` of the augmented state at phase `Ωt`.
    pub fn set_phase(&self, z: &mut [f64], phase: f64) {
        let mut at = self.state();
        z[at] = 1.0;
        for &order in &self.orders {
            let (sin, cos) = (order as f64 * phase).sin_cos();
            z[at + 1] = cos;
            z[at + 2] = sin;
            at += 2;
        }
    }
}

/// `z' = A z` in one joint regime.
#[derive(Debug, Clone)]
pub(crate) struct Generator {
    pub layout: Layout,
    /// Fundamental frequency `Ω`.
    pub frequency: f64,
    /// Rows of `(v', ζ')` on the augmented state, `n + m` rows of `n_z`.
    pub rates: Vec<f64>,
    /// Force of each element as a row on the augmented state.
    pub forces: Vec<Vec<f64>>,
}

impl Generator {
    /// `out = A z`.
    pub fn apply(&self, z: &[f64], out: &mut [f64]) {
        let layout = &self.layout;
        self.apply_sized(layout.coordinates, layout.internals, layout.orders.len(), z, out);
    }

    /// [`Self::apply`] for sizes that the caller knows: constants there become unrolled loops here.
    #[inline(always)]
    pub fn apply_sized(&self, n: usize, internals: usize, orders: usize, z: &[f64], out: &mut [f64]) {
        let nx = 2 * n + internals;
        let nz = nx + 1 + 2 * orders;
        let (z, out) = (&z[..nz], &mut out[..nz]);
        out[..n].copy_from_slice(&z[n..2 * n]);
        for i in 0..n + internals {
            let row = &self.rates[i * nz..(i + 1) * nz];
            let mut sum = 0.0;
            for j in 0..nz {
                sum = multiply_add(row[j], z[j], sum);
            }
            out[n + i] = sum;
        }
        out[nx] = 0.0;
        for (k, &order) in self.layout.orders[..orders].iter().enumerate() {
            let rate = order as f64 * self.frequency;
            let at = nx + 1 + 2 * k;
            out[at] = -rate * z[at + 1];
            out[at + 1] = rate * z[at];
        }
    }

    /// [`Self::apply`] for many coordinates: every row is summed in several independent parts.
    pub fn apply_wide(&self, z: &[f64], out: &mut [f64]) {
        let (n, nx, nz) = (
            self.layout.coordinates,
            self.layout.state(),
            self.layout.augmented(),
        );
        out[..n].copy_from_slice(&z[n..2 * n]);
        for (row, value) in self.rates.chunks_exact(nz).zip(&mut out[n..nx]) {
            *value = sum_of_products(row, z);
        }
        out[nx] = 0.0;
        for (k, &order) in self.layout.orders.iter().enumerate() {
            let rate = order as f64 * self.frequency;
            let at = nx + 1 + 2 * k;
            out[at] = -rate * z[at + 1];
            out[at + 1] = rate * z[at];
        }
    }

    /// Turns the harmonic part of `z` by a time.
    pub fn rotate(&self, z: &mut [f64], time: f64) {
        let mut at = self.layout.state();
        for &order in &self.layout.orders {
            let (sin, cos) = (order as f64 * self.frequency * time).sin_cos();
            let (c, s) = (z[at + 1], z[at + 2]);
            z[at + 1] = c * cos - s * sin;
            z[at + 2] = s * cos + c * sin;
            at += 2;
        }
    }

    /// The mechanical block of `A` applied to a mechanical state, for sizes that the caller knows.
    #[inline(always)]
    pub fn apply_to_state_sized(
        &self,
        n: usize,
        internals: usize,
        orders: usize,
        x: &[f64],
        out: &mut [f64],
    ) {
        let nx = 2 * n + internals;
        let nz = nx + 1 + 2 * orders;
        let (x, out) = (&x[..nx], &mut out[..nx]);
        out[..n].copy_from_slice(&x[n..2 * n]);
        for i in 0..n + internals {
            let row = &self.rates[i * nz..(i + 1) * nz];
            let mut sum = 0.0;
            for j in 0..nx {
                sum = multiply_add(row[j], x[j], sum);
            }
            out[n + i] = sum;
        }
    }

    /// The mechanical block of `A`, acting on `(q, v, ζ)`.
    pub fn state_matrix(&self) -> Matrix {
        let n = self.layout.coordinates;
        let (nx, nz) = (self.layout.state(), self.layout.augmented());
        let mut a = Matrix::zeros(nx, nx);
        for i in 0..n {
            a[(i, n + i)] = 1.0;
        }
        for i in n..nx {
            let row = (i - n) * nz;
            a.row_mut(i).copy_from_slice(&self.rates[row..row + nx]);
        }
        a
    }
}

/// Parts in which a long sum is formed, to fill the vector units.
const PARTS: usize = 8;

/// `Σ a_i b_i` in [`PARTS`] independent parts.
#[inline]
fn sum_of_products(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; PARTS];
    let (long_a, long_b) = (a.chunks_exact(PARTS), b.chunks_exact(PARTS));
    let rest: f64 = long_a
        .remainder()
        .iter()
        .zip(long_b.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in long_a.zip(long_b) {
        for i in 0..PARTS {
            sums[i] = multiply_add(x[i], y[i], sums[i]);
        }
    }
    rest + sums.iter().sum::<f64>()
}
