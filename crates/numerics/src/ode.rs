//! Adaptive integration of smooth ordinary differential equations `y' = f(t, y)`: the Dormand–Prince method 8(5,3) with
//! its interpolant of order seven (Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, §II.5 and §II.6).
//!
//! Of its own because the crate found for it, differential-equations 0.7, interpolates wrongly (two factors of the nested
//! form are exchanged: an oscillator integrated to 3e-12 is interpolated to 5e-8), allocates at every stage and computes
//! the three stages of the interpolant whether they are wanted or not.

mod tableau;

use tableau::{DENSE, END, ERROR_5, NODES, Row, SOLUTION_3, STAGES, WEIGHTS};

/// Coefficients of the interpolant per entry.
const TERMS: usize = 8;

/// Accuracy that is asked of the solution.
///
/// An entry's error per step is measured against `relative · max(|y|, floor)`, with `|y|` the largest modulus the entry has
/// had so far. Errors are averaged (root mean square) over each block of entries, and the worst block decides.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// Relative tolerance of each entry.
    pub relative: Vec<f64>,
    /// Modulus below which an entry's error is not measured any finer, of each entry; positive.
    pub floor: Vec<f64>,
    /// Entries per block; divides their number.
    pub block: usize,
}

/// Bounds on the effort.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Longest step.
    pub max_step: f64,
    /// Largest number of steps of one call, rejected ones included.
    pub max_steps: usize,
}

/// Why an integration stopped early.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum OdeError {
    /// The tolerance would need steps below rounding.
    #[error(
        "the step fell to {step:.1e} at t = {time}; is the tolerance finer than the equations can be evaluated?"
    )]
    StepTooSmall {
        /// Time reached.
        time: f64,
        /// Step that was to be tried.
        step: f64,
    },
    /// The largest number of steps was used up.
    #[error("{steps} steps were not enough, t = {time} was reached; are the equations stiff?")]
    TooManySteps {
        /// Time reached.
        time: f64,
        /// Steps taken.
        steps: usize,
    },
    /// The solution or its derivative is not a finite number.
    #[error("the solution is not finite beyond t = {time}")]
    NotFinite {
        /// Time reached.
        time: f64,
    },
}

/// Effort spent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Steps accepted.
    pub steps: usize,
    /// Steps rejected.
    pub rejected: usize,
    /// Evaluations of the right-hand side.
    pub evaluations: usize,
}

/// An accepted step with its interpolant.
#[derive(Debug, Clone, Copy)]
pub struct DenseStep<'a> {
    /// Time at its start.
    pub start: f64,
    /// Its length in time.
    pub length: f64,
    /// Blocks of the dimension's length.
    coefficients: &'a [f64],
}

impl DenseStep<'_> {
    /// The solution at the share `s` of the step, `0 ≤ s ≤ 1`, for as many leading entries as `y` has.
    ///
    /// `c₀ + s (c₁ + r (c₂ + s (c₃ + r (c₄ + s (c₅ + r (c₆ + s c₇))))))` with `r = 1 − s`.
    pub fn at(&self, s: f64, y: &mut [f64]) {
        let n = self.coefficients.len() / TERMS;
        let r = 1.0 - s;
        for (i, value) in y.iter_mut().enumerate() {
            let c = |term: usize| self.coefficients[term * n + i];
            *value =
                c(0) + s * (c(1) + r * (c(2) + s * (c(3) + r * (c(4) + s * (c(5) + r * (c(6) + s * c(7)))))));
        }
    }
}

/// The integrator: workspace, step control and statistics.
#[derive(Debug, Clone)]
pub struct DormandPrince {
    dimension: usize,
    tolerance: Tolerance,
    limits: Limits,
    /// Largest modulus of each entry since the last restart, at least its floor.
    sizes: Vec<f64>,
    /// Step to try next; `None` after a restart.
    step: Option<f64>,
    stages: Vec<f64>,
    trial: Vec<f64>,
    sum: Vec<f64>,
    coefficients: Vec<f64>,
    statistics: Statistics,
}

/// Factors by which the step may change at once.
const CHANGE: (f64, f64) = (1.0 / 3.0, 6.0);

/// Share of the step that is estimated to meet the tolerance.
const SAFETY: f64 = 0.9;

/// What looks at accepted steps.
pub type Observer<'a> = &'a mut dyn FnMut(&DenseStep<'_>);

impl DormandPrince {
    /// An integrator for as many equations as the tolerance has entries.
    pub fn new(tolerance: Tolerance, limits: Limits) -> Self {
        let dimension = tolerance.floor.len();
        debug_assert_eq!(tolerance.relative.len(), dimension);
        Self {
            dimension,
            sizes: tolerance.floor.clone(),
            tolerance,
            limits,
            step: None,
            stages: vec![0.0; STAGES * dimension],
            trial: vec![0.0; dimension],
            sum: vec![0.0; dimension],
            coefficients: vec![0.0; TERMS * dimension],
            statistics: Statistics::default(),
        }
    }

    /// Number of equations.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Changes the bounds on the effort.
    pub fn set_limits(&mut self, limits: Limits) {
        self.limits = limits;
    }

    /// Forgets the step length and the sizes of entries, so that results do not depend on earlier calls.
    pub fn restart(&mut self) {
        self.step = None;
        self.sizes.copy_from_slice(&self.tolerance.floor);
    }

    /// Effort spent since the integrator was made.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// Integrates from `start` to the later time `end`. The step length and the sizes of entries carry over from the call
    /// before unless there was a [`Self::restart`]. The interpolant costs three more evaluations a step and is computed
    /// only for an observer.
    ///
    /// # Errors
    /// [`OdeError`]; `y` is then the solution at the time reached.
    pub fn integrate(
        &mut self,
        equations: &mut impl FnMut(f64, &[f64], &mut [f64]),
        start: f64,
        end: f64,
        y: &mut [f64],
        mut observer: Option<Observer<'_>>,
    ) -> Result<(), OdeError> {
        let n = self.dimension;
        let span = end - start;
        let smallest = 4.0 * f64::EPSILON * start.abs().max(end.abs()).max(span);
        let mut time = start;
        self.raise_sizes(y);
        equations(time, y, &mut self.stages[..n]);
        self.statistics.evaluations += 1;
        let mut step = match self.step {
            Some(step) => step,
            None => self.first_step(equations, time, y, span),
        };
        let mut tried = 0;
        while end - time > smallest {
            let remaining = end - time;
            step = step.min(self.limits.max_step);
            let last = step >= 0.99 * remaining;
            let h = if last { remaining } else { step };
            if step < smallest {
                return Err(OdeError::StepTooSmall { time, step });
            }
            if tried == self.limits.max_steps {
                return Err(OdeError::TooManySteps { time, steps: tried });
            }
            tried += 1;
            self.try_step(equations, time, h, y);
            let error = self.error(h);
            if !error.is_finite() {
                self.statistics.rejected += 1;
                step = 0.1 * h;
                if step < smallest {
                    return Err(OdeError::NotFinite { time });
                }
                continue;
            }
            let change = (SAFETY * error.powf(-0.125)).clamp(CHANGE.0, CHANGE.1);
            if error > 1.0 {
                self.statistics.rejected += 1;
                step = h * change.min(SAFETY);
                continue;
            }
            let next = if last { end } else { time + h };
            self.evaluate(END, equations, next);
            if let Some(observer) = observer.as_mut() {
                self.interpolate(equations, time, h, y);
                observer(&DenseStep {
                    start: time,
                    length: h,
                    coefficients: &self.coefficients,
                });
            }
            y.copy_from_slice(&self.trial);
            let (first, rest) = self.stages.split_at_mut(n);
            first.copy_from_slice(&rest[(END - 1) * n..END * n]);
            self.raise_sizes(y);
            self.statistics.steps += 1;
            time = next;
            // A step cut short by the end says little about the next one.
            step = if last { step.max(h * change) } else { h * change };
        }
        self.step = Some(step);
        Ok(())
    }

    fn raise_sizes(&mut self, y: &[f64]) {
        for (size, value) in self.sizes.iter_mut().zip(y) {
            *size = size.max(value.abs());
        }
    }

    /// Computes the stages of a step of length `h` and leaves its end in `trial`.
    fn try_step(
        &mut self,
        equations: &mut impl FnMut(f64, &[f64], &mut [f64]),
        time: f64,
        h: f64,
        y: &[f64],
    ) {
        for stage in 1..END {
            self.combine(WEIGHTS[stage], h, y);
            self.evaluate(stage, equations, time + NODES[stage] * h);
        }
        self.combine(WEIGHTS[END], h, y);
    }

    /// `trial = y + h Σ weight · stage`.
    fn combine(&mut self, row: Row, h: f64, y: &[f64]) {
        weighted_sum(row, &self.stages, &mut self.sum);
        for ((trial, sum), y) in self.trial.iter_mut().zip(&self.sum).zip(y) {
            *trial = y + h * sum;
        }
    }

    /// Evaluates the right-hand side at `trial` into a stage.
    fn evaluate(&mut self, stage: usize, equations: &mut impl FnMut(f64, &[f64], &mut [f64]), time: f64) {
        let n = self.dimension;
        equations(time, &self.trial, &mut self.stages[stage * n..(stage + 1) * n]);
        self.statistics.evaluations += 1;
    }

    /// Error of the step relative to the tolerance, from both estimates, in the worst block.
    fn error(&mut self, h: f64) -> f64 {
        let n = self.dimension;
        let block = self.tolerance.block;
        // Space of the interpolant, which is computed afterwards.
        let (fifth, third) = self.coefficients[..2 * n].split_at_mut(n);
        weighted_sum(ERROR_5, &self.stages, fifth);
        weighted_sum(WEIGHTS[END], &self.stages, third);
        for &(stage, weight) in SOLUTION_3 {
            for (sum, k) in third.iter_mut().zip(&self.stages[stage * n..(stage + 1) * n]) {
                *sum -= weight * k;
            }
        }
        let mut worst = 0.0_f64;
        for first in (0..n).step_by(block) {
            let (mut five, mut three) = (0.0, 0.0);
            for i in first..first + block {
                let allowed = self.tolerance.relative[i] * self.sizes[i].max(self.trial[i].abs());
                five += (fifth[i] / allowed).powi(2);
                three += (third[i] / allowed).powi(2);
            }
            let total = five + 0.01 * three;
            if total.is_nan() || total.is_infinite() {
                return f64::NAN;
            }
            if total > 0.0 {
                worst = worst.max(h * five / (total * block as f64).sqrt());
            }
        }
        worst
    }

    /// Coefficients of the interpolant of the step from `y` to `trial`; leaves `trial` as it was.
    fn interpolate(
        &mut self,
        equations: &mut impl FnMut(f64, &[f64], &mut [f64]),
        time: f64,
        h: f64,
        y: &[f64],
    ) {
        let n = self.dimension;
        let end = self.trial.clone();
        for stage in END + 1..STAGES {
            self.combine(WEIGHTS[stage], h, y);
            self.evaluate(stage, equations, time + NODES[stage] * h);
        }
        self.trial.copy_from_slice(&end);
        for (term, row) in DENSE.iter().enumerate() {
            let target = &mut self.coefficients[(4 + term) * n..(5 + term) * n];
            weighted_sum(row, &self.stages, target);
            target.iter_mut().for_each(|value| *value *= h);
        }
        for i in 0..n {
            let difference = end[i] - y[i];
            let bend = h * self.stages[i] - difference;
            self.coefficients[i] = y[i];
            self.coefficients[n + i] = difference;
            self.coefficients[2 * n + i] = bend;
            self.coefficients[3 * n + i] = difference - h * self.stages[END * n + i] - bend;
        }
    }

    /// A first step from the sizes of the first and second derivative (Hairer, Nørsett and Wanner, §II.4).
    fn first_step(
        &mut self,
        equations: &mut impl FnMut(f64, &[f64], &mut [f64]),
        time: f64,
        y: &[f64],
        span: f64,
    ) -> f64 {
        let n = self.dimension;
        let sizes = &self.sizes;
        let norm = |value: &dyn Fn(usize) -> f64| {
            (0..n).fold(0.0_f64, |worst, i| worst.max((value(i) / sizes[i]).abs()))
        };
        let slope = norm(&|i| self.stages[i]);
        let trial = (0.01 / slope).min(self.limits.max_step).min(span);
        for i in 0..n {
            self.trial[i] = y[i] + trial * self.stages[i];
        }
        equations(time + trial, &self.trial, &mut self.sum);
        self.statistics.evaluations += 1;
        let bend = norm(&|i| (self.sum[i] - self.stages[i]) / trial);
        let tolerance = self.tolerance.relative.iter().copied().fold(1.0, f64::min);
        let step = (0.01 * tolerance / slope.max(bend).max(1e-15)).powf(0.125);
        if step.is_finite() {
            step.min(100.0 * trial)
        } else {
            1e-3 * trial.min(span)
        }
    }
}

/// `out = Σ weight · stage`.
fn weighted_sum(row: Row, stages: &[f64], out: &mut [f64]) {
    let n = out.len();
    out.fill(0.0);
    for &(stage, weight) in row {
        for (sum, k) in out.iter_mut().zip(&stages[stage * n..(stage + 1) * n]) {
            *sum += weight * k;
        }
    }
}

#[cfg(test)]
mod tests;
