//! `response --compare`: one resonance by multiple scales of both orders, harmonic balance and shooting, how far they
//! differ, and where the approximations are within a tolerance.

mod document;
mod history;
mod map;
mod matching;

pub use document::{
    CompareDocument, Contestant, ErrorRow, HistoryRow, MapAxis, MapCell, MethodBranch, Validity, ValidityMap,
    WithinRow,
};

use crate::response::multiple_scales::{Window, fault, window};
use crate::response::{BranchRow, Order, ParameterRow, Response, ResponseMethod, SweepPointRow};
use crate::{Label, Method, Quantity, Range, Signal, Study, StudyError};
use matching::Curve;
use slackside_dynamics::orbit::multiple_scales::ModalForm;
use slackside_mechanics::System;

/// The question.
#[derive(Debug, Clone)]
pub struct Compare {
    /// Model, range, family, values to look at, check: as for a response by one method.
    pub response: Response,
    /// Number of the mode, from one; `None` for the only one in the range.
    pub mode: Option<usize>,
    /// Number of harmonics of harmonic balance; `None` adapts it.
    pub harmonics: Option<usize>,
    /// Relative error that is accepted.
    pub tolerance: f64,
    /// Two keys and their values, over which validity is mapped.
    pub map: Option<[Range; 2]>,
}

/// Values of a key of the map without a step.
const MAP_VALUES: usize = 9;

/// A piece of work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Job {
    /// All branches by one method at one value of the family key.
    Branches(Option<f64>, Contestant),
    /// Histories at the values asked for, at one value of the family key.
    Histories(Option<f64>),
    /// The cell of the map in this row and column.
    Cell(usize, usize),
}

/// What a piece of work gives.
pub enum Rows {
    /// Branches, settled motions up and down, and remarks.
    Branches(Job, Vec<BranchRow>, [Vec<SweepPointRow>; 2], Vec<String>),
    /// Histories.
    Histories(Vec<HistoryRow>),
    /// A cell.
    Cell(usize, usize, MapCell),
}

impl Compare {
    fn window(&self, quantity: &Quantity, warnings: &mut Vec<String>) -> Result<Window, StudyError> {
        let (low, high) = self.response.over.bounds();
        let range = (quantity.parameter(low), quantity.parameter(high));
        window(quantity, self.mode, range, warnings)
    }

    /// The question for one method, over the part of the range near the resonance.
    fn by(&self, method: Contestant, quantity: &Quantity, window: &Window) -> Response {
        let mode = Some(window.mode + 1);
        Response {
            over: Range {
                from: quantity.value(window.range.0),
                to: quantity.value(window.range.1),
                ..self.response.over.clone()
            },
            method: match method {
                Contestant::Shooting => ResponseMethod::Shooting,
                Contestant::HarmonicBalance => ResponseMethod::HarmonicBalance {
                    harmonics: self.harmonics,
                },
                Contestant::SecondOrder => ResponseMethod::MultipleScales {
                    order: Order::Second,
                    mode,
                },
                Contestant::FirstOrder => ResponseMethod::MultipleScales {
                    order: Order::First,
                    mode,
                },
            },
            periods: 1,
            doublings: 0,
            at: Vec::new(),
            check: if method == Contestant::Shooting {
                self.response.check
            } else {
                0
            },
            ..self.response.clone()
        }
    }

    fn map_values(&self) -> Option<[Vec<f64>; 2]> {
        let map = self.map.as_ref()?;
        Some([map[0].values(MAP_VALUES), map[1].values(MAP_VALUES)])
    }

    /// Errors of all methods along the exact branch of one family value.
    fn errors(
        &self,
        branches: &[MethodBranch],
        label: &Option<Label>,
        measure: &str,
    ) -> Result<Vec<ErrorRow>, StudyError> {
        let of = |method: Contestant| {
            branches
                .iter()
                .filter(move |entry| entry.method == method && entry.branch.label == *label)
                .map(|entry| &entry.branch)
        };
        let rms = |m: &crate::Measures| m.get(measure).map_or(f64::NAN, |m| m.rms);
        let curve = |branch: &BranchRow| {
            let points = branch.points.iter();
            Curve::new(points.map(|p| [p.at.value, rms(&p.motion.measures)]).collect())
        };
        let others = [
            Contestant::FirstOrder,
            Contestant::SecondOrder,
            Contestant::HarmonicBalance,
        ];
        let curves = others.map(|method| of(method).map(curve).collect::<Vec<Curve>>());
        let quantity = self.response.quantity(label.as_ref().and_then(Label::number))?;
        let mut rows = Vec::new();
        for branch in of(Contestant::Shooting) {
            let exact = curve(branch);
            let mut points: Vec<_> = branch.points.iter().collect();
            // The curve may turn the points round.
            if exact.points().first().map(|p| p[0]) != points.first().map(|p| p.at.value)
                || exact.points().first().map(|p| p[1]) != points.first().map(|p| rms(&p.motion.measures))
            {
                points.reverse();
            }
            for (index, point) in points
                .iter()
                .enumerate()
                .filter(|(_, p)| !p.motion.events.is_empty())
            {
                let system = quantity.family.at(quantity.parameter(point.at.value))?.system;
                let form = ModalForm::new(&system).map_err(fault)?;
                let error = |curves: &[Curve]| matching::error(&exact, index, curves, self.tolerance);
                let rms = rms(&point.motion.measures);
                rows.push(ErrorRow {
                    at: point.at.clone(),
                    label: label.clone(),
                    stable: point.stable,
                    rms,
                    gamma: gamma(form.static_deflection, rms),
                    first_order: error(&curves[0]),
                    second_order: error(&curves[1]),
                    harmonic_balance: error(&curves[2]),
                });
            }
        }
        Ok(rows)
    }

    /// How far each method is within the tolerance on the motions of one family value.
    fn within(&self, rows: &[&ErrorRow], label: &Option<Label>) -> Vec<WithinRow> {
        let mut rows = rows.to_vec();
        rows.sort_by(|a, b| a.rms.total_cmp(&b.rms));
        Contestant::ALL[1..]
            .iter()
            .map(|&method| {
                let fine = |row: &&&ErrorRow| row.of(method).is_some_and(|error| error <= self.tolerance);
                let count = rows.iter().take_while(fine).count();
                let last = count.checked_sub(1).map(|i| rows[i]);
                let errors: Option<Vec<f64>> = rows.iter().map(|row| row.of(method)).collect();
                WithinRow {
                    label: label.clone(),
                    method,
                    rms: last.map(|row| row.rms),
                    gamma: last.map(|row| row.gamma),
                    everywhere: count == rows.len(),
                    worst: errors.map(|errors| errors.into_iter().fold(0.0, f64::max)),
                }
            })
            .collect()
    }
}

/// `γ` of a harmonic motion with this RMS.
fn gamma(static_deflection: f64, rms: f64) -> f64 {
    static_deflection / (std::f64::consts::SQRT_2 * rms)
}

/// The measure that is the deflection of the switching element.
fn deflection(system: &System) -> Result<String, StudyError> {
    let form = ModalForm::new(system).map_err(fault)?;
    let port = system
        .elements
        .get(form.element)
        .map(|element| element.port.terms());
    let found = system.outputs.iter().find(|output| {
        Some(output.displacement.as_slice()) == port
            && output.velocity.is_empty()
            && output.force.is_empty()
            && output.harmonics.is_empty()
    });
    found.map(|output| output.name.clone()).ok_or_else(|| {
        StudyError::NoAnswer(
            "no measure is the deflection of the switching element; add an [[output]] with the element's port".to_owned(),
        )
    })
}

impl Study for Compare {
    type Job = Job;
    type Rows = Rows;
    type Document = CompareDocument;

    fn plan(&self) -> Result<Vec<Job>, StudyError> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(StudyError::question(
                "--tolerance",
                "give a share between 0 and 1, for example 1 %",
            ));
        }
        let quantity = self.response.quantity(None)?;
        let window = self.window(&quantity, &mut Vec::new())?;
        deflection(&quantity.family.at(window.range.0)?.system)?;
        let values: Vec<Option<f64>> = self.by(Contestant::Shooting, &quantity, &window).plan()?;
        let mut jobs = Vec::new();
        for value in values {
            jobs.extend(Contestant::ALL.map(|method| Job::Branches(value, method)));
            if !self.response.at.is_empty() {
                jobs.push(Job::Histories(value));
            }
        }
        if let (Some(map), Some([across, down])) = (&self.map, self.map_values()) {
            for (range, values) in map.iter().zip([&across, &down]) {
                for value in values {
                    self.response.subject.with_number(&range.key, *value)?;
                }
            }
            for row in 0..down.len() {
                jobs.extend((0..across.len()).map(|column| Job::Cell(row, column)));
            }
        }
        Ok(jobs)
    }

    fn run(&self, job: &Job, signal: &Signal) -> Result<Rows, StudyError> {
        match *job {
            Job::Branches(value, method) => {
                let quantity = self.response.quantity(value)?;
                let mut warnings = Vec::new();
                let window = self.window(&quantity, &mut warnings)?;
                let found = self.by(method, &quantity, &window).run(&value, signal)?;
                if method == Contestant::Shooting {
                    warnings.extend(found.warnings);
                } else {
                    // That the range is cut is said once.
                    warnings = found.warnings;
                }
                Ok(Rows::Branches(
                    *job,
                    found.branches,
                    [found.up, found.down],
                    warnings,
                ))
            }
            Job::Histories(value) => history::rows(self, value, signal).map(Rows::Histories),
            Job::Cell(row, column) => {
                map::cell(self, row, column, signal).map(|cell| Rows::Cell(row, column, cell))
            }
        }
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<Rows, StudyError>>>,
        interrupted: bool,
    ) -> Result<CompareDocument, StudyError> {
        let quantity = self.response.quantity(None)?;
        let window = self.window(&quantity, &mut Vec::new())?;
        let measure = deflection(&quantity.family.at(window.range.0)?.system)?;
        let method = Method::new("comparison")
            .with("methods", Contestant::ALL.map(Contestant::words).to_vec())
            .with("error", "of the parameter at equal RMS, relative")
            .with("tolerance", self.tolerance);
        let mut header = self.response.subject.header("response", method);
        let (mut branches, mut histories) = (Vec::new(), Vec::new());
        let (mut up, mut down) = (Vec::new(), Vec::new());
        let mut map = self
            .map_values()
            .zip(self.map.as_ref())
            .map(|([across, down], keys)| ValidityMap {
                cells: vec![vec![None; across.len()]; down.len()],
                across: MapAxis {
                    key: keys[0].key.clone(),
                    values: across,
                },
                down: MapAxis {
                    key: keys[1].key.clone(),
                    values: down,
                },
            });
        for row in rows.into_iter().flatten() {
            match row {
                Ok(Rows::Branches(Job::Branches(value, method), found, settled, warnings)) => {
                    branches.extend(found.into_iter().map(|branch| MethodBranch { method, branch }));
                    let [rising, falling] = settled;
                    up.extend(rising);
                    down.extend(falling);
                    let about = value.map_or(String::new(), |value| format!("{value}: "));
                    for warning in warnings {
                        let warning = format!("{about}{}: {warning}", method.words());
                        if !header.warnings.contains(&warning) {
                            header.warnings.push(warning);
                        }
                    }
                }
                Ok(Rows::Branches(..)) => {}
                Ok(Rows::Histories(found)) => histories.extend(found),
                Ok(Rows::Cell(row, column, cell)) => {
                    let place = map
                        .as_mut()
                        .and_then(|map| map.cells.get_mut(row)?.get_mut(column));
                    if let Some(place) = place {
                        *place = Some(cell);
                    }
                }
                Err(error) => header.warnings.push(error.to_string()),
            }
        }
        if branches.is_empty() {
            return Err(if interrupted {
                StudyError::Interrupted
            } else {
                StudyError::NoAnswer(header.warnings.join("; "))
            });
        }
        if interrupted {
            header
                .warnings
                .push("interrupted: the comparison holds what was finished".to_owned());
        }
        let mut labels: Vec<Option<Label>> = Vec::new();
        for entry in &branches {
            if !labels.contains(&entry.branch.label) {
                labels.push(entry.branch.label.clone());
            }
        }
        let mut errors = Vec::new();
        let mut within = Vec::new();
        for label in &labels {
            let found = self.errors(&branches, label, &measure)?;
            if !found.is_empty() {
                within.extend(self.within(&found.iter().collect::<Vec<_>>(), label));
            }
            errors.extend(found);
        }
        Ok(CompareDocument {
            header,
            parameter: ParameterRow {
                key: quantity.key.clone(),
                unit: quantity.unit.clone(),
                from: quantity.value(window.range.0),
                to: quantity.value(window.range.1),
            },
            measure,
            tolerance: self.tolerance,
            branches,
            errors,
            within,
            histories,
            up,
            down,
            map,
        })
    }
}
