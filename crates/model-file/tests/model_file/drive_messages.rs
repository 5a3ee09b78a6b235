//! What users read when a drive is wrong or surprising.

use slackside_model_file::{Document, Scope};

use crate::{DRIVE, message, read, with_line};

/// Start of a line of the drive, what replaces the line, and the message.
type Case = (&'static str, &'static str, &'static str);

#[track_caller]
fn assert_messages(cases: &[Case]) {
    for (start, line, expected) in cases {
        assert_eq!(message(&with_line(DRIVE, start, line)), *expected);
    }
}

#[test]
#[rustfmt::skip]
fn unknown_keys_suggest_the_nearest() {
    assert_messages(&[
        (r#"model = "beam""#, r#"modell = "beam""#,
            r#"test.toml:3: belt.modell: unknown key "modell"; did you mean "model"?"#),
        (r#"radius = "88.9 mm""#, r#"radios = "88.9 mm""#,
            r#"test.toml:18: pulley.crank.radios: unknown key "radios"; did you mean "radius"?"#),
        ("arm_angle", r#"position = "1 mm""#,
            r#"test.toml:42: tensioner.tensioner.position: unknown key "position"; did you mean "friction"?"#),
        ("stops", "stop = 1",
            r#"test.toml:47: tensioner.tensioner.stop: unknown key "stop"; did you mean "stops"?"#),
        ("speed = ", "velocity = 1",
            r#"test.toml:50: operating.velocity: unknown key "velocity"; known keys here are speed and rotation"#),
        ("load", "laod = 1",
            r#"test.toml:33: pulley.alternator.laod: unknown key "laod"; did you mean "load"?"#),
        ("accessory_inertia", "inertia = 1",
            r#"test.toml:36: pulley.alternator.coupling.inertia: unknown key "inertia"; known keys here are kind, accessory_inertia, accessory_damping, stiffness, damping and preload"#),
        ("damping = { loss", "damping = { los_factor = 0.05 }",
            r#"test.toml:9: belt.damping.los_factor: unknown key "los_factor"; did you mean "loss_factor"?"#),
        ("temperature_change", r#"temperature = "80 K""#,
            r#"test.toml:55: condition.hot.temperature: unknown key "temperature"; did you mean "temperature_change"?"#),
    ]);
}

#[test]
#[rustfmt::skip]
fn missing_keys_say_what_to_add() {
    assert_messages(&[
        ("[belt]", "[[belt]]",
            r#"test.toml:2: belt = [{ arc_stretch = "mean", axial_stiffness = "170 kN", bending…: expected a table, found a list"#),
        (r#"model = "beam""#, "",
            r#"test.toml:2: belt.model: is missing; add a line such as `model = "beam"`"#),
        ("axial_stiffness", "",
            r#"test.toml:2: belt.axial_stiffness: is missing; add a line such as `axial_stiffness = "170 kN"`"#),
        ("natural_length", "",
            r#"test.toml:2: belt.installation: nothing says how long the belt is; add `installation = { tension = "300 N" }` (at rest, unloaded, arms at their reference), `installation = { operating_position = true }`, `natural_length` or `effective_length`"#),
        (r#"center = ["552"#, "",
            r#"test.toml:15: pulley.crank.center: nothing says where the pulley is; add `center = ["120 mm", "80 mm"]`, or `arm = "…"` with the name of the tensioner that carries it"#),
        (r#"radius = "88.9 mm""#, "",
            r#"test.toml:15: pulley.crank.radius: nothing says how large the pulley is; add `radius = "30 mm"` (of the cord line), `outside_diameter` or `effective_diameter`"#),
        (r#"name = "crank""#, "",
            r#"test.toml:15: pulley.0.name: is missing; add a line such as `name = "alternator"`"#),
        ("driver = true", "",
            "test.toml:15: pulley: no pulley drives the belt; add `driver = true` to the crank pulley"),
        (r#"kind = "one-way""#, "",
            r#"test.toml:34: pulley.alternator.coupling.kind: is missing; add a line such as `kind = "isolator"`"#),
        (r#"kind = "rotary""#, "",
            r#"test.toml:37: tensioner.tensioner.kind: is missing; add a line such as `kind = "rotary"`"#),
        ("pivot", "",
            r#"test.toml:37: tensioner.tensioner.pivot: is missing; add a line such as `pivot = ["250 mm", "60 mm"]`"#),
        ("arm_length", "",
            r#"test.toml:37: tensioner.tensioner.arm_length: is missing; add the distance from the pivot to the centre of the pulley, such as `arm_length = "97.1 mm"`"#),
        ("arm_angle", "",
            r#"test.toml:37: tensioner.tensioner.arm_angle: is missing; add a line such as `arm_angle = "0.57 deg"`"#),
        ("spring", "",
            r#"test.toml:37: tensioner.tensioner.spring: is missing; add a line such as `spring = { rate = "54 N m/rad" }`, or `locked = true` for a tensioner that is held where it stands"#),
        ("spring", "spring = { rate = 54.37 }",
            r#"test.toml:44: tensioner.tensioner.spring.preload: is missing: with belt.natural_length it does not follow from the installation; add the torque of the spring at the reference position, positive where it tightens the belt, or write `installation = { tension = "300 N" }`"#),
        ("friction = { torque", "friction = { static_ratio = 1.2 }",
            "test.toml:46: tensioner.tensioner.friction.torque: nothing says how large the friction is; add `torque`, or `loading` and `unloading`"),
        ("friction = { torque", r#"friction = { law = "dahl", torque = 1 }"#,
            "test.toml:46: tensioner.tensioner.friction.stiffness: is missing; add `stiffness`: how the tensioner gives before it slides"),
        ("friction = { torque", r#"friction = { law = "lugre", torque = 1, stiffness = 300 }"#,
            "test.toml:46: tensioner.tensioner.friction.stribeck_velocity: is missing; add `stribeck_velocity`: the velocity over which friction falls from that at rest"),
        ("friction = { torque", r#"friction = { law = "measured-loop" }"#,
            "test.toml:46: tensioner.tensioner.friction.loop: is missing; add `loop`: the measured torques"),
        ("bearing_drag", "stop_contact = { damping = 1 }",
            "test.toml:48: tensioner.tensioner.stop_contact.stiffness: nothing says what happens at the contact; add `restitution = 0.5` for a rigid contact, or `stiffness` for a compliant one"),
        ("friction = { torque", "friction = { loading = 1 }",
            "test.toml:46: tensioner.tensioner.friction.unloading: is missing; friction that depends on the direction has `loading` and `unloading`; for one value write `torque`"),
        ("speed = ", "",
            r#"test.toml:49: operating.speed: is missing; add a line such as `speed = "2000 rpm"`"#),
        ("motion", "motion = [{ order = 2 }]",
            r#"test.toml:52: excitation.motion.0.amplitude: is missing; add a line such as `amplitude = "0.57 deg"`"#),
        ("natural_length", "installation = {}",
            r#"test.toml:10: belt.installation: says nothing of the installation; write `{ tension = "300 N" }` or `{ operating_position = true }`"#),
        ("load", "load = { speed = [1, 2] }",
            r#"test.toml:33: pulley.alternator.load.torque: is missing; add a line such as `torque = ["2 N m", "4 N m"]`"#),
        ("load", "load = { torque = [1, 2] }",
            r#"test.toml:33: pulley.alternator.load.speed: is missing; add a line such as `speed = ["1000 rpm", "6000 rpm"]`"#),
    ]);
}

#[test]
#[rustfmt::skip]
fn values_of_the_wrong_sort_name_the_right_one() {
    assert_messages(&[
        (r#"model = "beam""#, r#"model = "bean""#,
            r#"test.toml:3: belt.model = "bean": unknown belt model; did you mean "beam"? Known are spring, string and beam"#),
        ("span_ends", r#"span_ends = "free""#,
            r#"test.toml:11: belt.span_ends = "free": unknown end of spans; known are tangent and contact"#),
        ("arc_stretch", "arc_stretch = true",
            "test.toml:12: belt.arc_stretch = true: expected a text in quotes, found a boolean"),
        ("static_correction", r#"static_correction = "yes""#,
            r#"test.toml:13: belt.static_correction = "yes": expected true or false, found a text"#),
        ("modes_per_span", "modes_per_span = 2.5",
            "test.toml:7: belt.modes_per_span = 2.5: expected a whole number, or a list with one for each span, found a number"),
        ("modes_per_span", "modes_per_span = -1",
            "test.toml:7: belt.modes_per_span = -1: must not be negative; give zero or a positive whole number"),
        ("axial_stiffness", r#"axial_stiffness = "170 kN/m""#,
            r#"test.toml:4: belt.axial_stiffness = "170 kN/m": expected an axial stiffness EA such as "170 kN", found "170 kN/m"; correct the unit, or write a number without quotes in SI units"#),
        (r#"center = ["552"#, r#"center = ["552.5 mm"]"#,
            r#"test.toml:17: pulley.crank.center = ["552.5 mm"]: expected two values, found 1; write two in brackets, each a length such as "120 mm""#),
        (r#"center = ["552"#, r#"center = "552.5 mm""#,
            r#"test.toml:17: pulley.crank.center = "552.5 mm": expected a list, found a text"#),
        (r#"contact = "back""#, r#"contact = "rear""#,
            r#"test.toml:26: pulley.tensioner pulley.contact = "rear": unknown side of the belt; known are ribs and back"#),
        ("load", r#"load = "6 N""#,
            r#"test.toml:33: pulley.alternator.load = "6 N": expected a torque or a power such as "4.5 N m", found "6 N"; correct the unit, or write a number without quotes in SI units"#),
        ("load", "load = true",
            r#"test.toml:33: pulley.alternator.load = true: expected a torque or a power such as "4.5 N m", found a boolean"#),
        (r#"kind = "one-way""#, r#"kind = "oneway""#,
            r#"test.toml:35: pulley.alternator.coupling.kind = "oneway": unknown kind of coupling; did you mean "one-way"? Known are rigid, one-way, wrap-spring, isolator and decoupler"#),
        (r#"kind = "rotary""#, r#"kind = "rotating""#,
            r#"test.toml:39: tensioner.tensioner.kind = "rotating": unknown kind of tensioner; did you mean "rotary"? Known are rotary and linear"#),
        ("spring", r#"spring = { rate = "54 N/m" }"#,
            r#"test.toml:44: tensioner.tensioner.spring.rate = "54 N/m": expected a torsional stiffness such as "332 N m/rad", found "54 N/m"; correct the unit, or write a number without quotes in SI units"#),
        (r#"damping = "0.05"#, r#"damping = "0.05 N s/m""#,
            r#"test.toml:45: tensioner.tensioner.damping = "0.05 N s/m": expected a torsional damping coefficient such as "0.05 N m s/rad", found "0.05 N s/m"; correct the unit, or write a number without quotes in SI units"#),
        ("stops", r#"stops = ["-40 mm", "25 mm"]"#,
            r#"test.toml:47: tensioner.tensioner.stops.0 = "-40 mm": expected an angle such as "0.57 deg", found "-40 mm"; correct the unit, or write a number without quotes in SI units"#),
        ("bearing_drag", r#"bearing_drag = "engine""#,
            r#"test.toml:48: tensioner.tensioner.bearing_drag = "engine": unknown place of reaction; known are arm and ground"#),
        ("speed = ", r#"speed = "2000 rmp""#,
            r#"test.toml:50: operating.speed = "2000 rmp": expected a rotational speed such as "2000 rpm", found "2000 rmp", whose unit "rmp" is not known; write a number and a unit in quotes, or a number without quotes in SI units"#),
        ("speed = ", "speed = 1\nrotation = \"left\"",
            r#"test.toml:51: operating.rotation = "left": unknown sense of rotation; known are counter-clockwise and clockwise"#),
        ("motion", r#"motion = [{ order = 2, amplitude = "1 N m" }]"#,
            r#"test.toml:52: excitation.motion.0.amplitude = "1 N m": expected an angle such as "0.57 deg", found "1 N m"; correct the unit, or write a number without quotes in SI units"#),
        ("temperature_change", r#"temperature_change = "80 mm""#,
            r#"test.toml:55: condition.hot.temperature_change = "80 mm": expected a change of temperature such as "80 K", found "80 mm"; correct the unit, or write a number without quotes in SI units"#),
        ("natural_length", "installation = { operating_position = 1 }",
            "test.toml:10: belt.installation.operating_position = 1: expected true or false, found an integer"),
    ]);
}

#[test]
#[rustfmt::skip]
fn numbers_out_of_bounds_are_rejected() {
    assert_messages(&[
        ("axial_stiffness", "axial_stiffness = 0",
            "test.toml:4: belt.axial_stiffness = 0: must be greater than zero; give a value greater than zero"),
        ("bending_stiffness", "bending_stiffness = 0",
            r#"test.toml:5: belt.bending_stiffness = 0: spans that are beams need a bending stiffness; give the bending stiffness, for example "0.015 N m^2", or write `model = "string"`"#),
        ("mass_per_length", r#"mass_per_length = "-1 kg/m""#,
            r#"test.toml:6: belt.mass_per_length = "-1 kg/m": must be greater than zero; give a value greater than zero"#),
        ("modes_per_span", "modes_per_span = 0",
            r#"test.toml:7: belt.modes_per_span = 0: a span has from 1 to 1000 sine terms; 5 to 20 suffice; for spans that do not vibrate write `model = "spring"`"#),
        ("modes_per_span", "modes_per_span = [5, 5]",
            "test.toml:7: belt.modes_per_span: 2 numbers for 3 spans; give one number, or one for each pulley: of the span that starts there"),
        ("modes_per_span", "modes_per_span = [5, 5, 2000]",
            r#"test.toml:7: belt.modes_per_span.2 = 2000: a span has from 1 to 1000 sine terms; 5 to 20 suffice; for spans that do not vibrate write `model = "spring"`"#),
        ("friction = 1.0", "friction = 0",
            "test.toml:8: belt.friction = 0: must be greater than zero; give a value greater than zero"),
        ("friction = 1.0", r#"friction = { coefficient = 0.3, groove_angle = "200 deg" }"#,
            r#"test.toml:8: belt.friction.groove_angle = "200 deg": a groove opens by less than 180 degrees; give the full angle between its flanks, 40 deg for PK ribs"#),
        ("damping = { loss", "damping = { modal = [] }",
            "test.toml:9: belt.damping.modal = []: the list of damping ratios is empty; give one ratio, or a list from the lowest mode upwards"),
        ("damping = { loss", "damping = { modal = [0.1, -0.1] }",
            "test.toml:9: belt.damping.modal.1 = -0.1: must not be negative; give zero or a positive value"),
        ("natural_length", r#"natural_length = "0 mm""#,
            r#"test.toml:10: belt.natural_length = "0 mm": must be greater than zero; give a value greater than zero"#),
        ("natural_length", r#"installation = { tension = "-300 N" }"#,
            r#"test.toml:10: belt.installation.tension = "-300 N": must be greater than zero; give a value greater than zero"#),
        ("natural_length", "installation = { operating_position = false }",
            "test.toml:10: belt.installation.operating_position = false: then nothing says how long the belt is; write true, or give a tension or a length"),
        ("static_correction", "arc_participation = 1.5",
            "test.toml:13: belt.arc_participation = 1.5: must lie between zero and one; give a share from 0 to 1"),
        ("static_correction", "ribs = 0",
            "test.toml:13: belt.ribs = 0: a belt has at least one rib; give the number of ribs, for example 6"),
        (r#"radius = "88.9 mm""#, r#"radius = "0 mm""#,
            r#"test.toml:18: pulley.crank.radius = "0 mm": must be greater than zero; give a value greater than zero"#),
        (r#"radius = "88.9 mm""#, r#"radius = "inf mm""#,
            r#"test.toml:18: pulley.crank.radius = "inf mm": expected a length such as "120 mm", found "inf mm", which does not start with a number; write a number and a unit in quotes, or a number without quotes in SI units"#),
        ("driver = true", "driver = true\nbearing_damping = -1",
            "test.toml:22: pulley.crank.bearing_damping = -1: must not be negative; give zero or a positive value"),
        ("load", "load = nan",
            "test.toml:33: pulley.alternator.load = nan: is not a finite number; give a finite number"),
        ("load", "load = { speed = [], torque = [] }",
            "test.toml:33: pulley.alternator.load.speed = []: the table is empty; give at least one speed"),
        ("load", "load = { speed = [1, 1], torque = [1, 2] }",
            "test.toml:33: pulley.alternator.load.speed.1 = 1: the speeds of a table ascend, and this one is not above the one before; sort the table by speed"),
        ("load", "load = { speed = [1, 2], torque = [1] }",
            "test.toml:33: pulley.alternator.load.torque: 1 value for 2 speeds; give one value for each speed"),
        ("accessory_inertia", "accessory_inertia = 0",
            r#"test.toml:36: pulley.alternator.coupling.accessory_inertia: is missing: a coupling of kind "one-way" has an accessory behind it; add a line such as `accessory_inertia = "3e-3 kg m^2"`"#),
        ("arm_length", "arm_length = 0",
            "test.toml:41: tensioner.tensioner.arm_length = 0: must be greater than zero; give a value greater than zero"),
        ("stops", r#"stops = ["25 deg", "-40 deg"]"#,
            r#"test.toml:47: tensioner.tensioner.stops = ["25 deg", "-40 deg"]: the second stop is not above the first: stops are the smallest and the largest position; give the smaller one first"#),
        ("arm_angle", r#"arm_angle = "30 deg""#,
            r#"test.toml:42: tensioner.tensioner.arm_angle = "30 deg": the reference position is beyond the stops; angles are counter-clockwise from +x, as the stops; correct the reference position or the stops"#),
        ("friction = { torque", r#"friction = { law = "measured-loop", loop = { position = [0, 0.1], loading = [5, 5], unloading = [4, 6] } }"#,
            "test.toml:46: tensioner.tensioner.friction.loop.loading.1 = 5: the torque while loading is below that while unloading: friction would drive the tensioner; exchange `loading` and `unloading`, or correct the values"),
        ("friction = { torque", r#"friction = { law = "measured-loop", loop = { position = [0.1, 0], loading = [5, 5], unloading = [4, 4] } }"#,
            "test.toml:46: tensioner.tensioner.friction.loop.position.1 = 0: the positions of a loop ascend, and this one is not above the one before; sort the loop by position"),
        ("bearing_drag", "stop_contact = { restitution = 1.5 }",
            "test.toml:48: tensioner.tensioner.stop_contact.restitution = 1.5: must lie between zero and one; give a share from 0 to 1"),
        ("bearing_drag", r#"pulley_contact = [{ pulley = "cranc", stiffness = 1e6 }]"#,
            r#"test.toml:48: tensioner.tensioner.pulley_contact.0.pulley = "cranc": there is no such pulley that the tensioner does not carry; did you mean "crank"?"#),
        ("friction = { torque", "friction = { torque = 2, static_ratio = 0.9 }",
            "test.toml:46: tensioner.tensioner.friction.static_ratio = 0.9: friction at rest is not below that in motion; give a ratio of at least 1"),
        ("speed = ", r#"speed = "-2000 rpm""#,
            r#"test.toml:50: operating.speed = "-2000 rpm": must not be negative; give zero or a positive value"#),
        ("motion", "motion = [{ order = 0, amplitude = 1 }]",
            "test.toml:52: excitation.motion.0.order = 0: must be greater than zero; give a value greater than zero"),
        ("motion", "motion = [{ order = 2, amplitude = [1, 2] }]",
            r#"test.toml:52: excitation.motion.0.amplitude: a list belongs to speeds, and there are none; add `speed = ["1000 rpm", …]` with as many values, or give one value"#),
        ("motion", "motion = [{ order = 2, speed = [1, 2], amplitude = [1, 2, 3] }]",
            "test.toml:52: excitation.motion.0.amplitude: 3 values for 2 speeds; give one value for each speed"),
        ("temperature_change", "elongation = -1",
            r#"test.toml:55: condition.hot.elongation = -1: an elongation is a strain: minus one would leave no belt; give a strain such as 0.003 or "0.3 %""#),
        ("temperature_change", "spring_factor = 0",
            "test.toml:55: condition.hot.spring_factor = 0: must be greater than zero; give a value greater than zero"),
    ]);
}

#[test]
#[rustfmt::skip]
fn contradictions_are_named_with_a_way_out() {
    assert_messages(&[
        ("natural_length", "natural_length = 1.5\ninstallation = { tension = 300 }",
            "test.toml:11: belt.installation = { tension = 300 }: the length of the belt already follows from natural_length; keep one of natural_length and installation"),
        ("natural_length", "installation = { tension = 300, operating_position = true }",
            "test.toml:10: belt.installation = { operating_position = true, tension = 300 }: gives both a tension at rest and the position at the operating point; keep one of the two"),
        ("natural_length", "natural_length = 1.5\nmeasuring_tension = 300",
            "test.toml:11: belt.measuring_tension = 300: belongs to an effective length, and the belt has none; remove it, or give `effective_length`"),
        ("axial_stiffness", "axial_stiffness = 1\nper_rib = { axial_stiffness = 1, mass_per_length = 1 }",
            "test.toml:4: belt.axial_stiffness: the belt has both values of the whole belt and values per rib; keep axial_stiffness of the whole belt or belt.per_rib, and give all values in the same form"),
        (r#"radius = "88.9 mm""#, "radius = \"88.9 mm\"\noutside_diameter = \"170 mm\"",
            r#"test.toml:19: pulley.crank.outside_diameter = "170 mm": the size of the pulley is already given by radius; keep one of radius and outside_diameter"#),
        (r#"radius = "45.2 mm""#, r#"outside_diameter = "90 mm""#,
            r#"test.toml:25: pulley.tensioner pulley.outside_diameter = "90 mm": the pitch radius follows only with belt.cord_offset_back, the distance of the cord line; add `cord_offset_back = "…"` to [belt] (about 1 mm for PK belts), or give the pitch radius as `radius`"#),
        (r#"radius = "45.2 mm""#, r#"effective_diameter = "90 mm""#,
            r#"test.toml:25: pulley.tensioner pulley.effective_diameter = "90 mm": an effective diameter belongs to ribs, and the back of the belt touches this pulley; give `outside_diameter` or `radius`"#),
        (r#"center = ["552"#, "center = [1, 2]\narm = \"tensioner\"",
            r#"test.toml:18: pulley.crank.arm = "tensioner": the pulley has both a fixed centre and a tensioner that carries it; keep `center` or `arm`"#),
        (r#"center = ["552"#, "center = [1, 2]\narm_length = 1",
            "test.toml:18: pulley.crank.arm_length = 1: belongs to a pulley on a tensioner, and this one has a fixed centre; remove the key, or give `arm` in place of `center`"),
        ("arm = ", r#"arm = "tensionner""#,
            r#"test.toml:24: pulley.tensioner pulley.arm = "tensionner": there is no such tensioner; did you mean "tensioner"?"#),
        ("arm = ", "arm = \"tensioner\"\noffset = [1, 2]",
            "test.toml:25: pulley.tensioner pulley.offset: an offset belongs to a linear tensioner, and this arm is rotary; give `arm_length` and `arm_angle_offset`"),
        (r#"center = ["552"#, r#"arm = "x""#,
            r#"test.toml:17: pulley.crank.arm = "x": there is no such tensioner; the tensioners are tensioner"#),
        ("arm = ", r#"center = ["300 mm", "0 mm"]"#,
            r#"test.toml:37: tensioner.tensioner: the tensioner carries no pulley; give a pulley `arm = "tensioner"` in place of `center`"#),
        ("driver = true", "driver = true\nload = 1",
            "test.toml:22: pulley.crank.load: the driver has no load of its own: its torque follows from the others; remove it, or put it on the accessory that takes it"),
        ("driver = true", "driver = true\nmass = 1",
            "test.toml:22: pulley.crank.mass = 1: belongs to a pulley on a tensioner, and this one has a fixed centre; remove the key, or give `arm` in place of `center`"),
        ("driver = true", "driver = true\ncoupling = { kind = \"isolator\", accessory_inertia = 1, stiffness = 1 }",
            r#"test.toml:22: pulley.crank.coupling.kind = "isolator": a coupling is between a driven pulley and its accessory, and this pulley is the driver; remove it, and shake the pulley by [excitation]"#),
        ("load", "load = 1\ndriver = true",
            r#"test.toml:34: pulley.alternator.driver = true: both "crank" and "alternator" drive the belt; keep `driver = true` at one pulley; another one that pushes has a negative load"#),
        ("load", "load = { speed = [1], torque = [1], power = [1] }",
            "test.toml:33: pulley.alternator.load.power = [1]: the load is given both as torque and as power; keep one of the two"),
        (r#"name = "alternator""#, r#"name = "crank""#,
            r#"test.toml:29: pulley.2.name = "crank": the name is already taken; choose another name"#),
        (r#"name = "alternator""#, r#"name = "a.b""#,
            r#"test.toml:29: pulley.2.name = "a.b": a name must not contain dots, commas, equals signs or line breaks; use letters, digits, - and _"#),
        ("friction = { torque", "friction = { force = 1 }",
            "test.toml:46: tensioner.tensioner.friction.force = 1: the friction of a rotary tensioner is a torque; write `torque = …`"),
        ("friction = { torque", "friction = { torque = 1, loading = 1 }",
            "test.toml:46: tensioner.tensioner.friction.torque: the friction is given both for all directions and for one of them; keep `torque`, or keep `loading` and `unloading`"),
        ("motion", "motion = [{ order = 2, amplitude = 1 }]\ntorque = [{ order = 2, amplitude = 1 }]",
            "test.toml:53: excitation.torque: the motion of the driver is prescribed, so that no torque can change it; keep `motion` or `torque`"),
        ("motion", "motion = [{ order = 2, amplitude = 1 }, { order = 2, amplitude = 3 }]",
            "test.toml:52: excitation.motion.1.order = 2: the order is already given by excitation.motion.0; put both into one item"),
        ("motion", "",
            r#"test.toml:9: belt.damping.loss_factor = 0.05: a loss factor holds at one frequency, and there is no excitation at a speed above zero that would say which; add `reference_frequency = "100 Hz"` beside it"#),
    ]);
}

#[test]
fn a_drive_needs_two_pulleys_and_tables() {
    assert_eq!(
        message("kind = \"drive\"\n"),
        "test.toml:1: belt: the table is missing; add a table [belt] with model, stiffness and mass of the belt"
    );
    let text = format!(
        "{}[operating]\nspeed = 1\n",
        &DRIVE[..DRIVE.find("[[pulley]]").unwrap()]
    );
    assert_eq!(
        message(&text),
        "test.toml:1: pulley: a drive has at least two pulleys, and this one has 0; add a [[pulley]] for each, in the \
         order in which the belt meets them"
    );
    let text = format!("{text}[[pulley]]\nname = \"a\"\ncenter = [0, 0]\nradius = 1\ndriver = true\n");
    assert!(message(&text).contains("this one has 1"));
}

#[test]
fn what_the_linear_model_leaves_out_is_said() {
    let of = |scope: Scope, text: &str| -> Vec<String> {
        let (_, warnings) = read(text);
        let said = warnings.iter().filter(|warning| warning.scope == scope);
        said.map(ToString::to_string).collect()
    };
    let warnings = |text: &str| of(Scope::Model, text);
    let always = "test.toml:46: tensioner.tensioner.friction: the steady state and the linear model leave dry friction out";
    assert_eq!(
        of(Scope::LinearModel, DRIVE),
        [
            "test.toml:35: pulley.alternator.coupling.kind: the linear model has the clutch locked: a rigid shaft",
            always,
        ]
    );
    assert!(warnings(DRIVE).is_empty());
    assert_eq!(
        of(Scope::Motions, DRIVE),
        [
            "test.toml:47: tensioner.tensioner.stops: motions pass the stops; add `stop_contact` with `restitution` or `stiffness` for them to act"
        ]
    );
    let guarded = with_line(
        DRIVE,
        "stops = ",
        "stops = [\"-40 deg\", \"25 deg\"]\nstop_contact = { restitution = 0.3 }",
    );
    assert!(of(Scope::Motions, &guarded).is_empty());
    let one_way = with_line(DRIVE, "bearing_drag", "one_way_damping = 0.2");
    assert_eq!(
        of(Scope::LinearModel, &one_way)[2],
        "test.toml:48: tensioner.tensioner.one_way_damping: the steady state and the linear model leave damping in one direction out"
    );
    let engaged = with_line(
        DRIVE,
        "kind = \"one-way\"",
        "kind = \"decoupler\"\nstiffness = 20\npreload = 1",
    );
    assert_eq!(
        of(Scope::LinearModel, &engaged)[0],
        "test.toml:35: pulley.alternator.coupling.kind: the linear model has the clutch engaged: a spring and a damper"
    );
    let at_rest = with_line(DRIVE, "natural_length", "installation = { tension = \"300 N\" }");
    assert_eq!(
        warnings(&at_rest)[0],
        "test.toml:44: tensioner.tensioner.spring.preload: is not used: the preload follows from the tension of the \
         installation"
    );
    let without_friction = with_line(DRIVE, "friction = 1.0", "");
    assert_eq!(
        warnings(&without_friction)[0],
        "test.toml:2: belt.friction: is not given: the safety against slip is judged with an effective friction of 1"
    );
    let massless = with_line(DRIVE, "inertia = \"1.165e-3 kg m^2\"", "");
    assert!(warnings(&massless)[0].contains("the tensioner has no inertia"));
    let massless = DRIVE.replace(
        "contact = \"back\"\ninertia = \"2.93e-4 kg m^2\"",
        "contact = \"back\"",
    );
    assert!(
        warnings(&massless)[0]
            .starts_with("test.toml:22: pulley.tensioner pulley.inertia: the pulley has no inertia")
    );
}

#[test]
fn a_change_of_kind_compares_couplings() {
    let mut document = Document::parse("test.toml", DRIVE).unwrap();
    document
        .set("pulley.alternator.coupling.kind", "isolator")
        .unwrap();
    assert_eq!(
        document.model().unwrap_err().to_string(),
        "test.toml:34: pulley.alternator.coupling.stiffness: is missing: a coupling of kind \"isolator\" has a spring; \
         add a line such as `stiffness = \"20 N m/rad\"`"
    );
    document
        .set("pulley.alternator.coupling.stiffness", "20 N m/rad")
        .unwrap();
    document
        .set("pulley.alternator.coupling.damping", "0.05 N m s/rad")
        .unwrap();
    let keys = |document: &Document| -> Vec<String> {
        let (_, warnings) = document.model().unwrap();
        let of_file = warnings
            .into_iter()
            .filter(|warning| warning.scope != Scope::Motions);
        of_file.map(|warning| warning.key).collect()
    };
    assert_eq!(keys(&document), ["tensioner.tensioner.friction"]);
    document
        .set("pulley.alternator.coupling.kind", "one-way")
        .unwrap();
    assert_eq!(
        keys(&document),
        [
            "pulley.alternator.coupling.stiffness",
            "pulley.alternator.coupling.damping",
            "pulley.alternator.coupling.kind",
            "tensioner.tensioner.friction",
        ]
    );
}

#[test]
fn an_override_is_blamed_for_what_it_breaks() {
    let mut document = Document::parse("test.toml", DRIVE).unwrap();
    document.set("tensioner.tensioner.arm_angle", "30 deg").unwrap();
    assert_eq!(
        document.model().unwrap_err().to_string(),
        "--set tensioner.tensioner.arm_angle=30 deg: the reference position is beyond the stops; angles are \
         counter-clockwise from +x, as the stops; correct the reference position or the stops"
    );
}
