//! Lyapunov exponents by orthogonalisation of the linearised map over each period (theory 02 §9.2).

use crate::flow::{Flow, FlowError};
use slackside_linalg::{Matrix, orthonormalize};
use std::f64::consts::TAU;

/// How long and how many exponents.
#[derive(Debug, Clone, PartialEq)]
pub struct LyapunovOptions {
    /// Periods during which the directions align before anything is counted.
    pub alignment: usize,
    /// Periods that are counted.
    pub periods: usize,
    /// Equal blocks of the counted periods from which the standard error is estimated; at least two.
    pub blocks: usize,
    /// Number of leading exponents; `None` for all `2n`.
    pub count: Option<usize>,
}

impl Default for LyapunovOptions {
    /// 200 periods of alignment, 5 blocks of 1000 periods, all exponents.
    fn default() -> Self {
        Self {
            alignment: 200,
            periods: 5000,
            blocks: 5,
            count: None,
        }
    }
}

/// Lyapunov exponents of one motion.
#[derive(Debug, Clone, PartialEq)]
pub struct LyapunovSpectrum {
    /// Exponents per unit of time, falling. An exponent is `−∞` if events squeeze its direction to nothing.
    pub exponents: Vec<f64>,
    /// Standard error of each, from the scatter of its means over the blocks.
    pub standard_errors: Vec<f64>,
    /// Periods counted.
    pub periods: usize,
    /// Time counted.
    pub time: f64,
}

impl LyapunovSpectrum {
    /// Sum of the exponents. If all were computed it is the mean divergence of the field, which for a system whose
    /// damping does not switch is `−tr(M⁻¹C)` exactly.
    pub fn sum(&self) -> f64 {
        self.exponents.iter().sum()
    }

    /// How far from zero exponent `i` must lie to count as different from zero: three standard errors, and at least the
    /// exponent of a growth by the factor 10 over all the time counted.
    pub fn resolution(&self, i: usize) -> f64 {
        (3.0 * self.standard_errors[i]).max(10.0_f64.ln() / self.time)
    }

    /// Number of exponents that are certainly positive.
    pub fn positive(&self) -> usize {
        (0..self.exponents.len())
            .filter(|&i| self.exponents[i] > self.resolution(i))
            .count()
    }
}

/// Lyapunov exponents along the motion from `state`, which moves along. The flow must have been made without a rate
/// ([`crate::flow::open`]), so that all columns are variations of the state. Cost per period: the flow with as many
/// columns as exponents, and `O(n · count²)`.
///
/// # Errors
/// [`FlowError`].
pub fn lyapunov(
    flow: &mut dyn Flow,
    state: &mut [f64],
    options: &LyapunovOptions,
) -> Result<LyapunovSpectrum, FlowError> {
    let nx = flow.dimension();
    let count = options.count.unwrap_or(nx).clamp(1, nx);
    let blocks = options.blocks.max(2);
    let block = options.periods.div_ceil(blocks).max(1);
    let period = TAU / flow.frequency();

    let mut directions = Matrix::zeros(nx, count);
    for i in 0..count {
        directions[(i, i)] = 1.0;
    }
    let mut columns = vec![0.0; nx * count];
    let mut step = |directions: &mut Matrix| -> Result<Vec<f64>, FlowError> {
        for j in 0..count {
            for i in 0..nx {
                columns[j * nx + i] = directions[(i, j)];
            }
        }
        flow.advance(state, 1, &mut columns)?;
        for j in 0..count {
            for i in 0..nx {
                directions[(i, j)] = columns[j * nx + i];
            }
        }
        Ok(orthonormalize(directions))
    };

    for _ in 0..options.alignment {
        step(&mut directions)?;
    }
    let mut means = Vec::with_capacity(blocks);
    for _ in 0..blocks {
        let mut sums = vec![0.0; count];
        for _ in 0..block {
            for (sum, length) in sums.iter_mut().zip(step(&mut directions)?) {
                *sum += length.ln();
            }
        }
        sums.iter_mut().for_each(|sum| *sum /= block as f64 * period);
        means.push(sums);
    }
    let periods = blocks * block;
    let mut pairs: Vec<(f64, f64)> = (0..count)
        .map(|i| mean_and_error(means.iter().map(|block| block[i])))
        .collect();
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (exponents, standard_errors) = pairs.into_iter().unzip();
    Ok(LyapunovSpectrum {
        exponents,
        standard_errors,
        periods,
        time: periods as f64 * period,
    })
}

/// Mean of block means and its standard error; an infinite mean has none.
fn mean_and_error(values: impl ExactSizeIterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.clone().sum::<f64>() / count;
    if mean.is_infinite() {
        return (mean, 0.0);
    }
    let square = values.map(|value| (value - mean).powi(2)).sum::<f64>();
    (mean, (square / (count * (count - 1.0))).sqrt())
}
