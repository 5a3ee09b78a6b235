//! Harmonic balance as a family to be followed in a parameter.

use super::balance::{Balance, Derivatives, check_laws};
use super::layout::{pack, resize};
use super::newton::enlarged;
use super::{HarmonicBalanceError, HarmonicOrbit, Settings};
use crate::branch::BranchFamily;
use crate::orbit::floquet;
use num_complex::Complex;
use slackside_continuation::{Evaluation, Family, FamilyError};
use slackside_mechanics::{OperatingPoint, System, SystemFamily};
use slackside_numerics::fourier::FourierPlanner;
use std::sync::Arc;

/// Step of the differences with respect to a parameter other than frequency, relative to the parameter's scale; their error
/// is of fourth order in it.
const DIFFERENCE_STEP: f64 = 1e-4;

/// The harmonic-balance equations of a family of systems, `F(z, p) = 0`.
///
/// `z` holds `(u_0, Re u_1, Im u_1, …)` of each nonlinear element; all systems of the family have the same elements. The
/// derivative with respect to frequency is exact; with respect to any other parameter it is a difference of fourth order of
/// the equations at fixed `z`. Test functions: period doubling, then Neimark–Sacker.
pub struct HarmonicBalance {
    family: Arc<dyn SystemFamily>,
    settings: Settings,
    harmonics: usize,
    samples: usize,
    /// Elements whose displacements are the unknowns.
    nonlinear: Vec<usize>,
    port_scales: Vec<f64>,
    parameter_scale: f64,
    planner: FourierPlanner,
    balance: Option<Balance>,
    /// Frequency `Ω` of the last evaluation.
    frequency: f64,
    /// Number of switchings when the number of harmonics was last raised.
    switchings_before: Option<usize>,
    /// The last motion looked at, with its unknowns and parameter.
    examined: Option<(Vec<f64>, f64, Examined)>,
}

/// What test functions, pattern and observation of one motion share.
#[derive(Debug, Clone, Default)]
struct Examined {
    switchings: usize,
    multipliers: Vec<Complex<f64>>,
    tests: [f64; 2],
}

impl std::fmt::Debug for HarmonicBalance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("HarmonicBalance")
            .field("settings", &self.settings)
            .field("harmonics", &self.harmonics)
            .finish_non_exhaustive()
    }
}

impl HarmonicBalance {
    /// The family of motions about a reference parameter, from which the scales of the unknowns are taken: the size of the
    /// linear response of each port, of its mean where there is one.
    ///
    /// # Errors
    /// [`HarmonicBalanceError`] if the system at the reference, or a setting, is not sound.
    pub fn new(
        family: Arc<dyn SystemFamily>,
        reference: f64,
        settings: Settings,
    ) -> Result<Self, HarmonicBalanceError> {
        let point = family
            .at(reference)
            .map_err(|error| HarmonicBalanceError::Setting {
                name: "reference",
                value: format!("{reference} ({error})"),
                range: "inside the domain of the family",
            })?;
        point.system.check()?;
        check_laws(&point.system)?;
        settings.check(&point.system)?;
        let mut planner = FourierPlanner::default();
        let mut balance = Balance::new(
            point.system.clone(),
            &settings,
            settings.harmonics,
            settings.samples,
            &mut planner,
        );
        balance.linear.check_static(&point.system, point.frequency)?;
        let linear = balance.linear_response(point.frequency)?;
        let order = 2 * settings.harmonics + 1;
        let port_scales = linear.chunks(order).map(port_scale).collect();
        Ok(Self {
            family,
            harmonics: settings.harmonics,
            samples: settings.samples,
            settings,
            nonlinear: balance.nonlinear.clone(),
            port_scales,
            parameter_scale: if reference == 0.0 { 1.0 } else { reference.abs() },
            planner,
            balance: Some(balance),
            frequency: point.frequency,
            switchings_before: None,
            examined: None,
        })
    }

    /// The number of harmonics `H` in use.
    pub fn harmonics(&self) -> usize {
        self.harmonics
    }

    /// Sets the typical size of the parameter, by default its reference value.
    pub fn set_parameter_scale(&mut self, scale: f64) {
        self.parameter_scale = scale;
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The unknowns of a motion found by [`super::solve`], padded or cut to this family's number of harmonics. Sampled laws
    /// take over its number of samples if that is larger.
    pub fn unknowns(&mut self, orbit: &HarmonicOrbit) -> Vec<f64> {
        let order = 2 * self.harmonics + 1;
        let mut z = vec![0.0; self.nonlinear.len() * order];
        for (part, &element) in z.chunks_mut(order).zip(&self.nonlinear) {
            let mut port = orbit.displacements[element].clone();
            if orbit.linearization.drifting[element] {
                port[0].re = orbit.drifts[element];
            }
            port.resize(self.harmonics + 1, Complex::ZERO);
            pack(&port, part);
        }
        if orbit.samples > self.samples {
            self.samples = orbit.samples;
            self.balance = None;
        }
        z
    }

    /// The motion with unknowns `z` at parameter `p`.
    ///
    /// # Errors
    /// [`FamilyError`] outside the domain of the family.
    pub fn orbit(&mut self, z: &[f64], p: f64) -> Result<HarmonicOrbit, FamilyError> {
        let point = self.at(p)?;
        self.balance_of(&point.system);
        match &mut self.balance {
            Some(balance) => {
                same_elements(balance, z)?;
                HarmonicOrbit::recover(balance, z, point.frequency, &mut self.planner).map_err(failure)
            }
            None => Err(FamilyError("there are no equations at this parameter".into())),
        }
    }

    /// Multipliers, test functions and number of switchings at a solution, found once and then remembered.
    fn examine(&mut self, z: &[f64], p: f64) -> Examined {
        if let Some((known_z, known_p, known)) = &self.examined
            && *known_p == p
            && known_z == z
        {
            return known.clone();
        }
        let mut result = Examined {
            tests: [f64::NAN; 2],
            ..Examined::default()
        };
        if let Ok(orbit) = self.orbit(z, p) {
            result.switchings = orbit.events.len();
            if let Ok(stability) = orbit.stability() {
                if let Some(monodromy) = &stability.monodromy {
                    result.tests = [
                        floquet::period_doubling_test(monodromy),
                        floquet::neimark_sacker_test(monodromy),
                    ];
                }
                result.multipliers = stability.multipliers;
            }
        }
        self.examined = Some((z.to_vec(), p, result.clone()));
        result
    }

    /// The number of harmonics that the last motion, with unknowns `z`, asks for (theory 02 §5.5).
    fn wanted_harmonics(&mut self, z: &[f64]) -> Option<usize> {
        let rule = self.settings.adaptation?;
        let (harmonics, frequency) = (self.harmonics, self.frequency);
        let balance = self.balance.as_mut().filter(|b| b.dimension() == z.len())?;
        let least = rule.minimum.max(self.settings.least_harmonics(&balance.system));
        balance.unpack(z);
        let (tail, count) = (balance.tail(), balance.switchings(frequency));
        let unsettled = self
            .switchings_before
            .take()
            .is_some_and(|before| before != count);
        if (tail > rule.tail || unsettled) && harmonics < rule.maximum {
            self.switchings_before = Some(count);
            return Some(enlarged(harmonics, tail, &rule));
        }
        if tail < 0.01 * rule.tail && harmonics > least {
            return Some((4 * harmonics / 5).max(least));
        }
        None
    }

    /// Whether twice the samples would change the residual at `z` noticeably.
    fn is_aliased(&mut self, z: &[f64]) -> Option<usize> {
        let balance = self.balance.as_mut().filter(|b| b.dimension() == z.len())?;
        balance.aliased(z, self.frequency, &self.settings, &mut self.planner)
    }

    fn at(&self, p: f64) -> Result<OperatingPoint, FamilyError> {
        let point = self
            .family
            .at(p)
            .map_err(|error| FamilyError(error.to_string()))?;
        if !self.family.is_frequency() {
            point
                .system
                .check()
                .map_err(|error| FamilyError(error.to_string()))?;
        }
        if self.settings.least_harmonics(&point.system) > self.harmonics {
            return Err(FamilyError(format!(
                "the load has order {}, which {} harmonics do not hold",
                point.system.forcing.highest_order(),
                self.harmonics
            )));
        }
        Ok(point)
    }

    /// The equations of a system, kept for as long as system and number of harmonics stay the same.
    fn balance_of(&mut self, system: &Arc<System>) -> &mut Balance {
        let kept = self
            .balance
            .take()
            .filter(|balance| Arc::ptr_eq(&balance.system, system) && balance.harmonics == self.harmonics);
        let (settings, harmonics, samples, planner) =
            (&self.settings, self.harmonics, self.samples, &mut self.planner);
        self.balance.insert(
            kept.unwrap_or_else(|| Balance::new(system.clone(), settings, harmonics, samples, planner)),
        )
    }

    /// `∂F/∂p` by central differences of fourth order; the step shrinks at the edge of the domain.
    fn difference(&mut self, z: &[f64], p: f64, result: &mut [f64]) -> Result<(), FamilyError> {
        let mut step = DIFFERENCE_STEP * if p == 0.0 { self.parameter_scale } else { p.abs() };
        let mut values = vec![0.0; z.len()];
        for attempt in 0..3 {
            result.fill(0.0);
            let mut outcome = Ok(());
            for (multiple, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
                outcome = self.residual(z, p + multiple * step, &mut values);
                if outcome.is_err() {
                    break;
                }
                for (sum, value) in result.iter_mut().zip(&values) {
                    *sum += weight * value / (12.0 * step);
                }
            }
            match outcome {
                Err(error) if attempt == 2 => return Err(error),
                Err(_) => step *= 0.1,
                Ok(()) => break,
            }
        }
        Ok(())
    }

    fn residual(&mut self, z: &[f64], p: f64, residual: &mut [f64]) -> Result<(), FamilyError> {
        let point = self.at(p)?;
        let mut balance = Balance::new(
            point.system,
            &self.settings,
            self.harmonics,
            self.samples,
            &mut self.planner,
        );
        same_elements(&balance, z)?;
        balance
            .evaluate(z, point.frequency, residual, Derivatives::default())
            .map_err(failure)
    }
}

impl Family for HarmonicBalance {
    fn dimension(&self) -> usize {
        self.port_scales.len() * (2 * self.harmonics + 1)
    }

    fn unknown_scales(&self) -> Vec<f64> {
        let order = 2 * self.harmonics + 1;
        let scales = self.port_scales.iter();
        scales
            .flat_map(|&scale| std::iter::repeat_n(scale, order))
            .collect()
    }

    fn parameter_scale(&self) -> f64 {
        self.parameter_scale
    }

    fn evaluate(&mut self, z: &[f64], p: f64, evaluation: &mut Evaluation) -> Result<(), FamilyError> {
        let point = self.at(p)?;
        let is_frequency = self.family.is_frequency();
        self.frequency = point.frequency;
        let balance = self.balance_of(&point.system);
        same_elements(balance, z)?;
        let by_frequency = is_frequency.then_some(evaluation.by_parameter.as_mut_slice());
        let derivatives = Derivatives {
            jacobian: Some(&mut evaluation.jacobian),
            by_frequency,
        };
        balance
            .evaluate(z, point.frequency, &mut evaluation.residual, derivatives)
            .map_err(failure)?;
        if !is_frequency {
            self.difference(z, p, &mut evaluation.by_parameter)?;
        }
        Ok(())
    }

    /// `det(Mon + I)` and the Neimark–Sacker product, see [`floquet`].
    fn test_functions(&mut self, z: &[f64], p: f64, _evaluation: &Evaluation) -> Vec<f64> {
        self.examine(z, p).tests.to_vec()
    }

    /// The number of switchings in one period of the motion.
    fn pattern(&mut self, z: &[f64], p: f64, _evaluation: &Evaluation) -> i64 {
        self.examine(z, p).switchings as i64
    }

    /// The multipliers, real and imaginary parts in turn, largest modulus first.
    fn observe(&mut self, z: &[f64], p: f64, _evaluation: &Evaluation) -> Vec<f64> {
        let multipliers = self.examine(z, p).multipliers;
        multipliers
            .iter()
            .flat_map(|value| [value.re, value.im])
            .collect()
    }

    fn adapt(&mut self, z: &mut Vec<f64>, tangent: &mut Vec<f64>) -> bool {
        if let Some(samples) = self.is_aliased(z) {
            self.samples = samples;
            self.balance = None;
            return true;
        }
        let ports = self.port_scales.len();
        let (from, dimension) = (self.harmonics, self.dimension());
        let Some(to) = self.wanted_harmonics(z) else {
            return false;
        };
        *z = resize(z, ports, from, to);
        // What follows the unknowns, the parameter's entry, stays.
        let rest = tangent.split_off(dimension);
        *tangent = resize(tangent, ports, from, to);
        tangent.extend(rest);
        let length = slackside_linalg::norm(tangent);
        if length > 0.0 {
            tangent.iter_mut().for_each(|value| *value /= length);
        }
        self.harmonics = to;
        true
    }
}

impl BranchFamily for HarmonicBalance {
    fn periods(&self) -> usize {
        self.settings.subharmonic
    }

    fn as_family(&mut self) -> &mut dyn Family {
        self
    }
}

fn failure(error: HarmonicBalanceError) -> FamilyError {
    FamilyError(error.to_string())
}

fn same_elements(balance: &Balance, z: &[f64]) -> Result<(), FamilyError> {
    if balance.dimension() == z.len() {
        Ok(())
    } else {
        Err(FamilyError(format!(
            "the system has {} unknowns in place of {}: an element has become linear or ceased to be",
            balance.dimension(),
            z.len()
        )))
    }
}

/// Size of one port's unknowns: its mean, unless that is negligible beside the oscillation; one for a port at rest.
fn port_scale(linear: &[f64]) -> f64 {
    let oscillation = slackside_linalg::norm(&linear[1..]);
    let mean = linear[0].abs();
    if mean > 1e-6 * oscillation {
        mean
    } else if oscillation > 0.0 {
        oscillation
    } else {
        1.0
    }
}
