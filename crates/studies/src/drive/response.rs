//! Linear response of a drive to the orders of its excitation, over speed, frequency or any key (theory 04 §3.7, §3.8).

use super::steady::VariedRow;
use super::{InstalledDrive, Place, Places};
use crate::{Header, Method, Signal, Study, StudyError, Texts, pair};
use serde::Serialize;
use serde::ser::SerializeMap;
use slackside_belt_drive::drive::Excitation;
use slackside_belt_drive::forced_response::{HarmonicLoad, forced_response};
use slackside_belt_drive::model::{Coordinate, LinearModel, Motion};
use slackside_belt_drive::steady::SteadyState;
use slackside_linalg::Complex;
use std::f64::consts::TAU;

/// Samples of a revolution of the driver from which extremes are taken.
const SAMPLES: usize = 128;
/// Most revolutions after which the excitation is taken to repeat.
const MOST_REVOLUTIONS: usize = 24;

/// The question.
#[derive(Debug, Clone)]
pub struct DriveResponse {
    /// Where.
    pub places: Places,
}

/// The answer; numbers in SI units, speeds in rpm.
#[derive(Debug, Clone, Serialize)]
pub struct DriveResponseDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// What varies.
    pub parameter: VariedRow,
    /// Orders of the excitation.
    pub orders: Vec<f64>,
    /// The response at every value that has one.
    pub points: Vec<ResponseRow>,
}

/// The response at one value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResponseRow {
    /// The value.
    pub value: f64,
    /// Speed of the driver, rpm.
    pub speed: f64,
    /// The measures by name.
    #[serde(serialize_with = "by_name")]
    pub measures: Vec<OrderMeasureRow>,
}

/// One measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OrderMeasureRow {
    /// Its name.
    #[serde(skip)]
    pub name: String,
    /// Unit.
    #[serde(skip)]
    pub unit: &'static str,
    /// Mean: the steady value.
    pub mean: f64,
    /// Root mean square about the mean.
    pub rms: f64,
    /// Largest value.
    pub max: f64,
    /// Smallest value.
    pub min: f64,
    /// Complex amplitudes in the order of the document's `orders`; none for what is not linear in the motion.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub orders: Vec<[f64; 2]>,
}

fn by_name<S: serde::Serializer>(measures: &[OrderMeasureRow], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(measures.len()))?;
    for measure in measures {
        map.serialize_entry(&measure.name, measure)?;
    }
    map.end()
}

/// What one job gives.
pub struct Found {
    value: f64,
    outcome: Result<ResponseRow, String>,
    violations: Vec<Violation>,
}

/// What a real belt would do where the linear model goes on (theory 04 §8.4).
#[derive(Debug, Clone, PartialEq)]
enum Violation {
    /// A span, by name, loses its tension.
    Slack(String),
    /// The belt slips on a pulley.
    Slip(String),
}

impl DriveResponse {
    /// The question, checked.
    ///
    /// # Errors
    /// [`StudyError::Question`] without a range or without an excitation.
    pub fn new(places: Places) -> Result<Self, StudyError> {
        if places.over.is_none() {
            return Err(StudyError::question(
                "--over",
                "give a range, for example --over speed=600:6000",
            ));
        }
        let drive = places.drive(places.operating_point())?;
        if drive.excitation.orders().is_empty() {
            return Err(StudyError::question(
                "FILE",
                "nothing shakes the drive; add `[excitation]` with `motion = [{ order = 2, amplitude = \"0.5 deg\" }]`",
            ));
        }
        Ok(Self { places })
    }
}

impl Study for DriveResponse {
    type Job = Place;
    type Rows = Found;
    type Document = DriveResponseDocument;

    fn plan(&self) -> Result<Vec<Place>, StudyError> {
        Ok(self.places.values())
    }

    fn run(&self, job: &Place, _: &Signal) -> Result<Found, StudyError> {
        let value = job.value.unwrap_or_default();
        let found = self.places.drive(*job).and_then(|at| self.row(*job, value, &at));
        match found {
            Ok((row, violations)) => Ok(Found {
                value,
                outcome: Ok(row),
                violations,
            }),
            Err(StudyError::NoAnswer(reason)) => Ok(Found {
                value,
                outcome: Err(reason),
                violations: Vec::new(),
            }),
            Err(StudyError::Linalg(error)) => Ok(Found {
                value,
                outcome: Err(format!("an undamped resonance ({error})")),
                violations: Vec::new(),
            }),
            Err(other) => Err(other),
        }
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Found, StudyError>>>,
        interrupted: bool,
    ) -> Result<DriveResponseDocument, StudyError> {
        let at = self.places.drive(self.places.operating_point())?;
        let belt = &at.drive.belt;
        let method = Method::new("linear response by orders")
            .with("belt_model", belt.model.name())
            .with("terms_per_span", belt.terms.clone())
            .with("static_correction", belt.static_correction)
            .with("samples_per_revolution", SAMPLES);
        let mut header = self.places.subject().header("response", method);
        let (mut points, mut failures) = (Vec::new(), Vec::new());
        let mut violations: Vec<(f64, Violation)> = Vec::new();
        for row in rows.into_iter().flatten() {
            let found = row?;
            let here = found.violations.into_iter();
            violations.extend(here.map(|violation| (found.value, violation)));
            match found.outcome {
                Ok(row) => points.push(row),
                Err(reason) => failures.push((found.value, reason)),
            }
        }
        let key = self.places.key();
        let slack = told(
            &violations,
            key,
            "the belt goes slack, which the linear model does not see",
            &|violation| match violation {
                Violation::Slack(span) => Some(span),
                Violation::Slip(_) => None,
            },
        );
        let slip = told(
            &violations,
            key,
            "the belt would slip, where the linear model lets it stick",
            &|violation| match violation {
                Violation::Slip(pulley) => Some(pulley),
                Violation::Slack(_) => None,
            },
        );
        header.warnings.extend(slack.into_iter().chain(slip));
        if let Some((value, reason)) = failures.first() {
            if points.is_empty() {
                return Err(StudyError::NoAnswer(format!("{key} = {value}: {reason}")));
            }
            header.warnings.push(format!(
                "{} values of {key} have no response, the first is {value}: {reason}",
                failures.len()
            ));
        }
        if points.is_empty() {
            return Err(StudyError::Interrupted);
        }
        if interrupted {
            header.warnings.push("interrupted".to_owned());
        }
        header.units.measures = Texts(
            points[0]
                .measures
                .iter()
                .map(|measure| (measure.name.clone(), measure.unit.to_owned()))
                .collect(),
        );
        Ok(DriveResponseDocument {
            header,
            parameter: VariedRow {
                key: key.to_owned(),
                unit: self.places.unit().to_owned(),
            },
            orders: at.excitation.orders().iter().map(|order| order.order).collect(),
            points,
        })
    }
}

/// One warning for all violations of a kind: where each happens first, and at how many values.
fn told(
    violations: &[(f64, Violation)],
    key: &str,
    what: &str,
    name_of: &dyn Fn(&Violation) -> Option<&String>,
) -> Option<String> {
    let mut places: Vec<(&String, f64, usize)> = Vec::new();
    for (value, violation) in violations {
        let Some(name) = name_of(violation) else {
            continue;
        };
        match places.iter_mut().find(|(known, _, _)| *known == name) {
            Some((_, _, count)) => *count += 1,
            None => places.push((name, *value, 1)),
        }
    }
    let list: Vec<String> = places
        .iter()
        .map(|(name, first, count)| format!("{name} ({count} values of {key}, from {first})"))
        .collect();
    (!list.is_empty()).then(|| format!("{what}: {}", list.join(", ")))
}

impl DriveResponse {
    fn row(
        &self,
        place: Place,
        value: f64,
        at: &InstalledDrive,
    ) -> Result<(ResponseRow, Vec<Violation>), StudyError> {
        let state = at.steady(at.driver_speed)?;
        let model = LinearModel::new(&at.drive, &state);
        let base = self.places.order_frequency(place, at);
        if base <= 0.0 {
            return Err(StudyError::NoAnswer(
                "at rest the excitation has no frequency".to_owned(),
            ));
        }
        let by_torque = matches!(at.excitation, Excitation::Torque(_));
        let mut motions = Vec::new();
        for order in at.excitation.orders() {
            let (amplitude, phase) = order.at(at.driver_speed);
            let amplitude = Complex::from_polar(amplitude, phase);
            let load = if by_torque {
                HarmonicLoad::DriverTorque(amplitude)
            } else {
                HarmonicLoad::DriverRotation(amplitude)
            };
            motions.push(forced_response(&at.drive, &model, order.order * base, load)?);
        }
        let orders: Vec<f64> = at.excitation.orders().iter().map(|order| order.order).collect();
        let reader = Reader {
            at,
            state: &state,
            model: &model,
            motions: &motions,
            times: times(&orders),
            orders,
        };
        let (measures, violations) = reader.measures();
        Ok((
            ResponseRow {
                value,
                speed: at.driver_speed / super::RPM,
                measures,
            },
            violations,
        ))
    }
}

/// Angles of order 1 at which the motion is sampled: over the revolutions after which it repeats.
fn times(orders: &[f64]) -> Vec<f64> {
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
struct Reader<'a> {
    at: &'a InstalledDrive,
    state: &'a SteadyState,
    model: &'a LinearModel,
    motions: &'a [Motion],
    orders: Vec<f64>,
    times: Vec<f64>,
}

impl Reader<'_> {
    fn measures(&self) -> (Vec<OrderMeasureRow>, Vec<Violation>) {
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
