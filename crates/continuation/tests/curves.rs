//! Curves whose folds, zeros and closure are known.

use slackside_continuation::*;

/// The circle `x² + p² = 1`, with a test function that vanishes where `x = p`.
struct Circle;

impl Family for Circle {
    fn dimension(&self) -> usize {
        1
    }
    fn unknown_scales(&self) -> Vec<f64> {
        vec![1.0]
    }
    fn parameter_scale(&self) -> f64 {
        1.0
    }
    fn evaluate(&mut self, z: &[f64], p: f64, e: &mut Evaluation) -> Result<(), FamilyError> {
        e.residual[0] = z[0] * z[0] + p * p - 1.0;
        e.jacobian[(0, 0)] = 2.0 * z[0];
        e.by_parameter[0] = 2.0 * p;
        Ok(())
    }
    fn test_functions(&mut self, z: &[f64], p: f64, _: &Evaluation) -> Vec<f64> {
        vec![z[0] - p]
    }
}

#[test]
fn the_circle_closes_and_has_two_folds_and_two_zeros() {
    let trace = trace(
        &mut Circle,
        &[1.0],
        0.0,
        1.0,
        &Options::over(-2.0, 2.0),
        &mut Unwatched,
    );
    assert_eq!(trace.stop, StopReason::Closed);
    let folds: Vec<f64> = trace
        .special
        .iter()
        .filter(|s| s.kind == Kind::Fold)
        .map(|s| s.point.p)
        .collect();
    assert_eq!(folds.len(), 2);
    assert!((folds[0] - 1.0).abs() < 1e-13 && (folds[1] + 1.0).abs() < 1e-13);
    let zeros: Vec<f64> = trace
        .special
        .iter()
        .filter(|s| s.kind == Kind::Test(0))
        .map(|s| s.point.p)
        .collect();
    assert_eq!(zeros.len(), 2);
    for zero in zeros {
        assert!((zero.abs() - 0.5_f64.sqrt()).abs() < 1e-12);
    }
    assert!((trace.points.last().unwrap().arclength - std::f64::consts::TAU).abs() < 0.2);
}

#[test]
fn a_branch_ends_on_the_limit_of_its_range() {
    let trace = trace(
        &mut Circle,
        &[1.0],
        0.0,
        1.0,
        &Options::over(-0.3, 0.3),
        &mut Unwatched,
    );
    assert_eq!(trace.stop, StopReason::RangeLimit);
    let last = trace.points.last().unwrap();
    assert_eq!(last.p, 0.3);
    assert!((last.z[0] - (1.0_f64 - 0.09).sqrt()).abs() < 1e-13);
}

/// The pitchfork `x (p − x²) = 0`.
struct Pitchfork;

impl Family for Pitchfork {
    fn dimension(&self) -> usize {
        1
    }
    fn unknown_scales(&self) -> Vec<f64> {
        vec![1.0]
    }
    fn parameter_scale(&self) -> f64 {
        1.0
    }
    fn evaluate(&mut self, z: &[f64], p: f64, e: &mut Evaluation) -> Result<(), FamilyError> {
        e.residual[0] = z[0] * (p - z[0] * z[0]);
        e.jacobian[(0, 0)] = p - 3.0 * z[0] * z[0];
        e.by_parameter[0] = z[0];
        Ok(())
    }
}

#[test]
fn a_crossing_branch_is_told_from_a_fold() {
    let trace = trace(
        &mut Pitchfork,
        &[0.0],
        -0.5,
        1.0,
        &Options::over(-1.0, 1.0),
        &mut Unwatched,
    );
    assert_eq!(trace.special.len(), 1);
    assert_eq!(trace.special[0].kind, Kind::BranchPoint);
    assert!(trace.special[0].point.p.abs() < 0.1);
}

#[test]
fn a_start_without_a_solution_says_so() {
    struct Nothing;
    impl Family for Nothing {
        fn dimension(&self) -> usize {
            1
        }
        fn unknown_scales(&self) -> Vec<f64> {
            vec![1.0]
        }
        fn parameter_scale(&self) -> f64 {
            1.0
        }
        fn evaluate(&mut self, z: &[f64], _: f64, e: &mut Evaluation) -> Result<(), FamilyError> {
            e.residual[0] = z[0] * z[0] + 1.0;
            e.jacobian[(0, 0)] = 2.0 * z[0];
            e.by_parameter[0] = 0.0;
            Ok(())
        }
    }
    let trace = trace(
        &mut Nothing,
        &[0.7],
        0.0,
        1.0,
        &Options::over(-1.0, 1.0),
        &mut Unwatched,
    );
    assert!(trace.points.is_empty());
    assert!(matches!(trace.stop, StopReason::NoStart(_)));
}
