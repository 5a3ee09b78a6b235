//! Where an element acts: a sparse column `b` of the system.

/// The sparse column `b` through which an element acts: its displacement is `u = bᵀq`, its velocity `v = bᵀq'`, and its
/// force enters the equations of motion as `b f`, on the left-hand side, so that `f v ≥ 0` is dissipation.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Port(Vec<(usize, f64)>);

impl Port {
    /// A port from pairs of coordinate index and factor. Factors of one coordinate are added, zeros dropped.
    pub fn new(terms: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let mut merged: Vec<(usize, f64)> = Vec::new();
        for (index, factor) in terms {
            match merged.iter_mut().find(|(i, _)| *i == index) {
                Some((_, sum)) => *sum += factor,
                None => merged.push((index, factor)),
            }
        }
        merged.retain(|&(_, factor)| factor != 0.0);
        merged.sort_by_key(|&(index, _)| index);
        Self(merged)
    }

    /// Pairs of coordinate index and factor, by rising index.
    pub fn terms(&self) -> &[(usize, f64)] {
        &self.0
    }

    /// `bᵀ x`.
    pub fn project(&self, vector: &[f64]) -> f64 {
        self.0.iter().map(|&(i, factor)| factor * vector[i]).sum()
    }

    /// The column as a dense vector of length `n`.
    pub fn dense(&self, n: usize) -> Vec<f64> {
        let mut result = vec![0.0; n];
        for &(i, factor) in &self.0 {
            result[i] += factor;
        }
        result
    }
}
