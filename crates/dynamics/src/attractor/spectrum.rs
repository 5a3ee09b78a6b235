//! Amplitude spectrum of samples that need not repeat (theory 02 §9.2, waterfall).

use slackside_linalg::Complex;
use slackside_numerics::fourier::FourierPlanner;

/// Amplitudes of equally spaced samples at the lines `0, 1, …, N/2` cycles per record, with a Hann window and corrected
/// for it (factor 2), so that a sinusoid on a line shows its amplitude there. The mean is taken out before the window and
/// its absolute value stands on line 0. Over `P` periods of a load of frequency `Ω`, line `k` lies at `k Ω / P`.
/// Fewer than two samples have no spectrum.
pub fn amplitude_spectrum(samples: &[f64]) -> Vec<f64> {
    let count = samples.len();
    if count < 2 {
        return Vec::new();
    }
    let mean = samples.iter().sum::<f64>() / count as f64;
    let step = std::f64::consts::TAU / count as f64;
    let windowed: Vec<f64> = samples
        .iter()
        .enumerate()
        .map(|(i, y)| (y - mean) * 0.5 * (1.0 - (step * i as f64).cos()))
        .collect();
    let mut harmonics = vec![Complex::ZERO; count / 2 + 1];
    FourierPlanner::default()
        .transform(count)
        .analyze(&windowed, &mut harmonics);
    let mut amplitudes: Vec<f64> = harmonics.iter().map(|h| 2.0 * h.norm()).collect();
    amplitudes[0] = mean.abs();
    amplitudes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sinusoid_on_a_line_shows_its_amplitude_and_the_mean_its_size() {
        let samples: Vec<f64> = (0..512)
            .map(|i| -0.7 + 0.3 * (std::f64::consts::TAU * 12.0 * i as f64 / 512.0 + 0.4).cos())
            .collect();
        let amplitudes = amplitude_spectrum(&samples);
        assert_eq!(amplitudes.len(), 257);
        assert!((amplitudes[0] - 0.7).abs() < 1e-13);
        assert!((amplitudes[12] - 0.3).abs() < 1e-13);
        // The window puts half of the amplitude on each neighbour and nothing beyond.
        assert!((amplitudes[11] - 0.15).abs() < 1e-13);
        assert!(amplitudes[1] < 1e-13 && amplitudes[14] < 1e-13);
    }

    #[test]
    fn a_single_sample_has_no_spectrum() {
        assert!(amplitude_spectrum(&[1.0]).is_empty());
    }
}
