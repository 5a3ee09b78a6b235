//! The answer of `limit`.

use crate::answer::Answer;
use crate::plots;
use crate::table_text::{number, table, with_unit};
use slackside_report::figures::{CriticalLevel, Curve, critical_level};
use slackside_report::plot::Axis;
use slackside_report::{Column, Figure, Table};
use slackside_studies::Header;
use slackside_studies::limit::{LimitDocument, LimitKind, LimitRow};

/// Ratio of largest to smallest limit from which the axis is logarithmic.
const WIDE: f64 = 30.0;

/// Name of the varied quantity.
fn key(document: &LimitDocument) -> &str {
    document.points.first().map_or("", |row| row.at.key.as_str())
}

/// The load or friction that the model has, if it is the same at all values.
fn constant_present(document: &LimitDocument) -> Option<f64> {
    let first = document.points.first()?.present?;
    let same = |row: &LimitRow| {
        row.present
            .is_some_and(|value| (value - first).abs() <= 1e-9 * first.abs())
    };
    document.points.iter().all(same).then_some(first)
}

/// What the model has, in words.
fn present_name(kind: LimitKind) -> &'static str {
    match kind {
        LimitKind::CriticalLoad => "load of the model",
        LimitKind::CriticalTorque => "friction of the model",
    }
}

/// One sentence: where the element is locked for all time.
fn verdict(document: &LimitDocument) -> String {
    let element = &document.element;
    let moves = document.points.iter().filter(|row| !row.locked).count();
    let what = match document.limit {
        LimitKind::CriticalLoad => "open",
        LimitKind::CriticalTorque => "slip",
    };
    if moves == 0 {
        return format!("\"{element}\" does not {what} at any of the values.\n");
    }
    if moves == document.points.len() {
        return format!("\"{element}\" {what}s at all values.\n");
    }
    let places: Vec<String> = (document.transitions.iter())
        .map(|transition| {
            let change = if transition.locked_above {
                "locked"
            } else {
                "moving"
            };
            format!("{} ({change} above)", number(transition.at.value))
        })
        .collect();
    format!(
        "\"{element}\" {what}s at {moves} of {} values; it passes the limit at {} = {}.\n",
        document.points.len(),
        key(document),
        places.join(", ")
    )
}

impl Answer for LimitDocument {
    fn header(&self) -> &Header {
        &self.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self)
    }

    fn summary(&self) -> String {
        let torque = &self.header.units.torque;
        let name = self.limit.name();
        let mut text = format!("{} of \"{}\"\n", plots::capital(name), self.element);
        let by_size = |a: &&LimitRow, b: &&LimitRow| a.value.total_cmp(&b.value);
        let ends = [
            ("first", self.points.first()),
            ("smallest", self.points.iter().min_by(by_size)),
            ("largest", self.points.iter().max_by(by_size)),
            ("last", self.points.last()),
        ];
        let rows = ends.into_iter().filter_map(|(which, row)| {
            let row = row?;
            Some(vec![
                which.to_owned(),
                number(row.at.value),
                number(row.value),
                row.present.map_or("–".to_owned(), number),
                if row.locked { "yes" } else { "no" }.to_owned(),
            ])
        });
        let head = [
            String::new(),
            with_unit(key(self), &self.unit),
            with_unit(name, torque),
            with_unit(present_name(self.limit), torque),
            "locked".to_owned(),
        ];
        let head: Vec<&str> = head.iter().map(String::as_str).collect();
        text += &table(&head, rows.collect());
        text += "\n\n";
        text + &verdict(self)
    }

    fn tables(&self) -> Vec<Table> {
        let torque = &self.header.units.torque;
        let column = |value: &dyn Fn(&LimitRow) -> f64| self.points.iter().map(value).collect::<Vec<f64>>();
        let optional = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let mut limit = Table::new("limit");
        limit.columns = vec![
            Column::number(key(self), self.unit.clone(), column(&|row| row.at.value)),
            Column::number("value", torque.clone(), column(&|row| row.value)),
            Column::number("present", torque.clone(), column(&|row| optional(row.present))),
            Column::text(
                "locked",
                self.points.iter().map(|row| row.locked.to_string()).collect(),
            ),
            Column::number("minimum", torque.clone(), column(&|row| row.minimum)),
            Column::number("maximum", torque.clone(), column(&|row| row.maximum)),
        ];
        match self.limit {
            LimitKind::CriticalLoad => {
                let opens = column(&|row| optional(row.opens_at));
                limit.columns.push(Column::number("opens_at", "", opens));
            }
            LimitKind::CriticalTorque => {
                let angle = self.header.units.angle.clone();
                let offset = column(&|row| optional(row.offset));
                limit.columns.push(Column::number("offset", angle, offset));
                let stiffness = column(&|row| optional(row.stiffness));
                limit.columns.push(Column::number("stiffness", "", stiffness));
            }
        }
        let mut resonances = Table::new("resonances");
        let of = |value: &dyn Fn(usize) -> f64| (0..self.resonances.len()).map(value).collect::<Vec<f64>>();
        resonances.columns = vec![
            Column::number(key(self), self.unit.clone(), of(&|i| self.resonances[i].at.value)),
            Column::number("order", "", of(&|i| self.resonances[i].order as f64)),
            Column::number("mode", "", of(&|i| self.resonances[i].mode as f64)),
        ];
        let mut transitions = Table::new("transitions");
        let values = self.transitions.iter().map(|t| t.at.value).collect();
        let locked = self.transitions.iter().map(|t| t.locked_above.to_string());
        transitions.columns = vec![
            Column::number(key(self), self.unit.clone(), values),
            Column::text("locked_above", locked.collect()),
        ];
        let mut tables = vec![limit];
        tables.extend(
            [resonances, transitions]
                .into_iter()
                .zip([self.resonances.len(), self.transitions.len()])
                .filter(|(_, rows)| *rows > 0)
                .map(|(table, _)| table),
        );
        tables
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        let torque = self.header.units.torque.clone();
        let name = plots::capital(self.limit.name());
        let x: Vec<f64> = self.points.iter().map(|row| row.at.value).collect();
        let y: Vec<f64> = self.points.iter().map(|row| row.value).collect();
        let (low, high) = y.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &value| {
            (low.min(value), high.max(value))
        });
        let constant = constant_present(self);
        let mut curves = vec![Curve {
            name: plots::words(&self.element),
            x: x.clone(),
            y,
        }];
        let present: Vec<f64> = self.points.iter().filter_map(|row| row.present).collect();
        if constant.is_none() && present.len() == x.len() {
            curves.push(Curve {
                name: present_name(self.limit).to_owned(),
                x,
                y: present,
            });
        }
        let level = if low > 0.0 && high > WIDE * low {
            Axis::logarithmic(name, torque)
        } else {
            Axis::linear(name, torque)
        };
        let input = CriticalLevel {
            x: plots::axis(key(self), &self.unit),
            level,
            curves,
            resonances: self.resonances.iter().map(|found| found.at.value).collect(),
            actual: constant
                .filter(|value| *value > 0.0)
                .map(|value| (value, present_name(self.limit).to_owned())),
        };
        vec![("limit".to_owned(), critical_level(&input, &plots::options()))]
    }
}
