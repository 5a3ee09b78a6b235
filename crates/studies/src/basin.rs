//! `sweep` over initial states: which attractor each start of a grid reaches (theory 02 §9.2).

use crate::simulate::{Initial, initial_state, state_names};
use crate::{Header, Measures, Method, Parameter, Range, Signal, Study, StudyError, Subject, motion};
use serde::Serialize;
use slackside_dynamics::attractor::basin::{Axis, BasinMap, BasinOptions, BasinRow, Cell, Grid, merge, row};
use slackside_dynamics::attractor::{PeriodicAttractor, Recognizer};
use slackside_dynamics::flow::Request;
use slackside_mechanics::OperatingPoint;

/// Values of a range without a step.
const USUAL_VALUES: usize = 101;

/// The question: two entries of the initial state vary over a grid, at one frequency of the load.
#[derive(Debug, Clone)]
pub struct Basin {
    /// The model.
    pub subject: Subject,
    /// Frequency of the load in the user's unit; `None` for that of the file.
    pub frequency: Option<f64>,
    /// State entry (`coordinate` or `coordinate.rate`) and its values across.
    pub across: Range,
    /// State entry and its values from row to row.
    pub down: Range,
    /// State that holds the other entries.
    pub initial: Initial,
    /// Length of the motions and recognition of attractors.
    pub options: BasinOptions,
}

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct BasinDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// The frequency of the load.
    #[serde(flatten)]
    pub at: Parameter,
    /// The entry that varies across.
    pub across: AxisValues,
    /// The entry that varies from row to row.
    pub down: AxisValues,
    /// Number of the attractor by row and column; none where the motion is not periodic, failed or was not computed.
    pub cells: Vec<Vec<Option<usize>>>,
    /// The attractors.
    pub attractors: Vec<AttractorRow>,
    /// Cells whose motion did not become periodic.
    pub not_periodic: usize,
    /// Cells whose motion could not be computed.
    pub failed: usize,
    /// Cells that were not computed before the study was interrupted.
    pub not_computed: usize,
    /// Names of the state entries in `poincare`.
    pub state: Vec<String>,
}

/// A state entry and its values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AxisValues {
    /// `coordinate` or `coordinate.rate`.
    pub entry: String,
    /// Values.
    pub values: Vec<f64>,
}

/// A periodic attractor.
#[derive(Debug, Clone, Serialize)]
pub struct AttractorRow {
    /// Periods of the load after which it repeats.
    pub periods: usize,
    /// Cells that reach it.
    pub cells: usize,
    /// Measures over its period.
    pub measures: Measures,
    /// Modulus of the largest Floquet multiplier, if it was refined to an exact orbit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_multiplier: Option<f64>,
    /// Stroboscopic points.
    pub poincare: Vec<Vec<f64>>,
}

impl Basin {
    fn point(&self) -> Result<OperatingPoint, StudyError> {
        self.subject.operating_point(self.frequency)
    }

    fn grid(&self, point: &OperatingPoint) -> Result<Grid, StudyError> {
        let state = initial_state(&point.system, point.frequency, &self.initial)?;
        let names = state_names(&point.system);
        let axis = |range: &Range| {
            let entry = names.iter().position(|name| *name == range.key).ok_or_else(|| {
                StudyError::question(
                    "--over",
                    format!(
                        "`{}` is no entry of the state; choose from {}",
                        range.key,
                        names.join(", ")
                    ),
                )
            })?;
            Ok::<_, StudyError>(Axis {
                entry,
                values: range.values(USUAL_VALUES),
            })
        };
        Grid::new(state, axis(&self.across)?, axis(&self.down)?)
            .map_err(|error| StudyError::question("--over", error.to_string()))
    }

    fn attractor(
        &self,
        recognizer: &mut Recognizer,
        point: &OperatingPoint,
        attractor: &PeriodicAttractor,
        cells: usize,
    ) -> Result<AttractorRow, StudyError> {
        let request = Request {
            extremes: true,
            ..Request::default()
        };
        let mut start = attractor.points.first().cloned().unwrap_or_default();
        let record =
            recognizer
                .flow()
                .record(&mut start, attractor.periods, &point.system.outputs, &request)?;
        Ok(AttractorRow {
            periods: attractor.periods,
            cells,
            measures: motion(&point.system, &record, attractor.periods).measures,
            largest_multiplier: attractor
                .orbit
                .as_ref()
                .and_then(|orbit| orbit.multipliers.first())
                .map(|multiplier| multiplier.norm()),
            poincare: attractor.points.clone(),
        })
    }
}

impl Study for Basin {
    /// Number of a row.
    type Job = usize;
    type Rows = BasinRow;
    type Document = BasinDocument;

    fn plan(&self) -> Result<Vec<usize>, StudyError> {
        let grid = self.grid(&self.point()?)?;
        Ok((0..grid.down().values.len()).collect())
    }

    fn run(&self, job: &usize, _: &Signal) -> Result<BasinRow, StudyError> {
        let point = self.point()?;
        Ok(row(&point, &self.grid(&point)?, *job, &self.options)?)
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<BasinRow, StudyError>>>,
        interrupted: bool,
    ) -> Result<BasinDocument, StudyError> {
        let point = self.point()?;
        let grid = self.grid(&point)?;
        let rows = rows.into_iter().flatten().collect::<Result<Vec<_>, _>>()?;
        if rows.is_empty() {
            return Err(StudyError::Interrupted);
        }
        let map = merge(rows);
        let columns = grid.across().values.len();
        let missing = grid.down().values.len() - map.rows.len();
        let method = Method::new("stepping")
            .with("periods", self.options.periods)
            .with("tolerance", self.options.recognition.tolerance)
            .with("longest_period", self.options.recognition.longest_period);
        let mut header = self.subject.header("basin", method);
        if interrupted {
            header
                .warnings
                .push(format!("interrupted: {missing} rows of the map are missing"));
        }
        let mut recognizer = Recognizer::new(&point, self.options.recognition.clone())?;
        let attractors = map
            .attractors
            .iter()
            .enumerate()
            .map(|(number, attractor)| {
                let cells = map.count(Cell::Attractor(number));
                self.attractor(&mut recognizer, &point, attractor, cells)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let values = |axis: &Axis, range: &Range| AxisValues {
            entry: range.key.clone(),
            values: axis.values.clone(),
        };
        Ok(BasinDocument {
            header,
            at: Parameter {
                key: "frequency".to_owned(),
                value: self.subject.units.user_frequency(point.frequency),
            },
            across: values(grid.across(), &self.across),
            down: values(grid.down(), &self.down),
            cells: numbers(&map, grid.down().values.len(), columns),
            attractors,
            not_periodic: map.count(Cell::NotPeriodic),
            failed: map.count(Cell::Failed),
            not_computed: missing * columns,
            state: state_names(&point.system),
        })
    }
}

/// Numbers of attractors by row and column, with rows that were not computed empty of them.
fn numbers(map: &BasinMap, rows: usize, columns: usize) -> Vec<Vec<Option<usize>>> {
    let mut cells = vec![vec![None; columns]; rows];
    for (row, found) in &map.rows {
        cells[*row] = found
            .iter()
            .map(|cell| match cell {
                Cell::Attractor(number) => Some(*number),
                Cell::NotPeriodic | Cell::Failed => None,
            })
            .collect();
    }
    cells
}
