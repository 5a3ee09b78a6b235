//! Directions that the period map leaves free, and Newton's step without them.

use slackside_linalg::{Lu, Matrix, dot};

/// A direction in which the period map moves nothing: the row that measures it and the unit of motion along it.
#[derive(Debug, Clone)]
pub(super) struct Pin {
    pub row: Vec<f64>,
    pub direction: Vec<f64>,
    /// Where the row is held; `None` for where it is.
    pub target: Option<f64>,
}

impl Pin {
    /// The cyclic coordinate `i` of a state of length `nx`, held at zero.
    pub fn coordinate(i: usize, nx: usize) -> Self {
        let mut row = vec![0.0; nx];
        row[i] = 1.0;
        Self {
            direction: row.clone(),
            row,
            target: Some(0.0),
        }
    }

    /// How far the state is from where the pin holds it.
    pub fn offset(&self, x: &[f64]) -> f64 {
        self.target.map_or(0.0, |target| dot(&self.row, x) - target)
    }
}

/// Removes from a vector its parts along the pins.
pub(super) fn project(vector: &mut [f64], pins: &[Pin]) {
    for pin in pins {
        let share = dot(&pin.row, vector);
        for (value, d) in vector.iter_mut().zip(&pin.direction) {
            *value -= share * d;
        }
    }
}

/// The monodromy matrix without its free directions.
pub(super) fn restricted(mut monodromy: Matrix, pins: &[Pin]) -> Matrix {
    let n = monodromy.rows();
    for j in 0..n {
        let mut column = monodromy.column(j);
        project(&mut column, pins);
        for (i, value) in column.into_iter().enumerate() {
            monodromy[(i, j)] = value;
        }
    }
    monodromy
}

/// Solves `(I − d pᵀ)(Mon − I) Δ − d pᵀ Δ = −misses + d (pᵀ x − target)`; `None` if the matrix is singular.
pub(super) fn newton_step(monodromy: Matrix, misses: &[f64], x: &[f64], pins: &[Pin]) -> Option<Vec<f64>> {
    let n = misses.len();
    let mut matrix = monodromy;
    for i in 0..n {
        matrix[(i, i)] -= 1.0;
    }
    let mut matrix = restricted(matrix, pins);
    let mut right: Vec<f64> = misses.iter().map(|value| -value).collect();
    for pin in pins {
        let offset = pin.offset(x);
        for i in 0..n {
            right[i] += pin.direction[i] * offset;
            if pin.direction[i] != 0.0 {
                for j in 0..n {
                    matrix[(i, j)] -= pin.direction[i] * pin.row[j];
                }
            }
        }
    }
    let step = Lu::new(&matrix).ok()?.solve(&right);
    step.iter().all(|value| value.is_finite()).then_some(step)
}
