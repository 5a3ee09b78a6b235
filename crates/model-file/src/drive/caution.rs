//! What may surprise about a drive that can be computed.

use super::{
    Coupling, CouplingKind, Drive, DryFriction, FrictionLaw, Guide, Installation, Length, Mount, Pulley,
    Tensioner,
};
use crate::scalar::join;

impl Drive {
    /// Key and message of what the linear model leaves out or holds fixed.
    pub(crate) fn cautions_of_linear_model(&self) -> Vec<(String, String)> {
        let mut cautions = Vec::new();
        for pulley in &self.pulleys {
            let state = match pulley.coupling.as_ref().map(|coupling| coupling.kind) {
                None | Some(CouplingKind::Rigid | CouplingKind::Isolator) => continue,
                Some(CouplingKind::OneWay) => "the linear model has the clutch locked: a rigid shaft",
                Some(CouplingKind::WrapSpring | CouplingKind::Decoupler) => {
                    "the linear model has the clutch engaged: a spring and a damper"
                }
            };
            cautions.push((format!("pulley.{}.coupling.kind", pulley.name), state.to_owned()));
        }
        for tensioner in &self.tensioners {
            let path = format!("tensioner.{}", tensioner.name);
            let mut left_out = |key: &str, what: &str| {
                cautions.push((
                    join(&path, key),
                    format!("the steady state and the linear model leave {what} out"),
                ));
            };
            if tensioner.friction.is_some() {
                left_out("friction", "dry friction");
            }
            if tensioner.one_way_damping > 0.0 {
                left_out("one_way_damping", "damping in one direction");
            }
        }
        cautions
    }

    /// Key and message of what motions leave out.
    pub(crate) fn cautions_of_motions(&self) -> Vec<(String, String)> {
        let unguarded = |tensioner: &&Tensioner| {
            tensioner.stops.is_some() && tensioner.stop_contact.is_none() && !tensioner.locked
        };
        self.tensioners
            .iter()
            .filter(unguarded)
            .map(|tensioner| {
                (
                    format!("tensioner.{}.stops", tensioner.name),
                    "motions pass the stops; add `stop_contact` with `restitution` or `stiffness` for them to act".to_owned(),
                )
            })
            .collect()
    }

    /// Key and message of everything that may surprise in every analysis.
    pub(crate) fn cautions(&self) -> Vec<(String, String)> {
        let mut cautions = Vec::new();
        if self.belt.friction.is_none() {
            cautions.push((
                "belt.friction".to_owned(),
                "is not given: the safety against slip is judged with an effective friction of 1".to_owned(),
            ));
        }
        for pulley in &self.pulleys {
            if pulley.inertia == 0.0 && !pulley.driver {
                cautions.push((
                    format!("pulley.{}.inertia", pulley.name),
                    "the pulley has no inertia: the steady state is right, modes and vibrations need one"
                        .to_owned(),
                ));
            }
            if let Some(coupling) = &pulley.coupling {
                caution_coupling(
                    &format!("pulley.{}.coupling", pulley.name),
                    coupling,
                    &mut cautions,
                );
            }
        }
        for tensioner in &self.tensioners {
            self.caution_tensioner(tensioner, &mut cautions);
        }
        cautions
    }

    fn caution_tensioner(&self, tensioner: &Tensioner, cautions: &mut Vec<(String, String)>) {
        let path = format!("tensioner.{}", tensioner.name);
        if let Some(friction) = &tensioner.friction {
            caution_friction(&format!("{path}.friction"), friction, cautions);
        }
        if tensioner.stops.is_none() && tensioner.stop_contact.is_some() {
            cautions.push((
                format!("{path}.stop_contact"),
                "is not used: the tensioner has no stops".to_owned(),
            ));
        }
        let follows = matches!(self.belt.length, Length::Installation(Installation::Tension(_)));
        let has_preload = tensioner
            .spring
            .as_ref()
            .is_some_and(|spring| spring.preload.is_some());
        if follows && has_preload {
            cautions.push((
                format!("{path}.spring.preload"),
                "is not used: the preload follows from the tension of the installation".to_owned(),
            ));
        }
        let (key, own) = match &tensioner.guide {
            Guide::Rotary(rotary) => ("inertia", rotary.inertia),
            Guide::Linear(linear) => ("mass", linear.mass),
        };
        let carries_mass = |pulley: &Pulley| matches!(&pulley.mount, Mount::Carried(carried) if carried.arm == tensioner.name && carried.mass > 0.0);
        if own == 0.0 && !tensioner.locked && !self.pulleys.iter().any(carries_mass) {
            cautions.push((
                format!("{path}.{key}"),
                format!(
                    "the tensioner has no {key}: the steady state is right, modes and vibrations need one"
                ),
            ));
        }
    }
}

/// Which keys of a coupling its kind does not use.
fn caution_coupling(path: &str, coupling: &Coupling, cautions: &mut Vec<(String, String)>) {
    let flexible = coupling.kind.is_flexible();
    for (key, is_unused) in [
        ("stiffness", coupling.stiffness.is_some() && !flexible),
        ("damping", coupling.damping.is_some() && !flexible),
        (
            "preload",
            coupling.preload.is_some() && coupling.kind != CouplingKind::Decoupler,
        ),
    ] {
        if is_unused {
            cautions.push((
                format!("{path}.{key}"),
                format!("is not used by a coupling of kind \"{}\"", coupling.kind.word()),
            ));
        }
    }
}

/// Which keys of a friction its law does not use.
fn caution_friction(path: &str, friction: &DryFriction, cautions: &mut Vec<(String, String)>) {
    let law = friction.law;
    let (coulomb, lugre) = (law == FrictionLaw::Coulomb, law == FrictionLaw::Lugre);
    let measured = law == FrictionLaw::MeasuredLoop;
    for (key, is_unused) in [
        ("torque", friction.torque.is_some() && measured),
        ("force", friction.force.is_some() && measured),
        ("loading", friction.loading.is_some() && !coulomb),
        ("unloading", friction.unloading.is_some() && !coulomb),
        (
            "static_ratio",
            friction.static_ratio != 1.0 && !(coulomb || lugre),
        ),
        ("stiffness", friction.stiffness.is_some() && (coulomb || measured)),
        ("damping", friction.damping.is_some() && !lugre),
        ("viscous", friction.viscous.is_some() && !lugre),
        (
            "stribeck_velocity",
            friction.stribeck_velocity.is_some() && !lugre,
        ),
        ("loop", friction.measured.is_some() && !measured),
    ] {
        if is_unused {
            cautions.push((
                join(path, key),
                format!("is not used by friction of law \"{}\"", friction.law.word()),
            ));
        }
    }
}
