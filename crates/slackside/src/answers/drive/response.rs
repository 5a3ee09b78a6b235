//! The answer of `response` for a drive: measures by order over speed, frequency or a key.

use super::sheet_figures::varied_axis;
use crate::answer::Answer;
use crate::failure::Failure;
use crate::plots;
use crate::table_text::{number, table, with_unit};
use slackside_report::figures::{Curve, OrderCurve, OrderMeasure, OrderResponse, order_response};
use slackside_report::plot::Axis;
use slackside_report::{Column, Figure, Table};
use slackside_studies::drive::response::{DriveResponseDocument, OrderMeasureRow};
use slackside_studies::{Header, StudyError};

/// Groups of measures that share a figure: prefix, name of the figure, title of the axis, unit drawn and its factor.
const GROUPS: [(&str, &str, &str, &str, f64); 7] = [
    ("tension.", "tensions", "Dynamic tension", "N", 1.0),
    ("hub_load.", "hub_loads", "Hub load about its mean", "N", 1.0),
    (
        "rotation.",
        "rotations",
        "Rotation",
        "°",
        180.0 / std::f64::consts::PI,
    ),
    ("windup.", "windups", "Wind-up", "°", 180.0 / std::f64::consts::PI),
    ("arm.", "arms", "Arm motion", "", 1.0),
    (
        "deflection.",
        "deflections",
        "Deflection at the middle",
        "mm",
        1e3,
    ),
    (
        "deflection_along.",
        "deflections_along",
        "Deflection along the span",
        "mm",
        1e3,
    ),
];

/// The document with the measure to draw alone, if one is asked for.
pub struct DriveResponseAnswer {
    document: DriveResponseDocument,
    measure: Option<usize>,
}

impl DriveResponseAnswer {
    /// Chooses the measure by name.
    ///
    /// # Errors
    /// [`StudyError::Question`] if there is no such measure.
    pub fn new(document: DriveResponseDocument, measure: Option<&str>) -> Result<Self, Failure> {
        let names = || document.points.iter().flat_map(|point| &point.measures);
        let measure = match measure {
            None => None,
            Some(name) => {
                let position = names().position(|row| row.name == name);
                let Some(position) = position else {
                    let first = document.points.first();
                    let known: Vec<&str> = first
                        .iter()
                        .flat_map(|point| &point.measures)
                        .map(|row| &*row.name)
                        .collect();
                    return Err(StudyError::question(
                        "--measure",
                        format!("there is no measure \"{name}\"; known are {}", known.join(", ")),
                    )
                    .into());
                };
                Some(position)
            }
        };
        Ok(Self { document, measure })
    }

    /// Names and units of the measures that every point has.
    fn measures(&self) -> Vec<(&str, &str)> {
        let Some(first) = self.document.points.first() else {
            return Vec::new();
        };
        first.measures.iter().map(|row| (&*row.name, row.unit)).collect()
    }

    /// Values of the varied quantity.
    fn values(&self) -> Vec<f64> {
        self.document.points.iter().map(|point| point.value).collect()
    }

    /// A number of a measure at every point; NaN where the point does not have it.
    fn column(&self, name: &str, value: &dyn Fn(&OrderMeasureRow) -> f64) -> Vec<f64> {
        self.document
            .points
            .iter()
            .map(|point| {
                let row = point.measures.iter().find(|row| row.name == name);
                row.map_or(f64::NAN, value)
            })
            .collect()
    }

    fn panel(&self, name: &str, heading: &str, title: &str, unit: &str, factor: f64) -> OrderMeasure {
        let is_linear = self
            .document
            .points
            .iter()
            .flat_map(|point| &point.measures)
            .any(|row| row.name == name && !row.orders.is_empty());
        let amplitude = |k: usize| {
            self.column(name, &|row| {
                row.orders
                    .get(k)
                    .map_or(f64::NAN, |[re, im]| factor * re.hypot(*im))
            })
        };
        let phase = |k: usize| {
            self.column(name, &|row| {
                row.orders
                    .get(k)
                    .map_or(f64::NAN, |[re, im]| im.atan2(*re).to_degrees())
            })
        };
        let orders = self.document.orders.iter().enumerate();
        OrderMeasure {
            amplitude: Axis::linear(title, unit),
            heading: heading.to_owned(),
            orders: if is_linear {
                orders
                    .map(|(k, order)| OrderCurve {
                        order: *order,
                        speed: self.values(),
                        amplitude: amplitude(k),
                        phase: phase(k),
                    })
                    .collect()
            } else {
                Vec::new()
            },
            totals: vec![Curve {
                name: "RMS".to_owned(),
                x: self.values(),
                y: self.column(name, &|row| factor * row.rms),
            }],
        }
    }

    fn figure(&self, measures: Vec<OrderMeasure>, phase: bool) -> Figure {
        let parameter = &self.document.parameter;
        order_response(
            &OrderResponse {
                speed: varied_axis(&parameter.key, &parameter.unit),
                measures,
                phase: phase.then(|| Axis::linear("Phase", "°")),
            },
            &plots::options(),
        )
    }

    /// The figure of one group of measures; `None` if the drive has none of them.
    fn group(&self, prefix: &str, title: &str, unit: &str, factor: f64) -> Option<Figure> {
        let panels: Vec<OrderMeasure> = self
            .measures()
            .into_iter()
            .filter_map(|(name, own_unit)| Some((name, name.strip_prefix(prefix)?, own_unit)))
            .map(|(name, rest, own_unit)| {
                let (unit, factor) = match (unit, own_unit) {
                    ("", "rad") => ("°", 1f64.to_degrees()),
                    ("", _) => ("mm", 1e3),
                    _ => (unit, factor),
                };
                self.panel(name, rest, title, unit, factor)
            })
            .collect();
        (!panels.is_empty()).then(|| self.figure(panels, false))
    }
}

impl Answer for DriveResponseAnswer {
    fn header(&self) -> &Header {
        &self.document.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(&self.document)
    }

    fn summary(&self) -> String {
        let parameter = &self.document.parameter;
        let orders: Vec<String> = self.document.orders.iter().map(f64::to_string).collect();
        let values = self.values();
        let mut text = format!(
            "Linear response to order {} at {} values of {}\n",
            orders.join(", "),
            values.len(),
            parameter.key
        );
        let rows = self.measures().into_iter().map(|(name, unit)| {
            let rms = self.column(name, &|row| row.rms);
            let largest = rms
                .iter()
                .zip(&values)
                .filter(|(value, _)| value.is_finite())
                .max_by(|a, b| a.0.total_cmp(b.0));
            let finite = |value: &dyn Fn(&OrderMeasureRow) -> f64| {
                let column = self.column(name, value);
                column
                    .into_iter()
                    .filter(|value| value.is_finite())
                    .collect::<Vec<f64>>()
            };
            let max = finite(&|row| row.max)
                .into_iter()
                .fold(f64::NEG_INFINITY, f64::max);
            let min = finite(&|row| row.min).into_iter().fold(f64::INFINITY, f64::min);
            let (rms, at) = largest.map_or((f64::NAN, f64::NAN), |(rms, at)| (*rms, *at));
            // Of a safety only the smallest value says anything.
            let (rms, at, max) = if name.starts_with("slip_safety.") {
                (f64::NAN, f64::NAN, f64::NAN)
            } else {
                (rms, at, max)
            };
            vec![
                with_unit(name, unit),
                number(rms),
                number(at),
                number(max),
                number(min),
            ]
        });
        let at = with_unit(&format!("at {}", parameter.key), &parameter.unit);
        text += &table(
            &["measure", "largest RMS", &at, "largest value", "smallest value"],
            rows.collect(),
        );
        text + "\n"
    }

    fn tables(&self) -> Vec<Table> {
        let parameter = &self.document.parameter;
        let mut table = Table::new("response");
        table.columns = vec![Column::number(
            parameter.key.clone(),
            parameter.unit.clone(),
            self.values(),
        )];
        for (name, unit) in self.measures() {
            let mut push = |statistic: String, value: &dyn Fn(&OrderMeasureRow) -> f64| {
                table.columns.push(Column::number(
                    format!("{name}.{statistic}"),
                    unit,
                    self.column(name, value),
                ));
            };
            push("mean".to_owned(), &|row| row.mean);
            push("rms".to_owned(), &|row| row.rms);
            push("max".to_owned(), &|row| row.max);
            push("min".to_owned(), &|row| row.min);
            for (k, order) in self.document.orders.iter().enumerate() {
                let part = |row: &OrderMeasureRow, part: usize| {
                    row.orders.get(k).map_or(f64::NAN, |pair| pair[part])
                };
                push(format!("order_{order}.re"), &|row| part(row, 0));
                push(format!("order_{order}.im"), &|row| part(row, 1));
            }
        }
        vec![table]
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        if let Some((name, unit)) = self.measure.and_then(|k| self.measures().get(k).copied()) {
            let panel = self.panel(name, name, "Amplitude", unit, 1.0);
            return vec![("response".to_owned(), self.figure(vec![panel], true))];
        }
        GROUPS
            .iter()
            .filter_map(|(prefix, name, title, unit, factor)| {
                Some(((*name).to_owned(), self.group(prefix, title, unit, *factor)?))
            })
            .collect()
    }
}
