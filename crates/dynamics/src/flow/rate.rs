//! Derivative of the motion's generator with respect to a parameter.

/// How the generator of one regime depends on the parameter of a family, at fixed phases of the load.
#[derive(Debug, Clone)]
pub(crate) struct Rate {
    /// `dΩ/dp`.
    pub frequency: f64,
    /// Derivative of the acceleration rows, `n × n_z` by rows; `None` if they do not depend on the parameter.
    pub acceleration: Option<Vec<f64>>,
}

impl Rate {
    /// Adds the source `A_p z` to a mechanical state's derivative; `nx = 2n`.
    #[inline]
    pub fn add_source(&self, z: &[f64], out: &mut [f64], nx: usize) {
        if let Some(rows) = &self.acceleration {
            for (row, value) in rows.chunks_exact(z.len()).zip(&mut out[nx / 2..nx]) {
                *value += row.iter().zip(z).map(|(a, b)| a * b).sum::<f64>();
            }
        }
    }
}
