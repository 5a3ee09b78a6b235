//! Periodic functions as samples and as harmonics.
//!
//! A real periodic function of an angle is given by complex amplitudes `h_0 … h_H`, where `h_0` is real:
//! `y(θ) = h_0 + Re Σ_{k=1}^{H} h_k e^{ikθ}`, so that `h_k = a_k − i b_k` for `a_k cos kθ + b_k sin kθ`.

use num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use std::sync::Arc;

/// Makes transforms and remembers their tables, so that a second one of the same length costs little.
#[derive(Default)]
pub struct FourierPlanner {
    planner: Option<RealFftPlanner<f64>>,
}

impl std::fmt::Debug for FourierPlanner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("FourierPlanner")
    }
}

impl FourierPlanner {
    /// A transform between `length` equispaced samples of one period and harmonics; at least two samples are used.
    pub fn transform(&mut self, length: usize) -> FourierTransform {
        let length = length.max(2);
        let planner = self.planner.get_or_insert_with(RealFftPlanner::new);
        let forward = planner.plan_fft_forward(length);
        let inverse = planner.plan_fft_inverse(length);
        FourierTransform {
            spectrum: forward.make_output_vec(),
            samples: forward.make_input_vec(),
            scratch: vec![Complex::ZERO; forward.get_scratch_len().max(inverse.get_scratch_len())],
            forward,
            inverse,
        }
    }
}

/// Transform between `N` samples at `θ_i = 2πi/N` and harmonics; it owns its space, so that use allocates nothing.
#[derive(Clone)]
pub struct FourierTransform {
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    spectrum: Vec<Complex<f64>>,
    samples: Vec<f64>,
    scratch: Vec<Complex<f64>>,
}

impl std::fmt::Debug for FourierTransform {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FourierTransform")
            .field("length", &self.length())
            .finish()
    }
}

impl FourierTransform {
    /// The number of samples `N`.
    pub fn length(&self) -> usize {
        self.samples.len()
    }

    /// Samples of the function with the given harmonics, `O(N log N)`. Harmonics beyond `N/2` are left out.
    ///
    /// `samples` has length `N`.
    pub fn synthesize(&mut self, harmonics: &[Complex<f64>], samples: &mut [f64]) {
        let highest = self.spectrum.len() - 1;
        self.spectrum.fill(Complex::ZERO);
        for (k, (out, h)) in self.spectrum.iter_mut().zip(harmonics).enumerate() {
            // The inverse transform adds the conjugate half, except for the mean and the highest order of an even length.
            let alone = k == 0 || (k == highest && self.samples.len().is_multiple_of(2));
            *out = if alone { Complex::new(h.re, 0.0) } else { 0.5 * h };
        }
        // The lengths are right by construction and the imaginary parts of the real orders are zero, the two faults that
        // the library reports; samples of another length are reported as zeros rather than by a panic.
        if self
            .inverse
            .process_with_scratch(&mut self.spectrum, samples, &mut self.scratch)
            .is_err()
        {
            samples.fill(0.0);
        }
    }

    /// The amplitudes `h_k` of `N` samples for as many orders as `harmonics` has entries, `O(N log N)`; orders beyond the
    /// `N/2` that the samples can tell are set to zero.
    pub fn analyze(&mut self, samples: &[f64], harmonics: &mut [Complex<f64>]) {
        debug_assert_eq!(samples.len(), self.samples.len());
        let n = self.samples.len();
        self.samples.copy_from_slice(samples);
        harmonics.fill(Complex::ZERO);
        if self
            .forward
            .process_with_scratch(&mut self.samples, &mut self.spectrum, &mut self.scratch)
            .is_err()
        {
            return;
        }
        let highest = self.spectrum.len() - 1;
        for (k, (out, c)) in harmonics.iter_mut().zip(&self.spectrum).enumerate() {
            let alone = k == 0 || (k == highest && n.is_multiple_of(2));
            *out = c * (if alone { 1.0 } else { 2.0 } / n as f64);
        }
    }
}

/// `y(θ)`, by Horner's rule in four interleaved sums `Σ_j h_{4j+r} z^{4j}`, which do not wait for each other.
pub fn value(harmonics: &[Complex<f64>], angle: f64) -> f64 {
    let z = Complex::cis(angle);
    let square = z * z;
    let fourth = square * square;
    let (blocks, rest) = harmonics.as_chunks::<4>();
    let mut sums = [Complex::ZERO; 4];
    for (sum, h) in sums.iter_mut().zip(rest) {
        *sum = *h;
    }
    for block in blocks.iter().rev() {
        for (sum, h) in sums.iter_mut().zip(block) {
            *sum = *sum * fourth + h;
        }
    }
    (sums[0] + sums[1] * z + (sums[2] + sums[3] * z) * square).re
}

/// `y(θ)` and `dy/dθ`, by Horner's rule.
pub fn value_and_rate(harmonics: &[Complex<f64>], angle: f64) -> (f64, f64) {
    let z = Complex::cis(angle);
    let mut sum = Complex::<f64>::ZERO;
    let mut derivative = Complex::<f64>::ZERO;
    for h in harmonics.iter().rev() {
        derivative = derivative * z + sum;
        sum = sum * z + h;
    }
    (sum.re, -(derivative * z).im)
}

/// Writes the harmonics of `factor · dy/dθ` into `result`, of the same length.
pub fn differentiate(harmonics: &[Complex<f64>], factor: f64, result: &mut [Complex<f64>]) {
    for (k, (out, h)) in result.iter_mut().zip(harmonics).enumerate() {
        *out = Complex::new(0.0, k as f64 * factor) * h;
    }
}

/// Root mean square about the mean, by Parseval's identity.
pub fn rms_about_mean(harmonics: &[Complex<f64>]) -> f64 {
    (0.5 * harmonics.iter().skip(1).map(|h| h.norm_sqr()).sum::<f64>()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn harmonics() -> Vec<Complex<f64>> {
        vec![
            Complex::new(0.3, 0.0),
            Complex::new(1.0, -0.5),
            Complex::new(-0.2, 0.7),
            Complex::new(0.05, 0.01),
        ]
    }

    fn direct(h: &[Complex<f64>], angle: f64) -> f64 {
        h.iter()
            .enumerate()
            .map(|(k, h)| h.re * (k as f64 * angle).cos() - h.im * (k as f64 * angle).sin())
            .sum()
    }

    #[test]
    fn synthesis_and_analysis_are_inverse_for_even_and_odd_lengths() {
        let h = harmonics();
        let mut planner = FourierPlanner::default();
        for length in [7, 8, 16, 33] {
            let mut transform = planner.transform(length);
            let mut samples = vec![0.0; length];
            transform.synthesize(&h, &mut samples);
            for (i, &y) in samples.iter().enumerate() {
                let angle = TAU * i as f64 / length as f64;
                assert!((y - direct(&h, angle)).abs() < 1e-14);
                assert!((y - value(&h, angle)).abs() < 1e-14);
            }
            let mut back = vec![Complex::ZERO; 6];
            transform.analyze(&samples, &mut back);
            for k in 0..6 {
                let expected = h.get(k).copied().unwrap_or_default();
                assert!((back[k] - expected).norm() < 1e-14, "{length} {k}");
            }
        }
    }

    #[test]
    fn values_agree_with_the_sum_for_every_number_of_harmonics() {
        let h: Vec<_> = (0..14)
            .map(|k| {
                Complex::new(
                    (1.3 * k as f64).cos(),
                    if k == 0 { 0.0 } else { (0.7 * k as f64).sin() },
                )
            })
            .collect();
        for count in 1..=h.len() {
            for angle in [0.0, 0.4, 2.9, 5.5] {
                assert!((value(&h[..count], angle) - direct(&h[..count], angle)).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn the_highest_order_of_an_even_length_keeps_its_amplitude() {
        let mut transform = FourierPlanner::default().transform(4);
        let mut back = vec![Complex::ZERO; 3];
        transform.analyze(&[1.0, -1.0, 1.0, -1.0], &mut back);
        assert_eq!(back[2], Complex::new(1.0, 0.0));
        let mut samples = [0.0; 4];
        transform.synthesize(&back, &mut samples);
        assert_eq!(samples, [1.0, -1.0, 1.0, -1.0]);
    }

    #[test]
    fn rates_agree_with_differences_and_with_differentiated_harmonics() {
        let h = harmonics();
        let mut rate = vec![Complex::ZERO; h.len()];
        differentiate(&h, 1.0, &mut rate);
        for i in 0..20 {
            let angle = 0.31 * i as f64;
            let (y, d) = value_and_rate(&h, angle);
            let step = 1e-5;
            let difference = (direct(&h, angle + step) - direct(&h, angle - step)) / (2.0 * step);
            assert!((y - direct(&h, angle)).abs() < 1e-14);
            assert!((d - difference).abs() < 1e-9);
            assert!((d - value(&rate, angle)).abs() < 1e-13);
        }
    }

    #[test]
    fn rms_of_a_cosine_is_its_amplitude_over_root_two() {
        let h = [Complex::new(5.0, 0.0), Complex::new(0.0, 3.0)];
        assert!((rms_about_mean(&h) - 3.0 / 2.0_f64.sqrt()).abs() < 1e-15);
    }
}
