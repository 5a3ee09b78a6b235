//! Basins of attraction: which attractor each of a grid of starts reaches (theory 02 §9.2).

use super::classify::settle;
use super::periodic::{PeriodicAttractor, Recognition, RecognitionOptions, Recognizer, SAME};
use crate::flow::FlowError;
use slackside_mechanics::OperatingPoint;

/// One direction of a grid of starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Index of the state entry `(q, q')` that varies.
    pub entry: usize,
    /// Its values.
    pub values: Vec<f64>,
}

/// Starts at phase zero: two entries of the state vary, the others are fixed.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    state: Vec<f64>,
    across: Axis,
    down: Axis,
}

/// Why a grid is not sound.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// A direction varies an entry that the state does not have.
    #[error("the grid varies state entry {entry}, but the state has {count} entries")]
    Entry {
        /// Index used.
        entry: usize,
        /// Number of entries.
        count: usize,
    },
    /// Both directions vary the same entry.
    #[error("both directions of the grid vary state entry {entry}: choose two different ones")]
    SameEntry {
        /// Index used twice.
        entry: usize,
    },
    /// A value is NaN or infinite.
    #[error("the grid has a value that is not a finite number")]
    NotFinite,
}

impl Grid {
    /// The starts that differ from `state` in the entry that varies along a row (`across`) and in the one that varies from
    /// row to row (`down`).
    ///
    /// # Errors
    /// [`GridError`] if the entries do not exist or are the same, or a number is not finite.
    pub fn new(state: Vec<f64>, across: Axis, down: Axis) -> Result<Self, GridError> {
        let count = state.len();
        for axis in [&across, &down] {
            if axis.entry >= count {
                return Err(GridError::Entry {
                    entry: axis.entry,
                    count,
                });
            }
        }
        if across.entry == down.entry {
            return Err(GridError::SameEntry { entry: across.entry });
        }
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        if !(finite(&state) && finite(&across.values) && finite(&down.values)) {
            return Err(GridError::NotFinite);
        }
        Ok(Self { state, across, down })
    }

    /// The direction that varies along a row.
    pub fn across(&self) -> &Axis {
        &self.across
    }

    /// The direction that varies from row to row.
    pub fn down(&self) -> &Axis {
        &self.down
    }

    /// The starts of a row, in order; none if there is no such row.
    fn starts(&self, row: usize) -> Vec<Vec<f64>> {
        let Some(&down) = self.down.values.get(row) else {
            return Vec::new();
        };
        self.across
            .values
            .iter()
            .map(|&across| {
                let mut state = self.state.clone();
                state[self.across.entry] = across;
                state[self.down.entry] = down;
                state
            })
            .collect()
    }
}

/// How long motions run and how their attractors are recognised.
#[derive(Debug, Clone, PartialEq)]
pub struct BasinOptions {
    /// Periods after which the attractor is looked for.
    pub periods: usize,
    /// How attractors are recognised.
    pub recognition: RecognitionOptions,
}

impl Default for BasinOptions {
    /// 600 periods.
    fn default() -> Self {
        Self {
            periods: 600,
            recognition: RecognitionOptions::default(),
        }
    }
}

/// Where the motion from one start ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// On the periodic attractor with this number.
    Attractor(usize),
    /// On no periodic motion that was recognised: quasi-periodic, chaotic, or not settled.
    NotPeriodic,
    /// The motion could not be computed to the end.
    Failed,
}

/// One row of the map; attractors are numbered within the row, in the order in which they were met.
#[derive(Debug, Clone)]
pub struct BasinRow {
    /// Number of the row.
    pub row: usize,
    /// One entry per value across.
    pub cells: Vec<Cell>,
    /// Attractors met in this row.
    pub attractors: Vec<PeriodicAttractor>,
    /// Scales of the state entries by which attractors are compared.
    pub scales: Vec<f64>,
}

/// The map of a grid.
#[derive(Debug, Clone, Default)]
pub struct BasinMap {
    /// Number and cells of each row that was computed, by rising number.
    pub rows: Vec<(usize, Vec<Cell>)>,
    /// Attractors, in the order in which the rows meet them.
    pub attractors: Vec<PeriodicAttractor>,
}

impl BasinMap {
    /// How many cells end as `cell` says.
    pub fn count(&self, cell: Cell) -> usize {
        self.rows
            .iter()
            .flat_map(|(_, cells)| cells)
            .filter(|&&c| c == cell)
            .count()
    }
}

/// Computes one row. Rows do not depend on each other, so that many can run at the same time. Cost per cell: the given
/// number of periods, and a few more to recognise the attractor.
///
/// # Errors
/// [`FlowError`] if the system is unsound or the state has the wrong length; a motion that fails only fails its cell.
pub fn row(
    point: &OperatingPoint,
    grid: &Grid,
    row: usize,
    options: &BasinOptions,
) -> Result<BasinRow, FlowError> {
    let mut recognizer = Recognizer::new(point, options.recognition.clone())?;
    let scales = recognizer.scales().to_vec();
    if grid.state.len() != scales.len() {
        return Err(FlowError::StateLength {
            expected: scales.len(),
            found: grid.state.len(),
        });
    }
    let mut attractors: Vec<PeriodicAttractor> = Vec::new();
    let cells = grid
        .starts(row)
        .iter_mut()
        .map(|state| {
            reached(&mut recognizer, state, options.periods, &mut attractors).unwrap_or(Cell::Failed)
        })
        .collect();
    Ok(BasinRow {
        row,
        cells,
        attractors,
        scales,
    })
}

/// Where the motion from `state` ends; a new attractor is added to the list.
fn reached(
    recognizer: &mut Recognizer,
    state: &mut [f64],
    periods: usize,
    attractors: &mut Vec<PeriodicAttractor>,
) -> Result<Cell, FlowError> {
    settle(recognizer.flow(), state, periods)?;
    // Close to a stable orbit that is already known there is nothing left to recognise.
    let known = attractors.iter().position(|attractor| {
        attractor.orbit.is_some() && attractor.distance(state, recognizer.scales()) <= SAME
    });
    if let Some(known) = known {
        return Ok(Cell::Attractor(known));
    }
    Ok(match recognizer.recognize(state)? {
        Recognition::NotPeriodic { .. } => Cell::NotPeriodic,
        Recognition::Periodic(found) => Cell::Attractor(number_of(attractors, found, recognizer.scales())),
    })
}

/// Number of an attractor in a list to which it is added if it is new.
fn number_of(attractors: &mut Vec<PeriodicAttractor>, found: PeriodicAttractor, scales: &[f64]) -> usize {
    match attractors.iter().position(|known| known.is_same(&found, scales)) {
        Some(known) => known,
        None => {
            attractors.push(found);
            attractors.len() - 1
        }
    }
}

/// Puts rows, given in any order, together; attractors of different rows that are the same become one.
pub fn merge(mut rows: Vec<BasinRow>) -> BasinMap {
    rows.sort_by_key(|row| row.row);
    let mut map = BasinMap::default();
    for row in rows {
        let numbers: Vec<usize> = row
            .attractors
            .into_iter()
            .map(|attractor| number_of(&mut map.attractors, attractor, &row.scales))
            .collect();
        let cells = row
            .cells
            .into_iter()
            .map(|cell| match cell {
                Cell::Attractor(number) => Cell::Attractor(numbers[number]),
                other => other,
            })
            .collect();
        map.rows.push((row.row, cells));
    }
    map
}
