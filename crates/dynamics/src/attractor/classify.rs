//! Which kind of motion has settled: periodic, quasi-periodic or chaotic (theory 02 §9.3).

use super::lyapunov::{LyapunovOptions, LyapunovSpectrum, lyapunov};
use super::periodic::{PeriodicAttractor, Recognition, RecognitionOptions, Recognizer};
use super::poincare::stroboscopic;
use super::rotation_number::{RotationError, RotationNumber, rotation_number};
use crate::flow::{Flow, FlowError};

/// How a settled motion is classified.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassifyOptions {
    /// How periodic motions are recognised.
    pub recognition: RecognitionOptions,
    /// Lyapunov exponents of motions that do not repeat.
    pub lyapunov: LyapunovOptions,
    /// Periods over which a rotation number is taken.
    pub rotation_periods: usize,
    /// Largest change of the rotation number between all and half of those periods.
    pub rotation_tolerance: f64,
    /// Further periods if a motion has not settled; doubled each time.
    pub further_periods: usize,
    /// How often.
    pub rounds: usize,
}

impl Default for ClassifyOptions {
    /// Four leading exponents over 5000 periods, the rotation number over 4096 to 1e-6; 1000, 2000 and 4000 further periods
    /// for a motion that has not settled.
    fn default() -> Self {
        Self {
            recognition: RecognitionOptions::default(),
            lyapunov: LyapunovOptions {
                count: Some(4),
                ..LyapunovOptions::default()
            },
            rotation_periods: 4096,
            rotation_tolerance: 1e-6,
            further_periods: 1000,
            rounds: 3,
        }
    }
}

/// A settled motion with the numbers that decided its kind.
#[derive(Debug, Clone)]
pub enum Attractor {
    /// It repeats.
    Periodic(PeriodicAttractor),
    /// It fills closed curves: the leading exponent is zero within its error, and the rotation number is confirmed.
    QuasiPeriodic {
        /// Rotation number.
        rotation: RotationNumber,
        /// Lyapunov exponents.
        spectrum: LyapunovSpectrum,
    },
    /// Neighbouring motions part: at least one exponent is positive beyond its error.
    Chaotic {
        /// Lyapunov exponents; [`LyapunovSpectrum::positive`] of them are positive.
        spectrum: LyapunovSpectrum,
    },
    /// None of these could be shown: it still converges, repeats after more periods than were tried, or has more than two
    /// frequencies.
    Unsettled {
        /// Number of periods after which it came closest to repeating.
        closest_periods: usize,
        /// Distance then.
        mismatch: f64,
        /// Lyapunov exponents.
        spectrum: LyapunovSpectrum,
        /// Rotation number, or why there is none; `None` if the leading exponent is not zero.
        rotation: Option<Result<RotationNumber, RotationError>>,
    },
}

/// Moves a state through `periods` periods, so that the transient fades.
///
/// # Errors
/// [`FlowError`]; the state is then unchanged.
pub fn settle(flow: &mut dyn Flow, state: &mut [f64], periods: usize) -> Result<(), FlowError> {
    flow.advance(state, periods, &mut []).map(|_| ())
}

/// Largest relative change of a curve's size between the halves of the points at which it counts as settled.
const LARGEST_DRIFT: f64 = 1e-2;

/// Classifies the motion from `state`, whose transient has faded; the state moves along.
///
/// A motion that repeats is periodic. Otherwise the leading Lyapunov exponent decides: positive means chaotic; zero, with
/// stroboscopic points on closed curves and a rotation number confirmed over half of the periods, quasi-periodic; negative,
/// a periodic motion that is approached slowly or repeats late, which is then sought up to five times the longest period.
/// In all other cases the motion is given more time.
///
/// # Errors
/// [`FlowError`].
pub fn classify(
    recognizer: &mut Recognizer,
    state: &mut [f64],
    options: &ClassifyOptions,
) -> Result<Attractor, FlowError> {
    let mut further = options.further_periods;
    let mut round = 0;
    loop {
        let (closest_periods, mismatch) = match recognizer.recognize(state)? {
            Recognition::Periodic(attractor) => return Ok(Attractor::Periodic(attractor)),
            Recognition::NotPeriodic { periods, mismatch } => (periods, mismatch),
        };
        // A motion that all but repeats sits on an unstable orbit: it must leave before exponents say where it goes.
        if mismatch <= options.recognition.tolerance && round < options.rounds {
            settle(recognizer.flow(), state, further)?;
            further *= 2;
            round += 1;
            continue;
        }
        let spectrum = lyapunov(recognizer.flow(), state, &options.lyapunov)?;
        let (leading, resolution) = (spectrum.exponents[0], spectrum.resolution(0));
        if leading > resolution && mismatch > options.recognition.tolerance {
            return Ok(Attractor::Chaotic { spectrum });
        }
        if leading < -resolution
            && let Recognition::Periodic(attractor) = recognizer.recognize_converging(state)?
        {
            return Ok(Attractor::Periodic(attractor));
        }
        let mut rotation = None;
        if leading.abs() <= resolution {
            let map = stroboscopic(recognizer.flow(), state, options.rotation_periods)?;
            let found = rotation_number(&map);
            if let Ok(rotation) = &found
                && rotation.change <= options.rotation_tolerance
                && rotation.drift <= LARGEST_DRIFT
            {
                return Ok(Attractor::QuasiPeriodic {
                    rotation: rotation.clone(),
                    spectrum,
                });
            }
            rotation = Some(found);
        }
        if round >= options.rounds {
            return Ok(Attractor::Unsettled {
                closest_periods,
                mismatch,
                spectrum,
                rotation,
            });
        }
        settle(recognizer.flow(), state, further)?;
        further *= 2;
        round += 1;
    }
}
