//! The answer of `simulate`.

mod figures;

use crate::answer::Answer;
use crate::table_text::{number, table, with_unit};
use slackside_report::{Column, Figure, Table};
use slackside_studies::simulate::SimulateDocument;
use slackside_studies::{Event, Header};

/// Events shown in the summary.
const EVENTS_SHOWN: usize = 12;

impl Answer for SimulateDocument {
    fn header(&self) -> &Header {
        &self.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }

    fn summary(&self) -> String {
        let units = &self.header.units;
        let mut text = format!(
            "{} periods at frequency {}\n",
            self.periods,
            with_unit(&number(self.frequency), &units.frequency)
        );
        let rows = self.measures.0.iter().map(|(name, m)| {
            vec![
                with_unit(name, units.measures.get(name)),
                number(m.mean),
                number(m.rms),
                number(m.max),
                number(m.min),
            ]
        });
        text += &table(&["measure", "mean", "rms", "max", "min"], rows.collect());
        text += &format!("\n\n{} events", self.events.len());
        if self.events.is_empty() {
            return text + "\n";
        }
        let shown = self.events.len().min(EVENTS_SHOWN);
        if shown < self.events.len() {
            text += &format!(", the last {shown}:");
        }
        text += "\n";
        let rows = self.events[self.events.len() - shown..].iter().map(|event| {
            vec![
                event.event.element.clone(),
                format!("{:.8}", event.time),
                format!("{:.6}", event.event.phase),
                event.event.from.clone(),
                event.event.to.clone(),
            ]
        });
        text + &table(
            &["element", &with_unit("time", &units.time), "phase", "from", "to"],
            rows.collect(),
        ) + "\n"
    }

    fn tables(&self) -> Vec<Table> {
        let units = &self.header.units;
        let mut series = Table::new("series");
        series.columns.push(Column::number(
            "time",
            unit(&units.time),
            self.series.time.clone(),
        ));
        for (name, values) in &self.series.measures {
            if name != "time" {
                let column = Column::number(name.clone(), unit(units.measures.get(name)), values.clone());
                series.columns.push(column);
            }
        }
        let text =
            |value: &dyn Fn(&Event) -> String| self.events.iter().map(|timed| value(&timed.event)).collect();
        let mut events = Table::new("events");
        events.columns = vec![
            Column::number(
                "time",
                unit(&units.time),
                self.events.iter().map(|event| event.time).collect(),
            ),
            Column::number(
                "phase",
                "",
                self.events.iter().map(|timed| timed.event.phase).collect(),
            ),
            Column::text("element", text(&|event| event.element.clone())),
            Column::text("from", text(&|event| event.from.clone())),
            Column::text("to", text(&|event| event.to.clone())),
        ];
        let mut spectrum = Table::new("spectrum");
        spectrum.columns.push(Column::number(
            "frequency",
            unit(&units.frequency),
            self.spectrum.frequency.clone(),
        ));
        for (name, values) in self
            .spectrum
            .amplitudes
            .0
            .iter()
            .filter(|(name, _)| name != "frequency")
        {
            let amplitudes = values.iter().map(|[re, im]| re.hypot(*im)).collect();
            let column = Column::number(name.clone(), unit(units.measures.get(name)), amplitudes);
            spectrum.columns.push(column);
        }
        vec![series, events, spectrum]
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        figures::all(self)
    }
}

/// Units in tables: none instead of a dash.
pub fn unit(unit: &str) -> String {
    if unit == "–" {
        String::new()
    } else {
        unit.to_owned()
    }
}
