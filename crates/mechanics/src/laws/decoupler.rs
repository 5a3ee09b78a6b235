//! The overrunning decoupler: a spring in series with a one-way clutch (theory 05 §6.3).

use crate::law::{Guard, InternalRate, Law, Piece, Regime, RegimeTable, Response, Rest, Transition};

/// A spring in series with a one-way clutch. Engaged it transmits `preload + stiffness · ζ + damping · ζ'` with the wind-up
/// `ζ' = v`; when that falls to zero (with a preload: when the wind-up has fallen to zero) it overruns, and forgets the
/// angle by which it does.
///
/// With a preload the spring rests against a stop inside the decoupler: up to that torque it transmits rigidly, which is a
/// regime of its own. With damping the spring, when it is let go, comes to rest by itself, `ζ' = −stiffness ζ / damping`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decoupler {
    stiffness: f64,
    damping: f64,
    preload: f64,
}

/// A damped spring against an internal stop would need a law of impact there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a decoupler has either damping or preload: leave one of them zero")]
pub struct DampingAndPreload;

impl Decoupler {
    /// A decoupler with `stiffness > 0` and not both of `damping ≥ 0` and `preload ≥ 0` positive.
    ///
    /// # Errors
    /// [`DampingAndPreload`].
    pub fn new(stiffness: f64, damping: f64, preload: f64) -> Result<Self, DampingAndPreload> {
        if damping > 0.0 && preload > 0.0 {
            return Err(DampingAndPreload);
        }
        Ok(Self {
            stiffness,
            damping,
            preload,
        })
    }

    /// Stiffness of the spring.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    fn damped(&self) -> RegimeTable {
        let (k, c) = (self.stiffness, self.damping);
        let balance = |sign: f64, to: usize| Guard {
            internal: sign * k,
            velocity: sign * c,
            ..Guard::on_force(0.0, 0.0, Transition::To(to))
        };
        let relaxing = InternalRate {
            internal: -k / c,
            ..InternalRate::default()
        };
        let engaged = Piece::Affine {
            constant: 0.0,
            displacement: 0.0,
            velocity: c,
            internal: k,
        };
        RegimeTable {
            regimes: vec![
                Regime {
                    internal_rate: relaxing,
                    ..Regime::new("overrunning", false, Piece::constant(0.0), vec![balance(-1.0, 1)])
                },
                Regime {
                    internal_rate: WINDING,
                    ..Regime::new("engaged", true, engaged, vec![balance(1.0, 0)])
                },
            ],
            rests: Vec::new(),
            internal: true,
        }
    }

    fn undamped(&self) -> RegimeTable {
        let rest = Transition::Rest(0);
        let engaged = Piece::Affine {
            constant: self.preload,
            displacement: 0.0,
            velocity: 0.0,
            internal: self.stiffness,
        };
        let mut regimes = vec![
            Regime::new(
                "overrunning",
                false,
                Piece::constant(0.0),
                vec![Guard::on_velocity(-1.0, 0.0, rest)],
            ),
            Regime {
                internal_rate: WINDING,
                ..Regime::new(
                    "engaged",
                    true,
                    engaged,
                    vec![Guard::on_internal(1.0, 0.0, Transition::To(0))],
                )
            },
        ];
        let stick = (self.preload > 0.0).then(|| {
            regimes.push(Regime::new(
                "locked",
                true,
                Piece::Stick { position: None },
                vec![
                    Guard::on_force(1.0, 0.0, rest),
                    Guard::on_force(-1.0, self.preload, rest),
                ],
            ));
            2
        });
        RegimeTable {
            regimes,
            rests: vec![Rest {
                backward: Some(0),
                stick,
                forward: Some(1),
            }],
            internal: true,
        }
    }
}

/// The spring winds up with the port.
const WINDING: InternalRate = InternalRate {
    constant: 0.0,
    displacement: 0.0,
    velocity: 1.0,
    internal: 0.0,
};

impl Law for Decoupler {
    fn kind(&self) -> &'static str {
        "decoupler"
    }

    fn response(&self, _: f64, velocity: f64) -> Response {
        let force = self.preload + self.damping * velocity;
        if velocity > 0.0 {
            Response {
                force,
                by_displacement: 0.0,
                by_velocity: self.damping,
            }
        } else {
            Response::default()
        }
    }

    fn regimes(&self) -> Option<RegimeTable> {
        Some(if self.damping > 0.0 {
            self.damped()
        } else {
            self.undamped()
        })
    }

    /// A clutch and a spring in series: what is stored comes back, so two motions approach each other (theory 05 §6.1).
    fn is_monotone(&self) -> bool {
        true
    }

    fn linearized(&self) -> (f64, f64) {
        (self.stiffness, self.damping)
    }
}
