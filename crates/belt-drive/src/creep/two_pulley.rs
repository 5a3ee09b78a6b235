//! Two pulleys and an extensible belt: tensions, slip arcs, speeds and losses from the natural length of the belt
//! (string-creep theory, theory 04 §6.2).
//!
//! Pulley 1 drives at a given speed, pulley 2 is driven against a given torque. The tight span enters pulley 1, the slack
//! one pulley 2. Mass and extension are exact: the mass flux `G` is the same everywhere, and `Z = N − Gv` takes the part
//! of the tension in the law of the rope on a drum.

use super::CreepError;
use super::root::root;
use std::f64::consts::PI;

/// The drive.
///
/// ```
/// use slackside_belt_drive::creep::TwoPulleyBelt;
/// let mut drive = TwoPulleyBelt {
///     radii: [0.08, 0.03],
///     distance: 0.3,
///     crossed: false,
///     mass_per_natural_length: 0.12,
///     axial_stiffness: 120e3,
///     friction: [0.9, 0.7],
///     natural_length: 0.0,
/// };
/// drive.natural_length = drive.natural_length_at_rest(400.0)?;
/// let creep = drive.creep(50.0, 2.0)?;
/// assert!((creep.efficiency - (1.0 - creep.speed_loss)).abs() < 1e-14);
/// # Ok::<(), slackside_belt_drive::creep::CreepError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoPulleyBelt {
    /// Pitch radii of the driving and the driven pulley, m.
    pub radii: [f64; 2],
    /// Distance of the centres, m.
    pub distance: f64,
    /// Whether the spans cross, so that the pulleys turn in opposite senses.
    pub crossed: bool,
    /// Mass per unstretched length `m₀`, kg/m.
    pub mass_per_natural_length: f64,
    /// Axial stiffness `EA`, N.
    pub axial_stiffness: f64,
    /// Effective friction coefficients `μ` of the two contacts.
    pub friction: [f64; 2],
    /// Natural length of the belt `L₀`, m.
    pub natural_length: f64,
}

/// Steady motion of the drive under a torque that it can transmit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoPulleyCreep {
    /// Tension of the tight span `P_t`, which enters the driving pulley, N.
    pub tight_tension: f64,
    /// Tension of the slack span `P_s`, N.
    pub slack_tension: f64,
    /// Mass flux `G = m v`, kg/s.
    pub mass_flux: f64,
    /// `Γ_c = G²/(m₀ EA)`.
    pub flux_number: f64,
    /// Belt speeds in the tight and the slack span, m/s.
    pub belt_speeds: [f64; 2],
    /// `Z = N − Gv` in the tight and the slack span, N.
    pub effective_tensions: [f64; 2],
    /// Wraps of the two pulleys, rad.
    pub wraps: [f64; 2],
    /// Slip arcs of the two pulleys, rad.
    pub slip_arcs: [f64; 2],
    /// Adhesion arcs of the two pulleys, rad.
    pub adhesion_arcs: [f64; 2],
    /// Natural length of belt on the spans and pulleys, m: `L₀` to rounding.
    pub natural_length: f64,
    /// Speed of the driven pulley `ω₂`, rad/s.
    pub driven_speed: f64,
    /// Torque on the driving pulley `M₁`, N·m.
    pub driving_torque: f64,
    /// Torque of the driven pulley `M₂`, N·m.
    pub driven_torque: f64,
    /// `1 − ω₂R₂/(ω₁R₁)`.
    pub speed_loss: f64,
    /// `M₂ω₂/(M₁ω₁)`.
    pub efficiency: f64,
    /// Work of friction per time on the two pulleys, W.
    pub power_lost: [f64; 2],
}

/// The largest torque that the drive transmits at a speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestTorque {
    /// Torque on the driven pulley, N·m.
    pub torque: f64,
    /// Pulley whose slip arc reaches its wrap, 1 or 2.
    pub pulley: usize,
}

/// Tensions that follow from the tight one and the ratio of the effective tensions.
#[derive(Debug, Clone, Copy)]
struct State {
    tight: f64,
    slack: f64,
    flux: f64,
    flux_number: f64,
    effective: [f64; 2],
    slip_arcs: [f64; 2],
    natural_length: f64,
}

impl TwoPulleyBelt {
    /// Length of each span, m.
    ///
    /// # Errors
    /// [`CreepError::Overlap`].
    pub fn span_length(&self) -> Result<f64, CreepError> {
        let [first, second] = self.radii;
        if self.distance.is_nan() || self.distance <= first + second {
            return Err(CreepError::Overlap {
                distance: self.distance,
                radii: first + second,
            });
        }
        Ok((self.distance.powi(2) - self.offset().powi(2)).sqrt())
    }

    /// Wraps of the two pulleys, rad.
    pub fn wraps(&self) -> [f64; 2] {
        let turn = 2.0 * (self.offset() / self.distance).asin();
        if self.crossed {
            [PI + turn; 2]
        } else {
            [PI + turn, PI - turn]
        }
    }

    /// Natural length of a belt that has this uniform tension at rest, m.
    ///
    /// # Errors
    /// [`CreepError::Overlap`].
    pub fn natural_length_at_rest(&self, tension: f64) -> Result<f64, CreepError> {
        let arcs: f64 = self
            .radii
            .iter()
            .zip(self.wraps())
            .map(|(r, wrap)| r * wrap)
            .sum();
        Ok((2.0 * self.span_length()? + arcs) / (1.0 + tension / self.axial_stiffness))
    }

    /// Difference of the radii, or their sum if the spans cross.
    fn offset(&self) -> f64 {
        let [first, second] = self.radii;
        if self.crossed {
            first + second
        } else {
            first - second
        }
    }

    /// Steady motion at a speed of the driving pulley (rad/s) under a torque on the driven one (N·m, not negative).
    ///
    /// # Errors
    /// [`CreepError::NegativeTorque`], [`CreepError::TorqueTooLarge`], [`CreepError::Overlap`], [`CreepError::TooLong`] or
    /// [`CreepError::TooShort`].
    pub fn creep(&self, driving_speed: f64, torque: f64) -> Result<TwoPulleyCreep, CreepError> {
        if torque.is_nan() || torque < 0.0 {
            return Err(CreepError::NegativeTorque { torque });
        }
        let largest = self.largest_torque(driving_speed)?;
        if torque > largest.torque {
            return Err(CreepError::TorqueTooLarge {
                torque,
                largest: largest.torque,
                pulley: largest.pulley,
            });
        }
        // The torque rises with the logarithm of the tension ratio from zero to its largest value.
        let mut failure = None;
        let (limit, _) = self.limit();
        let logarithm = root(
            0.0,
            limit,
            &mut |logarithm| match self.state(driving_speed, logarithm) {
                Ok(state) => self.driven_torque(&state) - torque,
                Err(error) => {
                    failure = Some(error);
                    0.0
                }
            },
        );
        if let Some(error) = failure {
            return Err(error);
        }
        let state = self.state(driving_speed, logarithm)?;
        Ok(self.result(driving_speed, &state))
    }

    /// The largest torque on the driven pulley at a speed of the driving one (rad/s).
    ///
    /// # Errors
    /// [`CreepError::Overlap`], [`CreepError::TooLong`] or [`CreepError::TooShort`].
    pub fn largest_torque(&self, driving_speed: f64) -> Result<LargestTorque, CreepError> {
        let (limit, pulley) = self.limit();
        Ok(LargestTorque {
            torque: self.driven_torque(&self.state(driving_speed, limit)?),
            pulley,
        })
    }

    /// Largest `ln(Z_t/Z_s)` and the pulley (1 or 2) that sets it.
    fn limit(&self) -> (f64, usize) {
        let [first, second] = self.wraps();
        let (first, second) = (self.friction[0] * first, self.friction[1] * second);
        if first < second { (first, 1) } else { (second, 2) }
    }

    /// `M₂ = R₂ (Z_t − Z_s)`.
    fn driven_torque(&self, state: &State) -> f64 {
        self.radii[1] * (state.effective[0] - state.effective[1])
    }

    /// The state with a given `ln(Z_t/Z_s)`: the tight tension that closes the natural length.
    fn state(&self, driving_speed: f64, logarithm: f64) -> Result<State, CreepError> {
        let span = self.span_length()?;
        let at = |tight: f64| self.open_state(span, driving_speed, logarithm, tight);
        // Z_t = P_t − m₀v²/(1 + P_t/EA) vanishes here; below it nothing presses the belt onto the pulleys.
        let inertia = self.mass_per_natural_length * (driving_speed * self.radii[0]).powi(2);
        let lowest = 2.0 * inertia / (1.0 + (1.0 + 4.0 * inertia / self.axial_stiffness).sqrt());
        let longest = at(lowest).natural_length;
        if self.natural_length.is_nan() || self.natural_length >= longest {
            return Err(CreepError::TooLong {
                natural_length: self.natural_length,
                longest,
            });
        }
        let mut highest = 2.0 * lowest + 0.01 * self.axial_stiffness;
        while at(highest).natural_length > self.natural_length {
            highest *= 4.0;
            if !highest.is_finite() || highest > 1e12 * self.axial_stiffness {
                return Err(CreepError::TooShort {
                    natural_length: self.natural_length,
                });
            }
        }
        let tight = root(lowest, highest, &mut |tight| {
            at(tight).natural_length - self.natural_length
        });
        Ok(at(tight))
    }

    /// The state with given tight tension and `ln(Z_t/Z_s)`, whatever natural length it needs.
    fn open_state(&self, span: f64, driving_speed: f64, logarithm: f64, tight: f64) -> State {
        let stiffness = self.axial_stiffness;
        let speed = driving_speed * self.radii[0];
        let flux = self.mass_per_natural_length * speed / (1.0 + tight / stiffness);
        let flux_number = flux * flux / (self.mass_per_natural_length * stiffness);
        let inertia = flux * flux / self.mass_per_natural_length;
        let tight_effective = tight * (1.0 - flux_number) - inertia;
        let slack_effective = tight_effective * (-logarithm).exp();
        let slack = (slack_effective + inertia) / (1.0 - flux_number);
        let slip_arcs = self.friction.map(|friction| {
            if logarithm == 0.0 {
                0.0
            } else {
                logarithm / friction
            }
        });
        let entries = [tight, slack];
        let mut natural_length = span / (1.0 + tight / stiffness) + span / (1.0 + slack / stiffness);
        for (i, wrap) in self.wraps().into_iter().enumerate() {
            let adhesion = self.radii[i] * (wrap - slip_arcs[i]) / (1.0 + entries[i] / stiffness);
            natural_length +=
                adhesion + self.slip_length(i, slip_arcs[i], slack_effective, inertia, flux_number);
        }
        State {
            tight,
            slack,
            flux,
            flux_number,
            effective: [tight_effective, slack_effective],
            slip_arcs,
            natural_length,
        }
    }

    /// Natural length of belt in the slip arc of pulley `i`: `∫ r dφ/(1 + N/EA)` with `Z` an exponential of `φ`.
    fn slip_length(&self, i: usize, arc: f64, lowest: f64, inertia: f64, flux_number: f64) -> f64 {
        if arc == 0.0 {
            return 0.0;
        }
        let scale = self.axial_stiffness * (1.0 - flux_number);
        let (a, b) = (1.0 + inertia / scale, lowest / scale);
        let friction = self.friction[i];
        // ln((a + b e^{μφ})/(a + b)) without cancellation for short arcs.
        let growth = (b * (friction * arc).exp_m1() / (a + b)).ln_1p();
        self.radii[i] / a * (arc - growth / friction)
    }

    fn result(&self, driving_speed: f64, state: &State) -> TwoPulleyCreep {
        let stiffness = self.axial_stiffness;
        let speed = |tension: f64| state.flux / self.mass_per_natural_length * (1.0 + tension / stiffness);
        let difference = state.tight - state.slack;
        let speed_loss = difference / (stiffness + state.tight);
        let driven_speed = speed(state.slack) / self.radii[1];
        let peripheral = state.effective[0] - state.effective[1];
        // ∫ |q_t| |v − v_pulley| ds with q_t ds = dZ = (1 − Γ_c) dN and v − v_pulley = (G/m₀)(N − N_in)/EA.
        let lost = 0.5 * peripheral * (state.flux / self.mass_per_natural_length) * difference / stiffness;
        let wraps = self.wraps();
        TwoPulleyCreep {
            tight_tension: state.tight,
            slack_tension: state.slack,
            mass_flux: state.flux,
            flux_number: state.flux_number,
            belt_speeds: [driving_speed * self.radii[0], speed(state.slack)],
            effective_tensions: state.effective,
            wraps,
            slip_arcs: state.slip_arcs,
            adhesion_arcs: [wraps[0] - state.slip_arcs[0], wraps[1] - state.slip_arcs[1]],
            natural_length: state.natural_length,
            driven_speed,
            driving_torque: self.radii[0] * peripheral,
            driven_torque: self.radii[1] * peripheral,
            speed_loss,
            efficiency: 1.0 - speed_loss,
            power_lost: [lost; 2],
        }
    }
}
