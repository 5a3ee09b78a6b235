//! Stroboscopic Poincaré map: the state at phase zero of the load, once per period.

use crate::flow::{Flow, FlowError};

/// Successive stroboscopic points of one motion; the first is its start.
#[derive(Debug, Clone, PartialEq)]
pub struct PoincareMap {
    dimension: usize,
    coordinates: Vec<f64>,
}

impl PoincareMap {
    /// Points of the given dimension, none yet.
    pub fn new(dimension: usize) -> Self {
        Self {
            dimension: dimension.max(1),
            coordinates: Vec::new(),
        }
    }

    /// Appends a point.
    pub fn push(&mut self, state: &[f64]) {
        debug_assert_eq!(state.len(), self.dimension);
        self.coordinates.extend_from_slice(state);
    }

    /// Entries of a point, `2n`.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.coordinates.len() / self.dimension
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// The state `(q, q')` after `k` periods.
    pub fn point(&self, k: usize) -> &[f64] {
        &self.coordinates[k * self.dimension..(k + 1) * self.dimension]
    }

    /// All points in the order of time.
    pub fn points(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.coordinates.chunks_exact(self.dimension)
    }

    /// Every `stride`-th point, `count` of them at most: the points of the map over `stride` periods.
    pub(super) fn every(&self, stride: usize, count: usize) -> Self {
        let mut result = Self::new(self.dimension);
        for point in self.points().step_by(stride.max(1)).take(count) {
            result.push(point);
        }
        result
    }

    /// All but the first `skip` points.
    pub(super) fn tail(&self, skip: usize) -> Self {
        Self {
            dimension: self.dimension,
            coordinates: self.coordinates[skip.min(self.len()) * self.dimension..].to_vec(),
        }
    }
}

/// The start and the states after each of `periods` periods, `periods + 1` points; the state moves along.
///
/// # Errors
/// [`FlowError`].
pub fn stroboscopic(
    flow: &mut dyn Flow,
    state: &mut [f64],
    periods: usize,
) -> Result<PoincareMap, FlowError> {
    let mut map = PoincareMap::new(flow.dimension());
    map.coordinates.reserve((periods + 1) * map.dimension);
    map.push(state);
    for _ in 0..periods {
        flow.advance(state, 1, &mut [])?;
        map.push(state);
    }
    Ok(map)
}
