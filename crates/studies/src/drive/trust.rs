//! Where the motion of a drive leaves what its model holds for: slack spans, gross slip (theory 04 §8.4).

use crate::drive::running::RunningDrive;
use serde::Serialize;
use slackside_dynamics::flow::Record;

/// Samples of a period from which the slip margin is taken.
pub(crate) const SAMPLES: usize = 256;

/// A reason not to trust a motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Remark {
    /// `slack-span`, `gross-slip`.
    pub kind: &'static str,
    /// The span or pulley.
    pub at: String,
    /// Smallest effective tension of the span (N, negative), or smallest safety against slip (below one).
    pub value: f64,
}

/// What the belt needs to hold.
pub(crate) struct Belt {
    spans: Vec<Span>,
    pulleys: Vec<Grip>,
}

struct Span {
    name: String,
    /// Index of the measure of its tension.
    measure: usize,
    /// Tension at which it is slack: what the belt's mass needs to follow the pulleys.
    slack: f64,
}

struct Grip {
    name: String,
    /// Spans before and behind the pulley.
    spans: [usize; 2],
    /// Friction times wrap.
    grip: f64,
}

impl Belt {
    pub fn new(running: &RunningDrive) -> Self {
        let (drive, steady) = (&running.drive, &running.steady);
        let count = drive.pulleys.len();
        let spans = (0..count).filter_map(|i| {
            let name = drive.span_name(i);
            Some(Span {
                measure: running.system.system.output_index(&format!("tension.{name}"))?,
                name,
                slack: steady.tensions[i] - steady.effective_tensions[i],
            })
        });
        let pulleys = drive.pulleys.iter().enumerate().map(|(j, pulley)| Grip {
            name: pulley.name.clone(),
            spans: [drive.span_before(j), j],
            grip: pulley.friction * steady.layout.wraps[j],
        });
        Self {
            spans: spans.collect(),
            pulleys: pulleys.collect(),
        }
    }

    /// What speaks against a motion.
    pub fn remarks(&self, record: &Record) -> Vec<Remark> {
        let mut remarks = Vec::new();
        for span in &self.spans {
            let least = record
                .measures
                .get(span.measure)
                .map_or(f64::NAN, |measure| measure.min);
            if least < span.slack {
                remarks.push(Remark {
                    kind: "slack-span",
                    at: span.name.clone(),
                    value: least - span.slack,
                });
            }
        }
        for pulley in &self.pulleys {
            // Where a span is slack, slip is no question of its own.
            if let Some(safety) = self.safety(pulley, record).filter(|safety| *safety < 1.0) {
                remarks.push(Remark {
                    kind: "gross-slip",
                    at: pulley.name.clone(),
                    value: safety,
                });
            }
        }
        remarks
    }

    /// Smallest safety against slip over the period; `None` if a span is slack.
    fn safety(&self, pulley: &Grip, record: &Record) -> Option<f64> {
        let tension = |span: usize| {
            let span = self.spans.get(span)?;
            Some((record.samples.get(span.measure)?, span.slack))
        };
        let [(before, slack_before), (behind, slack_behind)] =
            [tension(pulley.spans[0])?, tension(pulley.spans[1])?];
        let mut least = f64::INFINITY;
        for (before, behind) in before.iter().zip(behind) {
            let (before, behind) = (before - slack_before, behind - slack_behind);
            if before <= 0.0 || behind <= 0.0 {
                return None;
            }
            least = least.min(pulley.grip / (before / behind).ln().abs());
        }
        Some(least)
    }
}

/// Remarks in words, one text for each kind: where each span or pulley is concerned. `over` names what the numbers beside the
/// remarks are values of, if they are.
pub(crate) fn in_words(remarks: &[(f64, Remark)], over: Option<&str>) -> Vec<String> {
    let kinds = [
        (
            "slack-span",
            "spans go slack, which the model does not see",
            "N below zero",
        ),
        (
            "gross-slip",
            "the belt would slip, where the model lets it stick",
            "times what is needed to hold",
        ),
    ];
    let texts = kinds.iter().map(|(kind, what, worst)| {
        let mut places: Vec<(&str, f64, f64, usize, f64)> = Vec::new();
        for (here, Remark { at, value, .. }) in remarks.iter().filter(|(_, remark)| remark.kind == *kind) {
            match places.iter_mut().find(|place| place.0 == at) {
                Some(place) => {
                    place.1 = place.1.min(*here);
                    place.2 = place.2.max(*here);
                    place.3 += 1;
                    place.4 = place.4.min(*value);
                }
                None => places.push((at, *here, *here, 1, *value)),
            }
        }
        let list: Vec<String> = places
            .iter()
            .map(|(at, low, high, count, value)| {
                let value = value.abs();
                match over {
                    Some(key) => format!(
                        "{at} ({count} values of {key} from {low} to {high}, at worst {value:.3} {worst})"
                    ),
                    None => format!("{at} (at worst {value:.3} {worst})"),
                }
            })
            .collect();
        (!list.is_empty()).then(|| format!("{what}: {}", list.join(", ")))
    });
    texts.flatten().collect()
}
