//! The answer of `check`.

use super::modes::mode_lines;
use crate::answer::Answer;
use crate::table_text::{number, table, with_unit};
use slackside_report::{Column, Figure, Table};
use slackside_studies::Header;
use slackside_studies::check::CheckDocument;

impl Answer for CheckDocument {
    fn header(&self) -> &Header {
        &self.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self)
    }

    fn summary(&self) -> String {
        let units = &self.header.units;
        let mut text = format!("{}: a sound {} model\n", self.header.input.file, self.kind);
        if let Some(rest) = &self.equilibrium {
            text += "\nStatic equilibrium\n";
            let rows = rest.elements.iter().map(|element| {
                vec![
                    element.element.clone(),
                    element.law.to_owned(),
                    element.regime.unwrap_or("").to_owned(),
                    number(element.displacement),
                    number(element.force),
                ]
            });
            text += &table(
                &[
                    "element",
                    "law",
                    "regime",
                    &with_unit("displacement", &units.angle),
                    &with_unit("force", &units.torque),
                ],
                rows.collect(),
            );
            text += "\n";
        }
        text += "\nModes\n";
        text += &mode_lines(&self.modes, &units.frequency);
        text += "\n";
        for separation in &self.separation {
            let onset: Vec<String> = separation.onset.iter().map(|omega| number(*omega)).collect();
            let element = &separation.element;
            text += &if onset.is_empty() {
                format!(
                    "\nThe linear response keeps \"{element}\" {} at all frequencies: it takes up {:.0} % of the distance at most, at {}.\n",
                    separation.regime,
                    100.0 * separation.worst_ratio,
                    with_unit(&number(separation.worst_frequency), &units.frequency),
                )
            } else {
                format!(
                    "\nThe linear response of \"{element}\" stops being {} at {}.\n",
                    separation.regime,
                    with_unit(&onset.join(", "), &units.frequency),
                )
            };
        }
        if let Some(preload) = self.critical_preload {
            text += &format!(
                "No separation at any frequency above a preload of {}.\n",
                with_unit(&number(preload), &units.torque)
            );
        }
        text
    }

    fn tables(&self) -> Vec<Table> {
        let mut tables = vec![super::modes::mode_table(
            &self.modes,
            &self.header.units.frequency,
        )];
        if let Some(rest) = &self.equilibrium
            && !rest.elements.is_empty()
        {
            let column = |value: &dyn Fn(usize) -> f64| (0..rest.elements.len()).map(value).collect();
            let text = |value: &dyn Fn(usize) -> String| (0..rest.elements.len()).map(value).collect();
            let mut elements = Table::new("equilibrium");
            elements.columns = vec![
                Column::text("element", text(&|i| rest.elements[i].element.clone())),
                Column::text("law", text(&|i| rest.elements[i].law.to_owned())),
                Column::text(
                    "regime",
                    text(&|i| rest.elements[i].regime.unwrap_or("").to_owned()),
                ),
                Column::number(
                    "displacement",
                    self.header.units.angle.clone(),
                    column(&|i| rest.elements[i].displacement),
                ),
                Column::number(
                    "force",
                    self.header.units.torque.clone(),
                    column(&|i| rest.elements[i].force),
                ),
            ];
            tables.push(elements);
        }
        tables
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        Vec::new()
    }
}
