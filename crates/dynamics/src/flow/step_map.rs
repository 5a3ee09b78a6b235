//! One step of the exact flow within a regime, tabulated (theory 05 §3.2).
//!
//! With `h ≤ 2/ρ(A)` the step is a Taylor polynomial of 24 terms to rounding. Tabulated per regime are the full step
//! `Φ = exp(A h)`, its derivative with respect to the parameter, and for every guard the linear map from the state to the
//! guard's Taylor coefficients over the step. Columns that belong to the state and the constant do not depend on the
//! frequency of the load; when it changes only those of the harmonics are computed anew.

use super::generator::{Generator, GuardRow};
use super::{FlowError, Rate};
use slackside_linalg::eigenvalues;
use slackside_numerics::polynomial::{Coefficients, REACH, TERMS};

/// A guard with its Taylor table.
#[derive(Debug, Clone)]
pub(crate) struct GuardMap {
    pub guard: GuardRow,
    /// Coefficients per augmented-state entry, `n_z` blocks of [`TERMS`].
    taylor: Vec<[f64; TERMS]>,
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
                c[k] += value * column[k];
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
    /// Spectral radius of the mechanical part.
    radius: f64,
    pub guards: Vec<GuardMap>,
    /// `Φ` by columns: `n_z` blocks of `2n`.
    full: Vec<f64>,
    /// Derivative of the step at fixed phases, by columns like `full`; empty without a rate.
    rate_full: Vec<f64>,
    /// `(cos, sin)` of each order's phase over a full step.
    rotation: Vec<(f64, f64)>,
    /// Derivative of the acceleration rows with respect to the parameter, if any, and of the frequency.
    rate: Option<Rate>,
}

impl StepMap {
    pub fn new(
        joint: usize,
        generator: Generator,
        guards: Vec<GuardRow>,
        rate: Option<Rate>,
    ) -> Result<Self, FlowError> {
        let radius = eigenvalues(&generator.state_matrix())?
            .iter()
            .map(|v| v.norm())
            .fold(0.0, f64::max);
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
        let mut map = Self {
            joint,
            step: 0.0,
            radius,
            guards,
            full: vec![0.0; size],
            rate_full: if rate.is_some() {
                vec![0.0; size]
            } else {
                Vec::new()
            },
            rotation: vec![(1.0, 0.0); layout.orders.len()],
            rate,
            generator,
        };
        map.tabulate_all();
        Ok(map)
    }

    /// Adopts another frequency of the load, the matrices being unchanged.
    pub fn set_frequency(&mut self, frequency: f64) {
        let before = self.generator.frequency;
        self.generator.frequency = frequency;
        let fastest = self.generator.layout.orders.last().copied().unwrap_or(1) as f64 * frequency;
        if self.step * fastest > REACH {
            self.tabulate_all();
            return;
        }
        // Columns of state and constant: the derivative at fixed phase is −(h/Ω) A z, all else is unchanged.
        let fixed = (self.generator.layout.state() + 1) * self.generator.layout.state();
        for value in self.rate_full.iter_mut().take(fixed) {
            *value *= before / frequency;
        }
        self.tabulate(self.generator.layout.state() + 1);
    }

    fn tabulate_all(&mut self) {
        let layout = &self.generator.layout;
        let fastest = layout.orders.last().copied().unwrap_or(1) as f64 * self.generator.frequency;
        self.step = REACH / self.radius.max(fastest);
        self.tabulate(0);
    }

    /// Computes the columns from `first` on.
    fn tabulate(&mut self, first: usize) {
        let layout = self.generator.layout.clone();
        let (nx, nz) = (layout.state(), layout.augmented());
        for (&order, rotation) in layout.orders.iter().zip(&mut self.rotation) {
            let (sin, cos) = (order as f64 * self.generator.frequency * self.step).sin_cos();
            *rotation = (cos, sin);
        }
        let mut term = vec![0.0; nz];
        let mut next = vec![0.0; nz];
        let mut variation = vec![0.0; nz];
        let mut next_variation = vec![0.0; nz];
        for j in first..nz {
            term.fill(0.0);
            term[j] = 1.0;
            variation.fill(0.0);
            let full = &mut self.full[j * nx..(j + 1) * nx];
            full.copy_from_slice(&term[..nx]);
            for guard in &mut self.guards {
                guard.taylor[j][0] = guard.guard.row[j];
            }
            if let Some(rate) = &self.rate {
                self.rate_full[j * nx..(j + 1) * nx].fill(0.0);
                debug_assert!(
                    rate.acceleration
                        .as_ref()
                        .is_none_or(|rows| rows.len() == nx / 2 * nz)
                );
            }
            for k in 1..TERMS {
                let factor = self.step / k as f64;
                self.generator.apply(&term, &mut next);
                if let Some(rate) = &self.rate {
                    self.generator.apply(&variation, &mut next_variation);
                    next_variation[nx..].fill(0.0);
                    rate.add_source(&term, &mut next_variation, nx);
                    for i in 0..nx {
                        let advanced = factor * next[i];
                        variation[i] =
                            factor * next_variation[i] - rate.frequency / self.generator.frequency * advanced;
                    }
                    for (sum, value) in self.rate_full[j * nx..(j + 1) * nx].iter_mut().zip(&variation) {
                        *sum += value;
                    }
                }
                for (a, b) in term.iter_mut().zip(&next) {
                    *a = factor * b;
                }
                for (sum, value) in self.full[j * nx..(j + 1) * nx].iter_mut().zip(&term) {
                    *sum += value;
                }
                for guard in &mut self.guards {
                    guard.taylor[j][k] = guard.guard.row.iter().zip(&term).map(|(a, b)| a * b).sum();
                }
            }
        }
    }

    /// One full step: `z ← exp(A h) z`; `scratch` has the length of the mechanical state.
    #[inline]
    pub fn advance_full(&self, z: &mut [f64], scratch: &mut [f64]) {
        let nx = scratch.len();
        scratch.fill(0.0);
        for (column, &value) in self.full.chunks_exact(nx).zip(z.iter()) {
            for (sum, a) in scratch.iter_mut().zip(column) {
                *sum += value * a;
            }
        }
        z[..nx].copy_from_slice(scratch);
        let mut at = nx;
        for &(cos, sin) in &self.rotation {
            let (c, s) = (z[at + 1], z[at + 2]);
            z[at + 1] = c * cos - s * sin;
            z[at + 2] = s * cos + c * sin;
            at += 2;
        }
    }

    /// A full step of the variations: `columns` blocks of `2n`, of which the last is the derivative with respect to the
    /// parameter if there is a rate. `z` is the augmented state before the step.
    pub fn vary_full(&self, z: &[f64], variations: &mut [f64], scratch: &mut [f64]) {
        let nx = scratch.len();
        let last = variations.len() - nx;
        for (at, column) in variations.chunks_exact_mut(nx).enumerate() {
            scratch.fill(0.0);
            for (map, &value) in self.full.chunks_exact(nx).zip(column.iter()) {
                for (sum, a) in scratch.iter_mut().zip(map) {
                    *sum += value * a;
                }
            }
            if !self.rate_full.is_empty() && at * nx == last {
                for (map, &value) in self.rate_full.chunks_exact(nx).zip(z) {
                    for (sum, a) in scratch.iter_mut().zip(map) {
                        *sum += value * a;
                    }
                }
            }
            column.copy_from_slice(scratch);
        }
    }

    /// The Taylor terms of the state over a time `duration ≤ h`: calls `take(k, term)` for `k = 1, 2, …` with the term
    /// `(A d)^k z / k!`, until terms are below rounding.
    #[inline]
    pub fn terms(&self, z: &[f64], duration: f64, work: &mut Work, mut take: impl FnMut(usize, &[f64])) {
        let fastest = self
            .radius
            .max(self.generator.layout.orders.last().copied().unwrap_or(0) as f64 * self.generator.frequency);
        work.term.copy_from_slice(z);
        let mut bound = 1.0;
        for k in 1..TERMS {
            let factor = duration / k as f64;
            self.generator.apply(&work.term, &mut work.next);
            for (a, b) in work.term.iter_mut().zip(&work.next) {
                *a = factor * b;
            }
            take(k, &work.term);
            bound *= factor * fastest;
            if bound < 1e-18 {
                break;
            }
        }
    }

    /// A partial step of `duration ≤ h` of state and, unless empty, variations (as in [`Self::vary_full`]). The harmonic
    /// part of `z` is left to the caller.
    pub fn advance_partial(&self, z: &mut [f64], duration: f64, variations: &mut [f64], work: &mut Work) {
        let nx = self.generator.layout.state();
        let fastest = self
            .radius
            .max(self.generator.layout.orders.last().copied().unwrap_or(0) as f64 * self.generator.frequency);
        let with_rate = !variations.is_empty() && self.rate.is_some();
        work.variation.clear();
        work.variation.extend_from_slice(variations);
        work.term.copy_from_slice(z);
        let columns = variations.len() / nx;
        let mut bound = 1.0;
        for k in 1..TERMS {
            let factor = duration / k as f64;
            self.generator.apply(&work.term, &mut work.next);
            for (at, column) in work.variation.chunks_exact_mut(nx).enumerate() {
                self.apply_to_state(column, &mut work.state);
                if with_rate && at + 1 == columns {
                    if let Some(rate) = &self.rate {
                        rate.add_source(&work.term, &mut work.state, nx);
                        let share = rate.frequency / self.generator.frequency;
                        for (value, rate_term) in work.state.iter_mut().zip(&work.next) {
                            *value -= share * rate_term;
                        }
                    }
                }
                for (a, b) in column.iter_mut().zip(&work.state) {
                    *a = factor * b;
                }
            }
            for (a, b) in work.term.iter_mut().zip(&work.next) {
                *a = factor * b;
            }
            for (sum, term) in z[..nx].iter_mut().zip(&work.term) {
                *sum += term;
            }
            for (sum, term) in variations.iter_mut().zip(&work.variation) {
                *sum += term;
            }
            bound *= factor * fastest;
            if bound < 1e-18 {
                break;
            }
        }
    }

    /// The mechanical block of `A` applied to one column.
    #[inline]
    fn apply_to_state(&self, x: &[f64], out: &mut [f64]) {
        let n = self.generator.layout.coordinates;
        let nz = self.generator.layout.augmented();
        out[..n].copy_from_slice(&x[n..]);
        for (row, value) in self.generator.acceleration.chunks_exact(nz).zip(&mut out[n..]) {
            *value = row.iter().zip(x).map(|(a, b)| a * b).sum();
        }
    }
}

/// Space for partial steps, allocated once.
#[derive(Debug, Clone)]
pub(crate) struct Work {
    term: Vec<f64>,
    next: Vec<f64>,
    state: Vec<f64>,
    variation: Vec<f64>,
}

impl Work {
    pub fn new(state: usize, augmented: usize) -> Self {
        Self {
            term: vec![0.0; augmented],
            next: vec![0.0; augmented],
            state: vec![0.0; state],
            variation: Vec::new(),
        }
    }
}
