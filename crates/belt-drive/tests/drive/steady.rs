//! The steady state against its equations, evaluated another way, and against its own installation (theory 04 §2).

use crate::drives::{Case, close, config, ring_of, running};
use crate::span::integral;
use glam::DVec2;
use proptest::prelude::*;
use slackside_belt_drive::drive::{
    ArcStretch, BeltModel, Condition, Drive, Guide, Installation, Load, LoadTable, Mount, SpanEnds,
};
use slackside_belt_drive::model::{Coordinate, LinearModel};
use slackside_belt_drive::steady::{Installed, SteadyState};
use slackside_linalg::{Lu, Matrix};

/// Natural belt length from lengths, wraps and tensions, the excess length by quadrature.
fn natural_length(drive: &Drive, steady: &SteadyState) -> f64 {
    let stiffness = drive.belt.axial_stiffness;
    let mut sum = 0.0;
    for (i, span) in steady.layout.spans.iter().enumerate() {
        let j = drive.next(i);
        let tension = steady.effective_tensions[i];
        let excess = match drive.belt.span_ends {
            SpanEnds::Tangent => 0.5 * integral(span.length, 300, |x| steady.spans[i].slope(x).powi(2)),
            SpanEnds::Contact => {
                let squares = drive.pulleys[i].radius.powi(-2) + drive.pulleys[j].radius.powi(-2);
                squares * (drive.belt.bending_stiffness / tension).powf(1.5) / 12.0
            }
        };
        sum += (span.length + excess) / (1.0 + steady.tensions[i] / stiffness);
        let strain = match drive.belt.arc_stretch {
            ArcStretch::None => 0.0,
            ArcStretch::Entry => steady.tensions[i] / stiffness,
            ArcStretch::Mean => 0.5 * (steady.tensions[i] + steady.tensions[j]) / stiffness,
        };
        sum += drive.pulleys[j].radius * steady.layout.wraps[j] / (1.0 + strain);
    }
    sum
}

/// What the belt and the drag of carried pulleys exert on an arm along its coordinate, by moments about the pivot.
fn push_on_arm(drive: &Drive, steady: &SteadyState, arm: usize) -> f64 {
    let carried = drive.carried_by(arm);
    match drive.tensioners[arm].guide {
        Guide::Linear { direction } => carried.map(|j| steady.belt_forces[j].dot(direction)).sum(),
        Guide::Rotary { pivot } => carried
            .map(|j| {
                let drag = if drive.pulleys[j].drag_reacts_on_arm {
                    drive.pulleys[j].sense.sign() * steady.loads[j]
                } else {
                    0.0
                };
                (steady.layout.centres[j] - pivot).perp_dot(steady.belt_forces[j]) + drag
            })
            .sum(),
    }
}

/// The same drive with its belt and springs described another way.
fn described_by(case: &Case, installed: &Installed, installation: Installation, positions: &[f64]) -> Drive {
    let mut drive = case.drive.clone();
    drive.installation = installation;
    let layout = slackside_belt_drive::layout::Layout::new(&drive, positions).unwrap();
    let rates = slackside_belt_drive::layout::Kinematics::new(&drive, &layout, positions);
    for arm in 0..drive.tensioners.len() {
        let torque = installed.spring_torque(&case.drive, arm, positions[arm]);
        drive.tensioners[arm].spring_preload = Some(torque * rates.take_up[arm].signum());
        drive.tensioners[arm].reference = positions[arm];
    }
    drive
}

/// What the shear adds to the stiffness of the arms when the spans turn: exact in statics, left out of the dynamics
/// (theory 04 (2.10)).
fn add_shear(stiffness: &mut Matrix, drive: &Drive, steady: &SteadyState, model: &LinearModel) {
    for (i, span) in steady.layout.spans.iter().enumerate() {
        let rates = &steady.kinematics.spans[i];
        for a in 0..drive.tensioners.len() {
            for b in 0..drive.tensioners.len() {
                let turning = rates[a].along() * rates[b].across()
                    + rates[a].across() * rates[b].along()
                    + span.offset * rates[a].across() * rates[b].across() / span.length;
                stiffness[(model.coordinates.arm(a), model.coordinates.arm(b))] +=
                    steady.spans[i].shear() * turning / span.length;
            }
        }
    }
}

fn same_state(found: &SteadyState, expected: &SteadyState, tolerance: f64) {
    for (a, b) in found.tensions.iter().zip(&expected.tensions) {
        close(*a, *b, tolerance, 0.0, "tension");
    }
    for (a, b) in found.positions.iter().zip(&expected.positions) {
        close(*a, *b, tolerance, 0.1, "position");
    }
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn equations_hold(case in running()) {
        let (drive, steady) = (&case.drive, case.steady());
        let flux = drive.belt.mass_per_length * steady.belt_speed.powi(2);
        close(natural_length(drive, &steady), case.installed().natural_length, 1e-12, 0.0, "natural length");
        let mut power = 0.0;
        for j in 0..drive.pulleys.len() {
            close(steady.tensions[j], steady.effective_tensions[j] + flux, 1e-14, 0.0, "total tension");
            let rise = drive.pulleys[j].radius * (steady.tensions[j] - steady.tensions[drive.span_before(j)]);
            let torque = if j == drive.driver { -steady.driver_torque } else { steady.loads[j] };
            close(rise, torque, 1e-11, drive.pulleys[j].radius * steady.tensions[j], "torque balance");
            power += torque * steady.belt_speed / drive.pulleys[j].radius;
        }
        prop_assert!(power.abs() <= 1e-9 * steady.driver_torque.abs() * (1.0 + case.speed), "power balance");
        for arm in 0..drive.tensioners.len() {
            let balance = push_on_arm(drive, &steady, arm) + steady.spring_torques[arm] + steady.holding_torques[arm];
            let scale: f64 = drive.carried_by(arm)
                .map(|j| steady.belt_forces[j].length() * steady.kinematics.centre_rates[j][arm].length()).sum();
            close(balance, 0.0, 1e-10, scale, "arm in balance");
            prop_assert!(drive.tensioners[arm].locked || steady.holding_torques[arm] == 0.0);
        }
    }

    /// Forces of the belt on all hubs cancel, and their moment is that of the shafts' torques.
    #[test]
    fn the_belt_as_a_whole_is_in_balance(case in running()) {
        let (drive, steady) = (&case.drive, case.steady());
        let sum: DVec2 = steady.belt_forces.iter().sum();
        let largest = steady.tensions.iter().copied().fold(0.0, f64::max);
        close(sum.length(), 0.0, 1e-13, largest, "sum of hub loads");
        let moment: f64 = (0..drive.pulleys.len()).map(|j| {
            let torque = if j == drive.driver { -steady.driver_torque } else { steady.loads[j] };
            steady.layout.centres[j].perp_dot(steady.belt_forces[j]) + drive.pulleys[j].sense.sign() * torque
        }).sum();
        close(moment, 0.0, 1e-12, largest, "sum of moments");
    }

    #[test]
    fn every_description_of_the_installation_gives_the_same_state(case in running()) {
        let (installed, steady) = (case.installed(), case.steady());
        let reference = case.drive.reference_positions();
        let by_length = described_by(&case, &installed, Installation::NaturalLength(installed.natural_length), &reference);
        let again = Installed::new(&by_length).unwrap();
        let mut expected = steady.clone();
        // What holds a locked arm is the spring in one description and the lock in the other.
        let found = SteadyState::solve(&by_length, &again, case.speed).unwrap();
        same_state(&found, &expected, 1e-10);
        prop_assume!(!case.free_arms().is_empty());
        let at_speed = Installation::OperatingPosition { driver_speed: case.speed };
        let by_position = described_by(&case, &installed, at_speed, &steady.positions);
        let again = Installed::new(&by_position).unwrap();
        close(again.natural_length, installed.natural_length, 1e-12, 0.0, "natural length from the position");
        let found = SteadyState::solve(&by_position, &again, case.speed).unwrap();
        expected.positions.clone_from(&steady.positions);
        same_state(&found, &expected, 1e-10);
    }

    #[test]
    fn neighbours_lead_to_the_same_state(case in running(), share in 0.3..1.0_f64) {
        let installed = case.installed();
        let near = SteadyState::solve(&case.drive, &installed, share * case.speed);
        prop_assume!(near.is_ok());
        let found = near.unwrap().solve_from(&case.drive, &installed, case.speed).unwrap();
        same_state(&found, &case.steady(), 1e-10);
    }

    /// A change of the spring torques moves arms and tensions as the stiffness matrix says, up to the strain `P/EA`.
    #[test]
    fn stiffness_is_the_slope_of_the_steady_state(case in running()) {
        let mut case = case;
        case.drive.belt.axial_stiffness *= 100.0;
        // The chord's share of the excess length, of order (Q/T)², is left out of the matrix.
        case.drive.belt.bending_stiffness *= 0.2;
        case.drive.belt.span_ends = SpanEnds::Tangent;
        case.drive.belt.arc_stretch = ArcStretch::None;
        for pulley in &mut case.drive.pulleys {
            pulley.drag_reacts_on_arm = false;
        }
        let Ok(installed) = Installed::new(&case.drive) else { return Ok(()); };
        let Ok(steady) = SteadyState::solve(&case.drive, &installed, case.speed) else { return Ok(()); };
        let model = LinearModel::new(&case.drive, &steady);
        let free = model.free_coordinates(&case.drive, false);
        let mut stiffness = model.stiffness.clone();
        add_shear(&mut stiffness, &case.drive, &steady, &model);
        let compliance = Lu::new(&stiffness.selected(&free)).unwrap();
        for arm in case.free_arms() {
            let step = 1e-4 * installed.spring_torques[arm].abs();
            let at = |k: f64| {
                let mut turned = installed.clone();
                turned.spring_torques[arm] += k * step;
                steady.solve_from(&case.drive, &turned, case.speed).unwrap()
            };
            let (minus, plus) = (at(-1.0), at(1.0));
            let force: Vec<f64> = free.iter().map(|k| f64::from(*k == model.coordinates.arm(arm))).collect();
            let answer = compliance.solve(&force);
            for other in case.free_arms() {
                let found = (plus.positions[other] - minus.positions[other]) / (2.0 * step);
                let place = |arm: usize| free.iter().position(|k| *k == model.coordinates.arm(arm)).unwrap();
                close(found, answer[place(other)], 1e-3, 1e-3 * answer[place(arm)].abs(), "motion of an arm");
            }
            for span in 0..case.drive.pulleys.len() {
                let found = (plus.tensions[span] - minus.tensions[span]) / (2.0 * step);
                let whole: Vec<f64> = (0..model.coordinates.len())
                    .map(|k| free.iter().position(|f| *f == k).map_or(0.0, |f| answer[f])).collect();
                let stretch: f64 = model.stretch.row(span).iter().zip(&whole).map(|(a, b)| a * b).sum();
                close(found, model.span_stiffness[span] * stretch, 5e-3, 0.1 / steady.kinematics.take_up[arm].abs(), "tension");
            }
        }
    }

    /// A string drive with one arm and without loads: `dP/d(mc²) = 1/(1 + c_b K⁰/D²)` with the belt's compliance
    /// `c_b = L_b/(EA + P)`, exact for the stretch law used here (theory 04 (2.11)).
    #[test]
    fn tension_follows_the_speed_as_the_arm_allows(case in running()) {
        let mut drive = case.drive.clone();
        drive.belt.model = BeltModel::String;
        drive.belt.arc_stretch = ArcStretch::Mean;
        drive.pulleys.iter_mut().for_each(|pulley| pulley.load = Load::NONE);
        prop_assume!(case.free_arms().len() <= 1);
        let installed = Installed::new(&drive).unwrap();
        let at = |flux: f64| {
            let speed = (flux / drive.belt.mass_per_length).sqrt() / drive.pulleys[drive.driver].radius;
            SteadyState::solve(&drive, &installed, speed).unwrap()
        };
        let (before, steady, after) = (at(9.0), at(10.0), at(11.0));
        let share = (after.tensions[0] - before.tensions[0]) / 2.0;
        let expected = match case.free_arms()[..] {
            [arm] => {
                let spans: f64 = (0..drive.pulleys.len()).map(|i| {
                    let rates = &steady.kinematics.spans[i][arm];
                    steady.effective_tensions[i] * rates.across().powi(2) / steady.layout.spans[i].length
                }).sum();
                let geometric: f64 = drive.carried_by(arm)
                    .map(|j| steady.belt_forces[j].dot(steady.kinematics.centre_curvatures[j][arm])).sum();
                let stiffness = drive.tensioners[arm].spring_rate - geometric + spans;
                let compliance = steady.layout.pitch_length / (drive.belt.axial_stiffness + steady.tensions[0]);
                1.0 / (1.0 + compliance * stiffness / steady.kinematics.take_up[arm].powi(2))
            }
            _ => 0.0,
        };
        close(share, expected, 1e-5, 1.0, "share of the centrifugal tension");
    }

    #[test]
    fn conditions_do_what_they_say(case in running(), change in -20.0..40.0_f64) {
        let mut drive = case.drive.clone();
        drive.belt.thermal_expansion = 1e-5;
        let installed = Installed::new(&drive).unwrap();
        let mut hot = Condition::nominal("hot");
        hot.temperature_change = change;
        let mut worn = Condition::nominal("worn");
        worn.elongation = 1e-5 * change;
        let mut long = Condition::nominal("long");
        long.length_change = 1e-5 * change * installed.natural_length;
        let states: Vec<_> = [hot, worn, long].iter().map(|condition| {
            let (drive, installed) = installed.in_condition(&drive, condition);
            SteadyState::solve(&drive, &installed, case.speed)
        }).collect();
        prop_assume!(states.iter().all(Result::is_ok));
        let states: Vec<_> = states.into_iter().map(Result::unwrap).collect();
        same_state(&states[1], &states[0], 1e-9);
        same_state(&states[2], &states[0], 1e-9);
        let nominal = case.steady();
        if change.abs() > 1.0 && case.free_arms().is_empty() {
            prop_assert!((states[0].tensions[0] - nominal.tensions[0]) * change < 0.0, "a longer belt is slacker");
        }
        let mut aged = Condition::nominal("aged");
        aged.spring_factor = 0.97;
        let (same, weaker) = installed.in_condition(&drive, &aged);
        prop_assert_eq!(&same, &drive);
        for (a, b) in weaker.spring_torques.iter().zip(&installed.spring_torques) {
            close(*a, 0.97 * b, 1e-15, 0.0, "spring torque");
        }
    }

    /// Where the origin of a slide's coordinate lies is a matter of description.
    #[test]
    fn the_origin_of_a_slide_does_not_matter(case in running(), shift in -0.1..0.1_f64, change in -30.0..60.0_f64) {
        let mut moved = case.drive.clone();
        for arm in 0..moved.tensioners.len() {
            if let Guide::Linear { direction } = moved.tensioners[arm].guide {
                moved.tensioners[arm].reference += shift;
                for pulley in &mut moved.pulleys {
                    match &mut pulley.mount {
                        Mount::Carried { tensioner, place } if *tensioner == arm => *place -= shift * direction,
                        _ => {}
                    }
                }
            }
        }
        let mut hot = Condition::nominal("hot");
        hot.temperature_change = change;
        hot.structure_expansion = 1.2e-5;
        let solve = |drive: &Drive| {
            let installed = Installed::new(drive).unwrap();
            let (drive, installed) = installed.in_condition(drive, &hot);
            SteadyState::solve(&drive, &installed, case.speed)
        };
        let (here, there) = (solve(&case.drive), solve(&moved));
        prop_assume!(here.is_ok());
        for (a, b) in here.unwrap().tensions.iter().zip(&there.unwrap().tensions) {
            close(*a, *b, 1e-9, 0.0, "tension");
        }
    }

    /// A drive whose structure grows holds its belt tighter: for fixed centres and a string in closed form.
    #[test]
    fn a_growing_structure_tightens_the_belt(count in 2_usize..6, change in 0.0..80.0_f64) {
        let drive = ring_of(count, 0.04, 1e-3, BeltModel::String);
        let installed = Installed::new(&drive).unwrap();
        let mut hot = Condition::nominal("hot");
        hot.temperature_change = change;
        hot.structure_expansion = 1.2e-5;
        let mut stretched = drive.clone();
        stretched.belt.arc_stretch = ArcStretch::Mean;
        let relaxed = Installed::new(&stretched).unwrap();
        let (larger, installed_hot) = relaxed.in_condition(&stretched, &hot);
        let steady = SteadyState::solve(&larger, &installed_hot, 0.0).unwrap();
        let strain = (1.0 + 1.2e-5 * change) * (1.0 + 500.0 / drive.belt.axial_stiffness) - 1.0;
        close(steady.tensions[0], strain * drive.belt.axial_stiffness, 1e-10, 0.0, "tension of the hot drive");
        prop_assert!(installed.natural_length > relaxed.natural_length, "arcs that do not stretch need more belt");
    }
}

#[test]
fn loads_over_speed() {
    let mut drive = ring_of(3, 0.05, 1e-3, BeltModel::String);
    drive.driver = 1;
    drive.pulleys[1].radius = 0.08;
    drive.pulleys[2].load = Load::Power(900.0);
    drive.pulleys[0].load = Load::Table(LoadTable {
        speed: vec![100.0, 200.0],
        value: vec![2.0, 4.0],
        is_power: false,
        over_driver: true,
    });
    let loads = drive.load_torques(150.0);
    close(loads[0], 3.0, 1e-15, 0.0, "interpolated torque");
    close(
        loads[2],
        900.0 / (150.0 * 0.08 / 0.05),
        1e-15,
        0.0,
        "torque of a power",
    );
    assert_eq!(loads[1], 0.0, "no load on the driver");
    assert_eq!(drive.load_torques(0.0)[2], 0.0, "no power at rest");
    assert_eq!(drive.load_torques(500.0)[0], 4.0, "constant beyond the table");
}

#[test]
fn locked_arms_leave_the_free_coordinates() {
    let drive = {
        let mut drive = slackside_belt_drive::prototypes::three_pulley(0.015);
        drive.tensioners[0].locked = true;
        drive
    };
    let installed = Installed::new(&drive).unwrap();
    let steady = SteadyState::solve(&drive, &installed, 200.0).unwrap();
    assert_eq!(steady.positions, drive.reference_positions());
    let model = LinearModel::new(&drive, &steady);
    let free = model.free_coordinates(&drive, false);
    let held: Vec<Coordinate> = model
        .coordinates
        .iter()
        .enumerate()
        .filter(|(k, _)| !free.contains(k))
        .map(|(_, coordinate)| coordinate)
        .collect();
    assert_eq!(held, [Coordinate::Pulley(0), Coordinate::Arm(0)]);
}
