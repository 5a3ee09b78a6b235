//! Damping of bearings, arms, couplings and belt (theory 04 §3.6).

use super::span_matrices::{drag, internal_bending};
use super::{LinearModel, add_between, add_local, add_outer, belt_spring};
use crate::drive::{BeltModel, Drive, Guide, Mount};
use crate::steady::SteadyState;

pub(super) fn add(model: &mut LinearModel, drive: &Drive, steady: &SteadyState, disengaged: &[usize]) {
    add_bearings(model, drive);
    for (arm, tensioner) in drive.tensioners.iter().enumerate() {
        let at = model.coordinates.arm(arm);
        model.damping[(at, at)] += tensioner.damping;
    }
    for (j, pulley) in drive.pulleys.iter().enumerate() {
        let shaft = model.coordinates.accessory(j).unwrap_or(j);
        model.damping[(shaft, shaft)] += pulley.accessory_damping;
        if let (Some(part), Some(accessory), false) = (
            pulley.coupling.flexible(),
            model.coordinates.accessory(j),
            disengaged.contains(&j),
        ) {
            add_between(&mut model.damping, j, accessory, part.damping, 1.0);
        }
    }
    add_span_dashpots(model, drive, steady);
    if drive.belt.model != BeltModel::Spring {
        add_transverse(model, drive, steady);
    }
    let belt = &drive.belt.damping;
    model.damping.add_scaled(belt.rayleigh_mass, &model.mass);
    model
        .damping
        .add_scaled(belt.rayleigh_stiffness, &model.stiffness);
}

/// The bearing of a pulley on a rotary arm turns with the arm: `½ b (θ̇ − σ q̇)²`.
fn add_bearings(model: &mut LinearModel, drive: &Drive) {
    for (j, pulley) in drive.pulleys.iter().enumerate() {
        let carrier = match pulley.mount {
            Mount::Carried { tensioner, .. }
                if matches!(drive.tensioners[tensioner].guide, Guide::Rotary { .. }) =>
            {
                Some(model.coordinates.arm(tensioner))
            }
            _ => None,
        };
        let damping = pulley.bearing_damping;
        match carrier {
            Some(arm) => add_between(&mut model.damping, j, arm, damping, pulley.sense.sign()),
            None => model.damping[(j, j)] += damping,
        }
    }
}

/// Kelvin–Voigt dashpots, parallel to the belt's own spring.
fn add_span_dashpots(model: &mut LinearModel, drive: &Drive, steady: &SteadyState) {
    let belt = &drive.belt.damping;
    for i in 0..drive.pulleys.len() {
        let from_loss = belt.loss_factor.map_or(0.0, |loss| {
            loss.value * belt_spring(drive, steady, i) / loss.reference_frequency
        });
        let dashpot = belt.span_dashpot + from_loss;
        add_outer(&mut model.damping, model.stretch.row(i), dashpot);
        model.span_dashpots.push(dashpot);
    }
}

fn add_transverse(model: &mut LinearModel, drive: &Drive, steady: &SteadyState) {
    let belt = &drive.belt.damping;
    for i in 0..drive.pulleys.len() {
        let terms = model.coordinates.sines(i).len();
        let on_velocity = (belt.external + belt.drag) / drive.belt.mass_per_length;
        add_local(
            &mut model.damping,
            &model.spans[i].mass,
            &model.local[i],
            on_velocity,
        );
        add_local(
            &mut model.circulatory,
            &drag(terms),
            &model.local[i],
            belt.drag * steady.belt_speed,
        );
        let (rate, circulatory) = internal_bending(terms, steady.layout.spans[i].length);
        add_local(&mut model.damping, &rate, &model.local[i], belt.internal_bending);
        add_local(
            &mut model.circulatory,
            &circulatory,
            &model.local[i],
            belt.internal_bending * steady.belt_speed,
        );
    }
}
