//! Natural modes of random drives: the eigenvalue problem itself, orthogonality, invariances, tracking
//! (theory 04 §4).

use crate::drives::{Case, close, config, running};
use glam::DVec2;
use proptest::prelude::*;
use slackside_belt_drive::drive::{BeltModel, Coupling, Drive, Flexible, Guide, Load, Mount};
use slackside_belt_drive::model::LinearModel;
use slackside_belt_drive::modes::{Kind, Mode, campbell, damped_modes, undamped_modes};
use slackside_belt_drive::steady::{Installed, SteadyState};
use slackside_linalg::{Complex, Matrix};
use std::f64::consts::TAU;

/// The drive's modes, or `None` where the drive is statically unstable.
fn modes(drive: &Drive, speed: f64, driver_is_free: bool) -> Option<Vec<Mode>> {
    let installed = Installed::new(drive).unwrap();
    let steady = SteadyState::solve(drive, &installed, speed).unwrap();
    undamped_modes(drive, &LinearModel::new(drive, &steady), driver_is_free).ok()
}

fn form(left: &[Complex], matrix: &Matrix, right: &[Complex]) -> Complex {
    (0..left.len())
        .map(|i| {
            let row: Complex = matrix.row(i).iter().zip(right).map(|(a, b)| b * *a).sum();
            left[i].conj() * row
        })
        .sum()
}

fn same_frequencies(found: &[Mode], expected: &[Mode], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}: number of modes");
    let lowest = expected
        .iter()
        .map(|mode| mode.frequency)
        .find(|f| *f > 0.0)
        .unwrap_or(1.0);
    for (a, b) in found.iter().zip(expected) {
        close(a.frequency, b.frequency, tolerance, lowest, what);
    }
}

/// The drive with every place in the plane sent to another one; `turn` is added to the angles of rotary arms.
fn transformed(
    drive: &Drive,
    map: impl Fn(DVec2) -> DVec2,
    linear: impl Fn(DVec2) -> DVec2,
    turn: f64,
) -> Drive {
    let mut moved = drive.clone();
    for pulley in &mut moved.pulleys {
        match &mut pulley.mount {
            Mount::Fixed(centre) => *centre = map(*centre),
            Mount::Carried { tensioner, place } => {
                if matches!(drive.tensioners[*tensioner].guide, Guide::Linear { .. }) {
                    *place = map(*place);
                }
            }
        }
    }
    for tensioner in &mut moved.tensioners {
        match &mut tensioner.guide {
            Guide::Rotary { pivot } => {
                *pivot = map(*pivot);
                tensioner.reference += turn;
            }
            Guide::Linear { direction } => *direction = linear(*direction),
        }
    }
    moved
}

fn mirrored(drive: &Drive) -> Drive {
    let flip = |v: DVec2| DVec2::new(v.x, -v.y);
    let mut mirrored = transformed(&drive.reversed(), flip, flip, 0.0);
    for pulley in &mut mirrored.pulleys {
        if let Mount::Carried { tensioner, place } = &mut pulley.mount
            && matches!(drive.tensioners[*tensioner].guide, Guide::Rotary { .. })
        {
            *place = flip(*place);
        }
    }
    for tensioner in &mut mirrored.tensioners {
        if matches!(tensioner.guide, Guide::Rotary { .. }) {
            tensioner.reference = -tensioner.reference;
        }
    }
    mirrored
}

fn renumbered(drive: &Drive, shift: usize) -> Drive {
    let mut other = drive.clone();
    let count = drive.pulleys.len();
    other.pulleys.rotate_left(shift % count);
    other.belt.terms.rotate_left(shift % count);
    other.driver = (drive.driver + count - shift % count) % count;
    other
}

/// The belt runs the other way round.
fn backwards(drive: &Drive) -> Drive {
    let mut other = drive.reversed();
    other.pulleys.reverse();
    let count = drive.pulleys.len();
    other.driver = count - 1 - drive.driver;
    // Span i of the new drive leaves pulley count − 1 − i and ends at the one before it.
    other.belt.terms = (0..count)
        .map(|i| drive.belt.terms[(2 * count - 2 - i) % count])
        .collect();
    other
}

fn without_loads(drive: &Drive) -> Drive {
    let mut drive = drive.clone();
    drive
        .pulleys
        .iter_mut()
        .for_each(|pulley| pulley.load = Load::NONE);
    drive
}

proptest! {
    #![proptest_config(config(16))]

    #[test]
    fn modes_solve_their_equations(case in running(), driver_is_free in any::<bool>()) {
        let model = LinearModel::new(&case.drive, &case.steady());
        let Ok(modes) = undamped_modes(&case.drive, &model, driver_is_free) else { return Ok(()); };
        let free = model.free_coordinates(&case.drive, driver_is_free);
        prop_assert_eq!(modes.len(), free.len());
        let select = |mode: &Mode| -> Vec<Complex> { free.iter().map(|k| mode.shape[*k]).collect() };
        let (mass, turn, stiff) = (
            model.mass.selected(&free), model.gyroscopic.selected(&free), model.stiffness.selected(&free),
        );
        for mode in &modes {
            let shape = select(mode);
            let omega = mode.frequency;
            // Residual of (K − ω²M + iωG) φ, in units of the energy norm.
            let unit = |k: usize| (stiff[(k, k)] + omega * omega * mass[(k, k)]).sqrt();
            let size = (0..free.len()).map(|k| unit(k) * shape[k].norm()).fold(0.0, f64::max);
            for row in 0..free.len() {
                let apply = |matrix: &Matrix| -> Complex { matrix.row(row).iter().zip(&shape).map(|(a, b)| b * *a).sum() };
                let residual = apply(&stiff) - omega * omega * apply(&mass) + Complex::new(0.0, omega) * apply(&turn);
                prop_assert!(
                    residual.norm() <= 1e-9 * size * unit(row),
                    "residual {:e} at {omega} rad/s", residual.norm() / (size * unit(row))
                );
            }
            let total: f64 = mode.shares.rotation.iter().chain(&mode.shares.arms).chain(&mode.shares.spans).sum();
            close(total, 1.0, 1e-12, 0.0, "sum of the shares");
            prop_assert!(mode.shares.rotation.iter().chain(&mode.shares.arms).chain(&mode.shares.spans).all(|share| *share >= 0.0));
        }
        prop_assert!(modes.windows(2).all(|pair| pair[0].frequency <= pair[1].frequency));
        if driver_is_free {
            prop_assert_eq!(modes[0].frequency, 0.0);
            prop_assert_eq!(modes[0].kind, Kind::Rotation);
        }
        // Orthogonal in A*, and of unit size.
        for (a, first) in modes.iter().enumerate().filter(|(_, mode)| mode.frequency > 0.0) {
            for (b, second) in modes.iter().enumerate().filter(|(_, mode)| mode.frequency > 0.0) {
                let (left, right) = (select(first), select(second));
                let product = first.frequency * second.frequency * form(&left, &mass, &right) + form(&left, &stiff, &right);
                prop_assert!((product - f64::from(a == b)).norm() < 1e-7, "modes {a} and {b}: {product}");
            }
        }
    }

    #[test]
    fn damped_modes_without_damping_are_the_undamped_ones(case in running(), driver_is_free in any::<bool>()) {
        let model = LinearModel::new(&case.drive, &case.steady());
        let Ok(undamped) = undamped_modes(&case.drive, &model, driver_is_free) else { return Ok(()); };
        let damped = damped_modes(&case.drive, &model, driver_is_free).unwrap();
        same_frequencies(&damped, &undamped, 1e-7, "damped modes");
        for mode in &damped {
            prop_assert!(mode.damping_ratio.abs() < 1e-7);
        }
    }

    #[test]
    fn frequencies_do_not_depend_on_the_description(
        case in running(), angle in -3.0..3.0_f64, shift in -2.0..2.0_f64, places in 1_usize..8,
    ) {
        let Some(expected) = modes(&case.drive, case.speed, false) else { return Ok(()); };
        let spin = |v: DVec2| DVec2::from_angle(angle).rotate(v);
        let turned = transformed(&case.drive, |v| spin(v) + DVec2::new(shift, -0.3), spin, angle);
        let others = [
            ("turned and moved", turned),
            ("mirrored", mirrored(&case.drive)),
            ("renumbered", renumbered(&case.drive, places)),
        ];
        for (what, other) in others {
            let found = modes(&other, case.speed, false);
            prop_assert!(found.is_some(), "{what}");
            same_frequencies(&found.unwrap(), &expected, 1e-8, what);
        }
    }

    /// Without loads the belt may as well run the other way round.
    #[test]
    fn frequencies_do_not_depend_on_the_way_round(case in running()) {
        let drive = without_loads(&case.drive);
        let installed = Installed::new(&drive).unwrap();
        prop_assume!(SteadyState::solve(&drive, &installed, case.speed).is_ok());
        let Some(expected) = modes(&drive, case.speed, false) else { return Ok(()); };
        same_frequencies(&modes(&backwards(&drive), case.speed, false).unwrap(), &expected, 1e-8, "the other way round");
    }

    /// An accessory behind an open clutch turns by itself, at zero frequency; the others are as if it were not there.
    #[test]
    fn an_open_clutch_adds_a_free_rotation(case in running(), behind in 0_usize..8, driver_is_free in any::<bool>()) {
        let mut drive = case.drive.clone();
        let j = behind % drive.pulleys.len();
        prop_assume!(j != drive.driver);
        let steady = case.steady();
        let Ok(expected) = undamped_modes(&drive, &LinearModel::new(&drive, &steady), driver_is_free) else { return Ok(()); };
        drive.pulleys[j].coupling = Coupling::WrapSpring(Flexible { accessory_inertia: 2e-3, stiffness: 40.0, damping: 0.0 });
        let open = LinearModel::with_disengaged(&drive, &steady, &[j]);
        let found = undamped_modes(&drive, &open, driver_is_free).unwrap();
        prop_assert_eq!(found.len(), expected.len() + 1);
        let zeros = found.iter().filter(|mode| mode.frequency == 0.0).count();
        prop_assert_eq!(zeros, 1 + usize::from(driver_is_free));
        same_frequencies(&found[1..], &expected, 1e-8, "with an open clutch");
        // A very stiff clutch is a rigid one.
        drive.pulleys[j].coupling = Coupling::WrapSpring(Flexible { accessory_inertia: 2e-3, stiffness: 1e7, damping: 0.0 });
        let stiff = undamped_modes(&drive, &LinearModel::new(&drive, &steady), driver_is_free).unwrap();
        drive.pulleys[j].coupling = Coupling::OneWay { accessory_inertia: 2e-3 };
        let rigid = undamped_modes(&drive, &LinearModel::new(&drive, &steady), driver_is_free).unwrap();
        same_frequencies(&stiff[..6], &rigid[..6], 1e-3, "stiff clutch");
    }
}

proptest! {
    #![proptest_config(config(5))]

    /// Neighbouring speeds: followed modes resemble each other, and no frequency is lost or doubled.
    #[test]
    fn campbell_follows_modes(case in running()) {
        let speeds: Vec<f64> = (0..8).map(|k| case.speed * k as f64 / 7.0).collect();
        let Ok(diagram) = campbell(&case.drive, &case.installed(), &speeds, false, 8) else { return Ok(()); };
        for (point, speed) in diagram.points.iter().zip(&speeds) {
            prop_assert_eq!(point.driver_speed, *speed);
            let Some(all) = modes(&case.drive, *speed, false) else { continue };
            let mut found: Vec<f64> = point.modes.iter().map(|mode| mode.frequency).collect();
            found.sort_by(f64::total_cmp);
            for (a, b) in found.iter().zip(&all) {
                close(*a, b.frequency, 1e-12, 0.0, "frequency at a speed");
            }
        }
        for curve in 0..8.min(diagram.points[0].modes.len()) {
            for order in [0.5, 2.0, 6.0] {
                for crossing in diagram.crossings(curve, order) {
                    let k = speeds.partition_point(|speed| *speed < crossing).clamp(1, speeds.len() - 1);
                    let ends = [diagram.points[k - 1].modes[curve].frequency, diagram.points[k].modes[curve].frequency];
                    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                    prop_assert!((low * (1.0 - 1e-12)..=high * (1.0 + 1e-12)).contains(&(order * crossing)));
                }
            }
        }
    }
}

/// Terms left out of the sine series hardly matter once they act statically (theory 04 §7): the prototype at rest.
#[test]
fn static_correction_makes_few_terms_enough() {
    let frequencies = |terms: usize, correction: bool| -> Vec<f64> {
        let mut drive = slackside_belt_drive::prototypes::three_pulley(0.015);
        drive.belt.terms = vec![terms; 3];
        drive.belt.static_correction = correction;
        modes(&drive, 0.0, false)
            .unwrap()
            .iter()
            .take(3)
            .map(|mode| mode.frequency / TAU)
            .collect()
    };
    let exact = frequencies(50, true);
    let worst = |terms: usize, correction: bool| {
        frequencies(terms, correction)
            .iter()
            .zip(&exact)
            .map(|(a, b)| (a / b - 1.0).abs())
            .fold(0.0, f64::max)
    };
    for (terms, plain, corrected) in [
        (3, 3.0e-2, 5e-4),
        (5, 2.3e-2, 2e-4),
        (10, 1.2e-2, 9e-6),
        (20, 3.9e-3, 2e-6),
    ] {
        let found = worst(terms, false);
        assert!(
            (found / plain - 1.0).abs() < 0.05,
            "{terms} plain terms: {found:e} instead of {plain:e}"
        );
        let found = worst(terms, true);
        assert!(
            found < 1.5 * corrected,
            "{terms} corrected terms: {found:e} instead of {corrected:e}"
        );
    }
}

#[test]
fn case_is_what_the_generator_promises() {
    use proptest::strategy::{Strategy, ValueTree};
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::new(config(1));
    let cases: Vec<Case> = (0..200)
        .map(|_| running().new_tree(&mut runner).unwrap().current())
        .collect();
    let count = |what: &dyn Fn(&Case) -> bool| cases.iter().filter(|case| what(case)).count();
    let wanted: [(&str, usize); 8] = [
        ("two tensioners", count(&|c| c.drive.tensioners.len() == 2)),
        ("one tensioner", count(&|c| c.drive.tensioners.len() == 1)),
        ("fixed centres", count(&|c| c.drive.tensioners.is_empty())),
        (
            "a slide",
            count(&|c| {
                c.drive
                    .tensioners
                    .iter()
                    .any(|t| matches!(t.guide, Guide::Linear { .. }))
            }),
        ),
        (
            "an arm with two pulleys",
            count(&|c| (0..c.drive.tensioners.len()).any(|arm| c.drive.carried_by(arm).count() == 2)),
        ),
        (
            "a locked arm",
            count(&|c| c.drive.tensioners.iter().any(|t| t.locked)),
        ),
        ("seven or eight pulleys", count(&|c| c.drive.pulleys.len() >= 7)),
        (
            "an idler that drives",
            count(&|c| c.drive.pulleys[c.drive.driver].name.starts_with("idler")),
        ),
    ];
    for (what, found) in wanted {
        assert!(found >= 5, "{what}: {found} of {}", cases.len());
    }
    assert!(cases.iter().all(|case| case.drive.belt.model == BeltModel::Beam));
}
