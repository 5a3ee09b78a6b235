//! A harmonic motion of the drive in its strong form.

use super::assembly::Scales;
use super::wave::Term;
use super::{DriverMotion, StrongForm};
use slackside_linalg::Complex;

/// Complex amplitudes of a motion `Re(x e^{iωt})` about the steady state.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Angular frequency `ω`, rad/s; complex for a damped natural motion.
    pub frequency: Complex,
    /// Rotations of the pulleys, rad, positive with the belt's travel.
    pub rotations: Vec<Complex>,
    /// Rotations of the accessories, one per pulley, rad: the pulley's own where the connection is rigid, `None` where the
    /// accessory is disengaged.
    pub accessory_rotations: Vec<Option<Complex>>,
    /// Positions of the arms, rad or m.
    pub arms: Vec<Complex>,
    /// Dynamic tensions of the spans, N.
    pub tensions: Vec<Complex>,
    /// Transverse motion of the spans.
    pub spans: Vec<SpanMotion>,
    /// Torque on the driver that enforces a prescribed rotation, N·m; zero for a free driver.
    pub driver_torque: Complex,
    /// Torques along the coordinates of held tensioners that keep them still, N·m or N; zero for free ones.
    pub holding_torques: Vec<Complex>,
}

/// Transverse motion of one span: a sum of exponentials.
#[derive(Debug, Clone, PartialEq)]
pub struct SpanMotion {
    terms: Vec<Term>,
}

impl SpanMotion {
    /// Displacement to the left of the span at the distance `x` (m) from its start, m; the motion of the ends included.
    pub fn displacement(&self, x: f64) -> Complex {
        self.derivative(x, 0)
    }

    /// Slope at `x`.
    pub fn slope(&self, x: f64) -> Complex {
        self.derivative(x, 1)
    }

    /// Dynamic part of the curvature at `x`, 1/m.
    pub fn curvature(&self, x: f64) -> Complex {
        self.derivative(x, 2)
    }

    fn derivative(&self, x: f64, order: i32) -> Complex {
        self.terms.iter().map(|term| term.derivative(x, order)).sum()
    }
}

impl StrongForm<'_> {
    /// The motion that scaled unknowns stand for. A prescribed rotation reads zero.
    pub(super) fn motion(&self, frequency: Complex, unknowns: &[Complex], scales: &Scales) -> Motion {
        let value = |place: usize| unknowns[place] * scales.columns[place];
        let driver = self.drive.driver;
        let is_driven = self.configuration.driver == DriverMotion::Prescribed;
        let tensions: Vec<Complex> = (0..self.continua.len())
            .map(|span| value(self.tension_index(span)))
            .collect();
        let spans = self
            .continua
            .iter()
            .enumerate()
            .map(|(span, continuum)| {
                let waves = continuum.waves(frequency);
                let free = waves.free.iter().enumerate().map(|(k, term)| Term {
                    coefficient: value(self.wave_index(span) + k),
                    ..*term
                });
                let forced = waves.forced.iter().map(|term| Term {
                    coefficient: term.coefficient * tensions[span],
                    ..*term
                });
                SpanMotion {
                    terms: free.chain(forced).collect(),
                }
            })
            .collect();
        let rotations: Vec<Complex> = (0..self.drive.pulleys.len())
            .map(|j| {
                if is_driven && j == driver {
                    Complex::ZERO
                } else {
                    value(self.pulley_index(j))
                }
            })
            .collect();
        let accessory_rotations = (0..rotations.len())
            .map(|j| {
                if self.configuration.disengaged.contains(&j) {
                    return None;
                }
                let own = self.accessories.iter().position(|(pulley, _)| *pulley == j);
                Some(own.map_or(rotations[j], |place| value(self.accessory_index(place))))
            })
            .collect();
        let split = |arm: usize, held: bool| {
            if self.is_held(arm) == held {
                value(self.arm_index(arm))
            } else {
                Complex::ZERO
            }
        };
        let arms = 0..self.drive.tensioners.len();
        Motion {
            frequency,
            accessory_rotations,
            arms: arms.clone().map(|arm| split(arm, false)).collect(),
            holding_torques: arms.map(|arm| split(arm, true)).collect(),
            driver_torque: if is_driven {
                value(self.pulley_index(driver))
            } else {
                Complex::ZERO
            },
            rotations,
            tensions,
            spans,
        }
    }
}
