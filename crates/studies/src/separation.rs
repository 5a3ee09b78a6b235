//! Where the linear response about rest first touches a switching surface: onset of separation (theory 02 §1.9).

use crate::{StudyError, Subject, linear_response, static_equilibrium};
use serde::Serialize;
use slackside_linalg::Complex;
use slackside_mechanics::{Element, Guard, Piece, Regime, System, modes};
use std::f64::consts::TAU;

/// Frequencies scanned up to the highest resonance, besides those near each resonance.
const SCAN: usize = 2000;
/// Samples of a period when the load has several harmonics.
const PHASES: usize = 720;

/// When an element leaves the regime that it has at rest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Separation {
    /// Name of the element.
    pub element: String,
    /// Its regime at rest.
    pub regime: String,
    /// Frequencies, in the user's unit and ascending, at which the linear response touches the end of the regime.
    pub onset: Vec<f64>,
    /// Frequency of the linear response that goes farthest towards the end of the regime.
    pub worst_frequency: f64,
    /// How far it goes, relative to the distance at rest: above one the element separates.
    pub worst_ratio: f64,
    /// Factor on the constant load above which the element separates at no frequency; absent where the distance does not
    /// grow in proportion to the load.
    pub critical_load_factor: Option<f64>,
}

/// Number and data of the regime in which a law rests at a displacement; `None` for a smooth law.
pub(crate) fn regime_at(element: &Element, displacement: f64) -> Option<(usize, Regime)> {
    let table = element.law.regimes()?;
    table
        .regimes
        .into_iter()
        .enumerate()
        .max_by(|(_, a), (_, b)| depth(a, displacement).total_cmp(&depth(b, displacement)))
}

/// Smallest value of a regime's guards at rest; it is not negative inside the regime.
fn depth(regime: &Regime, displacement: f64) -> f64 {
    let guards = regime.guards.iter();
    guards
        .map(|guard| guard.displacement * displacement + guard.constant)
        .fold(f64::INFINITY, f64::min)
}

/// The onset of separation of every element with regimes whose rest lies inside one of them.
///
/// # Errors
/// [`StudyError::Linalg`] if the modes cannot be computed.
pub(crate) fn separations(
    subject: &Subject,
    system: &System,
    rest: &[f64],
) -> Result<Vec<Separation>, StudyError> {
    if system.forcing.harmonics.is_empty() {
        return Ok(Vec::new());
    }
    let mut resonances = Vec::new();
    for mode in modes(system, 1.0, true)?
        .iter()
        .filter(|mode| mode.frequency > 0.0)
    {
        for harmonic in &system.forcing.harmonics {
            resonances.push((mode.frequency / harmonic.order as f64, mode.damping_ratio));
        }
    }
    let grid = grid(&resonances);
    let mut found = Vec::new();
    for element in &system.elements {
        let Some((_, regime)) = regime_at(element, element.port.project(rest)) else {
            continue;
        };
        if regime.guards.is_empty() || depth(&regime, element.port.project(rest)) <= 0.0 {
            continue;
        }
        let ratio = |frequency: f64| ratio(system, element, &regime, rest, frequency);
        let (worst_frequency, worst_ratio) = worst(&grid, &ratio);
        let mut onset = crossings(&grid, &ratio);
        onset
            .iter_mut()
            .for_each(|omega| *omega = subject.units.user_frequency(*omega));
        found.push(Separation {
            element: element.name.clone(),
            regime: regime.name.to_owned(),
            onset,
            worst_frequency: subject.units.user_frequency(worst_frequency),
            worst_ratio,
            critical_load_factor: is_homogeneous(&regime).then_some(worst_ratio),
        });
    }
    Ok(found)
}

/// Whether force and guards of the regime are proportional to the motion.
fn is_homogeneous(regime: &Regime) -> bool {
    let constant = match regime.piece {
        Piece::Affine { constant, .. } => constant,
        _ => f64::NAN,
    };
    constant == 0.0 && regime.guards.iter().all(|guard| guard.constant == 0.0)
}

/// How far the linear response goes towards the nearest guard, relative to the guard's value at rest.
fn ratio(system: &System, element: &Element, regime: &Regime, rest: &[f64], frequency: f64) -> f64 {
    let moved;
    let rest = if system.is_frequency_dependent() {
        match static_equilibrium(system, frequency) {
            Ok(found) => {
                moved = found;
                &moved
            }
            Err(_) => return f64::NAN,
        }
    } else {
        rest
    };
    let Ok(response) = linear_response(system, frequency, rest) else {
        return f64::INFINITY;
    };
    let displacement = element.port.project(rest);
    let mut worst = 0.0_f64;
    for guard in &regime.guards {
        let at_rest = guard.displacement * displacement + guard.constant;
        let harmonics: Vec<(usize, Complex)> = response
            .harmonics
            .iter()
            .map(|(order, amplitudes)| {
                let terms = element.port.terms().iter();
                let port: Complex = terms.map(|&(i, factor)| amplitudes[i] * factor).sum();
                (*order, port * factor_of(guard, *order as f64 * frequency))
            })
            .collect();
        worst = worst.max(deepest(&harmonics) / at_rest);
    }
    worst
}

fn factor_of(guard: &Guard, omega: f64) -> Complex {
    Complex::new(guard.displacement, omega * guard.velocity)
}

/// `−min Re Σ G_k e^{ikθ}` over a period.
fn deepest(harmonics: &[(usize, Complex)]) -> f64 {
    if let [(_, amplitude)] = harmonics {
        return amplitude.norm();
    }
    let value = |phase: f64| -> f64 {
        let terms = harmonics.iter();
        -terms
            .map(|(k, g)| (g * Complex::from_polar(1.0, *k as f64 * phase)).re)
            .sum::<f64>()
    };
    let step = TAU / PHASES as f64;
    let best = (0..PHASES)
        .map(|i| i as f64 * step)
        .max_by(|a, b| value(*a).total_cmp(&value(*b)))
        .unwrap_or(0.0);
    let (_, largest) = maximum(best - step, best + step, &value);
    largest
}

/// Frequencies to look at: evenly up to beyond the highest resonance, and densely about each.
fn grid(resonances: &[(f64, f64)]) -> Vec<f64> {
    let highest = resonances.iter().fold(0.0_f64, |a, (w, _)| a.max(*w));
    let top = if highest > 0.0 { 2.5 * highest } else { 10.0 };
    let mut grid: Vec<f64> = (1..=SCAN).map(|i| top * i as f64 / SCAN as f64).collect();
    for (omega, damping) in resonances {
        let width = damping.clamp(1e-6, 0.2);
        grid.extend((-40..=40).map(|i| omega * (1.0 + 0.2 * width * f64::from(i))));
    }
    grid.retain(|omega| *omega > 0.0);
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

/// Largest value of a function with one maximum between two ends, by golden section.
fn maximum(mut left: f64, mut right: f64, value: &dyn Fn(f64) -> f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let mut a = right - GOLDEN * (right - left);
    let mut b = left + GOLDEN * (right - left);
    let (mut at_a, mut at_b) = (value(a), value(b));
    for _ in 0..60 {
        if at_a > at_b {
            (right, b, at_b) = (b, a, at_a);
            a = right - GOLDEN * (right - left);
            at_a = value(a);
        } else {
            (left, a, at_a) = (a, b, at_b);
            b = left + GOLDEN * (right - left);
            at_b = value(b);
        }
    }
    if at_a > at_b { (a, at_a) } else { (b, at_b) }
}

fn worst(grid: &[f64], ratio: &dyn Fn(f64) -> f64) -> (f64, f64) {
    let values: Vec<f64> = grid.iter().map(|omega| ratio(*omega)).collect();
    let best = (0..grid.len())
        .max_by(|&i, &j| values[i].total_cmp(&values[j]))
        .unwrap_or(0);
    let left = grid[best.saturating_sub(1)];
    let right = grid[(best + 1).min(grid.len() - 1)];
    let (omega, value) = maximum(left, right, ratio);
    if value > values[best] {
        (omega, value)
    } else {
        (grid[best], values[best])
    }
}

/// Frequencies at which the ratio passes one: bracketed on the grid, to which the maxima between its points are added.
fn crossings(grid: &[f64], ratio: &dyn Fn(f64) -> f64) -> Vec<f64> {
    let mut points: Vec<(f64, f64)> = grid.iter().map(|omega| (*omega, ratio(*omega))).collect();
    let peaks: Vec<(f64, f64)> = points
        .windows(3)
        .filter(|w| w[1].1 >= w[0].1 && w[1].1 >= w[2].1 && w[1].1 < 1.0)
        .map(|w| maximum(w[0].0, w[2].0, ratio))
        .filter(|(_, value)| *value > 1.0)
        .collect();
    points.extend(peaks);
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
        .windows(2)
        .filter(|pair| (pair[0].1 - 1.0) * (pair[1].1 - 1.0) < 0.0)
        .map(|pair| {
            let (mut left, mut right) = (pair[0].0, pair[1].0);
            let rises = pair[1].1 > 1.0;
            for _ in 0..100 {
                let middle = 0.5 * (left + right);
                if (ratio(middle) > 1.0) == rises {
                    right = middle;
                } else {
                    left = middle;
                }
            }
            0.5 * (left + right)
        })
        .collect()
}
