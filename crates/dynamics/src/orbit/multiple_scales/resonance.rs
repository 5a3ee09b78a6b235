//! The primary resonance of one mode.

use super::{ModalForm, ModalMode, MultipleScalesError, SteadyState};

/// Highest order of the sums over harmonics at second order; their terms fall like the fifth power.
pub(super) const HARMONICS: usize = 400;
/// Distance of a ratio of natural frequencies from an integer below which internal resonance is feared.
const NEAR_RESONANCE: f64 = 0.02;
/// The same, below which the expansion is refused.
const AT_RESONANCE: f64 = 1e-9;
/// Ratio of the largest correction to the amplitude above which a result must not be called validated (theory 02 §11).
const LARGEST_CORRECTION: f64 = 0.1;

/// The primary resonance of mode `n`: the load's frequency is near its natural frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct PrimaryResonance {
    /// The system's modal form.
    pub form: ModalForm,
    /// Index `n` of the mode, from zero.
    pub mode: usize,
    /// `q`: the other modes' direct response to the load, as deflection (C19).
    pub(super) direct_response: f64,
    /// `w_k` in `p_k = w_k N_k` (C19).
    pub(super) weights: Vec<f64>,
}

/// What a user of the expansion should know.
#[derive(Debug, Clone, PartialEq)]
pub enum Remark {
    /// The largest amplitude of the first order does not reach the switching point.
    NoSeparation {
        /// Factor on the constant load above which that is so; at most one here.
        critical_load_factor: f64,
    },
    /// Another natural frequency is close to a multiple of the resonant one.
    NearInternalResonance {
        /// The other mode, from one.
        other: usize,
        /// Ratio of the natural frequencies.
        ratio: f64,
    },
    /// Damping is too strong to be treated as small.
    StrongDamping {
        /// The damping ratio.
        damping_ratio: f64,
    },
}

impl std::fmt::Display for Remark {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoSeparation { critical_load_factor } => write!(
                f,
                "by first order nothing separates at this resonance: it would below {critical_load_factor:.6} of the constant load"
            ),
            Self::NearInternalResonance { other, ratio } => write!(
                f,
                "mode {other} has {ratio:.4} times the natural frequency of the resonant mode: near an internal resonance the expansion is unreliable"
            ),
            Self::StrongDamping { damping_ratio } => write!(
                f,
                "a damping ratio of {damping_ratio} is not small: the expansion is unreliable"
            ),
        }
    }
}

impl PrimaryResonance {
    /// The primary resonance of mode `mode` (from zero) of a modal form.
    ///
    /// # Errors
    /// [`MultipleScalesError`] if there is no such mode, the load does not excite it, it does not deflect the element, it has
    /// no damping, or another natural frequency is a multiple of its own.
    pub fn new(form: ModalForm, mode: usize) -> Result<Self, MultipleScalesError> {
        let number = mode + 1;
        let count = form.modes.len();
        let Some(resonant) = form.modes.get(mode) else {
            return Err(MultipleScalesError::Mode { mode: number, count });
        };
        let (w, d) = (resonant.frequency, resonant.deflection);
        let largest = |value: &dyn Fn(&ModalMode) -> f64| form.modes.iter().map(value).fold(0.0, f64::max);
        if resonant.load.abs() <= 1e-12 * largest(&|m| m.load.abs()) {
            return Err(MultipleScalesError::NotExcited { mode: number });
        }
        if d <= 1e-12 * largest(&|m| m.deflection) {
            return Err(MultipleScalesError::NotDeflected { mode: number });
        }
        // Rounding of a damping matrix must not pass for damping.
        if resonant.damping_ratio <= 1e-12 {
            return Err(MultipleScalesError::Undamped { mode: number });
        }
        let mut direct_response = 0.0;
        let mut weights: Vec<f64> = (0..=HARMONICS)
            .map(|k| match k {
                1 => 0.0,
                _ => d * d / (w * w * (1.0 - (k * k) as f64)),
            })
            .collect();
        for (j, other) in form.modes.iter().enumerate().filter(|(j, _)| *j != mode) {
            let (wj, dj) = (other.frequency, other.deflection);
            let multiple = (wj / w).round();
            if multiple >= 1.0 && (wj / w - multiple).abs() < AT_RESONANCE {
                return Err(MultipleScalesError::InternalResonance {
                    mode: number,
                    other: j + 1,
                    multiple: multiple as usize,
                });
            }
            direct_response += dj * other.load / ((wj - w) * (wj + w));
            for (k, weight) in weights.iter_mut().enumerate() {
                let kw = k as f64 * w;
                *weight += dj * dj / ((wj - kw) * (wj + kw));
            }
        }
        Ok(Self {
            form,
            mode,
            direct_response,
            weights,
        })
    }

    fn resonant(&self) -> &ModalMode {
        // The constructor checks the index.
        &self.form.modes[self.mode]
    }

    /// Natural frequency `ω_n`.
    pub fn frequency(&self) -> f64 {
        self.resonant().frequency
    }

    /// Damping ratio `ζ_n`.
    pub fn damping_ratio(&self) -> f64 {
        self.resonant().damping_ratio
    }

    /// Modal deflection `d_n`.
    pub fn deflection(&self) -> f64 {
        self.resonant().deflection
    }

    /// Modal load `F_n`.
    pub fn load(&self) -> f64 {
        self.resonant().load
    }

    /// Largest amplitude of the first order, `a_max = |F_n|/(2ζ_nω_n²)`; it does not depend on the separation.
    pub fn largest_amplitude(&self) -> f64 {
        self.load().abs() / (2.0 * self.damping_ratio() * self.frequency().powi(2))
    }

    /// Amplitude `δ_s/d_n` at which separation begins.
    pub fn onset_amplitude(&self) -> f64 {
        self.form.static_deflection / self.deflection()
    }

    /// Factor on the constant load above which the first order knows no separation: `a_max d_n/δ_s`. Times the preload it is
    /// the critical preload `M_c` of theory 02 §10.3.
    pub fn critical_load_factor(&self) -> f64 {
        self.largest_amplitude() / self.onset_amplitude()
    }

    /// `γ = δ_s/Δ` of a steady state; no separation at or above one.
    pub fn gamma(&self, state: &SteadyState) -> f64 {
        self.onset_amplitude() / state.amplitude
    }

    /// The largest correction relative to the amplitude, `max_k |p_k|/Δ`: how small the small terms are.
    pub fn correction(&self, state: &SteadyState) -> f64 {
        let separation = self.separation(state.amplitude);
        let mut largest = 0.0_f64;
        separation.each(HARMONICS, |k, c| {
            largest = largest.max((self.weights[k] * self.form.lost_stiffness * c.force).abs());
        });
        largest
    }

    /// Whether the correction at a steady state is small enough for the expansion to be relied on (theory 02 §11).
    pub fn is_validated(&self, state: &SteadyState) -> bool {
        self.correction(state) <= LARGEST_CORRECTION
    }

    /// What a user should know of this resonance.
    pub fn remarks(&self) -> Vec<Remark> {
        let mut remarks = Vec::new();
        let critical_load_factor = self.critical_load_factor();
        if critical_load_factor <= 1.0 {
            remarks.push(Remark::NoSeparation { critical_load_factor });
        }
        for (j, other) in self.form.modes.iter().enumerate() {
            let ratio = other.frequency / self.frequency();
            if j != self.mode && ratio.round() >= 1.0 && (ratio - ratio.round()).abs() < NEAR_RESONANCE {
                remarks.push(Remark::NearInternalResonance { other: j + 1, ratio });
            }
        }
        if self.damping_ratio() >= 0.2 {
            remarks.push(Remark::StrongDamping {
                damping_ratio: self.damping_ratio(),
            });
        }
        remarks
    }
}
