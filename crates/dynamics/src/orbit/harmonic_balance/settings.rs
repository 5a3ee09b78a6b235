//! Settings of harmonic balance.

use super::HarmonicBalanceError;
use slackside_mechanics::System;

/// How the harmonics of the elements' forces are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ForceMethod {
    /// Exactly, from the switching angles, for piecewise-linear laws, with the jump of dry friction at rest (the exact-sign
    /// Galerkin method of theory 05 §5.4, for motions that do not stick for long); from samples for all others.
    #[default]
    Automatic,
    /// From samples for every law.
    Sampled,
}

/// Rule by which the number of harmonics follows the motion (theory 02 §5.5). The tail `τ` is the share of the amplitudes
/// beyond `3H/4` in the root sum of squares of all but the mean, of the port where it is largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adaptation {
    /// `H` grows by 1.5 while `τ` is above this, and shrinks by 1.25 when `τ` is below a hundredth of it.
    pub tail: f64,
    /// Smallest `H`.
    pub minimum: usize,
    /// Largest `H`.
    pub maximum: usize,
}

impl Default for Adaptation {
    fn default() -> Self {
        Self {
            tail: 1e-7,
            minimum: 8,
            maximum: 480,
        }
    }
}

/// Settings of harmonic balance.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Number of harmonics `H` of `Ω/n`, to begin with if it adapts.
    pub harmonics: usize,
    /// Subharmonic order `n`: the motion repeats after `n` periods of the load.
    pub subharmonic: usize,
    /// How `H` adapts; `None` keeps it.
    pub adaptation: Option<Adaptation>,
    /// How forces are evaluated.
    pub force_method: ForceMethod,
    /// Number of time samples `N` for sampled laws: the least one if they are refined, and then at least `16 H` are taken.
    pub samples: usize,
    /// Whether samples are doubled until that changes the equations by less than `1e-10`. A narrow transition at rest takes
    /// very many; without refinement exactly `samples` are used and their error, about the share of the period between
    /// two of them, is accepted.
    pub refine_samples: bool,
    /// Newton's method ends when a step is below this, relative to the amplitude of the port.
    pub tolerance: f64,
    /// Largest number of Newton steps.
    pub iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            harmonics: 16,
            subharmonic: 1,
            adaptation: Some(Adaptation::default()),
            force_method: ForceMethod::default(),
            samples: 256,
            refine_samples: true,
            tolerance: 1e-12,
            iterations: 60,
        }
    }
}

impl Settings {
    /// Settings with exactly `harmonics` orders.
    pub fn fixed(harmonics: usize) -> Self {
        Self {
            harmonics,
            adaptation: None,
            ..Self::default()
        }
    }

    /// The smallest `H` that holds the load.
    pub(super) fn least_harmonics(&self, system: &System) -> usize {
        (self.subharmonic * system.forcing.highest_order()).max(1)
    }

    /// Checks the ranges.
    ///
    /// # Errors
    /// [`HarmonicBalanceError::Setting`] naming the first setting outside its range.
    pub(super) fn check(&self, system: &System) -> Result<(), HarmonicBalanceError> {
        let fault = |name, value: String, range| Err(HarmonicBalanceError::Setting { name, value, range });
        if self.subharmonic == 0 {
            return fault("subharmonic", "0".into(), "at least 1");
        }
        let least = self.least_harmonics(system);
        if self.harmonics < least {
            return fault(
                "harmonics",
                self.harmonics.to_string(),
                "at least the highest order of the load times the subharmonic order",
            );
        }
        if !(self.tolerance > 0.0 && self.tolerance <= 1e-2) {
            return fault(
                "tolerance",
                self.tolerance.to_string(),
                "positive and at most 0.01",
            );
        }
        if self.iterations == 0 {
            return fault("iterations", "0".into(), "at least 1");
        }
        let most = self.adaptation.map_or(self.harmonics, |rule| rule.maximum);
        if !self.refine_samples && self.samples < 4 * most + 2 {
            return fault(
                "samples",
                self.samples.to_string(),
                "at least four times the number of harmonics plus two",
            );
        }
        if let Some(rule) = self.adaptation {
            if !(rule.tail > 0.0 && rule.tail < 1.0) {
                return fault("adaptation.tail", rule.tail.to_string(), "between 0 and 1");
            }
            if rule.minimum > rule.maximum || self.harmonics > rule.maximum {
                return fault(
                    "adaptation.maximum",
                    rule.maximum.to_string(),
                    "at least the minimum and the number of harmonics to begin with",
                );
            }
        }
        Ok(())
    }
}
