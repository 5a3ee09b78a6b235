//! The three-pulley prototype of the serpentine drive: crank, tensioner, accessory (theory 04 §5.1 and appendix A).

use crate::drive::{
    ArcStretch, Belt, BeltDamping, BeltModel, Coupling, Drive, Guide, Installation, Load, Mount, Pulley,
    Sense, SpanEnds, Tensioner,
};
use glam::DVec2;

/// The prototype as a beam with this bending stiffness (N·m²) and a load of 5 N·m on the accessory, installed at 300 N:
/// spans end at the tangent points, arcs do not stretch, ten sine terms for each span with static correction.
pub fn three_pulley(bending_stiffness: f64) -> Drive {
    let tensioner_centre = DVec2::new(0.3477, 0.05715);
    let pivot = DVec2::new(0.2508, 0.0635);
    let arm = tensioner_centre - pivot;
    let pulley = |name: &str, radius, sense, mount, inertia, load, friction| Pulley {
        name: name.into(),
        radius,
        sense,
        mount,
        inertia,
        mass: 0.0,
        load: Load::Torque(load),
        bearing_damping: 0.0,
        drag_reacts_on_arm: false,
        friction,
        coupling: Coupling::NONE,
        accessory_damping: 0.0,
    };
    Drive {
        belt: Belt {
            model: BeltModel::Beam,
            axial_stiffness: 170e3,
            bending_stiffness,
            mass_per_length: 0.1029,
            span_ends: SpanEnds::Tangent,
            arc_stretch: ArcStretch::None,
            terms: vec![10; 3],
            static_correction: true,
            arc_participation: 0.0,
            wrapped_inertia: false,
            damping: BeltDamping::default(),
            thermal_expansion: 0.0,
        },
        pulleys: vec![
            pulley(
                "crank",
                0.0889,
                Sense::CounterClockwise,
                Mount::Fixed(DVec2::new(0.5525, 0.0556)),
                0.07248,
                0.0,
                1.0,
            ),
            pulley(
                "tensioner pulley",
                0.0452,
                Sense::Clockwise,
                Mount::Carried {
                    tensioner: 0,
                    place: DVec2::new(arm.length(), 0.0),
                },
                2.93e-4,
                0.0,
                0.35,
            ),
            pulley(
                "accessory",
                0.02697,
                Sense::CounterClockwise,
                Mount::Fixed(DVec2::ZERO),
                2.93e-4,
                5.0,
                1.0,
            ),
        ],
        tensioners: vec![Tensioner {
            name: "tensioner".into(),
            guide: Guide::Rotary { pivot },
            reference: arm.to_angle(),
            spring_rate: 54.37,
            spring_preload: None,
            inertia: 1.165e-3,
            damping: 0.0,
            stops: None,
            locked: false,
            friction: None,
            one_way_damping: 0.0,
            stop_contact: None,
            pulley_contacts: Vec::new(),
        }],
        driver: 0,
        installation: Installation::Tension(300.0),
    }
}
