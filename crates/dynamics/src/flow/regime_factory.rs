//! A system prepared for its joint regimes: the rows that a combination of regimes gives (theory 05 §3.1).

use super::FlowError;
use super::generator::Layout;
use slackside_linalg::{Lu, Matrix};
use slackside_mechanics::{Guard, Piece, Regime, RegimeTable, System, Transition};

/// A guard of one element in a joint regime, as a row on the augmented state.
#[derive(Debug, Clone)]
pub(crate) struct GuardRow {
    pub element: usize,
    pub from: usize,
    pub transition: Transition,
    /// How many of its derivatives vanish by construction where a motion begins from rest, its value counted: one if it is the
    /// port's velocity, two if it is the wind-up of a spring that is unwound there.
    pub vanishing_at_rest: usize,
    /// Whether it depends on the harmonics of the load.
    pub on_load: bool,
    pub row: Vec<f64>,
}

/// What a joint regime says: how rates move, and with which force each element acts.
#[derive(Debug, Clone)]
pub(crate) struct JointRows {
    /// Rows of `(v', ζ')` on the augmented state, `n + m` rows of `n_z`.
    pub rates: Vec<f64>,
    /// Force of each element as a row on the augmented state; of one that sticks its multiplier.
    pub forces: Vec<Vec<f64>>,
}

/// A system prepared for its joint regimes: everything that does not depend on which regime holds.
#[derive(Debug, Clone)]
pub(crate) struct RegimeFactory {
    pub layout: Layout,
    pub tables: Vec<RegimeTable>,
    strides: Vec<usize>,
    /// Position of the element's internal state in the mechanical state.
    pub internal: Vec<Option<usize>>,
    /// Acceleration rows without element forces, `n × n_z` by rows.
    free: Vec<f64>,
    /// `M⁻¹ b_j` per element.
    pub port_acceleration: Vec<Vec<f64>>,
    /// `b_j` per element.
    pub ports: Vec<Vec<f64>>,
    /// `b_iᵀ M⁻¹ b_j`.
    pub mobility: Matrix,
    pub mass: Matrix,
    pub damping: Matrix,
    pub stiffness: Matrix,
    /// The load as rows of `n` on the entries of the augmented state behind the mechanical ones.
    load: Vec<Vec<f64>>,
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
        let no_load = vec![0.0; n];
        let mut tables = Vec::with_capacity(system.elements.len());
        let mut strides = Vec::with_capacity(system.elements.len());
        let mut internal = Vec::with_capacity(system.elements.len());
        let (mut stride, mut internals) = (1_usize, 0);
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
            internal.push(table.internal.then_some(2 * n + internals));
            internals += usize::from(table.internal);
            tables.push(table);
        }
        let layout = Layout {
            coordinates: n,
            internals,
            orders,
        };
        let mass = Lu::new(&system.mass)?;
        let (damping, stiffness) = (system.damping_at(frequency), system.stiffness_at(frequency));
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(layout.augmented());
        let negative = |matrix: &Matrix, j: usize| matrix.column(j).iter().map(|v| -v).collect::<Vec<_>>();
        columns.extend((0..n).map(|j| negative(&stiffness, j)));
        columns.extend((0..n).map(|j| negative(&damping, j)));
        columns.extend((0..internals).map(|_| no_load.clone()));
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
        let port_acceleration: Vec<Vec<f64>> = ports.iter().map(|b| mass.solve(b)).collect();
        let mut mobility = Matrix::zeros(ports.len(), ports.len());
        for (i, b) in ports.iter().enumerate() {
            for (j, response) in port_acceleration.iter().enumerate() {
                mobility[(i, j)] = slackside_linalg::dot(b, response);
            }
        }
        Ok(Self {
            tables,
            strides,
            internal,
            free,
            port_acceleration,
            ports,
            mobility,
            mass: system.mass.clone(),
            damping,
            stiffness,
            load: columns.split_off(layout.state()),
            layout,
        })
    }

    /// Power of the load, `F(t)ᵀ q'`.
    pub fn load_power(&self, z: &[f64]) -> f64 {
        let (n, nx) = (self.layout.coordinates, self.layout.state());
        let parts = self.load.iter().zip(&z[nx..]);
        parts
            .map(|(column, share)| share * slackside_linalg::dot(column, &z[n..2 * n]))
            .sum()
    }

    /// Regime of one element within a joint regime.
    pub fn regime_of(&self, joint: usize, element: usize) -> usize {
        (joint / self.strides[element]) % self.tables[element].regimes.len()
    }

    /// The regime itself.
    pub fn regime(&self, joint: usize, element: usize) -> &Regime {
        &self.tables[element].regimes[self.regime_of(joint, element)]
    }

    /// The joint regime after one element's transition.
    pub fn after(&self, joint: usize, element: usize, to: usize) -> usize {
        let from = self.regime_of(joint, element);
        joint - from * self.strides[element] + to * self.strides[element]
    }

    /// Elements that hold their port in a joint regime.
    pub fn sticking(&self, joint: usize) -> Vec<usize> {
        (0..self.tables.len())
            .filter(|&element| self.regime(joint, element).sticks())
            .collect()
    }

    /// Displacement, velocity and internal state of an element in a state.
    pub fn port_motion(&self, element: usize, x: &[f64]) -> (f64, f64, f64) {
        let n = self.layout.coordinates;
        let u = slackside_linalg::dot(&self.ports[element], &x[..n]);
        let v = slackside_linalg::dot(&self.ports[element], &x[n..2 * n]);
        (u, v, self.internal[element].map_or(0.0, |at| x[at]))
    }

    /// Accelerations without the forces of the elements, and their scale of rounding.
    pub fn free_acceleration(&self, z: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let rows = self.free.chunks_exact(self.layout.augmented());
        rows.map(|row| {
            let terms = row.iter().zip(z).map(|(a, b)| a * b);
            terms.fold((0.0, 0.0), |(sum, size), t| (sum + t, size + t.abs()))
        })
        .unzip()
    }

    /// The rows of a joint regime.
    ///
    /// # Errors
    /// [`FlowError::Linalg`] if the held ports depend on each other beyond repair.
    pub fn rows(&self, joint: usize) -> Result<JointRows, FlowError> {
        let (n, nz) = (self.layout.coordinates, self.layout.augmented());
        let count = self.tables.len();
        let mut rates = self.free.clone();
        let mut forces: Vec<Vec<f64>> = (0..count)
            .map(|element| self.affine_force(joint, element))
            .collect();
        let subtract = |rates: &mut [f64], element: usize, force: &[f64]| {
            for (response, row) in self.port_acceleration[element]
                .iter()
                .zip(rates.chunks_exact_mut(nz))
            {
                if *response != 0.0 {
                    for (a, f) in row.iter_mut().zip(force) {
                        *a -= response * f;
                    }
                }
            }
        };
        for (element, force) in forces.iter().enumerate() {
            subtract(&mut rates, element, force);
        }
        let held = self.sticking(joint);
        if !held.is_empty() {
            for (&element, multiplier) in held.iter().zip(self.multipliers(&held, &rates)?) {
                subtract(&mut rates, element, &multiplier);
                forces[element] = multiplier;
            }
        }
        rates.truncate(n * nz);
        for (element, at) in self.internal.iter().enumerate() {
            if at.is_none() {
                continue;
            }
            let rate = self.regime(joint, element).internal_rate;
            rates.extend(self.element_row(
                element,
                rate.displacement,
                rate.velocity,
                rate.internal,
                rate.constant,
            ));
        }
        Ok(JointRows { rates, forces })
    }

    /// `Λ = (B_Sᵀ M⁻¹ B_S)⁻¹ B_Sᵀ a` for the acceleration rows `a` (theory 05 (3.1)).
    fn multipliers(&self, held: &[usize], acceleration: &[f64]) -> Result<Vec<Vec<f64>>, FlowError> {
        let nz = self.layout.augmented();
        let lu = self.held_mobility(held)?;
        let mut result = vec![vec![0.0; nz]; held.len()];
        for j in 0..nz {
            let mut right: Vec<f64> = held
                .iter()
                .map(|&element| {
                    let port = self.ports[element].iter().enumerate();
                    port.map(|(i, b)| b * acceleration[i * nz + j]).sum()
                })
                .collect();
            lu.solve_in_place(&mut right);
            for (row, value) in result.iter_mut().zip(right) {
                row[j] = value;
            }
        }
        Ok(result)
    }

    /// The mobility of held ports, factorised. Ports that depend on each other (friction at an arm that lies on its stop)
    /// share their force: a ridge at the level of rounding decides how.
    pub fn held_mobility(&self, held: &[usize]) -> Result<Lu, FlowError> {
        let mut mobility = self.mobility.selected(held);
        if let Ok(lu) = Lu::new(&mobility)
            && lu.determinant().abs() > 1e-12 * held.iter().map(|&e| self.mobility[(e, e)]).product::<f64>()
        {
            return Ok(lu);
        }
        for i in 0..held.len() {
            mobility[(i, i)] *= 1.0 + 1e-12;
        }
        Ok(Lu::new(&mobility)?)
    }

    /// Removes from velocities what moves the held ports, at the least kinetic energy: `v ← P v` (theory 05 §3.1).
    ///
    /// # Errors
    /// As [`Self::rows`].
    pub fn project(&self, held: &[usize], x: &mut [f64]) -> Result<(), FlowError> {
        if held.is_empty() {
            return Ok(());
        }
        let n = self.layout.coordinates;
        let mut impulses: Vec<f64> = held
            .iter()
            .map(|&element| slackside_linalg::dot(&self.ports[element], &x[n..2 * n]))
            .collect();
        self.held_mobility(held)?.solve_in_place(&mut impulses);
        for (&element, impulse) in held.iter().zip(impulses) {
            for (v, response) in x[n..2 * n].iter_mut().zip(&self.port_acceleration[element]) {
                *v -= impulse * response;
            }
        }
        Ok(())
    }

    /// Force of one element that does not stick, as a row on the augmented state; zero for one that sticks.
    fn affine_force(&self, joint: usize, element: usize) -> Vec<f64> {
        match self.regime(joint, element).piece {
            Piece::Affine {
                constant,
                displacement,
                velocity,
                internal,
            } => self.element_row(element, displacement, velocity, internal, constant),
            _ => vec![0.0; self.layout.augmented()],
        }
    }

    /// `displacement · u + velocity · v + internal · ζ + constant` of an element as a row on the augmented state.
    fn element_row(
        &self,
        element: usize,
        displacement: f64,
        velocity: f64,
        internal: f64,
        constant: f64,
    ) -> Vec<f64> {
        let n = self.layout.coordinates;
        let mut row = vec![0.0; self.layout.augmented()];
        for (i, &b) in self.ports[element].iter().enumerate() {
            row[i] = displacement * b;
            row[n + i] = velocity * b;
        }
        if let Some(at) = self.internal[element] {
            row[at] = internal;
        }
        row[self.layout.state()] = constant;
        row
    }

    /// All guards of a joint regime with the given forces.
    pub fn guards(&self, joint: usize, forces: &[Vec<f64>]) -> Vec<GuardRow> {
        let mut rows = Vec::new();
        for element in 0..self.tables.len() {
            let from = self.regime_of(joint, element);
            for guard in &self.tables[element].regimes[from].guards {
                let mut row = self.element_row(
                    element,
                    guard.displacement,
                    guard.velocity,
                    guard.internal,
                    guard.constant,
                );
                if guard.force != 0.0 {
                    for (sum, f) in row.iter_mut().zip(&forces[element]) {
                        *sum += guard.force * f;
                    }
                }
                rows.push(GuardRow {
                    element,
                    from,
                    transition: guard.transition,
                    vanishing_at_rest: vanishing_at_rest(guard),
                    on_load: row[self.layout.state() + 1..].iter().any(|value| *value != 0.0),
                    row,
                });
            }
        }
        rows
    }
}

/// See [`GuardRow::vanishing_at_rest`].
fn vanishing_at_rest(guard: &Guard) -> usize {
    if guard.displacement != 0.0 || guard.force != 0.0 || guard.constant != 0.0 {
        0
    } else if guard.internal == 0.0 {
        1
    } else {
        2
    }
}
