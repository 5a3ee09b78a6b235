//! What may surprise about a drive that can be computed.

use super::{Coupling, CouplingKind, Drive, Guide, Installation, Length, Mount, Pulley, Tensioner};

impl Drive {
    /// Key and message of everything that may surprise.
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
        if tensioner.friction.is_some() {
            cautions.push((
                format!("{path}.friction"),
                "the steady state and the linear model leave dry friction out".to_owned(),
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

/// What the linear model makes of a coupling that can open, and which of its keys it does not use.
fn caution_coupling(path: &str, coupling: &Coupling, cautions: &mut Vec<(String, String)>) {
    let state = match coupling.kind {
        CouplingKind::Rigid | CouplingKind::Isolator => None,
        CouplingKind::OneWay => Some("the linear model has the clutch locked: a rigid shaft"),
        CouplingKind::WrapSpring | CouplingKind::Decoupler => {
            Some("the linear model has the clutch engaged: a spring and a damper")
        }
    };
    if let Some(state) = state {
        cautions.push((format!("{path}.kind"), state.to_owned()));
    }
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
