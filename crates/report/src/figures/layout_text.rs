//! The texts in the drawing of a drive: names, wraps, tensions, hub loads. Lengths are in millimetres.

use super::drive_drawing::{outside, span_outside};
use super::drive_layout::{DriveLayout, LayoutPulley, LayoutSpan, TensionerMount};
use super::number::{degrees, force};
use super::tensioner_drawing::SLIDE;
use crate::plot::{Note, NotePlace, Width};

/// Greatest distance of a text from its place, points.
const REACH: f64 = 90.0;

/// What separates label and text.
const BETWEEN: &str = "  ";

/// The texts in the order in which they seek their places; `tips` are the ends of the hub loads.
pub(super) fn notes(input: &DriveLayout, tips: &[Option<[f64; 2]>], width: Width) -> Vec<Note> {
    // A narrow page has little room beside the drive: names come first. On a wide one, spans have fewer places.
    let pulleys = input
        .pulleys
        .iter()
        .map(|pulley| pulley_note(pulley, &input.pulleys));
    // The shorter a span, the fewer places its text has.
    let mut spans: Vec<&LayoutSpan> = input.spans.iter().collect();
    spans.sort_by(|a, b| length(a).total_cmp(&length(b)));
    let spans = spans
        .into_iter()
        .map(|span| span_note(span, &input.pulleys, width));
    let mut notes: Vec<Note> = match width {
        Width::Single => pulleys.chain(spans).collect(),
        Width::Double => spans.chain(pulleys).collect(),
    };
    // In one column there is no room for them; the legend names the largest.
    let tips = match width {
        Width::Single => &[],
        Width::Double => tips,
    };
    for (pulley, tip) in input.pulleys.iter().zip(tips) {
        if let (Some(load), Some(tip)) = (pulley.hub_load, tip) {
            notes.push(Note {
                text: force(load[0].hypot(load[1])),
                anchors: vec![*tip],
                place: NotePlace::Beside {
                    radius: 0.0,
                    toward: load,
                    reach: REACH,
                },
            });
        }
    }
    for tensioner in &input.tensioners {
        let (anchor, toward) = match tensioner.mount {
            TensionerMount::Rotary { pivot, .. } => {
                let arm = tensioner
                    .centers
                    .first()
                    .map_or([0.0, 0.0], |center| [pivot[0] - center[0], pivot[1] - center[1]]);
                (Some(pivot), arm)
            }
            TensionerMount::Linear { direction: along, .. } => (
                tensioner.centers.first().map(|center| beyond(*center, along)),
                along,
            ),
        };
        notes.push(Note {
            text: tensioner.name.clone(),
            anchors: anchor.into_iter().collect(),
            place: NotePlace::Beside {
                radius: 0.0,
                toward,
                reach: REACH,
            },
        });
    }
    notes.retain(|note| !note.text.is_empty());
    notes
}

fn pulley_note(pulley: &LayoutPulley, pulleys: &[LayoutPulley]) -> Note {
    Note {
        text: pulley_text(pulley),
        anchors: vec![pulley.center],
        place: NotePlace::Beside {
            radius: pulley.radius,
            toward: outside(pulley, pulleys),
            reach: REACH,
        },
    }
}

fn span_note(span: &LayoutSpan, pulleys: &[LayoutPulley], width: Width) -> Note {
    let at = |t: f64| {
        [
            span.start[0] + t * (span.end[0] - span.start[0]),
            span.start[1] + t * (span.end[1] - span.start[1]),
        ]
    };
    let text = words([&span.label, &span.note]);
    Note {
        text: match width {
            Width::Single => text.replace(BETWEEN, "\n"),
            Width::Double => text,
        },
        anchors: [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8].map(at).to_vec(),
        place: NotePlace::Beside {
            radius: 0.0,
            toward: span_outside(span, pulleys),
            reach: REACH,
        },
    }
}

/// Name, wrap and note of a pulley in lines.
fn pulley_text(pulley: &LayoutPulley) -> String {
    let lines = [
        words([&pulley.label, &pulley.name]),
        format!("wrap {}", degrees(pulley.wrap)),
        pulley.note.clone(),
    ];
    let lines: Vec<String> = lines.into_iter().filter(|line| !line.is_empty()).collect();
    lines.join("\n")
}

/// The end of a slide.
fn beyond(center: [f64; 2], along: [f64; 2]) -> [f64; 2] {
    let length = along[0].hypot(along[1]);
    [
        center[0] + SLIDE * along[0] / length,
        center[1] + SLIDE * along[1] / length,
    ]
}

fn length(span: &LayoutSpan) -> f64 {
    (span.end[0] - span.start[0]).hypot(span.end[1] - span.start[1])
}

/// The words that are not empty.
fn words(words: [&String; 2]) -> String {
    let words: Vec<&str> = words
        .into_iter()
        .map(String::as_str)
        .filter(|word| !word.is_empty())
        .collect();
    words.join(BETWEEN)
}
