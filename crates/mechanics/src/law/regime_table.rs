//! The regimes of a switching law as plain data, read by one interpreter (events, exact flow, saltation).

/// What holds in a regime.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Piece {
    /// `f = constant + displacement · u + velocity · v`.
    Affine {
        /// Force at `u = v = 0`.
        constant: f64,
        /// Stiffness.
        displacement: f64,
        /// Viscous coefficient.
        velocity: f64,
    },
}

/// What happens when a guard falls through zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Transition {
    /// The element passes to the regime with this index; positions and velocities are continuous.
    To(usize),
}

/// A linear function of the port's motion, `displacement · u + velocity · v + constant`, positive inside the regime.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guard {
    /// Factor of `u`.
    pub displacement: f64,
    /// Factor of `v`.
    pub velocity: f64,
    /// Constant.
    pub constant: f64,
    /// What happens at its zero.
    pub transition: Transition,
}

/// One regime of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Regime {
    /// Name by which event lists refer to it.
    pub name: &'static str,
    /// Whether the element transmits in this regime (a clutch that is engaged, a stop in contact).
    pub transmitting: bool,
    /// What holds in it.
    pub piece: Piece,
    /// Where it ends.
    pub guards: Vec<Guard>,
}

/// All regimes of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct RegimeTable {
    /// The regimes; transitions refer to their indices.
    pub regimes: Vec<Regime>,
}
