//! The answer of `sweep`.

use super::engagement::{engaged, switching_element};
use super::response::Choice;
use super::simulate::unit;
use crate::answer::Answer;
use crate::failure::Failure;
use crate::plots;
use crate::table_text::{number, table, with_unit};
use slackside_report::figures::{
    EngagementRow, EngagementStrip, PoincareMap, PointSet, Response, ResponseSpectrum, Waterfall,
    engagement_strip, poincare_map, response, waterfall_lines, waterfall_map,
};
use slackside_report::plot::Axis;
use slackside_report::{Column, Figure, Table};
use slackside_studies::sweep::{SweepDocument, SweepRow};
use slackside_studies::{Header, Measure};

/// Runs of one kind of motion shown in the summary.
const RUNS_SHOWN: usize = 40;
/// Spectra in a waterfall of lines: more would hide each other.
const LINES: usize = 60;

/// The document with the measure to draw.
pub struct SweepAnswer {
    document: SweepDocument,
    choice: Choice,
}

impl SweepAnswer {
    /// Chooses the measure: the one asked for, otherwise the RMS of the wind-up or of the first measure.
    ///
    /// # Errors
    /// A question error if there is no such measure.
    pub fn new(document: SweepDocument, measure: Option<&str>) -> Result<Self, Failure> {
        let choice = Choice::new(measure, &document.header)?;
        Ok(Self { document, choice })
    }

    /// Direction and row.
    fn rows(&self) -> Vec<(&'static str, &SweepRow)> {
        let up = self.document.up.iter().map(|row| ("up", row));
        up.chain(self.document.down.iter().map(|row| ("down", row)))
            .collect()
    }

    fn key(&self) -> String {
        self.rows()
            .first()
            .map_or(String::new(), |(_, row)| row.at.key.clone())
    }

    fn key_unit(&self) -> String {
        match self.key().as_str() {
            "frequency" => self.document.header.units.frequency.clone(),
            "speed" => "rpm".to_owned(),
            _ => String::new(),
        }
    }
}

impl Answer for SweepAnswer {
    fn header(&self) -> &Header {
        &self.document.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(&self.document)
    }

    fn summary(&self) -> String {
        let mut runs: Vec<(&str, &SweepRow, &SweepRow, usize, f64)> = Vec::new();
        for (direction, row) in self.rows() {
            let size = self.choice.of(&row.motion.measures);
            match runs.last_mut() {
                Some(run) if run.0 == direction && run.1.kind == row.kind => {
                    run.2 = row;
                    run.3 += 1;
                    run.4 = run.4.max(size);
                }
                _ => runs.push((direction, row, row, 1, size)),
            }
        }
        let shown = runs.len().min(RUNS_SHOWN);
        let head = with_unit(&self.key(), &self.key_unit());
        let rows = runs[..shown].iter().map(|(direction, first, last, count, size)| {
            vec![
                (*direction).to_owned(),
                first.kind.clone(),
                number(first.at.value),
                number(last.at.value),
                count.to_string(),
                number(*size),
            ]
        });
        let largest = format!("largest {}", self.choice.name());
        let mut text = table(
            &[
                "direction",
                "motion",
                &format!("{head} from"),
                "to",
                "values",
                &largest,
            ],
            rows.collect(),
        );
        if shown < runs.len() {
            text += &format!("\n… and {} more changes of the motion", runs.len() - shown);
        }
        text + "\n"
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.sweep_table(), self.points_table(), self.spectra_table()]
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        let mut figures = vec![
            ("sweep".to_owned(), self.curves()),
            ("poincare".to_owned(), self.poincare()),
        ];
        for (name, rows) in [("up", &self.document.up), ("down", &self.document.down)] {
            if let Some(waterfall) = self.waterfall(rows) {
                let map = waterfall_map(&waterfall, &plots::options());
                figures.push((format!("waterfall_map_{name}"), map));
                let every = waterfall.spectra.len().div_ceil(LINES).max(1);
                let lines = Waterfall {
                    amplitude: Axis::linear(
                        waterfall.amplitude.label.clone(),
                        waterfall.amplitude.unit.clone(),
                    ),
                    spectra: waterfall.spectra.iter().step_by(every).cloned().collect(),
                    ..waterfall
                };
                figures.push((
                    format!("waterfall_{name}"),
                    waterfall_lines(&lines, &plots::options()),
                ));
            }
            figures.extend(
                self.engagement(rows)
                    .map(|figure| (format!("engagement_{name}"), figure)),
            );
        }
        figures
    }
}

impl SweepAnswer {
    fn curves(&self) -> Figure {
        let points = |rows: &[SweepRow]| {
            rows.iter()
                .map(|row| [row.at.value, self.choice.of(&row.motion.measures)])
                .collect()
        };
        response(
            &Response {
                x: plots::axis(&self.key(), &self.key_unit()),
                y: self.choice.axis(&self.document.header),
                sweep_up: points(&self.document.up),
                sweep_down: points(&self.document.down),
                ..Response::default()
            },
            &plots::options(),
        )
    }

    /// Stroboscopic points of the first entry of the state over the parameter.
    fn poincare(&self) -> Figure {
        let set = |name: &str, rows: &[SweepRow]| PointSet {
            name: name.to_owned(),
            points: rows
                .iter()
                .flat_map(|row| {
                    let points = row.poincare.iter();
                    points.filter_map(|point| Some([row.at.value, *point.first()?]))
                })
                .collect(),
        };
        let mut sets = vec![
            set("sweep up", &self.document.up),
            set("sweep down", &self.document.down),
        ];
        sets.retain(|set| !set.points.is_empty());
        let entry = self.document.state.first().cloned().unwrap_or_default();
        poincare_map(
            &PoincareMap {
                x: plots::axis(&self.key(), &self.key_unit()),
                y: plots::axis(&entry, &self.document.header.units.angle),
                sets,
            },
            &plots::options(),
        )
    }

    fn waterfall(&self, rows: &[SweepRow]) -> Option<Waterfall> {
        let measure = &self.choice.measure;
        let spectra: Vec<ResponseSpectrum> = rows
            .iter()
            .filter_map(|row| {
                let (_, amplitude) = row.spectra.measures.iter().find(|(name, _)| name == measure)?;
                // The mean would hide all lines.
                Some(ResponseSpectrum {
                    parameter: row.at.value,
                    frequency: row.spectra.frequency.iter().skip(1).copied().collect(),
                    amplitude: amplitude.iter().skip(1).copied().collect(),
                })
            })
            .collect();
        if spectra.len() < 2 {
            return None;
        }
        let spectra = to_common_end(spectra);
        Some(Waterfall {
            parameter: plots::axis(&self.key(), &self.key_unit()),
            frequency: Axis::linear("Response frequency", self.document.header.units.frequency.clone()),
            amplitude: Axis::logarithmic(
                format!("Amplitude of {}", plots::words(measure)),
                self.document.header.units.measures.get(measure),
            ),
            spectra,
        })
    }

    fn engagement(&self, rows: &[SweepRow]) -> Option<Figure> {
        let periodic = || rows.iter().filter(|row| row.kind == "periodic-1");
        let element = switching_element(periodic().map(|row| &row.motion))?;
        let strips: Vec<EngagementRow> = periodic()
            .map(|row| EngagementRow {
                value: row.at.value,
                engaged: engaged(&row.motion, element),
            })
            .collect();
        if strips.iter().all(|row| row.engaged == [[0.0, 1.0]]) {
            return None;
        }
        Some(engagement_strip(
            &EngagementStrip {
                phase: Axis::linear("Phase of the period", "–"),
                row: plots::axis(&self.key(), &self.key_unit()),
                rows: strips,
            },
            &plots::options(),
        ))
    }

    fn sweep_table(&self) -> Table {
        let rows = self.rows();
        let value = |of: &dyn Fn(&SweepRow) -> f64| rows.iter().map(|(_, row)| of(row)).collect::<Vec<f64>>();
        let periods = rows
            .iter()
            .map(|(_, row)| i64::try_from(row.periods).unwrap_or(i64::MAX));
        let mut table = Table::new("sweep");
        table.columns = vec![
            Column::text(
                "direction",
                rows.iter().map(|(name, _)| (*name).to_owned()).collect(),
            ),
            Column::number(self.key(), unit(&self.key_unit()), value(&|row| row.at.value)),
            Column::text("kind", rows.iter().map(|(_, row)| row.kind.clone()).collect()),
            Column::integer("periods", periods.collect()),
            Column::number(
                "engaged_ratio",
                "",
                value(&|row| row.motion.engaged_ratio.unwrap_or(f64::NAN)),
            ),
            Column::number(
                "largest_multiplier",
                "",
                value(&|row| row.largest_multiplier.unwrap_or(f64::NAN)),
            ),
            Column::number(
                "rotation_number",
                "",
                value(&|row| row.rotation_number.unwrap_or(f64::NAN)),
            ),
            Column::number(
                "largest_lyapunov_exponent",
                "",
                value(&|row| {
                    let exponents = row.lyapunov.as_ref().and_then(|l| l.exponents.first());
                    exponents.copied().unwrap_or(f64::NAN)
                }),
            ),
        ];
        for (name, label) in &self.document.header.units.measures.0 {
            let of = |of: &dyn Fn(&Measure) -> f64| {
                value(&|row| row.motion.measures.get(name).map_or(f64::NAN, of))
            };
            table.columns.extend([
                Column::number(format!("{name}.mean"), unit(label), of(&|m| m.mean)),
                Column::number(format!("{name}.rms"), unit(label), of(&|m| m.rms)),
                Column::number(format!("{name}.max"), unit(label), of(&|m| m.max)),
                Column::number(format!("{name}.min"), unit(label), of(&|m| m.min)),
            ]);
        }
        table
    }

    fn points_table(&self) -> Table {
        let rows = self.rows();
        let points = || {
            let all = rows.iter();
            all.flat_map(|(direction, row)| row.poincare.iter().map(move |point| (*direction, *row, point)))
        };
        let mut table = Table::new("poincare");
        table.columns = vec![
            Column::text("direction", points().map(|(name, ..)| name.to_owned()).collect()),
            Column::number(
                self.key(),
                unit(&self.key_unit()),
                points().map(|(_, row, _)| row.at.value).collect(),
            ),
        ];
        for (i, name) in self.document.state.iter().enumerate() {
            let values = points().map(|(_, _, point)| point.get(i).copied().unwrap_or(f64::NAN));
            table
                .columns
                .push(Column::number(name.clone(), "", values.collect()));
        }
        table
    }

    fn spectra_table(&self) -> Table {
        let rows = self.rows();
        let lines = || {
            let all = rows.iter();
            all.flat_map(|(direction, row)| {
                let frequencies = row.spectra.frequency.iter().enumerate();
                frequencies.map(move |(line, frequency)| (*direction, *row, line, *frequency))
            })
        };
        let mut table = Table::new("spectra");
        table.columns = vec![
            Column::text("direction", lines().map(|(name, ..)| name.to_owned()).collect()),
            Column::number(
                self.key(),
                unit(&self.key_unit()),
                lines().map(|(_, row, ..)| row.at.value).collect(),
            ),
            Column::number(
                "response_frequency",
                unit(&self.document.header.units.frequency),
                lines().map(|(.., frequency)| frequency).collect(),
            ),
        ];
        let names = rows.first().map_or(Vec::new(), |(_, row)| {
            row.spectra
                .measures
                .iter()
                .map(|(name, _)| name.clone())
                .collect()
        });
        for (i, name) in names.iter().enumerate() {
            let values = lines().map(|(_, row, line, _)| {
                let measure = row.spectra.measures.get(i);
                measure
                    .and_then(|(_, values)| values.get(line))
                    .copied()
                    .unwrap_or(f64::NAN)
            });
            let label = self.document.header.units.measures.get(name);
            table
                .columns
                .push(Column::number(name.clone(), unit(label), values.collect()));
        }
        table
    }
}

/// Cuts spectra that reach far and fills up short ones with gaps, so that all share one axis: to the common end, but at
/// least to half of the longest.
fn to_common_end(mut spectra: Vec<ResponseSpectrum>) -> Vec<ResponseSpectrum> {
    let ends = || {
        spectra
            .iter()
            .filter_map(|spectrum| spectrum.frequency.last().copied())
    };
    let (shortest, longest) = (ends().fold(f64::INFINITY, f64::min), ends().fold(0.0, f64::max));
    let end = shortest.max(0.5 * longest);
    for spectrum in &mut spectra {
        let kept = spectrum.frequency.partition_point(|frequency| *frequency <= end);
        spectrum.frequency.truncate(kept);
        spectrum.amplitude.truncate(kept);
        if let [first, .., last] = spectrum.frequency[..] {
            let line = (last - first) / (kept - 1) as f64;
            let missing = ((end - last) / line).floor().max(0.0) as usize;
            for k in 1..=missing {
                spectrum.frequency.push(last + k as f64 * line);
                spectrum.amplitude.push(f64::NAN);
            }
        }
    }
    spectra
}
