//! Derivative of the motion's generator with respect to a parameter.

/// How the generator of one regime depends on the parameter of a family, at fixed phases of the load.
#[derive(Debug, Clone)]
pub(crate) struct Rate {
    /// `dΩ/dp`.
    pub frequency: f64,
    /// Derivative of the rows of `(v', ζ')`, by rows; `None` if they do not depend on the parameter.
    pub rates: Option<Vec<f64>>,
    /// Derivatives of the guards' rows, in their order; empty if they do not depend on the parameter.
    pub guards: Vec<Vec<f64>>,
}

impl Rate {
    /// Adds the source `A_p z` to a mechanical state's derivative; `n` is the number of coordinates.
    #[inline]
    pub fn add_source(&self, z: &[f64], out: &mut [f64], n: usize) {
        if let Some(rows) = &self.rates {
            for (row, value) in rows.chunks_exact(z.len()).zip(&mut out[n..]) {
                *value += row.iter().zip(z).map(|(a, b)| a * b).sum::<f64>();
            }
        }
    }
}
