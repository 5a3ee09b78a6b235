//! `check` of a drive: the steady sheet, and tensions over speed, load or any key in every condition of service.

use super::{InstalledDrive, Place, Places, RPM};
use crate::{Header, Method, Signal, Study, StudyError, Texts};
use serde::Serialize;
use slackside_belt_drive::creep;
use slackside_belt_drive::drive::{Condition, Guide, Mount, SpanEnds};
use slackside_belt_drive::elastica::ElasticaState;
use slackside_belt_drive::steady::SteadyState;
use std::f64::consts::TAU;

/// Sag indicator above which the choice of span ends matters (theory 04 §8.1).
const NOTICEABLE_SAG: f64 = 0.1;
/// Slip safety below which a warning is given.
const LOW_SLIP_SAFETY: f64 = 1.2;
/// Wrap below which a warning is given if the file sets no limit, rad.
const SMALL_WRAP: f64 = 0.25;
/// Strain above which a warning is given.
const LARGE_STRAIN: f64 = 0.015;

/// The question.
#[derive(Debug, Clone)]
pub struct SteadySheet {
    /// Where.
    pub places: Places,
    /// Whether the operating point is computed a second time, by the geometrically exact belt.
    pub cross_check: bool,
}

/// The answer; numbers in SI units, speeds in rpm.
#[derive(Debug, Clone, Serialize)]
pub struct SteadyDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// Kind of the model.
    pub kind: &'static str,
    /// Speed of the driver, rpm.
    pub speed: f64,
    /// The belt.
    pub belt: BeltRow,
    /// The spans in the order of travel.
    pub spans: Vec<SpanRow>,
    /// The pulleys in the order of travel.
    pub pulleys: Vec<PulleyRow>,
    /// The tensioners.
    pub tensioners: Vec<TensionerRow>,
    /// Torque that the driver's shaft supplies, N·m.
    pub driver_torque: f64,
    /// Share of the driver's power that reaches the accessories, by belt creep; absent where a pulley would slip.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub efficiency: Option<f64>,
    /// The operating point by the geometrically exact belt with free contact points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cross_check: Option<SteadyCrossCheck>,
    /// The steady sheet in every condition of service.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub conditions: Vec<ConditionRow>,
    /// What varies, and its unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameter: Option<VariedRow>,
    /// Tensions, arms and hub loads over the varied quantity, one list for each condition, the one as installed first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub over: Vec<FanRow>,
}

/// The operating point by the elastica: bending without approximation, contact points where the belt leaves the pulleys
/// (theory 04 §2.8). What differs is the model of the span ends, not the arithmetic (theory 04 §8.1).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SteadyCrossCheck {
    /// Its method.
    pub method: &'static str,
    /// Tensions of the spans, `H + mc²`, N.
    pub tensions: Vec<f64>,
    /// Positions of the arms, rad or m.
    pub positions: Vec<f64>,
    /// Wrap angles, rad.
    pub wraps: Vec<f64>,
    /// Largest relative difference of the effective tensions.
    pub largest_difference: f64,
}

/// The belt.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BeltRow {
    /// Length of its path along the pitch line, m.
    pub pitch_length: f64,
    /// Natural length, m.
    pub natural_length: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// Centrifugal tension `mc²`, N.
    pub centrifugal_tension: f64,
}

/// A span.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpanRow {
    /// The pulley it leaves.
    pub from: String,
    /// The pulley it meets.
    pub to: String,
    /// Length between the tangent points, m.
    pub length: f64,
    /// Total tension, N.
    pub tension: f64,
    /// Effective tension `P − mc²`, N.
    pub effective_tension: f64,
    /// First natural frequency between fixed ends, Hz.
    pub frequency_1: f64,
    /// Sag indicator `χ`.
    pub sag_indicator: f64,
    /// Ends in the plane, m: where it leaves, where it meets.
    pub ends: [[f64; 2]; 2],
}

/// A pulley.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PulleyRow {
    /// Name.
    pub name: String,
    /// Whether it drives the belt.
    pub driver: bool,
    /// The tensioner that carries it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tensioner: Option<String>,
    /// Centre, m.
    pub center: [f64; 2],
    /// Pitch radius, m.
    pub radius: f64,
    /// Sense of rotation: +1 counter-clockwise, −1 clockwise.
    pub sense: f64,
    /// Wrap angle, rad.
    pub wrap: f64,
    /// Speed relative to the driver's without creep.
    pub ratio: f64,
    /// Speed without creep, rpm.
    pub speed: f64,
    /// Speed with creep, rpm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_with_creep: Option<f64>,
    /// Speed lost by creep, as a share.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_loss: Option<f64>,
    /// Slip arc, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip_arc: Option<f64>,
    /// Load torque, N·m; of the driver what it supplies.
    pub torque: f64,
    /// Force of the belt on the pulley, N.
    pub hub_load: [f64; 2],
    /// Its magnitude, N.
    pub hub_load_magnitude: f64,
    /// Its direction from the first axis, rad.
    pub hub_load_direction: f64,
    /// Safety against gross slip; absent without a load.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip_safety: Option<f64>,
    /// Torque at which the belt would slip all round with the present tension on the pulley's slack side, N·m.
    pub slip_torque: f64,
}

/// A tensioner.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TensionerRow {
    /// Name.
    pub name: String,
    /// `rotary` or `linear`.
    pub kind: &'static str,
    /// Angle of a rotary arm, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Position of a slide, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<f64>,
    /// Way from the reference position, rad or m.
    pub travel: f64,
    /// Belt length that it takes up per unit of its motion, m/rad or 1.
    pub take_up: f64,
    /// Torque or force of its spring, positive where it tightens the belt.
    pub torque: f64,
    /// Pivot of a rotary arm, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pivot: Option<[f64; 2]>,
    /// Stops, rad or m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stops: Option<[f64; 2]>,
    /// Direction of a slide.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 2]>,
}

/// The drive in a condition of service.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConditionRow {
    /// Its name.
    pub name: String,
    /// What it gives, or why it is not possible.
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// What a condition gives.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Outcome {
    /// Tensions and arms.
    State(StateRow),
    /// Why there is no steady state.
    Impossible {
        /// The reason.
        impossible: String,
    },
}

/// Tensions, hub loads and arms of one steady state.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateRow {
    /// Total tensions by span, N.
    pub tensions: Vec<f64>,
    /// Effective tensions by span, N.
    pub effective_tensions: Vec<f64>,
    /// Hub loads by pulley, N.
    pub hub_loads: Vec<[f64; 2]>,
    /// Slip safeties by pulley; absent where there is no load.
    pub slip_safeties: Vec<Option<f64>>,
    /// Wrap angles by pulley, rad.
    pub wraps: Vec<f64>,
    /// Positions of the arms, rad or m.
    pub positions: Vec<f64>,
}

/// What varies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VariedRow {
    /// `speed`, or a key of the file.
    pub key: String,
    /// Unit of its values.
    pub unit: String,
}

/// One condition over the varied quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FanRow {
    /// Name of the condition.
    pub name: String,
    /// Values of the varied quantity.
    pub values: Vec<f64>,
    /// What each gives.
    pub outcomes: Vec<Outcome>,
}

/// What one job gives.
pub enum Piece {
    /// The sheet.
    Sheet(Box<SteadyDocument>),
    /// One value in all conditions.
    Value(f64, Vec<Outcome>),
}

impl Study for SteadySheet {
    type Job = Place;
    type Rows = Piece;
    type Document = SteadyDocument;

    fn plan(&self) -> Result<Vec<Place>, StudyError> {
        if self.places.key() == "frequency" {
            return Err(StudyError::question(
                "--over",
                "the steady state does not depend on a frequency; vary speed or a key of the file",
            ));
        }
        let mut jobs = vec![self.places.operating_point()];
        jobs.extend(self.places.values());
        Ok(jobs)
    }

    fn run(&self, job: &Place, _: &Signal) -> Result<Piece, StudyError> {
        match job.value {
            None => {
                let mut sheet = self.sheet(*job)?;
                if self.cross_check {
                    self.add_cross_check(*job, &mut sheet)?;
                }
                Ok(Piece::Sheet(Box::new(sheet)))
            }
            Some(value) => {
                let outcomes = match self.places.drive(*job) {
                    Ok(drive) => self
                        .conditions()
                        .iter()
                        .map(|condition| outcome(&drive, condition))
                        .collect(),
                    Err(error @ StudyError::NoAnswer(_)) => {
                        let impossible = Outcome::Impossible {
                            impossible: error.to_string(),
                        };
                        vec![impossible; self.conditions().len()]
                    }
                    Err(other) => return Err(other),
                };
                Ok(Piece::Value(value, outcomes))
            }
        }
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Piece, StudyError>>>,
        interrupted: bool,
    ) -> Result<SteadyDocument, StudyError> {
        let mut sheet = None;
        let mut fan: Vec<FanRow> = self
            .conditions()
            .into_iter()
            .map(|condition| FanRow {
                name: condition.name,
                values: Vec::new(),
                outcomes: Vec::new(),
            })
            .collect();
        for row in rows.into_iter().flatten() {
            match row? {
                Piece::Sheet(document) => sheet = Some(*document),
                Piece::Value(value, outcomes) => {
                    for (row, outcome) in fan.iter_mut().zip(outcomes) {
                        row.values.push(value);
                        row.outcomes.push(outcome);
                    }
                }
            }
        }
        let mut document = sheet.ok_or(StudyError::Interrupted)?;
        if self.places.over.is_some() {
            document.parameter = Some(VariedRow {
                key: self.places.key().to_owned(),
                unit: self.places.unit().to_owned(),
            });
            document.over = fan;
            document.warn_of_impossible();
        }
        if interrupted {
            document.header.warnings.push("interrupted".to_owned());
        }
        Ok(document)
    }
}

impl SteadyDocument {
    /// A warning for every condition that is impossible somewhere, with the first reason.
    fn warn_of_impossible(&mut self) {
        let key = self.parameter.as_ref().map_or("", |parameter| &parameter.key);
        for row in &self.over {
            let failures: Vec<(f64, &str)> = row
                .values
                .iter()
                .zip(&row.outcomes)
                .filter_map(|(value, outcome)| match outcome {
                    Outcome::Impossible { impossible } => Some((*value, &**impossible)),
                    Outcome::State(_) => None,
                })
                .collect();
            if let Some((value, reason)) = failures.first() {
                self.header.warnings.push(format!(
                    "{}: {} of {} values of {key} are impossible, the first at {value}: {reason}",
                    row.name,
                    failures.len(),
                    row.values.len()
                ));
            }
        }
    }
}

impl SteadySheet {
    /// The drive as installed, then the conditions of the file.
    fn conditions(&self) -> Vec<Condition> {
        let mut conditions = vec![Condition::nominal("as installed")];
        if let Some(file) = self.places.subject().model.drive() {
            conditions.extend(file.conditions());
        }
        conditions
    }

    /// Warns of wraps below the limit of the file.
    fn warn_of_wraps(&self, header: &mut Header, rows: &[PulleyRow]) {
        let Some(file) = self.places.subject().model.drive() else {
            return;
        };
        for (pulley, row) in file.pulleys.iter().zip(rows) {
            let limit = pulley.minimum_wrap.unwrap_or(SMALL_WRAP);
            if row.wrap < limit {
                header.warnings.push(format!(
                    "\"{}\": the belt wraps it by only {:.1}°, less than {:.1}°; move it or an idler beside it",
                    row.name,
                    row.wrap.to_degrees(),
                    limit.to_degrees()
                ));
            }
        }
    }

    fn add_cross_check(&self, place: Place, sheet: &mut SteadyDocument) -> Result<(), StudyError> {
        let at = self.places.drive(place)?;
        match ElasticaState::solve(&at.drive, at.driver_speed) {
            Ok(exact) => {
                let centrifugal = sheet.belt.centrifugal_tension;
                let differences = sheet
                    .spans
                    .iter()
                    .zip(&exact.spans)
                    .map(|(span, exact)| (span.effective_tension / exact.force - 1.0).abs());
                sheet.cross_check = Some(SteadyCrossCheck {
                    method: "geometrically exact belt with free contact points",
                    largest_difference: differences.fold(0.0, f64::max),
                    tensions: exact.spans.iter().map(|span| span.force + centrifugal).collect(),
                    positions: exact.positions,
                    wraps: exact.wraps,
                });
            }
            Err(error) => sheet
                .header
                .warnings
                .push(format!("no cross-check by the geometrically exact belt: {error}")),
        }
        Ok(())
    }

    /// The sheet at one place.
    ///
    /// # Errors
    /// [`StudyError`].
    pub(super) fn sheet(&self, place: Place) -> Result<SteadyDocument, StudyError> {
        let at = self.places.drive(place)?;
        let state = at.steady(at.driver_speed)?;
        let drive = &at.drive;
        let method = Method::new("steady state, Newton's iteration on the closed-form equilibrium")
            .with("belt_model", drive.belt.model.name())
            .with("span_ends", drive.belt.span_ends.name())
            .with("arc_stretch", drive.belt.arc_stretch.name());
        let mut header = self.places.subject().header("check", method);
        header.units.measures = units();
        let creep = match creep::steady_creep(drive, &state) {
            Ok(creep) => Some(creep),
            Err(error) => {
                header.warnings.push(error.to_string());
                None
            }
        };
        let spans: Vec<SpanRow> = (0..drive.pulleys.len())
            .map(|i| span_row(&at, &state, i))
            .collect();
        let pulleys: Vec<PulleyRow> = (0..drive.pulleys.len())
            .map(|j| pulley_row(&at, &state, creep.as_ref(), j))
            .collect();
        warn(&mut header, &at, &spans, &pulleys);
        self.warn_of_wraps(&mut header, &pulleys);
        let conditions = self
            .conditions()
            .iter()
            .skip(1)
            .map(|condition| ConditionRow {
                name: condition.name.clone(),
                outcome: outcome(&at, condition),
            })
            .collect();
        Ok(SteadyDocument {
            header,
            kind: self.places.subject().model.kind(),
            speed: at.driver_speed / RPM,
            belt: BeltRow {
                pitch_length: state.layout.pitch_length,
                natural_length: state.natural_length,
                speed: state.belt_speed,
                centrifugal_tension: state.tensions[0] - state.effective_tensions[0],
            },
            spans,
            pulleys,
            tensioners: (0..drive.tensioners.len())
                .map(|arm| tensioner_row(&at, &state, arm))
                .collect(),
            driver_torque: state.driver_torque,
            efficiency: creep.and_then(|creep| creep.efficiency),
            cross_check: None,
            conditions,
            parameter: None,
            over: Vec::new(),
        })
    }
}

/// Units of the document's numbers by key.
fn units() -> Texts {
    let units = [
        ("speed", "rpm"),
        ("belt.speed", "m/s"),
        ("length", "m"),
        ("tension", "N"),
        ("frequency_1", "Hz"),
        ("wrap", "rad"),
        ("torque", "N m"),
        ("hub_load", "N"),
        ("angle", "rad"),
        ("take_up", "m/rad"),
    ];
    Texts(units.map(|(key, unit)| (key.to_owned(), unit.to_owned())).into())
}

fn warn(header: &mut Header, at: &InstalledDrive, spans: &[SpanRow], pulleys: &[PulleyRow]) {
    for pulley in pulleys {
        if let Some(safety) = pulley.slip_safety
            && safety < LOW_SLIP_SAFETY
        {
            header.warnings.push(format!(
                "\"{}\": safety against slip is only {safety:.2}; raise the tension, the wrap or the friction",
                pulley.name
            ));
        }
    }
    let strain = spans
        .iter()
        .map(|span| span.tension / at.drive.belt.axial_stiffness)
        .fold(0.0, f64::max);
    if strain > LARGE_STRAIN {
        header.warnings.push(format!(
            "the belt is stretched by {:.1} %, more than belts bear for long; take a longer belt or lower the tension",
            100.0 * strain
        ));
    }
    let largest = spans.iter().map(|span| span.sag_indicator).fold(0.0, f64::max);
    if largest > NOTICEABLE_SAG && at.drive.belt.span_ends == SpanEnds::Tangent {
        header.warnings.push(format!(
            "the sag indicator χ reaches {largest:.2}: with `span_ends = \"tangent\"` bending softens the belt more than it \
             does in a real drive; for design work set `belt.span_ends = \"contact\"`"
        ));
    }
}

fn span_row(at: &InstalledDrive, state: &SteadyState, i: usize) -> SpanRow {
    let geometry = &state.layout.spans[i];
    SpanRow {
        from: at.drive.pulleys[i].name.clone(),
        to: at.drive.pulleys[at.drive.next(i)].name.clone(),
        length: geometry.length,
        tension: state.tensions[i],
        effective_tension: state.effective_tensions[i],
        frequency_1: state.span_frequency(&at.drive, i) / TAU,
        sag_indicator: state.sag_indicator(&at.drive, i),
        ends: [geometry.start.into(), geometry.end.into()],
    }
}

fn pulley_row(at: &InstalledDrive, state: &SteadyState, creep: Option<&creep::Creep>, j: usize) -> PulleyRow {
    let drive = &at.drive;
    let pulley = &drive.pulleys[j];
    let force = state.belt_forces[j];
    let ratio = drive.pulleys[drive.driver].radius / pulley.radius;
    let creep = creep.map(|creep| &creep.pulleys[j]);
    let loss = creep.map(|creep| creep.speed_loss);
    PulleyRow {
        name: pulley.name.clone(),
        driver: j == drive.driver,
        tensioner: match pulley.mount {
            Mount::Fixed(_) => None,
            Mount::Carried { tensioner, .. } => Some(drive.tensioners[tensioner].name.clone()),
        },
        center: state.layout.centres[j].into(),
        radius: pulley.radius,
        sense: pulley.sense.sign(),
        wrap: state.layout.wraps[j],
        ratio,
        speed: at.driver_speed / RPM * ratio,
        speed_with_creep: loss.map(|loss| at.driver_speed / RPM * ratio * (1.0 - loss)),
        speed_loss: loss,
        slip_arc: creep.map(|creep| creep.contact.slip_arc),
        torque: if j == drive.driver {
            state.driver_torque
        } else {
            state.loads[j]
        },
        hub_load: force.into(),
        hub_load_magnitude: force.length(),
        hub_load_direction: force.to_angle(),
        slip_safety: finite(state.slip_safety(drive, j)),
        slip_torque: state.slip_torque(drive, j),
    }
}

fn tensioner_row(at: &InstalledDrive, state: &SteadyState, arm: usize) -> TensionerRow {
    let tensioner = &at.drive.tensioners[arm];
    let position = state.positions[arm];
    let take_up = state.kinematics.take_up[arm];
    let (kind, angle, place, pivot, direction) = match tensioner.guide {
        Guide::Rotary { pivot } => ("rotary", Some(position), None, Some(pivot.into()), None),
        Guide::Linear { direction } => ("linear", None, Some(position), None, Some(direction.into())),
    };
    TensionerRow {
        name: tensioner.name.clone(),
        kind,
        angle,
        position: place,
        travel: position - tensioner.reference,
        take_up,
        torque: (if tensioner.locked {
            state.holding_torques[arm]
        } else {
            state.spring_torques[arm]
        }) * take_up.signum(),
        pivot,
        stops: tensioner.stops,
        direction,
    }
}

fn outcome(at: &InstalledDrive, condition: &Condition) -> Outcome {
    let (drive, installed) = at.installed.in_condition(&at.drive, condition);
    match SteadyState::solve(&drive, &installed, at.driver_speed) {
        Err(error) => Outcome::Impossible {
            impossible: error.to_string(),
        },
        Ok(state) => Outcome::State(StateRow {
            hub_loads: state.belt_forces.iter().map(|force| [force.x, force.y]).collect(),
            slip_safeties: (0..drive.pulleys.len())
                .map(|j| finite(state.slip_safety(&drive, j)))
                .collect(),
            wraps: state.layout.wraps,
            tensions: state.tensions,
            effective_tensions: state.effective_tensions,
            positions: state.positions,
        }),
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
