//! Where a text beside its anchor may stand: near, on the preferred side, clear of data and other text.

use std::f64::consts::{SQRT_2, TAU};

use super::mark::Transform;
use super::note::{CLEARANCE, Note, NotePlace};
use super::occupancy::Occupancy;
use super::svg::Rect;

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
/// A place found for a text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub rect: Rect,
    /// The text is flush with its left (−1), its middle (0) or its right (1).
    pub flush: i8,
    /// The line that leads to the text.
    pub leader: Option<[[f64; 2]; 2]>,
}

/// A place that is tried.
pub(super) struct Candidate {
    cost: f64,
    /// Where the text begins, seen from its anchor.
    end: [f64; 2],
    /// Direction from the anchor on the page.
    away: [f64; 2],
    /// The line that leads to the text.
    leader: Option<[[f64; 2]; 2]>,
}

/// What stands in a panel.
pub(super) struct Taken {
    /// Data, legend and text.
    pub all: Occupancy,
    /// Text and lines that lead to it.
    pub text: Occupancy,
}

/// The places beside the anchors of a note by rising cost.
pub(super) fn candidates(note: &Note, transform: &Transform, taken: &Taken) -> Vec<Candidate> {
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
        return Vec::new();
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
    candidates.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    candidates
}

/// The first place for a text of a width and height that is free and costs at most `most`.
pub(super) fn free(
    candidates: &[Candidate],
    [width, height]: [f64; 2],
    most: f64,
    taken: &Taken,
) -> Option<Place> {
    let affordable = candidates.iter().take_while(|candidate| candidate.cost <= most);
    affordable
        .map(|candidate| {
            let away = candidate.away;
            // The point of the text's edge that lies nearest to the anchor comes to `end`.
            let share = |component: f64| (component * SQRT_2).clamp(-1.0, 1.0);
            Place {
                rect: Rect {
                    x: candidate.end[0] + (share(away[0]) - 1.0) * width / 2.0,
                    y: candidate.end[1] + (share(away[1]) - 1.0) * height / 2.0,
                    width,
                    height,
                },
                flush: match away[0] {
                    x if x > 0.6 => -1,
                    x if x < -0.6 => 1,
                    _ => 0,
                },
                leader: candidate.leader,
            }
        })
        .find(|place| {
            taken.all.is_free(&place.rect.grown(CLEARANCE))
                && place
                    .leader
                    .is_none_or(|[from, to]| taken.text.is_line_clear(from, to))
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::axis::{Range, Scale};

    const FRAME: Rect = Rect {
        x: 0.0,
        y: 0.0,
        width: 200.0,
        height: 200.0,
    };

    fn transform() -> Transform {
        let unit = Range {
            low: 0.0,
            high: 200.0,
            scale: Scale::Linear,
        };
        Transform {
            frame: FRAME,
            x: unit,
            y: unit,
        }
    }

    fn place(radius: f64, toward: [f64; 2], taken: &Taken) -> Option<Place> {
        let note = Note {
            text: "text".into(),
            anchors: vec![[100.0, 100.0]],
            place: NotePlace::Beside {
                radius,
                toward,
                reach: 60.0,
            },
        };
        free(
            &candidates(&note, &transform(), taken),
            [30.0, 8.0],
            f64::INFINITY,
            taken,
        )
    }

    fn nothing() -> Taken {
        Taken {
            all: Occupancy::new(FRAME),
            text: Occupancy::new(FRAME),
        }
    }

    #[test]
    fn a_text_stands_near_its_anchor_on_the_preferred_side() {
        let right = place(20.0, [1.0, 0.0], &nothing()).unwrap();
        assert!((right.rect.x - 122.0).abs() < 1e-9 && right.flush == -1 && right.leader.is_none());
        // Upwards in the data is upwards on the page, where y runs downwards.
        let above = place(20.0, [0.0, 1.0], &nothing()).unwrap();
        assert!((above.rect.bottom() - 78.0).abs() < 1e-9 && above.flush == 0);
    }

    #[test]
    fn a_text_gives_way_to_data_and_its_line_to_text() {
        let mut taken = nothing();
        taken.all.mark_rect(FRAME.grown(-55.0));
        let far = place(0.0, [1.0, 0.0], &taken).unwrap();
        let [from, to] = far.leader.unwrap();
        assert_eq!(from, [100.0, 100.0]);
        assert!((to[0] - from[0]).hypot(to[1] - from[1]) > 30.0);
        // A wall of text on all sides cannot be crossed.
        taken.text.mark_rect(Rect {
            x: 80.0,
            y: 80.0,
            width: 40.0,
            height: 40.0,
        });
        assert!(place(0.0, [1.0, 0.0], &taken).is_none());
    }
}
