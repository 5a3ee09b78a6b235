//! Looking many steps ahead at once within a regime.
//!
//! From one state the states at all places of a grid are linear functions of it, without a chain of steps between them.
//! Between two places a guard is compared with the cubic through its values and slopes at both: the cubic is at least the
//! least of its four Bernstein coefficients, and the guard differs from it by at most `max |g''''| h⁴/384`. Where that
//! bound proves the guard positive nothing happens; elsewhere the full test of the step decides.

use super::kernels::combine;
use super::step_map::{StepMap, Work};
use slackside_numerics::polynomial::TERMS;

/// Places of the grid beyond its start.
pub(crate) const CELLS: usize = 16;

/// Cells per step of the regime.
pub(crate) const CELLS_PER_STEP: usize = 2;

/// The tables of one regime at one frequency.
#[derive(Debug, Clone)]
pub(crate) struct Scan {
    /// Frequency for which the tables hold.
    pub frequency: f64,
    /// Length of a cell in time.
    pub cell: f64,
    /// Mechanical states at the places, by columns of the start: `n_z` blocks of `CELLS` states.
    columns: Vec<f64>,
    guards: Vec<Bounds>,
    /// States at the places for the current start.
    states: Vec<f64>,
}

/// One guard: its row and that of its slope on state and constant, and the bound of the cubic's error.
#[derive(Debug, Clone)]
struct Bounds {
    value: Vec<(usize, f64)>,
    value_constant: f64,
    /// Slope times a third of the cell. `None` if it depends on the load: such a guard is always tested in full.
    slope: Option<Vec<(usize, f64)>>,
    slope_constant: f64,
    /// Error per unit of each state entry.
    error: Vec<f64>,
    error_constant: f64,
}

impl Scan {
    pub fn new(map: &StepMap, work: &mut Work) -> Self {
        let layout = &map.generator.layout;
        let (nx, nz) = (layout.state(), layout.augmented());
        let share = 1.0 / CELLS_PER_STEP as f64;
        let cell = map.step * share;
        let mut columns = vec![0.0; nz * CELLS * nx];
        let mut z = vec![0.0; nz];
        // One cell as a matrix, then its powers column by column.
        let mut one = vec![0.0; nz * nx];
        for j in 0..nz {
            z.fill(0.0);
            z[j] = 1.0;
            map.advance_partial(&mut z, share, work);
            one[j * nx..(j + 1) * nx].copy_from_slice(&z[..nx]);
        }
        let mut state = vec![0.0; nx];
        for j in 0..nz {
            z.fill(0.0);
            z[j] = 1.0;
            for c in 0..CELLS {
                combine(&one, &z, &mut state);
                z[..nx].copy_from_slice(&state);
                map.generator.rotate(&mut z, cell);
                let at = (j * CELLS + c) * nx;
                columns[at..at + nx].copy_from_slice(&state);
            }
        }
        let guards = map
            .guards
            .iter()
            .map(|guard| bounds(map, &guard.guard.row, &guard.taylor))
            .collect();
        Self {
            frequency: map.generator.frequency,
            cell,
            columns,
            guards,
            states: vec![0.0; CELLS * nx],
        }
    }

    /// Computes the states at all places ahead of `z`.
    #[inline]
    pub fn look_ahead(&mut self, z: &[f64]) {
        combine(&self.columns, z, &mut self.states);
    }

    /// The mechanical state at the end of cell `c` (counted from zero).
    #[inline]
    pub fn state(&self, c: usize, nx: usize) -> &[f64] {
        &self.states[c * nx..(c + 1) * nx]
    }

    /// Whether all guards are proved positive over the cell between the ends of cells `c − 1` and `c`.
    #[inline]
    pub fn is_clear(&self, c: usize, nx: usize) -> bool {
        let (a, b) = (self.state(c - 1, nx), self.state(c, nx));
        self.guards.iter().all(|guard| {
            let Some(slope) = &guard.slope else { return false };
            let value = |x: &[f64]| sparse(&guard.value, guard.value_constant, x);
            let rate = |x: &[f64]| sparse(slope, guard.slope_constant, x);
            let (ga, gb) = (value(a), value(b));
            let least = ga.min(gb).min(ga + rate(a)).min(gb - rate(b));
            let error: f64 =
                guard.error_constant + guard.error.iter().zip(a).map(|(e, x)| e * x.abs()).sum::<f64>();
            least > error
        })
    }
}

#[inline]
fn sparse(row: &[(usize, f64)], constant: f64, x: &[f64]) -> f64 {
    row.iter().fold(constant, |sum, &(i, factor)| sum + factor * x[i])
}

fn bounds(map: &StepMap, row: &[f64], taylor: &[[f64; TERMS]]) -> Bounds {
    let layout = &map.generator.layout;
    let (n, nx) = (layout.coordinates, layout.state());
    let nonzero = |row: &[f64]| {
        row.iter()
            .copied()
            .enumerate()
            .filter(|(_, factor)| *factor != 0.0)
            .collect::<Vec<_>>()
    };
    // g' = g_q v + g_v v' + g_ζ ζ'; the cubic's control points need a third of its change over the cell.
    let mut slope = vec![0.0; row.len()];
    slope[n..2 * n].copy_from_slice(&row[..n]);
    for (i, rate) in map.generator.rates.chunks_exact(row.len()).enumerate() {
        for (sum, a) in slope.iter_mut().zip(rate) {
            *sum += row[n + i] * a;
        }
    }
    let third = map.step / CELLS_PER_STEP as f64 / 3.0;
    slope.iter_mut().for_each(|value| *value *= third);
    let depends_on_load = slope[nx + 1..]
        .iter()
        .chain(&row[nx + 1..])
        .any(|value| *value != 0.0);
    let share = 1.0 / CELLS_PER_STEP as f64;
    let error: Vec<f64> = taylor
        .iter()
        .map(|c| {
            (4..TERMS)
                .map(|k| {
                    let fourth_derivative = (k * (k - 1) * (k - 2) * (k - 3)) as f64;
                    fourth_derivative / 384.0 * c[k].abs() * share.powi(k as i32)
                })
                .sum()
        })
        .collect();
    Bounds {
        value: nonzero(&row[..nx]),
        value_constant: row[nx],
        slope: (!depends_on_load).then(|| nonzero(&slope[..nx])),
        slope_constant: slope[nx],
        // Cosine and sine of the load are at most one.
        error_constant: error[nx..].iter().sum(),
        error: error[..nx].to_vec(),
    }
}
