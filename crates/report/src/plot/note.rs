//! Text at places of the data: on a point, or beside it where nothing else stands.
//!
//! A note beside its place is tried around all of its anchors at growing distances. The free place of least
//! cost wins: near, on the preferred side, at an early anchor. Far from its anchor it gets a thin line to it.
//! No note covers a line, an area or another text; hair lines (0.4 points or less, a grid) give way to it.

use std::f64::consts::{SQRT_2, TAU};

use super::chart::Panel;
use super::color::Color;
use super::layout::PanelLayout;
use super::mark::{Transform, occupy};
use super::occupancy::Occupancy;
use super::series::Layer;
use super::style::{SMALL_TYPE, Stroke};
use super::svg::{Anchor, Rect, Svg, number};
use super::text::{self, CAP_HEIGHT, DESCENT};

/// Text at a place of the data.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Note {
    /// The text, its lines separated by `\n`; `_{…}` and `^{…}` as in axis labels.
    pub text: String,
    /// Points `[x, y]` that it may stand at, the best first.
    pub anchors: Vec<[f64; 2]>,
    /// How it stands there.
    pub place: NotePlace,
}

/// How a [`Note`] stands at its anchor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum NotePlace {
    /// Centred on the anchor, on a white ground that covers the data below. Left out where other text stands.
    #[default]
    Over,
    /// Beside the anchor, clear of data and text. Left out if no place in the panel is free.
    Beside {
        /// Radius about the anchor that the text keeps away from, in units of the x axis; 0 for a point.
        radius: f64,
        /// The preferred side as a direction `[x, y]` in the data; all sides are equal when it is zero.
        toward: [f64; 2],
        /// Greatest distance from the anchor's radius, points; beyond 8 points a thin line leads to the text.
        reach: f64,
    },
}

/// Distance of base lines relative to the type size.
const LINE: f64 = 1.18;
/// Type sizes and greatest costs that are tried in turn: a smaller type is better than a place far away.
const ATTEMPTS: [(f64, f64); 4] = [
    (SMALL_TYPE, 24.0),
    (6.2, 40.0),
    (SMALL_TYPE, f64::INFINITY),
    (6.2, f64::INFINITY),
];
/// Distance from the anchor beyond which a line leads to the text.
const LEADER_FROM: f64 = 8.0;
/// Directions that are tried.
const DIRECTIONS: usize = 36;
/// What the far side costs, as a distance in points.
const WRONG_SIDE: f64 = 22.0;
/// What each further anchor costs.
const LATER_ANCHOR: f64 = 1.2;
/// What each point of a leading line costs where it crosses data.
const CROSSING: f64 = 1.5;
/// Distance of a leading line from its text.
const LEADER_GAP: f64 = 1.6;
/// Room around a text.
const CLEARANCE: f64 = 1.2;

/// Lines of a text and its size.
struct Block {
    lines: Vec<String>,
    size: f64,
    width: f64,
    height: f64,
}

impl Block {
    fn new(note: &Note, size: f64) -> Self {
        let lines: Vec<String> = note.text.lines().map(str::to_string).collect();
        let width = lines
            .iter()
            .map(|line| text::width(line, size))
            .fold(0.0, f64::max);
        let between = lines.len().saturating_sub(1) as f64 * LINE;
        Block {
            width,
            height: size * (CAP_HEIGHT + DESCENT + between),
            size,
            lines,
        }
    }

    /// Writes the lines into `rect`, flush with its left (−1), its middle (0) or its right (1).
    fn write(&self, svg: &mut Svg, rect: &Rect, flush: i8) {
        let (x, anchor) = match flush {
            -1 => (rect.x, Anchor::Start),
            1 => (rect.right(), Anchor::End),
            _ => (rect.x + rect.width / 2.0, Anchor::Middle),
        };
        for (index, line) in self.lines.iter().enumerate() {
            let base = rect.y + self.size * (CAP_HEIGHT + LINE * index as f64);
            svg.text(x, base, self.size, anchor, line);
        }
    }
}

/// A place found for a note.
struct Place {
    block: Block,
    rect: Rect,
    flush: i8,
    leader: Option<[[f64; 2]; 2]>,
}

/// A place that is tried.
struct Candidate {
    cost: f64,
    /// Where the text begins, seen from its anchor.
    end: [f64; 2],
    /// Direction from the anchor on the page.
    away: [f64; 2],
    /// The line that leads to the text.
    leader: Option<[[f64; 2]; 2]>,
}

/// What stands in a panel.
struct Taken {
    /// Data, legend and text.
    all: Occupancy,
    /// Text and lines that lead to it.
    text: Occupancy,
}

/// Writes the notes of a panel and returns the boxes they take.
pub(super) fn draw(svg: &mut Svg, panel: &Panel, layout: &PanelLayout) -> Vec<Rect> {
    let frame = layout.transform.frame;
    let mut boxes = Vec::new();
    if panel.notes.is_empty() {
        return boxes;
    }
    let mut taken = Taken {
        all: Occupancy::new(frame),
        text: Occupancy::new(frame),
    };
    panel
        .layers
        .iter()
        .filter(|layer| !is_hair_line(layer))
        .for_each(|layer| occupy(layer, &layout.transform, &mut taken.all));
    if let Some(legend) = &layout.legend {
        taken.all.mark_rect(legend.rect());
        taken.text.mark_rect(legend.rect());
    }
    // Notes with a fixed place come first, the others avoid them.
    for note in panel.notes.iter().filter(|note| note.place == NotePlace::Over) {
        let block = Block::new(note, SMALL_TYPE);
        let Some(at) = note.anchors.first().and_then(|at| layout.transform.point(*at)) else {
            continue;
        };
        let rect = Rect {
            x: at[0] - block.width / 2.0,
            y: at[1] - block.height / 2.0,
            width: block.width,
            height: block.height,
        };
        if taken.text.is_free(&rect) {
            svg.fill_rect(rect.grown(CLEARANCE), Color::WHITE);
            block.write(svg, &rect, 0);
            take(&mut taken, &rect, &mut boxes);
        }
    }
    for note in &panel.notes {
        let NotePlace::Beside { .. } = note.place else {
            continue;
        };
        let Some(place) = ATTEMPTS
            .iter()
            .find_map(|(size, most)| find(note, Block::new(note, *size), *most, &layout.transform, &taken))
        else {
            continue;
        };
        if let Some([from, to]) = place.leader {
            let data = format!(
                "M{} {}L{} {}",
                number(from[0]),
                number(from[1]),
                number(to[0]),
                number(to[1])
            );
            svg.path(&data, Some(Stroke::solid(Color::GREY).with_width(0.4)), None);
            taken.all.mark_line(from, to);
            taken.text.mark_line(from, to);
        }
        // Hair lines end before the text.
        svg.fill_rect(place.rect.grown(0.6), Color::WHITE);
        place.block.write(svg, &place.rect, place.flush);
        take(&mut taken, &place.rect, &mut boxes);
    }
    boxes
}

/// Whether a layer is a grid, on which text may stand.
fn is_hair_line(layer: &Layer) -> bool {
    const WIDEST: f64 = 0.4;
    matches!(layer, Layer::Line { stroke, .. } if stroke.width <= WIDEST)
}

fn take(taken: &mut Taken, rect: &Rect, boxes: &mut Vec<Rect>) {
    taken.all.mark_rect(rect.grown(CLEARANCE));
    taken.text.mark_rect(rect.grown(CLEARANCE));
    boxes.push(*rect);
}

/// The free place of least cost, if that is at most `most`.
fn find(note: &Note, block: Block, most: f64, transform: &Transform, taken: &Taken) -> Option<Place> {
    const DISTANCES: [f64; 18] = [
        2.0, 3.5, 5.5, 8.0, 11.0, 14.0, 17.0, 20.0, 24.0, 28.0, 33.0, 38.0, 44.0, 50.0, 58.0, 68.0, 84.0,
        100.0,
    ];
    let NotePlace::Beside {
        radius,
        toward,
        reach,
    } = note.place
    else {
        return None;
    };
    // The page's y runs downwards.
    let length = toward[0].hypot(toward[1]);
    let preferred = if length > 0.0 && length.is_finite() {
        [toward[0] / length, -toward[1] / length]
    } else {
        [0.0, 0.0]
    };
    let mut candidates: Vec<Candidate> = Vec::new();
    for (index, anchor) in note.anchors.iter().enumerate() {
        let (Some(at), true) = (transform.point(*anchor), transform.shows(*anchor)) else {
            continue;
        };
        let edge = transform
            .x(anchor[0] + radius)
            .map_or(0.0, |edge| (edge - at[0]).abs());
        for distance in DISTANCES.into_iter().filter(|distance| *distance <= reach) {
            for step in 0..DIRECTIONS {
                let angle = TAU * step as f64 / DIRECTIONS as f64;
                let away = [angle.cos(), angle.sin()];
                let side = if length > 0.0 {
                    1.0 - away[0] * preferred[0] - away[1] * preferred[1]
                } else {
                    0.0
                };
                let from = [at[0] + edge * away[0], at[1] + edge * away[1]];
                let leader = (distance > LEADER_FROM).then(|| {
                    let length = distance - LEADER_GAP;
                    [from, [from[0] + length * away[0], from[1] + length * away[1]]]
                });
                let crossed = leader.map_or(0.0, |[from, to]| taken.all.length_taken(from, to));
                candidates.push(Candidate {
                    cost: distance
                        + WRONG_SIDE / 2.0 * side
                        + LATER_ANCHOR * index as f64
                        + CROSSING * crossed,
                    end: [from[0] + distance * away[0], from[1] + distance * away[1]],
                    away,
                    leader,
                });
            }
        }
    }
    candidates.retain(|candidate| candidate.cost <= most);
    candidates.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let (rect, flush, leader) = candidates.into_iter().find_map(|candidate| {
        let Candidate {
            end, away, leader, ..
        } = candidate;
        // The point of the text's edge that lies nearest to the anchor comes to `end`.
        let share = |component: f64| (component * SQRT_2).clamp(-1.0, 1.0);
        let rect = Rect {
            x: end[0] + share(away[0]) * block.width / 2.0 - block.width / 2.0,
            y: end[1] + share(away[1]) * block.height / 2.0 - block.height / 2.0,
            width: block.width,
            height: block.height,
        };
        let reaches = leader.is_none_or(|[from, to]| taken.text.is_line_clear(from, to));
        let flush = if away[0] > 0.6 {
            -1
        } else if away[0] < -0.6 {
            1
        } else {
            0
        };
        (reaches && taken.all.is_free(&rect.grown(CLEARANCE))).then_some((rect, flush, leader))
    })?;
    Some(Place {
        block,
        rect,
        flush,
        leader,
    })
}
