//! The linear motion within a joint regime of all elements, `z' = A z` with `z = (q, v, 1, cos k₁Ωt, sin k₁Ωt, …)`
//! (theory 05 §1, §3.1).
//!
//! Constant and harmonic loads need no particular solution in this form, and a singular stiffness (a free accessory) is no
//! special case.

use super::FlowError;
use slackside_linalg::{Lu, Matrix};
use slackside_mechanics::{Guard, Piece, RegimeTable, System, Transition};
use slackside_numerics::multiply_add;

/// Sizes of the augmented state.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    /// Number of coordinates `n`.
    pub coordinates: usize,
    /// Orders of the load's harmonics.
    pub orders: Vec<usize>,
}

impl Layout {
    /// Length of the mechanical state `(q, v)`.
    pub fn state(&self) -> usize {
        2 * self.coordinates
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

/// A guard of one element in a joint regime, as a row on the augmented state.
#[derive(Debug, Clone)]
pub(crate) struct GuardRow {
    pub element: usize,
    pub from: usize,
    pub to: usize,
    pub row: Vec<f64>,
}

/// A system prepared for its joint regimes: everything that does not depend on which regime holds.
#[derive(Debug, Clone)]
pub(crate) struct RegimeFactory {
    pub layout: Layout,
    pub tables: Vec<RegimeTable>,
    strides: Vec<usize>,
    /// Acceleration rows without element forces, `n × n_z` by rows.
    free: Vec<f64>,
    /// `M⁻¹ b_j` per element.
    port_acceleration: Vec<Vec<f64>>,
    /// `b_j` per element.
    ports: Vec<Vec<f64>>,
}

impl RegimeFactory {
    pub fn new(system: &System, frequency: f64) -> Result<Self, FlowError> {
        let n = system.order();
        // Measures may contain prescribed harmonics (a crank rotation) that the load does not.
        let prescribed = system
            .outputs
            .iter()
            .flat_map(|output| output.harmonics.iter().map(|h| h.0));
        let mut orders: Vec<usize> = system
            .forcing
            .harmonics
            .iter()
            .map(|h| h.order)
            .chain(prescribed)
            .collect();
        orders.sort_unstable();
        orders.dedup();
        let layout = Layout {
            coordinates: n,
            orders,
        };
        let no_load = vec![0.0; n];
        let mut tables = Vec::with_capacity(system.elements.len());
        let mut strides = Vec::with_capacity(system.elements.len());
        let mut stride = 1_usize;
        for element in &system.elements {
            let table = element
                .law
                .regimes()
                .ok_or_else(|| FlowError::NotPiecewiseLinear {
                    element: element.name.clone(),
                })?;
            strides.push(stride);
            stride = stride
                .checked_mul(table.regimes.len())
                .ok_or(FlowError::TooManyRegimes {
                    elements: system.elements.len(),
                })?;
            tables.push(table);
        }
        let mass = Lu::new(&system.mass)?;
        let (damping, stiffness) = (system.damping_at(frequency), system.stiffness_at(frequency));
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(layout.augmented());
        let negative = |matrix: &Matrix, j: usize| matrix.column(j).iter().map(|v| -v).collect::<Vec<_>>();
        columns.extend((0..n).map(|j| negative(&stiffness, j)));
        columns.extend((0..n).map(|j| negative(&damping, j)));
        columns.push(system.forcing.constant.clone());
        for &order in &layout.orders {
            let harmonic = system.forcing.harmonics.iter().find(|h| h.order == order);
            columns.push(harmonic.map_or(&no_load, |h| &h.cosine).clone());
            columns.push(harmonic.map_or(&no_load, |h| &h.sine).clone());
        }
        let mut free = vec![0.0; n * columns.len()];
        for (j, column) in columns.iter().enumerate() {
            for (i, value) in mass.solve(column).into_iter().enumerate() {
                free[i * columns.len() + j] = value;
            }
        }
        let ports: Vec<Vec<f64>> = system.elements.iter().map(|e| e.port.dense(n)).collect();
        let port_acceleration = ports.iter().map(|b| mass.solve(b)).collect();
        Ok(Self {
            layout,
            tables,
            strides,
            free,
            port_acceleration,
            ports,
        })
    }

    /// Regime of one element within a joint regime.
    pub fn regime_of(&self, joint: usize, element: usize) -> usize {
        (joint / self.strides[element]) % self.tables[element].regimes.len()
    }

    /// The joint regime after one element's transition.
    pub fn after(&self, joint: usize, element: usize, to: usize) -> usize {
        let from = self.regime_of(joint, element);
        joint - from * self.strides[element] + to * self.strides[element]
    }

    /// A joint regime that holds at the mechanical state `x`; on a surface, one of the two.
    pub fn regime_at(&self, x: &[f64]) -> usize {
        let n = self.layout.coordinates;
        let mut joint = 0;
        for (element, table) in self.tables.iter().enumerate() {
            let u = slackside_linalg::dot(&self.ports[element], &x[..n]);
            let v = slackside_linalg::dot(&self.ports[element], &x[n..]);
            let least = |guards: &[Guard]| {
                guards
                    .iter()
                    .map(|g| g.displacement * u + g.velocity * v + g.constant)
                    .fold(f64::INFINITY, f64::min)
            };
            // The regime whose worst guard is best: the one that holds, or a neighbour on a surface.
            let best = (0..table.regimes.len())
                .max_by(|&a, &b| least(&table.regimes[a].guards).total_cmp(&least(&table.regimes[b].guards)))
                .unwrap_or(0);
            joint += best * self.strides[element];
        }
        joint
    }

    /// Acceleration rows of a joint regime, `n × n_z` by rows.
    pub fn acceleration(&self, joint: usize) -> Vec<f64> {
        let (n, nz) = (self.layout.coordinates, self.layout.augmented());
        let mut rows = self.free.clone();
        for (element, response) in self.port_acceleration.iter().enumerate() {
            let force = self.force_row(joint, element);
            for i in 0..n {
                if response[i] != 0.0 {
                    for (a, f) in rows[i * nz..(i + 1) * nz].iter_mut().zip(&force) {
                        *a -= response[i] * f;
                    }
                }
            }
        }
        rows
    }

    /// Force of one element as a row on the augmented state.
    pub fn force_row(&self, joint: usize, element: usize) -> Vec<f64> {
        let n = self.layout.coordinates;
        let mut row = vec![0.0; self.layout.augmented()];
        let regime = &self.tables[element].regimes[self.regime_of(joint, element)];
        if let Piece::Affine {
            constant,
            displacement,
            velocity,
            internal: _,
        } = regime.piece
        {
            for (i, &b) in self.ports[element].iter().enumerate() {
                row[i] = displacement * b;
                row[n + i] = velocity * b;
            }
            row[2 * n] = constant;
        }
        row
    }

    /// All guards of a joint regime.
    pub fn guards(&self, joint: usize) -> Vec<GuardRow> {
        let n = self.layout.coordinates;
        let mut rows = Vec::new();
        for (element, table) in self.tables.iter().enumerate() {
            let from = self.regime_of(joint, element);
            for guard in &table.regimes[from].guards {
                let mut row = vec![0.0; self.layout.augmented()];
                for (i, &b) in self.ports[element].iter().enumerate() {
                    row[i] = guard.displacement * b;
                    row[n + i] = guard.velocity * b;
                }
                row[2 * n] = guard.constant;
                if let Transition::To(to) = guard.transition {
                    rows.push(GuardRow {
                        element,
                        from,
                        to,
                        row,
                    });
                }
            }
        }
        rows
    }
}

/// `z' = A z` in one joint regime.
#[derive(Debug, Clone)]
pub(crate) struct Generator {
    pub layout: Layout,
    /// Fundamental frequency `Ω`.
    pub frequency: f64,
    /// Acceleration rows, `n × n_z` by rows.
    pub acceleration: Vec<f64>,
}

impl Generator {
    /// `out = A z`.
    pub fn apply(&self, z: &[f64], out: &mut [f64]) {
        self.apply_sized(self.layout.coordinates, self.layout.orders.len(), z, out);
    }

    /// [`Self::apply`] for sizes that the caller knows: constants there become unrolled loops here.
    #[inline(always)]
    pub fn apply_sized(&self, n: usize, orders: usize, z: &[f64], out: &mut [f64]) {
        let nz = 2 * n + 1 + 2 * orders;
        let (z, out) = (&z[..nz], &mut out[..nz]);
        for i in 0..n {
            out[i] = z[n + i];
            let row = &self.acceleration[i * nz..(i + 1) * nz];
            let mut sum = 0.0;
            for j in 0..nz {
                sum = multiply_add(row[j], z[j], sum);
            }
            out[n + i] = sum;
        }
        out[2 * n] = 0.0;
        for (k, &order) in self.layout.orders[..orders].iter().enumerate() {
            let rate = order as f64 * self.frequency;
            let at = 2 * n + 1 + 2 * k;
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
    pub fn apply_to_state_sized(&self, n: usize, orders: usize, x: &[f64], out: &mut [f64]) {
        let nz = 2 * n + 1 + 2 * orders;
        let (x, out) = (&x[..2 * n], &mut out[..2 * n]);
        for i in 0..n {
            out[i] = x[n + i];
            let row = &self.acceleration[i * nz..(i + 1) * nz];
            let mut sum = 0.0;
            for j in 0..2 * n {
                sum = multiply_add(row[j], x[j], sum);
            }
            out[n + i] = sum;
        }
    }

    /// The mechanical block of `A`, `2n × 2n`, acting on `(q, v)`.
    pub fn state_matrix(&self) -> Matrix {
        let n = self.layout.coordinates;
        let nz = self.layout.augmented();
        let mut a = Matrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            a[(i, n + i)] = 1.0;
            a.row_mut(n + i)
                .copy_from_slice(&self.acceleration[i * nz..i * nz + 2 * n]);
        }
        a
    }
}
