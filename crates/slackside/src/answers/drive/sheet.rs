//! The answer of `check` for a drive: the steady sheet.

use super::{degrees, fixed, millimetres};
use super::{sheet_figures, sheet_tables};
use crate::answer::Answer;
use crate::table_text::table;
use slackside_report::{Figure, Table};
use slackside_studies::Header;
use slackside_studies::drive::steady::{Outcome, StateRow, SteadyDocument};

impl Answer for SteadyDocument {
    fn header(&self) -> &Header {
        &self.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self)
    }

    fn summary(&self) -> String {
        let mut text = format!(
            "{}: a sound {} with {} pulleys, at {:.0} rpm of the driver\n\n",
            self.header.input.file,
            self.kind,
            self.pulleys.len(),
            self.speed
        );
        text += &format!(
            "Belt: pitch length {} mm, natural length {} mm, speed {:.2} m/s, centrifugal tension {:.1} N\n\n",
            millimetres(self.belt.pitch_length),
            millimetres(self.belt.natural_length),
            self.belt.speed,
            self.belt.centrifugal_tension
        );
        text += &(spans(self) + "\n\n");
        text += &(pulleys(self) + "\n");
        if !self.tensioners.is_empty() {
            text += &format!("\n{}\n", tensioners(self));
        }
        text += &format!("\nThe driver supplies {:.2} N m", self.driver_torque);
        text += &match self.efficiency {
            Some(efficiency) => format!("; belt creep leaves {:.2} % of its power.\n", 100.0 * efficiency),
            None => ".\n".to_owned(),
        };
        if let Some(check) = &self.cross_check {
            text += &format!(
                "Cross-check by the {}: effective tensions differ by {:.3} % at most.\n",
                check.method,
                100.0 * check.largest_difference
            );
        }
        if !self.conditions.is_empty() {
            text += &format!("\nConditions of service\n{}\n", conditions(self));
        }
        if let Some(parameter) = &self.parameter {
            text += &format!(
                "\nLowest effective tension over {}\n{}\n",
                parameter.key,
                lowest(self)
            );
        }
        text
    }

    fn tables(&self) -> Vec<Table> {
        sheet_tables::tables(self)
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        sheet_figures::figures(self)
    }
}

fn spans(sheet: &SteadyDocument) -> String {
    let rows = sheet.spans.iter().enumerate().map(|(i, span)| {
        vec![
            format!("{} {}-{}", i + 1, span.from, span.to),
            millimetres(span.length),
            fixed(span.tension, 1),
            fixed(span.effective_tension, 1),
            fixed(span.frequency_1, 1),
            fixed(span.sag_indicator, 3),
        ]
    });
    table(
        &[
            "span",
            "length (mm)",
            "tension (N)",
            "effective (N)",
            "first frequency (Hz)",
            "sag χ",
        ],
        rows.collect(),
    )
}

fn pulleys(sheet: &SteadyDocument) -> String {
    let rows = sheet.pulleys.iter().enumerate().map(|(j, pulley)| {
        vec![
            format!("{} {}", j + 1, pulley.name),
            fixed(pulley.speed, 0),
            degrees(pulley.wrap),
            fixed(pulley.torque, 2),
            fixed(pulley.hub_load_magnitude, 1),
            degrees(pulley.hub_load_direction),
            pulley
                .slip_safety
                .map_or_else(|| "–".to_owned(), |safety| fixed(safety, 2)),
            pulley
                .speed_loss
                .map_or_else(|| "–".to_owned(), |loss| fixed(100.0 * loss, 3)),
        ]
    });
    table(
        &[
            "pulley",
            "speed (rpm)",
            "wrap (°)",
            "torque (N m)",
            "hub load (N)",
            "at (°)",
            "slip safety",
            "creep (%)",
        ],
        rows.collect(),
    )
}

fn tensioners(sheet: &SteadyDocument) -> String {
    let rows = sheet.tensioners.iter().map(|row| {
        let is_linear = row.angle.is_none();
        let position = |value: f64| {
            if is_linear {
                format!("{} mm", millimetres(value))
            } else {
                format!("{:.2}°", value.to_degrees())
            }
        };
        vec![
            row.name.clone(),
            position(row.angle.or(row.position).unwrap_or_default()),
            position(row.travel),
            if is_linear {
                format!("{:.3} mm/mm", row.take_up)
            } else {
                format!("{:.3} mm/°", 1e3 * row.take_up / 1f64.to_degrees())
            },
            format!("{:.2} {}", row.torque, if is_linear { "N" } else { "N m" }),
        ]
    });
    table(
        &["tensioner", "position", "from reference", "take-up", "spring"],
        rows.collect(),
    )
}

fn conditions(sheet: &SteadyDocument) -> String {
    let rows = sheet.conditions.iter().map(|condition| {
        let mut row = vec![condition.name.clone()];
        match &condition.outcome {
            Outcome::State(state) => row.extend(state_cells(sheet, state)),
            Outcome::Impossible { .. } => row.extend(["impossible", "", "", ""].map(str::to_owned)),
        }
        row
    });
    let text = table(
        &[
            "condition",
            "lowest tension (N)",
            "highest tension (N)",
            "lowest slip safety",
            "arms",
        ],
        rows.collect(),
    );
    let reasons = sheet
        .conditions
        .iter()
        .filter_map(|condition| match &condition.outcome {
            Outcome::Impossible { impossible } => Some(format!("\n{}: {impossible}", condition.name)),
            Outcome::State(_) => None,
        });
    text + &reasons.collect::<String>()
}

fn state_cells(sheet: &SteadyDocument, state: &StateRow) -> Vec<String> {
    let lowest = state.tensions.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = state.tensions.iter().copied().fold(0.0, f64::max);
    let safety = state
        .slip_safeties
        .iter()
        .flatten()
        .copied()
        .fold(f64::INFINITY, f64::min);
    let arms: Vec<String> = sheet
        .tensioners
        .iter()
        .zip(&state.positions)
        .map(|(tensioner, position)| {
            if tensioner.angle.is_some() {
                format!("{:.2}°", position.to_degrees())
            } else {
                format!("{} mm", millimetres(*position))
            }
        })
        .collect();
    vec![
        fixed(lowest, 1),
        fixed(highest, 1),
        if safety.is_finite() {
            fixed(safety, 2)
        } else {
            "–".to_owned()
        },
        arms.join(", "),
    ]
}

/// The slackest span of every condition over the varied quantity.
fn lowest(sheet: &SteadyDocument) -> String {
    let key = sheet.parameter.as_ref().map_or(String::new(), |parameter| {
        format!("at {} ({})", parameter.key, parameter.unit)
    });
    let rows = sheet.over.iter().map(|row| {
        let states = row
            .values
            .iter()
            .zip(&row.outcomes)
            .filter_map(|(value, outcome)| match outcome {
                Outcome::State(state) => Some((value, state)),
                Outcome::Impossible { .. } => None,
            });
        let found = states
            .flat_map(|(value, state)| {
                let spans = state.effective_tensions.iter().enumerate();
                spans.map(move |(span, tension)| (*tension, span, *value))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let possible = row
            .outcomes
            .iter()
            .filter(|outcome| matches!(outcome, Outcome::State(_)))
            .count();
        let mut cells = vec![row.name.clone()];
        match found {
            Some((tension, span, value)) => cells.extend([
                fixed(tension, 1),
                format!("{} {}-{}", span + 1, sheet.spans[span].from, sheet.spans[span].to),
                crate::table_text::number(value),
            ]),
            None => cells.extend(["–", "", ""].map(str::to_owned)),
        }
        cells.push(format!("{possible} of {}", row.values.len()));
        cells
    });
    table(
        &["condition", "tension (N)", "span", &key, "possible"],
        rows.collect(),
    )
}
