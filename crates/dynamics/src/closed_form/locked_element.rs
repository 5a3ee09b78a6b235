//! An element that holds its port at rest for all time, and the force that it has to transmit.

use super::{ClosedFormError, Extremes, extremes};
use crate::receptance::{LinearSystem, LockedSystem, ReceptanceError, nonlinear_elements};
use slackside_linalg::Complex;
use slackside_mechanics::laws::Isolator;
use slackside_mechanics::{Law, Piece, Rest, System};
use std::sync::Arc;

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
    /// The harmonics that the other held elements transmit, in the order of [`LockedElement::held`].
    pub held: Vec<Vec<(usize, Complex)>>,
}

/// Another element that is taken as held at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldElement {
    /// Its name.
    pub name: String,
    /// Limits of the force between which it really holds.
    pub limits: (f64, f64),
}

/// What is assumed of the other elements.
#[derive(Debug, Default)]
struct Others {
    held: Vec<HeldElement>,
    engaged: Vec<String>,
    free: Vec<String>,
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
    /// Other elements that are taken as held at rest.
    pub held: Vec<HeldElement>,
    /// Other elements that are taken as engaged for good, by their linear spring and damper.
    pub engaged: Vec<String>,
    /// Other elements that are taken as free, such as stops out of reach.
    pub free: Vec<String>,
    locked: LockedSystem,
}

impl LockedElement {
    /// The element with this index of a system whose other elements are linear.
    ///
    /// # Errors
    /// [`ClosedFormError::CannotLock`], or [`ClosedFormError::Receptance`] for another nonlinear element.
    pub fn new(system: &System, element: usize) -> Result<Self, ClosedFormError> {
        let open = LinearSystem::new(system, &[element])?;
        Self::of_ports(system, &open, element, Others::default())
    }

    /// The element with this index while the others do not switch: those that can hold their ports at rest do so, and all
    /// further ones are linear, as engaged for good or free. What follows is exact as long as they really are; of those that hold,
    /// [`Self::holding_margins`] tells.
    ///
    /// # Errors
    /// [`ClosedFormError::CannotLock`], or [`ClosedFormError::Receptance`] for ports that hold each other.
    pub fn among_engaged(system: &System, element: usize) -> Result<Self, ClosedFormError> {
        let mut engaged_system = system.clone();
        let (mut ports, mut others) = (vec![element], Others::default());
        for index in nonlinear_elements(system).into_iter().filter(|&e| e != element) {
            let other = &system.elements[index];
            if let Some(limits) = holding_limits(other.law.as_ref()) {
                ports.push(index);
                others.held.push(HeldElement {
                    name: other.name.clone(),
                    limits,
                });
            } else {
                let (stiffness, damping) = other.law.linearized();
                if (stiffness, damping) == (0.0, 0.0) {
                    others.free.push(other.name.clone());
                } else {
                    others.engaged.push(other.name.clone());
                }
                engaged_system.elements[index].law = Arc::new(Isolator { stiffness, damping });
            }
        }
        let open = LinearSystem::new(&engaged_system, &ports)?;
        Self::of_ports(system, &open, element, others)
    }

    fn of_ports(
        system: &System,
        open: &LinearSystem,
        element: usize,
        others: Others,
    ) -> Result<Self, ClosedFormError> {
        let found = &system.elements[element];
        let limits = holding_limits(found.law.as_ref()).ok_or_else(|| ClosedFormError::CannotLock {
            element: found.name.clone(),
            kind: found.law.kind(),
        })?;
        Ok(Self {
            name: found.name.clone(),
            kind: found.law.kind(),
            limits,
            held: others.held,
            engaged: others.engaged,
            free: others.free,
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
        let mut held = vec![Vec::with_capacity(orders.len()); self.held.len()];
        let mut forces = vec![Complex::ZERO; self.locked.ports()];
        for (place, order) in orders.into_iter().enumerate() {
            self.locked.force_of(place, frequency, &mut forces)?;
            harmonics.push((order, forces[0]));
            for (other, force) in held.iter_mut().zip(&forces[1..]) {
                other.push((order, *force));
            }
        }
        Ok(LockedForce {
            dynamic: extremes(&harmonics),
            harmonics,
            held,
        })
    }

    /// How far the force stays inside the limits, at its closest; negative if it exceeds them. An element with limits on both sides
    /// and static stiffness at its port takes the offset that is best for it.
    ///
    /// # Errors
    /// [`ClosedFormError::Receptance`].
    pub fn margin(&self, force: &LockedForce, frequency: f64) -> Result<f64, ClosedFormError> {
        self.margin_of(0, self.limits, &force.dynamic, frequency)
    }

    /// The margins of the other held elements, as [`Self::margin`].
    ///
    /// # Errors
    /// [`ClosedFormError::Receptance`].
    pub fn holding_margins(&self, force: &LockedForce, frequency: f64) -> Result<Vec<f64>, ClosedFormError> {
        (self.held.iter().zip(&force.held).enumerate())
            .map(|(i, (other, harmonics))| {
                self.margin_of(i + 1, other.limits, &extremes(harmonics), frequency)
            })
            .collect()
    }

    fn margin_of(
        &self,
        port: usize,
        (low, high): (f64, f64),
        dynamic: &Extremes,
        frequency: f64,
    ) -> Result<f64, ClosedFormError> {
        let two_sided = low.is_finite() && high.is_finite();
        if two_sided && self.locked.static_stiffness(frequency)?[(port, port)] > 0.0 {
            return Ok(0.5 * (high - low) - 0.5 * (dynamic.maximum - dynamic.minimum));
        }
        let mean = match self.locked.mean_forces(frequency) {
            Ok(means) => means[port],
            Err(ReceptanceError::FreeMean) => 0.0,
            Err(error) => return Err(error.into()),
        };
        Ok((mean + dynamic.minimum - low).min(high - mean - dynamic.maximum))
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
        let mut of_ports = vec![Complex::ZERO; self.locked.ports()];
        for (place, rate) in rates.iter_mut().enumerate() {
            self.locked
                .force_rate_by_inertia(place, coordinate, frequency, &mut of_ports)?;
            *rate = of_ports[0];
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
