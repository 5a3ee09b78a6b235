//! Where the energy of a motion goes, and how often its elements reverse and stop (theory 05 §4.3, §5.6).

use super::regime_factory::RegimeFactory;
use super::step_map::Work;
use super::visitor::{Event, Piece};
use slackside_linalg::dot;
use slackside_mechanics::Transition;
use slackside_numerics::quadrature::gauss_legendre;
use std::sync::Arc;

/// The energy account of a stretch of motion, in units of energy:
/// `load = viscous + stored + Σ elements + Σ impacts`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Account {
    /// Work of the load, constant part and harmonics: `∫ Fᵀq' dt`.
    pub load: f64,
    /// What linear damping takes: `∫ q'ᵀC q' dt` (gyroscopic terms do no work).
    pub viscous: f64,
    /// Change of kinetic energy and work against the linear springs.
    pub stored: f64,
    /// Of each element.
    pub elements: Vec<ElementAccount>,
}

/// What one element does over a stretch of motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ElementAccount {
    /// Work done on the element, `∫ f v dt`: over a period what it dissipates.
    pub work: f64,
    /// Kinetic energy taken by its impacts.
    pub impact_loss: f64,
    /// Number of its impacts.
    pub impacts: usize,
    /// Changes of sign of its port's velocity, stops in between skipped.
    pub velocity_reversals: usize,
    /// Number of times its port comes to rest for a while.
    pub stops: usize,
    /// Changes of sign of its force.
    pub force_reversals: usize,
}

impl Account {
    /// What is missing in the balance, relative to the largest of its terms.
    pub fn imbalance(&self) -> f64 {
        let terms = [self.load, -self.viscous, -self.stored];
        let taken = self
            .elements
            .iter()
            .flat_map(|element| [-element.work, -element.impact_loss]);
        let (sum, size) = terms
            .into_iter()
            .chain(taken)
            .fold((0.0_f64, 0.0_f64), |(sum, size), term| {
                (sum + term, size.max(term.abs()))
            });
        if size == 0.0 { 0.0 } else { sum.abs() / size }
    }
}

/// Keeps the account while a motion is computed.
#[derive(Debug)]
pub(super) struct Bookkeeper {
    factory: Arc<RegimeFactory>,
    account: Account,
    /// Kinetic energy at the start; `None` before the first piece.
    initial: Option<f64>,
    /// Kinetic energy at the end of the last piece.
    last: f64,
    /// Signs seen per element: of the velocity, of the force.
    velocity_signs: Vec<Signs>,
    force_signs: Vec<Signs>,
    nodes: Vec<f64>,
}

/// Counts the changes of a sign in a sequence that is taken to begin again at its end.
#[derive(Debug, Clone, Copy, Default)]
struct Signs {
    first: i8,
    last: i8,
    changes: usize,
}

impl Signs {
    fn see(&mut self, value: f64, threshold: f64) {
        if value.abs() <= threshold {
            return;
        }
        let sign = if value > 0.0 { 1 } else { -1 };
        if self.last != 0 && self.last != sign {
            self.changes += 1;
        }
        if self.first == 0 {
            self.first = sign;
        }
        self.last = sign;
    }

    fn count(&self) -> usize {
        self.changes + usize::from(self.first != self.last)
    }
}

impl Bookkeeper {
    pub fn new(factory: &Arc<RegimeFactory>) -> Self {
        let count = factory.tables.len();
        Self {
            factory: factory.clone(),
            account: Account {
                elements: vec![ElementAccount::default(); count],
                ..Account::default()
            },
            initial: None,
            last: 0.0,
            velocity_signs: vec![Signs::default(); count],
            force_signs: vec![Signs::default(); count],
            nodes: vec![0.0; factory.layout.augmented()],
        }
    }

    fn kinetic(&self, z: &[f64]) -> f64 {
        let n = self.factory.layout.coordinates;
        0.5 * dot(&z[n..2 * n], &self.factory.mass.times(&z[n..2 * n]))
    }

    pub fn piece(&mut self, piece: &Piece<'_>, work: &mut Work) {
        if self.initial.is_none() {
            self.initial = Some(self.kinetic(piece.z));
        }
        let factory = self.factory.clone();
        let layout = &factory.layout;
        let (n, nx) = (layout.coordinates, layout.state());
        let rule = gauss_legendre();
        let generator = &piece.map.generator;
        piece.map.polynomial(piece.z, work);
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let weight = weight * piece.duration;
            work.state_at(node * piece.share, &mut self.nodes);
            layout.set_phase(
                &mut self.nodes,
                generator.frequency * (piece.time + node * piece.duration),
            );
            let z = &self.nodes;
            let velocity = &z[n..2 * n];
            let viscous = dot(velocity, &factory.damping.times(velocity));
            let springs = dot(velocity, &factory.stiffness.times(&z[..n]));
            let load = factory.load_power(z);
            self.account.viscous += weight * viscous;
            self.account.stored += weight * springs;
            self.account.load += weight * load;
            for (element, account) in self.account.elements.iter_mut().enumerate() {
                let v = dot(&factory.ports[element], velocity);
                let force = &generator.forces[element];
                let f = dot(force, z);
                account.work += weight * f * v;
                let regime = factory.regime(piece.map.joint, element);
                if !regime.sticks() {
                    self.velocity_signs[element].see(v, 0.0);
                }
                let size: f64 = force.iter().zip(z).map(|(a, b)| (a * b).abs()).sum();
                self.force_signs[element].see(f, 1e-12 * size);
            }
        }
        work.state_at(piece.share, &mut self.nodes);
        self.last = self.kinetic(&self.nodes[..nx]);
    }

    pub fn event(&mut self, event: &Event) {
        let regimes = &self.factory.tables[event.element].regimes;
        if event.from != event.to && regimes[event.to].sticks() {
            self.account.elements[event.element].stops += 1;
        }
        let hits = regimes[event.from]
            .guards
            .iter()
            .any(|guard| matches!(guard.transition, Transition::Impact { .. }));
        if hits {
            self.account.elements[event.element].impacts += 1;
        }
    }

    pub fn impact(&mut self, element: usize, energy: f64) {
        self.account.elements[element].impact_loss += energy;
    }

    /// The account. Reversals are those of a motion that repeats.
    pub fn finish(mut self) -> Account {
        // Impacts take kinetic energy that the integrals do not see.
        self.account.stored += self.last - self.initial.unwrap_or(0.0);
        let signs = self.velocity_signs.iter().zip(&self.force_signs);
        for (account, (velocity, force)) in self.account.elements.iter_mut().zip(signs) {
            account.velocity_reversals = velocity.count();
            account.force_reversals = force.count();
        }
        self.account
    }
}
