//! What is read from the motion of a drive: rotations, arms, tensions, hub loads, deflections, torques (theory 04 §3.8).

use super::reduction::{DriverMotion, Reduction};
use super::row::{Row, RowReader};
use super::tensioners::{Role, contact_name, loading_sense};
use super::{DriveSystemError, couplings};
use crate::drive::{Coupling, Drive};
use crate::model::{Coordinate, LinearModel};
use crate::steady::SteadyState;
use slackside_linalg::Matrix;
use slackside_mechanics::{Output, System};
use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};

/// Displacement of a sine that is none, rounding errors apart.
const NODE: f64 = 1e-12;

/// Unit and steady value of a measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// Unit in SI: `rad`, `rad/s`, `m`, `m/s`, `N`, `N m`.
    pub unit: &'static str,
    /// What the measure is in the steady state beyond what it says: total = steady + measure. Zero for measures that are
    /// totals themselves (torques of couplings and friction, wind-ups).
    pub steady: f64,
}

/// The displacement along a span: the squares of these measures add up to its mean square over the span's length
/// (theory 05 §5.7).
#[derive(Debug, Clone, PartialEq)]
pub struct SpanAverage {
    /// Name of the span.
    pub span: String,
    /// Rows, m.
    pub rows: Vec<Output>,
}

pub(super) struct Reader<'a> {
    drive: &'a Drive,
    steady: &'a SteadyState,
    model: &'a LinearModel,
    reduction: &'a Reduction,
    system: &'a System,
    rows: RowReader<'a>,
}

/// Measures in the order in which they are made.
struct List<'r, 'a> {
    rows: &'r RowReader<'a>,
    frequency: f64,
    outputs: Vec<Output>,
    measures: Vec<Measure>,
}

impl List<'_, '_> {
    fn push(&mut self, name: String, unit: &'static str, steady: f64, row: &Row) {
        self.outputs.push(self.rows.output(name, row, self.frequency));
        self.measures.push(Measure { unit, steady });
    }
}

impl<'a> Reader<'a> {
    pub fn new(
        drive: &'a Drive,
        steady: &'a SteadyState,
        model: &'a LinearModel,
        reduction: &'a Reduction,
        system: &'a System,
    ) -> Result<Self, DriveSystemError> {
        Ok(Self {
            drive,
            steady,
            model,
            reduction,
            system,
            rows: RowReader::new(reduction, system)?,
        })
    }

    /// All measures, with unit and steady value.
    pub fn measures(&self, frequency: f64) -> (Vec<Output>, Vec<Measure>) {
        let mut list = List {
            rows: &self.rows,
            frequency,
            outputs: Vec::new(),
            measures: Vec::new(),
        };
        self.coordinates(&mut list);
        self.couplings(&mut list);
        self.tensioners(&mut list);
        for i in 0..self.drive.pulleys.len() {
            let name = format!("tension.{}", self.drive.span_name(i));
            list.push(name, "N", self.steady.tensions[i], &self.tension(i));
        }
        for i in 0..self.drive.pulleys.len() {
            if !self.model.coordinates.sines(i).is_empty() {
                let name = format!("deflection.{}", self.drive.span_name(i));
                list.push(name, "m", 0.0, &self.deflection(i, 0.5));
            }
        }
        for j in 0..self.drive.pulleys.len() {
            let force = self.steady.belt_forces[j];
            let name = &self.drive.pulleys[j].name;
            let [x, y] = self.hub_load(j);
            list.push(format!("hub_load.{name}.x"), "N", force.x, &x);
            list.push(format!("hub_load.{name}.y"), "N", force.y, &y);
        }
        self.sines(&mut list);
        (list.outputs, list.measures)
    }

    /// Rotations, arms and their rates. A rotation that drifts has a rate only: that of an accessory that may overrun for
    /// good, and all of them if the driver turns freely against damping alone.
    fn coordinates(&self, list: &mut List<'_, '_>) {
        for (index, coordinate) in self.model.coordinates.iter().enumerate() {
            let name = self.model.coordinates.name(self.drive, index);
            let (unit, rate_unit, steady, drifts) = match coordinate {
                Coordinate::Pulley(_) => ("rad", "rad/s", 0.0, self.reduction.driver == DriverMotion::Damped),
                Coordinate::Accessory(j) => (
                    "rad",
                    "rad/s",
                    0.0,
                    self.reduction.driver == DriverMotion::Damped
                        || matches!(
                            self.drive.pulleys[j].coupling,
                            Coupling::OneWay { .. } | Coupling::Decoupler { .. }
                        ),
                ),
                Coordinate::Arm(arm) => {
                    let (unit, rate) = self.arm_units(arm);
                    (unit, rate, self.steady.positions[arm], false)
                }
                Coordinate::Sine { .. } => continue,
            };
            if !drifts {
                list.push(name.clone(), unit, steady, &Row::displacement(index, 1.0));
            }
            list.push(format!("{name}.rate"), rate_unit, 0.0, &Row::velocity(index, 1.0));
        }
    }

    fn arm_units(&self, arm: usize) -> (&'static str, &'static str) {
        match self.drive.tensioners[arm].guide.position_unit() {
            "m" => ("m", "m/s"),
            _ => ("rad", "rad/s"),
        }
    }

    /// Torque through every coupling with an accessory behind it, wind-up of springs, speed of overrun.
    fn couplings(&self, list: &mut List<'_, '_>) {
        for (j, pulley) in self.drive.pulleys.iter().enumerate() {
            let accessory = self.model.coordinates.accessory(j);
            let name = &pulley.name;
            let element = self.element(&couplings::name(self.drive, j));
            let load = self.steady.loads[j];
            let torque = match (element, pulley.coupling) {
                (Some(element), _) => Row {
                    force: vec![(element, 1.0)],
                    ..Row::default()
                },
                // What turns the accessory is its load, its inertia and its drag.
                (None, coupling) if coupling.accessory_inertia() > 0.0 => {
                    let shaft = accessory.unwrap_or(j);
                    Row {
                        constant: load,
                        velocity: vec![(shaft, pulley.accessory_damping)],
                        acceleration: vec![(shaft, coupling.accessory_inertia())],
                        ..Row::default()
                    }
                }
                _ => continue,
            };
            list.push(format!("clutch_torque.{name}"), "N m", 0.0, &torque);
            let Some(accessory) = accessory else { continue };
            let between = [(j, 1.0), (accessory, -1.0)];
            match pulley.coupling {
                Coupling::Isolator(spring) => {
                    let mut windup = Row::displacement(j, 1.0);
                    windup.add(1.0, &Row::displacement(accessory, -1.0));
                    windup.constant = load / spring.stiffness;
                    list.push(format!("windup.{name}"), "rad", 0.0, &windup);
                }
                Coupling::WrapSpring(_) => {
                    let windup = Row {
                        displacement: between.to_vec(),
                        ..Row::default()
                    };
                    list.push(format!("windup.{name}"), "rad", 0.0, &windup);
                }
                // The spring of a decoupler is wound up by the torque; what it overruns is forgotten.
                Coupling::Decoupler { spring, .. } => {
                    let mut windup = Row::default();
                    windup.add(1.0 / spring.stiffness, &torque);
                    list.push(format!("windup.{name}"), "rad", 0.0, &windup);
                }
                Coupling::Rigid { .. } | Coupling::OneWay { .. } => {}
            }
            if pulley.coupling.is_one_way() {
                let overrun = Row {
                    velocity: between.map(|(index, factor)| (index, -factor)).to_vec(),
                    ..Row::default()
                };
                list.push(format!("overrun.{name}"), "rad/s", 0.0, &overrun);
            }
        }
    }

    /// Torques of friction, damper and stops on the tensioner against the direction of its coordinate, and contact forces.
    fn tensioners(&self, list: &mut List<'_, '_>) {
        for (arm, tensioner) in self.drive.tensioners.iter().enumerate() {
            let unit = match self.arm_units(arm).0 {
                "m" => "N",
                _ => "N m",
            };
            let sense = loading_sense(self.steady, arm);
            for (measure, parts) in [
                ("friction_torque", vec![(Role::Friction, sense)]),
                ("damper_torque", vec![(Role::Damper, sense)]),
                (
                    "stop_torque",
                    vec![(Role::LowerStop, -1.0), (Role::UpperStop, 1.0)],
                ),
            ] {
                let present = parts
                    .iter()
                    .filter_map(|(role, sign)| Some((self.element(&role.name(self.drive, arm))?, *sign)));
                let row = Row {
                    force: present.collect(),
                    ..Row::default()
                };
                if !row.force.is_empty() {
                    list.push(format!("{measure}.{}", tensioner.name), unit, 0.0, &row);
                }
            }
            for contact in &tensioner.pulley_contacts {
                let element = contact_name(self.drive, arm, contact);
                if let Some(index) = self.element(&element) {
                    let row = Row {
                        force: vec![(index, 1.0)],
                        ..Row::default()
                    };
                    list.push(
                        format!("contact_force{}", element.trim_start_matches("contact")),
                        "N",
                        0.0,
                        &row,
                    );
                }
            }
        }
    }

    fn sines(&self, list: &mut List<'_, '_>) {
        for (index, coordinate) in self.model.coordinates.iter().enumerate() {
            if matches!(coordinate, Coordinate::Sine { .. }) {
                let name = self.model.coordinates.name(self.drive, index);
                list.push(name, "m", 0.0, &Row::displacement(index, 1.0));
            }
        }
    }

    fn element(&self, name: &str) -> Option<usize> {
        self.system
            .elements
            .iter()
            .position(|element| element.name == name)
    }

    /// `p_i = k_i D_i q + c_i D_i q'`.
    fn tension(&self, span: usize) -> Row {
        let stretch = self.model.stretch.row(span);
        let terms = |factor: f64| -> Vec<(usize, f64)> {
            stretch
                .iter()
                .enumerate()
                .filter(|(_, value)| **value != 0.0 && factor != 0.0)
                .map(|(index, value)| (index, factor * value))
                .collect()
        };
        Row {
            displacement: terms(self.model.span_stiffness[span]),
            velocity: terms(self.model.span_dashpots[span]),
            ..Row::default()
        }
    }

    /// Displacement along the left normal at a share of the span's length.
    fn deflection(&self, span: usize, share: f64) -> Row {
        let mut row = Row::default();
        for (k, terms) in self.model.local[span].iter().enumerate() {
            let shape = match k {
                0 => 1.0 - share,
                1 => share,
                _ => ((k - 1) as f64 * PI * share).sin(),
            };
            // Sines that have a node there leave only rounding errors.
            if shape.abs() > NODE {
                let scaled = terms.iter().map(|(index, factor)| (*index, factor * shape));
                row.displacement.extend(scaled);
            }
        }
        row
    }

    /// Force of a span on the body at its start (0) or end (1) along the left normal: the row of the span's own matrices.
    fn end_force(&self, span: usize, end: usize) -> Row {
        let mut row = Row::default();
        let matrices = &self.model.spans[span];
        for (column, terms) in self.model.local[span].iter().enumerate() {
            for (index, factor) in terms {
                let entry = |matrix: &Matrix| (*index, -factor * matrix[(end, column)]);
                row.displacement.push(entry(&matrices.stiffness));
                row.velocity.push(entry(&matrices.gyroscopic));
                row.acceleration.push(entry(&matrices.mass));
            }
        }
        row
    }

    /// Components of the dynamic force of the belt on a pulley.
    fn hub_load(&self, pulley: usize) -> [Row; 2] {
        let before = self.drive.span_before(pulley);
        let (incoming, outgoing) = (
            &self.steady.layout.spans[before],
            &self.steady.layout.spans[pulley],
        );
        let parts = [
            (self.tension(pulley), outgoing.direction),
            (self.tension(before), -incoming.direction),
            (self.end_force(pulley, 0), outgoing.normal),
            (self.end_force(before, 1), incoming.normal),
        ];
        let mut result = [Row::default(), Row::default()];
        for (row, direction) in &parts {
            result[0].add(direction.x, row);
            result[1].add(direction.y, row);
        }
        result
    }

    /// Rows whose mean squares add up to the mean square along a span. With the ramp between the ends as a sine series,
    /// `r_n = 2 [b⁰ − (−1)ⁿ b^L]/(nπ)`, they are the sines `(a_n + r_n)/√2` of the model and what the ramp has beyond them, by
    /// the sum and the difference of the ends.
    pub fn span_averages(&self, frequency: f64) -> Vec<SpanAverage> {
        let spans = 0..self.drive.pulleys.len();
        spans
            .filter(|span| !self.model.coordinates.sines(*span).is_empty())
            .map(|span| {
                let name = self.drive.span_name(span);
                let rows = self.average_rows(span).into_iter().enumerate().map(|(k, row)| {
                    self.rows
                        .output(format!("deflection_along.{name}.{k}"), &row, frequency)
                });
                SpanAverage {
                    rows: rows.collect(),
                    span: name.clone(),
                }
            })
            .collect()
    }

    fn average_rows(&self, span: usize) -> Vec<Row> {
        let [start, end, sines @ ..] = &self.model.local[span][..] else {
            return Vec::new();
        };
        let combined = |parts: &[(&Vec<(usize, f64)>, f64)]| {
            let mut row = Row::default();
            for (terms, share) in parts {
                row.displacement
                    .extend(terms.iter().map(|(index, factor)| (*index, factor * share)));
            }
            row
        };
        let mut rows = Vec::new();
        // Of the ramp: coefficients of (b⁰)² + (b^L)² and of b⁰ b^L, less those of its sines.
        let (mut squares, mut product) = (1.0 / 3.0, 1.0 / 3.0);
        for (k, sine) in sines.iter().enumerate() {
            let order = (k + 1) as f64 * PI;
            let alternating = if k % 2 == 0 { -1.0 } else { 1.0 };
            let ramp = SQRT_2 / order;
            rows.push(combined(&[
                (sine, FRAC_1_SQRT_2),
                (start, ramp),
                (end, -alternating * ramp),
            ]));
            squares -= 2.0 / (order * order);
            product += 4.0 * alternating / (order * order);
        }
        let (sum, difference) = (squares + 0.5 * product, squares - 0.5 * product);
        for (square, sign) in [(sum, 1.0), (difference, -1.0)] {
            let share = (0.5 * square).max(0.0).sqrt();
            rows.push(combined(&[(start, share), (end, sign * share)]));
        }
        rows.retain(|row| !row.displacement.is_empty());
        rows
    }
}
