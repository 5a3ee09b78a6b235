//! Stepping a parameter while the motion carries on (theory 02 §9.1, §9.2).

use super::classify::{Attractor, ClassifyOptions, classify, settle};
use super::periodic::Recognizer;
use super::poincare::{PoincareMap, stroboscopic};
use crate::flow::{FlowError, Record, Request};
use slackside_mechanics::{OperatingPoint, SystemFamily};

/// How a parameter is stepped and what is recorded at each value.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepOptions {
    /// Periods discarded at each value. All are run: a motion that looks settled may be leaving an unstable orbit.
    pub transient_periods: usize,
    /// Periods then recorded for samples, and for the measures of motions that do not repeat.
    pub record_periods: usize,
    /// Samples per period of each measure; zero for none.
    pub samples: usize,
    /// Stroboscopic points of motions that do not repeat.
    pub poincare_points: usize,
    /// Harmonics of each measure.
    pub harmonics: usize,
    /// How the settled motion is classified.
    pub classify: ClassifyOptions,
}

impl Default for SweepOptions {
    /// 600 transient periods, 64 recorded ones with 128 samples each, 1000 stroboscopic points, no harmonics.
    fn default() -> Self {
        Self {
            transient_periods: 600,
            record_periods: 64,
            samples: 128,
            poincare_points: 1000,
            harmonics: 0,
            classify: ClassifyOptions::default(),
        }
    }
}

/// The settled motion at one value of the parameter.
#[derive(Debug, Clone)]
pub struct SweepStep {
    /// Value of the parameter.
    pub parameter: f64,
    /// Frequency of the load.
    pub frequency: f64,
    /// Kind of the motion.
    pub attractor: Attractor,
    /// Periods over which `record` was taken: those of a refined periodic orbit, or the recorded periods.
    pub measured_periods: usize,
    /// Measures, events and shares of time in the regimes; exact for a refined periodic orbit.
    pub record: Record,
    /// Samples of each measure over the recorded periods of the motion as it ran, for spectra.
    pub samples: Vec<Vec<f64>>,
    /// Stroboscopic points: all of a periodic motion, the requested number of any other.
    pub points: PoincareMap,
}

/// Why a sweep ended.
#[derive(Debug, Clone, PartialEq)]
pub enum SweepStop {
    /// All values were visited.
    Finished,
    /// The caller asked to stop.
    Asked,
    /// No motion could be computed at a value.
    Failed {
        /// Value of the parameter.
        parameter: f64,
        /// What went wrong.
        error: FlowError,
    },
}

/// Steps a parameter through `parameters` in the given order, starting from `state` at phase zero, which moves along. At
/// each value the motion goes on from where it was at the end of the last period of the previous value. `take` receives
/// each step and returns false to stop.
pub fn sweep(
    family: &dyn SystemFamily,
    parameters: &[f64],
    state: &mut [f64],
    options: &SweepOptions,
    take: &mut dyn FnMut(SweepStep) -> bool,
) -> SweepStop {
    for &parameter in parameters {
        match sweep_step(family, parameter, state, options) {
            Ok(step) => {
                if !take(step) {
                    return SweepStop::Asked;
                }
            }
            Err(error) => return SweepStop::Failed { parameter, error },
        }
    }
    SweepStop::Finished
}

/// One value of a sweep: transient, record, classification. The state moves through the transient and the recorded periods
/// only, so that the next value does not depend on how this one was classified.
///
/// # Errors
/// [`FlowError`]; the state is then unchanged.
pub fn sweep_step(
    family: &dyn SystemFamily,
    parameter: f64,
    state: &mut [f64],
    options: &SweepOptions,
) -> Result<SweepStep, FlowError> {
    let point = family.at(parameter)?;
    let mut recognizer = Recognizer::new(&point, options.classify.recognition.clone())?;
    let mut moving = state.to_vec();
    settle(recognizer.flow(), &mut moving, options.transient_periods)?;
    let settled = moving.clone();
    let mut attractor = classify(&mut recognizer, &mut moving, &options.classify)?;

    let mut end = settled.clone();
    let orbit = match &mut attractor {
        Attractor::Periodic(periodic) => {
            if let Some(orbit) = &mut periodic.orbit {
                // It was found with the frequency as parameter.
                orbit.parameter = parameter;
            }
            periodic.orbit.as_ref()
        }
        _ => None,
    };
    let (measured_periods, mut record, samples) = if let Some(orbit) = orbit {
        let mut start = orbit.start.clone();
        let record = run(
            &mut recognizer,
            &point,
            &mut start,
            orbit.periods,
            options,
            true,
            0,
        )?;
        let samples = if options.samples > 0 {
            let periods = options.record_periods;
            run(
                &mut recognizer,
                &point,
                &mut end,
                periods,
                options,
                false,
                options.samples,
            )?
            .samples
        } else {
            settle(recognizer.flow(), &mut end, options.record_periods)?;
            Vec::new()
        };
        (orbit.periods, record, samples)
    } else {
        let periods = options.record_periods.max(1);
        let mut record = run(
            &mut recognizer,
            &point,
            &mut end,
            periods,
            options,
            true,
            options.samples,
        )?;
        let samples = std::mem::take(&mut record.samples);
        (periods, record, samples)
    };
    record.samples = Vec::new();

    let points = match &attractor {
        Attractor::Periodic(periodic) => {
            let mut map = PoincareMap::new(settled.len());
            periodic.points.iter().for_each(|point| map.push(point));
            map
        }
        _ => stroboscopic(
            recognizer.flow(),
            &mut settled.clone(),
            options.poincare_points.saturating_sub(1),
        )?,
    };
    state.copy_from_slice(&end);
    Ok(SweepStep {
        parameter,
        frequency: point.frequency,
        attractor,
        measured_periods,
        record,
        samples,
        points,
    })
}

/// Records the measures of the system over a number of periods; `measured` asks for harmonics and extremes.
fn run(
    recognizer: &mut Recognizer,
    point: &OperatingPoint,
    state: &mut [f64],
    periods: usize,
    options: &SweepOptions,
    measured: bool,
    samples: usize,
) -> Result<Record, FlowError> {
    let request = Request {
        harmonics: if measured { options.harmonics } else { 0 },
        extremes: measured,
        samples,
        account: false,
    };
    recognizer
        .flow()
        .record(state, periods, &point.system.outputs, &request)
}
