//! Random drives: pulleys on a ring, back-side idlers between them, up to two tensioners, loads that leave the belt taut.

use glam::DVec2;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use slackside_belt_drive::drive::{
    ArcStretch, Belt, BeltDamping, BeltModel, Coupling, Drive, Guide, Installation, Load, Mount, Pulley,
    Sense, SpanEnds, Tensioner,
};
use slackside_belt_drive::steady::{Installed, SteadyState};
use std::f64::consts::TAU;

pub(crate) fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(4),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// A drive and a speed at which it runs (rad/s of the driver).
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub drive: Drive,
    pub speed: f64,
}

impl Case {
    pub fn installed(&self) -> Installed {
        Installed::new(&self.drive).unwrap()
    }

    pub fn steady(&self) -> SteadyState {
        SteadyState::solve(&self.drive, &self.installed(), self.speed).unwrap()
    }

    /// The free arms.
    pub fn free_arms(&self) -> Vec<usize> {
        (0..self.drive.tensioners.len())
            .filter(|arm| !self.drive.tensioners[*arm].locked)
            .collect()
    }
}

/// Numbers from 0 to 1 that make a drive.
#[derive(Debug, Clone)]
struct Recipe {
    ring: usize,
    idlers: [bool; 5],
    tensioners: usize,
    rotary: [bool; 2],
    shared_arm: bool,
    mirrored: bool,
    driver: usize,
    ends: SpanEnds,
    arcs: ArcStretch,
    numbers: Vec<f64>,
}

fn recipe() -> impl Strategy<Value = Recipe> {
    (
        2_usize..=5,
        any::<[bool; 5]>(),
        0_usize..=2,
        any::<[bool; 2]>(),
        any::<(bool, bool)>(),
        0_usize..8,
        prop_oneof![Just(SpanEnds::Tangent), Just(SpanEnds::Contact)],
        prop_oneof![
            Just(ArcStretch::None),
            Just(ArcStretch::Mean),
            Just(ArcStretch::Entry)
        ],
        proptest::collection::vec(0.0..1.0_f64, 100),
    )
        .prop_map(
            |(ring, idlers, tensioners, rotary, (shared_arm, mirrored), driver, ends, arcs, numbers)| {
                Recipe {
                    ring,
                    idlers,
                    tensioners,
                    rotary,
                    shared_arm,
                    mirrored,
                    driver,
                    ends,
                    arcs,
                    numbers,
                }
            },
        )
}

/// Drives of 2 to 8 pulleys with 0 to 2 tensioners, one of which may carry two idlers, that have a steady state.
pub(crate) fn running() -> impl Strategy<Value = Case> {
    recipe().prop_filter_map("no steady state", |recipe| {
        let case = case(&recipe);
        let installed = Installed::new(&case.drive).ok()?;
        SteadyState::solve(&case.drive, &installed, case.speed).ok()?;
        Some(case)
    })
}

fn pulley(name: String, radius: f64, sense: Sense, centre: DVec2) -> Pulley {
    Pulley {
        name,
        radius,
        sense,
        mount: Mount::Fixed(centre),
        inertia: 0.0,
        mass: 0.0,
        load: Load::NONE,
        bearing_damping: 0.0,
        drag_reacts_on_arm: false,
        friction: 1.0,
        coupling: Coupling::NONE,
        accessory_damping: 0.0,
    }
}

fn case(recipe: &Recipe) -> Case {
    let mut numbers = recipe.numbers.iter().copied().cycle();
    let mut between = |low: f64, high: f64| low + (high - low) * numbers.next().unwrap_or(0.5);
    let flip = |v: DVec2| if recipe.mirrored { DVec2::new(v.x, -v.y) } else { v };
    let (inside, outside) = if recipe.mirrored {
        (Sense::Clockwise, Sense::CounterClockwise)
    } else {
        (Sense::CounterClockwise, Sense::Clockwise)
    };
    let ring: Vec<(DVec2, f64)> = (0..recipe.ring)
        .map(|k| {
            let angle = TAU * k as f64 / recipe.ring as f64 + between(-0.15, 0.15);
            (between(0.2, 0.3) * DVec2::from_angle(angle), between(0.025, 0.06))
        })
        .collect();
    let mut pulleys = Vec::new();
    // Idlers that a tensioner may carry, with the direction from the loop's outside to its inside.
    let mut movable = Vec::new();
    for (k, (centre, radius)) in ring.iter().enumerate() {
        let (next, next_radius) = ring[(k + 1) % ring.len()];
        pulleys.push(pulley(format!("ring {k}"), *radius, inside, flip(*centre)));
        if !recipe.idlers[k] || pulleys.len() + ring.len() - k > 8 {
            continue;
        }
        let along = (next - *centre).normalize();
        let outward = -along.perp();
        let share = between(0.4, 0.6);
        let idler = between(0.02, 0.035);
        let depth = between(0.006, 0.03);
        // On the outer tangent, then out by the radius, then in by the depth.
        let on_tangent = centre.lerp(next, share) + outward * (radius + share * (next_radius - radius));
        let place = on_tangent + outward * (idler - depth);
        movable.push((pulleys.len(), place, -outward));
        pulleys.push(pulley(format!("idler {k}"), idler, outside, flip(place)));
    }
    let mut tensioners = Vec::new();
    let count = recipe.tensioners.min(movable.len());
    for arm in 0..count {
        let (index, place, inward) = movable[arm];
        let rotary = recipe.rotary[arm];
        let turn = between(-0.5, 0.5);
        let (guide, reference, rate) = if rotary {
            let angle = inward.perp().to_angle() + turn;
            let pivot = place - between(0.06, 0.12) * DVec2::from_angle(angle);
            let reference = angle + between(-1.0, 1.0);
            (
                Guide::Rotary { pivot: flip(pivot) },
                reference,
                between(15.0, 60.0),
            )
        } else {
            let direction = flip(DVec2::from_angle(inward.to_angle() + turn));
            (
                Guide::Linear { direction },
                between(-0.05, 0.05),
                between(2e3, 2e4),
            )
        };
        let reference = if rotary && recipe.mirrored {
            -reference
        } else {
            reference
        };
        let carried: Vec<(usize, DVec2)> = match movable.last() {
            Some((last, other, _))
                if recipe.shared_arm && rotary && arm == 0 && *last != index && count == 1 =>
            {
                vec![(index, place), (*last, *other)]
            }
            _ => vec![(index, place)],
        };
        for (index, place) in carried {
            let centre = flip(place);
            let in_frame = match guide {
                Guide::Rotary { pivot } => DVec2::from_angle(-reference).rotate(centre - pivot),
                Guide::Linear { direction } => centre - reference * direction,
            };
            pulleys[index].mount = Mount::Carried {
                tensioner: arm,
                place: in_frame,
            };
            pulleys[index].mass = between(0.1, 0.4);
            pulleys[index].drag_reacts_on_arm = between(0.0, 1.0) > 0.5;
        }
        tensioners.push(Tensioner {
            name: format!("arm {arm}"),
            guide,
            reference,
            spring_rate: rate,
            spring_preload: None,
            inertia: if rotary {
                between(1e-3, 3e-3)
            } else {
                between(0.2, 0.5)
            },
            damping: 0.0,
            stops: None,
            locked: between(0.0, 1.0) > 0.85,
            friction: None,
            one_way_damping: 0.0,
            stop_contact: None,
            pulley_contacts: Vec::new(),
        });
    }
    let tension = between(400.0, 900.0);
    let driver = recipe.driver % pulleys.len();
    let steps = pulleys.len() as f64;
    for pulley in &mut pulleys {
        pulley.inertia = between(2e-4, 2e-2);
        pulley.load = Load::Torque(between(0.0, 0.4) * tension / steps * pulley.radius);
    }
    let terms = (0..pulleys.len()).map(|_| between(0.0, 8.9) as usize).collect();
    Case {
        speed: between(0.0, 30.0) / pulleys[driver].radius,
        drive: Drive {
            belt: Belt {
                model: BeltModel::Beam,
                axial_stiffness: between(8e4, 3e5),
                bending_stiffness: between(0.005, 0.05),
                mass_per_length: between(0.05, 0.15),
                span_ends: recipe.ends,
                arc_stretch: recipe.arcs,
                terms,
                static_correction: true,
                arc_participation: 0.0,
                wrapped_inertia: false,
                damping: BeltDamping::default(),
                thermal_expansion: 0.0,
            },
            pulleys,
            tensioners,
            driver,
            installation: Installation::Tension(tension),
        },
    }
}

/// Pulleys of one size at the corners of a regular polygon, fixed, without loads.
pub(crate) fn ring_of(count: usize, radius: f64, inertia: f64, model: BeltModel) -> Drive {
    let pulleys = (0..count)
        .map(|k| {
            let angle = TAU * k as f64 / count as f64;
            let mut pulley = pulley(
                format!("pulley {k}"),
                radius,
                Sense::CounterClockwise,
                0.2 * DVec2::from_angle(angle),
            );
            pulley.inertia = inertia;
            pulley
        })
        .collect();
    Drive {
        belt: Belt {
            model,
            axial_stiffness: 120e3,
            bending_stiffness: 0.02,
            mass_per_length: 0.1,
            span_ends: SpanEnds::Tangent,
            arc_stretch: ArcStretch::None,
            terms: vec![12; count],
            static_correction: true,
            arc_participation: 0.0,
            wrapped_inertia: false,
            damping: BeltDamping::default(),
            thermal_expansion: 0.0,
        },
        pulleys,
        tensioners: Vec::new(),
        driver: 0,
        installation: Installation::Tension(500.0),
    }
}

/// `|a − b|` against the larger of both and `floor`.
#[track_caller]
pub(crate) fn close(a: f64, b: f64, tolerance: f64, floor: f64, what: &str) {
    let scale = a.abs().max(b.abs()).max(floor);
    assert!(
        (a - b).abs() <= tolerance * scale,
        "{what}: {a} and {b} differ by {:e} of {scale}",
        (a - b).abs() / scale
    );
}
