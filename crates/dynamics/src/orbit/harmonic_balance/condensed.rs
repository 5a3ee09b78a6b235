//! The linear part seen from the ports: receptances and linear response per harmonic (theory 05 §5.3).

use super::linear_part::LinearPart;
use super::{HarmonicBalanceError, elimination};
use num_complex::Complex;

/// For each harmonic `k = 0 … H` of `Ω/n`, with `B` the columns of the `m` ports and `D_k` the dynamic stiffness:
/// receptance `R_k = Bᵀ D_k⁻¹ B` and linear response `u_lin,k = Bᵀ D_k⁻¹ F_k`, with derivatives with respect to `Ω`,
/// `R_k' = −Bᵀ D_k⁻¹ D_k' D_k⁻¹ B` and `u_lin,k' = −Bᵀ D_k⁻¹ D_k' D_k⁻¹ F_k`. For a port that drifts `R_0` and `u_lin,0` are mobility
/// and mean velocity ([`super::linearization`]).
#[derive(Debug, Clone, Default)]
pub struct Condensed {
    ports: usize,
    receptance: Vec<Complex<f64>>,
    receptance_rate: Vec<Complex<f64>>,
    response: Vec<Complex<f64>>,
    response_rate: Vec<Complex<f64>>,
    stiffness: Vec<Complex<f64>>,
    columns: Vec<Complex<f64>>,
    rates: Vec<Complex<f64>>,
    product: Vec<Complex<f64>>,
}

impl Condensed {
    /// `R_k` between ports `i` (displacement) and `j` (force).
    #[inline]
    pub fn receptance(&self, k: usize, i: usize, j: usize) -> Complex<f64> {
        self.receptance[(k * self.ports + i) * self.ports + j]
    }

    /// `dR_k/dΩ`.
    #[inline]
    pub fn receptance_rate(&self, k: usize, i: usize, j: usize) -> Complex<f64> {
        self.receptance_rate[(k * self.ports + i) * self.ports + j]
    }

    /// `u_lin,k` of port `i`.
    #[inline]
    pub fn response(&self, k: usize, i: usize) -> Complex<f64> {
        self.response[k * self.ports + i]
    }

    /// `du_lin,k/dΩ`.
    #[inline]
    pub fn response_rate(&self, k: usize, i: usize) -> Complex<f64> {
        self.response_rate[k * self.ports + i]
    }

    /// Fills in all harmonics at frequency `Ω`; rates only if asked for. `O(H n³)`; space is reused.
    ///
    /// # Errors
    /// [`HarmonicBalanceError::Resonance`] if a dynamic stiffness is singular.
    pub fn update(
        &mut self,
        linear: &LinearPart,
        harmonics: usize,
        frequency: f64,
        subharmonic: usize,
        with_rates: bool,
    ) -> Result<(), HarmonicBalanceError> {
        let (n, m) = (linear.order(), linear.ports.len());
        // Right-hand sides: the ports' columns, then the load.
        let width = m + 1;
        self.ports = m;
        self.stiffness.resize(n * n, Complex::ZERO);
        self.product.resize(n * n, Complex::ZERO);
        self.columns.resize(n * width, Complex::ZERO);
        self.rates.resize(n * width, Complex::ZERO);
        for (vector, length) in [
            (&mut self.receptance, (harmonics + 1) * m * m),
            (&mut self.receptance_rate, (harmonics + 1) * m * m),
            (&mut self.response, (harmonics + 1) * m),
            (&mut self.response_rate, (harmonics + 1) * m),
        ] {
            vector.resize(length, Complex::ZERO);
        }
        for k in 0..=harmonics {
            let singular = || HarmonicBalanceError::Resonance {
                harmonic: k,
                frequency,
            };
            self.columns.fill(Complex::ZERO);
            for (j, port) in linear.ports.iter().enumerate() {
                for &(i, factor) in port.terms() {
                    self.columns[i * width + j] = Complex::new(factor, 0.0);
                }
            }
            if let Some(load) = linear.load(k, subharmonic) {
                for (i, amplitude) in load.iter().enumerate() {
                    self.columns[i * width + m] = *amplitude;
                }
            }
            linear.dynamic_stiffness(k, frequency, subharmonic, &mut self.stiffness);
            if !elimination::solve(&mut self.stiffness, &mut self.columns, n, width) {
                return Err(singular());
            }
            let port = |i: usize| match k {
                0 => linear.mean_ports[i].as_slice(),
                _ => linear.ports[i].terms(),
            };
            for i in 0..m {
                for j in 0..m {
                    self.receptance[(k * m + i) * m + j] = project(port(i), &self.columns, width, j);
                }
                self.response[k * m + i] = project(port(i), &self.columns, width, m);
            }
            if !with_rates {
                continue;
            }
            linear.dynamic_stiffness_rate(k, frequency, subharmonic, &mut self.product);
            for i in 0..n {
                for j in 0..width {
                    let row = &self.product[i * n..(i + 1) * n];
                    let sum: Complex<f64> = row
                        .iter()
                        .enumerate()
                        .map(|(l, d)| d * self.columns[l * width + j])
                        .sum();
                    self.rates[i * width + j] = -sum;
                }
            }
            linear.dynamic_stiffness(k, frequency, subharmonic, &mut self.stiffness);
            if !elimination::solve(&mut self.stiffness, &mut self.rates, n, width) {
                return Err(singular());
            }
            for i in 0..m {
                for j in 0..m {
                    self.receptance_rate[(k * m + i) * m + j] = project(port(i), &self.rates, width, j);
                }
                self.response_rate[k * m + i] = project(port(i), &self.rates, width, m);
            }
        }
        Ok(())
    }
}

/// `bᵀ` times one column of a row-major block.
fn project(port: &[(usize, f64)], block: &[Complex<f64>], width: usize, column: usize) -> Complex<f64> {
    port.iter()
        .map(|&(i, factor)| block[i * width + column] * factor)
        .sum()
}
