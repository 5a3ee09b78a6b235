//! Steady states of the slow flow as a family, to be followed in the frequency or any other parameter.

use super::{ModalForm, MultipleScalesError, Order, PrimaryResonance, SteadyState};
use crate::branch::BranchFamily;
use slackside_continuation::{Evaluation, Family, FamilyError};
use slackside_mechanics::SystemFamily;
use std::sync::Arc;

/// Step of the differences by which derivatives with respect to a key are taken, relative to its value.
const DIFFERENCE_STEP: f64 = 1e-4;

/// Steady states `(a, ψ)` of one primary resonance over a parameter. Its multipliers are those of the slow flow; its
/// pattern is the number of events, two with separation.
#[derive(Clone)]
pub struct MultipleScales {
    family: Arc<dyn SystemFamily>,
    order: Order,
    mode: usize,
    parameter_scale: f64,
    amplitude_scale: f64,
    /// The resonance of a family over frequency, which is the same everywhere.
    fixed: Option<Arc<PrimaryResonance>>,
}

impl MultipleScales {
    /// The family about `parameter`, for mode `mode` (from zero). A key is measured by `parameter_scale`, the frequency by
    /// the natural frequency.
    ///
    /// # Errors
    /// [`FamilyError`] if there is no system at the parameter or no primary resonance.
    pub fn new(
        family: Arc<dyn SystemFamily>,
        order: Order,
        mode: usize,
        parameter: f64,
        parameter_scale: f64,
    ) -> Result<Self, FamilyError> {
        let mut found = Self {
            family,
            order,
            mode,
            parameter_scale,
            amplitude_scale: 1.0,
            fixed: None,
        };
        let (resonance, _) = found.resonance(parameter)?;
        found.amplitude_scale = resonance.onset_amplitude();
        if found.family.is_frequency() {
            found.parameter_scale = 0.25 * resonance.frequency();
            found.fixed = Some(resonance);
        }
        Ok(found)
    }

    /// The primary resonance at a parameter, and the frequency of the load there.
    ///
    /// # Errors
    /// [`FamilyError`] if there is no system at the parameter or no primary resonance.
    pub fn resonance(&self, parameter: f64) -> Result<(Arc<PrimaryResonance>, f64), FamilyError> {
        if let Some(resonance) = &self.fixed {
            if parameter.is_nan() || parameter <= 0.0 {
                return Err(FamilyError("the frequency must be positive".into()));
            }
            return Ok((resonance.clone(), parameter));
        }
        let point = self
            .family
            .at(parameter)
            .map_err(|error| FamilyError(error.to_string()))?;
        let fault = |error: MultipleScalesError| FamilyError(error.to_string());
        let form = ModalForm::new(&point.system).map_err(fault)?;
        let resonance = PrimaryResonance::new(form, self.mode).map_err(fault)?;
        Ok((Arc::new(resonance), point.frequency))
    }

    /// The steady state of unknowns `(a, ψ)` at a parameter.
    ///
    /// # Errors
    /// [`FamilyError`] as [`Self::resonance`], or if the amplitude is not positive.
    pub fn state(
        &self,
        z: &[f64],
        parameter: f64,
    ) -> Result<(Arc<PrimaryResonance>, SteadyState), FamilyError> {
        let (resonance, frequency) = self.resonance(parameter)?;
        match z {
            &[amplitude, phase] if amplitude > 0.0 => Ok((
                resonance,
                SteadyState {
                    frequency,
                    amplitude,
                    phase,
                },
            )),
            _ => Err(FamilyError("the amplitude must be positive".into())),
        }
    }

    fn residual(&self, z: &[f64], parameter: f64) -> Result<[f64; 2], FamilyError> {
        let (resonance, state) = self.state(z, parameter)?;
        let flow = resonance.slow_flow(self.order, &state);
        let scale = resonance.load().abs();
        Ok([flow.cosine / scale, flow.sine / scale])
    }

    /// Differences of fourth order; the step shrinks at the edge of the domain.
    fn difference(&self, z: &[f64], p: f64) -> Result<[f64; 2], FamilyError> {
        let step = DIFFERENCE_STEP * if p == 0.0 { self.parameter_scale } else { p.abs() };
        let attempt = |step: f64| -> Result<[f64; 2], FamilyError> {
            let mut sum = [0.0; 2];
            for (multiple, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
                let value = self.residual(z, p + multiple * step)?;
                for i in 0..2 {
                    sum[i] += weight * value[i] / (12.0 * step);
                }
            }
            Ok(sum)
        };
        attempt(step).or_else(|_| attempt(0.1 * step))
    }
}

impl Family for MultipleScales {
    fn dimension(&self) -> usize {
        2
    }

    fn unknown_scales(&self) -> Vec<f64> {
        vec![self.amplitude_scale, 1.0]
    }

    fn parameter_scale(&self) -> f64 {
        self.parameter_scale
    }

    fn evaluate(&mut self, z: &[f64], p: f64, evaluation: &mut Evaluation) -> Result<(), FamilyError> {
        let (resonance, state) = self.state(z, p)?;
        let flow = resonance.slow_flow(self.order, &state);
        let scale = resonance.load().abs();
        for (row, value, rates) in [
            (0, flow.cosine, flow.cosine_rates),
            (1, flow.sine, flow.sine_rates),
        ] {
            evaluation.residual[row] = value / scale;
            evaluation.jacobian[(row, 0)] = rates[0] / scale;
            evaluation.jacobian[(row, 1)] = rates[1] / scale;
            evaluation.by_parameter[row] = rates[2] / scale;
        }
        if !self.family.is_frequency() {
            evaluation.by_parameter.copy_from_slice(&self.difference(z, p)?);
        }
        Ok(())
    }

    fn pattern(&mut self, z: &[f64], p: f64, _: &Evaluation) -> i64 {
        let separates =
            |(resonance, state): (Arc<PrimaryResonance>, SteadyState)| resonance.gamma(&state) < 1.0;
        if self.state(z, p).is_ok_and(separates) {
            2
        } else {
            0
        }
    }

    fn observe(&mut self, z: &[f64], p: f64, _: &Evaluation) -> Vec<f64> {
        let Ok((resonance, state)) = self.state(z, p) else {
            return Vec::new();
        };
        let multipliers = resonance.multipliers(self.order, &state);
        multipliers
            .iter()
            .flat_map(|value| [value.re, value.im])
            .collect()
    }
}

impl BranchFamily for MultipleScales {
    fn periods(&self) -> usize {
        1
    }

    fn as_family(&mut self) -> &mut dyn Family {
        self
    }
}
