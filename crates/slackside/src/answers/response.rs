//! The answer of `response`.

mod designs;
mod figures;
mod motions;
mod set_valued;
mod tables;

use crate::answer::Answer;
use crate::failure::Failure;
use crate::plots;
use crate::table_text::{number, table, with_unit};
use slackside_report::plot::Axis;
use slackside_report::{Figure, Table};
use slackside_studies::response::ResponseDocument;
use slackside_studies::{Header, Label, Measures, StudyError};

/// A measure and one of its statistics, as `windup.rms`.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    pub measure: String,
    pub statistic: Statistic,
}

/// What is drawn of a measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Statistic {
    Mean,
    Rms,
    Max,
    Min,
}

impl Statistic {
    const ALL: [(&'static str, Self); 4] = [
        ("mean", Self::Mean),
        ("rms", Self::Rms),
        ("max", Self::Max),
        ("min", Self::Min),
    ];

    fn words(self) -> &'static str {
        match self {
            Self::Mean => "Mean",
            Self::Rms => "RMS",
            Self::Max => "Maximum",
            Self::Min => "Minimum",
        }
    }

    fn name(self) -> &'static str {
        let found = Self::ALL.iter().find(|(_, statistic)| *statistic == self);
        found.map_or("", |(name, _)| name)
    }
}

impl Choice {
    /// Reads `MEASURE` or `MEASURE.STATISTIC`.
    fn read(text: &str, known: &[String]) -> Result<Self, StudyError> {
        let (measure, statistic) = match text.rsplit_once('.') {
            Some((measure, last)) => match Statistic::ALL.iter().find(|(name, _)| *name == last) {
                Some((_, statistic)) => (measure, *statistic),
                None => (text, Statistic::Rms),
            },
            None => (text, Statistic::Rms),
        };
        if known.iter().any(|name| name == measure) {
            Ok(Self {
                measure: measure.to_owned(),
                statistic,
            })
        } else {
            Err(StudyError::question(
                "--measure",
                format!(
                    "there is no measure \"{measure}\"; known are {}, each with .mean, .rms, .max or .min",
                    known.join(", ")
                ),
            ))
        }
    }

    /// The measure asked for, otherwise the RMS of the wind-up, of an arm or of the first measure.
    ///
    /// # Errors
    /// [`StudyError::Question`] if there is no such measure.
    pub fn new(asked: Option<&str>, header: &Header) -> Result<Self, StudyError> {
        let names = header.units.measures.0.iter();
        let known: Vec<String> = names.map(|(name, _)| name.clone()).collect();
        let is_arm = |name: &&String| name.starts_with("arm.") && !name.ends_with(".rate");
        let usual = known.iter().find(|name| *name == "windup");
        let usual = usual.or_else(|| known.iter().find(is_arm)).or(known.first());
        let usual = usual.cloned().unwrap_or_default();
        Self::read(asked.unwrap_or(&usual), &known)
    }

    /// The name in options and tables: `windup.rms`.
    pub fn name(&self) -> String {
        format!("{}.{}", self.measure, self.statistic.name())
    }

    /// The axis of a figure.
    pub fn axis(&self, header: &Header) -> Axis {
        let words = plots::words(&self.measure);
        let unit = header.units.measures.get(&self.measure);
        Axis::linear(format!("{} of {words}", self.statistic.words()), unit)
    }

    /// The value among the measures of a motion.
    pub fn of(&self, measures: &Measures) -> f64 {
        let Some(measure) = measures.get(&self.measure) else {
            return f64::NAN;
        };
        match self.statistic {
            Statistic::Mean => measure.mean,
            Statistic::Rms => measure.rms,
            Statistic::Max => measure.max,
            Statistic::Min => measure.min,
        }
    }
}

/// The document with the measure to draw.
pub struct ResponseAnswer {
    document: ResponseDocument,
    choice: Choice,
}

impl ResponseAnswer {
    /// Chooses the measure: the one asked for, otherwise the RMS of the wind-up or of the first measure.
    ///
    /// # Errors
    /// [`StudyError::Question`] if there is no such measure.
    pub fn new(document: ResponseDocument, measure: Option<&str>) -> Result<Self, Failure> {
        let choice = Choice::new(measure, &document.header)?;
        Ok(Self { document, choice })
    }
}

impl Answer for ResponseAnswer {
    fn header(&self) -> &Header {
        &self.document.header
    }

    fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(&self.document)
    }

    fn summary(&self) -> String {
        let parameter = &self.document.parameter;
        let head = with_unit(&parameter.key, &parameter.unit);
        let measure = self.choice.name();
        let label = |label: &Option<Label>| {
            let named = label.as_ref();
            named.map_or(String::new(), |label| format!(" ({})", plots::label(label)))
        };
        let mut text = String::from("Branches\n");
        let rows = self.document.branches.iter().enumerate().map(|(index, branch)| {
            let values = || branch.points.iter().map(|point| point.at.value);
            let stable = branch.points.iter().filter(|point| point.stable).count();
            let largest = branch
                .points
                .iter()
                .map(|point| self.choice.of(&point.motion.measures));
            vec![
                format!("{index}{}", label(&branch.label)),
                branch.periods.to_string(),
                number(values().fold(f64::INFINITY, f64::min)),
                number(values().fold(f64::NEG_INFINITY, f64::max)),
                branch.points.len().to_string(),
                format!("{} %", 100 * stable / branch.points.len().max(1)),
                number(largest.fold(f64::NEG_INFINITY, f64::max)),
                branch.ends.join(", "),
            ]
        });
        text += &table(
            &[
                "branch",
                "periods",
                "lowest",
                "highest",
                "points",
                "stable",
                &format!("largest {measure}"),
                "ends",
            ],
            rows.collect(),
        );
        let special = self
            .document
            .branches
            .iter()
            .enumerate()
            .flat_map(|(index, branch)| {
                // Grazing points are many and change no stability; tables and JSON have them.
                let special = branch.special.iter().filter(|special| special.kind != "grazing");
                special.map(move |special| {
                    vec![
                        format!("{index}{}", label(&branch.label)),
                        special.kind.to_owned(),
                        format!("{:.12}", special.at.value),
                        number(self.choice.of(&special.measures)),
                    ]
                })
            });
        let special: Vec<_> = special.collect();
        let is_periodic = !self.document.uniqueness.is_empty();
        if is_periodic {
            text += "\n\n";
            text += &designs::verdicts(&self.document);
            text += &designs::optimum(&self.document);
            text += &designs::compared(&self.document);
        } else if special.is_empty() {
            text += "\n\nNo special points besides grazing.\n";
        } else {
            text += "\n\nSpecial points\n";
            text += &table(&["branch", "kind", &head, &measure], special);
            text += "\n";
        }
        if !self.document.at.is_empty() {
            text += "\nMotions at the values asked for\n";
            let rows = self.document.at.iter().map(|orbit| {
                vec![
                    format!("{}{}", orbit.branch, label(&orbit.label)),
                    number(orbit.at.value),
                    orbit.periods.to_string(),
                    if orbit.stable { "stable" } else { "unstable" }.to_owned(),
                    format!("{:.10}", self.choice.of(&orbit.motion.measures)),
                    orbit
                        .motion
                        .engaged_ratio
                        .map_or(String::new(), |ratio| format!("{ratio:.6}")),
                    orbit.motion.events.len().to_string(),
                ]
            });
            text += &table(
                &[
                    "branch",
                    &head,
                    "periods",
                    "stability",
                    &measure,
                    "engaged",
                    "events",
                ],
                rows.collect(),
            );
            text += "\n";
        }
        text
    }

    fn tables(&self) -> Vec<Table> {
        tables::all(&self.document)
    }

    fn figures(&self) -> Vec<(String, Figure)> {
        let points = self.document.branches.iter().flat_map(|branch| &branch.points);
        if !points.into_iter().any(|point| point.trust.is_some()) {
            return figures::all(&self.document, &self.choice);
        }
        let mut figures = set_valued::all(&self.document, &self.choice);
        figures.extend(motions::all(&self.document));
        figures.extend(
            figures::engagement(&self.document, &self.choice).map(|figure| ("engagement".to_owned(), figure)),
        );
        figures
    }
}
