//! One periodic motion at fixed parameters: damped Newton's method, with the number of harmonics adapted.

use super::balance::{Balance, Derivatives, check_laws};
use super::layout::{pack, resize};
use super::{Adaptation, HarmonicBalanceError, HarmonicOrbit, Settings};
use num_complex::Complex;
use slackside_linalg::{LinalgError, Lu, Matrix, norm};
use slackside_mechanics::OperatingPoint;
use slackside_numerics::fourier::FourierPlanner;

/// Where Newton's method starts.
#[derive(Debug, Clone, Copy)]
pub enum Start<'a> {
    /// At the response with all elements linear.
    Linear,
    /// At given amplitudes `h_0, h_1, …` of the displacement of each element of the system, of any number; `h_0` is the mean
    /// velocity of a port that drifts.
    Harmonics(&'a [Vec<Complex<f64>>]),
    /// At given samples of the displacement of each element, equispaced over one period of the motion.
    Samples(&'a [Vec<f64>]),
}

/// How Newton's method ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolveStop {
    /// The last step was below the tolerance.
    Converged,
    /// The number of iterations was reached.
    IterationLimit,
    /// No fraction of the Newton step reduced the residual.
    Stalled,
    /// The Jacobian was singular: a fold, or a bad start.
    SingularJacobian,
    /// Converged, but the largest number of harmonics left the tail above its limit or the number of switchings unsettled.
    HarmonicLimit,
}

/// What [`solve`] found; the orbit is the last iterate however the iteration ended.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The motion.
    pub orbit: HarmonicOrbit,
    /// How the iteration ended.
    pub stop: SolveStop,
    /// Newton steps in total.
    pub iterations: usize,
    /// Norm of the residual relative to that of the amplitudes.
    pub residual: f64,
}

/// Finds a periodic motion of the system at a fixed operating point.
///
/// # Errors
/// [`HarmonicBalanceError`] if the system, the settings or the start are not sound, or the mean position is not
/// determined. Failure to converge is not an error but a [`SolveStop`].
pub fn solve(
    point: &OperatingPoint,
    start: Start<'_>,
    settings: &Settings,
) -> Result<Solution, HarmonicBalanceError> {
    point.system.check()?;
    check_laws(&point.system)?;
    settings.check(&point.system)?;
    if !(point.frequency.is_finite() && point.frequency > 0.0) {
        return Err(HarmonicBalanceError::Setting {
            name: "frequency",
            value: point.frequency.to_string(),
            range: "positive",
        });
    }
    let mut planner = FourierPlanner::default();
    let mut harmonics = settings.harmonics;
    let mut samples = settings.samples;
    let make = |harmonics, samples, planner: &mut FourierPlanner| {
        Balance::new(point.system.clone(), settings, harmonics, samples, planner)
    };
    let mut balance = make(harmonics, samples, &mut planner);
    balance.linear.check_static(&point.system, point.frequency)?;
    let mut z = first_iterate(&mut balance, point, start)?;
    let mut iterations = 0;
    let mut narrow = matches!(start, Start::Linear);
    let mut switchings = None;
    let (stop, residual) = loop {
        let newton = Newton::run_from_anywhere(&mut balance, &mut z, point.frequency, settings, narrow)?;
        narrow = false;
        iterations += newton.iterations;
        // Too few samples are also a reason why an iteration stalls, but not the only one.
        let refine = newton.stop == SolveStop::Converged || samples <= STALLED_SAMPLES;
        if refine && let Some(finer) = balance.aliased(&z, point.frequency, settings, &mut planner) {
            samples = finer;
            balance = make(harmonics, samples, &mut planner);
            continue;
        }
        if newton.stop != SolveStop::Converged {
            break (newton.stop, newton.residual);
        }
        let Some(rule) = settings.adaptation else {
            break (newton.stop, newton.residual);
        };
        let count = balance.switchings(point.frequency);
        // A motion with switchings is trusted only when one with more harmonics has as many.
        let settled = count == 0 || switchings == Some(count);
        switchings = Some(count);
        if balance.tail() <= rule.tail && settled {
            break (newton.stop, newton.residual);
        }
        if harmonics >= rule.maximum {
            break (SolveStop::HarmonicLimit, newton.residual);
        }
        let larger = enlarged(harmonics, balance.tail(), &rule);
        z = resize(&z, balance.nonlinear.len(), harmonics, larger);
        harmonics = larger;
        balance = make(harmonics, samples, &mut planner);
    };
    let orbit = HarmonicOrbit::recover(&mut balance, &z, point.frequency, &mut planner)?;
    Ok(Solution {
        orbit,
        stop,
        iterations,
        residual,
    })
}

/// The next larger number of harmonics: by the factor 1.5, as often as the tail asks for if amplitudes fall like `k⁻⁴`, as
/// they do at a kink of the force, but at most three times at once.
pub(super) fn enlarged(harmonics: usize, tail: f64, rule: &Adaptation) -> usize {
    let times = ((tail / rule.tail).ln() / (3.5 * 1.5_f64.ln()))
        .ceil()
        .clamp(1.0, 3.0);
    let wanted = (harmonics as f64 * 1.5_f64.powf(times)).ceil() as usize;
    wanted.max(harmonics + 1).min(rule.maximum)
}

fn first_iterate(
    balance: &mut Balance,
    point: &OperatingPoint,
    start: Start<'_>,
) -> Result<Vec<f64>, HarmonicBalanceError> {
    let elements = point.system.elements.len();
    let count = |found: usize| match found == elements {
        true => Ok(()),
        false => Err(HarmonicBalanceError::Start {
            what: "elements",
            expected: elements,
            found,
        }),
    };
    let order = 2 * balance.harmonics + 1;
    let mut z = vec![0.0; balance.dimension()];
    let mut port = vec![Complex::ZERO; balance.harmonics + 1];
    match start {
        Start::Linear => return balance.linear_response(point.frequency),
        Start::Harmonics(given) => {
            count(given.len())?;
            for (i, &element) in balance.nonlinear.iter().enumerate() {
                for (k, h) in port.iter_mut().enumerate() {
                    *h = given[element].get(k).copied().unwrap_or_default();
                }
                pack(&port, &mut z[i * order..(i + 1) * order]);
            }
        }
        Start::Samples(given) => {
            count(given.len())?;
            let mut planner = FourierPlanner::default();
            for (i, &element) in balance.nonlinear.iter().enumerate() {
                let samples = &given[element];
                if samples.len() < 2 {
                    return Err(HarmonicBalanceError::Start {
                        what: "samples",
                        expected: 2,
                        found: samples.len(),
                    });
                }
                planner.transform(samples.len()).analyze(samples, &mut port);
                pack(&port, &mut z[i * order..(i + 1) * order]);
            }
        }
    }
    Ok(z)
}

/// Largest number of samples up to which an iteration that has not converged is tried again with more.
const STALLED_SAMPLES: usize = 2048;
/// Factor by which transitions at rest narrow from one solution to the next.
const NARROWING: f64 = 3.0;
/// Tolerance of the solutions on that way.
const NARROWING_TOLERANCE: f64 = 1e-2;
/// Smallest step of the share of the remainder forces on the way from the linear response.
const SMALLEST_SHARE: f64 = 0.02;
/// Full steps taken at first, whether or not they reduce the residual: with switching angles nearly settled the equations are
/// linear, and these few steps end it.
const FREE_STEPS: usize = 8;
/// Smallest fraction of a Newton step that is tried.
const SMALLEST_FRACTION: f64 = 1e-4;
/// How often a full step is taken after all where no fraction of it reduces the residual.
const ESCAPES: usize = 4;

/// Outcome of Newton's method for one number of harmonics.
struct Newton {
    stop: SolveStop,
    iterations: usize,
    residual: f64,
}

impl Newton {
    /// Newton's method from `z`; if it fails, from the linear response with transitions at rest narrowed to their true width,
    /// or with the remainder forces raised in steps from zero to their full size. `z` keeps the better of the two last
    /// iterates. `narrow` goes the first of these ways at once, where there are transitions.
    fn run_from_anywhere(
        balance: &mut Balance,
        z: &mut [f64],
        frequency: f64,
        settings: &Settings,
        narrow: bool,
    ) -> Result<Self, HarmonicBalanceError> {
        let mut spent = 0;
        if narrow && balance.has_transitions() {
            let narrowed = Self::run_narrowing(balance, z, frequency, settings)?;
            if narrowed.stop == SolveStop::Converged {
                return Ok(narrowed);
            }
            spent = narrowed.iterations;
        }
        let mut direct = Self::run(balance, z, frequency, settings, 1.0, FREE_STEPS)?;
        direct.iterations += spent;
        if direct.stop == SolveStop::Converged {
            return Ok(direct);
        }
        if !narrow && balance.has_transitions() {
            let mut trial = z.to_vec();
            let narrowed = Self::run_narrowing(balance, &mut trial, frequency, settings)?;
            direct.iterations += narrowed.iterations;
            if narrowed.stop == SolveStop::Converged {
                z.copy_from_slice(&trial);
                return Ok(Self {
                    iterations: direct.iterations,
                    ..narrowed
                });
            }
        }
        let mut reached = balance.linear_response(frequency)?;
        let (mut share, mut step) = (0.0_f64, 0.25);
        while step >= SMALLEST_SHARE {
            let next = (share + step).min(1.0);
            let mut trial = reached.clone();
            let raised = Self::run(balance, &mut trial, frequency, settings, next, FREE_STEPS)?;
            direct.iterations += raised.iterations;
            if raised.stop != SolveStop::Converged {
                step *= 0.5;
                continue;
            }
            if next == 1.0 {
                z.copy_from_slice(&trial);
                return Ok(Self {
                    iterations: direct.iterations,
                    ..raised
                });
            }
            (share, reached) = (next, trial);
            step *= 1.5;
        }
        Ok(direct)
    }

    /// Newton's method from the linear response for transitions at rest that are wide at first and a third as wide each time
    /// (theory 05 §5.3). Laws that are monotone let every damped step reduce the residual.
    fn run_narrowing(
        balance: &mut Balance,
        z: &mut [f64],
        frequency: f64,
        settings: &Settings,
    ) -> Result<Self, HarmonicBalanceError> {
        let linear = balance.linear_response(frequency)?;
        z.copy_from_slice(&linear);
        let rough = Settings {
            tolerance: NARROWING_TOLERANCE,
            ..settings.clone()
        };
        let (mut divisor, mut iterations) = (1.0, 0);
        loop {
            let widened = balance.widen(&linear, frequency, divisor);
            let chosen = if widened { &rough } else { settings };
            let found = Self::run(balance, z, frequency, chosen, 1.0, 0)?;
            iterations += found.iterations;
            if !widened {
                return Ok(Self { iterations, ..found });
            }
            divisor *= NARROWING;
        }
    }

    /// Newton's method for the given share of the remainder forces: `free` full steps, then steps halved until the residual falls. `z` ends at the best iterate. The steps are measured by port, relative to the
    /// amplitudes there.
    fn run(
        balance: &mut Balance,
        z: &mut [f64],
        frequency: f64,
        settings: &Settings,
        share: f64,
        free: usize,
    ) -> Result<Self, HarmonicBalanceError> {
        let n = balance.dimension();
        let mut residual = vec![0.0; n];
        let mut jacobian = Matrix::zeros(n, n);
        let mut trial = vec![0.0; n];
        let linear = balance.linear_response(frequency)?;
        let scales = scales(&linear, z, balance.nonlinear.len());
        let order = 2 * balance.harmonics + 1;
        let size = |vector: &[f64]| -> f64 {
            let sum: f64 = vector
                .iter()
                .enumerate()
                .map(|(i, v)| (v / scales[i / order]).powi(2))
                .sum();
            sum.sqrt()
        };
        let derivatives = Derivatives {
            jacobian: Some(&mut jacobian),
            by_frequency: None,
        };
        balance.evaluate(z, frequency, &mut residual, derivatives)?;
        scale_remainder(&mut residual, &mut jacobian, z, &linear, share);
        let mut before = size(&residual);
        let (mut best, mut least) = (z.to_vec(), before);
        let (mut free, mut escapes) = (free, ESCAPES);
        let end = |stop, iterations, residual| {
            Ok(Self {
                stop,
                iterations,
                residual,
            })
        };
        if n == 0 {
            return end(SolveStop::Converged, 0, 0.0);
        }
        for iteration in 1..=settings.iterations {
            let lu = match Lu::new(&jacobian) {
                Ok(lu) => lu,
                Err(LinalgError::Singular | LinalgError::NotFinite) => {
                    z.copy_from_slice(&best);
                    return end(SolveStop::SingularJacobian, iteration, least);
                }
                Err(error) => return Err(error.into()),
            };
            let step = lu.solve(&residual);
            let length = size(&step);
            let mut fraction = 1.0;
            let after = loop {
                for i in 0..n {
                    trial[i] = z[i] - fraction * step[i];
                }
                let derivatives = Derivatives {
                    jacobian: Some(&mut jacobian),
                    by_frequency: None,
                };
                balance.evaluate(&trial, frequency, &mut residual, derivatives)?;
                scale_remainder(&mut residual, &mut jacobian, &trial, &linear, share);
                let after = size(&residual);
                // Near the solution the residual is rounding and need not fall.
                let falls = after < before || (length <= 1e-7 && after <= 1e-11);
                if falls || (free > 0 && after.is_finite()) {
                    free = free.saturating_sub(1);
                    break after;
                }
                fraction *= 0.5;
                if fraction < SMALLEST_FRACTION {
                    if escapes == 0 {
                        z.copy_from_slice(&best);
                        return end(SolveStop::Stalled, iteration, least);
                    }
                    escapes -= 1;
                    (free, fraction) = (1, 1.0);
                }
            };
            z.copy_from_slice(&trial);
            before = after;
            if after < least {
                least = after;
                best.copy_from_slice(z);
            }
            if fraction == 1.0 && length <= settings.tolerance {
                return end(SolveStop::Converged, iteration, before);
            }
            // Quadratic convergence: the error left by a full step is about the square of the step, and a residual at
            // rounding level cannot be improved.
            if fraction == 1.0 && length <= 1e-7 && before <= settings.tolerance {
                return end(SolveStop::Converged, iteration, before);
            }
        }
        z.copy_from_slice(&best);
        end(SolveStop::IterationLimit, settings.iterations, least)
    }
}

/// Turns residual and Jacobian into those of a share `s` of the remainder forces: `u − u_lin + s R N = s r + (1 − s)(u − u_lin)`.
fn scale_remainder(residual: &mut [f64], jacobian: &mut Matrix, z: &[f64], linear: &[f64], share: f64) {
    if share == 1.0 {
        return;
    }
    for (i, r) in residual.iter_mut().enumerate() {
        *r = share * *r + (1.0 - share) * (z[i] - linear[i]);
    }
    jacobian.as_mut_slice().iter_mut().for_each(|v| *v *= share);
    for i in 0..residual.len() {
        jacobian[(i, i)] += 1.0 - share;
    }
}

/// Size of each port's amplitudes: the larger of linear response and start, or one where both vanish.
fn scales(linear: &[f64], z: &[f64], ports: usize) -> Vec<f64> {
    let order = z.len() / ports.max(1);
    (0..ports)
        .map(|i| {
            let part = i * order..(i + 1) * order;
            let scale = norm(&linear[part.clone()]).max(norm(&z[part]));
            if scale > 0.0 { scale } else { 1.0 }
        })
        .collect()
}
