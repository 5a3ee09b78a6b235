//! The answer of `modes` for a drive.

use super::layout::{carried, layout};
use super::sheet_figures::varied_axis;
use crate::answer::Answer;
use crate::plots;
use crate::table_text::{number, table};
use slackside_report::figures::{
    Campbell, CampbellMode, ModeKind, ModeShape, ModeShapes, campbell, mode_shapes,
};
use slackside_report::plot::Axis;
use slackside_report::{Column, Figure, Table};
use slackside_studies::Header;
use slackside_studies::drive::modes::{DriveModeRow, DriveModesDocument};
use slackside_studies::drive::steady::SteadyDocument;

/// Largest drawn deflection relative to the size of the drive.
const EXAGGERATION: f64 = 0.06;

impl Answer for DriveModesDocument {
    fn header(&self) -> &Header {
        &self.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self)
    }

    fn summary(&self) -> String {
        let mut text = format!(
            "Modes at {:.0} rpm of the driver, its motion {}\n{}\n",
            self.speed,
            self.driver,
            mode_lines(&self.modes)
        );
        let largest = self
            .modes
            .iter()
            .filter_map(|mode| Some((mode.frequency_hz / mode.strong_form_hz? - 1.0).abs()))
            .reduce(f64::max);
        if let Some(largest) = largest {
            text += &format!(
                "\nCross-check by the strong form of the equations: frequencies differ by {largest:.1e} at most.\n"
            );
        }
        if let Some(change) = self.convergence {
            text += &format!("\nTwice the sine terms change these frequencies by {change:.1e} at most.\n");
        }
        if let (Some(parameter), Some(first), Some(last)) =
            (&self.parameter, self.over.first(), self.over.last())
        {
            text += &format!(
                "\n{} values of {} from {} to {} {}\n",
                self.over.len(),
                parameter.key,
                number(first.value),
                number(last.value),
                parameter.unit
            );
        }
        if !self.resonances.is_empty() {
            let rows = self.resonances.iter().map(|row| {
                vec![
                    row.order.to_string(),
                    format!("{:.0}", row.speed),
                    format!("{:.1}", row.frequency_hz),
                    row.mode.to_string(),
                    row.kind.clone(),
                ]
            });
            let head = ["order", "resonance at (rpm)", "frequency (Hz)", "mode", "moves"];
            text += &format!("\n{}\n", table(&head, rows.collect()));
        }
        if let Some(limit) = &self.limit_speed {
            text += &format!(
                "\nNo stable steady state above {:.0} rpm: {}\n",
                limit.speed, limit.reason
            );
        }
        text
    }

    fn tables(&self) -> Vec<Table> {
        let mut tables = vec![mode_table(&self.modes)];
        if let Some(parameter) = &self.parameter {
            tables.push(campbell_table(self, &parameter.key, &parameter.unit));
        }
        if !self.resonances.is_empty() {
            let column = |value: &dyn Fn(usize) -> f64| (0..self.resonances.len()).map(value).collect();
            let mut table = Table::new("resonances");
            table.columns = vec![
                Column::number("order", "", column(&|k| self.resonances[k].order)),
                Column::number("speed", "rpm", column(&|k| self.resonances[k].speed)),
                Column::number("frequency", "Hz", column(&|k| self.resonances[k].frequency_hz)),
                Column::number("mode", "", column(&|k| self.resonances[k].mode as f64)),
                Column::text(
                    "kind",
                    self.resonances.iter().map(|row| row.kind.clone()).collect(),
                ),
            ];
            tables.push(table);
        }
        tables
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        let pages = mode_shapes(
            &ModeShapes {
                layout: layout(&self.sheet),
                modes: self
                    .modes
                    .iter()
                    .enumerate()
                    .map(|(k, mode)| shape(&self.sheet, k, mode))
                    .collect(),
            },
            &plots::options(),
        );
        let mut figures: Vec<(String, Figure)> = pages
            .into_iter()
            .enumerate()
            .map(|(page, figure)| (format!("mode_shapes_{}", page + 1), figure))
            .collect();
        if let Some(parameter) = &self.parameter {
            figures.push((
                "campbell".to_owned(),
                campbell_figure(self, &parameter.key, &parameter.unit),
            ));
        }
        figures
    }
}

fn mode_lines(modes: &[DriveModeRow]) -> String {
    let rows = modes.iter().enumerate().map(|(k, mode)| {
        let sum = |prefix: &str| -> f64 {
            let parts = mode.shares.0.iter();
            parts
                .filter(|(name, _)| name.starts_with(prefix))
                .map(|(_, share)| share)
                .sum()
        };
        let percent = |prefix: &str| format!("{:.1} %", 100.0 * sum(prefix));
        vec![
            (k + 1).to_string(),
            format!("{:.3}", mode.frequency_hz),
            format!("{:.4}", mode.damping_ratio),
            mode.kind.clone(),
            percent("rotation."),
            percent("arm."),
            percent("span."),
        ]
    });
    table(
        &[
            "mode",
            "frequency (Hz)",
            "damping ratio",
            "moves",
            "rotation",
            "arms",
            "spans",
        ],
        rows.collect(),
    )
}

fn mode_table(modes: &[DriveModeRow]) -> Table {
    let column = |value: &dyn Fn(&DriveModeRow) -> f64| modes.iter().map(value).collect::<Vec<f64>>();
    let mut table = Table::new("modes");
    table.columns = vec![
        Column::number("frequency", "Hz", column(&|mode| mode.frequency_hz)),
        Column::number("damping_ratio", "", column(&|mode| mode.damping_ratio)),
        Column::number(
            "strong_form",
            "Hz",
            column(&|mode| mode.strong_form_hz.unwrap_or(f64::NAN)),
        ),
        Column::text("kind", modes.iter().map(|mode| mode.kind.clone()).collect()),
    ];
    if let Some(first) = modes.first() {
        for (k, (name, _)) in first.shares.0.iter().enumerate() {
            table.columns.push(Column::number(
                format!("share.{name}"),
                "",
                column(&|mode| mode.shares.0[k].1),
            ));
        }
    }
    table
}

/// A mode as it is drawn: at the phase of its largest displacement.
fn shape(sheet: &SteadyDocument, number: usize, mode: &DriveModeRow) -> ModeShape {
    let scale = EXAGGERATION * size(sheet);
    let mut centers: Vec<[f64; 2]> = sheet.pulleys.iter().map(|pulley| pulley.center).collect();
    for (tensioner, motion) in sheet.tensioners.iter().zip(&mode.arms) {
        for j in carried(sheet, &tensioner.name) {
            let at = sheet.pulleys[j].center;
            let rate = match (tensioner.pivot, tensioner.direction) {
                (Some(pivot), _) => [-(at[1] - pivot[1]), at[0] - pivot[0]],
                (None, direction) => direction.unwrap_or_default(),
            };
            centers[j] = [
                at[0] + scale * motion[0] * rate[0],
                at[1] + scale * motion[0] * rate[1],
            ];
        }
    }
    let spans = sheet.spans.iter().zip(&mode.spans).map(|(span, points)| {
        let [start, end] = span.ends;
        let along = [end[0] - start[0], end[1] - start[1]];
        let length = along[0].hypot(along[1]);
        let normal = [-along[1] / length, along[0] / length];
        let last = (points.len() - 1) as f64;
        points
            .iter()
            .enumerate()
            .map(|(k, point)| {
                let share = k as f64 / last;
                let across = scale * point[0];
                [
                    start[0] + share * along[0] + across * normal[0],
                    start[1] + share * along[1] + across * normal[1],
                ]
            })
            .collect()
    });
    ModeShape {
        heading: format!("{}: {:.1} Hz, {}", number + 1, mode.frequency_hz, mode.kind),
        spans: spans.collect(),
        rotations: sheet
            .pulleys
            .iter()
            .zip(&mode.rotations)
            .map(|(pulley, rotation)| pulley.sense * scale * rotation[0])
            .collect(),
        centers,
    }
}

/// The greater side of the drive, m.
fn size(sheet: &SteadyDocument) -> f64 {
    let extent = |axis: usize| {
        let low = sheet
            .pulleys
            .iter()
            .map(|pulley| pulley.center[axis] - pulley.radius)
            .fold(f64::INFINITY, f64::min);
        let high = sheet
            .pulleys
            .iter()
            .map(|pulley| pulley.center[axis] + pulley.radius)
            .fold(f64::NEG_INFINITY, f64::max);
        high - low
    };
    extent(0).max(extent(1))
}

fn campbell_table(document: &DriveModesDocument, key: &str, unit: &str) -> Table {
    let mut table = Table::new("campbell");
    let values = document.over.iter().map(|row| row.value).collect();
    table.columns.push(Column::number(key, unit, values));
    let curves = document.over.iter().map(|row| row.frequencies_hz.len()).min();
    for k in 0..curves.unwrap_or(0) {
        table.columns.push(Column::number(
            format!("frequency_{}", k + 1),
            "Hz",
            document.over.iter().map(|row| row.frequencies_hz[k]).collect(),
        ));
        table.columns.push(Column::text(
            format!("kind_{}", k + 1),
            document.over.iter().map(|row| row.kinds[k].clone()).collect(),
        ));
    }
    table
}

fn campbell_figure(document: &DriveModesDocument, key: &str, unit: &str) -> Figure {
    let curves = document.over.iter().map(|row| row.frequencies_hz.len()).min();
    let modes = (0..curves.unwrap_or(0)).map(|k| CampbellMode {
        name: (k + 1).to_string(),
        speed: document.over.iter().map(|row| row.value).collect(),
        frequency: document.over.iter().map(|row| row.frequencies_hz[k]).collect(),
        kinds: document
            .over
            .iter()
            .map(|row| kind(&document.sheet, &row.kinds[k]))
            .collect(),
    });
    let over_speed = key == "speed";
    let mut orders: Vec<f64> = document.resonances.iter().map(|row| row.order).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    let input = Campbell {
        speed: varied_axis(key, unit),
        frequency: Axis::linear("Natural frequency", "Hz"),
        modes: modes.collect(),
        orders,
        order_slope: 1.0 / 60.0,
        crossings: document
            .resonances
            .iter()
            .map(|row| [row.speed, row.frequency_hz])
            .collect(),
        critical_speed: document
            .limit_speed
            .as_ref()
            .filter(|_| over_speed)
            .map(|limit| limit.speed),
    };
    campbell(&input, &plots::options())
}

fn kind(sheet: &SteadyDocument, name: &str) -> ModeKind {
    match name {
        "rotation" => ModeKind::Rotation,
        "arm" => ModeKind::Arm,
        _ => sheet
            .spans
            .iter()
            .position(|span| name == format!("span {}-{}", span.from, span.to))
            .map_or(ModeKind::Mixed, |span| ModeKind::Span(span + 1)),
    }
}
