//! Text at places of the data: on a point, or beside it where nothing else stands.
//!
//! A note beside its place is tried around all of its anchors at growing distances. The free place of least
//! cost wins: near, on the preferred side, at an early anchor. Far from its anchor it gets a thin line to it.
//! No note covers a line, an area or another text; hair lines (0.4 points or less, a grid) give way to it.

use super::chart::Panel;
use super::color::Color;
use super::layout::PanelLayout;
use super::mark::occupy;
use super::note_place::{self, Taken};
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
/// Room around a text.
pub(super) const CLEARANCE: f64 = 1.2;

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
        let candidates = note_place::candidates(note, &layout.transform, &taken);
        let found = ATTEMPTS.iter().find_map(|(size, most)| {
            let block = Block::new(note, *size);
            let place = note_place::free(&candidates, [block.width, block.height], *most, &taken)?;
            Some((block, place))
        });
        let Some((block, place)) = found else {
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
        block.write(svg, &place.rect, place.flush);
        take(&mut taken, &place.rect, &mut boxes);
    }
    boxes
}

/// Whether a layer is a grid, on which text may stand.
fn is_hair_line(layer: &Layer) -> bool {
    const WIDEST: f64 = 0.4;
    matches!(layer, Layer::Line { stroke, .. } | Layer::Uprights { stroke, .. } if stroke.width <= WIDEST)
}

fn take(taken: &mut Taken, rect: &Rect, boxes: &mut Vec<Rect>) {
    taken.all.mark_rect(rect.grown(CLEARANCE));
    taken.text.mark_rect(rect.grown(CLEARANCE));
    boxes.push(*rect);
}
