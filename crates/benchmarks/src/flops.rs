//! Floating-point operations, estimated from counted events and evaluations and from the sizes of the tables
//! (2 coordinates: a state of 4, augmented 7; Taylor polynomials of 24 terms). A multiply-add is two operations.

const STATE: f64 = 4.0;
const AUGMENTED: f64 = 7.0;
const TERMS: f64 = 24.0;

/// Places of a look-ahead.
const CELLS: f64 = 16.0;

/// A guard's Taylor coefficients and the short certificate.
const FULL_TEST: f64 = 2.0 * TERMS * AUGMENTED + 2.0 * 64.0 + TERMS;

/// The state within a step: its polynomial and one evaluation.
const PARTIAL_STEP: f64 = 2.0 * TERMS * STATE * (AUGMENTED + 1.0);

/// One event of a long run with the way to it: one look-ahead, two full tests, about ten cells checked by their bounds, four
/// Newton evaluations of value and slope, and the state at the event.
pub(crate) const EVENT: f64 =
    2.0 * AUGMENTED * CELLS * STATE + 2.0 * FULL_TEST + 10.0 * 24.0 + 4.0 * 4.0 * TERMS + PARTIAL_STEP;

/// One map with derivatives at frequency `omega` for a regime of spectral radius `radius`: the harmonic columns of two
/// regimes with their derivatives, full steps with variations, and three partial steps.
pub(crate) fn map(omega: f64, radius: f64) -> f64 {
    let steps = std::f64::consts::TAU / omega * radius.max(1.3 * omega) / 2.0;
    let tables = 2.0 * 2.0 * TERMS * 2.0 * (3.0 * STATE + 2.0 * AUGMENTED);
    let full_step = FULL_TEST + 2.0 * STATE * (STATE * (STATE + 1.0) + 2.0 * AUGMENTED);
    let partial = FULL_TEST + 2.0 * PARTIAL_STEP + 2.0 * TERMS * STATE * STATE;
    tables + steps * full_step + 3.0 * partial
}

/// One sample of a settled motion in closed form.
pub(crate) const SETTLED_SAMPLE: f64 = 4.0 * 8.0;
