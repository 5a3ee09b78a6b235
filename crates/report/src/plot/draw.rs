//! Drawing a laid-out figure.

use super::chart::{Figure, Panel, ScaleBar};
use super::color::{Color, sequential_color};
use super::layout::{self, BAR_GAP, BAR_WIDTH, BarLayout, LABEL_GAP, LABEL_LINE, PanelLayout, TICK_GAP};
use super::mark::{Transform, line_path, marker_path};
use super::raster::cells_to_png;
use super::series::{HeatMap, Layer, Strip};
use super::style::{
    Dash, FRAME_WIDTH, LABEL_TYPE, MAJOR_TICK, MINOR_TICK, Marker, SMALL_TYPE, Shape, Stroke, TITLE_TYPE,
};
use super::svg::{Anchor, Rect, Svg, number};
use super::{arrow, curve_label, legend, note, text, warnings};

/// Stroke of frames and ticks.
const FRAME: Stroke = Stroke {
    color: Color::BLACK,
    width: FRAME_WIDTH,
    dash: Dash::Solid,
};

/// Draws all of a figure.
pub(super) fn figure(figure: &Figure) -> Svg {
    let layout = layout::layout(figure);
    let mut svg = Svg::new(layout.width, layout.height);
    if let Some(title) = &figure.title {
        let size = text::fitting_size([title.as_str()].into_iter(), TITLE_TYPE, layout.width - 8.0);
        svg.text(layout.width / 2.0, 3.0 + size, size, Anchor::Middle, title);
    }
    if let Some(place) = &layout.legend {
        legend::draw(&mut svg, place, &figure.legend);
    }
    for (panels, layouts) in figure.rows.iter().zip(&layout.panels) {
        for (panel, layout) in panels.iter().zip(layouts) {
            draw_panel(&mut svg, panel, layout);
        }
    }
    warnings::draw(&mut svg, &layout.warnings);
    svg
}

fn draw_panel(svg: &mut Svg, panel: &Panel, layout: &PanelLayout) {
    let frame = layout.transform.frame;
    svg.begin_clip(frame);
    panel
        .layers
        .iter()
        .for_each(|layer| draw_lines_and_areas(svg, layer, &layout.transform));
    svg.end_clip();
    if !panel.bare {
        svg.stroke_rect(frame, FRAME);
    }
    // Markers are not clipped: one on the frame is whole, one outside is absent.
    for layer in &panel.layers {
        if let Layer::Points { points, marker } = layer {
            let shown = points.iter().filter(|point| layout.transform.shows(**point));
            let data: String = shown
                .filter_map(|point| layout.transform.point(*point))
                .map(|at| marker_path(marker, at))
                .collect();
            markers(svg, marker, &data);
        }
    }
    draw_axes(svg, layout);
    if let Some(bar) = &layout.color_bar {
        draw_color_bar(svg, bar, &frame);
    }
    if let Some(bar) = &panel.scale_bar {
        draw_scale_bar(svg, bar, &layout.transform);
    }
    if let Some(place) = &layout.legend {
        legend::draw(svg, place, &panel.legend);
    }
    if let Some(letter) = &panel.letter {
        let x = frame.x - MAJOR_TICK - TICK_GAP - layout.y_tick_width;
        svg.text(x, frame.y - 5.2, TITLE_TYPE, Anchor::Start, letter);
    }
    if let Some(heading) = &panel.heading {
        let size = text::fitting_size([heading.as_str()].into_iter(), LABEL_TYPE, frame.width + 8.0);
        let base = frame.y - layout.legend_height(panel) - 4.0;
        svg.text(frame.x + frame.width / 2.0, base, size, Anchor::Middle, heading);
    }
    let notes = note::draw(svg, panel, layout);
    curve_label::draw(svg, panel, layout, &notes);
}

/// Draws markers given as path data.
pub(super) fn markers(svg: &mut Svg, marker: &Marker, data: &str) {
    let has_inside = !matches!(marker.shape, Shape::Plus | Shape::Cross | Shape::Asterisk);
    let inside = has_inside.then_some(if marker.filled { marker.color } else { Color::WHITE });
    let width = if marker.size > 3.0 {
        0.7
    } else {
        (0.3 * marker.size).min(0.5)
    };
    svg.path(data, Some(Stroke::solid(marker.color).with_width(width)), inside);
}

fn draw_lines_and_areas(svg: &mut Svg, layer: &Layer, transform: &Transform) {
    let frame = &transform.frame;
    match layer {
        Layer::Line { points, stroke } => {
            svg.path(
                &line_path(&transform.polylines(points), frame),
                Some(*stroke),
                None,
            );
        }
        Layer::CoveringLine { points, base, stroke } => {
            let parts = transform.polylines(points);
            let foot = transform.y(*base).unwrap_or(frame.bottom());
            for part in &parts {
                if let (Some(first), Some(last)) = (part.first(), part.last()) {
                    let mut outline = line_path(std::slice::from_ref(part), frame);
                    outline.push_str(&format!(
                        "L{} {}L{} {}Z",
                        number(last[0]),
                        number(foot),
                        number(first[0]),
                        number(foot)
                    ));
                    svg.path(&outline, None, Some(Color::WHITE));
                }
            }
            svg.path(&line_path(&parts, frame), Some(*stroke), None);
        }
        Layer::Arrow { points, stroke, head } => {
            for part in transform.polylines(points) {
                if let Some(arrow) = arrow::on_page(&part, *head) {
                    svg.path(&line_path(&[arrow.shaft], frame), Some(*stroke), None);
                    svg.path(&polygon_path(&arrow.head), None, Some(stroke.color));
                }
            }
        }
        Layer::Area { points, color } => {
            let data: String = transform
                .polylines(points)
                .iter()
                .map(|part| polygon_path(part))
                .collect();
            svg.path(&data, None, Some(*color));
        }
        Layer::Stems { points, base, stroke } => {
            let foot = transform.y(*base).unwrap_or(frame.bottom());
            let stems: Vec<Vec<[f64; 2]>> = points
                .iter()
                .filter_map(|point| transform.point(*point))
                .map(|at| vec![[at[0], foot], at])
                .collect();
            svg.path(&line_path(&stems, frame), Some(*stroke), None);
        }
        Layer::Bands { intervals, color } => {
            let height = [transform.y.low, transform.y.high];
            let data: String = intervals
                .iter()
                .filter_map(|x| transform.rect(*x, height))
                .map(|rect| rect_path(&rect))
                .collect();
            svg.path(&data, None, Some(*color));
        }
        Layer::Uprights { x, stroke } => {
            let lines: Vec<Vec<[f64; 2]>> = x
                .iter()
                .filter_map(|x| transform.x(*x))
                .map(|x| vec![[x, frame.bottom()], [x, frame.y]])
                .collect();
            svg.path(&line_path(&lines, frame), Some(*stroke), None);
        }
        Layer::Strips(strips) => draw_strips(svg, strips, transform),
        Layer::HeatMap(map) => draw_heat_map(svg, map, transform),
        Layer::Outline { x, y, stroke } => {
            if let Some(rect) = transform.rect(*x, *y) {
                svg.stroke_rect(rect, *stroke);
            }
        }
        Layer::Points { .. } => {}
    }
}

/// Path data of a closed polygon on the page.
fn polygon_path(corners: &[[f64; 2]]) -> String {
    let mut data = String::new();
    for (index, at) in corners.iter().enumerate() {
        data.push(if index == 0 { 'M' } else { 'L' });
        data.push_str(&format!("{} {}", number(at[0]), number(at[1])));
    }
    if !data.is_empty() {
        data.push('Z');
    }
    data
}

fn rect_path(rect: &Rect) -> String {
    format!(
        "M{} {}h{}v{}h{}Z",
        number(rect.x),
        number(rect.y),
        number(rect.width),
        number(rect.height),
        number(-rect.width)
    )
}

/// One path for each colour: neighbours in one path meet without a seam.
fn draw_strips(svg: &mut Svg, strips: &[Strip], transform: &Transform) {
    let mut paths: Vec<(Color, String)> = Vec::new();
    for strip in strips {
        let Some(rect) = transform.rect(strip.x, strip.y) else {
            continue;
        };
        match paths.iter_mut().find(|(color, _)| *color == strip.color) {
            Some((_, data)) => data.push_str(&rect_path(&rect)),
            None => paths.push((strip.color, rect_path(&rect))),
        }
    }
    for (color, data) in &paths {
        svg.path(data, None, Some(*color));
    }
}

fn draw_heat_map(svg: &mut Svg, map: &HeatMap, transform: &Transform) {
    let corners = (
        transform.point([map.x[0], map.y[0]]),
        transform.point([map.x[1], map.y[1]]),
    );
    if let ((Some(low), Some(high)), Some(png)) = (corners, cells_to_png(map.columns, &map.cells)) {
        let rect = Rect {
            x: low[0].min(high[0]),
            y: low[1].min(high[1]),
            width: (high[0] - low[0]).abs(),
            height: (high[1] - low[1]).abs(),
        };
        svg.image(rect, &png);
    }
}

fn draw_axes(svg: &mut Svg, layout: &PanelLayout) {
    let transform = &layout.transform;
    let frame = transform.frame;
    let mut marks = String::new();
    for (values, length) in [
        (
            layout
                .x_ticks
                .major
                .iter()
                .map(|tick| tick.value)
                .collect::<Vec<_>>(),
            MAJOR_TICK,
        ),
        (layout.x_ticks.minor.clone(), MINOR_TICK),
    ] {
        for x in values
            .into_iter()
            .filter(|x| transform.x.contains(*x))
            .filter_map(|x| transform.x(x))
        {
            marks.push_str(&format!(
                "M{} {}v{}",
                number(x),
                number(frame.bottom()),
                number(length)
            ));
        }
    }
    for (values, length) in [
        (
            layout
                .y_ticks
                .major
                .iter()
                .map(|tick| tick.value)
                .collect::<Vec<_>>(),
            MAJOR_TICK,
        ),
        (layout.y_ticks.minor.clone(), MINOR_TICK),
    ] {
        for y in values
            .into_iter()
            .filter(|y| transform.y.contains(*y))
            .filter_map(|y| transform.y(y))
        {
            marks.push_str(&format!("M{} {}h{}", number(frame.x), number(y), number(-length)));
        }
    }
    svg.path(&marks, Some(FRAME), None);

    for tick in &layout.y_ticks.major {
        if let Some(y) = transform.y(tick.value) {
            let x = frame.x - MAJOR_TICK - TICK_GAP;
            svg.text(x, y + 0.36 * SMALL_TYPE, SMALL_TYPE, Anchor::End, &tick.label);
        }
    }
    let (lines, size) = &layout.y_label;
    let nearest = frame.x - MAJOR_TICK - TICK_GAP - layout.y_tick_width - LABEL_GAP - 0.2 * size;
    for (index, line) in lines.iter().rev().enumerate() {
        let middle = frame.y + frame.height / 2.0;
        svg.upward_text(nearest - index as f64 * LABEL_LINE, middle, *size, line);
    }
    if !layout.x_labelled {
        return;
    }
    let base = frame.bottom() + MAJOR_TICK + TICK_GAP + 0.73 * SMALL_TYPE;
    for tick in &layout.x_ticks.major {
        if let Some(x) = transform.x(tick.value) {
            svg.text(x, base, SMALL_TYPE, Anchor::Middle, &tick.label);
        }
    }
    let (lines, size) = &layout.x_label;
    for (index, line) in lines.iter().enumerate() {
        let base = base + LABEL_GAP + 0.8 * size + index as f64 * LABEL_LINE;
        svg.text(frame.x + frame.width / 2.0, base, *size, Anchor::Middle, line);
    }
}

fn draw_color_bar(svg: &mut Svg, bar: &BarLayout, frame: &Rect) {
    const STEPS: usize = 128;
    // One column would do, but viewers that smooth images would fade it out towards the sides.
    const COLUMNS: usize = 16;
    let rect = Rect {
        x: frame.right() + BAR_GAP,
        y: frame.y,
        width: BAR_WIDTH,
        height: frame.height,
    };
    let colors: Vec<Color> = (0..STEPS * COLUMNS)
        .map(|cell| sequential_color((cell / COLUMNS) as f64 / (STEPS - 1) as f64))
        .collect();
    if let Some(png) = cells_to_png(COLUMNS, &colors) {
        svg.begin_clip(rect);
        svg.image(rect, &png);
        svg.end_clip();
    }
    svg.stroke_rect(rect, FRAME);
    let mut marks = String::new();
    for tick in &bar.ticks.major {
        let Some(fraction) = bar.range.fraction(tick.value) else {
            continue;
        };
        let y = rect.bottom() - fraction * rect.height;
        marks.push_str(&format!(
            "M{} {}h{}",
            number(rect.right()),
            number(y),
            number(MAJOR_TICK)
        ));
        let x = rect.right() + MAJOR_TICK + TICK_GAP;
        svg.text(x, y + 0.36 * SMALL_TYPE, SMALL_TYPE, Anchor::Start, &tick.label);
    }
    svg.path(&marks, Some(FRAME), None);
    let (lines, size) = &bar.label;
    let nearest = rect.right() + MAJOR_TICK + TICK_GAP + bar.tick_width + LABEL_GAP + 0.73 * size;
    for (index, line) in lines.iter().enumerate() {
        svg.upward_text(
            nearest + index as f64 * LABEL_LINE,
            frame.y + frame.height / 2.0,
            *size,
            line,
        );
    }
}

fn draw_scale_bar(svg: &mut Svg, bar: &ScaleBar, transform: &Transform) {
    let frame = transform.frame;
    let Some(fraction) = transform.y.fraction(transform.y.low + bar.length) else {
        return;
    };
    let length = (fraction * frame.height).clamp(0.0, frame.height);
    let x = frame.right() + BAR_GAP;
    let (top, bottom) = (number(frame.bottom() - length), number(frame.bottom()));
    let data = format!(
        "M{a} {bottom}h3M{a} {top}h3M{x} {bottom}V{top}",
        a = number(x - 1.5),
        x = number(x)
    );
    svg.path(&data, Some(FRAME.with_width(0.8)), None);
    // A text longer than the bar starts at its foot.
    let middle =
        (frame.bottom() - length / 2.0).min(frame.bottom() - text::width(&bar.text, SMALL_TYPE) / 2.0);
    svg.upward_text(x + 3.5 + 0.73 * SMALL_TYPE, middle, SMALL_TYPE, &bar.text);
}
