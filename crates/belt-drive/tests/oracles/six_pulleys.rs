//! A drive with everything: six pulleys, back-side idlers on a rotary arm and on a slide, loads, an isolator.

use glam::DVec2;
use slackside_belt_drive::drive::{
    ArcStretch, Belt, BeltDamping, BeltModel, Coupling, Drive, Flexible, Guide, Installation, Load, Mount,
    Pulley, Sense, SpanEnds, Tensioner,
};
use slackside_belt_drive::steady::{Installed, SteadyState};

/// The drive, installed at 400 N, without damping.
pub fn six_pulleys() -> Drive {
    let pulley = |name: &str, radius: f64, sense, mount, inertia: f64, load: f64| Pulley {
        name: name.into(),
        radius,
        sense,
        mount,
        inertia,
        mass: 0.0,
        load: Load::Torque(load),
        bearing_damping: 0.0,
        drag_reacts_on_arm: false,
        friction: 1.1,
        coupling: Coupling::NONE,
        accessory_damping: 0.0,
    };
    let (inside, outside) = (Sense::CounterClockwise, Sense::Clockwise);
    let fixed = |x, y| Mount::Fixed(DVec2::new(x, y));
    let pivot = DVec2::new(0.21, -0.13);
    let arm = DVec2::new(0.15, -0.092) - pivot;
    let mut alternator = pulley("alternator", 0.028, inside, fixed(0.33, 0.24), 4e-4, 6.0);
    alternator.coupling = Coupling::Isolator(Flexible {
        accessory_inertia: 3e-3,
        stiffness: 120.0,
        damping: 0.0,
    });
    let mut idler = pulley(
        "arm idler",
        0.03,
        outside,
        Mount::Carried {
            tensioner: 0,
            place: DVec2::new(arm.length(), 0.0),
        },
        1.5e-4,
        0.2,
    );
    idler.mass = 0.25;
    idler.drag_reacts_on_arm = true;
    let mut slider = pulley(
        "slide idler",
        0.032,
        outside,
        Mount::Carried {
            tensioner: 1,
            place: DVec2::new(-0.083, 0.15),
        },
        1.6e-4,
        0.1,
    );
    slider.mass = 0.2;
    Drive {
        belt: Belt {
            model: BeltModel::Beam,
            axial_stiffness: 240e3,
            bending_stiffness: 0.02,
            mass_per_length: 0.11,
            span_ends: SpanEnds::Tangent,
            arc_stretch: ArcStretch::Mean,
            terms: vec![40; 6],
            static_correction: true,
            arc_participation: 0.3,
            wrapped_inertia: true,
            damping: BeltDamping::default(),
            thermal_expansion: 0.0,
        },
        pulleys: vec![
            pulley("crank", 0.08, inside, fixed(0.0, 0.0), 0.05, 0.0),
            idler,
            pulley("compressor", 0.06, inside, fixed(0.3, -0.02), 4e-3, 12.0),
            alternator,
            pulley("pump", 0.065, inside, fixed(0.02, 0.3), 2e-3, 5.0),
            slider,
        ],
        tensioners: vec![
            Tensioner {
                name: "arm".into(),
                guide: Guide::Rotary { pivot },
                reference: arm.to_angle(),
                spring_rate: 30.0,
                spring_preload: None,
                inertia: 8e-4,
                damping: 0.0,
                stops: None,
                locked: false,
                friction: None,
                one_way_damping: 0.0,
                stop_contact: None,
                pulley_contacts: Vec::new(),
            },
            Tensioner {
                name: "slide".into(),
                guide: Guide::Linear {
                    direction: DVec2::new(1.0, 0.0),
                },
                reference: 0.0,
                spring_rate: 25e3,
                spring_preload: None,
                inertia: 0.3,
                damping: 0.0,
                stops: None,
                locked: false,
                friction: None,
                one_way_damping: 0.0,
                stop_contact: None,
                pulley_contacts: Vec::new(),
            },
        ],
        driver: 0,
        installation: Installation::Tension(500.0),
    }
}

/// The steady state at a driver speed (rad/s).
pub fn steady(drive: &Drive, speed: f64) -> SteadyState {
    SteadyState::solve(drive, &Installed::new(drive).unwrap(), speed).unwrap()
}
