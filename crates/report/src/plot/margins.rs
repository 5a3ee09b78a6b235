//! Margins that fit tick labels, axis labels, legends and bars, and the frames in the room they leave.

use super::chart::{Figure, Panel};
use super::layout::{BAR_GAP, BAR_WIDTH, LABEL_GAP, LABEL_LINE, PanelLayout, TICK_GAP, position};
use super::legend::{self, LegendLayout};
use super::style::{LABEL_TYPE, MAJOR_TICK, SMALL_TYPE, TITLE_TYPE};
use super::svg::Rect;
use super::text;

/// White edge of the figure, points.
pub(super) const EDGE: f64 = 3.0;
/// Extra distance between columns of panels.
const GUTTER: f64 = 8.0;
/// Distance of the legend of the page from the panels.
const PAGE_LEGEND_GAP: f64 = 3.0;

/// Frames of equal size in the room that margins leave.
pub(super) fn frames(figure: &Figure, width: f64, height: f64, parts: &[PanelLayout]) -> Vec<Rect> {
    let columns = figure.rows.iter().map(Vec::len).max().unwrap_or(0).max(1);
    let (mut left, mut right) = (vec![0.0_f64; columns], vec![0.0_f64; columns]);
    let (mut top, mut bottom) = (vec![0.0_f64; figure.rows.len()], vec![0.0_f64; figure.rows.len()]);
    for (index, (part, panel)) in parts.iter().zip(figure.rows.iter().flatten()).enumerate() {
        let (row, column) = position(figure, index);
        left[column] = left[column].max(left_margin(part));
        right[column] = right[column].max(right_margin(part, panel));
        top[row] = top[row].max(top_margin(part, panel));
        bottom[row] = bottom[row].max(bottom_margin(part));
    }
    // Panels side by side stand clear of each other.
    right
        .iter_mut()
        .rev()
        .skip(1)
        .for_each(|margin| *margin += GUTTER);
    let title = if figure.title.is_some() {
        TITLE_TYPE * 1.4
    } else {
        0.0
    };
    let title =
        title + page_legend(figure, width).map_or(0.0, |legend| legend.rect().height + PAGE_LEGEND_GAP);
    let frame_width =
        ((width - 2.0 * EDGE - left.iter().chain(&right).sum::<f64>()) / columns as f64).max(15.0);
    let heights = row_heights(
        figure,
        height - 2.0 * EDGE - title - top.iter().chain(&bottom).sum::<f64>(),
    );
    (0..parts.len())
        .map(|index| {
            let (row, column) = position(figure, index);
            let before: f64 = (0..column).map(|c| left[c] + frame_width + right[c]).sum();
            let over: f64 = (0..row).map(|r| top[r] + heights[r] + bottom[r]).sum();
            Rect {
                x: EDGE + before + left[column],
                y: EDGE + title + over + top[row],
                width: frame_width,
                height: heights[row],
            }
        })
        .collect()
}

/// Heights of the frames of each row: as given, the others equal in what is left of `room`.
fn row_heights(figure: &Figure, room: f64) -> Vec<f64> {
    const LEAST: f64 = 12.0;
    let given: Vec<Option<f64>> = figure
        .rows
        .iter()
        .map(|row| {
            row.iter()
                .map(|panel| panel.frame_height.filter(|height| height.is_finite()))
                .reduce(|a, b| Some(a?.max(b?)))?
        })
        .map(|height| height.map(|height| height.max(LEAST)))
        .collect();
    let rest = room - given.iter().flatten().sum::<f64>();
    let sharing = given.iter().filter(|height| height.is_none()).count();
    let share = (rest / sharing.max(1) as f64).max(LEAST);
    given.into_iter().map(|height| height.unwrap_or(share)).collect()
}

/// The legend above all panels, below the title.
pub(super) fn page_legend(figure: &Figure, width: f64) -> Option<LegendLayout> {
    if figure.legend.is_empty() {
        return None;
    }
    let block = legend::above(&figure.legend, width - 2.0 * EDGE);
    let title = if figure.title.is_some() {
        TITLE_TYPE * 1.4
    } else {
        0.0
    };
    let x = width - EDGE - block.rect().width;
    Some(legend::moved(block, x, EDGE + title))
}

fn left_margin(part: &PanelLayout) -> f64 {
    let ticks = MAJOR_TICK + TICK_GAP + part.y_tick_width;
    let label = if part.y_label.0.is_empty() {
        0.0
    } else {
        LABEL_GAP + LABEL_LINE * part.y_label.0.len() as f64
    };
    // The first label of the x axis reaches to the left of the frame.
    let first = part.x_ticks.major.first().map_or(0.0, |tick| {
        let at = part.transform.x.fraction(tick.value).unwrap_or(0.0) * part.transform.frame.width;
        text::width(&tick.label, SMALL_TYPE) / 2.0 - at
    });
    (ticks + label).max(first)
}

fn right_margin(part: &PanelLayout, panel: &Panel) -> f64 {
    let last = part.x_ticks.major.last().map_or(0.0, |tick| {
        let at = (1.0 - part.transform.x.fraction(tick.value).unwrap_or(1.0)) * part.transform.frame.width;
        text::width(&tick.label, SMALL_TYPE) / 2.0 - at
    });
    let color_bar = part.color_bar.as_ref().map_or(0.0, |bar| {
        let label = if bar.label.0.is_empty() {
            0.0
        } else {
            LABEL_GAP + LABEL_LINE * bar.label.0.len() as f64
        };
        BAR_GAP + BAR_WIDTH + MAJOR_TICK + TICK_GAP + bar.tick_width + label
    });
    let scale_bar = if panel.scale_bar.is_some() {
        BAR_GAP + 3.0 + SMALL_TYPE
    } else {
        0.0
    };
    last.max(color_bar).max(scale_bar).max(2.0)
}

fn top_margin(part: &PanelLayout, panel: &Panel) -> f64 {
    let letter = if panel.letter.is_some() {
        TITLE_TYPE + 3.0
    } else {
        0.0
    };
    let heading = if panel.heading.is_some() {
        LABEL_TYPE + 4.0
    } else {
        0.0
    };
    let legend = part.legend_height(panel);
    // Half of the highest y tick label may reach over the frame.
    letter.max(legend + heading).max(0.4 * SMALL_TYPE)
}

fn bottom_margin(part: &PanelLayout) -> f64 {
    if part.x_labelled {
        let label = if part.x_label.0.is_empty() {
            0.0
        } else {
            LABEL_GAP + LABEL_LINE * part.x_label.0.len() as f64
        };
        MAJOR_TICK + TICK_GAP + 0.8 * SMALL_TYPE + label
    } else {
        MAJOR_TICK + 2.5
    }
}

impl PanelLayout {
    /// Height that a legend above the frame takes; 0 for one inside.
    pub fn legend_height(&self, panel: &Panel) -> f64 {
        if self.legend_above && !panel.legend.is_empty() {
            legend::above(&panel.legend, legend_width(panel, &self.transform.frame))
                .rect()
                .height
                + 4.0
        } else {
            0.0
        }
    }
}

/// Width for a legend above the frame, beside the panel letter.
pub(super) fn legend_width(panel: &Panel, frame: &Rect) -> f64 {
    let letter = panel
        .letter
        .as_ref()
        .map_or(0.0, |letter| text::width(letter, TITLE_TYPE) + 6.0);
    // The letter stands to the left of the frame's edge by about as much as it is wide.
    frame.width + 20.0 - letter
}
