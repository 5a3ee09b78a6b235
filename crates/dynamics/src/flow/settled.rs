//! The certificate that a motion stays in its regime for ever, and its closed form.
//!
//! In a regime whose linear motion decays, `x(t) = x_c + Re Σ_k X_k e^{ikΩt} + Σ_j v_j c_j e^{μ_j t}`. If for every guard the
//! static value exceeds the sum of the amplitudes of all other terms, no guard is ever reached.

use super::step_map::StepMap;
use slackside_linalg::{Complex, ComplexLu, ComplexMatrix, Eigen, LinalgError, Lu, Matrix, dot, eigen};

/// A regime whose free motion decays, in its eigenvectors.
#[derive(Debug, Clone)]
pub(crate) struct DecayingRegime {
    eigen: Eigen,
    inverse: ComplexLu,
    matrix: Matrix,
    /// `x_c`.
    constant: Vec<f64>,
    /// Per guard: static value, and amplitude per unit of each eigenvector.
    guards: Vec<(f64, Vec<f64>)>,
}

/// The forced motion of such a regime at one frequency.
#[derive(Debug, Clone)]
pub(crate) struct ForcedMotion {
    pub frequency: f64,
    /// `X_k` per order of the load.
    amplitudes: Vec<Vec<Complex>>,
    /// Per guard: sum of the forced amplitudes.
    guards: Vec<f64>,
}

impl DecayingRegime {
    /// `None` if the free motion does not decay, if a guard is a force that depends on the load, or if the eigenvectors are
    /// nearly dependent.
    pub fn new(map: &StepMap) -> Option<Self> {
        let layout = &map.generator.layout;
        let (n, nx, nz) = (layout.coordinates, layout.state(), layout.augmented());
        if map.guards.iter().any(|guard| guard.guard.on_load) {
            return None;
        }
        let matrix = map.generator.state_matrix();
        let eigen = eigen(&matrix).ok()?;
        let fastest = eigen.values.iter().map(|v| v.norm()).fold(0.0, f64::max);
        if eigen.values.iter().any(|value| value.re > -1e-9 * fastest) {
            return None;
        }
        let inverse = eigen.vectors.lu().ok()?;
        let mut load = vec![0.0; nx];
        for i in 0..nx - n {
            load[n + i] = -map.generator.rates[i * nz + nx];
        }
        let constant = Lu::new(&matrix).ok()?.solve(&load);
        let guards: Vec<(f64, Vec<f64>)> = map
            .guards
            .iter()
            .map(|guard| {
                let row = &guard.guard.row;
                let per_vector = (0..nx)
                    .map(|j| {
                        (0..nx)
                            .map(|i| eigen.vectors[(i, j)] * row[i])
                            .sum::<Complex>()
                            .norm()
                    })
                    .collect();
                (dot(&row[..nx], &constant) + row[nx], per_vector)
            })
            .collect();
        let regime = Self {
            eigen,
            inverse,
            matrix,
            constant,
            guards,
        };
        // Nearly dependent eigenvectors would turn rounding into amplitude: a probe shows it.
        let probe = vec![1.0; nx];
        let back = regime.combine(&regime.inverse.solve(&complex(&probe)), 0.0);
        let error = back
            .iter()
            .zip(&probe)
            .fold(0.0_f64, |a, (x, y)| a.max((x - y).abs()));
        (error < 1e-12).then_some(regime)
    }

    /// The forced motion at the map's frequency.
    ///
    /// # Errors
    /// [`LinalgError`] if the load is in resonance with an undamped motion.
    pub fn forced(&self, map: &StepMap) -> Result<ForcedMotion, LinalgError> {
        let layout = &map.generator.layout;
        let (n, nx, nz) = (layout.coordinates, layout.state(), layout.augmented());
        let frequency = map.generator.frequency;
        let mut amplitudes = Vec::with_capacity(layout.orders.len());
        for (k, &order) in layout.orders.iter().enumerate() {
            let mut resolvent = ComplexMatrix::combination(&[(Complex::from(-1.0), &self.matrix)]);
            let mut load = vec![Complex::ZERO; nx];
            for i in 0..nx {
                resolvent[(i, i)] += Complex::new(0.0, order as f64 * frequency);
            }
            for i in 0..nx - n {
                let row = &map.generator.rates[i * nz + nx + 1 + 2 * k..];
                load[n + i] = Complex::new(row[0], -row[1]);
            }
            amplitudes.push(resolvent.lu()?.solve(&load));
        }
        let guards = map
            .guards
            .iter()
            .map(|guard| {
                let along = |x: &Vec<Complex>| {
                    x.iter()
                        .zip(&guard.guard.row)
                        .map(|(a, g)| a * g)
                        .sum::<Complex>()
                        .norm()
                };
                amplitudes.iter().map(along).sum()
            })
            .collect();
        Ok(ForcedMotion {
            frequency,
            amplitudes,
            guards,
        })
    }

    /// Amplitudes `c_j` of the free part of the motion that is at `x` now at phase `phase`, if that motion provably never
    /// leaves the regime.
    pub fn free_amplitudes(
        &self,
        forced: &ForcedMotion,
        orders: &[usize],
        x: &[f64],
        phase: f64,
    ) -> Option<Vec<Complex>> {
        let steady = self.steady(forced, orders, phase);
        let free: Vec<f64> = x.iter().zip(steady).map(|(x, s)| x - s).collect();
        let amplitudes = self.inverse.solve(&complex(&free));
        let never_leaves = self
            .guards
            .iter()
            .zip(&forced.guards)
            .all(|((rest, per_vector), forced)| {
                let moving: f64 = forced
                    + per_vector
                        .iter()
                        .zip(&amplitudes)
                        .map(|(g, c)| g * c.norm())
                        .sum::<f64>();
                // A margin far above rounding: motions that graze are left to the event search.
                rest - moving > 1e-9 * (rest.abs() + moving)
            });
        never_leaves.then_some(amplitudes)
    }

    /// The state after `time`, at phase `phase_after`, of the motion with these free amplitudes.
    pub fn state_after(
        &self,
        forced: &ForcedMotion,
        orders: &[usize],
        amplitudes: &[Complex],
        time: f64,
        phase_after: f64,
    ) -> Vec<f64> {
        let free = self.combine(amplitudes, time);
        self.steady(forced, orders, phase_after)
            .iter()
            .zip(free)
            .map(|(s, f)| s + f)
            .collect()
    }

    /// A measure, given as a row on the augmented state, along the motion with these free amplitudes.
    pub fn measure(
        &self,
        forced: &ForcedMotion,
        orders: &[usize],
        amplitudes: &[Complex],
        row: &[f64],
    ) -> ExponentialSum {
        let nx = self.constant.len();
        let mut terms = Vec::with_capacity(orders.len() + nx);
        for (k, (&order, amplitude)) in orders.iter().zip(&forced.amplitudes).enumerate() {
            let at = nx + 1 + 2 * k;
            let along: Complex = amplitude.iter().zip(row).map(|(a, r)| a * r).sum();
            let rate = Complex::new(0.0, order as f64 * forced.frequency);
            terms.push((rate, along + Complex::new(row[at], -row[at + 1])));
        }
        for (j, (&rate, &amplitude)) in self.eigen.values.iter().zip(amplitudes).enumerate() {
            let along: Complex = (0..nx).map(|i| self.eigen.vectors[(i, j)] * row[i]).sum();
            terms.push((rate, along * amplitude));
        }
        ExponentialSum {
            constant: dot(&row[..nx], &self.constant) + row[nx],
            terms,
        }
    }

    /// The forced motion at a phase of the load.
    fn steady(&self, forced: &ForcedMotion, orders: &[usize], phase: f64) -> Vec<f64> {
        let mut state = self.constant.clone();
        for (&order, amplitude) in orders.iter().zip(&forced.amplitudes) {
            let turn = Complex::cis(order as f64 * phase);
            for (sum, a) in state.iter_mut().zip(amplitude) {
                *sum += (a * turn).re;
            }
        }
        state
    }

    /// `Re Σ_j v_j c_j e^{μ_j t}`.
    fn combine(&self, amplitudes: &[Complex], time: f64) -> Vec<f64> {
        let decayed: Vec<Complex> = amplitudes
            .iter()
            .zip(&self.eigen.values)
            .map(|(c, mu)| c * (mu * time).exp())
            .collect();
        self.eigen
            .vectors
            .times(&decayed)
            .iter()
            .map(|value| value.re)
            .collect()
    }
}

/// `y(t) = constant + Re Σ a e^{λt}`: statistics in closed form.
#[derive(Debug, Clone)]
pub(crate) struct ExponentialSum {
    constant: f64,
    /// Pairs `(λ, a)`.
    terms: Vec<(Complex, Complex)>,
}

impl ExponentialSum {
    /// Mean and root mean square about it over `[0, time]`.
    pub fn mean_and_rms(&self, time: f64) -> (f64, f64) {
        let shift: f64 = self
            .terms
            .iter()
            .map(|(rate, a)| (a * average(rate * time)).re)
            .sum();
        let mut square = 0.0;
        for (rate, a) in &self.terms {
            for (other, b) in &self.terms {
                let sum = a * b * average((rate + other) * time);
                let difference = a * b.conj() * average((rate + other.conj()) * time);
                square += 0.5 * (sum + difference).re;
            }
        }
        (self.constant + shift, (square - shift * shift).max(0.0).sqrt())
    }

    /// The amplitude `h_k` of `e^{ikwt}` over `[0, time]`, a whole number of its periods.
    pub fn harmonic(&self, k: usize, fundamental: f64, time: f64) -> Complex {
        if k == 0 {
            return Complex::from(self.mean_and_rms(time).0);
        }
        let turn = Complex::new(0.0, k as f64 * fundamental);
        self.terms
            .iter()
            .map(|(rate, a)| {
                a * average((rate - turn) * time) + a.conj() * average((rate.conj() - turn) * time)
            })
            .sum()
    }

    /// Appends `count` samples from `start` on, `interval` apart.
    pub fn sample(&self, start: f64, interval: f64, count: usize, samples: &mut Vec<f64>) {
        // Conjugate pairs have the same real part: one of each is enough.
        let mut moving: Vec<(Complex, Complex)> = self
            .terms
            .iter()
            .filter(|(rate, _)| rate.im >= 0.0)
            .map(|&(rate, a)| {
                let paired = self
                    .terms
                    .iter()
                    .any(|(other, _)| rate.im > 0.0 && *other == rate.conj());
                let weight = if paired { 2.0 } else { 1.0 };
                (weight * a * (rate * start).exp(), (rate * interval).exp())
            })
            .collect();
        for _ in 0..count {
            let mut y = self.constant;
            for (value, turn) in &mut moving {
                y += value.re;
                *value *= *turn;
            }
            samples.push(y);
        }
    }
}

/// `(e^x − 1)/x`, the average of `e^{λt}` over a time with `x = λ · time`.
fn average(x: Complex) -> Complex {
    if x.norm() < 1e-6 {
        1.0 + 0.5 * x + x * x / 6.0
    } else {
        (x.exp() - 1.0) / x
    }
}

fn complex(vector: &[f64]) -> Vec<Complex> {
    vector.iter().map(|&value| Complex::from(value)).collect()
}
