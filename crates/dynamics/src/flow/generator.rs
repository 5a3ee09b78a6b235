//! The linear motion within a joint regime of all elements, `z' = A z` with
//! `z = (q, v, ζ, 1, cos k₁Ωt, sin k₁Ωt, …)`
//! (theory 05 §1, §3.1).
//!
//! Constant and harmonic loads need no particular solution in this form, and a singular stiffness (a free accessory) is no
//! special case.

use super::FlowError;
use slackside_linalg::{Lu, Matrix};
use slackside_mechanics::{Piece, Regime, RegimeTable, Rest, System, Transition};
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

/// A guard of one element in a joint regime, as a row on the augmented state.
#[derive(Debug, Clone)]
pub(crate) struct GuardRow {
    pub element: usize,
    pub from: usize,
    pub transition: Transition,
    /// Whether it is the port's velocity, which is zero where a motion begins from rest.
    pub on_velocity: bool,
    /// Whether it depends on the harmonics of the load.
    pub on_load: bool,
    pub row: Vec<f64>,
}

/// How an element starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StartingRegime {
    pub regime: usize,
    /// The rest at which it is, if its port does not move.
    pub rest: Option<usize>,
    /// Whether the port moves in a direction that the law does not allow.
    pub refused: bool,
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

    /// The regime in which an element starts; for one at rest a provisional one.
    pub fn starting_regime(&self, element: usize, x: &[f64]) -> StartingRegime {
        let table = &self.tables[element];
        let (u, v, zeta) = self.port_motion(element, x);
        let of = |regime: usize| StartingRegime {
            regime,
            rest: None,
            refused: false,
        };
        let least = |regime: &Regime| {
            let values = regime
                .guards
                .iter()
                .map(|g| g.displacement * u + g.velocity * v + g.internal * zeta + g.constant);
            values.fold(f64::INFINITY, f64::min)
        };
        if table.rests.is_empty() {
            // A regime that transmits and whose guards are all positive holds; otherwise the one whose worst guard is best:
            // the one that holds, or a neighbour on a surface.
            let regimes = || table.regimes.iter().enumerate();
            let best = regimes()
                .find(|(_, regime)| regime.transmitting && least(regime) > 0.0)
                .or_else(|| regimes().max_by(|a, b| least(a.1).total_cmp(&least(b.1))));
            return of(best.map_or(0, |(regime, _)| regime));
        }
        // Of several rests (segments of a measured loop) the one whose bounds of the displacement hold.
        let inside = |rest: &Rest| {
            let bounds = rest.candidates().flat_map(|regime| &table.regimes[regime].guards);
            bounds
                .filter(|g| g.displacement != 0.0 && g.force == 0.0)
                .all(|g| g.displacement * u + g.constant >= 0.0)
        };
        let number = table.rests.iter().position(inside).unwrap_or(0);
        let rest = &table.rests[number];
        let stop = rest.stick.and_then(|stick| match table.regimes[stick].piece {
            Piece::Stick { position } => position,
            _ => None,
        });
        if let Some(position) = stop {
            let terms = self.ports[element].iter().zip(x).map(|(b, q)| (b * q).abs());
            let size = position.abs() + terms.sum::<f64>();
            if (u - position).abs() > 1e-12 * size {
                return of(rest.backward.unwrap_or(0));
            }
        }
        if let (true, Some(wound)) = (table.internal && zeta > 0.0, rest.forward) {
            return of(wound);
        }
        if self.is_at_rest(element, x) {
            return StartingRegime {
                rest: Some(number),
                ..of(rest.stick.or(rest.backward).unwrap_or(0))
            };
        }
        let moving = if v < 0.0 { rest.backward } else { rest.forward };
        match (moving, stop) {
            (Some(regime), _) => of(regime),
            // A port that moves into its stop is about to hit it.
            (None, Some(_)) => of(rest.backward.unwrap_or(0)),
            (None, None) => StartingRegime {
                rest: Some(number),
                refused: true,
                ..of(rest.stick.unwrap_or(0))
            },
        }
    }

    /// Puts a port that lies on its stop exactly there, with the least motion of the others.
    pub fn place_on_stop(&self, element: usize, rest: usize, z: &mut [f64]) {
        let table = &self.tables[element];
        let stick = table.rests[rest].stick.map(|stick| table.regimes[stick].piece);
        if let Some(Piece::Stick {
            position: Some(position),
        }) = stick
        {
            let (u, _, _) = self.port_motion(element, z);
            let share = (position - u) / self.mobility[(element, element)];
            for (q, response) in z.iter_mut().zip(&self.port_acceleration[element]) {
                *q += share * response;
            }
        }
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
                    on_velocity: guard.velocity != 0.0
                        && guard.displacement == 0.0
                        && guard.internal == 0.0
                        && guard.constant == 0.0,
                    on_load: row[self.layout.state() + 1..].iter().any(|value| *value != 0.0),
                    row,
                });
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
        for i in 0..n {
            out[i] = z[n + i];
        }
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
        for i in 0..n {
            out[i] = x[n + i];
        }
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
