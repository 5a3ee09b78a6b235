//! Real unknowns and complex amplitudes: `(h_0, Re h_1, Im h_1, …, Re h_H, Im h_H)` of each port in turn. For a port that
//! drifts `h_0` is the mean velocity.

use num_complex::Complex;
use slackside_numerics::fourier::differentiate;

/// `τ = (Σ_{k>3H/4} |h_k|²)^{1/2} / (Σ_{k≥1} |h_k|²)^{1/2}`; zero for a port at rest.
pub fn tail(port: &[Complex<f64>]) -> f64 {
    let sum = |from: usize| port.iter().skip(from).map(|h| h.norm_sqr()).sum::<f64>();
    let all = sum(1);
    if all > 0.0 {
        (sum(3 * (port.len() - 1) / 4 + 1) / all).sqrt()
    } else {
        0.0
    }
}

/// Amplitudes of the velocity of a port from its amplitudes, the first of which is the mean velocity if the port drifts.
pub fn velocity(port: &[Complex<f64>], omega: f64, drifts: bool, result: &mut [Complex<f64>]) {
    differentiate(port, omega, result);
    if drifts {
        result[0] = port[0];
    }
}

/// Real unknowns of one port from its amplitudes.
pub fn pack(port: &[Complex<f64>], z: &mut [f64]) {
    for (k, &h) in port.iter().enumerate() {
        write(z, 0, k, h);
    }
}

/// Amplitudes of one port from its real unknowns.
pub fn unpack(z: &[f64], port: &mut [Complex<f64>]) {
    port[0] = Complex::new(z[0], 0.0);
    for (k, h) in port.iter_mut().enumerate().skip(1) {
        *h = Complex::new(z[2 * k - 1], z[2 * k]);
    }
}

/// The unknowns `z` of `ports` ports with another number of harmonics: padded with zeros or cut.
pub fn resize(z: &[f64], ports: usize, from: usize, to: usize) -> Vec<f64> {
    let (old, new) = (2 * from + 1, 2 * to + 1);
    let kept = old.min(new);
    let mut result = vec![0.0; ports * new];
    for i in 0..ports {
        result[i * new..i * new + kept].copy_from_slice(&z[i * old..i * old + kept]);
    }
    result
}

/// Writes amplitude `k` of the port whose unknowns begin at `offset`.
#[inline]
pub fn write(out: &mut [f64], offset: usize, k: usize, value: Complex<f64>) {
    if k == 0 {
        out[offset] = value.re;
    } else {
        out[offset + 2 * k - 1] = value.re;
        out[offset + 2 * k] = value.im;
    }
}
