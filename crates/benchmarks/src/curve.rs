//! Task (a): the frequency-response curve from 0.3 to 8 with both resonances, all special points located, multipliers and
//! the RMS of the wind-up at every point.

use crate::Case;
use crate::timing::measure;
use serde_json::{Value, json};
use slackside_continuation::Options;
use slackside_dynamics::branch::{Branch, BranchOptions, SpecialKind, follow};
use slackside_dynamics::flow::Request;
use slackside_dynamics::orbit::shooting::Shooting;
use slackside_mechanics::FrequencyFamily;
use slackside_testkit::{benchmark, numbers, reference};
use std::sync::Arc;

const RANGE: (f64, f64) = (0.3, 8.0);

struct Curve {
    branch: Branch,
    rms: Vec<f64>,
    evaluations: usize,
}

fn compute(amplitude: f64) -> Curve {
    let model = benchmark(amplitude);
    let system = model.system().expect("the benchmark system is sound");
    let windup = vec![system.outputs[2].clone()];
    let family = Arc::new(FrequencyFamily::new(Arc::new(system)));
    let mut shooting = Shooting::new(family, RANGE.0, 1).expect("the exact flow applies");
    let rest = [0.0, -model.static_windup(), 0.0, 0.0];
    let start = shooting
        .solve(&rest, RANGE.0)
        .expect("the linear response exists at low frequency");
    let continuation = Options {
        max_step: 0.18,
        ..Options::over(RANGE.0, RANGE.1)
    };
    let options = BranchOptions {
        continuation,
        direction: 1.0,
    };
    let branch = follow(&mut shooting, &start.start, RANGE.0, &options, &mut |_| true);
    let evaluations = shooting.evaluations();
    let request = Request {
        harmonics: 0,
        extremes: false,
        samples: 0,
        ..Request::default()
    };
    let rms = branch
        .points
        .iter()
        .map(|point| {
            let record = shooting.summarize(&point.unknowns, point.parameter, &windup, &request);
            record.expect("the motion is known").measures[0].rms
        })
        .collect();
    Curve {
        branch,
        rms,
        evaluations,
    }
}

/// Largest distance of the found points from the expected ones; infinite if their numbers differ.
fn worst(found: &mut [f64], mut expected: Vec<f64>) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    found.sort_by(f64::total_cmp);
    expected.sort_by(f64::total_cmp);
    found
        .iter()
        .zip(&expected)
        .map(|(f, e)| (f - e).abs())
        .fold(0.0, f64::max)
}

pub(crate) fn run(case: Case, repeats: usize) -> Value {
    let file = reference("clutch_benchmark.json");
    let (name, amplitude, folds, doublings, tori) = match case {
        Case::A => {
            let folds = file["caseA_exact"]["folds"].as_array().expect("a list");
            let folds = folds.iter().map(|f| slackside_testkit::number(&f["W"])).collect();
            ("A", 0.05, folds, Vec::new(), Vec::new())
        }
        Case::B => {
            let list = |key: &str| numbers(&file["caseB_exact"][key]);
            ("B", 0.10, list("LP"), list("PD"), list("TR"))
        }
    };
    let timing = measure(repeats, || compute(amplitude));
    let branch = &timing.result.branch;
    let error = |kind, expected| worst(&mut branch.special_parameters(kind), expected);
    let accuracy = json!({
        "points": branch.points.len(),
        "end": format!("{:?}", branch.stop),
        "largest_rms": timing.result.rms.iter().copied().fold(0.0, f64::max),
        "fold_error": error(SpecialKind::Fold, folds),
        "period_doubling_error": error(SpecialKind::PeriodDoubling, doublings),
        "neimark_sacker_error": error(SpecialKind::NeimarkSacker, tori),
    });
    // Largest natural frequency of the engaged system.
    let radius = 5.644_590_916_651_54;
    let points = branch.points.len() as f64;
    let per_map = branch
        .points
        .iter()
        .map(|p| crate::flops::map(p.parameter, radius))
        .sum::<f64>()
        / points;
    let flops = timing.result.evaluations as f64 * per_map;
    timing.line(
        "a",
        name,
        accuracy,
        flops,
        "shooting; also locates grazing points; RMS of the wind-up at every point; flops estimated from counted maps, \
         without eigenvalues and RMS",
    )
}
