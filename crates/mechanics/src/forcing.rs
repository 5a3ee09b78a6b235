//! The external load: constant plus harmonics of one fundamental frequency.

/// One harmonic of the load: `cosine · cos(order Ω t) + sine · sin(order Ω t)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonic {
    /// Multiple of the fundamental frequency, at least one.
    pub order: usize,
    /// Cosine amplitudes, one per coordinate.
    pub cosine: Vec<f64>,
    /// Sine amplitudes, one per coordinate.
    pub sine: Vec<f64>,
}

/// `F(t) = F₀ + Σ_k (Fc_k cos kΩt + Fs_k sin kΩt)`, force or torque per coordinate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Forcing {
    /// The constant part `F₀`, one entry per coordinate.
    pub constant: Vec<f64>,
    /// The harmonics, by rising order, each order once.
    pub harmonics: Vec<Harmonic>,
}

impl Forcing {
    /// No load on `n` coordinates.
    pub fn none(n: usize) -> Self {
        Self {
            constant: vec![0.0; n],
            harmonics: Vec::new(),
        }
    }

    /// Adds a harmonic; its amplitudes are added to those of the same order.
    pub fn add_harmonic(&mut self, harmonic: Harmonic) {
        match self.harmonics.iter_mut().find(|h| h.order == harmonic.order) {
            Some(existing) => {
                existing
                    .cosine
                    .iter_mut()
                    .zip(&harmonic.cosine)
                    .for_each(|(a, b)| *a += b);
                existing
                    .sine
                    .iter_mut()
                    .zip(&harmonic.sine)
                    .for_each(|(a, b)| *a += b);
            }
            None => {
                self.harmonics.push(harmonic);
                self.harmonics.sort_by_key(|h| h.order);
            }
        }
    }

    /// Largest order present; zero without harmonics.
    pub fn highest_order(&self) -> usize {
        self.harmonics.last().map_or(0, |h| h.order)
    }
}
