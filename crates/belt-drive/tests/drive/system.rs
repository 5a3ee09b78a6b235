//! Drives as mechanical systems: with every coupling engaged they answer as the linear model does, whatever excites them;
//! the steady state is an equilibrium; elements stand where the drive has them.

use crate::drives::{Case, close, config, running};
use proptest::prelude::*;
use slackside_belt_drive::drive::{
    BeltDamping, Coupling, Drive, Excitation, Flexible, Load, LossFactor, ModalDamping, OrderAmplitude,
    OrderTable, PulleyContact, StopContact, TensionerFriction,
};
use slackside_belt_drive::forced_response::{HarmonicLoad, forced_response};
use slackside_belt_drive::layout::Layout;
use slackside_belt_drive::model::{LinearModel, Motion};
use slackside_belt_drive::steady::{Installed, SteadyState};
use slackside_belt_drive::system::{DriveSpeedFamily, DriveSystem, DriveSystemError};
use slackside_linalg::{Complex, Matrix, is_positive_definite};
use slackside_mechanics::{Output, System, SystemFamily};

/// Which of the couplings a pulley gets, by number.
fn coupling(kind: usize) -> Coupling {
    let spring = Flexible {
        accessory_inertia: 3e-3,
        stiffness: 40.0,
        damping: 0.03,
    };
    match kind {
        0 => Coupling::Rigid {
            accessory_inertia: 3e-3,
        },
        1 => Coupling::OneWay {
            accessory_inertia: 3e-3,
        },
        2 => Coupling::WrapSpring(spring),
        3 => Coupling::Isolator(spring),
        _ => Coupling::Decoupler { spring, preload: 0.0 },
    }
}

/// The drive of a case with couplings at its driven pulleys.
fn coupled(case: &Case, kinds: &[usize], damping: BeltDamping, bearing: f64) -> Drive {
    let mut drive = case.drive.clone();
    drive.belt.damping = damping;
    let driver = drive.driver;
    for (j, pulley) in drive.pulleys.iter_mut().enumerate() {
        pulley.bearing_damping = bearing;
        if j != driver {
            pulley.coupling = coupling(kinds[j % kinds.len()]);
            pulley.accessory_damping = bearing;
            if let Load::Torque(torque) = &mut pulley.load {
                *torque += 0.05;
            }
        }
    }
    for tensioner in &mut drive.tensioners {
        tensioner.damping = 0.4;
    }
    drive
}

fn belt_damping() -> BeltDamping {
    BeltDamping {
        span_dashpot: 20.0,
        loss_factor: Some(LossFactor {
            value: 0.04,
            reference_frequency: 500.0,
        }),
        external: 0.4,
        drag: 0.1,
        ..BeltDamping::default()
    }
}

fn order(order: f64, amplitude: f64, phase: f64) -> OrderAmplitude {
    OrderAmplitude {
        order,
        table: OrderTable::Constant { amplitude, phase },
    }
}

fn steady(drive: &Drive, speed: f64) -> Option<SteadyState> {
    SteadyState::solve(drive, &Installed::new(drive).ok()?, speed).ok()
}

/// Harmonic motion with every element engaged: locked where it locks, otherwise a spring and damper.
struct Engaged {
    omega: f64,
    order: usize,
    coordinates: Vec<Complex>,
    forces: Vec<Complex>,
}

impl Engaged {
    fn new(found: &DriveSystem, order: usize) -> Option<Self> {
        let system = &found.system;
        let (n, omega) = (system.order(), order as f64 * found.frequency);
        let mut dynamic = system.dynamic_stiffness(omega, found.frequency);
        // A lock is a multiplier of its own.
        let locks: Vec<usize> = (0..system.elements.len())
            .filter(|e| system.elements[*e].law.locks())
            .collect();
        let size = n + locks.len();
        let mut matrix = slackside_linalg::ComplexMatrix::zeros(size, size);
        let slopes: Vec<Complex> = system
            .elements
            .iter()
            .map(|element| {
                // All laws at hand have their engaged slopes just beyond rest.
                let at = element.law.response(1.0, 0.0);
                let (spring, damper) = element.law.linearized();
                let stiffness = if spring > 0.0 { spring } else { at.by_displacement };
                let damping = if damper > 0.0 { damper } else { at.by_velocity };
                Complex::new(stiffness, omega * damping)
            })
            .collect();
        for (e, element) in system.elements.iter().enumerate() {
            if locks.contains(&e) {
                continue;
            }
            for (i, a) in element.port.terms() {
                for (j, b) in element.port.terms() {
                    dynamic[(*i, *j)] += slopes[e] * *a * *b;
                }
            }
        }
        for i in 0..n {
            for j in 0..n {
                matrix[(i, j)] = dynamic[(i, j)];
            }
        }
        for (k, e) in locks.iter().enumerate() {
            for (i, factor) in system.elements[*e].port.terms() {
                matrix[(*i, n + k)] += *factor;
                matrix[(n + k, *i)] += *factor;
            }
        }
        let mut load = vec![Complex::ZERO; size];
        let harmonic = system.forcing.harmonics.iter().find(|h| h.order == order)?;
        for (i, value) in load.iter_mut().take(n).enumerate() {
            *value = Complex::new(harmonic.cosine[i], -harmonic.sine[i]);
        }
        let solution = matrix.lu().ok()?.solve(&load);
        let forces = system
            .elements
            .iter()
            .enumerate()
            .map(|(e, element)| match locks.iter().position(|lock| *lock == e) {
                Some(k) => solution[n + k],
                None => element
                    .port
                    .terms()
                    .iter()
                    .map(|(i, factor)| slopes[e] * solution[*i] * *factor)
                    .sum(),
            })
            .collect();
        Some(Self {
            omega,
            order,
            coordinates: solution[..n].to_vec(),
            forces,
        })
    }

    fn read(&self, output: &Output) -> Complex {
        let sum = |terms: &[(usize, f64)], values: &[Complex]| -> Complex {
            terms.iter().map(|(index, factor)| values[*index] * *factor).sum()
        };
        let prescribed: Complex = output
            .harmonics
            .iter()
            .filter(|(order, _, _)| *order == self.order)
            .map(|(_, cosine, sine)| Complex::new(*cosine, -sine))
            .sum();
        sum(&output.displacement, &self.coordinates)
            + Complex::new(0.0, self.omega) * sum(&output.velocity, &self.coordinates)
            + sum(&output.force, &self.forces)
            + prescribed
    }
}

fn output<'a>(system: &'a System, name: &str) -> &'a Output {
    let index = system.output_index(name);
    &system.outputs[index.unwrap_or_else(|| panic!("no measure {name}"))]
}

/// All measures of the engaged system against those of the linear model.
fn same_measures(
    drive: &Drive,
    steady: &SteadyState,
    excitation: &Excitation,
    tolerance: f64,
) -> Result<(), TestCaseError> {
    let found = DriveSystem::new(drive, steady, excitation).unwrap();
    prop_assert!(found.system.check().is_ok());
    prop_assert_eq!(found.measures.len(), found.system.outputs.len());
    let model = LinearModel::new(drive, steady);
    for item in excitation.orders() {
        let omega = item.order * steady.driver_speed;
        let (amplitude, phase) = item.at(steady.driver_speed);
        let amplitude = Complex::from_polar(amplitude, phase);
        let load = match excitation {
            Excitation::Torque(_) => HarmonicLoad::DriverTorque(amplitude),
            _ => HarmonicLoad::DriverRotation(amplitude),
        };
        let Ok(linear) = forced_response(drive, &model, omega, load) else {
            return Ok(());
        };
        let number = (omega / found.frequency).round() as usize;
        let Some(engaged) = Engaged::new(&found, number) else {
            return Ok(());
        };
        let velocity_scale = linear.amplitudes.iter().map(|a| a.norm()).fold(0.0, f64::max) * omega;
        let same = |name: &str, expected: Complex, scale: f64| {
            let value = engaged.read(output(&found.system, name));
            prop_assert!(
                (value - expected).norm() <= tolerance * scale.max(1e-12),
                "{name}: {value} instead of {expected}, scale {scale}"
            );
            Ok(())
        };
        for (index, coordinate) in model.coordinates.iter().enumerate() {
            let name = model.coordinates.name(drive, index);
            if !matches!(coordinate, slackside_belt_drive::model::Coordinate::Sine { .. }) {
                let rate = Complex::new(0.0, omega) * linear.amplitudes[index];
                same(&format!("{name}.rate"), rate, 10.0 * velocity_scale)?;
            }
        }
        let stiffest = |i: usize| {
            let row = model.stretch.row(i);
            let reach: f64 = row
                .iter()
                .zip(&linear.amplitudes)
                .map(|(a, b)| a.abs() * b.norm())
                .sum();
            model.span_stiffness[i] * reach + omega * model.span_dashpots[i] * reach
        };
        let pull: f64 = (0..drive.pulleys.len()).map(stiffest).fold(0.0, f64::max);
        for i in 0..drive.pulleys.len() {
            let name = drive.span_name(i);
            same(
                &format!("tension.{name}"),
                model.dynamic_tension(&linear, i),
                10.0 * pull,
            )?;
            if !model.coordinates.sines(i).is_empty() {
                let motion = model.span_motion(steady, &linear, i);
                let middle = motion.at(0.5 * steady.layout.spans[i].length);
                same(&format!("deflection.{name}"), middle, velocity_scale / omega)?;
            }
        }
        for (j, pulley) in drive.pulleys.iter().enumerate() {
            let [x, y] = model.dynamic_hub_load(drive, steady, &linear, j);
            // Forces of inertia of spans may be larger than what they do on the hub.
            let scale = 100.0 * pull + forces_of_inertia(&model, &linear);
            same(&format!("hub_load.{}.x", pulley.name), x, scale)?;
            same(&format!("hub_load.{}.y", pulley.name), y, scale)?;
        }
        for average in &found.span_averages {
            let sum: f64 = average.rows.iter().map(|row| engaged.read(row).norm_sqr()).sum();
            let span = (0..drive.pulleys.len())
                .find(|i| drive.span_name(*i) == average.span)
                .unwrap();
            let expected = model.span_motion(steady, &linear, span).mean_amplitude();
            prop_assert!((sum.sqrt() - expected).abs() <= 1e-8 * velocity_scale / omega);
        }
    }
    Ok(())
}

fn forces_of_inertia(model: &LinearModel, motion: &Motion) -> f64 {
    let squared = motion.frequency * motion.frequency;
    let largest = motion.amplitudes.iter().map(|a| a.norm()).fold(0.0, f64::max);
    let heaviest = model
        .spans
        .iter()
        .map(|span| span.mass.max_abs().max(span.stiffness.max_abs() / squared))
        .fold(0.0, f64::max);
    squared * heaviest * largest
}

fn stable(drive: &Drive, steady: &SteadyState) -> bool {
    let model = LinearModel::new(drive, steady);
    is_positive_definite(&model.stiffness.selected(&model.free_coordinates(drive, false)))
}

proptest! {
    #![proptest_config(config(32))]

    /// With every coupling engaged, the driver's motion prescribed.
    #[test]
    fn engaged_couplings_answer_as_the_linear_model(
        case in running(),
        kinds in proptest::collection::vec(0_usize..5, 3),
        speed in 60.0..300.0_f64,
        rayleigh in any::<bool>(),
    ) {
        let damping = BeltDamping {
            rayleigh_mass: if rayleigh { 2.0 } else { 0.0 },
            rayleigh_stiffness: if rayleigh { 1e-5 } else { 0.0 },
            ..belt_damping()
        };
        let drive = coupled(&case, &kinds, damping, 1e-3);
        let steady = steady(&drive, speed);
        prop_assume!(steady.as_ref().is_some_and(|steady| stable(&drive, steady)));
        let excitation = Excitation::Motion(vec![order(2.0, 0.01, 0.3), order(3.0, 0.004, 1.0)]);
        same_measures(&drive, &steady.unwrap(), &excitation, 1e-10)?;
    }

    /// The driver free under torque, its rotation with the belt damped by bearings or not at all.
    #[test]
    fn a_free_driver_answers_as_the_linear_model(
        case in running(),
        kinds in proptest::collection::vec(0_usize..5, 3),
        speed in 60.0..300.0_f64,
        is_damped in any::<bool>(),
    ) {
        let drive = coupled(&case, &kinds, belt_damping(), if is_damped { 1e-2 } else { 0.0 });
        let steady = steady(&drive, speed);
        prop_assume!(steady.as_ref().is_some_and(|steady| stable(&drive, steady)));
        let excitation = Excitation::Torque(vec![order(1.5, 3.0, 0.3), order(3.0, 1.0, 1.0)]);
        let steady = steady.unwrap();
        let found = DriveSystem::new(&drive, &steady, &excitation).unwrap();
        let driver = format!("rotation.{}", drive.pulleys[drive.driver].name);
        prop_assert_eq!(found.system.coordinates.contains(&driver), is_damped);
        if let Some(cyclic) = found.system.coordinates.iter().position(|name| *name == driver) {
            prop_assert!((0..found.system.order()).all(|k| found.system.stiffness[(cyclic, k)] == 0.0));
        }
        same_measures(&drive, &steady, &excitation, 1e-10)?;
    }

    /// Modal damping is that of the drive with its couplings engaged.
    #[test]
    fn modal_damping_answers_as_the_linear_model(case in running(), kinds in proptest::collection::vec(0_usize..2, 3)) {
        let damping = BeltDamping { modal: Some(ModalDamping::Common(0.02)), ..BeltDamping::default() };
        let drive = coupled(&case, &kinds, damping, 0.0);
        let steady = steady(&drive, 150.0);
        prop_assume!(steady.as_ref().is_some_and(|steady| stable(&drive, steady)));
        let steady = steady.unwrap();
        same_measures(&drive, &steady, &Excitation::Motion(vec![order(2.0, 0.01, 0.3)]), 1e-10)?;
        // Rounding gives the rotation of the whole drive a frequency, and the linear model damps it.
        same_measures(&drive, &steady, &Excitation::Torque(vec![order(2.0, 3.0, 0.3)]), 1e-8)?;
    }

    /// Pulley and accessory merged have the mass matrix of the linear model.
    #[test]
    fn merged_accessories_have_the_mass_of_the_linear_model(case in running()) {
        let drive = coupled(&case, &[1], BeltDamping::default(), 0.0);
        let steady = steady(&drive, case.speed.max(20.0));
        prop_assume!(steady.is_some());
        let steady = steady.unwrap();
        let found = DriveSystem::new(&drive, &steady, &Excitation::None).unwrap();
        let model = LinearModel::new(&drive, &steady);
        let free = model.free_coordinates(&drive, false);
        let names: Vec<String> = free.iter().map(|index| model.coordinates.name(&drive, *index)).collect();
        let column = |name: &str| names.iter().position(|known| known == name.trim_end_matches(".accessory")).unwrap();
        let places: Vec<usize> = found.system.coordinates.iter().map(|name| column(name)).collect();
        let mut merged = Matrix::zeros(free.len(), free.len());
        for (i, row) in places.iter().enumerate() {
            for (j, to) in places.iter().enumerate() {
                merged[(*row, *to)] += found.system.mass[(i, j)];
            }
        }
        let mut difference = model.mass.selected(&free);
        difference.add_scaled(-1.0, &merged);
        prop_assert!(difference.max_abs() <= 1e-15 * merged.max_abs());
        // An accessory behind an open clutch is held by nothing.
        for (i, name) in found.system.coordinates.iter().enumerate().filter(|(_, name)| name.ends_with(".accessory")) {
            prop_assert!((0..found.system.order()).all(|k| found.system.stiffness[(i, k)] == 0.0), "{}", name);
        }
    }

    /// At rest in the steady state: no coordinate moves, every coupling carries its load.
    #[test]
    fn the_steady_state_is_an_equilibrium(case in running(), kinds in proptest::collection::vec(0_usize..5, 3)) {
        let drive = coupled(&case, &kinds, BeltDamping::default(), 0.0);
        let steady = steady(&drive, case.speed.max(20.0));
        prop_assume!(steady.is_some());
        let steady = steady.unwrap();
        let found = DriveSystem::new(&drive, &steady, &Excitation::None).unwrap();
        let system = &found.system;
        let mut residual = system.stiffness.times(&found.rest);
        for (value, load) in residual.iter_mut().zip(&system.forcing.constant) {
            *value -= load;
        }
        for element in &system.elements {
            let pulley = element.name.trim_start_matches("coupling.");
            let load = steady.loads[drive.pulleys.iter().position(|p| p.name == pulley).unwrap()];
            let response = element.law.response(element.port.project(&found.rest), 0.0);
            // The spring of a decoupler and the lock of a clutch have the load as their force.
            let force = if element.law.kind() == "wrap-spring" || element.law.kind() == "stop" { response.force } else { load };
            close(force, load, 1e-12, 0.0, "force of the coupling");
            for (i, factor) in element.port.terms() {
                residual[*i] += factor * load;
            }
        }
        prop_assert!(residual.iter().all(|value| value.abs() <= 1e-12), "{:?}", residual);
    }

    /// Loading shortens the path of the belt, and the spring resists it.
    #[test]
    fn friction_is_positive_while_the_belt_pushes_the_tensioner_back(case in running()) {
        let mut drive = case.drive.clone();
        for tensioner in &mut drive.tensioners {
            tensioner.friction = Some(TensionerFriction::Coulomb { loading: 3.0, unloading: 2.0, static_ratio: 1.0 });
            tensioner.one_way_damping = 0.7;
        }
        let Some(steady) = steady(&drive, case.speed.max(20.0)) else { return Ok(()); };
        let found = DriveSystem::new(&drive, &steady, &Excitation::None).unwrap();
        for arm in case.free_arms() {
            let name = &drive.tensioners[arm].name;
            let element = |role: &str| {
                let name = format!("{role}.{name}");
                found.system.elements.iter().find(|element| element.name == name).unwrap()
            };
            let sense = element("friction").port.terms()[0].1;
            let mut positions = steady.positions.clone();
            positions[arm] += 1e-4 * sense;
            let moved = Layout::new(&drive, &positions).unwrap();
            prop_assert!(moved.pitch_length < steady.layout.pitch_length);
            prop_assert_eq!(element("friction").law.response(0.0, 1.0).force, 3.0);
            prop_assert_eq!(element("friction").law.response(0.0, -1.0).force, -2.0);
            prop_assert_eq!(element("damper").law.response(0.0, 1.0).force, 0.7);
            prop_assert_eq!(element("damper").law.response(0.0, -1.0).force, 0.0);
            // Measured along the coordinate, friction is against the motion.
            let torque = output(&found.system, &format!("friction_torque.{name}"));
            prop_assert_eq!(torque.force[0].1, sense);
        }
    }
}

fn three_pulley() -> (Drive, SteadyState) {
    let mut drive = slackside_belt_drive::prototypes::three_pulley(0.015);
    drive.tensioners[0].damping = 0.05;
    let steady = steady(&drive, 200.0).unwrap();
    (drive, steady)
}

fn force(found: &DriveSystem, name: &str, displacement: f64) -> f64 {
    let element = found
        .system
        .elements
        .iter()
        .find(|element| element.name == name)
        .unwrap();
    let (_, factor) = element.port.terms()[0];
    element.law.response(factor * displacement, 0.0).force * factor
}

#[test]
fn stops_stand_where_the_file_has_them() {
    let (mut drive, before) = three_pulley();
    let position = before.positions[0];
    drive.tensioners[0].stops = Some([position - 0.02, position + 0.05]);
    drive.tensioners[0].stop_contact = Some(StopContact::Compliant {
        stiffness: 1e4,
        damping: 0.0,
    });
    let steady = steady(&drive, 200.0).unwrap();
    let found = DriveSystem::new(&drive, &steady, &Excitation::None).unwrap();
    for (name, at, expected) in [
        ("lower_stop.tensioner", -0.019, 0.0),
        ("lower_stop.tensioner", -0.021, -10.0),
        ("upper_stop.tensioner", 0.049, 0.0),
        ("upper_stop.tensioner", 0.051, 10.0),
    ] {
        close(force(&found, name, at), expected, 1e-9, 1e-9, name);
    }
    let torque = output(&found.system, "stop_torque.tensioner");
    assert_eq!(torque.force, [(0, -1.0), (1, 1.0)]);
    drive.tensioners[0].stop_contact = Some(StopContact::Rigid { restitution: 0.4 });
    let found = DriveSystem::new(&drive, &steady, &Excitation::None).unwrap();
    assert!(found.system.elements.iter().all(|element| {
        element
            .law
            .regimes()
            .is_some_and(|table| table.regimes.len() == 2)
    }));
}

#[test]
fn a_pulley_on_the_arm_touches_another_where_the_gap_closes() {
    let (mut drive, steady) = three_pulley();
    drive.tensioners[0].pulley_contacts = vec![PulleyContact {
        carried: 1,
        other: 0,
        clearance: 0.004,
        contact: StopContact::Compliant {
            stiffness: 1e6,
            damping: 0.0,
        },
    }];
    let found = DriveSystem::new(&drive, &steady, &Excitation::None).unwrap();
    let element = &found.system.elements[0];
    assert_eq!(element.name, "contact.tensioner.crank");
    let gap = |position: f64| {
        let layout = Layout::new(&drive, &[position]).unwrap();
        let radii = drive.pulleys[0].radius + drive.pulleys[1].radius;
        (layout.centres[1] - layout.centres[0]).length() - radii - 0.004
    };
    let here = steady.positions[0];
    let slope = (gap(here + 1e-6) - gap(here - 1e-6)) / 2e-6;
    close(
        element.port.terms()[0].1,
        -slope,
        1e-8,
        0.0,
        "approach of the pulleys",
    );
    // In contact one millimetre beyond the gap.
    let pressed = element.law.response(gap(here) + 1e-3, 0.0).force;
    close(pressed, 1e3, 1e-8, 0.0, "force");
    assert_eq!(element.law.response(gap(here) - 1e-3, 0.0).force, 0.0);
    drive.tensioners[0].pulley_contacts[0].clearance = 1.0;
    assert!(matches!(
        DriveSystem::new(&drive, &steady, &Excitation::None),
        Err(DriveSystemError::Touching { .. })
    ));
}

/// A loop that is the spring line with 2 N·m of friction either way is Coulomb friction.
#[test]
fn a_measured_loop_about_the_spring_line_is_dry_friction() {
    let (mut drive, steady) = three_pulley();
    let sense = -steady.kinematics.take_up[0].signum();
    let position = steady.positions[0];
    let positions = vec![position - 0.3, position, position + 0.3];
    let line: Vec<f64> = positions
        .iter()
        .map(|at| -sense * (steady.spring_torques[0] - drive.tensioners[0].spring_rate * (at - position)))
        .collect();
    assert!(
        line.iter().all(|torque| *torque > 0.0),
        "the spring tightens the belt"
    );
    drive.tensioners[0].friction = Some(TensionerFriction::MeasuredLoop {
        positions,
        loading: line.iter().map(|torque| torque + 2.0).collect(),
        unloading: line.iter().map(|torque| torque - 2.0).collect(),
    });
    let found = DriveSystem::new(&drive, &steady, &Excitation::None).unwrap();
    let element = &found.system.elements[0];
    assert_eq!(element.port.terms()[0].1, sense);
    for u in [-0.25, -0.01, 0.0, 0.2] {
        close(element.law.response(u, 1.0).force, 2.0, 1e-12, 0.0, "loading");
        close(element.law.response(u, -1.0).force, -2.0, 1e-12, 0.0, "unloading");
    }
}

#[test]
fn what_has_no_motion_is_refused() {
    let (mut drive, steady) = three_pulley();
    let one_way = Coupling::OneWay {
        accessory_inertia: 2e-3,
    };
    drive.pulleys[2].coupling = one_way;
    let build = |drive: &Drive, steady: &SteadyState| DriveSystem::new(drive, steady, &Excitation::None);
    let mut unloaded = steady.clone();
    unloaded.loads[2] = 0.0;
    assert!(matches!(
        build(&drive, &unloaded),
        Err(DriveSystemError::LoadOpensCoupling { load: 0.0, .. })
    ));
    drive.pulleys[2].accessory_damping = 1e-4;
    assert!(build(&drive, &unloaded).is_ok());
    unloaded.loads[2] = -1.0;
    assert!(matches!(
        build(&drive, &unloaded),
        Err(DriveSystemError::LoadOpensCoupling { .. })
    ));
    drive.pulleys[2].inertia = 0.0;
    assert_eq!(
        build(&drive, &steady).unwrap_err().to_string(),
        "\"rotation.accessory\" has no inertia; motions need one"
    );
    drive.pulleys[2].inertia = 1e-4;
    drive.pulleys[0].coupling = one_way;
    assert!(matches!(
        build(&drive, &steady),
        Err(DriveSystemError::CouplingOfDriver { .. })
    ));
    drive.pulleys[0].coupling = Coupling::NONE;
    let mut at_rest = steady.clone();
    at_rest.driver_speed = 0.0;
    assert!(matches!(
        build(&drive, &at_rest),
        Err(DriveSystemError::NoFrequency { .. })
    ));
}

/// Everything follows the speed; the operating point has the fundamental of the orders.
#[test]
fn over_speed_everything_follows() {
    let (mut drive, _) = three_pulley();
    drive.pulleys[2].load = Load::Power(300.0);
    drive.pulleys[2].coupling = Coupling::OneWay {
        accessory_inertia: 2e-3,
    };
    let family = DriveSpeedFamily {
        installed: Installed::new(&drive).unwrap(),
        excitation: Excitation::Motion(vec![order(0.5, 0.001, 0.0), order(2.0, 0.01, 0.0)]),
        drive: drive.clone(),
    };
    for speed in [100.0, 250.0] {
        let at = family.at(speed).unwrap();
        assert_eq!(at.frequency, 0.5 * speed);
        let orders: Vec<usize> = at.system.forcing.harmonics.iter().map(|h| h.order).collect();
        assert_eq!(orders, [1, 4]);
        let accessory_speed = speed * drive.pulleys[0].radius / drive.pulleys[2].radius;
        let load = at.system.forcing.constant.iter().copied().fold(0.0, f64::max);
        close(load, 300.0 / accessory_speed, 1e-14, 0.0, "load");
        // Measures are totals.
        let steady = SteadyState::solve(&family.drive, &family.installed, speed).unwrap();
        let tension = format!("tension.{}", family.drive.span_name(0));
        let tension = &at.system.outputs[at.system.output_index(&tension).unwrap()];
        close(tension.constant, steady.tensions[0], 1e-12, 0.0, "steady tension");
    }
    assert!(family.at(0.0).is_err());
    assert!(family.at(-10.0).is_err());
}
