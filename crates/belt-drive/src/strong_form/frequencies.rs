//! Natural frequencies of the strong form: Newton's method on `N(ω) x = 0`, `x_m = 1`.

use super::assembly::Scales;
use super::{Motion, StrongForm, StrongFormError};
use slackside_linalg::{Complex, ComplexLu, ComplexMatrix, LinalgError};
use std::f64::consts::PI;

/// Inverse iterations at the estimate, which turn any start towards the nearest natural motion.
const INVERSE_ITERATIONS: usize = 4;

/// Newton steps.
const STEPS: usize = 40;

/// Relative step of the difference for `dN/dω`. Only the speed of convergence depends on the derivative.
const DIFFERENCE: f64 = 1e-5;

/// Starts per mean distance of natural frequencies in a scan.
const STARTS: f64 = 8.0;

/// Relative distance below which two natural frequencies found by a scan are the same.
const SAME: f64 = 1e-9;

/// A natural motion.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalMotion {
    /// Angular frequency, rad/s: `e^{iωt}` decays at the rate of the imaginary part, which is zero to rounding without
    /// damping.
    pub frequency: Complex,
    /// Its shape, to an arbitrary factor.
    pub motion: Motion,
    /// Change of the frequency in the last Newton step, relative: an upper bound of what further steps would do.
    pub last_change: f64,
}

impl NaturalMotion {
    /// The real part in Hz.
    pub fn hertz(&self) -> f64 {
        self.frequency.re / (2.0 * PI)
    }
}

impl StrongForm<'_> {
    /// The natural motion to which an estimate of the angular frequency (rad/s; complex with damping) leads, usually the
    /// nearest one.
    ///
    /// # Errors
    /// [`StrongFormError::Frequency`], [`StrongFormError::NoConvergence`] or [`StrongFormError::Linalg`].
    pub fn natural_motion(&self, estimate: Complex) -> Result<NaturalMotion, StrongFormError> {
        if !(estimate.is_finite() && estimate.re > 0.0) {
            return Err(StrongFormError::Frequency { found: estimate.re });
        }
        let scales = self.scales(estimate);
        let mut frequency = estimate;
        let count = scales.rows.len();
        // Any start that is not orthogonal to the mode.
        let mut shape: Vec<Complex> = (0..count)
            .map(|k| Complex::new((1.0 + k as f64).cos(), (2.0 + 3.0 * k as f64).sin()))
            .collect();
        let (factors, slope) = self.linearised(&mut frequency, &scales)?;
        for _ in 0..INVERSE_ITERATIONS {
            shape = factors.solve(&slope.times(&shape));
            normalise(&mut shape);
        }
        let mut last_change = f64::INFINITY;
        for _ in 0..STEPS {
            let (factors, slope) = self.linearised(&mut frequency, &scales)?;
            let fixed = normalise(&mut shape);
            let next = factors.solve(&slope.times(&shape));
            let change = -next[fixed].inv();
            frequency += change;
            shape = next;
            normalise(&mut shape);
            let relative = change.norm() / frequency.norm();
            if !relative.is_finite() || frequency.re <= 0.0 {
                break;
            }
            // Converged, or as far as rounding allows.
            if relative < 1e-14 || (relative < 1e-11 && relative >= 0.5 * last_change) {
                return Ok(NaturalMotion {
                    frequency,
                    motion: self.motion(frequency, &shape, &scales),
                    last_change: relative,
                });
            }
            last_change = relative;
        }
        Err(StrongFormError::NoConvergence {
            estimate: estimate.re,
        })
    }

    /// Natural motions with real parts of the frequency between `low` and `high` (rad/s), ascending, from starts spread over
    /// that range. With damping the starts are undamped frequencies, so that strongly damped motions can be missed.
    ///
    /// # Errors
    /// [`StrongFormError::Frequency`] or [`StrongFormError::Linalg`].
    pub fn natural_motions(&self, low: f64, high: f64) -> Result<Vec<NaturalMotion>, StrongFormError> {
        if !(low.is_finite() && low > 0.0) {
            return Err(StrongFormError::Frequency { found: low });
        }
        // Density of the frequencies of the spans as strings, and all others within the range.
        let per_frequency: f64 = self
            .continua
            .iter()
            .map(|span| {
                let wave_speed = (span.speed.powi(2) + span.tension / span.mass).sqrt();
                span.length * wave_speed * span.mass / (PI * span.tension)
            })
            .sum();
        let others = self.drive.pulleys.len() + self.accessories.len() + self.arms.len();
        let starts = (STARTS * (per_frequency * (high - low) + others as f64))
            .ceil()
            .max(1.0) as usize;
        let mut found: Vec<NaturalMotion> = Vec::new();
        for k in 0..starts {
            let start = low + (high - low) * (k as f64 + 0.5) / starts as f64;
            let motion = match self.natural_motion(start.into()) {
                Ok(motion) => motion,
                Err(StrongFormError::NoConvergence { .. }) => continue,
                Err(error) => return Err(error),
            };
            let is_new = found
                .iter()
                .all(|other| (other.frequency - motion.frequency).norm() > SAME * motion.frequency.norm());
            if is_new && (low..=high).contains(&motion.frequency.re) {
                found.push(motion);
            }
        }
        found.sort_by(|a, b| a.frequency.re.total_cmp(&b.frequency.re));
        Ok(found)
    }

    /// `N(ω)`, factorised, and `dN/dω`. An exactly singular `N` moves the frequency by a rounding.
    fn linearised(
        &self,
        frequency: &mut Complex,
        scales: &Scales,
    ) -> Result<(ComplexLu, ComplexMatrix), StrongFormError> {
        let factors = match self.system(*frequency, scales).lu() {
            Err(LinalgError::Singular) => {
                *frequency *= 1.0 + 8.0 * f64::EPSILON;
                self.system(*frequency, scales).lu()
            }
            other => other,
        }
        .map_err(|source| StrongFormError::Linalg {
            frequency: frequency.re,
            source,
        })?;
        let half = DIFFERENCE * *frequency;
        let (mut slope, before) = (
            self.system(*frequency + half, scales),
            self.system(*frequency - half, scales),
        );
        for i in 0..slope.rows() {
            for j in 0..slope.columns() {
                slope[(i, j)] = (slope[(i, j)] - before[(i, j)]) / (2.0 * half);
            }
        }
        Ok((factors, slope))
    }
}

/// Scales a vector so that its largest entry is one; returns its place.
fn normalise(vector: &mut [Complex]) -> usize {
    let place = (0..vector.len())
        .max_by(|a, b| vector[*a].norm_sqr().total_cmp(&vector[*b].norm_sqr()))
        .unwrap_or_default();
    let factor = vector.get(place).map_or(Complex::new(1.0, 0.0), Complex::inv);
    vector.iter_mut().for_each(|value| *value *= factor);
    place
}
