//! An element that holds its port at rest for all time, and the force that it has to transmit.

use super::{ClosedFormError, Extremes, extremes};
use crate::receptance::{LinearSystem, LockedSystem, ReceptanceError};
use slackside_linalg::Complex;
use slackside_mechanics::{Law, Piece, Rest, System};

/// The limits between which a law holds its port at rest: `(0, ∞)` for a one-way clutch, `(−Q, Q)` for dry friction, `None` for
/// laws that cannot hold it, or only at one position.
pub fn holding_limits(law: &dyn Law) -> Option<(f64, f64)> {
    let table = law.regimes()?;
    let stick = table.rests.iter().find_map(|rest: &Rest| rest.stick)?;
    let regime = &table.regimes[stick];
    let Piece::Stick { position: None } = regime.piece else {
        return None;
    };
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for guard in &regime.guards {
        // factor · f + constant > 0
        if guard.force > 0.0 {
            low = low.max(-guard.constant / guard.force);
        } else if guard.force < 0.0 {
            high = high.min(-guard.constant / guard.force);
        }
    }
    Some((low, high))
}

/// The force that the element transmits while it holds its port at rest: `mean + Re Σ g_k e^{ikΩt}`.
#[derive(Debug, Clone, PartialEq)]
pub struct LockedForce {
    /// Order and amplitude of every harmonic of the load.
    pub harmonics: Vec<(usize, Complex)>,
    /// Extremes of the sum of the harmonics.
    pub dynamic: Extremes,
}

/// An element of an otherwise linear system, locked. Made once for a system, it answers for any frequency of the load by one
/// complex solution per harmonic.
#[derive(Debug, Clone)]
pub struct LockedElement {
    /// Name of the element.
    pub name: String,
    /// The kind of its law.
    pub kind: &'static str,
    /// Limits of the force between which it stays locked.
    pub limits: (f64, f64),
    locked: LockedSystem,
}

impl LockedElement {
    /// The element with this index of a system whose other elements are linear.
    ///
    /// # Errors
    /// [`ClosedFormError::CannotLock`], or [`ClosedFormError::Receptance`] for another nonlinear element.
    pub fn new(system: &System, element: usize) -> Result<Self, ClosedFormError> {
        let open = LinearSystem::new(system, &[element])?;
        let found = &system.elements[element];
        let limits = holding_limits(found.law.as_ref()).ok_or_else(|| ClosedFormError::CannotLock {
            element: found.name.clone(),
            kind: found.law.kind(),
        })?;
        Ok(Self {
            name: found.name.clone(),
            kind: found.law.kind(),
            limits,
            locked: open.locked()?,
        })
    }

    /// The harmonics of the transmitted force under a load of frequency `Ω`, and their extremes.
    ///
    /// # Errors
    /// [`ClosedFormError::NoHarmonic`], or [`ClosedFormError::Receptance`] at an undamped resonance.
    pub fn force(&mut self, frequency: f64) -> Result<LockedForce, ClosedFormError> {
        let orders: Vec<usize> = self.locked.orders().collect();
        if orders.is_empty() {
            return Err(ClosedFormError::NoHarmonic);
        }
        let mut harmonics = Vec::with_capacity(orders.len());
        for (place, order) in orders.into_iter().enumerate() {
            let mut force = [Complex::ZERO];
            self.locked.force_of(place, frequency, &mut force)?;
            harmonics.push((order, force[0]));
        }
        Ok(LockedForce {
            dynamic: extremes(&harmonics),
            harmonics,
        })
    }

    /// Mean of the transmitted force while the port is held at displacement zero; `None` if the load leaves it open.
    ///
    /// # Errors
    /// [`ClosedFormError::Receptance`].
    pub fn mean_force(&self, frequency: f64) -> Result<Option<f64>, ClosedFormError> {
        match self.locked.mean_forces(frequency) {
            Ok(forces) => Ok(forces.first().copied()),
            Err(ReceptanceError::FreeMean) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    /// Static stiffness of the port, by which an offset changes the mean force.
    ///
    /// # Errors
    /// [`ClosedFormError::Receptance`].
    pub fn static_stiffness(&self, frequency: f64) -> Result<f64, ClosedFormError> {
        Ok(self.locked.static_stiffness(frequency)?[(0, 0)])
    }

    /// Derivatives of the force's harmonics with respect to the inertia `M_cc` of a coordinate, in the order of
    /// [`LockedForce::harmonics`].
    ///
    /// # Errors
    /// [`ClosedFormError::Receptance`].
    pub fn force_rates_by_inertia(
        &mut self,
        coordinate: usize,
        frequency: f64,
    ) -> Result<Vec<Complex>, ClosedFormError> {
        let count = self.locked.orders().count();
        let mut rates = vec![Complex::ZERO; count];
        for place in 0..count {
            let rate = &mut rates[place..=place];
            self.locked
                .force_rate_by_inertia(place, coordinate, frequency, rate)?;
        }
        Ok(rates)
    }

    /// The resonances of the locked system: its poles with positive imaginary part, by rising frequency.
    ///
    /// # Errors
    /// [`ClosedFormError::Receptance`].
    pub fn resonances(&self, frequency: f64) -> Result<Vec<Complex>, ClosedFormError> {
        let mut poles = self.locked.poles(frequency)?;
        poles.retain(|pole| pole.im > 0.0);
        Ok(poles)
    }
}
