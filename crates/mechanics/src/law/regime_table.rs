//! The regimes of a switching law as plain data, read by one interpreter (events, exact flow, saltation).
//!
//! A law may be set-valued at rest (a one-way clutch, dry friction): there the port's velocity is zero and the force is
//! whatever keeps it so. Such a regime is a [`Piece::Stick`], and [`Rest`] lists which regimes may hold at zero velocity.

/// What holds in a regime.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Piece {
    /// `f = constant + displacement · u + velocity · v + internal · ζ`.
    Affine {
        /// Force at `u = v = ζ = 0`.
        constant: f64,
        /// Stiffness.
        displacement: f64,
        /// Viscous coefficient.
        velocity: f64,
        /// Factor of the element's internal state `ζ`.
        internal: f64,
    },
    /// `v = 0`; the force is the one that keeps it so, the multiplier `Λ` of theory 05 (3.1).
    Stick {
        /// The displacement at which a rigid stop holds its port; `None` for a law of the velocity alone.
        position: Option<f64>,
    },
}

impl Piece {
    /// A constant force.
    pub const fn constant(force: f64) -> Self {
        Self::Affine {
            constant: force,
            displacement: 0.0,
            velocity: 0.0,
            internal: 0.0,
        }
    }
}

/// `ζ' = constant + displacement · u + velocity · v + internal · ζ`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InternalRate {
    /// Constant part.
    pub constant: f64,
    /// Factor of `u`.
    pub displacement: f64,
    /// Factor of `v`.
    pub velocity: f64,
    /// Factor of `ζ`.
    pub internal: f64,
}

/// What happens when a guard falls through zero.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Transition {
    /// The element passes to the regime with this index; positions, velocities and internal states are continuous.
    To(usize),
    /// The port is at rest: which regime follows is decided among those of this [`Rest`], together with all other elements
    /// at rest (theory 05 §3.4).
    Rest(usize),
    /// The port hits a rigid stop with a velocity `v`, which becomes `−restitution · v` (theory 05 §6.4).
    Impact {
        /// Coefficient of restitution, 0 to 1.
        restitution: f64,
        /// The [`Rest`] that decides when the impacts have ceased.
        rest: usize,
    },
}

/// A linear function of the port's motion and force,
/// `displacement · u + velocity · v + internal · ζ + force · f + constant`, positive inside the regime.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guard {
    /// Factor of `u`.
    pub displacement: f64,
    /// Factor of `v`.
    pub velocity: f64,
    /// Factor of `ζ`.
    pub internal: f64,
    /// Factor of the element's force.
    pub force: f64,
    /// Constant.
    pub constant: f64,
    /// What happens at its zero.
    pub transition: Transition,
}

impl Guard {
    const fn zero(transition: Transition) -> Self {
        Self {
            displacement: 0.0,
            velocity: 0.0,
            internal: 0.0,
            force: 0.0,
            constant: 0.0,
            transition,
        }
    }

    /// `factor · u + constant`.
    pub const fn on_displacement(factor: f64, constant: f64, transition: Transition) -> Self {
        Self {
            displacement: factor,
            constant,
            ..Self::zero(transition)
        }
    }

    /// `factor · v + constant`.
    pub const fn on_velocity(factor: f64, constant: f64, transition: Transition) -> Self {
        Self {
            velocity: factor,
            constant,
            ..Self::zero(transition)
        }
    }

    /// `factor · ζ + constant`.
    pub const fn on_internal(factor: f64, constant: f64, transition: Transition) -> Self {
        Self {
            internal: factor,
            constant,
            ..Self::zero(transition)
        }
    }

    /// `factor · f + constant`.
    pub const fn on_force(factor: f64, constant: f64, transition: Transition) -> Self {
        Self {
            force: factor,
            constant,
            ..Self::zero(transition)
        }
    }
}

/// One regime of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Regime {
    /// Name by which event lists refer to it.
    pub name: &'static str,
    /// Whether the element transmits in this regime (a clutch that is engaged, a stop in contact, an arm that sticks).
    pub transmitting: bool,
    /// What holds in it.
    pub piece: Piece,
    /// How the internal state moves.
    pub internal_rate: InternalRate,
    /// Where it ends.
    pub guards: Vec<Guard>,
}

impl Regime {
    /// A regime without movement of an internal state.
    pub fn new(name: &'static str, transmitting: bool, piece: Piece, guards: Vec<Guard>) -> Self {
        Self {
            name,
            transmitting,
            piece,
            internal_rate: InternalRate::default(),
            guards,
        }
    }

    /// Whether the port is held.
    pub fn sticks(&self) -> bool {
        matches!(self.piece, Piece::Stick { .. })
    }
}

/// The regimes among which one holds at zero velocity of the port, by the motion that they lead to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rest {
    /// The port begins to move backward, `v < 0`.
    pub backward: Option<usize>,
    /// The port stays at rest.
    pub stick: Option<usize>,
    /// The port begins to move forward, `v > 0`.
    pub forward: Option<usize>,
}

impl Rest {
    /// The candidates, sticking first: with a static limit above the kinetic one it has precedence (theory 05 §5.1).
    pub fn candidates(&self) -> impl Iterator<Item = usize> + use<> {
        [self.stick, self.backward, self.forward].into_iter().flatten()
    }
}

/// All regimes of a law.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RegimeTable {
    /// The regimes; transitions refer to their indices.
    pub regimes: Vec<Regime>,
    /// What may hold at zero velocity; empty for a law that is a function of the motion.
    pub rests: Vec<Rest>,
    /// Whether the law has an internal state `ζ`, which starts at zero unless told otherwise.
    pub internal: bool,
}

impl RegimeTable {
    /// A law that is a function of displacement and velocity.
    pub fn of_function(regimes: Vec<Regime>) -> Self {
        Self {
            regimes,
            rests: Vec::new(),
            internal: false,
        }
    }

    /// Whether any regime or its end depends on the displacement of the port.
    pub fn depends_on_displacement(&self) -> bool {
        self.regimes.iter().any(|regime| {
            let piece = match regime.piece {
                Piece::Affine { displacement, .. } => displacement != 0.0,
                Piece::Stick { position } => position.is_some(),
            };
            piece
                || regime.internal_rate.displacement != 0.0
                || regime.guards.iter().any(|guard| guard.displacement != 0.0)
        })
    }
}
