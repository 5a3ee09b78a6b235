//! Drives: what a file means for the mechanics.

use std::f64::consts::{PI, TAU};

use slackside_belt_drive::drive::{
    ArcStretch, BeltModel, Coupling, Drive, Excitation, Guide, Installation, Load, Mount, OrderTable, Sense,
    Speeds, StopContact, TensionerFriction,
};
use slackside_belt_drive::layout::Layout;
use slackside_belt_drive::steady::{Installed, SteadyState};
use slackside_model_file::{Document, Problem, Scope};

use crate::{DRIVE, example_drives, message, read, with_line};

fn drive(text: &str) -> Drive {
    read(text).0.drive().unwrap().belt_drive().unwrap()
}

#[track_caller]
fn assert_close(value: f64, expected: f64) {
    assert!(
        (value - expected).abs() <= 1e-14 * expected.abs(),
        "{value} instead of {expected}"
    );
}

#[test]
fn every_value_arrives_in_si() {
    let drive = drive(DRIVE);
    assert_eq!(drive.belt.model, BeltModel::Beam);
    assert_eq!(drive.belt.axial_stiffness, 170e3);
    assert_eq!(drive.belt.bending_stiffness, 0.015);
    assert_eq!(drive.belt.mass_per_length, 0.1029);
    assert_eq!(drive.belt.terms, [5, 5, 5]);
    assert_eq!(drive.belt.arc_stretch, ArcStretch::Mean);
    assert!(drive.belt.static_correction);
    let loss_factor = drive.belt.damping.loss_factor.unwrap();
    assert_eq!(loss_factor.value, 0.05);
    assert_close(loss_factor.reference_frequency, 2.0 * 2000.0 * PI / 30.0);
    assert_eq!(drive.installation, Installation::NaturalLength(1.5123));
    assert_eq!(drive.driver, 0);

    let [crank, idler, alternator] = drive.pulleys.as_slice() else {
        panic!("three pulleys");
    };
    let Mount::Fixed(center) = crank.mount else {
        panic!("fixed");
    };
    assert_close(center.x, 0.5525);
    assert_close(center.y, 0.0556);
    assert_eq!(crank.radius, 0.0889);
    assert_eq!(crank.friction, 1.0);
    let Mount::Carried { tensioner: 0, place } = idler.mount else {
        panic!("carried by the tensioner");
    };
    assert_close(place.x, 0.0971);
    assert_eq!(place.y, 0.0);
    assert!(idler.drag_reacts_on_arm && !crank.drag_reacts_on_arm);
    assert_eq!(alternator.load, Load::Torque(4.5));
    assert_eq!(
        alternator.coupling,
        Coupling::OneWay {
            accessory_inertia: 2.9e-3
        }
    );

    let tensioner = &drive.tensioners[0];
    let Guide::Rotary { pivot } = tensioner.guide else {
        panic!("rotary");
    };
    assert_close(pivot.x, 0.2508);
    assert_close(pivot.y, 0.0635);
    assert_close(tensioner.reference, -3.75 * PI / 180.0);
    assert_eq!(tensioner.spring_rate, 54.37);
    assert_eq!(tensioner.spring_preload, Some(19.9));
    assert_close(tensioner.stops.unwrap()[0], -40.0 * PI / 180.0);

    let (model, _) = read(DRIVE);
    let file = model.drive().unwrap();
    assert_close(file.operating_speed(), 2000.0 * PI / 30.0);
    let Excitation::Motion(orders) = file.excitation() else {
        panic!("motion");
    };
    assert_eq!(orders[0].order, 2.0);
    assert_close(orders[0].at(0.0).0, 0.57 * PI / 180.0);
    assert_eq!(file.conditions()[0].temperature_change, 80.0);
    assert_eq!(file.conditions()[0].spring_factor, 1.0);
    assert_eq!(model.kind(), "drive");
    assert_eq!(model.units().frequency, "Hz");
    assert_eq!(
        model.coordinates(),
        ["crank", "tensioner pulley", "alternator", "tensioner"]
    );
}

#[test]
fn a_drive_has_a_system_at_its_operating_speed() {
    let (model, _) = read(DRIVE);
    let system = model.system().unwrap();
    assert!(system.check().is_ok());
    let names: Vec<&str> = system.elements.iter().map(|element| &*element.name).collect();
    assert_eq!(names, ["coupling.alternator", "friction.tensioner"]);
    assert!(
        system
            .coordinates
            .contains(&"rotation.alternator.accessory".to_owned())
    );
    // Order 2 alone: the fundamental is twice the speed.
    assert_close(model.frequency().unwrap(), 2.0 * 2000.0 * PI / 30.0);
    let of = |line: &str| read(&with_line(DRIVE, "motion", line)).0;
    let orders = of("motion = [{ order = 0.5, amplitude = 0.001 }, { order = 2, amplitude = 0.01 }]");
    assert_close(orders.frequency().unwrap(), 0.5 * 2000.0 * PI / 30.0);
    let irrational =
        of("motion = [{ order = 1.234567, amplitude = 0.001 }, { order = 2, amplitude = 0.01 }]");
    assert_eq!(irrational.frequency(), None);
    assert_eq!(
        irrational.system().unwrap_err().to_string(),
        "excitation: the orders [1.234567, 2.0] of the excitation repeat together only after more than 24 revolutions of the \
         driver; round them to common fractions"
    );
}

#[test]
fn laws_of_tensioners_and_couplings_reach_the_mechanics() {
    let friction = |line: &str| {
        let drive = drive(&with_line(DRIVE, "friction = { torque", line));
        drive.tensioners[0].friction.clone().unwrap()
    };
    let coulomb = |loading, unloading, static_ratio| TensionerFriction::Coulomb {
        loading,
        unloading,
        static_ratio,
    };
    assert_eq!(
        friction("friction = { torque = \"2 N m\" }"),
        coulomb(2.0, 2.0, 1.0)
    );
    assert_eq!(
        friction("friction = { loading = 3, unloading = 2, static_ratio = 1.2 }"),
        coulomb(3.0, 2.0, 1.2)
    );
    assert_eq!(
        friction("friction = { law = \"spring-slider\", torque = 2, stiffness = \"5 N m/deg\" }"),
        TensionerFriction::SpringSlider {
            torque: 2.0,
            stiffness: 5.0 / (PI / 180.0)
        }
    );
    assert_eq!(
        friction("friction = { law = \"dahl\", torque = 2, stiffness = 300 }"),
        TensionerFriction::Dahl {
            torque: 2.0,
            stiffness: 300.0
        }
    );
    let bristles = "friction = { law = \"lugre\", torque = 2, static_ratio = 1.3, stribeck_velocity = \"0.1 rad/s\", stiffness = 300, \
                    damping = \"0.2 N m s/rad\", viscous = 0.05 }";
    assert_eq!(
        friction(bristles),
        TensionerFriction::LuGre {
            torque: 2.0,
            static_ratio: 1.3,
            stribeck_velocity: 0.1,
            stiffness: 300.0,
            damping: 0.2,
            viscous: 0.05
        }
    );
    let measured = "friction = { law = \"measured-loop\", loop = { position = [-0.3, 0.3], loading = [20, 16], unloading = [14, 10] } }";
    assert_eq!(
        friction(measured),
        TensionerFriction::MeasuredLoop {
            positions: vec![-0.3, 0.3],
            loading: vec![20.0, 16.0],
            unloading: vec![14.0, 10.0]
        }
    );
    let lines = "one_way_damping = 0.3\nstop_contact = { stiffness = \"1 kN m/rad\", damping = 0.5 }\n\
                 pulley_contact = [{ pulley = \"crank\", belt_thickness = \"4 mm\", restitution = 0.5 }]";
    let drive = drive(&with_line(DRIVE, "bearing_drag", lines));
    let tensioner = &drive.tensioners[0];
    assert_eq!(tensioner.one_way_damping, 0.3);
    assert_eq!(
        tensioner.stop_contact,
        Some(StopContact::Compliant {
            stiffness: 1000.0,
            damping: 0.5
        })
    );
    let contact = tensioner.pulley_contacts[0];
    assert_eq!((contact.carried, contact.other, contact.clearance), (1, 0, 4e-3));
    assert_eq!(contact.contact, StopContact::Rigid { restitution: 0.5 });
    let decoupler = "kind = \"decoupler\"\nstiffness = 20\npreload = 1\naccessory_damping = 0.01";
    let drive = self::drive(&with_line(DRIVE, "kind = \"one-way\"", decoupler));
    assert!(matches!(
        drive.pulleys[2].coupling,
        Coupling::Decoupler { preload: 1.0, .. }
    ));
    assert_eq!(drive.pulleys[2].accessory_damping, 0.01);
}

#[test]
fn the_sense_of_rotation_is_inferred_or_given() {
    let senses = |drive: Drive| -> Vec<Sense> { drive.pulleys.iter().map(|pulley| pulley.sense).collect() };
    let counter_clockwise = [Sense::CounterClockwise, Sense::Clockwise, Sense::CounterClockwise];
    assert_eq!(senses(drive(DRIVE)), counter_clockwise);
    // Seen from behind, the same pulleys are met clockwise.
    let mirrored = DRIVE
        .replace("\"552.5 mm\"", "\"-552.5 mm\"")
        .replace("\"250.8 mm\"", "\"-250.8 mm\"")
        .replace("\"-3.75 deg\"", "\"183.75 deg\"")
        .replace("[\"-40 deg\", \"25 deg\"]", "[\"155 deg\", \"220 deg\"]");
    let clockwise = counter_clockwise.map(Sense::reversed);
    assert_eq!(senses(drive(&mirrored)), clockwise);
    let given = |rotation: &str| {
        let speed = format!("speed = \"2000 rpm\"\nrotation = \"{rotation}\"");
        with_line(DRIVE, "speed", &speed)
    };
    assert_eq!(senses(drive(&given("counter-clockwise"))), counter_clockwise);
    assert_eq!(
        message(&given("clockwise")),
        "test.toml:51: operating.rotation: in this sense the belt does not meet the pulleys in the order of the file, in \
         the other it does; turn the sense, or list the pulleys in the opposite order"
    );
}

#[test]
fn a_driver_may_touch_the_back() {
    let text = DRIVE.replace("driver = true\n", "").replace(
        "contact = \"back\"\ninertia = \"2.93e-4 kg m^2\"",
        "contact = \"back\"\ninertia = \"2.93e-4 kg m^2\"\ndriver = true",
    );
    let drive = drive(&text);
    assert_eq!(drive.driver, 1);
    assert_eq!(drive.pulleys[1].sense, Sense::Clockwise);
    assert_eq!(drive.pulleys[0].sense, Sense::CounterClockwise);
}

#[test]
fn an_impossible_layout_names_the_pulleys() {
    let text = with_line(DRIVE, "center = [\"0", "center = [\"500 mm\", \"0 mm\"]");
    assert_eq!(
        message(&text),
        "test.toml:28: pulley.alternator: pulleys \"crank\" and \"alternator\" overlap: their centres are 76.5 mm apart, \
         their pitch radii add up to 115.9 mm; move one away or make it smaller"
    );
    let missed = with_line(DRIVE, "pivot", "pivot = [\"250.8 mm\", \"200 mm\"]");
    let message = message(&missed);
    assert!(
        message.starts_with(
            "test.toml:22: pulley.tensioner pulley: the belt does not touch \"tensioner pulley\""
        ),
        "{message}"
    );
    // A change by a program is examined when the drive is laid out.
    let moved = read(DRIVE)
        .0
        .with_number("pulley.alternator.center.0", 0.5)
        .unwrap();
    let error = moved.drive().unwrap().belt_drive().unwrap_err();
    assert_eq!(error.problem(), Problem::WrongValue);
    assert_eq!(error.key(), "pulley.alternator");
}

#[test]
fn diameters_become_pitch_radii() {
    let radius = |line: &str| {
        let text = with_line(DRIVE, "radius = \"26.97 mm\"", line);
        drive(&text).pulleys[2].radius
    };
    assert_close(radius("outside_diameter = \"52 mm\""), 0.0271);
    assert_close(radius("effective_diameter = \"52 mm\""), 0.0271);
    assert_close(
        radius("outside_diameter = \"52 mm\"\ncord_offset = \"0.8 mm\""),
        0.0268,
    );
    let back = with_line(DRIVE, "radius = \"45.2 mm\"", "outside_diameter = \"90 mm\"");
    let back = with_line(
        &back,
        "cord_offset_ribs",
        "cord_offset_ribs = 0.001\ncord_offset_back = \"1.4 mm\"",
    );
    assert_close(drive(&back).pulleys[1].radius, 0.0464);
}

#[test]
fn an_effective_length_is_measured_on_another_line() {
    let length = |line: &str| match drive(&with_line(DRIVE, "natural_length", line)).installation {
        Installation::NaturalLength(length) => length,
        other => panic!("{other:?}"),
    };
    let pitch = 1.505 + TAU * 0.0011;
    assert_close(length("effective_length = \"1505 mm\""), pitch);
    assert_close(
        length("effective_length = \"1505 mm\"\nmeasuring_tension = \"340 N\""),
        pitch / (1.0 + 340.0 / 170e3),
    );
}

#[test]
fn installations_take_the_preload_they_need() {
    let installed = |line: &str| drive(&with_line(DRIVE, "natural_length", line));
    let at_rest = installed("installation = { tension = \"300 N\" }");
    assert_eq!(at_rest.installation, Installation::Tension(300.0));
    assert_eq!(at_rest.tensioners[0].spring_preload, None);
    let operating = installed("installation = { operating_position = true }");
    let Installation::OperatingPosition { driver_speed } = operating.installation else {
        panic!("operating position");
    };
    assert_close(driver_speed, 2000.0 * PI / 30.0);
    assert_eq!(operating.tensioners[0].spring_preload, Some(19.9));
}

#[test]
fn friction_has_grooves_on_the_ribs_only() {
    let friction = |lines: &str| {
        let drive = drive(&with_line(DRIVE, "friction = 1.0", lines));
        [drive.pulleys[0].friction, drive.pulleys[1].friction]
    };
    assert_eq!(friction("friction = 1.2"), [1.2, 1.2]);
    assert_eq!(friction("friction = 1.2\nback_friction = 0.4"), [1.2, 0.4]);
    let grooved = "friction = { coefficient = 0.35, groove_angle = \"40 deg\" }";
    let wedged = 0.35 / 20.0_f64.to_radians().sin();
    assert_close(friction(grooved)[0], wedged);
    assert_eq!(friction(grooved)[1], 0.35);
    assert_eq!(friction(&format!("{grooved}\nback_friction = 0.3"))[1], 0.3);
    let own = with_line(
        DRIVE,
        "radius = \"88.9 mm\"",
        "radius = \"88.9 mm\"\nfriction = 0.9",
    );
    assert_eq!(drive(&own).pulleys[0].friction, 0.9);
}

#[test]
fn a_belt_may_be_described_per_rib() {
    let text = DRIVE
        .replace("axial_stiffness = \"170 kN\"\n", "ribs = 6\n")
        .replace(
            "bending_stiffness = \"0.015 N m^2\"\n",
            "per_rib = { axial_stiffness = \"30 kN\", bending_stiffness = 0.0025, mass_per_length = \"17 g/m\" }\n",
        )
        .replace("mass_per_length = \"0.1029 kg/m\"\n", "");
    let belt = drive(&text).belt;
    assert_close(belt.axial_stiffness, 180e3);
    assert_close(belt.bending_stiffness, 0.015);
    assert_close(belt.mass_per_length, 0.102);
    let mut document = Document::parse("test.toml", &text).unwrap();
    document.set("belt.ribs", "7").unwrap();
    let (model, _) = document.model().unwrap();
    assert_close(
        model.drive().unwrap().belt_drive().unwrap().belt.axial_stiffness,
        210e3,
    );
    assert_eq!(model.number("belt.per_rib.axial_stiffness").unwrap(), 30e3);
}

#[test]
fn loads_are_torques_or_powers() {
    let load = |value: &str| {
        let text = with_line(DRIVE, "load", &format!("load = {value}"));
        drive(&text).pulleys[2].load.clone()
    };
    assert_eq!(load("6"), Load::Torque(6.0));
    assert_eq!(load("\"6 N m\""), Load::Torque(6.0));
    assert_eq!(load("\"1.2 kW\""), Load::Power(1200.0));
    assert_eq!(load("{ power = \"1.2 kW\" }"), Load::Power(1200.0));
    let at = |load: &Load, driver, pulley| load.torque(&Speeds { driver, pulley });
    let torque = load("{ speed = [100, 200], torque = [2, \"4 N m\"] }");
    assert_close(at(&torque, 0.0, 150.0), 3.0);
    let power = load("{ speed = [100, 200], power = [\"300 W\", 900], over = \"driver\" }");
    assert_close(at(&power, 150.0, 300.0), 2.0);
}

#[test]
fn linear_tensioners_move_along_a_line() {
    let start = DRIVE.find("[[tensioner]]").unwrap();
    let end = DRIVE.find("[operating]").unwrap();
    let slide = |direction: &str| {
        format!(
            "{}[[tensioner]]\nname = \"tensioner\"\nkind = \"linear\"\npoint = [\"347.7 mm\", \"57 mm\"]\n\
             direction = {direction}\nposition = \"1 mm\"\nmass = \"0.3 kg\"\n\
             spring = {{ rate = \"5 N/mm\", preload = \"200 N\" }}\ndamping = \"5 N s/m\"\n\
             friction = {{ loading = \"10 N\", unloading = \"20 N\" }}\nstops = [\"-10 mm\", \"10 mm\"]\n{}",
            &DRIVE[..start],
            &DRIVE[end..]
        )
    };
    for direction in ["\"90 deg\"", "[0, 2.5]"] {
        let drive = drive(&slide(direction));
        let tensioner = &drive.tensioners[0];
        let Guide::Linear { direction } = tensioner.guide else {
            panic!("linear");
        };
        assert!((direction - glam::DVec2::Y).length() < 1e-15);
        assert_eq!(tensioner.reference, 0.001);
        assert_eq!(tensioner.spring_rate, 5000.0);
        assert_eq!(tensioner.inertia, 0.3);
        let Mount::Carried { place, .. } = drive.pulleys[1].mount else {
            panic!("carried");
        };
        assert_eq!(place.to_array(), [0.3477, 0.057]);
    }
}

#[test]
fn a_second_pulley_of_an_arm_has_its_own_place() {
    let second = "[[pulley]]\nname = \"second\"\narm = \"tensioner\"\narm_length = \"98.5 mm\"\n\
                  arm_angle_offset = \"-86.25 deg\"\nradius = \"10 mm\"\ncontact = \"back\"\ninertia = 1e-4\n";
    let text = DRIVE.replace("[[tensioner]]", &format!("{second}[[tensioner]]"));
    let drive = drive(&text);
    let Mount::Carried { tensioner: 0, place } = drive.pulleys[3].mount else {
        panic!("carried");
    };
    let [centre, ..] = drive.tensioners[0]
        .guide
        .centre(place, drive.tensioners[0].reference);
    assert!((centre - glam::DVec2::new(0.2508, -0.035)).length() < 1e-15);
}

#[test]
fn excitation_may_be_a_table_over_speed() {
    let line = "motion = [{ order = 1.5, speed = [\"1000 rpm\", \"2000 rpm\"], amplitude = [\"1 deg\", \"0.5 deg\"] }, \
                { order = 3, amplitude = 0.001, phase = \"90 deg\" }]";
    let (model, _) = read(&with_line(DRIVE, "motion", line));
    let excitation = model.drive().unwrap().excitation();
    let [table, constant] = excitation.orders() else {
        panic!("two orders");
    };
    assert_close(table.at(50.0 * PI).0, 0.75 * PI / 180.0);
    assert!(matches!(constant.table, OrderTable::Constant { phase, .. } if phase == PI / 2.0));
    let line = "torque = [{ order = 2, amplitude = \"20 N m\" }]";
    let (model, _) = read(&with_line(DRIVE, "motion", line));
    assert!(
        matches!(model.drive().unwrap().excitation(), Excitation::Torque(orders) if orders[0].at(0.0).0 == 20.0)
    );
    let (model, _) = read(&with_line(
        &with_line(DRIVE, "motion", ""),
        "damping = { loss",
        "damping = { loss_factor = 0.05, reference_frequency = \"100 Hz\" }",
    ));
    assert_eq!(model.drive().unwrap().excitation(), Excitation::None);
}

#[test]
fn every_form_of_damping_arrives() {
    let line = "damping = { span_dashpot = 1, external = 2, drag = 3, internal_bending = 4, rayleigh = { mass = 5, \
                stiffness = 6 }, modal = [0.01, \"2 %\"] }";
    let damping = drive(&with_line(DRIVE, "damping = { loss", line)).belt.damping;
    assert_eq!(
        [
            damping.span_dashpot,
            damping.external,
            damping.drag,
            damping.internal_bending,
            damping.rayleigh_mass,
            damping.rayleigh_stiffness,
        ],
        [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    );
    assert_eq!(damping.modal.unwrap().ratio(7), 0.02);
    assert_eq!(damping.loss_factor, None);
}

#[test]
fn overrides_reach_items_by_name() {
    let mut document = Document::parse("test.toml", DRIVE).unwrap();
    document.set("pulley.alternator.load", "6 N m").unwrap();
    document
        .set("tensioner.tensioner.spring.rate", "60 N m/rad")
        .unwrap();
    document.set("pulley.tensioner pulley.radius", "45 mm").unwrap();
    document.set("belt.model", "string").unwrap();
    document.set("condition.hot.elongation", "0.1 %").unwrap();
    let (model, _) = document.model().unwrap();
    assert_eq!(model.number("pulley.alternator.load").unwrap(), 6.0);
    assert_eq!(model.number("pulley.2.load").unwrap(), 6.0);
    assert_eq!(model.number("tensioner.tensioner.spring.rate").unwrap(), 60.0);
    assert_eq!(model.number("condition.hot.elongation").unwrap(), 0.001);
    let error = document.set("pulley.alternater.load", "6 N m").unwrap_err();
    assert_eq!(
        error.to_string(),
        "--set pulley.alternater.load=6 N m: pulley has no item \"alternater\"; did you mean \"alternator\"?"
    );
}

#[test]
fn examples_are_drives_without_warnings_that_a_belt_can_follow() {
    for (name, text) in example_drives() {
        let (model, warnings) = Document::parse(&name, &text).unwrap().model().unwrap();
        let surprises: Vec<_> = warnings
            .iter()
            .filter(|warning| warning.scope == Scope::Model)
            .collect();
        assert!(surprises.is_empty(), "{name}: {surprises:?}");
        assert!(model.name().is_some(), "{name}");
        let drive = model.drive().unwrap().belt_drive().unwrap();
        let layout = Layout::new(&drive, &drive.reference_positions()).unwrap();
        layout.check(&drive).unwrap();
        let found = model.drive().unwrap().drive_system().unwrap();
        found.system.check().unwrap();
        assert!(
            found.effective_tensions.iter().all(|tension| *tension > 0.0),
            "{name}"
        );
        let mut lines = text.lines();
        assert!(lines.next().unwrap().ends_with('.'), "{name}");
        let command = lines.next().unwrap();
        assert!(command.starts_with("# slackside "), "{name}");
        assert!(command.contains(&format!(" examples/drives/{name}")), "{name}");
    }
}

#[test]
fn examples_run_without_slip_in_every_condition() {
    for (name, text) in example_drives() {
        let (model, _) = Document::parse(&name, &text).unwrap().model().unwrap();
        let file = model.drive().unwrap();
        let nominal = file.belt_drive().unwrap();
        let installed = Installed::new(&nominal).unwrap();
        let mut cases = vec![(nominal.clone(), installed.clone())];
        for condition in file.conditions() {
            cases.push(installed.in_condition(&nominal, &condition));
        }
        for (drive, installed) in cases {
            for speed in [0.35, 1.0, 2.5] {
                let steady = SteadyState::solve(&drive, &installed, speed * file.operating_speed()).unwrap();
                for pulley in 0..drive.pulleys.len() {
                    let safety = steady.slip_safety(&drive, pulley);
                    assert!(
                        safety > 1.3,
                        "{name} {speed} {}: {safety}",
                        drive.pulleys[pulley].name
                    );
                }
            }
        }
    }
}

#[test]
fn the_prototype_has_the_belt_of_its_reference() {
    let text = example_drives()
        .into_iter()
        .find(|(name, _)| name == "three-pulley.toml")
        .unwrap()
        .1;
    let installed = Installed::new(&drive(&text)).unwrap();
    // validation/reference/drive_three_pulley.json, EI = 0.015: natural length and spring torque at the reference.
    assert!((installed.natural_length - 1.5125678669779385).abs() < 1e-12);
    assert!((installed.spring_torques[0] + 20.148570833079624).abs() < 1e-10);
}
