//! One step of the exact flow within a regime, tabulated (theory 05 §3.2).
//!
//! With `h ≤ 2/ρ(A)` the step is a Taylor polynomial of 24 terms to rounding. Tabulated per regime are the transition over a
//! full step, the terms from which partial steps and their derivatives with respect to the parameter follow (by columns for
//! few coordinates, by terms for many), and for every guard the linear map from the state to the guard's Taylor coefficients
//! over the step. Columns that belong to the state and the constant do not depend on the frequency of the load; when it
//! changes only those of the harmonics are computed anew.

use super::column_tables::{ColumnTables, Tabulation};
use super::generator::Generator;
use super::kernels::{add_to_last, combine, horner, vary};
use super::regime_factory::GuardRow;
use super::spectral_radius::spectral_radius;
use super::term_tables::{self, TermTables};
use super::{FlowError, Rate};
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

/// Number of coordinates from which on tables by terms are used.
const MANY: usize = 5;

#[derive(Debug, Clone)]
enum Tables {
    Columns(ColumnTables),
    Terms(TermTables),
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
    /// Spectral radius of the mechanical part, or a bound on it.
    radius: f64,
    tables: Tables,
    /// `Φ = exp(A h)`: `n_z` columns of the mechanical state.
    full: Vec<f64>,
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
        let (state, augmented) = (layout.state(), layout.augmented());
        let tables = if layout.coordinates < MANY {
            Tables::Columns(ColumnTables::new(state, augmented, rate.is_some()))
        } else {
            Tables::Terms(TermTables::new(state))
        };
        let mut map = Self {
            joint,
            step: 0.0,
            guards,
            radius,
            tables,
            full: vec![0.0; augmented * state],
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
        let layout = &self.generator.layout;
        let first = layout.state() + 1;
        if let Tables::Columns(tables) = &mut self.tables {
            tables.scale_rates(first * layout.state(), before / frequency);
        }
        self.tabulate(first, work);
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

    fn tabulate(&mut self, first: usize, work: &mut Work) {
        for (&order, rotation) in self.generator.layout.orders.iter().zip(&mut self.rotation) {
            let (sin, cos) = (order as f64 * self.generator.frequency * self.step).sin_cos();
            *rotation = (cos, sin);
        }
        let mut tabulation = Tabulation {
            generator: &self.generator,
            rate: self.rate.as_ref(),
            length: self.step,
            guards: &mut self.guards,
            full: &mut self.full,
        };
        match &mut self.tables {
            Tables::Columns(tables) => tables.tabulate(&mut tabulation, first, work),
            Tables::Terms(tables) => tables.tabulate(&mut tabulation, first),
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

    /// A full step of the variations, columns of the state's length, of which the last is the derivative with respect to the
    /// parameter if there is a rate. `z` is the augmented state before the step.
    pub fn vary_full(&self, z: &[f64], variations: &mut [f64], work: &mut Work) {
        let nx = work.state.len();
        vary(&self.full[..nx * nx], variations, &mut work.state);
        let Some(rate) = &self.rate else { return };
        match &self.tables {
            Tables::Columns(tables) => tables.rate_full(z, &mut work.state),
            Tables::Terms(_) => {
                term_tables::rate_polynomial(&self.generator, rate, self.step, z, work);
                horner(&work.polynomial, 1.0, &mut work.state);
            }
        }
        add_to_last(variations, &work.state);
    }

    /// Whether [`Self::vary_steps`] may take the place of as many calls of [`Self::vary_full`]: the variations do not depend on
    /// the state, and there are enough of them to pay.
    pub fn varies_in_powers(&self) -> bool {
        self.rate.is_none() && self.generator.layout.coordinates >= MANY
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
        match &self.tables {
            Tables::Columns(tables) => tables.polynomial(z, &mut work.polynomial),
            Tables::Terms(_) => term_tables::polynomial(&self.generator, self.step, z, work),
        }
        &work.polynomial
    }

    /// A partial step of `share ≤ 1` of the step. The harmonic part of `z` is left to the caller.
    #[inline]
    pub fn advance_partial(&self, z: &mut [f64], share: f64, work: &mut Work) {
        self.polynomial(z, work);
        let nx = work.state.len();
        horner(&work.polynomial, share, &mut z[..nx]);
    }

    /// A partial step of the variations, as [`Self::vary_full`].
    pub fn vary_partial(&self, z: &[f64], share: f64, variations: &mut [f64], work: &mut Work) {
        let nx = work.state.len();
        match &self.tables {
            Tables::Columns(tables) => tables.transition(share, nx, &mut work.matrix),
            Tables::Terms(tables) => tables.transition(share, nx, &mut work.rows, &mut work.matrix),
        }
        vary(&work.matrix, variations, &mut work.state);
        let Some(rate) = &self.rate else { return };
        match &self.tables {
            Tables::Columns(tables) => tables.rate_polynomial(z, &mut work.polynomial),
            Tables::Terms(_) => term_tables::rate_polynomial(&self.generator, rate, self.step, z, work),
        }
        horner(&work.polynomial, share, &mut work.state);
        add_to_last(variations, &work.state);
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

/// Space for steps, allocated once.
#[derive(Debug, Clone)]
pub(crate) struct Work {
    pub(super) term: Vec<f64>,
    pub(super) next: Vec<f64>,
    pub(super) variation: Vec<f64>,
    pub(super) next_variation: Vec<f64>,
    pub(super) state: Vec<f64>,
    pub(super) polynomial: Vec<f64>,
    matrix: Vec<f64>,
    rows: Vec<f64>,
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
            rows: Vec::new(),
        }
    }

    /// The mechanical state at `share` of the step whose polynomial was formed last, into `out`.
    pub fn state_at(&self, share: f64, out: &mut [f64]) {
        horner(&self.polynomial, share, &mut out[..self.state.len()]);
    }
}
