//! Measures of a motion that is the sum of the responses to all orders (theory 04 §3.8).

use super::document::OrderMeasureRow;
use crate::drive::InstalledDrive;
use crate::pair;
use slackside_belt_drive::model::{Coordinate, LinearModel, Motion};
use slackside_belt_drive::steady::SteadyState;
use slackside_linalg::Complex;
use std::f64::consts::TAU;

/// Samples of a revolution of the driver from which extremes are taken.
pub(super) const SAMPLES: usize = 128;
/// Most revolutions after which the excitation is taken to repeat.
const MOST_REVOLUTIONS: usize = 24;

/// What a real belt would do where the linear model goes on (theory 04 §8.4).
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Violation {
    /// A span, by name, loses its tension.
    Slack(String),
    /// The belt slips on a pulley.
    Slip(String),
}

/// Angles of order 1 at which the motion is sampled: over the revolutions after which it repeats.
pub(super) fn times(orders: &[f64]) -> Vec<f64> {
    let repeats = |revolutions: &usize| {
        orders.iter().all(|order| {
            let turns = order * *revolutions as f64;
            (turns - turns.round()).abs() < 1e-9
        })
    };
    let revolutions = (1..=MOST_REVOLUTIONS).find(repeats).unwrap_or(MOST_REVOLUTIONS);
    let highest = orders.iter().copied().fold(1.0, f64::max);
    let count = (SAMPLES as f64 * revolutions as f64 * highest.ceil()) as usize;
    (0..count)
        .map(|k| TAU * revolutions as f64 * k as f64 / count as f64)
        .collect()
}

/// Reads measures from the motions of all orders.
pub(super) struct Reader<'a> {
    pub at: &'a InstalledDrive,
    pub state: &'a SteadyState,
    pub model: &'a LinearModel,
    pub motions: &'a [Motion],
    pub orders: Vec<f64>,
    pub times: Vec<f64>,
}

impl Reader<'_> {
    /// All measures, and where a real belt would behave otherwise.
    pub fn measures(&self) -> (Vec<OrderMeasureRow>, Vec<Violation>) {
        let drive = &self.at.drive;
        let mut rows = Vec::new();
        let mut violations = Vec::new();
        for (index, coordinate) in self.model.coordinates.iter().enumerate() {
            let of_coordinate = self.amplitudes(&|motion| motion.amplitudes[index]);
            match coordinate {
                Coordinate::Sine { .. } => {}
                Coordinate::Arm(arm) => {
                    let name = self.model.coordinates.name(drive, index);
                    let unit = if drive.tensioners[arm].guide.position_unit() == "m" {
                        "m"
                    } else {
                        "rad"
                    };
                    rows.push(self.linear(name, unit, self.state.positions[arm], of_coordinate));
                }
                Coordinate::Pulley(_) | Coordinate::Accessory(_) => {
                    let name = self.model.coordinates.name(drive, index);
                    rows.push(self.linear(name, "rad", 0.0, of_coordinate));
                }
            }
        }
        for j in 0..drive.pulleys.len() {
            if let Some(accessory) = self.model.coordinates.accessory(j) {
                let windup = self.amplitudes(&|motion| motion.amplitudes[j] - motion.amplitudes[accessory]);
                let name = format!("windup.{}", drive.pulleys[j].name);
                rows.push(self.linear(name, "rad", 0.0, windup));
            }
        }
        let tensions: Vec<Vec<Complex>> = (0..drive.pulleys.len())
            .map(|i| self.amplitudes(&|motion| self.model.dynamic_tension(motion, i)))
            .collect();
        for (i, amplitudes) in tensions.iter().enumerate() {
            let name = format!("tension.{}", drive.span_name(i));
            let row = self.linear(name, "N", self.state.tensions[i], amplitudes.clone());
            let centrifugal = self.state.tensions[i] - self.state.effective_tensions[i];
            if row.min < centrifugal {
                violations.push(Violation::Slack(drive.span_name(i)));
            }
            rows.push(row);
        }
        for i in 0..drive.pulleys.len() {
            rows.extend(self.deflection(i));
        }
        for j in 0..drive.pulleys.len() {
            rows.push(self.hub_load(j));
            if let Some(row) = self.slip_safety(j, &tensions) {
                if row.min < 1.0 {
                    violations.push(Violation::Slip(drive.pulleys[j].name.clone()));
                }
                rows.push(row);
            }
        }
        (rows, violations)
    }

    fn amplitudes(&self, value: &dyn Fn(&Motion) -> Complex) -> Vec<Complex> {
        self.motions.iter().map(value).collect()
    }

    /// `Re Σ â_o e^{ioϑ}` at all sampled angles.
    fn sampled(&self, amplitudes: &[Complex]) -> Vec<f64> {
        self.times
            .iter()
            .map(|angle| {
                amplitudes
                    .iter()
                    .zip(&self.orders)
                    .map(|(amplitude, order)| (amplitude * Complex::from_polar(1.0, order * angle)).re)
                    .sum()
            })
            .collect()
    }

    fn linear(
        &self,
        name: String,
        unit: &'static str,
        mean: f64,
        amplitudes: Vec<Complex>,
    ) -> OrderMeasureRow {
        let samples = self.sampled(&amplitudes);
        let square: f64 = amplitudes
            .iter()
            .map(|amplitude| 0.5 * amplitude.norm_sqr())
            .sum();
        let (min, max) = extremes(&samples);
        OrderMeasureRow {
            name,
            unit,
            mean,
            rms: square.sqrt(),
            max: mean + max,
            min: mean + min,
            orders: amplitudes.iter().map(pair).collect(),
        }
    }

    /// The displacement of the middle of a span, and its root mean square along the span.
    fn deflection(&self, span: usize) -> Vec<OrderMeasureRow> {
        let drive = &self.at.drive;
        if self.model.coordinates.sines(span).is_empty() {
            return Vec::new();
        }
        let middle = 0.5 * self.state.layout.spans[span].length;
        let motions: Vec<_> = self
            .motions
            .iter()
            .map(|motion| self.model.span_motion(self.state, motion, span))
            .collect();
        let name = drive.span_name(span);
        let at_middle = motions.iter().map(|motion| motion.at(middle)).collect();
        let means: Vec<f64> = motions.iter().map(|motion| motion.mean_amplitude()).collect();
        let rms = means.iter().map(|mean| 0.5 * mean * mean).sum::<f64>().sqrt();
        vec![
            self.linear(format!("deflection.{name}"), "m", 0.0, at_middle),
            OrderMeasureRow {
                name: format!("deflection_along.{name}"),
                unit: "m",
                mean: 0.0,
                rms,
                // Amplitudes along the span at their largest together: a bound.
                max: means.iter().sum(),
                min: -means.iter().sum::<f64>(),
                orders: means.iter().map(|mean| [*mean, 0.0]).collect(),
            },
        ]
    }

    /// The magnitude of the hub load, which is not linear in the motion.
    fn hub_load(&self, pulley: usize) -> OrderMeasureRow {
        let drive = &self.at.drive;
        let force = self.state.belt_forces[pulley];
        let component = |axis: usize| {
            let amplitudes = self
                .amplitudes(&|motion| self.model.dynamic_hub_load(drive, self.state, motion, pulley)[axis]);
            self.sampled(&amplitudes)
        };
        let (x, y) = (component(0), component(1));
        let magnitudes: Vec<f64> = x
            .iter()
            .zip(&y)
            .map(|(dx, dy)| (force.x + dx).hypot(force.y + dy))
            .collect();
        sampled_row(
            format!("hub_load.{}", drive.pulleys[pulley].name),
            "N",
            &magnitudes,
        )
    }

    /// Safety against slip with the instantaneous tensions, capped where there is no difference of tensions; `None` where
    /// a span goes slack.
    fn slip_safety(&self, pulley: usize, tensions: &[Vec<Complex>]) -> Option<OrderMeasureRow> {
        /// Larger safeties are as good as this one.
        const ENOUGH: f64 = 100.0;
        let drive = &self.at.drive;
        let before = drive.span_before(pulley);
        let grip = drive.pulleys[pulley].friction * self.state.layout.wraps[pulley];
        let effective = |span: usize| -> Vec<f64> {
            let steady = self.state.effective_tensions[span];
            let dynamic = self.sampled(&tensions[span]);
            dynamic.into_iter().map(|value| steady + value).collect()
        };
        let safeties: Option<Vec<f64>> = effective(before)
            .iter()
            .zip(effective(pulley))
            .map(|(left, right)| {
                let taut = *left > 0.0 && right > 0.0;
                taut.then(|| (grip / (left / right).ln().abs()).min(ENOUGH))
            })
            .collect();
        let name = format!("slip_safety.{}", drive.pulleys[pulley].name);
        Some(sampled_row(name, "–", &safeties?))
    }
}

fn sampled_row(name: String, unit: &'static str, samples: &[f64]) -> OrderMeasureRow {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let square = samples.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    let (min, max) = extremes(samples);
    OrderMeasureRow {
        name,
        unit,
        mean,
        rms: square.sqrt(),
        max,
        min,
        orders: Vec::new(),
    }
}

fn extremes(samples: &[f64]) -> (f64, f64) {
    samples
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(*value), high.max(*value))
        })
}
