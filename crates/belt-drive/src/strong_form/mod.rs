//! The linear model in its strong form: the spans as moving strings or beams solved exactly at one frequency, joined by the
//! balances of pulleys, accessories and arms (theory 04 §4.6).
//!
//! It shares neither the sine series nor the matrices with the linear model, so that the two check each other:
//! natural frequencies by Newton's method on the transcendental eigenproblem, from an estimate or by scanning, and the
//! forced response by one linear solution. Motions are `Re(x e^{iωt})` about the steady state.
//!
//! There is no strong form for [`crate::drive::SpanEnds::Contact`], whose factors ½ and ⅓ correct single coefficients of the
//! series rather than the boundary conditions, for [`crate::drive::BeltModel::Spring`], whose spans have no motion of their
//! own, and for damping that is defined by matrices (Rayleigh, modal) or raises the order of the equation (internal bending
//! damping).

mod assembly;
mod error;
mod frequencies;
mod motion;
mod wave;

pub use error::StrongFormError;
pub use frequencies::NaturalMotion;
pub use motion::{Motion, SpanMotion};

use crate::drive::{BeltModel, Drive, Flexible, Guide, Mount, SpanEnds};
use crate::steady::SteadyState;
use slackside_linalg::{Complex, LinalgError};
use wave::Continuum;

/// How the driver moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DriverMotion {
    /// As prescribed.
    #[default]
    Prescribed,
    /// Freely, with its own inertia.
    Free,
}

/// What is free and what is connected.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Configuration {
    /// How the driver moves.
    pub driver: DriverMotion,
    /// Pulleys whose accessory is disconnected: its inertia and its coupling leave the model, as a body of its own.
    pub disengaged: Vec<usize>,
    /// Tensioners that are held, by friction say, besides the locked ones.
    pub held: Vec<usize>,
}

/// What shakes the drive at one frequency: complex amplitudes of `e^{iωt}`.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicLoad {
    /// Rotation of a driver whose motion is prescribed, rad.
    pub driver_rotation: Complex,
    /// Torques on the pulleys, positive with the belt's travel, N·m.
    pub pulley_torques: Vec<Complex>,
    /// Torques along the coordinates of the tensioners, N·m or N.
    pub arm_torques: Vec<Complex>,
}

impl HarmonicLoad {
    /// Rotation of the driver alone.
    pub fn driver_rotation(drive: &Drive, amplitude: Complex) -> Self {
        Self {
            driver_rotation: amplitude,
            pulley_torques: vec![Complex::ZERO; drive.pulleys.len()],
            arm_torques: vec![Complex::ZERO; drive.tensioners.len()],
        }
    }
}

/// The strong form of a drive about a steady state.
#[derive(Debug, Clone)]
pub struct StrongForm<'a> {
    drive: &'a Drive,
    steady: &'a SteadyState,
    configuration: Configuration,
    continua: Vec<Continuum>,
    /// `k_i`, N/m, and dashpots `c_i`, N·s/m.
    springs: Vec<f64>,
    dashpots: Vec<f64>,
    /// Inertia of every pulley with what is rigidly connected to it, kg·m².
    pulley_inertias: Vec<f64>,
    /// Accessories with a rotation of their own: pulley and connection.
    accessories: Vec<(usize, Flexible)>,
    /// Inertia, static stiffness `k_τ − ΣF·C''`, of every tensioner.
    arms: Vec<(f64, f64)>,
}

impl<'a> StrongForm<'a> {
    /// The strong form about a steady state.
    ///
    /// # Errors
    /// [`StrongFormError::NotInStrongForm`] or [`StrongFormError::Slack`].
    pub fn new(
        drive: &'a Drive,
        steady: &'a SteadyState,
        configuration: Configuration,
    ) -> Result<Self, StrongFormError> {
        check(drive, steady)?;
        let belt = &drive.belt;
        let bending = belt.acting_bending_stiffness();
        let curvature = |j: usize| drive.pulleys[j].sense.sign() / drive.pulleys[j].radius;
        let continua = (0..steady.spans.len())
            .map(|i| {
                let mut continuum = Continuum::new(
                    &steady.spans[i],
                    steady.layout.spans[i].length,
                    steady.effective_tensions[i],
                    bending,
                    [curvature(i), curvature(drive.next(i))],
                    belt.mass_per_length,
                    steady.belt_speed,
                );
                (continuum.external, continuum.drag) = (belt.damping.external, belt.damping.drag);
                continuum
            })
            .collect();
        let arc = |j: usize| drive.pulleys[j].radius * steady.layout.wraps[j];
        let springs: Vec<f64> = (0..steady.spans.len())
            .map(|i| {
                let arcs = 0.5 * belt.arc_participation * (arc(i) + arc(drive.next(i)));
                belt.axial_stiffness / (steady.layout.spans[i].length + arcs)
            })
            .collect();
        let dashpots = springs
            .iter()
            .map(|spring| {
                let by_loss = belt
                    .damping
                    .loss_factor
                    .map_or(0.0, |loss| loss.value * spring / loss.reference_frequency);
                belt.damping.span_dashpot + by_loss
            })
            .collect();
        let mut form = Self {
            drive,
            steady,
            configuration,
            continua,
            springs,
            dashpots,
            pulley_inertias: Vec::new(),
            accessories: Vec::new(),
            arms: Vec::new(),
        };
        form.connect();
        Ok(form)
    }

    /// Inertias and connections of pulleys, accessories and arms (theory 04 §3.2, §3.4).
    fn connect(&mut self) {
        let (drive, steady) = (self.drive, self.steady);
        let wrapped = |j: usize| {
            if drive.belt.wrapped_inertia {
                drive.belt.mass_per_length * drive.pulleys[j].radius * steady.layout.wraps[j]
            } else {
                0.0
            }
        };
        for (j, pulley) in drive.pulleys.iter().enumerate() {
            let mut inertia = pulley.inertia + wrapped(j) * pulley.radius.powi(2);
            if !self.configuration.disengaged.contains(&j) {
                match pulley.coupling.flexible() {
                    Some(part) => self.accessories.push((j, part)),
                    None => inertia += pulley.coupling.accessory_inertia(),
                }
            }
            self.pulley_inertias.push(inertia);
        }
        self.arms = drive
            .tensioners
            .iter()
            .enumerate()
            .map(|(arm, tensioner)| {
                let (mut inertia, mut stiffness) = (tensioner.inertia, tensioner.spring_rate);
                for j in drive.carried_by(arm) {
                    let rate = steady.kinematics.centre_rates[j][arm];
                    inertia += (drive.pulleys[j].mass + wrapped(j)) * rate.length_squared();
                    stiffness -= steady.belt_forces[j].dot(steady.kinematics.centre_curvatures[j][arm]);
                }
                (inertia, stiffness)
            })
            .collect();
    }

    /// Whether a tensioner does not move.
    fn is_held(&self, arm: usize) -> bool {
        self.drive.tensioners[arm].locked || self.configuration.held.contains(&arm)
    }

    /// The factor `−σ_j` between the rotation of a carried pulley and that of its rotary arm in the bearing; zero for others.
    fn bearing_on_arm(&self, j: usize) -> Option<(usize, f64)> {
        match self.drive.pulleys[j].mount {
            Mount::Carried { tensioner, .. } => match self.drive.tensioners[tensioner].guide {
                Guide::Rotary { .. } => Some((tensioner, -self.drive.pulleys[j].sense.sign())),
                Guide::Linear { .. } => None,
            },
            Mount::Fixed(_) => None,
        }
    }

    /// The motion under a harmonic load at an angular frequency (rad/s).
    ///
    /// # Errors
    /// [`StrongFormError::Frequency`], [`StrongFormError::Count`], or [`StrongFormError::Linalg`] at a natural frequency
    /// without damping.
    pub fn respond(&self, frequency: f64, load: &HarmonicLoad) -> Result<Motion, StrongFormError> {
        if !(frequency.is_finite() && frequency > 0.0) {
            return Err(StrongFormError::Frequency { found: frequency });
        }
        for (what, per, expected, found) in [
            (
                "the list of pulley torques",
                "pulley",
                self.drive.pulleys.len(),
                load.pulley_torques.len(),
            ),
            (
                "the list of arm torques",
                "tensioner",
                self.drive.tensioners.len(),
                load.arm_torques.len(),
            ),
        ] {
            if expected != found {
                return Err(StrongFormError::Count {
                    what,
                    per,
                    expected,
                    found,
                });
            }
        }
        let failure = |source: LinalgError| StrongFormError::Linalg { frequency, source };
        let frequency = Complex::new(frequency, 0.0);
        let scales = self.scales(frequency);
        let system = self.system(frequency, &scales);
        let right = self.right_hand_side(frequency, load, &scales);
        let unknowns = system.lu().map_err(failure)?.solve(&right);
        let mut motion = self.motion(frequency, &unknowns, &scales);
        if self.configuration.driver == DriverMotion::Prescribed {
            motion.rotations[self.drive.driver] = load.driver_rotation;
        }
        Ok(motion)
    }
}

fn check(drive: &Drive, steady: &SteadyState) -> Result<(), StrongFormError> {
    let damping = &drive.belt.damping;
    let refused = [
        (
            drive.belt.model == BeltModel::Spring,
            "spans without motion of their own",
        ),
        (
            drive.belt.acting_bending_stiffness() > 0.0 && drive.belt.span_ends == SpanEnds::Contact,
            "free contact points",
        ),
        (damping.internal_bending != 0.0, "internal bending damping"),
        (
            damping.rayleigh_mass != 0.0 || damping.rayleigh_stiffness != 0.0,
            "Rayleigh damping",
        ),
        (damping.modal.is_some(), "modal damping"),
    ];
    if let Some((_, what)) = refused.into_iter().find(|(present, _)| *present) {
        return Err(StrongFormError::NotInStrongForm { what });
    }
    match steady
        .effective_tensions
        .iter()
        .position(|tension| tension.is_nan() || *tension <= 0.0)
    {
        Some(span) => Err(StrongFormError::Slack {
            span: drive.span_name(span),
        }),
        None => Ok(()),
    }
}
