//! The answer of `basin`.

use super::simulate::unit;
use crate::answer::Answer;
use crate::plots;
use crate::table_text::{number, table};
use slackside_report::figures::{Basin, basin};
use slackside_report::plot::Axis;
use slackside_report::{Column, Figure, Table};
use slackside_studies::Header;
use slackside_studies::basin::BasinDocument;

impl Answer for BasinDocument {
    fn header(&self) -> &Header {
        &self.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }

    fn summary(&self) -> String {
        let cells = self.across.values.len() * self.down.values.len();
        let share = |count: usize| format!("{:.2} %", 100.0 * count as f64 / cells.max(1) as f64);
        let first = self.header.units.measures.0.iter().map(|(name, _)| name);
        let measure = first
            .clone()
            .find(|name| *name == "windup")
            .or(first.clone().next());
        let measure = measure.cloned().unwrap_or_default();
        let rows = self.attractors.iter().enumerate().map(|(index, attractor)| {
            vec![
                index.to_string(),
                format!("periodic-{}", attractor.periods),
                share(attractor.cells),
                attractor
                    .measures
                    .get(&measure)
                    .map_or(String::new(), |m| number(m.rms)),
                attractor.largest_multiplier.map_or(String::new(), number),
            ]
        });
        let mut text = format!(
            "{cells} initial states at {} = {}\n",
            self.at.key,
            number(self.at.value)
        );
        text += &table(
            &[
                "attractor",
                "motion",
                "share",
                &format!("{measure}.rms"),
                "largest multiplier",
            ],
            rows.collect(),
        );
        for (count, what) in [
            (self.not_periodic, "did not become periodic"),
            (self.failed, "could not be computed"),
            (self.not_computed, "were not computed"),
        ] {
            if count > 0 {
                text += &format!("\n{} of the motions {what}", share(count));
            }
        }
        text + "\n"
    }

    fn tables(&self) -> Vec<Table> {
        let (mut x, mut y, mut label) = (Vec::new(), Vec::new(), Vec::new());
        for (row, cells) in self.cells.iter().enumerate() {
            for (column, cell) in cells.iter().enumerate() {
                x.push(self.across.values.get(column).copied().unwrap_or(f64::NAN));
                y.push(self.down.values.get(row).copied().unwrap_or(f64::NAN));
                label.push(cell.map_or(-1, |index| i64::try_from(index).unwrap_or(i64::MAX)));
            }
        }
        let mut cells = Table::new("basin");
        let label_of = |entry: &str| unit(self.header.units.measures.get(entry));
        cells.columns.push(Column::number(
            self.across.entry.clone(),
            label_of(&self.across.entry),
            x,
        ));
        cells.columns.push(Column::number(
            self.down.entry.clone(),
            label_of(&self.down.entry),
            y,
        ));
        cells.columns.push(Column::integer("attractor", label));
        let points = || {
            let attractors = self.attractors.iter().zip(0_i64..);
            attractors
                .flat_map(|(attractor, index)| attractor.poincare.iter().map(move |point| (index, point)))
        };
        let mut attractors = Table::new("attractors");
        attractors.columns.push(Column::integer(
            "attractor",
            points().map(|(index, _)| index).collect(),
        ));
        for (i, name) in self.state.iter().enumerate() {
            let values = points().map(|(_, point)| point.get(i).copied().unwrap_or(f64::NAN));
            attractors
                .columns
                .push(Column::number(name.clone(), "", values.collect()));
        }
        vec![cells, attractors]
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        let ends = |values: &[f64]| match (values.first(), values.last()) {
            (Some(first), Some(last)) => [*first, *last],
            _ => [0.0, 1.0],
        };
        let entry = |name: &str| self.state.iter().position(|known| known == name);
        let points = match (entry(&self.across.entry), entry(&self.down.entry)) {
            (Some(x), Some(y)) => {
                let (x_ends, y_ends) = (ends(&self.across.values), ends(&self.down.values));
                let inside = |value: f64, [a, b]: [f64; 2]| a.min(b) <= value && value <= a.max(b);
                let all = self.attractors.iter().flat_map(|attractor| &attractor.poincare);
                all.filter_map(|point| Some([*point.get(x)?, *point.get(y)?]))
                    .filter(|[x, y]| inside(*x, x_ends) && inside(*y, y_ends))
                    .collect()
            }
            _ => Vec::new(),
        };
        let axis = |name: &str| -> Axis { plots::axis(name, self.header.units.measures.get(name)) };
        let names = self.attractors.iter().enumerate();
        let figure = basin(
            &Basin {
                x: axis(&self.across.entry),
                y: axis(&self.down.entry),
                x_centres: ends(&self.across.values),
                y_centres: ends(&self.down.values),
                columns: self.across.values.len(),
                cells: self.cells.iter().flatten().copied().collect(),
                attractors: names
                    .map(|(index, attractor)| format!("{index}: period {}", attractor.periods))
                    .collect(),
                points,
            },
            &plots::options(),
        );
        vec![("basin".to_owned(), figure)]
    }
}
