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
    /// `None` if the free motion does not decay, or if the eigenvectors are nearly dependent.
    pub fn new(map: &StepMap) -> Option<Self> {
        let layout = &map.generator.layout;
        let (n, nx, nz) = (layout.coordinates, layout.state(), layout.augmented());
        let matrix = map.generator.state_matrix();
        let eigen = eigen(&matrix).ok()?;
        let fastest = eigen.values.iter().map(|v| v.norm()).fold(0.0, f64::max);
        if eigen.values.iter().any(|value| value.re > -1e-9 * fastest) {
            return None;
        }
        let inverse = eigen.vectors.lu().ok()?;
        let mut load = vec![0.0; nx];
        for i in 0..n {
            load[n + i] = -map.generator.acceleration[i * nz + nx];
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
            for i in 0..n {
                let row = &map.generator.acceleration[i * nz + nx + 1 + 2 * k..];
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

    /// The state after `time`, at phase `phase_after`, of the motion that is at `x` now at phase `phase`, if that motion
    /// provably never leaves the regime.
    pub fn settled_state(
        &self,
        forced: &ForcedMotion,
        orders: &[usize],
        x: &[f64],
        phase: f64,
        time: f64,
        phase_after: f64,
    ) -> Option<Vec<f64>> {
        let steady = |phase: f64| {
            let mut state = self.constant.clone();
            for (&order, amplitude) in orders.iter().zip(&forced.amplitudes) {
                let turn = Complex::cis(order as f64 * phase);
                for (sum, a) in state.iter_mut().zip(amplitude) {
                    *sum += (a * turn).re;
                }
            }
            state
        };
        let free: Vec<f64> = x.iter().zip(steady(phase)).map(|(x, s)| x - s).collect();
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
        if !never_leaves {
            return None;
        }
        let free = self.combine(&amplitudes, time);
        Some(steady(phase_after).iter().zip(free).map(|(s, f)| s + f).collect())
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

fn complex(vector: &[f64]) -> Vec<Complex> {
    vector.iter().map(|&value| Complex::from(value)).collect()
}
