//! The linear part of the equations: everything but the remainder forces of the nonlinear elements.
//!
//! Each element is replaced by its linear spring and damper `(k, c)`, which keeps the static stiffness regular when the
//! element opens (theory 02 (C11)); what is left to the harmonic unknowns is `N = f − k u − c v`.

use super::HarmonicBalanceError;
use super::linearization::Linearization;
use num_complex::Complex;
use slackside_linalg::{Lu, Matrix};
use slackside_mechanics::{Port, System};

/// `−(kω)² M + ikω (C + Ω C₁) + K + Ω² K₂` and its load, where `C` and `K` include the elements' springs and dampers and
/// `ω = Ω/n`.
#[derive(Debug, Clone)]
pub struct LinearPart {
    /// `M`.
    pub mass: Matrix,
    /// `C` with the elements' dampers.
    pub damping: Matrix,
    /// `C₁`, per unit of `Ω`.
    pub damping_linear: Option<Matrix>,
    /// `K` with the elements' springs.
    pub stiffness: Matrix,
    /// `K₂`, per unit of `Ω²`.
    pub stiffness_quadratic: Option<Matrix>,
    /// The load: order in multiples of `Ω`, and complex amplitude per coordinate.
    pub loads: Vec<(usize, Vec<Complex<f64>>)>,
    /// Ports of the elements with a remainder.
    pub ports: Vec<Port>,
    /// Combinations of the mean solution that are the mean unknowns of these ports.
    pub mean_ports: Vec<Vec<(usize, f64)>>,
    /// What drift adds to the static stiffness, `C N Nᵀ` and per unit of `Ω` `C₁ N Nᵀ`; none without drift.
    pub drift: Option<(Matrix, Option<Matrix>)>,
}

impl LinearPart {
    /// The linear part of a system, with the ports of the `nonlinear` elements (indices).
    pub fn new(system: &System, linearization: &Linearization, nonlinear: &[usize]) -> Self {
        let mut damping = system.damping.clone();
        let mut stiffness = system.stiffness.clone();
        for (element, &(spring, damper)) in system.elements.iter().zip(&linearization.elements) {
            for &(i, a) in element.port.terms() {
                for &(j, b) in element.port.terms() {
                    stiffness[(i, j)] += a * b * spring;
                    damping[(i, j)] += a * b * damper;
                }
            }
        }
        let constant = system.forcing.constant.iter().map(|&f| Complex::new(f, 0.0));
        let mut loads = vec![(0, constant.collect())];
        for harmonic in &system.forcing.harmonics {
            let amplitudes = harmonic.cosine.iter().zip(&harmonic.sine);
            let amplitudes = amplitudes.map(|(&c, &s)| Complex::new(c, -s)).collect();
            loads.push((harmonic.order, amplitudes));
        }
        let drift = linearization.drift.as_ref().map(|(projector, _)| {
            let linear = system.damping_linear_in_frequency.as_ref();
            (
                damping.product(projector),
                linear.map(|matrix| matrix.product(projector)),
            )
        });
        let n = system.order();
        let mean_ports = nonlinear.iter().map(|&e| {
            let port = &system.elements[e].port;
            match &linearization.drift {
                Some((projector, _)) if linearization.drifting[e] => {
                    projector.times(&port.dense(n)).into_iter().enumerate().collect()
                }
                _ => port.terms().to_vec(),
            }
        });
        Self {
            mean_ports: mean_ports.collect(),
            drift,
            mass: system.mass.clone(),
            damping,
            damping_linear: system.damping_linear_in_frequency.clone(),
            stiffness,
            stiffness_quadratic: system.stiffness_quadratic_in_frequency.clone(),
            loads,
            ports: nonlinear
                .iter()
                .map(|&e| system.elements[e].port.clone())
                .collect(),
        }
    }

    /// Number of coordinates.
    pub fn order(&self) -> usize {
        self.mass.rows()
    }

    /// Writes the dynamic stiffness of harmonic `k` into `result`, row by row.
    pub fn dynamic_stiffness(
        &self,
        k: usize,
        frequency: f64,
        subharmonic: usize,
        result: &mut [Complex<f64>],
    ) {
        let omega = k as f64 * frequency / subharmonic as f64;
        combine(&self.mass, Complex::new(-omega * omega, 0.0), result, true);
        combine(&self.damping, Complex::new(0.0, omega), result, false);
        combine(&self.stiffness, Complex::ONE, result, false);
        if let Some(matrix) = &self.damping_linear {
            combine(matrix, Complex::new(0.0, omega * frequency), result, false);
        }
        if let Some(matrix) = &self.stiffness_quadratic {
            combine(matrix, Complex::new(frequency * frequency, 0.0), result, false);
        }
        if let (0, Some((constant, linear))) = (k, &self.drift) {
            combine(constant, Complex::ONE, result, false);
            if let Some(matrix) = linear {
                combine(matrix, Complex::new(frequency, 0.0), result, false);
            }
        }
    }

    /// Writes its derivative with respect to `Ω` into `result`.
    pub fn dynamic_stiffness_rate(
        &self,
        k: usize,
        frequency: f64,
        subharmonic: usize,
        result: &mut [Complex<f64>],
    ) {
        let ratio = k as f64 / subharmonic as f64;
        combine(
            &self.mass,
            Complex::new(-2.0 * ratio * ratio * frequency, 0.0),
            result,
            true,
        );
        combine(&self.damping, Complex::new(0.0, ratio), result, false);
        if let Some(matrix) = &self.damping_linear {
            combine(matrix, Complex::new(0.0, 2.0 * ratio * frequency), result, false);
        }
        if let Some(matrix) = &self.stiffness_quadratic {
            combine(matrix, Complex::new(2.0 * frequency, 0.0), result, false);
        }
        if let (0, Some((_, Some(matrix)))) = (k, &self.drift) {
            combine(matrix, Complex::ONE, result, false);
        }
    }

    /// The amplitude of the load at harmonic `k` of `Ω/n`, if there is one.
    pub fn load(&self, k: usize, subharmonic: usize) -> Option<&[Complex<f64>]> {
        self.loads
            .iter()
            .find(|(order, _)| order * subharmonic == k)
            .map(|(_, amplitudes)| amplitudes.as_slice())
    }

    /// Checks that the mean position, or the rate of drift, is determined: the condition number of the static stiffness, scaled by the masses to
    /// squared frequencies, is below `1e13`.
    ///
    /// # Errors
    /// [`HarmonicBalanceError::FreeMean`] with the elements that a stiffness would help.
    pub fn check_static(&self, system: &System, frequency: f64) -> Result<(), HarmonicBalanceError> {
        let mut stiffness = self.stiffness.clone();
        if let Some(matrix) = &self.stiffness_quadratic {
            stiffness.add_scaled(frequency * frequency, matrix);
        }
        if let Some((constant, linear)) = &self.drift {
            stiffness.add_scaled(1.0, constant);
            if let Some(matrix) = linear {
                stiffness.add_scaled(frequency, matrix);
            }
        }
        let n = self.order();
        for i in 0..n {
            for j in 0..n {
                stiffness[(i, j)] /= (self.mass[(i, i)] * self.mass[(j, j)]).sqrt();
            }
        }
        if is_regular(&stiffness) {
            return Ok(());
        }
        let scale = stiffness.max_abs().max(frequency * frequency);
        let helps = |port: &Port| {
            let mut held = stiffness.clone();
            for &(i, a) in port.terms() {
                for &(j, b) in port.terms() {
                    held[(i, j)] += a * b * scale;
                }
            }
            is_regular(&held)
        };
        let candidates = system
            .elements
            .iter()
            .filter(|element| element.law.linearized().0 == 0.0 && helps(&element.port))
            .map(|element| element.name.clone())
            .collect();
        Err(HarmonicBalanceError::FreeMean { candidates })
    }
}

fn combine(matrix: &Matrix, factor: Complex<f64>, result: &mut [Complex<f64>], replace: bool) {
    for (out, &entry) in result.iter_mut().zip(matrix.as_slice()) {
        let term = factor * entry;
        *out = if replace { term } else { *out + term };
    }
}

fn is_regular(matrix: &Matrix) -> bool {
    let Ok(lu) = Lu::new(matrix) else { return false };
    let inverse = lu.solve_matrix(&Matrix::identity(matrix.rows()));
    let condition = matrix.norm_infinity() * inverse.norm_infinity();
    condition.is_finite() && condition < 1e13
}
