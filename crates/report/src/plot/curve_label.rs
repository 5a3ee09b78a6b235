//! Names beside curves, where no data and no other text stands and no other curve is near.

use super::chart::{CurveLabel, Panel};
use super::layout::PanelLayout;
use super::mark::{Transform, occupy};
use super::occupancy::Occupancy;
use super::series::Layer;
use super::style::SMALL_TYPE;
use super::svg::{Anchor, Rect, Svg};
use super::text;

/// Writes names beside their curves, each at the free place nearest to the curve's highest point; `notes` are
/// the boxes of text that stands in the panel already.
pub(super) fn draw(svg: &mut Svg, panel: &Panel, layout: &PanelLayout, notes: &[Rect]) {
    if panel.labels.is_empty() {
        return;
    }
    let mut taken = Occupancy::new(layout.transform.frame);
    panel
        .layers
        .iter()
        .for_each(|layer| occupy(layer, &layout.transform, &mut taken));
    if let Some(place) = &layout.legend {
        taken.mark_rect(place.rect());
    }
    notes.iter().for_each(|rect| taken.mark_rect(rect.grown(1.0)));
    for label in &panel.labels {
        let mut others = Occupancy::new(layout.transform.frame);
        panel
            .layers
            .iter()
            .filter(|layer| !matches!(layer, Layer::Line { stroke, .. } if stroke.color == label.color))
            .filter(|layer| !matches!(layer, Layer::Points { .. }))
            .for_each(|layer| occupy(layer, &layout.transform, &mut others));
        if let Some(rect) = label_place(label, &layout.transform, &taken, &others) {
            taken.mark_rect(rect.grown(2.0));
            let base = rect.bottom() - text::DESCENT * SMALL_TYPE;
            svg.text(rect.x, base, SMALL_TYPE, Anchor::Start, &label.text);
        }
    }
}

fn label_place(
    label: &CurveLabel,
    transform: &Transform,
    taken: &Occupancy,
    others: &Occupancy,
) -> Option<Rect> {
    /// Distance of the name from its curve, and from curves that are not its own.
    const DISTANCE: f64 = 2.2;
    const CLEARANCE: f64 = 4.5;
    let (width, height) = (
        text::width(&label.text, SMALL_TYPE),
        (text::CAP_HEIGHT + text::DESCENT) * SMALL_TYPE,
    );
    let mut points: Vec<[f64; 2]> = transform.polylines(&label.points).into_iter().flatten().collect();
    points.retain(|at| {
        transform.frame.intersects(&Rect {
            x: at[0],
            y: at[1],
            width: 0.1,
            height: 0.1,
        })
    });
    let peak = *points.iter().min_by(|a, b| a[1].total_cmp(&b[1]))?;
    points.sort_by(|a, b| {
        let distance = |at: &[f64; 2]| (at[0] - peak[0]).hypot(at[1] - peak[1]);
        distance(a).total_cmp(&distance(b))
    });
    points.iter().find_map(|at| {
        let (right, left) = (at[0] + DISTANCE, at[0] - DISTANCE - width);
        let (below, above) = (at[1] + DISTANCE, at[1] - DISTANCE - height);
        let (centre, middle) = (at[0] - width / 2.0, at[1] - height / 2.0);
        // Beside, over or under a level curve; at a corner of a sloping one.
        [
            (right, middle),
            (centre, above),
            (left, middle),
            (centre, below),
            (right, below),
            (left, above),
            (right, above),
            (left, below),
        ]
        .into_iter()
        .map(|(x, y)| Rect { x, y, width, height })
        .find(|rect| taken.is_free(&rect.grown(0.8)) && others.is_clear(&rect.grown(CLEARANCE)))
    })
}
